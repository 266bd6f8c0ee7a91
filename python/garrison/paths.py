"""Files and folders that a caller names: read, or written whole or not at all."""

import contextlib
import errno
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from garrison import _core
from garrison.files import contents
from garrison.words import refusal, shown

_FULL = (errno.ENOSPC, errno.EDQUOT)


def path(which: str, value: Any) -> Path:
    """The path of a file."""
    if not isinstance(value, (str, os.PathLike)):
        raise refusal(which, shown(value), "the path of a file")
    return Path(value)


def read(which: str, where: Any, expected: str) -> bytes:
    """All bytes of a file. Raises IoError when it cannot be read."""
    try:
        return contents(path(which, where))
    except (OSError, ValueError) as error:
        raise _core.IoError(f"{_named(where)}: got {_why(error)}, expected {expected}") from error


def write(which: str, where: Any, data: bytes) -> None:
    """A file of these bytes, created or replaced. Raises IoError when it cannot be written; nothing changes then."""
    with whole_file(path(which, where)) as temporary:
        temporary.write_bytes(data)


def folder(which: str, where: Any) -> list[Path]:
    """What is in a folder, which is made where there is none. Raises IoError when it cannot be made or read."""
    try:
        path(which, where).mkdir(parents=True, exist_ok=True)
        return list(path(which, where).iterdir())
    except (OSError, ValueError) as error:
        raise _core.IoError(f"{_named(where)}: got {_why(error)}, expected the name of a folder to write to") from error


@contextlib.contextmanager
def whole_file(where: Path) -> Iterator[Path]:
    """A temporary file beside `where`, which takes its place at the end, if all went well. Raises IoError.

    Devices and pipes are written to as they are.
    """
    with told(where):
        target = where.resolve()
        if target.is_dir():
            raise _core.IoError(f"{_named(where)}: got a folder, expected the name of a file to write")
        if target.exists() and not target.is_file():
            yield target
            return
        handle, name = tempfile.mkstemp(prefix=f".{target.stem[:40]}.", suffix=target.suffix, dir=target.parent)
        os.close(handle)
        temporary = Path(name)
        try:
            yield temporary
            temporary.chmod(target.stat().st_mode if target.exists() else 0o666 & ~umask())
            temporary.replace(target)
        finally:
            temporary.unlink(missing_ok=True)


@contextlib.contextmanager
def whole_folder(where: Path, ours: Callable[[Path], bool]) -> Iterator[Path]:
    """A temporary folder beside `where`, which takes its place at the end, if all went well. Raises IoError.

    What is there already is replaced only if it is empty or `ours`.
    """
    with told(where), growing_folder(where, ours) as new:
        yield new


@contextlib.contextmanager
def growing_folder(where: Path, ours: Callable[[Path], bool]) -> Iterator[Path]:
    """The same for work that writes to it now and then: what else goes wrong meanwhile passes as it is."""
    with told(where):
        target = where.resolve()
        _require_ours(where, target, ours)
        temporary = Path(tempfile.mkdtemp(prefix=f".{target.stem[:40]}.", suffix=target.suffix, dir=target.parent))
    old = temporary / "old"
    try:
        new = temporary / "new"
        yield new
        with told(where):
            _require_ours(where, target, ours)  # once more: it may have taken long
            if target.exists():
                target.rename(old)
            new.rename(target)
    finally:
        if old.exists() and not target.exists():
            old.rename(target)
        shutil.rmtree(temporary, ignore_errors=True)


def _require_ours(where: Path, target: Path, ours: Callable[[Path], bool]) -> None:
    if not target.exists() or (target.is_dir() and (ours(target) or not any(target.iterdir()))):
        return
    kind = "a folder with files of others" if target.is_dir() else "a file"
    raise _core.IoError(
        f"{_named(where)}: got {kind}, expected a new name, or that of a run to replace; nothing was changed"
    )


@contextlib.contextmanager
def told(where: Path) -> Iterator[None]:
    """Errors of the system as those of garrison."""
    try:
        yield
    except _core.Error:
        raise
    except (OSError, ValueError) as error:
        code = error.errno if isinstance(error, OSError) else None
        why = "a disk that is full" if code in _FULL else _why(error)
        room = "room for it; free some (what was there is unchanged), or name another place"
        expected = room if code in (*_FULL, errno.EFBIG, errno.EIO) else "the name of a file to write"
        raise _core.IoError(f"{_named(where)}: got {why}, expected {expected}") from error


def _named(where: Any) -> str:
    """A path in full, for messages."""
    text = str(where)
    return text if text.isprintable() else repr(text)


def _why(error: OSError | ValueError) -> str:
    return (error.strerror if isinstance(error, OSError) else None) or str(error)


def umask() -> int:
    """Permissions that new files do not get."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
