"""What a filter says of a sensor at a sample."""

from garrison.words import Word


class Verdict(Word):
    """The values of `Run.verdict`. NOT_TESTED never means cleared."""

    CLEARED = 0  #: its measurement was used as it is
    SUSPECTED = 1  #: its measurement was clipped, or a test was above its threshold once
    ATTACKED = 2  #: the filter takes it for attacked and isolates it, or raises an alarm
    SILENT = 3  #: it had no measurement: a relay, or lost
    NOT_TESTED = 4  #: the filter could not, or does not, test it
