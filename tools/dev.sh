#!/usr/bin/env bash
# tools/dev.sh [TARGET...]: the quick build of a developer, in build/dev: few dimensions, the module beside its Python files
# (PYTHONPATH=python). VENV=... names another environment than .venv.
set -euo pipefail
cd "$(dirname "$0")/.."
venv=$(realpath "${VENV:-.venv}")
export CXX=${CXX:-g++} LC_ALL=C.UTF-8
[[ -f build/dev/build.ninja ]] || cmake -S . -B build/dev -G Ninja -DCMAKE_BUILD_TYPE=Release -DGARRISON_FEW_DIMENSIONS=ON \
  -DGARRISON_BUILD_PYTHON=ON -DGARRISON_BUILD_NODE=ON -DGARRISON_BUILD_MPI=AUTO -DCMAKE_CXX_COMPILER_LAUNCHER="$(command -v ccache)" -DPython_EXECUTABLE="$venv/bin/python" \
  -Dpybind11_DIR="$("$venv/bin/python" -m pybind11 --cmakedir)" >/dev/null
cmake --build build/dev ${*:+--target "$@"}
for module in build/dev/bindings/_core*.so; do
  [[ ! -e $module ]] || ln -sf "../../$module" python/garrison/
done
