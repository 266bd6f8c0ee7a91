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
tools/system.sh "$@"

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

sources=$(tools/sources.sh)
stamp=.venv/stamp-garrison
if ! fresh "$stamp" "$sources"; then
  # A wheel that `make wheel` made of these sources for this interpreter saves building them.
  tag=$(.venv/bin/python -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
  wheel=$(ls dist/garrison-*-"$tag-$tag"-*.whl 2>/dev/null || true)
  if [[ -n $wheel ]] && fresh dist/sources "$sources"; then
    tools/stage.sh "install $wheel" "${pip[@]}" --no-deps --force-reinstall "$wheel"
  else
    echo "setup: garrison is built now, 5 to 15 minutes on two cores; a wheel or the Debian packages need no build (docs/install.md)"
    tools/stage.sh "build and install garrison" .venv/bin/python -m pip install -v --no-build-isolation --no-deps \
      --config-settings=build-dir=build/python .
  fi
  printf '%s\n' "$sources" >"$stamp"
fi
