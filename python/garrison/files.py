"""Files as bytes: only what has an end is read."""

import errno
import stat
from pathlib import Path


def contents(path: Path) -> bytes:
    """All bytes of a file. Raises OSError, also for devices and pipes, which may never end."""
    mode = path.stat().st_mode
    if not stat.S_ISREG(mode) and not stat.S_ISDIR(mode):
        raise OSError(errno.EINVAL, "a device or a pipe (write what it says to a file)", str(path))
    return path.read_bytes()
