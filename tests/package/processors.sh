#!/usr/bin/env bash
# Same bytes and bits on other processors, under qemu: arm64 (little-endian) and s390x (big-endian). Needs
#   apt-get install qemu-user-static g++-s390x-linux-gnu g++-aarch64-linux-gnu
# and leaves out, with a word, what is not installed.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
flags=(-std=c++20 -O2 -ffp-contract=off -DGARRISON_HEADERS_ONLY -Iinclude -isystem /usr/include/eigen3 tests/package/processors.cpp)
g++ "${flags[@]}" -o "$work/here"
"$work/here" >"$work/here.out"
grep -q "IS LOST" "$work/here.out" && { cat "$work/here.out"; exit 1; }
compared=0
for processor in s390x aarch64; do
  if ! command -v "$processor-linux-gnu-g++" >/dev/null || ! command -v "qemu-$processor-static" >/dev/null; then
    echo "processors: $processor left out, not installed"
    continue
  fi
  "$processor-linux-gnu-g++" "${flags[@]}" -static -o "$work/$processor"
  "qemu-$processor-static" "$work/$processor" >"$work/$processor.out"
  diff "$work/here.out" "$work/$processor.out"
  compared=$((compared + 1))
done
echo "processors: $(wc -l <"$work/here.out") lines, the same on $compared other processors"
