"""How Sphinx builds the documentation: `make docs`."""

import re
from importlib.metadata import version as installed
from typing import Any

project = "rmfs"
author = "The rmfs developers"
copyright = "The rmfs developers"
version = release = installed("rmfs")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
exclude_patterns = ["_build", "paper"]
html_theme = "furo"
html_title = "rmfs"

# notebooks are pages with cells; they run when the documentation is built
nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_timeout = 600
nb_execution_in_temp = True

myst_heading_anchors = 3
myst_links_external_new_tab = False

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True, "show-inheritance": True}
# optional packages that the reference does not need
autodoc_mock_imports = ["distributed", "dask_jobqueue"]
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True  # attributes are documented once, in their class
# words of signatures, such as Outcome, name more than one thing
suppress_warnings = ["ref.python"]


def _links_out(app: object, name: str, source: list[str]) -> None:
    """Turn links to files outside `docs` into their names, as these files are not published."""
    outside = r"\.\./" * (name.count("/") + 1)
    source[0] = re.sub(rf"\[([^\]]*)\]\({outside}([^)\s]*)\)", r"\1 (`\2`)", source[0])


def _plain_names(*told: Any) -> None:
    """Keep names of types that end with _, such as np.bool_, from being taken for links."""
    lines: list[str] = told[-1]
    lines[:] = [re.sub(r"\b(np\.\w+)_(?!\w)", r"\1\\_", line) for line in lines]


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.connect("source-read", _links_out)
    # after napoleon, which adds the types of attributes
    app.connect("autodoc-process-docstring", _plain_names, priority=900)
