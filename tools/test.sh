#!/usr/bin/env bash
# tools/test.sh: all tests; those under the sanitizers beside the others, and told of after them. So are the node's parsers
# under libFuzzer, where .ci/run has begun them.
set -euo pipefail
cd "$(dirname "$0")/.."
trap 'tools/behind.sh stop sanitizers' EXIT
if [[ -z ${SANITIZERS_BEGUN:-} ]]; then
  make --no-print-directory library
  tools/behind.sh begin sanitizers tools/sanitizers.sh
fi
make --no-print-directory test-fast
[[ -z ${FUZZ_BEGUN:-} ]] || tools/behind.sh end fuzz-node
tools/behind.sh end sanitizers
