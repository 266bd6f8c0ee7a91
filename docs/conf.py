"""Sphinx: `make docs` builds the site into build/docs; warnings are errors."""

import sys
from pathlib import Path

DOCS = Path(__file__).parent
sys.path.insert(0, str(DOCS))

import garrison  # noqa: E402
from generate import pages, plain_docstrings  # noqa: E402

project = "garrison"
author = copyright = "The garrison contributors"
release = version = garrison.__version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_design"]
myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 3
exclude_patterns = ["generate", "generated/parameters_*.md", "generated/import_*.md", "generated/python_rest.md"]
autodoc_default_options = {"members": True, "undoc-members": True}
autodoc_member_order = "bysource"
autodoc_typehints = "none"
smartquotes = False  # primes are no quotes, and -- begins options
html_theme = "furo"
html_title = "garrison"
html_static_path = ["_static"]
html_css_files = ["garrison.css"]
html_theme_options = {"navigation_with_keys": True}
html_show_sourcelink = False
html_copy_source = False

pages.write(DOCS / "generated")


def setup(app: object) -> None:
    """Docstrings are plain text, not reStructuredText."""
    app.connect("autodoc-process-docstring", plain_docstrings.process)  # type: ignore[attr-defined]
