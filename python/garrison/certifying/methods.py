"""The two ways of gr.certify through a record: a bank of filters, and windows."""

from __future__ import annotations

from collections.abc import Callable
from math import comb

import numpy as np
from numpy.typing import NDArray

from garrison import _core
from garrison._core import certificate
from garrison.certifying.listening import Listener
from garrison.certifying.plant import Levels, Plant

Array = NDArray[np.float64]

#: sets of sources left out up to which a window goes through all of them; beyond, a search goes as far as it can
MOST_SETS = 500
#: leaves of that search, and leaves times unknowns times unknowns and rows that are worth a third of a second a sample
_LEAVES = 20
_MOST_SEARCH = 2e8
#: failure probability of the tests of banks that only listen: small beside that of what they are to say
_LISTENING = 1e-6
#: pairs of sets, times states cubed, up to which the bank's half widths for ever are worked out: about a second
_MOST_PAIRS = 2e6
#: pairs of sets, times unknowns times unknowns and rows, up to which those of a window are: likewise
_MOST_WINDOW = 5e8


class Record:
    """What is sure at every sample, filled in as it is found."""

    def __init__(self, samples: int, n: int) -> None:
        self.center = np.full((samples, n), np.nan)
        self.box = np.full((samples, n), np.inf)
        self.radius = np.full(samples, np.inf)
        self.proved: list[list[int]] = [[] for _ in range(samples)]
        #: (sample, state) where the region and that of the sample alone had no point in common
        self.apart: list[tuple[int, int]] = []
        #: what innovations say against white noise: evidence, source, correlation, pairs
        self.dependence = (-np.inf, -1, 0.0, 0.0)

    def take(self, t: int, found: certificate.WindowWitness, last: int = -1) -> bool:
        """Whether there is a region. last: the step of a window that is sample t."""
        self.radius[t] = found.radius
        self.proved[t] = list(found.proved) or list(found.proved_at.get(last, []))
        if found.center is None or found.box is None:
            self.box[t] = found.radius
            return False
        self.center[t], self.box[t] = found.center, found.box
        return True

    def agrees(self, t: int, found: certificate.Region, alone: certificate.Region) -> bool:
        """Whether the region of sample t and that of the sample alone have a point in common; else there is none."""
        if not (found.answered and alone.answered) or not certificate.intersection([found, alone]).refuted:
            return True
        assert alone.center is not None and alone.box is not None  # it has answered
        gap = np.abs(alone.center - self.center[t]) - alone.box - self.box[t]
        self.apart.append((t, int(np.argmax(gap))))
        self.center[t] = self.box[t] = self.radius[t] = np.nan
        self.proved[t] = []
        return False


def rule(plant: Plant, s: int, moving: bool, length: int) -> tuple[str, int]:
    """Which theorem a window of so many samples uses (docs/certificates.md, section 8), and the leaves of A."""
    if moving:
        return "W2M, moving liars", 0
    if comb(len(plant.names), s) <= MOST_SETS:
        return "W3M", 0
    unknowns = plant.n + (length - 1) * plant.root.shape[1]
    rows = unknowns + length * len(plant.rows)
    leaves = min(_LEAVES, int(_MOST_SEARCH / (unknowns**2 * rows)))
    return (f"A, {leaves} leaves", leaves) if leaves > 1 else ("W2M", 0)


def in_window(
    plant: Plant, y: Array, moved: Array, s: int, levels: Levels, *, moving: bool
) -> certificate.WindowWitness:
    """What `rule` says over these samples."""
    window = plant.window(y, moved)
    name, leaves = rule(plant, s, moving, len(y))
    if name == "W3M":
        return certificate.subsets_window(window, s, *levels, limit=MOST_SETS)
    if leaves:
        return certificate.anytime_window(window, s, *levels, leaves=leaves)
    return certificate.leverage_window(window, s, *levels, moving=moving)


def alone(plant: Plant, y: Array, s: int, failure: float) -> certificate.Region:
    """What one sample (1, outputs) says: it assumes less than any memory. Leverages, where there are many sets."""
    levels = certificate.window_levels(failure, max(y.size, 1), plant.n)
    window = plant.window(y, np.zeros((1, plant.n)))
    if comb(len(plant.names), s) > MOST_SETS:
        return certificate.leverage_window(window, s, *levels).region
    return certificate.subsets_window(window, s, *levels, limit=MOST_SETS).region


def by_window(
    plant: Plant,
    y: Array,
    moved: Array,
    s: int,
    failure: float,
    length: int,
    moving: bool,
    limit: int,
    tell: Callable[[int], None],
) -> Record:
    """A window of the last samples for every sample: nothing older counts. moved: what known inputs add to its state.

    Where the liars are always the same, what windows take for white noise is tested over the whole record.
    """
    record = Record(len(y), plant.n)
    listener = None
    if s == 0 or not moving:
        listener = Listener(plant, s, bank_levels(_LISTENING, len(y), y.shape[1], plant.n), limit)
    for t in range(len(y)):
        taken = slice(max(0, t + 1 - length), t + 1)
        part = y[taken]
        levels = certificate.window_levels(failure, max(part.size, 1), plant.n)
        found = in_window(plant, part, moved[taken], s, levels, moving=moving)
        if record.take(t, found, last=len(part) - 1) and plant.seen_at_once and len(part) > 1:
            record.agrees(t, found.region, alone(plant, y[t : t + 1], s, failure))
        if listener:
            listener.hear(y[t, plant.order], moved[t])
        tell(t + 1)
    if listener:
        record.dependence = listener.dependence
    return record


def bank_levels(failure: float, samples: int, outputs: int, n: int) -> Levels:
    """Theorem B, section 9: the member that is right has to pass the tests of all samples so far."""
    tests = certificate.two_sided(failure / 4.0 / max(samples * outputs, 1))
    return tests, certificate.chi(failure / 8.0, n), certificate.two_sided(failure / 8.0 / n)


def by_bank(
    plant: Plant,
    y: Array,
    moved: Array,
    s: int,
    failure: float,
    length: int,
    start: tuple[Array, Array] | None,
    limit: int,
    tell: Callable[[int], None],
) -> Record:
    """A bank over all samples, started from `start` or from the first window that answers; anew once it is refuted.

    At most `failure` for the region of a sample: a quarter for the tests of the member that is right, over all samples;
    a quarter for its region now; a quarter for the windows that a bank may start from, one a sample; the last one for
    what all samples say alone, with which it is compared.
    """
    record = Record(len(y), plant.n)
    bank = plant.bank(s, limit)
    levels = bank_levels(failure, len(y), y.shape[1], plant.n)
    ordered = y[:, plant.order]
    running, first = start is not None, 0
    if start is not None:
        bank.start_gaussian(*start)
    for t in range(len(y)):
        if running:
            found = bank.update(ordered[t], *levels, u=moved[t], predict=not (t == 0 and start is not None))
            running = record.take(t, found)
            if running and plant.seen_at_once:
                one = alone(plant, y[t : t + 1], s, failure / 4.0 / len(y))
                running = record.agrees(t, found.region, one)
            first = t + 1
        else:
            taken = slice(max(first, t + 1 - length), t + 1)
            part = y[taken]
            share = certificate.window_levels(failure / 4.0 / len(y), max(part.size, 1), plant.n)
            found = in_window(plant, part, moved[taken], s, share, moving=False)
            running = record.take(t, found)
            if running:
                bank.restart(found.region)
            elif np.isnan(found.radius):
                first = t + 1
        tell(t + 1)
    record.dependence = bank.dependence
    return record


def _pairs(m: int, s: int) -> int:
    """Sets of s of m sources, times sets of s of the others; 0 where there are none."""
    return comb(m, s) * comb(m - s, s) if m >= 2 * s else 0


def steady(plant: Plant, s: int, failure: float, samples: int) -> Array | None:
    """Theorem B2; None where too many pairs of sets would have to be gone through."""
    members, pairs = comb(len(plant.names), s), _pairs(len(plant.names), s)
    if pairs == 0:
        return np.full(plant.n, np.inf)
    if pairs * plant.n**3 > _MOST_PAIRS:
        return None
    z1, _, _ = bank_levels(failure, samples, len(plant.rows), plant.n)
    z2 = certificate.chi(failure / 8.0 / members, plant.n)
    zc = certificate.two_sided(failure / 8.0 / plant.n / members)
    try:
        return plant.steady(s, (z1, z2, zc), pairs)
    except _core.InvalidInput:
        return None


def steady_window(plant: Plant, s: int, failure: float, length: int) -> Array | None:
    """Theorem W3D, of windows that go through all sets; None where they do not, or where there are too many pairs."""
    members, pairs = comb(len(plant.names), s), _pairs(len(plant.names), s)
    if pairs == 0:
        return np.full(plant.n, np.inf)
    window = plant.window(np.zeros((length, len(plant.rows))), np.zeros((length, plant.n)))
    unknowns = plant.n + (length - 1) * plant.root.shape[1]
    if members > MOST_SETS or pairs * unknowns**2 * (unknowns + window.rows) > _MOST_WINDOW:
        return None
    z1, _, _ = certificate.window_levels(failure, length * len(plant.rows), plant.n)
    zc = certificate.two_sided(failure / 3.0 / plant.n / members)
    return np.asarray(certificate.subsets_window_width(window, s, z1, zc, limit=pairs))
