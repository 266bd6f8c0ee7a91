"""Arrays and a JSON document in one .npz archive, without pickles; and back."""

import hashlib
import io
import json
import tokenize
import zipfile
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core

_VERSION = 2
_DOCUMENT = "run_json"
_DIGEST = "run_digest"


def digest(text: str, arrays: dict[str, NDArray[Any]]) -> str:
    """What belongs to these words and arrays alone: a file with another one is damaged."""
    made = hashlib.blake2b(text.encode(), digest_size=16)
    for name in sorted(arrays):
        values = np.ascontiguousarray(arrays[name], dtype=arrays[name].dtype.newbyteorder("<"))
        made.update(f"{name} {values.dtype.str} {arrays[name].shape}".encode())
        made.update(values.tobytes())
    return made.hexdigest()


def require_digest(given: str, text: str, arrays: dict[str, NDArray[Any]], name: str) -> None:
    """Refuse words and arrays of which one is not what was written."""
    if given != digest(text, arrays):
        raise _core.IoError(
            f"{name}: got a damaged file: its digest does not match, expected a run written by Run.save; copy it again"
        )


def pack(document: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> bytes:
    """The archive as bytes."""
    buffer = io.BytesIO()
    text = json.dumps({"version": _VERSION, **document})
    words = {_DOCUMENT: np.array(text), _DIGEST: np.array(digest(text, arrays))}
    np.savez_compressed(buffer, **words, **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


def unpack(data: bytes, name: str) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Document and arrays of an archive. Raises IoError when the bytes are none, or of another version."""
    if not zipfile.is_zipfile(io.BytesIO(data)):
        raise _core.IoError(f"{name}: got a file that is no archive of arrays, expected a run written by Run.save")
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            found = {key: archive[key] for key in archive.files}
        text = str(found.pop(_DOCUMENT))
        document = json.loads(text)
        if not isinstance(document, dict):
            raise ValueError(f"{_DOCUMENT} without entries")
        version = document.pop("version")
        given = str(found.pop(_DIGEST, ""))
    except (
        OSError,
        ValueError,
        KeyError,
        EOFError,
        AttributeError,
        NotImplementedError,
        RuntimeError,
        SyntaxError,
        tokenize.TokenError,
        zipfile.BadZipFile,
        zlib.error,
    ) as error:
        raise _core.IoError(f"{name}: got {error}, expected a run written by Run.save") from None
    if version != _VERSION:
        raise _core.IoError(f"{name}: got format {version}, expected {_VERSION}; another version of garrison wrote it")
    require_digest(given, text, found, name)
    return document, found
