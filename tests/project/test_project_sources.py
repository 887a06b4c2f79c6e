"""What may not stand in a tracked file, and how long a module may be."""

import re
import warnings
from pathlib import Path

from project_files import ROOT, tracked

LONG, TOO_LONG = 450, 650

REGISTRIES = [
    ".".join(parts)
    for parts in (
        ("pypi", "org"),
        ("pythonhosted", "org"),
        ("crates", "io"),
        ("npmjs", "org"),
        ("debian", "org"),
        ("maven", "org"),
        ("golang", "org"),
    )
]
REGISTRY = re.compile("|".join(map(re.escape, REGISTRIES)))
MACHINE_PATH = re.compile(r"(?<![\w.~>-])/(?:work|root|home|Users|mnt)/\w")
MARKS_OF_UNFINISHED_WORK = re.compile(r"\b(?:TO" + r"DO|FIX" + r"ME|XX" + r"X)\b")
MAY_NAME_A_REGISTRY = ("Cargo.lock", "supply.py")
"""What cargo writes, and the tool that asks a registry what it knows of advisories."""


def lines(pattern: re.Pattern[str], paths: list[Path]) -> list[str]:
    found = []
    for path in paths:
        try:
            content = path.read_text("utf-8")
        except UnicodeDecodeError:
            continue
        found += [
            f"{path.relative_to(ROOT)}:{number}: {line.strip()[:100]}"
            for number, line in enumerate(content.splitlines(), 1)
            if pattern.search(line)
        ]
    return found


def test_no_file_names_a_package_registry() -> None:
    paths = [path for path in tracked() if path.name not in MAY_NAME_A_REGISTRY]
    assert lines(REGISTRY, paths) == []


def test_no_file_names_a_place_on_one_machine() -> None:
    assert lines(MACHINE_PATH, tracked()) == []


def test_no_source_is_marked_as_unfinished() -> None:
    assert lines(MARKS_OF_UNFINISHED_WORK, tracked("*.py", "*.rs", "*.toml")) == []


def test_modules_are_short() -> None:
    sizes = {
        str(path.relative_to(ROOT)): len(path.read_text("utf-8").splitlines())
        for path in tracked("*.py", "*.rs")
    }
    for name, size in sizes.items():
        if size > LONG:
            warnings.warn(f"{name} has {size} lines; is it one idea?", stacklevel=1)
    assert [name for name, size in sizes.items() if size > TOO_LONG] == []


def test_no_big_file_is_tracked() -> None:
    limit = 2_000_000
    assert [path for path in tracked() if path.stat().st_size > limit] == []
