import re

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from project_files import text, toml

PROJECT = toml("pyproject.toml")
BLOCKS = re.findall(r"^[^\s#].*(?:\n[ \t].*)*", text("requirements.txt"), re.MULTILINE)
DEPENDENCIES = [
    *PROJECT["project"]["dependencies"],
    *PROJECT["project"]["optional-dependencies"]["dev"],
]


def pins() -> list[Requirement]:
    return [Requirement(block.split(" \\")[0]) for block in BLOCKS]


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: block.split("==")[0])
def test_each_package_has_one_version_and_its_hashes(block: str) -> None:
    (specifier,) = Requirement(block.split(" \\")[0]).specifier
    assert specifier.operator == "=="
    assert re.search(r"--hash=sha256:[0-9a-f]{64}\b", block)


def test_the_lock_file_holds_nothing_else() -> None:
    assert "://" not in text("requirements.txt")
    assert len(pins()) > len(DEPENDENCIES)


@pytest.mark.parametrize("dependency", DEPENDENCIES)
def test_each_dependency_is_locked_at_a_version_that_it_allows(dependency: str) -> None:
    wanted = Requirement(dependency)
    locked = [pin for pin in pins() if canonicalize_name(pin.name) == wanted.name]
    assert locked, "run make lock"
    for pin in locked:
        (specifier,) = pin.specifier
        assert specifier.version in wanted.specifier


def test_maturin_of_the_lock_file_is_one_that_pip_may_use() -> None:
    (required,) = PROJECT["build-system"]["requires"]
    assert required in PROJECT["project"]["optional-dependencies"]["dev"]
