#!/usr/bin/env bash
# Installs garrison into a temporary prefix, then builds and runs a foreign project against it,
# by CMake and by pkg-config.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

tools/stage.sh "configure release" cmake --preset release
tools/stage.sh "build library" cmake --build --preset release --target garrison
tools/stage.sh "install library" cmake --install build/release --prefix "$work/prefix"

tools/stage.sh "package: CMake" cmake -G Ninja -S tests/package -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix"
tools/stage.sh "package: build" cmake --build "$work/build"
"$work/build/uses_garrison"
"$work/build/uses_headers"

# Every node gives the bits of the whole library's agents, from the same parts.
"$work/build/parts" >"$work/cases"
while read -r family name; do
  rm -rf "$work/parts" && mkdir "$work/parts"
  "$work/build/parts" "$family" "$name" "$work/parts" >"$work/expected"
  node=node_$(sed -E "s/(^|_)(.)/\U\2/g" <<<"$family")  # the type: partial_sharing is PartialSharing
  "$work/build/$node" "$work"/parts/*.part >"$work/estimates"
  cmp "$work/expected" "$work/estimates"
  echo "node: $family ($name) agrees in all bits, $(wc -l <"$work/estimates") agents"
done <"$work/cases"

PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name garrison.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046  # the flags are meant to be split
g++ -std=c++20 tests/package/main.cpp -o "$work/by_pkg_config" $(pkg-config --cflags --libs garrison)
"$work/by_pkg_config"
tests/package/abi.sh "$work"
tests/package/alone.sh "$work/prefix/include"
echo "package: both ways build and run"
