#!/usr/bin/env bash
# tools/behind.sh begin NAME COMMAND...: starts a long job that gives way to everything else, which often leaves a core idle.
# tools/behind.sh end NAME: lets it have the machine, waits for it, prints what it printed, and ends as it did.
# tools/behind.sh stop NAME: ends it, if it runs.
set -euo pipefail
cd "$(dirname "$0")/.."
action=$1 job=build/log/behind-$2
shift 2
mkdir -p build/log

case $action in
  begin)
    rm -f "$job".*
    # A session of its own is a group of its own to the scheduler, where that has groups, and nice counts within it alone: so
    # it is told, too. The session tells it of itself: until it is one, it would be the caller that gives way.
    # shellcheck disable=SC2016  # expanded there
    setsid nice -n 19 bash -c '{ echo 19 >/proc/self/autogroup; } 2>/dev/null
      job=$1; shift; code=0; "$@" || code=$?; echo "$code" >"$job.code"' - "$job" "$@" >"$job.log" 2>&1 </dev/null &
    echo $! >"$job.pid"
    ;;
  end)
    pid=$(<"$job.pid")
    { echo 0 >"/proc/$pid/autogroup"; } 2>/dev/null || true
    tail --pid="$pid" --lines=+1 --follow "$job.log"
    rm "$job.pid"
    exit "$(<"$job.code")"
    ;;
  stop)
    [[ ! -f $job.pid ]] || kill -- "-$(<"$job.pid")" 2>/dev/null || true
    ;;
esac
