"""Files and folders that appear whole or not at all, and never in place of something that we did not write."""

import contextlib
import hashlib
import json
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from garrison import _core
from garrison.paths import umask, whole_file
from garrison.words import refusal

#: names and hashes of the files that a run wrote
MANIFEST = "manifest.json"
_TEMPORARY = ".garrison-"


def new_file(name: str, force: bool) -> Path:
    """The path of a file to write; refused where it exists and `force` is not given."""
    path = Path(name)
    if path.is_dir():
        raise _core.IoError(f"{path}: got a folder, expected the name of a file to write")
    if path.exists() and not force:
        raise _core.IoError(f"{path}: exists already; choose another name, or replace it with --force")
    if not path.absolute().parent.is_dir():
        raise _core.IoError(f"{path}: got no folder {path.absolute().parent}, expected one to write to")
    return path


@contextlib.contextmanager
def output_folder(path: Path, force: bool) -> Iterator[Path]:
    """A temporary folder, whose files are moved to `path` at the end, if all went well.

    It is beside `path`, or in it where it exists: on the same disk, and writable if `path` is.

    Of what is in `path` only the files that an earlier run wrote, unchanged since, are replaced (with `force`).
    """
    _ours(path, force)
    target = path.resolve()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        home = target if target.is_dir() else target.parent
        temporary = Path(tempfile.mkdtemp(prefix=_TEMPORARY, dir=home))
    except OSError as error:  # it names a folder that nobody asked for
        raise _core.IoError(f"{path}: got {error.strerror}, expected a folder that can be written into") from None
    try:
        yield temporary
        files = sorted(p.name for p in temporary.iterdir())
        hashes = {name: _hash(temporary / name) for name in files}
        text = json.dumps({"program": "garrison", "version": _core.__version__, "files": hashes}, indent=1)
        (temporary / MANIFEST).write_text(text, encoding="utf-8")
        _swap(temporary, target, [*files, MANIFEST], force)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


def _swap(temporary: Path, target: Path, files: list[str], force: bool) -> None:
    old = _ours(target, force)  # once more: the run may have taken hours
    if not target.exists():
        temporary.chmod(0o777 & ~umask())
        temporary.rename(target)
        return
    strangers = [name for name in files if name not in old and (target / name).exists()]
    if strangers:
        raise _core.IoError(
            f"{target / strangers[0]}: got a file that no run of garrison has written, and will not replace it"
        )
    for name in files:
        (temporary / name).replace(target / name)
    for name in old:
        if name not in files:
            (target / name).unlink(missing_ok=True)


def _ours(path: Path, force: bool) -> list[str]:
    """Names of the files in `path` that an earlier run wrote; refused where the folder must not be written to."""
    if path.exists() and not path.is_dir():
        raise _core.IoError(f"{path}: got a file, expected a folder to write to")
    if not path.exists() or all(p.name.startswith(_TEMPORARY) for p in path.iterdir()):
        return []
    hashes = _manifest(path / MANIFEST)
    for name, known in hashes.items():
        if (path / name).exists() and _hash(path / name) != known:
            raise _core.IoError(f"{path / name}: got a file that was changed after the run; move it away to run again")
    if not force:
        raise _core.IoError(
            f"{path}: got a folder that is not empty, the output of an earlier run; "
            "choose another one, or replace it with --force"
        )
    return [*hashes, MANIFEST]


def _manifest(file: Path) -> dict[str, str]:
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        hashes = {str(name): str(known) for name, known in content["files"].items()}
        if content["program"] != "garrison" or any(Path(name).name != name for name in hashes):
            raise ValueError
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        raise _core.IoError(
            f"{file.parent}: got a folder that is not empty and that no run of garrison has written, and will not "
            "replace it; choose a new or an empty one"
        ) from None
    return hashes


def _hash(path: Path) -> str:
    if not path.is_file():
        return "not a file"
    return hashlib.sha256(path.read_bytes()).hexdigest()


def write_picture(target: Path, figure: Any) -> None:
    """Write a figure whole, in the format that the ending of `target` names."""
    kind = target.suffix.lower().removeprefix(".")
    if kind not in figure.canvas.get_supported_filetypes():
        raise refusal(f"--output {target}", f"the ending {target.suffix!r}", "one of .png, .svg, .pdf")
    with whole_file(target) as temporary:
        figure.savefig(temporary, dpi=120, format=kind)
