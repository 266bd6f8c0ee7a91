#!/usr/bin/env bash
# tools/sanitizers.sh [REGEX]: C++ tests with address and undefined-behaviour sanitizers, assertions on: those of the node,
# and of tests/cpp those whose path matches; where nothing is given, those of what reads bytes, hands out memory or shares
# it. As in tools/fuzz.sh, what these are about is compiled anew, below it is the library of BUILD (default build/release):
# all of it would be half of what a check may take (`cmake --preset asan` builds that).
set -euo pipefail
cd "$(dirname "$0")/.."
regex=${1:-'cpp/(attacks|wire)/|cpp/engine/(conformance|dimensions|forged|link|missing_rows|restart|room|sink|workers)_|cpp/core/(agent_set|model|names|params|random)'}
build=${BUILD:-build/release}
out=build/sanitizers
jobs=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
# Without the checks that make Eigen compile for minutes. As the library: objects of other builds do not link with it.
flags=(-std=c++20 -O1 -g1 -fno-omit-frame-pointer -D_GLIBCXX_ASSERTIONS -ffp-contract=off -fno-math-errno
  -fno-trapping-math -Wno-psabi -fsanitize=address,undefined -fno-sanitize=alignment,null,object-size,vptr
  -fno-sanitize-recover=all -DGARRISON_CASES="\"$PWD/tests/cases\"" -DGARRISON_SOURCE="\"$PWD\""
  -DEIGEN_MALLOC_ALREADY_ALIGNED=1 -Iinclude -Isrc -Itests/cpp -Itests/node -isystem /usr/include/eigen3)
! grep -q '^GARRISON_FEW_DIMENSIONS:BOOL=ON$' "$build/CMakeCache.txt" || flags+=(-DGARRISON_FEW_DIMENSIONS)
library=(src/{attacks,drivers,wire}/*.cpp src/engine/*.cpp src/core/{error,model,network,params,series}.cpp)
tests=(tests/cpp/main.cpp)
for test in $(find tests/cpp -name '*_test.cpp' ! -name allocation_test.cpp | sort); do
  [[ ! $test =~ $regex ]] || tests+=("$test")
done
node=(src/node/*.cpp src/node/daemon/*.cpp tests/node/{main,allocations,simulation,checks,station,plant,faults}.cpp tests/node/*_test.cpp)

object_of() { echo "$out/${1//\//_}.o"; }
compile() { # SOURCE
  # The declarations that tests share, read once.
  local header=()
  [[ $1 != tests/cpp/*_test.cpp ]] || header=(-include "$out/shared.hpp")
  g++ "${flags[@]}" "${header[@]}" -c "$1" -o "$(object_of "$1")"
}
program() { # NAME SOURCES...
  local objects=()
  for source in "${@:2}"; do objects+=("$(object_of "$source")"); done
  g++ -fsanitize=address,undefined "${objects[@]}" "$build/src/libgarrison.a" -lsodium -lcxsparse -lbtf -ldl -pthread -o "$out/$1"
}
build_all() {
  printf '#include <%s>\n' doctest/doctest.h nlohmann/json.hpp core/solvers.hpp iostream random >"$out/shared.hpp"
  g++ "${flags[@]}" -x c++-header "$out/shared.hpp" -o "$out/shared.hpp.gch"
  printf '%s\0' "${library[@]}" "${tests[@]}" "${node[@]}" | sort -zu | xargs -0 -P "$jobs" -I{} bash -ec 'eval "$setup"; compile "$1"' - {}
  program tests "${library[@]}" "${tests[@]}"
  program node_tests "${library[@]}" "${node[@]}"
}
# Arrays cannot be exported.
setup=$(declare -p flags out; declare -f object_of compile)
export setup
mkdir -p "$out"
if [[ ${2:-} == build ]]; then
  build_all
  exit
fi
BUILD=$build tools/stage.sh "build sanitizers" "$0" "$regex" build
export ASAN_OPTIONS=strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1
"$out/node_tests" &
nodes=$!
"$out/tests"
wait "$nodes"
