"""Two builds of the same sources, in other folders and from nothing, are equal bit for bit."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from project_files import ROOT, tracked

BUILD = """
import sys
sys.path.insert(0, ".ci")
import build_backend
build_backend.build_sdist(sys.argv[1])
build_backend.build_wheel(sys.argv[1])
"""


def built(sources: Path, target: Path) -> dict[str, str]:
    """Build in a copy of the tracked files; return the digest of what came of it, by name."""
    for path in tracked("*"):
        copy = sources / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(path, copy, follow_symlinks=False)
    for link in tracked_links():
        copy = sources / link
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.symlink_to((ROOT / link).readlink())
    target.mkdir()
    tools = [str(ROOT / ".rust/bin"), str(Path(sys.executable).parent)]
    path = os.pathsep.join([*tools, os.environ["PATH"]])
    environment = {**os.environ, "PATH": path, "CARGO_NET_OFFLINE": "true"}
    environment.pop("CARGO_TARGET_DIR", None)
    command = [sys.executable, "-c", BUILD, str(target)]
    subprocess.run(command, cwd=sources, env=environment, check=True, capture_output=True)
    made = sorted(target.iterdir())
    return {one.name: hashlib.sha256(one.read_bytes()).hexdigest() for one in made}


def tracked_links() -> list[Path]:
    """Return the links that git tracks: folders of the package that lie beside it."""
    listed = ["git", "-C", str(ROOT), "ls-files", "-s"]
    told = subprocess.run(listed, capture_output=True, text=True, check=True).stdout
    return [Path(line.split("\t")[1]) for line in told.splitlines() if line.startswith("120000")]


@pytest.mark.slow
def test_two_builds_are_equal(tmp_path: Path) -> None:
    pytest.importorskip("maturin")
    one = built(tmp_path / "one", tmp_path / "first")
    other = built(tmp_path / "elsewhere" / "another", tmp_path / "second")
    assert one == other
    assert sorted(name.rsplit(".", 1)[1] for name in one) == ["gz", "whl"]
