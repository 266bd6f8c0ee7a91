#!/usr/bin/env bash
# tools/run.sh: replays the wind data into out/wind, with the Debian package where it is installed and of this version,
# else with .venv, which is made first. GARRISON=COMMAND takes another one.
set -euo pipefail
cd "$(dirname "$0")/.."
installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Version}' python3-garrison 2>/dev/null || true)
if [[ -n ${GARRISON:-} ]]; then
  garrison=$GARRISON
elif [[ $installed == "ii  $(<VERSION)-"* ]]; then
  garrison=/usr/bin/garrison
  echo "run: the package python3-garrison is installed and of this version, so nothing is built"
else
  tools/setup.sh
  garrison=.venv/bin/garrison
fi
exec "$garrison" run examples/wind/hijacked.toml -o out/wind --force
