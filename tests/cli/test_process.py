"""The command as a process: start-up time, streams, exit codes."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def rmfs(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "rmfs", *arguments],
        capture_output=True,
        text=True,
        cwd=cwd,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin"},
        timeout=120,
        check=False,
    )


def test_help_comes_at_once(tmp_path):
    begin = time.perf_counter()
    done = rmfs("--help", cwd=tmp_path)
    assert done.returncode == 0
    assert "Usage: rmfs" in done.stdout
    # an eighth of a second on an idle machine; numpy or pandas alone would take longer
    assert time.perf_counter() - begin < 2.0


def test_heavy_modules_are_not_loaded_for_help(tmp_path):
    code = "import sys, rmfs.cli as c; c.main(['--help']); print(*sys.modules, file=sys.stderr)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=ROOT, check=True
    )
    assert not {"numpy", "pandas", "matplotlib", "pyarrow"} & set(done.stderr.split())


def test_an_error_is_one_line_on_the_error_stream(tmp_path):
    done = rmfs("run", "--seed", "many", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert len(done.stderr.splitlines()) == 1
    assert list(tmp_path.iterdir()) == []
