"""How busy others kept the machine: a miss says little where they took the processors."""

import os
import resource
import time
from pathlib import Path

#: cores that others may take before a miss is doubtful
_QUIET = 0.25


class Load:
    """Begins to measure when it is made; what runs below this process is not counted among the others."""

    def __init__(self) -> None:
        self._begun, self._all, self._own = time.monotonic(), _machine(), _ours()

    def words(self) -> str:
        """How many cores others took on average, and what that means for a miss; empty on a quiet machine."""
        passed = max(time.monotonic() - self._begun, 0.01)
        others = max(0.0, (_machine() - self._all) - (_ours() - self._own)) / passed
        if others <= _QUIET:
            return ""
        return f"others took {others:.2f} of {os.cpu_count()} cores meanwhile: repeat a miss on a quiet machine"


def _machine() -> float:
    """Seconds of all processors that were not idle, since the machine started (proc(5))."""
    user, nice, system, _idle, _wait, irq, soft = map(int, Path("/proc/stat").read_text().split()[1:8])
    return (user + nice + system + irq + soft) / os.sysconf("SC_CLK_TCK")


def _ours() -> float:
    """Seconds of this process and of its children that have ended."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(one.ru_utime + one.ru_stime for one in used)
