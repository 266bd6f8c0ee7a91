"""Every family of `families.hpp` has all that a filter needs outside the code: CONTRIBUTING's steps 4 and 5."""

import re

import pytest
from conftest import ROOT
from garrison.filters import FAMILIES

PAGES = ROOT / "docs" / "filters"
#: filters with a page of their own; the others are baselines, on one page together
OWN_PAGE = sorted(p.stem for p in PAGES.glob("*.md") if p.stem not in ("index", "baselines"))


def words(name: str) -> str:
    """ScalarGain -> scalar_gain, as families are called in scenarios and files."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower()


@pytest.mark.parametrize("name", FAMILIES)
def test_a_family_is_shown_and_described(name: str) -> None:
    readme = (ROOT / "README.md").read_text()
    assert f"| `{name}` |" in readme, f"README.md: the table of filters has no row for {name}"
    heading = f"\n## {words(name).replace('_', ' ').capitalize()}\n"
    described = words(name) in OWN_PAGE or heading in (PAGES / "baselines.md").read_text()
    assert described, (
        f"{name}: expected docs/filters/{words(name)}.md, or the heading {heading!r} in baselines.md there"
    )


@pytest.mark.parametrize("family", OWN_PAGE)
def test_a_family_with_a_page_has_cases_their_reader_and_its_paper_gone_through(family: str) -> None:
    assert family in map(words, FAMILIES), f"docs/filters/{family}.md describes a filter that does not exist"
    assert list((ROOT / "tests" / "cases" / family).glob("*.json")), f"tests/cases/{family} holds no case"
    for part in (f"python/garrison/verify/{family}.py", f"examples/papers/{family}.py"):
        assert (ROOT / part).is_file(), f"{part} is missing"
    own = list((ROOT / "tests" / "cpp" / "filters" / family).glob("*_test.cpp"))
    assert own, f"tests/cpp/filters/{family} holds no test: a search for a violated promise on random systems"
    assert f"]({family}.md)" in (PAGES / "index.md").read_text(), f"docs/filters/index.md does not lead to {family}.md"
