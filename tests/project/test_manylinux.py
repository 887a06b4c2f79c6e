"""The wheel for Linux machines of all kinds: its tag, and a run in an environment without Rust.

`make manylinux` installs the tools and runs this; elsewhere it is skipped.
"""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
import venv
from pathlib import Path

import pytest
from project_files import ROOT

DIST = ROOT / "dist"
RUN = """
import shutil
import rmfs
assert shutil.which("cargo") is None and shutil.which("rustc") is None
short = {"scenario.warmup_s": 0, "scenario.duration_s": 300}
run = rmfs.simulate("small", "small", seed=1, set=short, trace=True)
assert run.check().ok and run.footprint["units_picked"] > 0
print(rmfs.__file__)
"""


def told(*command: str | Path, **environment: str) -> str:
    done = subprocess.run(
        [str(word) for word in command],
        cwd=environment.pop("cwd", str(ROOT)),
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_recipe_and_the_tag_agree():
    recipe = (ROOT / ".ci" / "manylinux").read_text("utf-8")
    workflow = (ROOT / ".github" / "workflows" / "wheels.yml").read_text("utf-8")
    assert "--compatibility manylinux_2_17" in recipe and "make manylinux" in workflow


@pytest.mark.slow
@pytest.mark.skipif(
    not all(importlib.util.find_spec(name) for name in ("ziglang", "auditwheel")),
    reason="make manylinux installs Zig and auditwheel",
)
def test_the_wheel_runs_in_a_clean_environment_without_rust(tmp_path: Path):
    shown = told(ROOT / ".ci" / "manylinux", sys.executable, DIST)
    assert re.search(r"manylinux_2_17_x86_64|manylinux2014|manylinux_2_17_aarch64", shown), shown
    (wheel,) = DIST.glob("*-abi3-*manylinux_2_17*.whl")
    clean = tmp_path / "venv"
    # the packages that rmfs needs are those of the tests; rmfs itself is that of the wheel
    venv.create(clean, with_pip=True)
    python = clean / "bin" / "python"
    told(python, "-m", "pip", "-q", "install", "--no-index", "--no-deps", wheel)
    (site,) = (clean / "lib").glob("python3*/site-packages")
    needed = [path for path in sys.path if path.endswith("site-packages")]
    # after the wheel's own folder; a .pth file there that names the checkout is not read
    (site / "needed.pth").write_text("\n".join(needed) + "\n")
    place = told(python, "-c", RUN, cwd=str(tmp_path), PATH=f"{clean / 'bin'}:/usr/bin:/bin")
    assert place.startswith(str(clean)), place
