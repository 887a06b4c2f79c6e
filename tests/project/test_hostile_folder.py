"""A project with folders `experiments`, `solvers` and `instances` of its own runs everything."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
import venv
import zipfile
from pathlib import Path

import pytest
from project_files import ROOT

FILES = {
    "experiments/__init__.py": "OWN = True\n",
    "instances/__init__.py": "OWN = True\n",
    "instances/layouts/default.toml": "not = a layout",
    "solvers/__init__.py": "OWN = True\n",
    "solvers/weights.py": "SIGN = -1\n",
    "solvers/far.py": """
import numpy as np

from rmfs.control.psa.nearest import Nearest
from solvers.weights import SIGN


class Far(Nearest):
    def place(self, robot):
        places = self.view.storage.places
        times = SIGN * self.view.travel.away(robot.waypoint, loaded=True)[places]
        return int(places[np.where(self.view.storage.is_empty, times, np.inf).argmin()])
""",
    "design.toml": """
format = "rmfs-design/1"
name = "own"
seeds = [1, 2]
[base]
layout = "basic"
scenario = "basic"
controllers = "default"
"scenario.warmup_s" = 0
"scenario.duration_s" = 120
[factors]
"controllers.psa" = ["placement", "solvers.far:Far"]
""",
    "cluster.toml": 'format = "rmfs-cluster/1"\ncluster = "local"\nworkers = 1\n',
    "study.py": """
import experiments
import instances
import solvers

import rmfs
from rmfs.experiments import load, plan, reproducible_table, run

if __name__ == "__main__":
    assert experiments.OWN and instances.OWN and solvers.OWN
    print("rmfs is", rmfs.__file__)
    short = [(["scenario", "duration_s"], 60.0), (["controllers", "psa"], "placement")]
    assert rmfs.simulate("default", "basic", "default", overrides=short).footprint["trips"] > 0
    made = plan("design.toml")
    assert run(made, "results/here", processes=2).finished == 4
    assert run(made, "results/dask", dask="cluster.toml").finished == 4
    tables = [reproducible_table(load(f"results/{name}")) for name in ("here", "dask")]
    assert tables[0].equals(tables[1])
    print(tables[0].groupby("arm", sort=False)["distance_m"].mean().is_monotonic_increasing)
""",
}

COMMANDS = (
    "run --layout basic --scenario basic --set scenario.duration_s=60 "
    "--controllers pile-on --set controllers.psa.name=solvers.far:Far --out results/r",
    "experiment status design.toml --out results/here",
    "experiment table design.toml --out results/here",
    "layout check default",
)
REST = "import sys; from rmfs.cli import main; sys.exit(any(main(c.split()) for c in sys.argv[1:]))"


@pytest.fixture
def project(tmp_path):
    """The project's folder."""
    for name, text in FILES.items():
        path = tmp_path / "project" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "project"


def runs_everything(python: Path | str, project: Path) -> str:
    """Run the study and the commands in the project; return where rmfs was taken from."""
    environment = {**os.environ, "PYTHONPATH": "."}

    def told(*words: str) -> str:
        done = subprocess.run(
            [str(python), *words],
            cwd=project,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=300,
        )
        assert done.returncode == 0, f"{words}: {done.stdout}\n{done.stderr}"
        return done.stdout

    place, further = told("study.py").splitlines()
    assert further == "True"
    first, *rest = COMMANDS
    told("-m", "rmfs", *first.split())
    told("-c", REST, *rest)
    return place.removeprefix("rmfs is ")


def test_from_the_checkout(project):
    assert Path(runs_everything(sys.executable, project)) == ROOT / "rmfs" / "__init__.py"


@pytest.mark.slow  # the wheel is built; .ci/run does it
def test_from_the_wheel(project, tmp_path):
    build = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "--no-build-isolation",
        "--no-deps",
        "--no-index",
    ]
    places = [ROOT / ".rust" / "bin", Path(sys.executable).parent, os.environ["PATH"]]
    environment = {**os.environ, "PATH": os.pathsep.join(map(str, places))}
    subprocess.run(
        [*build, "--wheel-dir", tmp_path, ROOT], check=True, capture_output=True, env=environment
    )
    (wheel,) = tmp_path.glob("rmfs-*.whl")
    venv.create(tmp_path / "venv", with_pip=False)
    python = tmp_path / "venv" / "bin" / "python"
    place = subprocess.run(
        [python, "-c", "import sysconfig; print(sysconfig.get_path('platlib'))"],
        check=True,
        capture_output=True,
        text=True,
    )
    packages = Path(place.stdout.strip())
    with zipfile.ZipFile(wheel) as file:
        file.extractall(packages)
    # the packages it needs, without the link to the checkout that lies among them
    (packages / "needed.pth").write_text(sysconfig.get_path("platlib") + "\n")
    assert Path(runs_everything(python, project)) == packages / "rmfs" / "__init__.py"
