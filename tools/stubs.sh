#!/usr/bin/env bash
# tools/stubs.sh [--check]: writes python/garrison/_core/*.pyi from the installed module, or fails when they are
# out of date.
set -euo pipefail
cd "$(dirname "$0")/.."
stubs=python/garrison/_core
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
.venv/bin/pybind11-stubgen garrison._core --exit-code --output-dir "$work" >"$work/log" 2>&1 || {
  cat "$work/log" >&2
  exit 1
}
new=$work/garrison/_core
.venv/bin/ruff format --quiet --config pyproject.toml "$new"
if [[ ${1:-} != --check ]]; then
  rm -rf "$stubs"
  cp -r "$new" "$stubs"
elif ! diff -ruN "$stubs" "$new"; then
  echo "stubs: $stubs is out of date; write it anew with tools/stubs.sh" >&2
  exit 1
fi
