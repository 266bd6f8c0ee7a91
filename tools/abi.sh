#!/usr/bin/env bash
# tools/abi.sh OLD: what programs linked to the library of the packages in OLD would miss in that of dist/ (`make deb`):
# symbols of the libraries, and layouts of what the headers declare. The debugging symbols of the whole library say the
# same in ten minutes and eleven gigabytes.
# Exit code 0: nothing; 4 and more as abidiff has it; 2: not compared, and why.
set -euo pipefail
cd "$(dirname "$0")/.."
refuse() {
  printf 'abi: not compared: %s\n' "$@" >&2
  exit 2
}
command -v abidiff >/dev/null || refuse "abidiff is missing: apt-get install abigail-tools"
old=${1:-}
[[ -n $old ]] || refuse "no older packages named: make abi OLD=FOLDER (there is no release yet)"
room=$(mktemp -d)
trap 'rm -rf "$room"' EXIT
unpack() {  # FOLDER PATTERN WHERE
  local found
  found=$(find "$1" -maxdepth 1 -name "$2" | sort | tail -n 1)
  [[ -n $found ]] || refuse "no $2 in $1"
  dpkg-deb -x "$found" "$3"
}
for side in old new; do
  folder=$old
  [[ $side == old ]] || folder=dist
  unpack "$folder" 'libgarrison[0-9]*.[0-9]_*.deb' "$room/$side"
  unpack "$folder" 'libgarrison-dev_*.deb' "$room/$side"
  # What is only declared counts too, so nothing is left out of the debugging symbols.
  echo '#include <garrison/garrison.hpp>' | "${CXX:-g++}" -std=c++20 -g -O0 -fPIC -shared -x c++ - -o "$room/$side.so" \
    -fno-eliminate-unused-debug-types -I"$room/$side/usr/include" -isystem /usr/include/eigen3
done
library() { find "$room/$1/usr/lib" -name 'libgarrison.so.*' -type f; }
failed=0
abidiff --no-added-syms "$(library old)" "$(library new)" || failed=$?
abidiff --no-added-syms --non-reachable-types --leaf-changes-only --headers-dir1 "$room/old/usr/include/garrison" \
  --headers-dir2 "$room/new/usr/include/garrison" "$room/old.so" "$room/new.so" || failed=$((failed | $?))
((failed)) || echo "abi: nothing that a program uses is missing or changed"
exit "$failed"
