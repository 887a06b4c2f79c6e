"""Every code block and command of the documentation works as it is written."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from code_blocks import RAWSIMO, ROOT, WORDS, Block, Session, blocks, indented, run

PAGES = [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").glob("**/*.md"))]
PAGES = [page for page in PAGES if "_build" not in page.parts]
BLOCKS = {page: blocks(page) for page in PAGES}
RUN = ("python", "sh", "toml", "json")
SHOWN = ("text", "bibtex", "latex", "rust")
"""Languages that are there to be read."""


def named(pages: list[Path]):
    return pytest.mark.parametrize("page", pages, ids=[page.name for page in pages])


def runs(block: Block) -> bool:
    lacking = "skip" in block.options or ("reference" in block.options and not RAWSIMO.is_dir())
    return not lacking and (block.language in (*RUN, "text") or "from" in block.options)


def is_slow(page: Path) -> bool:
    return any("slow" in block.options for block in BLOCKS[page] if runs(block))


WITH_BLOCKS = [p for p in PAGES if any(runs(b) and b.language != "text" for b in BLOCKS[p])]


def session(page: Path, folder: Path, monkeypatch, *, slow: bool) -> None:
    monkeypatch.chdir(folder)
    monkeypatch.syspath_prepend(str(folder))
    known = set(sys.modules)
    shared = Session(folder)
    try:
        for block in BLOCKS[page]:
            if runs(block) and (slow or "slow" not in block.options):
                run(block, shared)
    finally:
        # what a page has written as a module is not known to the next one
        for name in set(sys.modules) - known:
            origin = getattr(sys.modules[name], "__file__", None)
            if origin and Path(origin).parent == folder:
                del sys.modules[name]


@named(WITH_BLOCKS)
def test_the_blocks_of_a_page_work(page, tmp_path, monkeypatch):
    session(page, tmp_path, monkeypatch, slow=False)


@pytest.mark.slow
@named([page for page in WITH_BLOCKS if is_slow(page)])
def test_the_long_blocks_of_a_page_work(page, tmp_path, monkeypatch):
    session(page, tmp_path, monkeypatch, slow=True)


@named(PAGES)
def test_every_block_says_what_it_is(page):
    """So that none is left out by mistake; a reason is needed for what cannot run."""
    for block in BLOCKS[page]:
        if block.language.startswith("{"):
            continue  # a directive of Sphinx
        assert block.language in (*RUN, *SHOWN), f"{block}: language {block.language!r}"
        assert set(block.options) <= {*WORDS}, f"{block}: {block.options}"
        assert "skip" not in block.options or len(block.options["skip"].split()) > 2, f"{block}"


@named(PAGES)
def test_commands_are_in_blocks_that_run(page):
    for content in indented(page):
        for line in content.splitlines():
            assert line.split(" ")[0] not in ("rmfs", "python", "pip", "$"), f"{page.name}: {line}"


def test_what_does_not_work_is_found(tmp_path, monkeypatch):
    """The collector itself: each kind of block can fail."""
    wrong = {
        "python": "assert 1 == 2",
        "sh": "rmfs run --layout nowhere --out x",
        "toml": 'format = "rmfs-design/1"\nname = "x"\nseeds = [1]\n[base]\nlayout = "nowhere"\n'
        'scenario = "basic"\ncontrollers = "basic"',
        "json": "{",
        "text output": "something\n...\nelse",
    }
    for info, content in wrong.items():
        page = tmp_path / "page.md"
        page.write_text(f"# Page\n\n```{info}\n{content}\n```\n")
        (block,) = blocks(page)
        with pytest.raises((AssertionError, ValueError)):
            run(block, Session(tmp_path, printed="something\nis\nthere"))
    page.write_text("```text output\nsomething\n...\nthere\n```\n")
    run(blocks(page)[0], Session(tmp_path, printed="something\nis\nthere  \n"))
