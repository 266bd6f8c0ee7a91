"""What a filter says of a sensor at a sample."""

from garrison.words import Word


class Verdict(Word):
    """The values of `Run.verdict`. NOT_TESTED never means cleared.

    Attributes
    ----------
    CLEARED : 0
        Its measurement was used as it is.
    SUSPECTED : 1
        Its measurement was clipped, or a test was above its threshold once.
    ATTACKED : 2
        The filter takes it for attacked and isolates it, or raises an alarm.
    SILENT : 3
        It had no measurement: a relay, or lost.
    NOT_TESTED : 4
        The filter could not, or does not, test it.
    """

    CLEARED = 0
    SUSPECTED = 1
    ATTACKED = 2
    SILENT = 3
    NOT_TESTED = 4
