#!/usr/bin/env bash
# tools/setup.sh [EXTRA...]: from a bare Debian 12 to .venv with garrison installed. Repeating it is quick.
# PYTHON=/path/to/python3 chooses the interpreter, otherwise `python3` is taken.
set -euo pipefail
cd "$(dirname "$0")/.."
extras=(dev plot pandas xarray "$@")
python=${PYTHON:-python3}
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
export PIP_DISABLE_PIP_VERSION_CHECK=1

stop() {
  printf 'setup: %s\n' "$@" >&2
  exit 1
}

# 1. System packages.
have() { command -v "$1" >/dev/null; }
installed() { [[ $(dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null) == ii* ]]; }
python_has_headers() { "$python" -c 'import pathlib, sysconfig as s; assert pathlib.Path(s.get_path("include"), "Python.h").exists()'; }
missing=()
need() { # PACKAGE TEST...
  local package=$1
  shift
  "$@" 2>/dev/null || missing+=("$package")
}
need g++ have g++
need cmake have cmake
need ninja-build have ninja
need ccache have ccache
need make have make
need pkg-config have pkg-config
need libeigen3-dev installed libeigen3-dev
need doctest-dev installed doctest-dev
need nlohmann-json3-dev installed nlohmann-json3-dev
need libsuitesparse-dev installed libsuitesparse-dev
need libsodium-dev installed libsodium-dev
need libtomlplusplus-dev installed libtomlplusplus-dev
if [[ " $* " == *" bench "* ]]; then need coinor-libipopt-dev installed coinor-libipopt-dev; fi
need python3 have "$python"
need python3-venv "$python" -c 'import venv, ensurepip'
need python3-dev python_has_headers

if ((${#missing[@]})); then
  line="apt-get install --yes --no-install-recommends ${missing[*]}"
  have apt-get || stop "missing: ${missing[*]}" "this script installs with apt-get only; install what these Debian packages hold and repeat"
  if [[ $(id -u) == 0 ]]; then
    root=()
  elif have sudo; then
    root=(sudo)
  else
    stop "missing: ${missing[*]}" "neither root nor sudo; ask an administrator for:" "  $line"
  fi
  tools/stage.sh "apt-get update" "${root[@]}" apt-get update
  tools/stage.sh "install ${missing[*]}" "${root[@]}" env DEBIAN_FRONTEND=noninteractive $line ||
    stop "that line can be run by hand, as root:" "  $line"
fi

# 2. The interpreter and its environment.
version=$("$python" -c 'import sys; print("%d.%d.%d" % sys.version_info[:3])') || stop "$python does not run"
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
  stop "got Python $version ($(command -v "$python")), expected 3.11 or newer" \
    "Debian 12 has it: apt-get install python3; or name another: PYTHON=/usr/bin/python3 make run"
"$python" -c 'import venv, ensurepip' 2>/dev/null ||
  stop "$(command -v "$python") has no venv module; name another: PYTHON=/usr/bin/python3 make run"
if [[ ! -x .venv/bin/pip ]] || ! .venv/bin/python -c '' 2>/dev/null; then
  rm -rf .venv build/python
  tools/stage.sh "create .venv with Python $version" "$python" -m venv .venv
fi
pip=(.venv/bin/python -m pip install --quiet)

# 3. Python packages, when pyproject.toml changed; 4. garrison, when its sources changed.
fresh() { [[ -f $1 && $(<"$1") == "$2" ]]; }
requirements() {
  .venv/bin/python - "$@" <<'PY'
import sys, tomllib
project = tomllib.load(open("pyproject.toml", "rb"))["project"]
print(*project["dependencies"], *(r for e in sys.argv[1:] for r in project["optional-dependencies"][e]), sep="\n")
PY
}
wanted=$(requirements "${extras[@]}")
stamp=.venv/stamp-packages${*:+-$*}
if ! fresh "$stamp" "$wanted"; then
  mapfile -t list <<<"$wanted"
  tools/stage.sh "install Python packages" "${pip[@]}" "${list[@]}"
  printf '%s\n' "$wanted" >"$stamp"
fi

sources=$(find CMakeLists.txt VERSION pyproject.toml README.md cmake include src bindings python -type f \
  ! -name '*.pyc' ! -name '*.so' -print0 | LC_ALL=C sort -z | xargs -0 sha256sum | sha256sum)
stamp=.venv/stamp-garrison
if ! fresh "$stamp" "$sources"; then
  tools/stage.sh "build and install garrison" "${pip[@]}" --no-build-isolation --no-deps \
    --config-settings=build-dir=build/python .
  printf '%s\n' "$sources" >"$stamp"
fi
