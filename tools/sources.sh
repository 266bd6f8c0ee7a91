#!/usr/bin/env bash
# tools/sources.sh: a hash of all that garrison is built from.
set -euo pipefail
cd "$(dirname "$0")/.."
find CMakeLists.txt VERSION pyproject.toml README.md cmake include src bindings python tools/readme.py -type f \
  ! -name '*.pyc' ! -name '*.so' -print0 | LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum
