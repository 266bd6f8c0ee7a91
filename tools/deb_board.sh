#!/usr/bin/env bash
# tools/deb_board.sh arm64|armhf: libgarrison, libgarrison-dev and garrison-node for a board, in dist/BOARD, cross-built
# in a clean Debian 12 (tools/clean_root.sh) whose packages this machine never sees; then installed there and, where qemu
# is here, asked for their version. Python and MPI are not cross-built: profiles nopython, nompi.
set -euo pipefail
cd "$(dirname "$0")/.."
case ${1-} in
  arm64) qemu=qemu-aarch64-static ;;
  armhf) qemu=qemu-arm-static ;;
  *) echo "deb-board: got BOARD=${1-}, expected arm64 or armhf: make deb-board BOARD=arm64" >&2 && exit 2 ;;
esac
board=$1
mkdir -p build
root=$(mktemp -d "$PWD/build/deb-board.XXXXXX")
trap 'rm -rf --one-file-system "$root"' EXIT
inside() {  # NAME COMMAND...
  tools/stage.sh "$1" env -u CXX CMAKE_CXX_COMPILER_LAUNCHER= LC_ALL=C.UTF-8 HOME=/root DEBIAN_FRONTEND=noninteractive \
    chroot "$root" "${@:2}"
}
install="apt-get install --yes --no-install-recommends"
profiles=cross,nocheck,pkg.garrison.nopython,pkg.garrison.nompi
tools/clean_root.sh "$root"
tools/copy.sh "$root/build/garrison"
inside "fetch the compiler for $board" sh -ec "dpkg --add-architecture $board; apt-get update
  $install dpkg-dev build-essential crossbuild-essential-$board"
inside "fetch what garrison needs for $board" sh -ec "cd /build/garrison
  apt-get build-dep --yes --no-install-recommends --host-architecture $board --build-profiles $profiles ./"
inside "build packages for $board" sh -ec "cd /build/garrison
  export DEB_BUILD_OPTIONS='nocheck parallel=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)} ${DEB_BUILD_OPTIONS:-}'
  dpkg-buildpackage --host-arch $board --build-profiles=$profiles --unsigned-source --unsigned-changes --build=any"
rm -rf "dist/$board" && mkdir -p "dist/$board"
cp "$root"/build/*.deb "$root"/build/*.changes "$root"/build/*.buildinfo "dist/$board/"
inside "install the packages for $board" sh -ec \
  "$install /build/libgarrison*_$board.deb /build/garrison-node_*_$board.deb"
if command -v "$qemu" >/dev/null; then
  cp "$(command -v "$qemu")" "$root/qemu"
  for program in garrison-node garrison-ctl; do
    echo "deb-board: on $board: $(chroot "$root" /qemu "/usr/bin/$program" --version)"
  done
else
  echo "deb-board: not run, no $qemu (apt-get install qemu-user-static)"
fi
ls -1 "dist/$board"/*.deb
