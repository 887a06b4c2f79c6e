"""The command as a process: start, streams, exit codes."""

from __future__ import annotations

import subprocess
import sys
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


def test_help_is_shown(tmp_path):
    done = rmfs("--help", cwd=tmp_path)
    assert done.returncode == 0
    assert "Usage: rmfs" in done.stdout


def completed(words: str, cwd: Path) -> list[str]:
    """What a shell offers for the last of some words."""
    code = "import sys; sys.argv[0] = 'rmfs'; from rmfs.cli import main; sys.exit(main())"
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        cwd=cwd,
        env={
            "PYTHONPATH": str(ROOT),
            "PATH": "/usr/bin:/bin",
            "_RMFS_COMPLETE": "complete_bash",
            "COMP_WORDS": words,
            "COMP_CWORD": str(len(words.split(" ")) - 1),
        },
        timeout=120,
        check=False,
    )
    return done.stdout.split()


def test_the_shell_completes_commands_options_and_names(tmp_path):
    assert completed("rmfs exp", tmp_path) == ["experiment"]
    assert {"table", "status", "plot"} <= set(completed("rmfs experiment ", tmp_path))
    assert completed("rmfs experiment table --acr", tmp_path) == ["--across"]
    assert set(completed("rmfs run --layout study-", tmp_path)) == {
        *("study-128", "study-32", "study-tiers")
    }
    assert "--install-completion" in rmfs("--help", cwd=tmp_path).stdout


def test_help_comes_at_once_as_heavy_modules_are_not_loaded():
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
