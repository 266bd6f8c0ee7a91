#!/usr/bin/env bash
# tools/abi.sh OLD: what programs linked to the library of the packages in OLD would miss in that of dist/ (`make deb`).
# Exit code 0: nothing; 4 and more as abipkgdiff has it; 2: not compared, and why.
set -euo pipefail
cd "$(dirname "$0")/.."
refuse() {
  printf 'abi: not compared: %s\n' "$@" >&2
  exit 2
}
command -v abipkgdiff >/dev/null || refuse "abipkgdiff is missing: apt-get install abigail-tools"
old=${1:-}
[[ -n $old ]] || refuse "no older packages named: make abi OLD=FOLDER (there is no release yet)"
find_one() {  # FOLDER PATTERN
  local found
  found=$(find "$1" -maxdepth 1 -name "$2" | sort | tail -n 1)
  [[ -n $found ]] || refuse "no $2 in $1"
  echo "$found"
}
packages=()
for folder in "$old" dist; do
  packages+=("$(find_one "$folder" 'libgarrison[0-9]*.[0-9]_*.deb')" "$(find_one "$folder" 'libgarrison[0-9]*-dbgsym_*.deb')"
    "$(find_one "$folder" 'libgarrison-dev_*.deb')")
done
abipkgdiff --d1 "${packages[1]}" --d2 "${packages[4]}" --devel1 "${packages[2]}" --devel2 "${packages[5]}" \
  "${packages[0]}" "${packages[3]}"
echo "abi: nothing that a program uses is missing or changed"
