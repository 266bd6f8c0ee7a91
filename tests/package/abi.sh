#!/usr/bin/env bash
# A program whose flags make Eigen take its memory otherwise than the library's does not link, and the linker says why;
# one with other flags links and runs. Wants garrison in PKG_CONFIG_PATH. $1: a folder to work in.
set -euo pipefail
cd "$(dirname "$0")"
build() {  # FLAGS...
  # shellcheck disable=SC2046  # the flags are meant to be split
  "${CXX:-g++}" -std=c++20 -O1 "$@" abi.cpp -o "$work/abi" $(pkg-config --cflags --libs garrison)
}
work=$1
build
"$work/abi"
[[ $(uname -m) == x86_64 ]] || exit 0
build -msse4.2
"$work/abi"
for flags in "-mavx2" "-mavx2 -DEIGEN_MAX_ALIGN_BYTES=16" "-march=skylake-avx512" "-fsanitize=address"; do
  # shellcheck disable=SC2086
  if build $flags 2>"$work/abi.log"; then
    echo "abi: a program with $flags links" >&2
    exit 1
  fi
  grep -o 'undefined reference to .garrison_[0-9_]*with_EIGEN_DEFAULT_ALIGN_BYTES[A-Za-z0-9_]*' "$work/abi.log" | sort -u
done
echo "package: programs with another memory layout do not link"
