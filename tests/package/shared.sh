#!/usr/bin/env bash
# The library of a static build, linked as a shared one: how many symbols it shows, and whether the Python module finds all
# that it calls, as in the Debian packages, without building them. $1: the build, with -fPIC and the module.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
version=$(sed -nE 's/^#define GARRISON_VERSION_M(AJOR|INOR) //p' include/garrison/version.hpp | paste -sd.)
library=$work/libgarrison.so.$version
g++ -shared -o "$library" -Wl,-soname,"libgarrison.so.$version" -Wl,--version-script=src/libgarrison.map \
  -Wl,--whole-archive "$1/src/libgarrison.a" -Wl,--no-whole-archive -lcholmod -lsodium -pthread
tests/package/symbols.sh "$library"
# What the module does not find is named when it is linked to the end; Python's own functions come with the interpreter.
g++ -shared -o "$work/module.so" -Wl,-z,defs "$1"/bindings/CMakeFiles/_core.dir/*.o "$library" -pthread 2>"$work/missing" || true
missing=$(sed -nE 's/.*undefined reference to `(garrison::.*)'"'"'$/\1/p' "$work/missing" | sort -u)
[[ -z $missing ]] || { printf 'shared: the module calls what the library does not show, GARRISON_EXPORT is missing: %s\n' "$missing" >&2 && exit 1; }
echo "shared: the module finds all that it calls"
