"""What rmfs is made with: bill of materials, licences, advisories: `python -m tests.tools.supply`.

Names and versions are those of the lock files, licences those that packages state. Advisories are
stored, so that the look at them needs no network: a list of what has been mended in which version
(`--advisories FILE` takes a newer one), and what PyPI has answered of each locked version
(`--ask` asks it again).
"""

from __future__ import annotations

import argparse
import csv
import datetime
import json
import re
import subprocess
import sys
import textwrap
import tomllib
import urllib.error
import urllib.request
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from packaging.version import Version

from rmfs.files import write_text
from tests.tools.checkout import ROOT

BILL = ROOT / "docs" / "sbom.cdx.json"
PAGE = ROOT / "docs" / "dependencies.md"
ADVISORIES = Path(__file__).with_name("advisories.csv")
ASKED = Path(__file__).with_name("asked.csv")
UNTOLD = "not told"

COMPATIBLE = {
    *("0BSD", "Apache-2.0", "BSD-2-Clause", "BSD-3-Clause", "CC0-1.0", "ISC", "LLVM-exception"),
    *("MIT", "MIT-0", "MIT-CMU", "MPL-2.0", "PSF-2.0", "Unicode-3.0", "Zlib"),
}
"""Licences under which a package may be used by, and installed beside, one of the MIT licence.

MPL-2.0 is one of files: what uses such a package is not touched by it.
"""

WORDS = (
    (r"mozilla public license 2", "MPL-2.0"),
    (r"apache", "Apache-2.0"),
    (r"2-clause|bsd-2", "BSD-2-Clause"),
    (r"bsd|kiwi", "BSD-3-Clause"),
    (r"matplotlib|python software", "PSF-2.0"),
    (r"isc", "ISC"),
    (r"\bmit\b", "MIT"),
)
"""How licences are told where no expression of SPDX is: the first word found counts."""

ELSEWHERE = {"colorama": "BSD-3-Clause"}
"""Licences of packages that are locked for other systems and not installed here."""


@dataclass(frozen=True, order=True)
class Part:
    """A package: where it comes from, name, version, licence (SPDX), and what for."""

    ecosystem: str
    name: str
    version: str
    licence: str
    purpose: str

    @property
    def purl(self) -> str:
        """Return its package URL."""
        return f"pkg:{self.ecosystem}/{self.name}@{self.version}"


def locked() -> set[tuple[str, str, str]]:
    """Return ecosystem, name and version of everything that the lock files name."""
    text = (ROOT / "requirements.txt").read_text("utf-8")
    blocks = re.findall(r"^[^\s#].*", text, re.MULTILINE)
    pins = [Requirement(block.split(" \\")[0]) for block in blocks]
    python = {("pypi", canonicalize_name(pin.name), _version(pin)) for pin in pins}
    crates = tomllib.loads((ROOT / "rmfs/traffic/Cargo.lock").read_text("utf-8"))["package"]
    rust = {("cargo", one["name"], one["version"]) for one in crates if "source" in one}
    return python | rust | {("npm", *package) for package in _in_the_page()}


def _in_the_page() -> dict[tuple[str, str], str]:
    """Return the licences of the packages that the page of the viewer has inside, as locked."""
    lock = json.loads((ROOT / "rmfs/view/web/package-lock.json").read_text("utf-8"))
    return {
        (path.removeprefix("node_modules/"), one["version"]): one["license"]
        for path, one in lock["packages"].items()
        if path and not one.get("dev") and not one.get("optional")
    }


def _version(pin: Requirement) -> str:
    (specifier,) = pin.specifier
    return specifier.version


def collected() -> list[Part]:
    """Return all parts, with the licences that the installed packages and the crates state."""
    needed = _needed_to_run()
    licences, pages = _of_crates(), _in_the_page()
    parts = []
    for ecosystem, name, version in sorted(locked()):
        if ecosystem == "cargo":
            parts.append(Part(ecosystem, name, version, licences[name, version], "compiled core"))
            continue
        if ecosystem == "npm":
            told = pages[name, version]
            parts.append(Part(ecosystem, name, version, told, "page of the viewer"))
            continue
        purpose = "run time" if name in needed else "extras and development"
        parts.append(Part(ecosystem, name, version, licence_of(name), purpose))
    return parts


def _needed_to_run() -> set[str]:
    """Return the packages that an installation without extras takes."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    todo = [Requirement(text).name for text in project["dependencies"]]
    found: set[str] = set()
    while todo:
        name = canonicalize_name(todo.pop())
        if name in found:
            continue
        found.add(name)
        try:
            needs = [Requirement(text) for text in metadata.requires(name) or []]
        except metadata.PackageNotFoundError:
            continue
        todo += [r.name for r in needs if r.marker is None or "extra" not in str(r.marker)]
    return found


def licence_of(name: str) -> str:
    """Return the licence that an installed package states, as SPDX has it; `unknown` if none."""
    try:
        told = metadata.metadata(name)
    except metadata.PackageNotFoundError:
        return ELSEWHERE.get(name, "unknown")
    if "License-Expression" in told:
        return str(told["License-Expression"])
    classifiers = [one for one in told.get_all("Classifier", []) if one.startswith("License")]
    said = " ".join([*classifiers, *told.get_all("License", [])]).lower()[:400]
    return next((spdx for word, spdx in WORDS if re.search(word, said)), "unknown")


def _of_crates() -> dict[tuple[str, str], str]:
    command = ["cargo", "metadata", "--offline", "--locked", "--format-version", "1"]
    manifest = ["--manifest-path", str(ROOT / "rmfs/traffic/Cargo.toml")]
    told = subprocess.run([*command, *manifest], capture_output=True, check=True).stdout
    found = json.loads(told)["packages"]
    return {(p["name"], p["version"]): p["license"].replace("/", " OR ") for p in found}


def unfit(licence: str) -> list[str]:
    """Return what of a licence's expression is not known to be compatible.

    Of alternatives one is enough; of what holds together, all count.
    """
    flat = re.sub(r"[()]", " ", licence)
    missing: list[str] = []
    for part in re.split(r"\s+AND\s+", flat):
        choices = [re.split(r"\s+WITH\s+", one.strip()) for one in re.split(r"\s+OR\s+", part)]
        if not any(set(choice) <= COMPATIBLE for choice in choices):
            missing.append(part.strip())
    return missing


def affected(advisories: Path, parts: set[tuple[str, str, str]] | None = None) -> list[str]:
    """Return the locked packages to which a stored advisory applies.

    Parameters
    ----------
    advisories
        CSV: ecosystem, name, version in which it is mended, identifier, what is wrong.
    parts
        Default those of the lock files.
    """
    found = []
    with advisories.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            for ecosystem, name, version in sorted(locked() if parts is None else parts):
                same = (ecosystem, name) == (row["ecosystem"], row["name"])
                if same and Version(version) < Version(row["mended"]):
                    found.append(f"{name} {version}: {row['id']}, {row['what']}")
    return found


def ask() -> list[dict[str, str]]:
    """Ask PyPI which advisories it knows of each locked version."""
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    rows = []
    for ecosystem, name, version in sorted(locked()):
        if ecosystem != "pypi":
            continue
        known = _told(f"{name}/{version}") or _told(name)
        if known is None or known["info"]["version"] != version:
            found = UNTOLD
        else:
            mine = [one for one in known["vulnerabilities"] if not one.get("withdrawn")]
            found = " ".join(sorted(one["id"] for one in mine)) or "none"
        rows.append({"name": name, "version": version, "asked": today, "advisories": found})
    return rows


def _told(what: str) -> dict[str, Any] | None:
    try:
        with urllib.request.urlopen(f"https://pypi.org/pypi/{what}/json", timeout=30) as answer:
            told: dict[str, Any] = json.load(answer)
    except (urllib.error.URLError, ValueError):
        return None
    return told


def answers() -> list[dict[str, str]]:
    """Return what PyPI has answered, one row per package: name, version, asked, advisories."""
    with ASKED.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def bill(parts: list[Part]) -> dict[str, Any]:
    """Return the bill of materials, in the form of CycloneDX 1.5."""
    return {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {"component": {"type": "application", "name": "rmfs", "bom-ref": "rmfs"}},
        "components": [
            {
                "type": "library",
                "bom-ref": part.purl,
                "name": part.name,
                "version": part.version,
                "purl": part.purl,
                "scope": "optional" if part.purpose.startswith("extras") else "required",
                "licenses": [{"expression": part.licence}],
                "properties": [{"name": "rmfs:purpose", "value": part.purpose}],
            }
            for part in parts
        ],
    }


def known_weaknesses() -> str:
    """Return what the page says of advisories: what was asked for, of whom, and when."""
    rows = answers()
    clear = [row for row in rows if row["advisories"] == "none"]
    untold = [f"{row['name']} {row['version']}" for row in rows if row["advisories"] == UNTOLD]
    days = " and ".join(sorted({row["asked"] for row in rows}))
    with ADVISORIES.open(newline="", encoding="utf-8") as file:
        mended = list(csv.DictReader(file))
    crates, packages = (
        sum(row["ecosystem"] == kind for row in mended) for kind in ("cargo", "pypi")
    )
    paragraph = f"""Known vulnerabilities: no known advisory applies. PyPI was queried on {days} and
listed none for {len(clear)} of the {len(rows)} locked versions of Python packages. The query
gave answers only for the newest version of each package. The other {len(untold)} locked versions
are older, so there is no answer for them: {", ".join(untold)}. All locked versions were also
compared with stored advisories. These are {crates} advisories on the crates (from a copy of the
RustSec database of June 2026) and {packages} on Python packages (published from 2021 to 2023, from
the PyPA database). `python -m tests.tools.supply --ask` queries PyPI again."""
    return textwrap.fill(paragraph, 100, break_long_words=False, break_on_hyphens=False)


def page(parts: list[Part]) -> str:
    """Return the page that lists all parts."""
    rows = "\n".join(
        f"| {part.name} | {part.version} | {part.licence} | {part.purpose} |" for part in parts
    )
    return f"""# Dependencies

This page lists all packages that rmfs uses, in the versions of the lock files, with the licence
that each package states. A test checks that all licences are compatible with the licence of rmfs,
the MIT licence. The file `docs/sbom.cdx.json` contains the same list as a bill of materials
(CycloneDX 1.5). `python -m tests.tools.supply` writes this page and the bill of materials. It also
compares the locked versions with stored advisories; this needs no network.

Packages are installed separately, with two exceptions. The Rust crates are linked into the compiled
core (path planning and other fast parts). The JavaScript packages three.js and uPlot are contained
in the page of the [viewer](viewer.md). The licences of these two packages are in
`rmfs/view/static/notices.txt`, which is part of the wheel, and at the top of the page's script, so
exported pages contain these licences as well.

The last column states what a package is needed for: the compiled core, the page of the viewer,
every installation at run time, or only optional extras and development. If a Python package is
listed in two versions, the lower one is for Python 3.11, the other for Python 3.12 and newer.

{known_weaknesses()}

| package | version | licence | needed for |
|---|---|---|---|
{rows}
"""


def main(arguments: list[str] | None = None) -> int:
    """Return the exit code: 1 if a licence does not fit, or an advisory applies."""
    parser = argparse.ArgumentParser(prog="python -m tests.tools.supply", description=__doc__)
    parser.add_argument("--advisories", type=Path, default=ADVISORIES, help="list to look at")
    parser.add_argument("--ask", action="store_true", help="ask PyPI again, over the network")
    given = parser.parse_args(arguments)
    if given.ask:
        rows = ask()
        text = "\n".join([",".join(rows[0]), *(",".join(row.values()) for row in rows)])
        write_text(ASKED, text + "\n")
    parts = collected()
    write_text(BILL, json.dumps(bill(parts), indent=1) + "\n")
    write_text(PAGE, page(parts))
    problems = [f"{p.name}: licence {p.licence}" for p in parts if unfit(p.licence)]
    problems += affected(given.advisories)
    problems += [
        f"{row['name']} {row['version']}: {row['advisories']}"
        for row in answers()
        if row["advisories"] not in ("none", UNTOLD)
    ]
    print(*problems, f"{len(parts)} packages, {len(problems)} problems", sep="\n")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
