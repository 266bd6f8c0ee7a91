#!/usr/bin/env bash
# tests/package/debian.sh [--all]: the packages of dist/ (tools/deb.sh): what the library shows, then install, run and remove
# them in a clean Debian 12, made by debootstrap. Without root or debootstrap they are only unpacked and run here, and it
# says so. --all: lintian before that, and their own tests (debian/tests) after it.
set -euo pipefail
cd "$(dirname "$0")/../.."
work=$(mktemp -d "$PWD/build/debian.XXXXXX")
trap 'umount "$work"/root/{proc,sys,dev/shm} 2>/dev/null || true; rm -rf --one-file-system "$work"' EXIT
debs() { find dist -maxdepth 1 -name '*.deb' ! -name '*-dbgsym_*'; }
[[ -n $(debs) ]] || { echo "debian: no packages in dist/: make deb" >&2 && exit 1; }

library=$(find dist -maxdepth 1 -name 'libgarrison[0-9]*.[0-9]_*.deb')
dpkg-deb -x "$library" "$work/library"
tests/package/symbols.sh "$(find "$work/library" -name 'libgarrison.so.*' -type f)"
for deb in $(debs | sort); do
  echo "debian: $(dpkg-deb -W --showformat '${Package}: ${Installed-Size} kB installed' "$deb"), $(($(stat -c %s "$deb") / 1000)) kB"
done

if [[ ${1:-} == --all ]]; then
  for tool in lintian autopkgtest; do
    command -v "$tool" >/dev/null || { echo "debian: missing: apt-get install $tool" >&2 && exit 1; }
  done
  lintian --pedantic --fail-on error,warning,info,pedantic dist/*.changes
  echo "debian: lintian --pedantic has no complaint"
fi

runs() {  # PREFIX OF COMMANDS...: the command, the module, and the main job
  "$@" garrison --version
  "$@" python3 -m garrison --version
  "$@" python3 -c 'import garrison, importlib.metadata as m; assert m.version("garrison") == garrison.__version__'
  "$@" garrison-node --version
  "$@" garrison-mpi --version
  "$@" garrison run /usr/share/doc/garrison/examples/wind/hijacked.toml -o /tmp/garrison-out --force >"$work/run.log"
  "$@" test -s /tmp/garrison-out/report.html
}

if [[ $(id -u) != 0 ]] || ! command -v debootstrap >/dev/null; then
  for deb in $(debs); do dpkg-deb -x "$deb" "$work/unpacked"; done
  triplet=$(dpkg-architecture -qDEB_HOST_MULTIARCH)
  export PATH=$work/unpacked/usr/bin:$PATH PYTHONPATH=$work/unpacked/usr/lib/python3/dist-packages
  export LD_LIBRARY_PATH=$work/unpacked/usr/lib/$triplet
  garrison --version
  garrison run examples/wind/hijacked.toml -o "$work/out" --force >/dev/null
  test -s "$work/out/report.html"
  echo "debian: unpacked and run on THIS system (a clean one wants root and debootstrap: apt-get install debootstrap)"
  exit 0
fi

tools/clean_root.sh "$work/root"
inside() { LC_ALL=C.UTF-8 HOME=/root DEBIAN_FRONTEND=noninteractive chroot "$work/root" "$@"; }
mkdir "$work/root/packages"
# shellcheck disable=SC2046
cp $(debs) "$work/root/packages"
mount -t proc proc "$work/root/proc" 2>/dev/null || true
mount -t sysfs sysfs "$work/root/sys" 2>/dev/null || true  # processors, as MPI sees them
mkdir -p "$work/root/dev/shm"  # semaphores of Python, ranks of MPI
mount -t tmpfs tmpfs "$work/root/dev/shm" 2>/dev/null || true
inside apt-get update -qq
tools/stage.sh "install the packages in it" env LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive chroot "$work/root" \
  sh -c 'apt-get install --yes --no-install-recommends python3-matplotlib /packages/*.deb'
runs inside
inside sh -c 'for page in garrison garrison-node garrison-mpi; do test -s /usr/share/man/man1/$page.1.gz || exit 1; done'
inside sh -c 'apt-get purge --yes $(dpkg-query -W -f "\${Package} " "*garrison*")' >"$work/purge.log" 2>&1 || { cat "$work/purge.log" && exit 1; }
left=$(inside find / -xdev -path /packages -prune -o -path /proc -prune -o -path /sys -prune -o -path /tmp -prune -o -path /var/log -prune -o \
  -path /var/lib/apt -prune -o -name '*garrison*' -print)
[[ -z $left ]] || { printf 'debian: left after purge: %s\n' "$left" >&2 && exit 1; }
echo "debian: installed, run and removed without a trace in a clean Debian 12 (debootstrap)"

if [[ ${1:-} == --all ]]; then
  tools/copy.sh "$work/sources"  # without what a build leaves, which tests would take for what is installed
  # shellcheck disable=SC2046
  autopkgtest --apt-upgrade --no-built-binaries $(debs) "$work/sources" -- chroot "$work/root"
fi
