#!/usr/bin/env bash
# A wheel in a bare environment of the same interpreter: with pip and nothing else, far from the checkout. Imports it,
# runs the wind data, and once more with pictures. $1: the interpreter; $2: the wheel.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" -m venv "$work/bare"
cp -r examples/wind "$work/wind"
wheel=$(realpath "$2")
cd "$work"
export PIP_DISABLE_PIP_VERSION_CHECK=1
bare/bin/python -m pip install --quiet "$wheel"
bare/bin/python -c 'import garrison, importlib.metadata as m; assert m.version("garrison") == garrison.__version__'
bare/bin/garrison --version
bare/bin/garrison run wind/hijacked.toml -o plain --force >plain.txt
bare/bin/python -m pip install --quiet "$wheel[plot]"
bare/bin/garrison run wind/hijacked.toml -o plot --force >plot.txt
test -s plot/report.html
bare/bin/python -m pip uninstall --quiet --yes garrison
if bare/bin/python -c 'import garrison' 2>/dev/null; then
  echo "wheel: garrison is still there after pip uninstall" >&2
  exit 1
fi
echo "wheel: ${wheel##*/} installs, runs and goes ($(bare/bin/python --version))"
