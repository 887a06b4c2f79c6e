"""What `run.json` tells of a run's origin."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import replace

from fake_run import layout

import rmfs
from rmfs import instances
from rmfs.control.choices import choose
from rmfs.control.problems import Problem
from rmfs.measure import provenance


def test_a_shipped_input_is_named_with_its_hash():
    told = provenance.source("layout", "default")
    assert told["name"] == "default"
    assert told["file"] == "instances/layouts/default.toml"
    assert len(told["sha256"]) == 64


def test_a_users_file_is_named_with_its_path(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text("a")
    told = provenance.source("scenario", str(path))
    assert (told["name"], told["file"]) == ("mine", path.as_posix())
    assert told["sha256"].startswith("ca978112ca1bbdca")


def test_what_came_from_no_file_has_its_name_only():
    told = provenance.source("controllers", "made in python")
    assert told == {"name": "made in python", "file": None, "sha256": None}


def test_a_plus_sign_in_a_name_is_kept_if_controllers_are_exchanged(tmp_path):
    shutil.copy(instances.locate("scenarios", "small"), tmp_path / "peak+2.toml")
    short = {"scenario.duration_s": 60.0}
    simulation = rmfs.Simulation("small", tmp_path / "peak+2.toml", set=short)
    simulation.run_until(30.0)
    simulation.exchange(choose(Problem.PSA, {"name": "random"}, "exchange"))
    simulation.run()
    run = simulation.result()
    assert run.names == ("small", "peak+2", "default+psa=random@30.000000s")
    told = run.save(tmp_path / "run").parameters
    names = [told[part]["name"] for part in ("layout", "scenario", "controllers")]
    assert names == ["small", "peak+2", "default"]


def test_a_digest_changes_with_any_value_and_only_then():
    one = layout()
    assert provenance.digest(one) == provenance.digest(layout())
    x = one.x_m.copy()
    x[3] += 1e-9
    assert provenance.digest(replace(one, x_m=x)) != provenance.digest(one)
    assert provenance.digest(replace(one, pod_radius_m=0.41)) != provenance.digest(one)
    assert provenance.digest({1: (2,)}) != provenance.digest({1: (2, 3)})


def test_without_git_there_is_no_commit(monkeypatch):
    def missing(*arguments, **options):
        raise FileNotFoundError

    monkeypatch.setattr(subprocess, "run", missing)
    assert provenance.commit() == {"git_commit": None, "git_changed": None}


def test_the_machine_is_told():
    told = provenance.machine()
    assert told["cores"] >= 1
    assert told["python"].startswith("3.")
