"""Design files to test with."""

from __future__ import annotations

from pathlib import Path

import pytest
from stand_in import Inline

from rmfs import experiments
from rmfs.experiments.running.driver import drive
from rmfs.experiments.store import Store

TINY = {
    "format": "rmfs-design/1",
    "name": "tiny",
    "seeds": [1, 2, 3],
    "base": {
        "layout": "basic",
        "scenario": "basic",
        "controllers": "default",
        "scenario.duration_s": 300,
    },
    "factors": {"layout.robots": [8, 16], "controllers.psa": ["nearest", "random"]},
}


@pytest.fixture
def design(tmp_path: Path):
    """Write a design: the tiny one with some keys replaced (None removes a key)."""

    def write(*, file: str = "design.toml", **changes) -> Path:
        table = {**TINY, **changes}
        table = {key: value for key, value in table.items() if value is not None}
        path = tmp_path / file
        path.write_text(toml(table), encoding="utf-8")
        return path

    return write


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of the tiny design with `keep = ["series"]`, to be copied by tests."""
    folder = tmp_path_factory.mktemp("finished")
    path = folder / "design.toml"
    path.write_text(toml({**TINY, "keep": ["series"]}), encoding="utf-8")
    drive(experiments.plan(path), Store(folder / "tiny"), Inline())
    return folder / "tiny"


def toml(table: dict) -> str:
    """Write TOML with quoted keys."""
    lines, tables = [], []
    for key, value in table.items():
        if isinstance(value, dict):
            tables.append(f"[{key}]")
            tables += [f'"{k}" = {inline(v)}' for k, v in value.items()]
        else:
            lines.append(f"{key} = {inline(value)}")
    return "\n".join([*lines, *tables]) + "\n"


def inline(value) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f'"{k}" = {inline(v)}' for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(inline(item) for item in value) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else repr(value)
