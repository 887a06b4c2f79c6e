import re

from project_files import text, toml

PROJECT = toml("pyproject.toml")
CRATE = toml("rmfs/traffic/Cargo.toml")["package"]


def cited(key: str) -> str:
    found = re.search(rf"^{key}: (.+)$", text("CITATION.cff"), re.MULTILINE)
    assert found is not None
    return found[1].strip('"')


def test_all_files_state_the_same_version() -> None:
    version = PROJECT["project"]["version"]
    locked = next(
        package["version"]
        for package in toml("rmfs/traffic/Cargo.lock")["package"]
        if package["name"] == CRATE["name"]
    )
    assert {CRATE["version"], locked, cited("version")} == {version}


def test_all_files_state_the_same_licence() -> None:
    assert {PROJECT["project"]["license"], CRATE["license"], cited("license")} == {"MIT"}
    assert text("LICENSE").startswith("MIT License")


def test_change_log_has_a_place_for_what_comes_next() -> None:
    headings = re.findall(r"^## \[(.+?)\]", text("CHANGELOG.md"), re.MULTILINE)
    assert headings[0] == "Unreleased"


def test_all_files_state_the_same_oldest_python() -> None:
    stated = PROJECT["project"]["requires-python"].removeprefix(">=")
    major, minor = stated.split(".")
    assert PROJECT["tool"]["mypy"]["python_version"] == stated
    assert PROJECT["tool"]["ruff"]["target-version"] == f"py{major}{minor}"
    assert f"abi3-py{major}{minor}" in text("rmfs/traffic/Cargo.toml")
    assert f"sys.version_info < ({major}, {minor})" in text("Makefile")
    assert f"--python-version {stated}" in text("Makefile")
    assert f"Python {stated} or newer" in text("README.md")


def test_the_pinned_rust_is_new_enough() -> None:
    pinned = re.search(r"^PINNED=([\d.]+)$", text(".ci/rust"), re.MULTILINE)
    assert pinned is not None

    def numbers(version: str) -> list[int]:
        return [int(part) for part in version.split(".")]

    assert numbers(pinned[1]) >= numbers(CRATE["rust-version"])
