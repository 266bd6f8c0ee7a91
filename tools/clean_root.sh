#!/usr/bin/env bash
# tools/clean_root.sh FOLDER: a clean Debian 12 in FOLDER, for chroot. Wants root and debootstrap; only the first one is
# fetched, it is kept in build/.
set -euo pipefail
mkdir -p "$1"
folder=$(realpath "$1")
cd "$(dirname "$0")/.."
[[ $(id -u) == 0 ]] || { echo "clean root: only root can make one" >&2 && exit 1; }
command -v debootstrap >/dev/null || { echo "clean root: missing: apt-get install debootstrap" >&2 && exit 1; }
base=build/debian-base.tar
if [[ ! -f $base ]]; then
  tools/stage.sh "make a clean Debian 12" debootstrap --variant=minbase bookworm "$folder"
  tar cf "$base.new" -C "$folder" . && mv "$base.new" "$base"
else
  tar xf "$base" -C "$folder"
fi
