#!/usr/bin/env bash
# tools/sanitizers.sh: builds the C++ tests with address and undefined-behaviour sanitizers and runs them.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/stage.sh "configure asan" cmake --preset asan
tools/stage.sh "build asan" cmake --build --preset asan
ctest --preset asan --parallel "${CTEST_PARALLEL_LEVEL:-$(nproc)}"
