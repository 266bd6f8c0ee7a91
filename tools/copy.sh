#!/usr/bin/env bash
# tools/copy.sh FOLDER: what git knows of this checkout, or would know: nothing that a build leaves.
set -euo pipefail
mkdir -p "$1"
folder=$(realpath "$1")
cd "$(dirname "$0")/.."
git ls-files -z --cached --others --exclude-standard | xargs -0 cp --parents -t "$folder" --no-dereference
