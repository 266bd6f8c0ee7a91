#!/usr/bin/env bash
# Node programs of boards give the bits of this machine: every family, from its parts of a design. Builds them where the
# board's compiler and qemu are installed. $1: the folder of the foreign project's programs (parts); $2...: boards, arm64
# or armhf.
set -euo pipefail
cd "$(dirname "$0")/../.."
programs=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$programs/parts" >"$work/cases"
for board in "$@"; do
  case $board in
    arm64) triple=aarch64-linux-gnu qemu=qemu-aarch64-static ;;
    armhf) triple=arm-linux-gnueabihf qemu=qemu-arm-static ;;
  esac
  if ! { command -v "$triple-g++" && command -v "$qemu"; } >/dev/null; then
    echo "boards: $board left out, not installed (apt-get install qemu-user-static g++-$triple)"
    continue
  fi
  run=("$qemu" -L "/usr/$triple")
  tools/board.sh "$board"
  while read -r family name; do
    rm -rf "$work/parts" && mkdir "$work/parts"
    "$programs/parts" "$family" "$name" "$work/parts" >"$work/expected"
    node=node_$(sed -E "s/(^|_)(.)/\U\2/g" <<<"$family")
    "${run[@]}" "build/board-$board/$node" "$work"/parts/*.part >"$work/estimates"
    cmp "$work/expected" "$work/estimates"
    echo "boards: $family ($name) on $board agrees in all bits, $(wc -l <"$work/estimates") agents"
  done <"$work/cases"
done
