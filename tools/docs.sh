#!/usr/bin/env bash
# tools/docs.sh [PYTHON]: builds the site into build/docs, and the C++ reference into build/docs/cpp; a warning or a broken
# internal link is an error. PYTHON needs garrison and its extra `docs`.
set -euo pipefail
cd "$(dirname "$0")/.."
python=${1:-.venv/bin/python}
"$python" -m sphinx -q -W --keep-going --fail-on-warning -j 1 -b html -d build/docs-cache docs build/docs
doxygen docs/Doxyfile
echo "docs: open build/docs/index.html"
