"""Phrases that readers stumbled over do not come back."""

import re
from pathlib import Path

import pytest
from conftest import ROOT

#: phrase -> what is written instead
BANNED = {
    "our notes": "the paper or theorem, or docs/filters/<family>.md#anchor",
    "(notes, item": "docs/filters/<family>.md#anchor",
    "of the notes": "docs/filters/<family>.md#anchor",
    "see the C++ header": "what the header says",
    "got something else": "what was got",
    "the answer is no": "a check failed",
    "hijacked in truth": "actually attacked",
    "is being held back": "sensors whose measurements were clipped",
    "who did how well": "results by filter",
    "for machines": "as JSON",
    "is called now and then": "how often it is called",
    "indispensable": "necessary",
    "got nothing": "got no value",
    "expected a text": "expected a string",
    "could lie unseen": "could drift without limit, unseen",
    "innovation that is used in full": "innovations above this are clipped",
    "believes to be attacked": "has accused",
    "to its own plant until": "the control input until",
    "proves who": "identifies",
    "proves which": "identifies",
    "every gain with a stable": "gains are accepted only if the error dynamics are stable",
    "is printed only in a reading": "we print a bound only if it is proved",
    "overlapping ones joined": "measure at least one state of each of these groups",
    "knows all attackers": "has identified all attackers",
    "row(s)": "words.count: 1 row, 2 rows",
    "column(s)": "words.count",
    "trial(s)": "words.count",
    "output of unit length": "one measurement row of norm 1 per agent",
    "believes all of them": "uses every measurement as it comes",
    "are used up to this size": "innovations above this are clipped",
    "can be told": "can be determined",
    "could not be told": "could not be determined",
    "is not told": "is not reported",
    "always the same lie": "the liars are always the same",
    "lie told to": "lie sent to",
    "filter was told": "what the model or a parameter says",
    "same arguments, same bits": "equal arguments give bit-identical results",
}
_FOLDERS = ("README.md", "CONTRIBUTING.md", "docs", "python", "include", "src", "bindings", "examples", "tests/cpp")
_SUFFIXES = (".md", ".py", ".pyi", ".hpp", ".cpp", ".toml")


def _files() -> list[Path]:
    found = []
    for name in _FOLDERS:
        path = ROOT / name
        found += [path] if path.is_file() else sorted(p for p in path.rglob("*") if p.suffix in _SUFFIXES)
    return [p for p in found if "generated" not in p.parts]


def _hits(path: Path) -> set[str]:
    text = re.sub(r"\s*(///?<?|#|\*)?\s+", " ", path.read_text(encoding="utf-8")).lower()
    return {phrase for phrase in BANNED if phrase.lower() in text}


def test_no_file_holds_a_banned_phrase() -> None:
    found = {(str(p.relative_to(ROOT)), phrase) for p in _files() for phrase in _hits(p)}
    lines = [f"{name}: {phrase!r}; better: {BANNED[phrase]}" for name, phrase in sorted(found)]
    assert not lines, "\n".join(lines)


@pytest.mark.parametrize("phrase", BANNED)
def test_a_phrase_is_found_across_lines_of_a_comment(phrase: str, tmp_path: Path) -> None:
    path = tmp_path / "x.hpp"
    path.write_text("/// Some words " + phrase.replace(" ", "\n/// ") + " and more.\n")
    assert _hits(path) == {phrase}


def test_nothing_refers_to_a_note_by_its_number() -> None:
    by_number = re.compile(r"\bnotes? \d+\b")
    found = [str(p.relative_to(ROOT)) for p in _files() if by_number.search(p.read_text(encoding="utf-8"))]
    assert not found, "better: docs/filters/<family>.md#anchor, in " + ", ".join(found)
