#!/usr/bin/env bash
# tools/board.sh arm64|armhf: cross-compiles garrison::node and a node program of every family for a board, and prints
# their sizes without symbols: at most 70 kB on armhf. The compilers are Debian packages, named where they are missing.
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
  size=$(stat -c %s "$program.stripped")
  rm "$program.stripped"
  echo "$(basename "$program"): $size bytes stripped"
  [[ $1 != armhf ]] || ((size <= 70000)) || { echo "board: got $size bytes, expected at most 70000" >&2 && exit 1; }
done
