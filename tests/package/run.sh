#!/usr/bin/env bash
# Installs garrison into a temporary prefix, then builds and runs foreign projects against it, by CMake and by pkg-config
# and with other flags, and as a subdirectory of one; the examples of the documentation; nodes under qemu.
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

tools/stage.sh "examples: CMake" cmake -G Ninja -S examples/cpp -B "$work/examples" -DCMAKE_PREFIX_PATH="$work/prefix"
tools/stage.sh "examples: build" cmake --build "$work/examples"
python3 tests/package/examples.py "$work/examples"

tools/stage.sh "subdirectory: CMake" cmake -G Ninja -S tests/package/subdirectory -B build/subdirectory -DCMAKE_BUILD_TYPE=Release
tools/stage.sh "subdirectory: build" cmake --build build/subdirectory
build/subdirectory/uses_garrison

PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name garrison.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046  # the flags are meant to be split
g++ -std=c++20 tests/package/main.cpp -o "$work/by_pkg_config" $(pkg-config --cflags --libs garrison)
"$work/by_pkg_config"
tests/package/abi.sh "$work"
tests/package/flags.sh "$work"
tests/package/alone.sh "$work/prefix/include"
tests/package/processors.sh
tests/package/boards.sh "$work/build" arm64 armhf
echo "package: both ways build and run"
