"""The Makefile, and the tool that finds or brings a Rust."""

import os
import platform
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from project_files import ROOT, make_targets, text, toml

MINIMUM = toml("rmfs/traffic/Cargo.toml")["package"]["rust-version"]
NEEDED = [
    "bash",
    "sh",
    "dirname",
    "sed",
    "cut",
    "sort",
    "head",
    "uname",
    "mkdir",
    "chmod",
    "cat",
    "rm",
    "tail",
]


def make(*arguments: str) -> "subprocess.CompletedProcess[str]":
    environment = {key: value for key, value in os.environ.items() if not key.startswith("MAKE")}
    return subprocess.run(
        ["make", *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        env=environment,
    )


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A checkout with as much as the tool reads, and an own folder of programs, without Rust."""
    for name in (".ci/rust", "rmfs/traffic/Cargo.toml"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, tmp_path / name)
    (tmp_path / "bin").mkdir()
    for name in NEEDED:
        found = shutil.which(name)
        assert found is not None
        (tmp_path / "bin" / name).symlink_to(found)
    program(tmp_path, "cc", "exit 0")
    return tmp_path


def program(checkout: Path, name: str, script: str) -> None:
    """Put a program of that name on the checkout's PATH."""
    path = checkout / "bin" / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)


def rust(checkout: Path, version: str) -> None:
    program(checkout, "rustc", f"echo 'rustc {version} (0123456789 2025-01-01)'")
    program(checkout, "cargo", f"echo 'cargo {version}'")


def bring_rust(checkout: Path) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [checkout / ".ci" / "rust"],
        env={"PATH": str(checkout / "bin")},
        capture_output=True,
        text=True,
        check=False,
    )


def test_help_lists_the_targets() -> None:
    told = make("help")
    assert told.returncode == 0
    parts = {"rust", "lint-python", "lint-rust"}
    assert set(re.findall(r"^  make (\S+)", told.stdout, re.MULTILINE)) == make_targets() - parts


def test_an_old_python_is_refused_in_one_line(tmp_path: Path) -> None:
    old = tmp_path / "python-old"
    code = "import sys; sys.version_info = (3, 10, 4); exec(sys.argv[2])"
    old.write_text(f'#!/bin/sh\nexec "{sys.executable}" -c "{code}" "$@"\n')
    old.chmod(0o755)
    told = make("-s", "setup", f"PYTHON={old}", f"VENV={tmp_path / 'venv'}")
    assert told.returncode != 0
    first, *rest = told.stderr.splitlines()
    assert first.startswith("Python 3.11 or newer is needed")
    assert "is 3.10" in first
    assert all(line.startswith("make") for line in rest)
    assert not (tmp_path / "venv").exists()


@pytest.mark.parametrize("later", ["", ".1"])
def test_a_rust_that_will_do_is_used(checkout: Path, later: str) -> None:
    rust(checkout, MINIMUM + later)
    told = bring_rust(checkout)
    assert (told.returncode, told.stdout, told.stderr) == (0, "", "")
    assert not (checkout / ".rust").exists()


@pytest.mark.parametrize("found", [None, "1.9.0"])
def test_without_rust_and_network_one_line_says_what_is_needed(
    checkout: Path, found: str | None
) -> None:
    if found is not None:
        rust(checkout, found)
    told = bring_rust(checkout)
    assert told.returncode == 1
    (line,) = told.stderr.splitlines()
    assert f"Rust {MINIMUM} or newer is needed" in line
    assert not (checkout / ".rust").exists()


def test_an_installer_of_another_checksum_is_not_run(checkout: Path) -> None:
    program(checkout, "curl", f'for last; do :; done; echo "touch {checkout}/run" >"$last"')
    (checkout / "bin" / "sha256sum").symlink_to(str(shutil.which("sha256sum")))
    told = bring_rust(checkout)
    assert told.returncode == 1
    assert "has another checksum than published; it is not run" in told.stderr
    assert not (checkout / "run").exists()
    assert not (checkout / ".rust").exists()


def test_rustup_brings_the_pinned_version(checkout: Path) -> None:
    """A stand-in for curl fetches a stand-in for rustup's installer."""
    installer = (
        'mkdir -p "$CARGO_HOME/bin"; while [ "$1" != --default-toolchain ]; do shift; done; '
        "for name in rustc cargo; do printf '#!/bin/sh\\necho \"%s %s in $RUSTUP_HOME\"\\n' "
        '$name "$2" >"$CARGO_HOME/bin/$name"; chmod +x "$CARGO_HOME/bin/$name"; done'
    )
    (checkout / "installer").write_text(f"#!/bin/sh\n{installer}")
    program(checkout, "curl", f'for last; do :; done; cat "{checkout}/installer" >"$last"')
    kind = f"{platform.system()}-{platform.machine()}"
    sums = re.search(rf"{kind}\).*\n *([0-9a-f]{{64}})", text(".ci/rust"))
    assert sums is not None
    program(checkout, "sha256sum", f"echo {sums[1]}")
    told = bring_rust(checkout)
    assert told.returncode == 0, told.stderr
    pinned = re.search(r"^PINNED=(.+)$", text(".ci/rust"), re.MULTILINE)
    assert pinned is not None
    assert told.stderr == f"rust: installing Rust {pinned[1]} with rustup into .rust\n"
    version = subprocess.run(
        [checkout / ".rust" / "bin" / "rustc"], capture_output=True, text=True, check=True
    )
    assert version.stdout == f"rustc {pinned[1]} in {checkout}/.rust/rustup\n"


def test_a_missing_linker_is_named(checkout: Path) -> None:
    rust(checkout, MINIMUM)
    (checkout / "bin" / "cc").unlink()
    told = bring_rust(checkout)
    assert told.returncode == 1
    (line,) = told.stderr.splitlines()
    assert "C compiler" in line
