"""Every page is in one of the four parts of the sidebar, and the tree that is shown is the tree."""

from __future__ import annotations

import posixpath
import re
import subprocess
from collections import Counter

import pytest
from code_blocks import ROOT

DOCS = ROOT / "docs"
PARTS = ("Guide", "Reference", "Explanation", "Results")
TOCTREE = re.compile(r"^```\{toctree\}\n(.*?)^```", re.MULTILINE | re.DOTALL)
INDEX = (DOCS / "index.md").read_text("utf-8")


def pages() -> set[str]:
    """Names of all pages, as a toctree has them."""
    found = {path.relative_to(DOCS) for path in DOCS.glob("**/*.md")}
    return {
        path.with_suffix("").as_posix() for path in found if not {"_build", "paper"} & {*path.parts}
    }


def toctrees(page: str) -> list[tuple[str, list[str]]]:
    """Caption and entries of the toctrees of a page."""
    found = []
    for body in TOCTREE.findall((DOCS / f"{page}.md").read_text("utf-8")):
        caption = re.search(r"^:caption: (.*)$", body, re.MULTILINE)
        lines = [line.strip() for line in body.splitlines()]
        names = [line for line in lines if line and not line.startswith(":")]
        folder = posixpath.dirname(page)
        entries = [posixpath.normpath(posixpath.join(folder, name)) for name in names]
        found.append((caption[1] if caption else "", entries))
    return found


def listed(part: str) -> list[str]:
    """Pages that the front page lists, with a line on each, under the heading of a part."""
    section = INDEX.split(f"\n## {part}\n")[1].split("\n## ")[0].split("\n```")[0]
    return re.findall(r"^- \[[^\]]*\]\(([^)]+)\.md\)", section, re.MULTILINE)


def test_the_sidebar_has_four_parts():
    assert tuple(caption for caption, _ in toctrees("index")) == PARTS


def test_every_page_is_in_one_part():
    shown = Counter(name for page in pages() for _, names in toctrees(page) for name in names)
    assert {name for name, times in shown.items() if times > 1} == set()
    assert pages() - set(shown) == {"index"}
    assert set(shown) <= pages()


@pytest.mark.parametrize("part", PARTS)
def test_the_front_page_lists_what_the_sidebar_has(part: str):
    assert sorted(listed(part)) == sorted(dict(toctrees("index"))[part])


def test_pages_of_measured_figures_are_results():
    results = set(dict(toctrees("index"))["Results"])
    assert {name for name in pages() if name.endswith("-measured")} <= results


def shown_tree() -> dict[str, str]:
    """Paths of the tree in the development page, with what is said of each."""
    text = (DOCS / "development.md").read_text("utf-8")
    block = text.split("## The tree\n\n")[1].split("\n\n")[0]
    found, folder = {}, ""
    for line in block.splitlines():
        match = re.fullmatch(r"( +)(\S+) +(\S.*)", line)
        assert match is not None, line
        if len(match[1]) == 4:
            folder = match[2]
        found[match[2] if len(match[1]) == 4 else folder + match[2]] = match[3]
    return found


def test_the_tree_that_is_shown_is_the_tree():
    told = subprocess.run(
        ["git", "-C", str(ROOT), "ls-files"], capture_output=True, check=False, text=True
    )
    if told.returncode:
        pytest.skip("not a git checkout")
    files = [name.split("/") for name in told.stdout.splitlines()]
    links = {path for path in (ROOT / "rmfs").iterdir() if path.is_symlink()}
    top = {f"{parts[0]}/" for parts in files if len(parts) > 1}
    packages = ("rmfs", "solvers", "experiments", "instances", "docs")
    below = {"/".join(parts[:2]) + "/" for parts in files if parts[0] in packages and parts[2:]}
    shown = shown_tree()
    assert {name for name in shown if name.endswith("/")} == (
        top | below | {f"rmfs/{link.name}/" for link in links}
    )
    assert all((ROOT / name).exists() for name in shown)
    for link in links:
        target = link.resolve().relative_to(ROOT).as_posix()
        assert shown[f"rmfs/{link.name}/"] == f"link to {target}/"
