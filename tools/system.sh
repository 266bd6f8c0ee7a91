#!/usr/bin/env bash
# tools/system.sh [docs|bench|mpi|fuzz...]: installs the Debian packages that a build wants and this machine lacks, and the named
# extras' own. PYTHON=/path/to/python3 chooses the interpreter.
set -euo pipefail
cd "$(dirname "$0")/.."
python=${PYTHON:-python3}

stop() {
  printf 'setup: %s\n' "$@" >&2
  exit 1
}

have() { command -v "$1" >/dev/null; }
installed() { [[ $(dpkg-query -W -f='${db:Status-Abbrev}' "$1" 2>/dev/null) == ii* ]]; }
python_has_headers() { "$python" -c 'import pathlib, sysconfig as s; assert pathlib.Path(s.get_path("include"), "Python.h").exists()'; }
has_libfuzzer() { clang++ -fsanitize=fuzzer -x c++ - -o /dev/null <<<'extern "C" int LLVMFuzzerTestOneInput(char*, int) { return 0; }'; }
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
if [[ " $* " == *" mpi "* ]]; then
  need libopenmpi-dev installed libopenmpi-dev
  need openmpi-bin installed openmpi-bin
  need libpnetcdf-dev installed libpnetcdf-dev
  need libmetis-dev installed libmetis-dev
fi
if [[ " $* " == *" fuzz "* ]]; then
  need clang have clang++
  need libclang-rt-14-dev has_libfuzzer
fi
if [[ " $* " == *" docs "* ]]; then need doxygen have doxygen; fi
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
