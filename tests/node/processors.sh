#!/usr/bin/env bash
# Logs of real daemons of this machine give the same bits on other processors, under qemu: arm64 (little-endian) and s390x
# (big-endian). Runs six daemons for some seconds. Needs a build of the node's programs, and
#   apt-get install qemu-user-static g++-s390x-linux-gnu g++-aarch64-linux-gnu
# and leaves out, with a word, what is not installed. PYTHON=... names the interpreter that has garrison.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed '/^\[certificate\]/,/^$/d' tests/node/ring.toml >"$work/scenario.toml" # boards have none
cat >"$work/network.toml" <<END
scenario = "scenario.toml"
[set]
"run.steps" = 60
[run]
period_ms = 100
[relay]
loss = 0.1
END
"${PYTHON:-.venv/bin/python}" -m garrison.net up "$work/network.toml" -o "$work/net" >/dev/null
sources=(tests/node/elsewhere.cpp src/node/journal.cpp src/node/log.cpp src/core/error.cpp)
flags=(-std=c++20 -O2 -ffp-contract=off -DGARRISON_HEADERS_ONLY -Iinclude -isystem /usr/include/eigen3)
compared=0
for processor in s390x aarch64; do
  if ! command -v "$processor-linux-gnu-g++" >/dev/null || ! command -v "qemu-$processor-static" >/dev/null; then
    echo "processors: $processor left out, not installed"
    continue
  fi
  "$processor-linux-gnu-g++" "${flags[@]}" "${sources[@]}" -static -o "$work/$processor"
  found=$("qemu-$processor-static" "$work/$processor" "$work"/net/*/log/*.mcap)
  echo "processors: $processor: $found"
  compared=$((compared + 1))
done
echo "processors: every bit is the same on $compared other processors"
