#!/usr/bin/env bash
# tools/fuzz.sh [SECONDS [TARGET...]]: the node's parsers under libFuzzer with address and undefined-behaviour sanitizers, for
# so long each (default 60). Needs a build in build/dev and, on Debian, apt-get install clang libclang-rt-14-dev. Parsers are
# compiled anew with coverage; the library below them is that of build/dev. What it finds stays in build/fuzz.
# LIBRARIES=DIR: where libclang_rt lies, if it is not installed.
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-60}
shift || true
targets=("$@")
((${#targets[@]})) || targets=(settings roster key line state proof part log snapshot frame datagram)
out=build/fuzz
mkdir -p "$out/objects"
resource=${LIBRARIES:+-resource-dir=$LIBRARIES}
flags=(-std=c++20 -O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -ffp-contract=off
  -DGARRISON_FEW_DIMENSIONS -Iinclude -Isrc -Itests/node -isystem /usr/include/eigen3 ${resource:+"$resource"})
sources=(src/node/*.cpp src/node/daemon/*.cpp src/core/error.cpp src/core/params.cpp tests/node/{plant,faults}.cpp
  tests/node/fuzz/{targets,insider,numeric_hosts,libfuzzer}.cpp)
for source in "${sources[@]}"; do
  object="$out/objects/${source//\//_}.o"
  if [[ ! $object -nt $source ]]; then echo "clang++ ${flags[*]} -c $source -o $object"; fi
done | xargs -r -d '\n' -P "$(nproc)" -I{} sh -c '{}'
clang++ ${resource:+"$resource"} -fsanitize=fuzzer,address,undefined "$out"/objects/*.o build/dev/src/libgarrison.a -lsodium -ldl \
  -o "$out/fuzz"
for target in "${targets[@]}"; do
  mkdir -p "$out/$target"
  GARRISON_TARGET=$target "$out/fuzz" "$out/$target" -max_total_time="$seconds" -artifact_prefix="$out/$target-" -verbosity=0 \
    -print_final_stats=1 -timeout=20 >"$out/$target.log" 2>&1 || { tail -30 "$out/$target.log"; exit 1; }
  echo "fuzz: $target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$out/$target.log") runs, nothing found"
done
