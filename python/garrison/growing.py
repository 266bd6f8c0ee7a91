"""An array of a folder of zarr that is written while a run goes on, and one that is read where it is indexed."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from garrison.sizes import require_room

#: bytes of a chunk, about, and the most of one: programs read whole chunks
_CHUNK, _MOST = 4e6, 64e6
#: chunks that wait for the writer
_WAITING = 8


def chunks(shape: tuple[int, ...], itemsize: int) -> tuple[int, ...]:
    """Lengths of the chunks of an array (trial, time, ..): many times of one trial, or many short trials."""
    trials, times, *row = shape
    size = max(1, math.prod(row) * itemsize)
    length = max(1, min(times, int(_CHUNK // size)))
    together = 1 if length < times else min(trials, max(1, int(_CHUNK // (times * size))))
    parts = math.ceil(size / _MOST)
    return (together, length, -(-row[0] // parts), *row[1:])


class Writer:
    """Writes chunks in a thread of its own, so that a run need not wait for the disk; few of them wait for it."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(max_workers=1)
        self._waiting: deque[Future[None]] = deque()

    def put(self, write: Callable[[], None]) -> None:
        """Have it done, after all that was put before. Raises what that raised."""
        self._waiting.append(self._thread.submit(write))
        while len(self._waiting) > _WAITING or (self._waiting and self._waiting[0].done()):
            self._waiting.popleft().result()

    def finish(self) -> None:
        """Wait until all is done. Raises what it raised."""
        while self._waiting:
            self._waiting.popleft().result()

    def close(self) -> None:
        """Do nothing more."""
        self._thread.shutdown(wait=True, cancel_futures=True)


class Growing:
    """An array (trial, time, ..) of a store, written chunk by whole chunk as its rows come.

    Of each trial they come in order of time; of several trials in any order. Memory holds the chunks that are not whole
    yet: one per trial that runs; and those that wait for the writer. Chunks are written as zarr's format 2 has them,
    because zarr would wait for each.
    """

    def __init__(self, array: Any, axes: tuple[str, ...], folder: Path, codec: Any, writer: Writer) -> None:
        self.array, self.axes = array, axes
        self._folder, self._codec, self._writer = folder, codec, writer
        self._open: dict[tuple[int, int], tuple[NDArray[Any], int]] = {}
        self._spare: list[NDArray[Any]] = []

    def put(self, trial: int, start: int, rows: NDArray[Any]) -> None:
        """Take rows from time `start` on."""
        together, length = self.array.chunks[:2]
        while len(rows):
            whole = start // length
            here = rows[: (whole + 1) * length - start]
            self._add(trial, (trial // together, whole), start, here)
            start, rows = start + len(here), rows[len(here) :]

    def _add(self, trial: int, key: tuple[int, int], start: int, rows: NDArray[Any]) -> None:
        trials, times = (
            slice(k * n, min((k + 1) * n, most))
            for k, n, most in zip(key, self.array.chunks, self.array.shape, strict=False)
        )
        shape = (trials.stop - trials.start, times.stop - times.start)
        buffer, missing = self._open.pop(key, None) or (self._buffer(), shape[0] * shape[1])
        at = start - times.start
        buffer[trial - trials.start, at : at + len(rows)] = rows
        missing -= len(rows)
        if missing:
            self._open[key] = buffer, missing
            return
        buffer[shape[0] :], buffer[:, shape[1] :] = 0, 0  # chunks at the end are as long as all others
        self._writer.put(partial(self._write, key, buffer))

    def _write(self, key: tuple[int, int], buffer: NDArray[Any]) -> None:
        width = self.array.chunks[2]
        for k, first in enumerate(range(0, buffer.shape[2], width)):
            part = buffer[:, :, first : first + width]
            if part.shape[2] < width:
                part = np.pad(part, [(0, 0), (0, 0), (0, width - part.shape[2]), *[(0, 0)] * (part.ndim - 3)])
            name = ".".join(map(str, (*key, k, *[0] * (part.ndim - 3))))
            (self._folder / name).write_bytes(self._codec.encode(np.ascontiguousarray(part)))
        self._spare.append(buffer)

    def _buffer(self) -> NDArray[Any]:
        """Memory of a chunk, of an earlier one where there is one."""
        if self._spare:
            return self._spare.pop()
        return np.empty((*self.array.chunks[:2], *self.array.shape[2:]), self.array.dtype)


class StoredArray(np.lib.mixins.NDArrayOperatorsMixin):
    """An array in a store: what is indexed is read, and nothing else; in a computation all of it."""

    def __init__(self, array: Any, name: str) -> None:
        self._array, self._name = array, name

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of its axes."""
        return tuple(self._array.shape)

    @property
    def ndim(self) -> int:
        """How many axes it has."""
        return len(self.shape)

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of its numbers."""
        found: np.dtype[Any] = self._array.dtype
        return found

    def __len__(self) -> int:
        return self.shape[0]

    def __getitem__(self, key: Any) -> Any:
        parts = key if isinstance(key, tuple) else (key,)
        if all(map(_plain, parts)):
            return self._array[key]
        return np.asarray(self)[key]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        require_room(self._name, self._array, self.dtype.itemsize / 8.0)
        return np.asarray(self._array[...], dtype=dtype)

    def __array_ufunc__(self, ufunc: Any, method: str, *given: Any, **more: Any) -> Any:
        given = tuple(np.asarray(one) if isinstance(one, StoredArray) else one for one in given)
        return getattr(ufunc, method)(*given, **more)

    def __repr__(self) -> str:
        return f"<{self._name}: {self.dtype} {self.shape}, in a store; np.asarray reads it>"


def _plain(key: Any) -> bool:
    """Whether an index is one that every store knows: a number, a range forwards, or `...`."""
    if isinstance(key, slice):
        return key.step is None or key.step > 0
    return key is Ellipsis or (isinstance(key, (int, np.integer)) and not isinstance(key, bool))
