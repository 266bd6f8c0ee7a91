#!/usr/bin/env bash
# Runs the programs of the foreign CMake project. $1: where they were built.
set -euo pipefail
build=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$build/uses_garrison"
"$build/uses_headers"
"$build/memory"

# Every node gives the bits of the whole library's agents, from the same parts.
"$build/parts" >"$work/cases"
while read -r family name; do
  rm -rf "$work/parts" && mkdir "$work/parts"
  "$build/parts" "$family" "$name" "$work/parts" >"$work/expected"
  node=node_$(sed -E "s/(^|_)(.)/\U\2/g" <<<"$family")  # the type: partial_sharing is PartialSharing
  "$build/$node" "$work"/parts/*.part >"$work/estimates"
  cmp "$work/expected" "$work/estimates"
  echo "node: $family ($name) agrees in all bits, $(wc -l <"$work/estimates") agents"
done <"$work/cases"
