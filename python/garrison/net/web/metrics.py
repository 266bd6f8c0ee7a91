"""Statuses of nodes in the text format of Prometheus (version 0.0.4)."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

#: counters of a status -> metric and what it counts
_COUNTERS = {
    "samples": ("samples_total", "samples that ended"),
    "complete": ("complete_total", "samples in which every message of every round was there"),
    "missing": ("missing_messages_total", "messages that a round ended without"),
    "missed_samples": ("missed_samples_total", "samples that went by without this node"),
    "unmeasured": ("unmeasured_total", "samples without a measurement"),
    "overruns": ("overruns_total", "samples that the next one's begin ended"),
    "wants": ("wants_total", "messages that were asked for again"),
    "resent": ("resent_total", "messages that were sent again"),
    "joins": ("joins_total", "how often the node has joined a running network"),
    "resets": ("resets_total", "estimates that were of no use"),
    "clock_steps": ("clock_steps_total", "jumps of the clock"),
    "clock_back": ("clock_back_total", "jumps behind what had been sent"),
    "unsent": ("unsent_total", "datagrams that the system did not take"),
    "statements": ("statements_total", "signed statements of others"),
    "contradictions": ("contradictions_total", "senders that signed two different statements about the same samples"),
    "disowned": ("disowned_total", "statements of neighbours about something else than what they sent here"),
    "log_gaps": ("log_gaps_total", "times the log had to begin anew"),
}
#: the same, of what the daemon itself counts
_OF_DAEMON = {
    "log_failed": ("log_failed_total", "writes of the log that the disk did not take"),
    "states_refused": ("states_refused_total", "states of an earlier life that could not be used"),
}
#: numbers of a status -> metric and what it is; missing where there is none
_GAUGES = {
    "t": ("sample", "the last sample that ended"),
    "bound": ("bound", "certified bound on the error of the estimate"),
    "statistic": ("statistic", "what is tested"),
    "threshold": ("threshold", "what it is tested against"),
    "took_ms": ("sample_milliseconds", "from the begin of the last sample to its end"),
    "snapshot_age_s": ("snapshot_age_seconds", "age of the last snapshot"),
}
_LINK_GAUGES = {
    "age_s": ("link_age_seconds", "since the last genuine frame"),
    "skew_us": ("link_skew_microseconds", "its clock less ours"),
    "delay_us": ("link_delay_microseconds", "how long the link takes"),
}
#: bound, bound_kind, state of a link and reachability are values of their own
_STATES = {"down": 0, "absent": 1, "up": 2}


def exposition(statuses: Mapping[str, dict[str, Any] | None]) -> str:
    """One text for all nodes. statuses: name of a node -> its status, None = it does not answer."""
    lines: list[str] = []
    known = {name: status for name, status in statuses.items() if status is not None}
    _family(lines, "up", "gauge", "whether the node answers", _up(statuses))
    for key, (metric, what) in _COUNTERS.items():
        _family(lines, metric, "counter", what, _counters(known, key))
    for key, (metric, what) in _OF_DAEMON.items():
        _family(lines, metric, "counter", what, _gauges(known, key))
    for key, (metric, what) in _GAUGES.items():
        _family(lines, metric, "gauge", what, _gauges(known, key))
    _family(lines, "accused", "gauge", "sensors that the node takes for attacked", _sizes(known, "accused"))
    _family(lines, "proved", "gauge", "sources that a certificate with memory proves false", _sizes(known, "proved"))
    _family(lines, "sensor_lines_total", "counter", "lines of the sensor, by what became of them", _sensor(known))
    _family(lines, "link_state", "gauge", "0 down, 1 absent, 2 up", _link_states(known))
    for key, (metric, what) in _LINK_GAUGES.items():
        _family(lines, metric, "gauge", what, _links(known, key))
    _family(lines, "frames_total", "counter", "datagrams by what became of them", _fates(known))
    return "\n".join([*lines, ""])


Samples = Iterator[tuple[dict[str, str], float]]
Statuses = Mapping[str, dict[str, Any]]


def _family(lines: list[str], name: str, kind: str, what: str, samples: Iterable[tuple[dict[str, str], float]]) -> None:
    lines += [f"# HELP garrison_{name} {what}", f"# TYPE garrison_{name} {kind}"]
    for labels, value in samples:
        inside = ",".join(f'{key}="{_escaped(text)}"' for key, text in labels.items())
        lines.append(f"garrison_{name}{{{inside}}} {value:.17g}")


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n")


def _up(statuses: Mapping[str, dict[str, Any] | None]) -> Samples:
    for name, status in statuses.items():
        yield {"node": name}, float(status is not None)


def _counters(known: Statuses, key: str) -> Samples:
    for name, status in known.items():
        yield {"node": name}, status["counters"][key]


def _gauges(known: Statuses, key: str) -> Samples:
    for name, status in known.items():
        if status[key] is not None:
            yield {"node": name}, status[key]


def _sizes(known: Statuses, key: str) -> Samples:
    for name, status in known.items():
        yield {"node": name}, len(status[key])


def _sensor(known: Statuses) -> Samples:
    for name, status in known.items():
        for fate, count in status["sensor"].items():
            yield {"node": name, "fate": fate}, count


def _link_states(known: Statuses) -> Samples:
    for name, status in known.items():
        for link in status["links"]:
            yield {"node": name, "peer": link["name"]}, _STATES[link["state"]]


def _links(known: Statuses, key: str) -> Samples:
    for name, status in known.items():
        for link in status["links"]:
            if link[key] is not None:
                yield {"node": name, "peer": link["name"]}, link[key]


def _fates(known: Statuses) -> Samples:
    for name, status in known.items():
        for fate, count in status["outside"].items():
            yield {"node": name, "peer": "", "fate": fate}, count
        for link in status["links"]:
            for fate, count in link["fates"].items():
                yield {"node": name, "peer": link["name"], "fate": fate}, count
