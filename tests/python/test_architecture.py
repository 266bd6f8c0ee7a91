"""The layers of the Python package: who may import whom, read from the source."""

import ast
import subprocess
import sys
from collections.abc import Iterable, Iterator

from conftest import ROOT
from garrison import _core

PACKAGE = ROOT / "python" / "garrison"
#: bottom first; a module imports modules of its own layer or below. Packages stand for all that is in them.
LAYERS = (
    ("_core",),
    ("words", "verdict", "bound_kind", "drawing", "files", "result", "shapes", "encoded"),
    ("numeric", "sizes", "storage", "paths", "objects", "filters", "notebook", "alarms"),
    ("arguments", "parameters", "clean", "families", "tables", "longform", "labelled", "labelled_files", "growing"),
    (
        "attacks",
        "varying",
        "varying_noise",
        "varying_network",
        "linear_rows",
        "static_plant",
        "nonlinear",
        "certifying",
    ),
    (
        "bins",
        "reductions",
        "record",
        "recipe",
        "run_file",
        "run_options",
        "store",
        "stored",
        "expected",
        "checks",
        "doubts",
        "refuted",
    ),
    ("drivers", "kalman", "fitting", "fitting_full", "identifying", "calibration", "certificate", "exposing"),
    ("prepared", "designing"),
    ("resilience", "mitigation", "lmi", "scenario", "answers"),
    ("jobs", "anatomy", "sweeps", "comparison", "importers"),
    ("__init__",),  # what a user calls: for those who call it as users do
    ("figures", "report", "verify"),
    ("_commands",),
    ("cli",),
    ("net",),
    ("__main__",),
)
#: the one place where a lower layer imports a higher one, inside a function: results draw themselves
UPWARD = {("drawing", "figures")}
#: packages whose modules nobody below may import at all, but for UPWARD
HEAVY = ("rich", "networkx", "matplotlib", "pandas", "xarray", "scipy")


def modules() -> dict[str, ast.Module]:
    """Name within garrison ("scenario.reader") -> its source; the package itself is left out."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        name = ".".join(p for p in parts if p != "__init__")
        if name:
            found[name] = ast.parse(path.read_text(encoding="utf-8"))
    return found


def imports(name: str, tree: ast.Module, known: set[str]) -> Iterator[str]:
    """Modules of garrison that a module imports when it runs (imports for type checking do not run)."""
    for_types = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        if id(node) in for_types:
            continue
        if isinstance(node, ast.Import):
            named = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{name}: a relative import"
            base = node.module or ""
            named = [f"{base}.{alias.name}" for alias in node.names] if base.split(".")[0] == "garrison" else []
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith("import_module"):
            named = constants(node.args)
        else:
            continue
        for full in named:
            if full.split(".")[0] != "garrison":
                continue
            inside = full.removeprefix("garrison").removeprefix(".")
            while inside and inside not in known and not inside.startswith("_core"):
                inside = inside.rpartition(".")[0]
            yield inside or "__init__"


def graph() -> dict[str, set[str]]:
    """Module -> the modules that it imports, without the compiled core."""
    sources = modules()
    return {
        name: {to for to in imports(name, tree, set(sources)) if to != name and not to.startswith("_core")}
        for name, tree in sources.items()
    }


def layer(name: str) -> int:
    """Number of the layer of a module, from below."""
    top = name.split(".")[0]
    return next(k for k, names in enumerate(LAYERS) if top in names)


def test_every_module_has_a_layer() -> None:
    known = {name for names in LAYERS for name in names}
    assert {name.split(".")[0] for name in modules()} - known == set()


def test_imports_go_down() -> None:
    pairs = [(name, to) for name, found in graph().items() for to in found]
    upward = {(name.split(".")[0], to.split(".")[0]) for name, to in pairs if layer(to) > layer(name)}
    assert upward == UPWARD
    assert len(UPWARD) <= 1


def test_no_import_cycles() -> None:
    edges = {
        name: {to for to in found if (name.split(".")[0], to.split(".")[0]) not in UPWARD}
        for name, found in graph().items()
    }
    done: set[str] = set()

    def visit(name: str, path: tuple[str, ...]) -> None:
        assert name not in path, " -> ".join((*path[path.index(name) :], name))
        if name not in done:
            for to in edges.get(name, ()):
                visit(to, (*path, name))
            done.add(name)

    for name in edges:
        visit(name, ())


def test_importing_garrison_is_light() -> None:
    code = f"import sys, garrison, garrison.cli; print([m for m in {HEAVY!r} if m in sys.modules])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "[]"


def test_nobody_chooses_the_matplotlib_backend_or_uses_pyplot() -> None:
    for name, tree in modules().items():
        calls = [ast.unparse(n.func) for n in ast.walk(tree) if isinstance(n, ast.Call)]
        assert "matplotlib.use" not in calls, name
        used = [ast.unparse(n) for n in ast.walk(tree) if isinstance(n, (ast.Import, ast.ImportFrom))]
        assert not any("pyplot" in line for line in used), name


def test_only_families_ask_for_a_family() -> None:
    """Names and parameters of families are asked for in families/ (and where a function is about one family).

    Nor does anybody else keep a table or list of several of them.
    """
    about_one = {"attacks", "objects"}
    families = {info["name"] for info in _core.filter_infos()}
    classes = {name for name, cls in vars(_core.filters).items() if isinstance(cls, type)}
    general = {"attacked", "false_alarm", "window"}  # mean the same wherever they are
    private = {field["name"] for info in _core.filter_infos() for field in info["params"]} - general
    for name, tree in modules().items():
        if name.split(".")[0] in ("families", "verify", "importers") or name in about_one:
            continue
        for node in ast.walk(tree):
            shown = f"{name}: {ast.unparse(node)}" if isinstance(node, ast.expr) else name
            asked = list(_asked_of_params(node))
            assert not private & set(asked), shown
            assert not isinstance(node, ast.Subscript) or not asked, shown
            if isinstance(node, ast.Compare):
                words = {word for part in node.comparators for word in constants(ast.walk(part))}
                assert not families & words, shown
                assert not (ast.unparse(node.left).endswith(".ndim") and ast.unparse(node.comparators[0]) == "4"), shown
            if isinstance(node, ast.MatchValue):
                assert not families & set(constants([node.value])), name
            if isinstance(node, ast.Attribute) and ast.unparse(node.value).endswith("_core.filters"):
                assert node.attr not in classes, shown
            if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("name.startswith"):
                starts = constants(node.args)
                assert not any(f.startswith(w) for f in families for w in starts), shown
            listed = node.keys if isinstance(node, ast.Dict) else getattr(node, "elts", [])
            assert len(families & set(constants(listed))) < 2, shown


def _asked_of_params(node: ast.AST) -> Iterator[str]:
    """Names of parameters that are asked of `params`: params["x"], params.get("x"), "x" in params."""
    if isinstance(node, ast.Subscript) and ast.unparse(node.value).endswith(".params"):
        yield from constants([node.slice])
    if isinstance(node, ast.Call) and ast.unparse(node.func).endswith("params.get"):
        yield from constants(node.args[:1])
    if isinstance(node, ast.Compare) and ast.unparse(node.comparators[-1]).endswith("params"):
        yield from constants([node.left])


def constants(nodes: Iterable[ast.AST | None]) -> list[str]:
    """The words among nodes."""
    return [n.value for n in nodes if isinstance(n, ast.Constant) and isinstance(n.value, str)]
