"""Writes docs/generated."""

import shutil
from pathlib import Path

from generate import benchmarks, commands, gallery, papers, parameters, python_api, scenario


def write(folder: Path) -> None:
    """All generated pages, anew."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    texts = {
        "scenario.md": scenario.page(),
        "commands.md": commands.page(),
        "gallery.md": gallery.page(folder),
        "papers.md": papers.page(),
        "attacks.md": parameters.attacks_page(),
        "benchmarks.md": benchmarks.page(),
        "python_rest.md": python_api.rest(),
        **{f"parameters_{name}.md": text for name, text in parameters.of_filters().items()},
        **{f"import_{name}.md": text for name, text in commands.imports().items()},
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
