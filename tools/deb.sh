#!/usr/bin/env bash
# tools/deb.sh: Debian packages of this checkout in dist/ (with the site, if `make docs` was called before), built with Debian 12's own packages, which it installs first.
# DEB_BUILD_OPTIONS=fewdimensions compiles few dimensions only, to try the packaging in minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
export DEB_BUILD_OPTIONS="parallel=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)} ${DEB_BUILD_OPTIONS:-}"
root=()
[[ $(id -u) == 0 ]] || root=(sudo)
if ! { command -v dpkg-buildpackage && dpkg-checkbuilddeps; } >/dev/null 2>&1; then
  tools/stage.sh "apt-get update" "${root[@]}" apt-get update
  tools/stage.sh "install build dependencies" "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --no-install-recommends dpkg-dev build-essential fakeroot
  tools/stage.sh "install build dependencies of garrison" "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get build-dep --yes --no-install-recommends ./
fi
# dpkg-buildpackage writes beside its folder: it works in a copy, which has no file that git does not know.
copy=build/deb/garrison
rm -rf build/deb && mkdir -p dist
tools/copy.sh "$copy"
# The site, where `make docs` has built it here: garrison-doc takes it along.
[[ ! -f build/docs/index.html ]] || cp -r build/docs "$copy/debian/site"
tools/stage.sh "build packages" env -C "$copy" dpkg-buildpackage --unsigned-source --unsigned-changes --build=binary
rm -f dist/*.deb dist/*.changes dist/*.buildinfo
mv build/deb/*.deb build/deb/*.changes build/deb/*.buildinfo dist/
ls -1 dist/*.deb
