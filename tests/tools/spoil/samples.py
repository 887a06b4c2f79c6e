"""What is spoilt: files that are shipped, small ones of RAWSim-O's formats, and those of a run."""

from __future__ import annotations

import contextlib
import gzip
import importlib
import io
import json
import shutil
import sys
import tomllib
from pathlib import Path
from typing import Any

from rmfs import instances
from rmfs import layout as layouts
from rmfs.cli import main
from rmfs.layout.explicit import save_json

TESTS = Path(__file__).resolve().parents[2]

SHORT = ["--set", "scenario.warmup_s=0", "--set", "scenario.duration_s=40"]
"""Options of runs: what is spoilt shows itself at once, or is read at the start."""

DESIGN = """
format = "rmfs-design/1"
name = "tiny"
description = "Two arms"
replications = 2
keep = ["series"]
[base]
layout = "small"
scenario = "small"
controllers = "default"
"scenario.duration_s" = 20
"scenario.warmup_s" = 0
[factors]
"layout.robots" = [2, 3]
"""


def prepared(folder: Path) -> Path:
    """Fill a folder with whole files; what is there already stays.

    Returns
    -------
    The folder.
    """
    mark = folder / "whole"
    if mark.exists():
        return folder
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    save_json(layouts.load("small"), folder / "small.json")
    (folder / "design.toml").write_text(DESIGN)
    run = ["run", "--layout", "small", "--scenario", "small", "--controllers", "pile-on"]
    options = ["--trace", "--record", str(folder), "--decisions", str(folder / "asked")]
    _call([*run, *SHORT, "--pacing", "fixed=0.5", "--out", str(folder / "run"), *options])
    _call(["experiment", "run", str(folder / "design.toml"), "--out", str(folder / "study")])
    question = sorted((folder / "asked").glob("*.json.gz"))[0]
    (folder / "question.json").write_bytes(gzip.decompress(question.read_bytes()))
    shutil.rmtree(folder / "asked")
    method = ["--work", "0.05", "--out", str(folder)]
    _call(["decisions", "solve", str(folder / "question.json"), *method])
    next(folder.glob("*.solution.json")).replace(folder / "solution.json")
    for name, content in of_rawsimo().items():
        (folder / name).write_text(content)
    xml = folder / "parts"
    xml.mkdir()
    resources = _tests_module("rawsimo_files").resources
    resources(xml)
    mark.touch()
    return folder


def _call(arguments: list[str]) -> None:
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        code = main(arguments)
    if code != 0:
        raise SystemExit(f"the samples cannot be made: rmfs {' '.join(arguments)}")


def _tests_module(name: str) -> Any:
    if str(TESTS) not in sys.path:
        sys.path.append(str(TESTS))
    return importlib.import_module(name)


def of_rawsimo() -> dict[str, str]:
    """Return small files of RAWSim-O's formats, by name."""
    files = _tests_module("rawsimo_files")
    return {
        "a.xgenc": files.XGENC,
        "a.xitem": files.XITEM,
        "a.xconf": files.XCONF,
        "a.xlayo": files.XLAYO,
        "a.xsett": files.XSETT.format("<SimulationDuration>60</SimulationDuration>", "", ""),
    }


def shipped(kind: str) -> list[tuple[str, dict[str, Any]]]:
    """Return names and trees of the shipped files of a kind (`layouts`, `scenarios`, ...)."""
    paths = sorted((instances.ROOT / kind).glob("*.toml"))
    return [(path.stem, tomllib.loads(path.read_text("utf-8"))) for path in paths]


def tree(path: Path) -> Any:
    """Return the tree of a JSON file."""
    return json.loads(path.read_text("utf-8"))


def design(name: str) -> dict[str, Any]:
    """Return the tree of a shipped design."""
    from rmfs.experiments.design import file

    path = Path(file.__file__).parents[1] / "designs" / f"{name}.toml"
    return tomllib.loads(path.read_text("utf-8"))
