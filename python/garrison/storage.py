"""Arrays and a JSON document in one .npz archive, without pickles; and back."""

import io
import json
import tokenize
import zipfile
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison import _core

_VERSION = 1
_DOCUMENT = "run_json"


def pack(document: dict[str, Any], arrays: dict[str, NDArray[Any]]) -> bytes:
    """The archive as bytes."""
    buffer = io.BytesIO()
    text = json.dumps({"version": _VERSION, **document})
    np.savez_compressed(buffer, **{_DOCUMENT: np.array(text)}, **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()


def unpack(data: bytes, name: str) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Document and arrays of an archive. Raises IoError when the bytes are none, or of another version."""
    if not zipfile.is_zipfile(io.BytesIO(data)):
        raise _core.IoError(f"{name}: got a file that is no archive of arrays, expected a run written by Run.save")
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            found = {key: archive[key] for key in archive.files}
        document = json.loads(str(found.pop(_DOCUMENT)))
        version = document.pop("version")
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
    return document, found
