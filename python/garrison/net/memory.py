"""What a process takes of the machine (proc(5))."""

from pathlib import Path


def resident(process: int) -> int:
    """Bytes in memory; 0 when there is no such process any more."""
    try:
        lines = Path(f"/proc/{process}/status").read_text().splitlines()
    except OSError:
        return 0
    return next((1024 * int(line.split()[1]) for line in lines if line.startswith("VmRSS:")), 0)


def descriptors(process: int) -> int:
    """Open files and sockets; 0 when there is no such process any more."""
    try:
        return sum(1 for _ in Path(f"/proc/{process}/fd").iterdir())
    except OSError:
        return 0
