#!/usr/bin/env bash
# What a shared libgarrison shows: its SONAME, and not more than 500 symbols, none of them Eigen's or the standard
# library's. $1: the library.
set -euo pipefail
soname=$(objdump -p "$1" | sed -n 's/^ *SONAME *//p')
version=$(sed -nE 's/^#define GARRISON_VERSION_M(AJOR|INOR) //p' "$(dirname "$0")/../../include/garrison/version.hpp" | paste -sd.)
[[ $soname == "libgarrison.so.$version" ]] || { echo "symbols: got SONAME $soname, expected libgarrison.so.$version" >&2 && exit 1; }
shown=$(nm -D --defined-only "$1" | awk '{ print $3 }')
foreign=$(grep -vE '^_Z(T[ISV])?NK?8garrison|^garrison_' <<<"$shown" | c++filt || true)
[[ -z $foreign ]] || { printf 'symbols: not ours: %s\n' "$foreign" >&2 && exit 1; }
count=$(wc -l <<<"$shown")
((count <= 500)) || { echo "symbols: got $count, expected at most 500 (src/libgarrison.map says what is hidden)" >&2 && exit 1; }
echo "symbols: $soname shows $count"
