"""The tracked build is what its sources make."""

import hashlib
import json
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

from rmfs.view import pages

WEB = Path(pages.__file__).parent / "web"
SOURCES = ("index.html", "package-lock.json", "package.json", "tsconfig.json", "vite.config.ts")
BUILT = ("index.html", "app.js", "app.css", "build.json", "notices.txt")
OLDEST_NODE = (20, 19)
UNREACHABLE = ("ENOTFOUND", "EAI_AGAIN", "ECONNREFUSED", "ECONNRESET", "ETIMEDOUT")


def node_version() -> tuple[int, ...]:
    """Major and minor version of Node; nothing without it or without npm."""
    if shutil.which("npm") is None or shutil.which("node") is None:
        return ()
    told = subprocess.run(["node", "--version"], capture_output=True, text=True, check=True).stdout
    return tuple(int(part) for part in told.strip().removeprefix("v").split(".")[:2])


def test_the_build_was_made_from_these_sources() -> None:
    files = [*SOURCES, *(path.relative_to(WEB).as_posix() for path in (WEB / "src").rglob("*.*"))]
    state = hashlib.sha256()
    for name in sorted(files):
        state.update(f"{name}\n".encode() + (WEB / name).read_bytes() + b"\n")
    told = json.loads(pages.content("build.json"))
    assert told == {"sources_sha256": state.hexdigest()}, "run `make viewer`"


def test_everything_served_is_built() -> None:
    assert {path.name for path in pages.STATIC.iterdir()} == set(BUILT)
    assert {name for name, _ in pages.FILES.values()} == set(BUILT) - {"build.json", "notices.txt"}


def test_the_licences_of_the_packages_in_the_page_are_shipped() -> None:
    lock = json.loads((WEB / "package-lock.json").read_text())["packages"]
    notices = pages.content("notices.txt").decode()
    for package in lock[""]["dependencies"]:
        locked = lock[f"node_modules/{package}"]
        assert f"{package} {locked['version']} ({locked['license']})\n" in notices
    assert notices.count("Copyright") >= len(lock[""]["dependencies"])
    assert notices.count("Permission is hereby granted") == len(lock[""]["dependencies"])
    for name in ("app.js", "app.css"):  # so that exported pages carry them, too
        assert pages.content(name).decode().startswith(f"/*!\n{notices}*/\n")
    settings = tomllib.loads((WEB.parents[2] / "pyproject.toml").read_text())
    assert "rmfs/view/static/notices.txt" in settings["project"]["license-files"]


def test_the_lock_has_the_packages_of_all_platforms() -> None:
    """Else `npm ci` refuses it."""
    lock = json.loads((WEB / "package-lock.json").read_text())["packages"]
    wanted = [
        (name, package)
        for name, locked in lock.items()
        for package in (*locked.get("dependencies", {}), *locked.get("optionalDependencies", {}))
    ]
    assert len(wanted) > 50
    missing = [
        (name, package)
        for name, package in wanted
        if not {f"node_modules/{package}", f"{name}/node_modules/{package}"} & set(lock)
    ]
    assert not missing
    assert all(locked["integrity"].startswith("sha512-") for name, locked in lock.items() if name)


@pytest.mark.slow
@pytest.mark.skipif(node_version() < OLDEST_NODE, reason="needs npm and Node 20.19 or newer")
def test_building_again_gives_the_same(tmp_path: Path) -> None:
    copy = tmp_path / "web"
    shutil.copytree(WEB, copy, ignore=shutil.ignore_patterns("node_modules"))
    installed = subprocess.run(["npm", "ci"], cwd=copy, capture_output=True, text=True)
    if any(reason in installed.stderr for reason in UNREACHABLE):
        pytest.skip("the registry of npm cannot be reached")
    installed.check_returncode()
    for command in (["npm", "run", "lint"], ["npm", "run", "build"]):
        subprocess.run(command, cwd=copy, check=True, capture_output=True)
    assert (copy / "package-lock.json").read_bytes() == (WEB / "package-lock.json").read_bytes()
    for name in BUILT:
        assert (tmp_path / "static" / name).read_bytes() == pages.content(name), name
