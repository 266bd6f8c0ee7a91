#!/usr/bin/env bash
# Node programs of boards give the bits of this machine: every family, from its parts of a design. Wants what
# `make board` built. $1: the folder of the foreign project's programs (parts); $2...: boards, arm64 or armhf.
set -euo pipefail
cd "$(dirname "$0")/../.."
programs=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$programs/parts" >"$work/cases"
for board in "$@"; do
  case $board in
    arm64) run=(qemu-aarch64-static -L /usr/aarch64-linux-gnu) ;;
    armhf) run=(qemu-arm-static -L /usr/arm-linux-gnueabihf) ;;
  esac
  if ! command -v "${run[0]}" >/dev/null; then
    echo "boards: $board left out, no ${run[0]} (apt-get install qemu-user-static)"
    continue
  fi
  while read -r family name; do
    rm -rf "$work/parts" && mkdir "$work/parts"
    "$programs/parts" "$family" "$name" "$work/parts" >"$work/expected"
    node=node_$(sed -E "s/(^|_)(.)/\U\2/g" <<<"$family")
    "${run[@]}" "build/board-$board/$node" "$work"/parts/*.part >"$work/estimates"
    cmp "$work/expected" "$work/estimates"
    echo "boards: $family ($name) on $board agrees in all bits, $(wc -l <"$work/estimates") agents"
  done <"$work/cases"
done
