#!/usr/bin/env bash
# tools/board.sh arm64|armhf: cross-compiles garrison::node and a node program of every family for a board, and prints
# their sizes without symbols. The boards' compilers are Debian packages, named where they are missing.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1-} in
  arm64) triple=aarch64-linux-gnu ;;
  armhf) triple=arm-linux-gnueabihf ;;
  *) echo "board: got BOARD=${1-}, expected arm64 or armhf: make board BOARD=arm64" >&2 && exit 2 ;;
esac
command -v "$triple-g++" >/dev/null || { echo "board: missing: apt-get install g++-$triple" >&2 && exit 1; }
build=build/board-$1
tools/stage.sh "configure $1" cmake -G Ninja -S tests/package/board -B "$build" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_TOOLCHAIN_FILE="$PWD/cmake/toolchain-$1.cmake"
tools/stage.sh "build nodes for $1" cmake --build "$build"
for program in "$build"/node_*; do
  "$triple-strip" -o "$program.stripped" "$program"
  echo "$(basename "$program"): $(stat -c %s "$program.stripped") bytes stripped"
  rm "$program.stripped"
done
