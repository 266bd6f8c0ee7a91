"""What the site generates from the code is complete: keys of scenarios, parameters, commands."""

import pytest
from conftest import ROOT
from garrison import _core, cli


@pytest.fixture(autouse=True)
def _generators(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "docs"))


def test_every_key_of_the_reader_has_a_meaning() -> None:
    from generate import scenario

    keys = scenario.keys_of_the_reader()
    assert {"steps", "drop", "radius_km", "law", "schedule"} <= keys
    page = scenario.page()
    assert all(f"`{key}`" in page for key in keys)


def test_a_key_without_a_meaning_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    from generate import scenario

    monkeypatch.delitem(scenario.MEANINGS["run"], "trials")
    with pytest.raises(RuntimeError, match="no meaning for \\['trials'\\]"):
        scenario.page()


def test_every_parameter_is_in_its_table() -> None:
    from generate import parameters

    tables = parameters.of_filters()
    for info in _core.filter_infos():
        assert all(f"`{p['name']}`" in tables[info["name"]] for p in info["params"]), info["name"]
    attacks = parameters.attacks_page()
    for info in _core.attack_infos():
        assert f"## {info['name']}\n" in attacks
        assert all(f"`{p['name']}`" in attacks for p in info["params"]), info["name"]


#: page with the guide of an import -> kinds
GUIDES = {
    "import-cars": ["openacc"],
    "import-aircraft": ["adsb"],
    "import-grid": ["pandapower"],
    "import-robot": ["rosbag", "mcap"],
    "csv-to-scenario": ["csv"],
}


def test_every_option_of_an_import_is_on_the_page_of_its_guide() -> None:
    from generate import commands

    tables = commands.imports()
    assert sorted(tables) == sorted(kind for kinds in GUIDES.values() for kind in kinds)
    for guide, kinds in GUIDES.items():
        page = (ROOT / "docs" / "how-to" / f"{guide}.md").read_text(encoding="utf-8")
        for kind in kinds:
            assert f"```{{include}} ../generated/import_{kind}.md" in page, f"{guide}: {kind}"
    assert "`--manoeuvre MANOEUVRE`" in tables["adsb"] and "`--harmonics HARMONICS`" in tables["csv"]


def test_a_paper_is_shown_with_its_claims() -> None:
    from generate import papers

    assert {path.stem for path in papers.SCRIPTS.glob("*.py")} >= {*papers.PAPERS}
    text = papers.section(papers.SCRIPTS / "rdkf.py")
    assert text.startswith("## rdkf") and "python examples/papers/rdkf.py -o out/papers/rdkf" in text
    assert text.count("| confirmed |") >= 10 and "| not confirmed |" in text


def test_every_command_is_shown() -> None:
    from generate import commands

    page = commands.page()
    kinds = ("openacc", "adsb", "pandapower", "rosbag", "mcap", "csv")
    assert all(f"### garrison import {kind}\n" in page for kind in kinds) and "`--manoeuvre MANOEUVRE`" in page
    for command in cli.COMMANDS:
        name = command.__name__.rpartition(".")[2].rstrip("_").replace("_", "-")
        assert f"## garrison {name}\n" in page
