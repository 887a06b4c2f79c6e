"""The bill of materials is that of the lock files; licences fit; advisories are noticed."""

from __future__ import annotations

import json

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


def test_an_advisory_that_applies_is_told() -> None:
    old = {("pypi", "pyyaml", "5.3"), ("cargo", "pyo3", "0.28.9"), ("pypi", "pyo3", "0.1")}
    found = supply.affected(supply.ADVISORIES, old)
    assert [one.split(":")[0] for one in found] == ["pyo3 0.28.9"] * 2 + ["pyyaml 5.3"]


def test_pypi_was_asked_of_every_locked_version() -> None:
    """Otherwise: `python -m tests.tools.supply --ask`."""
    asked = {("pypi", row["name"], row["version"]) for row in supply.answers()}
    assert asked == {one for one in supply.locked() if one[0] == "pypi"}
    untold = [row for row in supply.answers() if row["advisories"] == supply.UNTOLD]
    known = [row for row in supply.answers() if row["advisories"] == "none"]
    assert len(known) + len(untold) == len(asked) and len(known) > 80


def test_what_pypi_says(monkeypatch: pytest.MonkeyPatch) -> None:
    """An advisory counts unless it was withdrawn; the answer of another version does not."""
    locked = {("pypi", name, "1.0") for name in ("bad", "good", "other", "unknown")}
    bad = [{"id": "A-2"}, {"id": "A-1"}, {"id": "A-3", "withdrawn": "2026-01-01"}]
    told = {
        "bad": {"info": {"version": "1.0"}, "vulnerabilities": bad},
        "good": {"info": {"version": "1.0"}, "vulnerabilities": []},
        "other": {"info": {"version": "2.0"}, "vulnerabilities": []},
    }
    monkeypatch.setattr(supply, "locked", lambda: locked)
    monkeypatch.setattr(supply, "_told", told.get)
    found = {row["name"]: row["advisories"] for row in supply.ask()}
    assert found == {"bad": "A-1 A-2", "good": "none", "other": "not told", "unknown": "not told"}
