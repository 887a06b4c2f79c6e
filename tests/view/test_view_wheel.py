"""A built wheel carries the page, and not its sources."""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from rmfs.view import pages

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("cargo") is None, reason="Rust is not installed")
def test_the_wheel_carries_the_page(tmp_path: Path) -> None:
    build = [sys.executable, "-m", "maturin", "build", "--out", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as content:
        names = set(content.namelist())
        for file, _ in pages.FILES.values():
            assert content.read(f"rmfs/view/static/{file}") == pages.content(file)
        notices = pages.content("notices.txt")
        assert content.read("rmfs/view/static/notices.txt") == notices
        (shown,) = [
            name for name in names if name.endswith("licenses/rmfs/view/static/notices.txt")
        ]
        assert content.read(shown) == notices
    assert "rmfs/view/live.py" in names
    assert not any(name.startswith("rmfs/view/web/") for name in names)
