#!/usr/bin/env bash
# tools/stage.sh NAME COMMAND...: runs the command, prints one line; on failure shows the end of its log.
set -uo pipefail
name=$1
shift
cd "$(dirname "$0")/.."
mkdir -p build/log
# The Python module, the tests and the benchmarks compile the same library: with ccache only once, if all of them
# call the compiler by the same name and in the same locale (Python sets one for pip where there is none).
export CXX=${CXX:-g++} LC_ALL=C.UTF-8
export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-$(command -v ccache)}
log=build/log/${name//[^[:alnum:]]/-}.log
printf '== %s ... ' "$name"
start=$SECONDS
if "$@" >"$log" 2>&1; then
  echo "done ($((SECONDS - start)) s)"
else
  code=$?
  echo "FAILED"
  tail -n 60 "$log"
  echo "The whole log: $log" >&2
  exit "$code"
fi
