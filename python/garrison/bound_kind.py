"""Where a bound comes from, or why there is none."""

import numpy as np
from numpy.typing import NDArray

from garrison.words import Word


class BoundKind(Word):
    """The values of `Run.bound_kind`. Proofs: docs/certificates.md.

    Attributes
    ----------
    NONE : 0
        No certificate was asked for, and the filter promises nothing here.
    PUBLISHED : 1
        The filter family's own.
    WITNESS : 2
        The measurements of this sample that reached the agent.
    RELAYED : 3
        What another agent, or an earlier sample, has shown.
    TABLE : 4
        Data-free.
    INFORMED : 5
        Data-free, all attackers are proved.
    RECOVERED : 6
        The table, and what lost messages may have added to it.
    TOO_FEW : 7
        None (inf): too few measurements reached the agent, in this sample and all before.
    REFUTED : 8
        None (nan): the data contradict "at most so many are attacked".
    LIARS : 9
        None (nan): agents lie in their messages, and bounds rest on what they say.
    VARYING : 10
        None (nan): A or C changes in time or the plant is nonlinear; theorems need a constant linear one.
    MEMORY : 11
        All measurements that reached the agent so far.
    """

    NONE = 0
    PUBLISHED = 1
    WITNESS = 2
    RELAYED = 3
    TABLE = 4
    INFORMED = 5
    RECOVERED = 6
    TOO_FEW = 7
    REFUTED = 8
    LIARS = 9
    VARYING = 10
    MEMORY = 11

    @property
    def why(self) -> str:
        """Why there is no bound, in a sentence; empty where there is one."""
        return _WHY.get(self, "")


_WHY = {
    BoundKind.NONE: "no certificate was asked for, and the filter promises nothing at this sample: a condition of its "
    "theorem is not met, or what the theorem needs was lost, such as a message",
    BoundKind.TOO_FEW: "too few measurements have reached this agent, at this sample and all before: without those of "
    "the attackers the rest does not determine the state (where the plant changes or is nonlinear, earlier ones count "
    "with memory alone, and of a nonlinear one its linear outputs)",
    BoundKind.REFUTED: "the measurements contradict the assumption that at most so many are attacked (or the rare "
    "event happened that the failure probability allows)",
    BoundKind.LIARS: "agents lie in their messages, and this bound rests on what they say (those of "
    'certificate = "direct" do not)',
    BoundKind.VARYING: "the plant changes in time, or is nonlinear, and the theorem behind the filter's bound needs a "
    "constant linear one (rows that come and go can be constant outputs with nan: then it holds)",
}


def counts(kinds: NDArray[np.uint8]) -> dict[str, int]:
    """Word -> how often, of those that occur."""
    found = np.bincount(kinds.ravel(), minlength=len(BoundKind))
    return {BoundKind(k).word: int(v) for k, v in enumerate(found) if v}
