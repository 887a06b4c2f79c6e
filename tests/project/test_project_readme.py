"""What the texts tell a reader to type works, and what they point to is there."""

import re

import pytest
from project_files import ROOT, make_targets, text, tracked

README = text("README.md")
TEXTS = ["README.md", "CHANGELOG.md", *sorted(f"docs/{p.name}" for p in ROOT.glob("docs/*.md"))]


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("name", TEXTS)
def test_targets_named_can_be_made(name: str) -> None:
    named = re.findall(r"(?:`|^    )make(?: [A-Z]+=\S+)* ([a-z]+)", text(name), re.MULTILINE)
    assert set(named) <= make_targets()


def test_the_two_commands_are_named() -> None:
    assert "    make demo\n    make test\n" in README


def test_the_python_experiment_is_the_one_on_the_command_line() -> None:
    command, *_ = [line for block in blocks("sh") for line in block.splitlines() if " run " in line]
    (code,) = blocks("python")
    settings = re.findall(r"--set (\S+)=(\S+)", command)
    assert settings == re.findall(r'"(\w+\.\w+)": (\d+)', code) != []


@pytest.mark.parametrize("name", TEXTS)
def test_links_lead_somewhere(name: str) -> None:
    for link in re.findall(r"\]\(([^)]+)\)", text(name)):
        if "://" not in link:
            assert (ROOT / name).parent.joinpath(link.split("#")[0]).exists(), link


def test_folders_named_exist() -> None:
    listed = re.findall(r"^\| `([a-z]+)/` \|", README, re.MULTILINE)
    assert {path.relative_to(ROOT).parts[0] for path in tracked("*/*.py")} - {".ci"} <= set(listed)


def test_pictures_are_small() -> None:
    for path in tracked("docs/images/*"):
        assert path.stat().st_size < 300_000
