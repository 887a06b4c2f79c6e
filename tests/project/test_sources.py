"""Which files of users a class of theirs is made of."""

from __future__ import annotations

import importlib
import sys
import textwrap
import tomllib

import pytest
from project_files import ROOT

from rmfs import control, references
from rmfs.measure.provenance import PACKAGES
from rmfs.sources import sources

FILES = {
    "shop/__init__.py": "",
    "shop/rules.py": """
        import json, numpy as np, pandas.api
        from typing import TYPE_CHECKING
        import rmfs.control
        from . import scores
        from .more import deep
        from shop_helper import *
        if TYPE_CHECKING:
            from shop.only_types import Nothing
        class Rule:
            def late(self):
                from shop.more.deeper import at_last
                import importlib
                importlib.import_module("shop_named")
    """,
    "shop/scores.py": "import shop.rules\n",
    "shop/more/__init__.py": "",
    "shop/more/deep.py": "from .. import weights as w\n",
    "shop/more/deeper.py": "at_last = 1\n",
    "shop/weights.py": "w = 1\n",
    "shop/only_types.py": "class Nothing: ...\n",
    "shop/unused.py": "",
    "shop_helper.py": "x = 1\n",
    "shop_named.py": "",
    "alone.py": "import shop_helper\nclass Rule: ...\n",
}


@pytest.fixture
def project(tmp_path, monkeypatch):
    """A folder with modules of a user, on the path; forgotten afterwards."""
    for name, text in FILES.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(textwrap.dedent(text))
    monkeypatch.syspath_prepend(str(tmp_path))
    known = set(sys.modules)
    yield tmp_path
    for name in set(sys.modules) - known:
        del sys.modules[name]


def test_all_that_is_imported_below_the_users_folder_and_nothing_else(project):
    rule = importlib.import_module("shop.rules").Rule
    found = sources([rule])
    assert list(found) == [
        *("shop", "shop.more", "shop.more.deep", "shop.more.deeper", "shop.rules", "shop.scores"),
        *("shop.weights", "shop_helper", "shop_named"),
    ]
    assert found["shop.more.deep"] == project / "shop/more/deep.py"
    # not imported by this process, and found all the same
    assert "shop.more.deeper" not in sys.modules


def test_a_class_named_by_its_file(project):
    rule = references.resolve(f"{project}/alone.py:Rule", object, "rule")
    assert [path.name for path in sources([rule]).values()] == ["alone.py", "shop_helper.py"]


def test_what_is_told_by_a_version_has_no_files():
    assert sources([control.Controller, dict]) == {}
    # of an installed package its own files only
    found = sources([pytest.MonkeyPatch])
    assert "_pytest.monkeypatch" in found and "pytest" not in found


def test_rules_that_come_later_in_a_run_are_rules_too():
    exchange = {"at_s": 60.0, "psa": {"name": "random"}}
    settings = control.load("default", [(["mm"], {"name": "scheduled", "exchanges": [exchange]})])
    assert "RandomPlace" in [rule.__name__ for rule in settings.rules()]


def test_run_json_tells_the_version_of_every_dependency():
    with (ROOT / "pyproject.toml").open("rb") as file:
        named = tomllib.load(file)["project"]["dependencies"]
    assert sorted(PACKAGES) == sorted(one.partition(">")[0] for one in named)
