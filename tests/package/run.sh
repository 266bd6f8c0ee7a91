#!/usr/bin/env bash
# Installs garrison into a temporary prefix, then builds and runs a foreign project against it,
# by CMake and by pkg-config.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

tools/stage.sh "configure release" cmake --preset release
tools/stage.sh "build library" cmake --build --preset release --target garrison garrison_node \
  program_garrison_node program_garrison_keygen program_garrison_ctl program_garrison_relay
tools/stage.sh "install library" cmake --install build/release --prefix "$work/prefix"

tools/stage.sh "package: CMake" cmake -G Ninja -S tests/package -B "$work/build" -DCMAKE_PREFIX_PATH="$work/prefix"
tools/stage.sh "package: build" cmake --build "$work/build"
tests/package/programs.sh "$work/build"

PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name garrison.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046  # the flags are meant to be split
g++ -std=c++20 tests/package/main.cpp -o "$work/by_pkg_config" $(pkg-config --cflags --libs garrison)
"$work/by_pkg_config"
tests/package/abi.sh "$work"
tests/package/alone.sh "$work/prefix/include"
tests/package/processors.sh
echo "package: both ways build and run"
