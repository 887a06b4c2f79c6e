"""How Sphinx builds the documentation: `make docs`."""

from importlib.metadata import version as installed

project = "rmfs"
author = "The rmfs developers"
copyright = "The rmfs developers"  # noqa: A001 - the name Sphinx wants
version = release = installed("rmfs")

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.viewcode",
]
exclude_patterns = ["_build"]
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
