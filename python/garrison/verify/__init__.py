"""Replay of reference cases: does this build compute what it should?

A case file is a JSON object with `inputs` and `expected`; a file with `must` instead of `expected` holds bad input
that has to be refused or survived. Files are read by content, whatever their names.
"""

import json
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

from garrison._core import Error, IoError
from garrison.files import contents
from garrison.verify import certificates, partial_sharing, platoon, rdkf, saturation, structural
from garrison.verify.bad import judge
from garrison.verify.compare import FieldResult, compare
from garrison.verify.shapes import words

#: name of the paper in a case file -> module that recomputes its cases
FAMILIES = {
    "he_secure": saturation,
    "dutta_rdkf": rdkf,
    "he_platoon": platoon,
    "moradi_brcdf": partial_sharing,
    "doost_structural": structural,
    "certificates": certificates,
}


@dataclass
class FileResult:
    """All fields of one file."""

    file: str
    family: str
    fields: list[FieldResult] = field(default_factory=list)

    @property
    def misses(self) -> int:
        """Fields that deviate too much or were not understood."""
        return sum(not f.ok for f in self.fields)


def _family(case: dict[str, Any], path: Path) -> str:
    """Name of the paper: said in the file, else recognised by the inputs that only this family has."""
    if isinstance(case.get("paper"), str):
        return str(case["paper"])
    inputs = case.get("inputs", {})
    inputs = inputs[0] if isinstance(inputs, list) and inputs else inputs
    for name, module in FAMILIES.items():
        if isinstance(inputs, dict) and _recognises(module, inputs):
            return name
    return "unknown"


def _recognises(module: ModuleType, inputs: dict[str, Any]) -> bool:
    try:
        return bool(module.recognises(inputs))
    except (TypeError, AttributeError):  # entries of other kinds than any family has
        return False


def _template(case: dict[str, Any], family: str, path: Path) -> dict[str, Any]:
    """The case whose use of the inputs a bad one follows; empty when it is not at hand."""
    name = f"{family}_{case.get('template')}.json"
    for folder in (path.parent, path.parent.parent):
        if (folder / name).is_file():
            return dict(json.loads((folder / name).read_text()))
    return {}


def _unread(path: Path, why: str) -> FileResult:
    return FileResult(path.name, "unknown", [FieldResult.failure("file", why)])


def verify_file(path: Path, family: str | None = None) -> FileResult | None:
    """Recompute one file; None when it belongs to another family than the one asked for."""
    try:
        case = json.loads(contents(path).decode("utf-8-sig"))
    except json.JSONDecodeError as error:
        return _unread(path, f"is no JSON from line {error.lineno}, column {error.colno} on")
    except OSError as error:
        return _unread(path, f"cannot be read: {error.strerror or error}")
    except (ValueError, RecursionError):  # bytes that are no text, or nesting without end
        return _unread(path, "is no JSON in UTF-8")
    paper = _family(case, path) if isinstance(case, dict) else "unknown"
    if family is not None and family not in (paper, getattr(FAMILIES.get(paper), "NAME", None)):
        return None
    module = FAMILIES.get(paper)
    if module is None:
        return FileResult(path.name, paper, [FieldResult.failure("family", f"{paper} is not understood")])
    result = FileResult(path.name, module.NAME)
    try:
        if "must" in case:
            result.fields = judge(module, case, _template(case, paper, path))
        elif "inputs" in case and "expected" in case:
            result.fields = compare(
                module.evaluate(case["inputs"], case["expected"]),
                case["expected"],
                module.TOLERANCES,
                informative=frozenset(getattr(module, "INFORMATIVE", ())),
            )
        else:
            result.fields = [FieldResult.failure("file", "has neither expected nor must")]
    except Error as error:
        result.fields.append(FieldResult.failure("file", f"refused: {error}"))
    except Exception as error:  # a case must never stop the replay of the others
        result.fields.append(FieldResult.failure("file", words(case, error)))
    return result


def verify(folder: str | Path, family: str | None = None) -> list[FileResult]:
    """Recompute every case file (*.json) in `folder` and its subfolders, or one file; or only those of one family."""
    root = Path(folder)
    if not root.exists():
        raise IoError(f"{root}: got no such folder or file, expected case files (JSON)")
    paths = sorted(root.rglob("*.json")) if root.is_dir() else [root]
    results = [verify_file(path, family) for path in paths]
    return [result for result in results if result is not None]
