"""The site: every code block runs, every reference from the code to a page resolves, every filter has its page."""

import re
from pathlib import Path

import documents
import pytest
from conftest import ROOT
from garrison import _core

_RUN = [  # test_readme.py runs the README
    page for page in documents.pages()[1:] if any(b.language in ("python", "shell") for b in documents.blocks(page))
]
_NEEDED = {"long-runs.md": "zarr"}
_CODE = ("include", "src", "bindings", "python", "examples", "tests/cpp", "tests/python")
_REFERENCE = re.compile(r"docs/((?:[\w-]+/)*[\w-]+\.md)(?:#([\w-]+))?")


def _name(page: Path) -> str:
    return str(page.relative_to(ROOT))


@pytest.mark.parametrize("page", _RUN, ids=_name)
def test_the_code_of_a_page_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if needed := _NEEDED.get(page.name):
        pytest.importorskip(needed, minversion="3")
    monkeypatch.chdir(tmp_path)
    documents.run(page, tmp_path)


@pytest.mark.parametrize("page", documents.pages(), ids=_name)
def test_every_block_says_what_it_is(page: Path) -> None:
    unknown = [(b.line, b.language) for b in documents.blocks(page) if b.language not in documents.LANGUAGES]
    known = ", ".join(sorted(documents.LANGUAGES))
    assert page.name == "README.md" or not unknown, f"{page.name}: got blocks {unknown}, expected one of {known}"


def test_a_failing_block_is_seen(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("```shell\ngarrison check absent.toml\n```\n")
    with pytest.raises(AssertionError, match=r"page\.md:1: exit code 2"):
        documents.run(page, tmp_path)


@pytest.mark.parametrize("page", documents.pages(), ids=_name)
def test_rows_of_tables_are_whole(page: Path) -> None:
    lines = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL).splitlines()
    wrong, width = [], 0
    for line in lines:
        cells = len(re.findall(r"(?<!\\)\|", line)) if line.startswith("|") else 0
        width = cells if not width or not cells else width
        if cells != width:
            wrong.append(line)
        width = width if cells else 0
    assert not wrong, "a | in a cell is written \\|: " + "\n".join(wrong)


def _anchors(page: Path) -> set[str]:
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    titles = re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)
    slugs = {re.sub(r"[^\w\- ]", "", title.lower()).strip().replace(" ", "-") for title in titles}
    return slugs | set(re.findall(r"^\(([\w-]+)\)=$", text, flags=re.MULTILINE))


def test_references_from_code_to_pages_resolve() -> None:
    missing = []
    for folder in _CODE:
        for path in sorted((ROOT / folder).rglob("*")):
            if path.suffix not in (".hpp", ".cpp", ".py", ".pyi", ".toml", ".md") or path.name == "test_docs.py":
                continue
            for name, anchor in _REFERENCE.findall(path.read_text(encoding="utf-8")):
                page = ROOT / "docs" / name
                if not page.is_file() or (anchor and anchor not in _anchors(page)):
                    missing.append(f"{path.relative_to(ROOT)}: docs/{name}#{anchor}")
    assert not missing, "\n".join(missing)


def test_every_filter_has_a_page_with_its_parameters() -> None:
    text = "".join(p.read_text(encoding="utf-8") for p in (ROOT / "docs" / "filters").glob("*.md"))
    for info in _core.filter_infos():
        assert f"generated/parameters_{info['name']}.md" in text, f"docs/filters: no page shows {info['name']}"


def test_every_field_of_a_message_is_on_a_page_of_the_filters() -> None:
    """What an agent can lie in."""
    headers = (path.read_text(encoding="utf-8") for path in (ROOT / "include/garrison/filters").rglob("*.hpp"))
    listed = re.compile(r"""v\.(?:numbers|optional|sparse|flag|count|set|labels)\("(\w+)""")
    fields = {name for text in headers for name in listed.findall(text)}
    assert {"estimate", "proved", "information", "shared", "rest", "attacked"} <= fields
    pages = "".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs/filters").glob("*.md"))
    assert [name for name in sorted(fields) if f"`{name}`" not in pages] == []


def test_every_class_of_the_headers_says_how_threads_may_use_it() -> None:
    # Not the specialisations of a template, nor the classes inside of one.
    template = r"(?:template <.*\n(?:  requires .*\n)?)?"
    opening = re.compile(rf"^(.*)\n{template}class (?:GARRISON_EXPORT )?(\w+)(?: final)?(?: : .*)? \{{$", re.MULTILINE)
    found = [
        (path.name, name, before)
        for path in sorted((ROOT / "include").rglob("*.hpp"))
        for before, name in opening.findall(path.read_text(encoding="utf-8"))
    ]
    assert len(found) > 60
    silent = [(file, name) for file, name, before in found if not before.startswith("/// Threads: ")]
    assert not silent, f'got {silent}, expected "/// Threads: ..." as the last line above the class'


def test_every_extra_for_users_is_on_the_page_of_the_installation() -> None:
    import tomllib

    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    page = (ROOT / "docs" / "install.md").read_text(encoding="utf-8")
    assert [name for name in extras if name not in ("dev", "bench") and f"`{name}`" not in page] == []
