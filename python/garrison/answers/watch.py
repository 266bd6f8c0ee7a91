"""The time of an analysis: shared out among its questions, with progress, and ended by Ctrl-C."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from garrison import _core

Progress = Callable[[str, int, int], None]


class Watch:
    """Seconds for all questions together; every question gets a share of what is left."""

    def __init__(self, seconds: float, questions: int, progress: Progress | None) -> None:
        self._end = time.monotonic() + seconds
        self._questions = questions
        self._progress = progress
        self._asked = 0

    @property
    def left(self) -> float:
        """Seconds until the end, at least one millisecond."""
        return max(self._end - time.monotonic(), 1e-3)

    @contextmanager
    def question(self, words: str, share: float = 0.5) -> Iterator[Any]:
        """The budget of one question; a computation without a partial result just ends when it is over."""
        if self._progress is not None:
            self._progress(words, self._asked, self._questions)
        self._asked += 1
        seconds = self.left * share
        end = time.monotonic() + seconds
        budget = _core.budget(seconds)
        with suppress(Unfinished), budget:
            try:
                yield budget
            except _core.InvalidInput as refused:
                # A check inside has a budget of its own, which ends no sooner than this one.
                if not budget.over and time.monotonic() < end:
                    raise
                raise Unfinished from refused

    def done(self) -> None:
        """All questions are answered."""
        if self._progress is not None:
            self._progress("done", self._questions, self._questions)


class Unfinished(Exception):
    """The time of a question is up."""
