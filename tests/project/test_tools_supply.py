"""The bill of materials is that of the lock files; licences fit; advisories are noticed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.tools import supply


def listed() -> list[dict]:
    return json.loads(supply.BILL.read_text("utf-8"))["components"]


def test_the_bill_holds_what_is_locked() -> None:
    """Otherwise: `python -m tests.tools.supply`."""
    told = {(c["purl"].split(":")[1].split("/")[0], c["name"], c["version"]) for c in listed()}
    assert told == supply.locked()
    page = supply.PAGE.read_text("utf-8")
    assert all(f"| {c['name']} | {c['version']} |" in page for c in listed())


def test_all_licences_are_known_and_fit() -> None:
    for component in listed():
        (told,) = component["licenses"]
        assert not supply.unfit(told["expression"]), component


def test_licences_are_those_that_packages_state() -> None:
    checked = 0
    for component in listed():
        if component["purl"].startswith("pkg:pypi"):
            (told,) = component["licenses"]
            stated = supply.licence_of(component["name"])
            assert stated in (told["expression"], "unknown"), component["name"]
            checked += stated != "unknown"
    assert checked > 60


@pytest.mark.parametrize(
    ("licence", "missing"),
    [
        ("MIT", []),
        ("GPL-3.0-only", ["GPL-3.0-only"]),
        ("MIT OR GPL-3.0-only", []),
        ("MIT AND GPL-3.0-only", ["GPL-3.0-only"]),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", []),
        ("Apache-2.0 WITH LLVM-exception", []),
        ("unknown", ["unknown"]),
    ],
)
def test_expressions(licence: str, missing: list[str]) -> None:
    assert supply.unfit(licence) == missing


def test_no_advisory_applies() -> None:
    assert supply.affected(supply.ADVISORIES) == []


def test_an_advisory_that_applies_is_told(tmp_path: Path) -> None:
    old = {("pypi", "jinja2", "3.1.5"), ("cargo", "pyo3", "0.23.0"), ("pypi", "pyo3", "0.1")}
    found = supply.affected(supply.ADVISORIES, old)
    assert [one.split(":")[0] for one in found] == ["jinja2 3.1.5", "pyo3 0.23.0"]
