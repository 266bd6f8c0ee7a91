"""Public functions say in numpydoc form what they take, give and raise; the site shows it."""

import ast
import dataclasses
import importlib
import inspect
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import garrison as gr
import pytest
from conftest import ROOT

FUNCTIONS = [name for name in gr.__all__ if inspect.isfunction(getattr(gr, name))]
#: classes of the core that everybody makes
CLASSES = {"Model": gr.Model, "Network": gr.Network}
#: what functions return
RESULTS = [name for name in gr.__all__ if dataclasses.is_dataclass(getattr(gr, name))]
ERRORS = [
    name for name in gr.__all__ if isinstance(getattr(gr, name), type) and issubclass(getattr(gr, name), Exception)
]


def _public(path: str, thing: Any, seen: set[int]) -> Iterator[tuple[str, Any, str]]:
    """(path, function, docstring) of everything public that can be called, below a module or class."""
    if id(thing) in seen:
        return
    seen.add(id(thing))
    if inspect.ismodule(thing):
        for name in getattr(thing, "__all__", [n for n in vars(thing) if not n.startswith("_")]):
            yield from _public(f"{path}.{name}", getattr(thing, name), seen)
    elif inspect.isclass(thing) and thing.__module__.startswith("garrison"):
        doc = inspect.getdoc(thing) or ""
        for name, member in vars(thing).items():
            function = member.__func__ if isinstance(member, staticmethod | classmethod) else member
            if name == "__init__" and "\nAttributes\n" not in doc:  # those are results, which functions make
                yield f"{path}.{name}", function, doc
            elif not name.startswith("_") and callable(function):
                yield f"{path}.{name}", function, inspect.getdoc(function) or ""
    elif callable(thing) and not inspect.isclass(thing):
        yield path, thing, inspect.getdoc(thing) or ""


def _taken(function: Any) -> list[str]:
    """Names of its parameters; of compiled ones from the first line of the docstring."""
    if inspect.isfunction(function):
        found = [name for name in inspect.signature(function).parameters]
    else:
        line = (inspect.getdoc(function) or "").partition("\n")[0].partition(") ->")[0]
        found = re.findall(r"(\w+): ", line)
    return [name for name in found if name not in ("self", "cls")]


def _shown() -> Iterator[tuple[str, Any, str]]:
    """What pages and examples import from submodules."""
    files = [*(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*.py"), ROOT / "README.md"]
    for path in (p for p in files if "generated" not in p.parts):
        text = path.read_text(encoding="utf-8")
        for module, names in re.findall(r"^from (garrison\.[a-z_.]+) import ([\w, ]+)$", text, flags=re.MULTILINE):
            for name in names.split(", "):
                thing = getattr(importlib.import_module(module), name.partition(" ")[0])
                if inspect.isfunction(thing):
                    yield f"{module}.{name}", thing, inspect.getdoc(thing) or ""


EVERYTHING = {
    path: (function, doc) for path, function, doc in (*_public("garrison", gr, set()), *_shown()) if _taken(function)
}


def section(function: Callable[..., Any] | str, name: str) -> list[str]:
    """The lines of one section of a docstring, which may be given itself; empty where there is none."""
    doc = function if isinstance(function, str) else inspect.getdoc(function) or ""
    found = re.search(rf"^{name}\n{'-' * len(name)}\n(.*?)(?=^\w+\n-+\n|\Z)", doc, re.DOTALL | re.MULTILINE)
    return found[1].splitlines() if found else []


def documented(function: Callable[..., Any] | str, what: str = "Parameters") -> dict[str, list[str]]:
    """Name of each documented parameter, or attribute -> the lines about it."""
    out: dict[str, list[str]] = {}
    names: list[str] = []
    for line in section(function, what):
        if line and not line.startswith(" "):
            names = [name.strip().lstrip("*") for name in line.partition(" : ")[0].split(",")]
            out |= {name: [] for name in names}
        elif line.strip():
            for name in names:
                out[name].append(line)
    return out


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_parameter_is_documented_in_its_order(name: str) -> None:
    function = getattr(gr, name)
    taken = list(inspect.signature(function).parameters)
    found = documented(function)
    assert set(found) == set(taken)
    assert all(found.values()), f"parameters without a text: {[k for k, lines in found.items() if not lines]}"
    positional = [p.name for p in inspect.signature(function).parameters.values() if p.kind is p.POSITIONAL_OR_KEYWORD]
    assert list(found)[: len(positional)] == positional


@pytest.mark.parametrize("name", FUNCTIONS)
def test_results_and_refusals_are_documented(name: str) -> None:
    function = getattr(gr, name)
    assert section(function, "Returns") and section(function, "Raises")
    for line in section(function, "Raises"):
        if line and not line.startswith(" "):
            assert issubclass(getattr(gr, line), Exception)


@pytest.mark.parametrize("path", EVERYTHING)
def test_everything_that_takes_arguments_says_what_they_are(path: str) -> None:
    function, doc = EVERYTHING[path]
    found = documented(doc)
    assert set(found) == set(_taken(function))
    assert all(found.values()), f"parameters without a text: {[k for k, lines in found.items() if not lines]}"


def test_everything_public_is_looked_at() -> None:
    for path in (
        "attacks.Bias",
        "filters.Saturation.__init__",
        "saturation.design",
        "structure.System.mitigate",
        "tables.read_records",
    ):
        assert f"garrison.{path}" in EVERYTHING
    assert len(EVERYTHING) > 250


@pytest.mark.parametrize("name", CLASSES)
def test_constructors_are_documented(name: str) -> None:
    stub = ast.parse((Path(gr.__file__).parent / "_core" / "__init__.pyi").read_text(encoding="utf-8"))
    body = next(node.body for node in stub.body if isinstance(node, ast.ClassDef) and node.name == name)
    made = next(node for node in body if isinstance(node, ast.FunctionDef) and node.name == "__init__")
    taken = [a.arg for a in (*made.args.args, *made.args.kwonlyargs) if a.arg != "self"]
    assert list(documented(CLASSES[name])) == taken
    assert section(CLASSES[name], "Raises")


@pytest.mark.parametrize("name", RESULTS)
def test_every_attribute_of_a_result_is_documented(name: str) -> None:
    result = getattr(gr, name)
    found = documented(result, "Attributes")
    assert set(found) == {field.name for field in dataclasses.fields(result)}
    assert all(found.values()), f"attributes without a text: {[k for k, lines in found.items() if not lines]}"


def test_every_attribute_of_a_run_is_documented() -> None:
    model = gr.Model([[1.0]], [[1.0]], process_bound=0.1, measurement_bound=0.1)
    run = gr.simulate(model, gr.Network([], agents=1), gr.filters.ScalarGain(), steps=1)
    found = documented(gr.Run, "Attributes")
    assert set(found) == set(vars(run)) and all(found.values())


@pytest.mark.parametrize("name", ERRORS)
def test_errors_say_what_they_are(name: str) -> None:
    assert (getattr(gr, name).__doc__ or "").endswith(".")


def test_a_missing_parameter_is_seen() -> None:
    def function(a: int, b: int) -> None:
        """One.

        Parameters
        ----------
        a : int
            The first.
        """

    assert documented(function) == {"a": ["    The first."]}


def test_the_site_shows_sections_as_lists(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs"))
    from generate import plain_docstrings

    lines = [
        "One *star*.",
        "",
        "Parameters",
        "----------",
        "x0 : (n,) array",
        "    Start_value.",
        "",
        "Raises",
        "------",
    ]
    lines += ["InvalidInput", "    It does not fit."]
    plain_docstrings.process(None, "", "", None, None, lines)
    text = "\n".join(lines)
    assert "One \\*star\\*." in text
    assert "**Parameters**\n\n**x0** : (n,) array\n   Start\\_value." in text
    assert "**InvalidInput**\n   It does not fit." in text
    assert "-----" not in text
    plain = ["One.", "", "Two."]
    plain_docstrings.process(None, "", "", None, None, plain)
    assert plain == ["One.", "", "Two.", ""]


@pytest.mark.parametrize("name", FUNCTIONS)
def test_signatures_name_array_types_by_one_word(name: str) -> None:
    assert "_SupportsArray" not in str(inspect.signature(getattr(gr, name)))
