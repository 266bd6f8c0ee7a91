#!/usr/bin/env bash
# tools/sanitizers.sh [REGEX]: builds C++ tests with address and undefined-behaviour sanitizers and runs them: those of
# the node, and of tests/cpp those whose path matches; where nothing is given, those of what reads bytes, hands out memory
# or shares it.
set -euo pipefail
cd "$(dirname "$0")/.."
chosen='^(attacks|wire)/|^engine/(conformance|dimensions|forged|link|missing_rows|restart|room|sink|workers)_|^core/(agent_set|model|names|params|random)'
tools/stage.sh "configure asan" cmake --preset asan -DGARRISON_TEST_FILES="${1:-$chosen}"
tools/stage.sh "build asan" cmake --build --preset asan --target garrison_tests garrison_allocation_test \
  garrison_node_tests garrison_node_fuzz
ctest --preset asan --exclude-regex partition --parallel "${CTEST_PARALLEL_LEVEL:-$(nproc)}"
