#!/usr/bin/env bash
# A program that runs a filter, with flags that are not the library's: it gives the same numbers, or it does not link and
# the linker says why. Wants garrison in PKG_CONFIG_PATH. $1: a folder to work in.
set -euo pipefail
cd "$(dirname "$0")"
work=$1
build() {  # COMPILER FLAGS...
  # shellcheck disable=SC2046  # the flags are meant to be split
  "$@" main.cpp -o "$work/flags" $(pkg-config --cflags --libs garrison)
}
build g++ -std=c++20
expected=$("$work/flags")
if [[ $(uname -m) == x86_64 ]]; then wide=("-O2 -mavx2" "-O3 -march=native"); else wide=(); fi
compilers=(g++)
if command -v clang++ >/dev/null; then compilers+=(clang++); else echo "flags: clang++ left out, not installed"; fi
for compiler in "${compilers[@]}"; do
  for flags in "-std=c++20 -O2" "-std=c++23 -O2" "-std=c++20 -O0 -g -D_GLIBCXX_ASSERTIONS" "-std=c++20 -O2 -fno-plt -flto" \
    "${wide[@]/#/-std=c++20 }"; do
    [[ $compiler == g++ || $flags != *-flto* ]] || continue  # clang's needs a linker of its own
    [[ $compiler == g++ ]] || flags=${flags/c++23/c++2b}     # as clang 14 calls it
    # shellcheck disable=SC2086
    if build $compiler $flags 2>"$work/flags.log"; then
      got=$("$work/flags") || { echo "flags: $compiler $flags: ends with $?" >&2 && exit 1; }
      [[ $got == "$expected" ]] || { echo "flags: $compiler $flags: got $got, expected $expected" >&2 && exit 1; }
      echo "flags: $compiler $flags: runs"
    elif grep -q 'garrison_[0-9_]*with_EIGEN_DEFAULT_ALIGN_BYTES' "$work/flags.log"; then
      echo "flags: $compiler $flags: does not link, and the linker names the flags"
    else
      cat "$work/flags.log" >&2
      exit 1
    fi
  done
done
