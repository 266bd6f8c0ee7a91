#!/usr/bin/env bash
# tools/fuzz.sh [SECONDS [TARGET...]]: the node's parsers under libFuzzer with address and undefined-behaviour sanitizers, for
# so many seconds of a processor each (default 60), however much of it others take, JOBS of them at a time (default: one per
# processor). Wants what `tools/system.sh fuzz` installs,
# and a build: parsers are compiled anew with coverage, what is below them is the library of BUILD (default build/dev).
# Inputs that showed something new stay in build/fuzz/TARGET, one that breaks a parser in build/fuzz/TARGET-found-*; the end
# is then not 0.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
shift || true
targets=("$@")
((${#targets[@]})) || targets=(settings roster key line state proof part log snapshot frame datagram)
jobs=${JOBS:-$(nproc)}
build=${BUILD:-build/dev}
out=build/fuzz
checks=fuzzer,address,undefined
# As the library: objects of other builds do not link with it.
few=$(sed -n 's/^GARRISON_FEW_DIMENSIONS:BOOL=ON$/-DGARRISON_FEW_DIMENSIONS/p' "$build/CMakeCache.txt")
# A file of the library that is here, too, is taken from here.
parsers=(src/node/*.cpp src/node/daemon/{files,keys,machine,roster,sensor,service,settings,state,toml_file,udp}.cpp
  src/core/{error,params}.cpp src/engine/design_file.cpp src/filters/saturation/family.cpp
  tests/node/{plant,faults}.cpp tests/node/fuzz/{targets,insider,numeric_hosts,libfuzzer}.cpp)

object_of() { echo "$out/objects/${1//\//_}.o"; }

compile() { # SOURCE
  ccache clang++ -std=c++20 -O1 -gline-tables-only -ffp-contract=off -fsanitize="${checks/fuzzer/fuzzer-no-link}" \
    -fno-sanitize-recover=undefined -Wno-unknown-warning-option ${few:+"$few"} \
    -Iinclude -Isrc -Itests/node -isystem /usr/include/eigen3 -c "$1" -o "$(object_of "$1")"
}

try() { # TARGET
  local log=$out/$1.log found=$out/$1-found- left=$((1000 * seconds)) runs=0 TIMEFORMAT='%3U %3S' used user system
  rm -f "$found"*
  mkdir -p "$out/$1"
  while ((left >= 1000)); do
    # Refused is what claims more than the file has; half a gigabyte is what an agent's mailboxes may take.
    if ! used=$({ time GARRISON_TARGET=$1 GARRISON_SEEDS=$out/$1 "$out/fuzz" "$out/$1" -max_total_time=$((left / 1000)) \
      -artifact_prefix="$found" -verbosity=0 -print_final_stats=1 -timeout=20 -malloc_limit_mb=600 \
      >"$log" 2>&1; } 2>&1); then
      grep -m 1 -A 25 -E 'ERROR|runtime error' "$log" || tail -n 25 "$log"
      echo "fuzz: $1: broken by an input; again: GARRISON_TARGET=$1 $out/fuzz" "$found"*
      return 1
    fi
    read -r user system <<<"$used"
    left=$((left - 10#${user/./} - 10#${system/./} - 1))
    runs=$((runs + $(sed -n 's/^stat::number_of_executed_units: *//p' "$log")))
  done
  echo "fuzz: $1: $runs runs in $((seconds - left / 1000)) s of a processor, nothing found"
}

export -f object_of compile try
export checks out seconds few
export ASAN_OPTIONS=allow_addr2line=1
mkdir -p "$out/objects"
printf '%s\0' "${parsers[@]}" | xargs -0 -P "$jobs" -I{} bash -ec 'compile {}'
mapfile -t objects < <(for source in "${parsers[@]}"; do object_of "$source"; done)
clang++ -fsanitize="$checks" "${objects[@]}" "$build/src/libgarrison.a" -lsodium -ldl -o "$out/fuzz"
printf '%s\0' "${targets[@]}" | xargs -0 -P "$jobs" -I{} bash -ec 'try {}'
