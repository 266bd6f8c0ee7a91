#!/usr/bin/env bash
# Builds the module garrison_bench into .venv. Called by `make bench`.
set -euo pipefail
cd "$(dirname "$0")/.."
tools/stage.sh "configure bench" cmake -S . -B build/bench -G Ninja -DGARRISON_BUILD_BENCH=ON -DGARRISON_IPOPT=AUTO -DGARRISON_BUILD_TESTS=OFF \
  -DPython_EXECUTABLE="$PWD/.venv/bin/python" -Dpybind11_DIR="$(.venv/bin/python -m pybind11 --cmakedir)"
tools/stage.sh "build bench" cmake --build build/bench
cp build/bench/bench/garrison_bench*.so "$(.venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("platlib"))')"
