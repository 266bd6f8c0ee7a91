#!/usr/bin/env bash
# tools/stage.sh NAME COMMAND...: runs the command, prints one line, with how far it is where that is a long build; on
# failure shows the end of its log.
set -uo pipefail
name=$1
shift
cd "$(dirname "$0")/.."
mkdir -p build/log
# The Python module, the tests and the benchmarks compile the same library: with ccache only once, if all of them
# call the compiler by the same name and in the same locale (Python sets one for pip where there is none).
export CXX=${CXX:-g++} LC_ALL=C.UTF-8
export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-$(command -v ccache)}
# Folders below this one are named relative to it, so that builds in different places share what they compile.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$PWD} CCACHE_NOHASHDIR=${CCACHE_NOHASHDIR:-1}
log=build/log/${name//[^[:alnum:]]/-}.log
printf '== %s ... ' "$name"
start=$SECONDS

# Every ten percent of a build by ninja, which writes [12/180] into the log.
progress() {
  local tens=0 done all
  while sleep 2 >/dev/null; do
    IFS=/ read -r done all < <(grep -oE '\[[0-9]+/[0-9]+\]' "$log" | tail -n 1 | tr -d '[]')
    ((${all:-0} > 20)) || continue
    while ((10 * done / all > tens)); do
      tens=$((tens + 1))
      printf '%d0%% ' "$tens"
    done
  done
}
: >"$log"
progress 2>/dev/null &
watcher=$!
trap 'kill "$watcher" 2>/dev/null' EXIT

if "$@" >"$log" 2>&1; then
  echo "done ($((SECONDS - start)) s)"
else
  code=$?
  echo "FAILED"
  tail -n 60 "$log"
  echo "The whole log: $log" >&2
  exit "$code"
fi
