"""Code blocks of Markdown pages, and what running them means.

A page is one session: its blocks run in order, in one folder and one Python namespace. The first
word of a block's info string is its language; further words:

    file=NAME       the block is written to a file instead of being run
    from=PATH       the block is part of a file of the project, word for word
    output          (text) what the block before has printed; a line `...` stands for any lines
    serves          (sh) each command is a server: it runs until it has told its address
    reference       (sh) needs the public instances of RAWSim-O, in the folder $RAWSIMO
    slow            runs only in the slow suite
    skip="WHY"      never runs; the reason is for the reader of the source

Packages for documents with examples (sybil, pytest-examples) run Python blocks; commands, files,
outputs and slow blocks of one session would all have to be added to them.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import traceback
from dataclasses import dataclass, field
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from markdown_it import MarkdownIt

from rmfs.cli import INTERRUPTED, main

ROOT = Path(__file__).resolve().parents[2]
RAWSIMO = ROOT.parent / "shared" / "reference" / "instances"
WORDS = ("file", "from", "output", "reference", "serves", "slow", "skip")
HERE = "PYTHONPATH=."
"""What the folder of a page is for the tests anyway."""
CELL = "{code-cell}"
"""A cell of a notebook page: slow, and `make docs` runs it, too."""


@dataclass(frozen=True)
class Block:
    """A fenced block of a page."""

    page: Path
    line: int
    language: str
    options: dict[str, str]
    content: str

    def __str__(self) -> str:
        return f"{self.page.name}:{self.line}"


@dataclass
class Session:
    """What the blocks of a page share."""

    folder: Path
    names: dict[str, Any] = field(default_factory=lambda: {"__name__": "__main__"})
    printed: str = ""


def blocks(page: Path) -> list[Block]:
    """Return the fenced blocks of a page."""
    text = re.sub(r"\A---\n.*?\n---\n", lambda m: "\n" * m[0].count("\n"), page.read_text("utf-8"),
                  flags=re.DOTALL)  # fmt: skip
    found = []
    for token in MarkdownIt().parse(text):
        if token.type == "fence":
            assert token.map is not None
            language, *words = shlex.split(token.info) or [""]
            options = {k: v for k, _, v in (word.partition("=") for word in words)}
            if language == CELL:
                language, options = "python", {"slow": ""}
            found.append(Block(page, token.map[0] + 1, language, options, token.content))
    return found


def indented(page: Path) -> list[str]:
    """Return the blocks that are code by being indented: they have no language and never run."""
    tokens = MarkdownIt().parse(page.read_text("utf-8"))
    return [token.content for token in tokens if token.type == "code_block"]


def run(block: Block, session: Session) -> None:
    """Do what a block says.

    Raises
    ------
    AssertionError
        If it does not work.
    """
    if "file" in block.options:
        path = session.folder / block.options["file"]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.content, encoding="utf-8")
    if "from" in block.options:
        assert block.content in (ROOT / block.options["from"]).read_text("utf-8"), f"{block}"
        return
    {"python": _python, "sh": _shell, "toml": _toml, "json": _json, "text": _text}[block.language](
        block, session
    )


def _python(block: Block, session: Session) -> None:
    if "file" in block.options:
        compile(block.content, block.options["file"], "exec")
        return
    printed = io.StringIO()
    # the line numbers of a traceback are those of the page
    code = compile("\n" * block.line + block.content, str(block.page), "exec")
    with contextlib.redirect_stdout(printed):
        try:
            exec(code, session.names)
        except Exception:
            raise AssertionError(f"{block}: {traceback.format_exc()}") from None
    session.printed = printed.getvalue()


def _shell(block: Block, session: Session) -> None:
    printed = []
    for command in re.sub(r"\\\n\s*", "", block.content).splitlines():
        words = shlex.split(command, comments=True)
        if not words:
            continue
        if "serves" in block.options:
            code, told = _served(command)
        else:
            code, told = _ours(words) if _is_ours(command, words) else _foreign(command)
        assert code == 0, f"{block}: {command}: exit code {code}\n{told}"
        printed.append(told)
    session.printed = "".join(printed)


def _is_ours(command: str, words: list[str]) -> bool:
    """Whether a command can be run in this process, which has everything imported."""
    plain = not re.search(r"[|;&><$*?]", command.split(" #")[0])
    return plain and next(word for word in words if word != HERE) == "rmfs"


def _ours(words: list[str]) -> tuple[int, str]:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed):
        code = main(words[1 + words.index("rmfs") :])
    return code, printed.getvalue()


def _foreign(command: str) -> tuple[int, str]:
    told = subprocess.run(
        ["bash", "-c", command], capture_output=True, text=True, check=False, env=_environment()
    )
    return told.returncode, told.stdout + told.stderr


def _served(command: str) -> tuple[int, str]:
    """Run a server until it tells its address, then interrupt it."""
    with subprocess.Popen(
        ["bash", "-c", f"exec {command}"],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        env=_environment() | {"BROWSER": "true", "PYTHONUNBUFFERED": "1"},
    ) as server:
        assert server.stdout is not None
        told = ""
        for line in server.stdout:
            told += line
            if "http://" in line:
                server.send_signal(signal.SIGINT)
                break
        told += server.stdout.read()
        code = server.wait()
    return (0 if "http://" in told and code in (0, INTERRUPTED) else code or 1), told


def _environment() -> dict[str, str]:
    # beside the interpreter of the tests is the `rmfs` of the tests
    return os.environ | {
        "RAWSIMO": str(RAWSIMO),
        "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}",
    }


def _toml(block: Block, session: Session) -> None:
    from rmfs import control, experiments, layout, scenario
    from rmfs.config import read_toml

    path = session.folder / block.options.get("file", "block.toml")
    path.write_text(block.content, encoding="utf-8")
    form = str(read_toml(path).get("format", "")).partition("/")[0]
    if form == "rmfs-design":
        assert experiments.plan(path).problems == [], f"{block}"
    elif form == "rmfs-cluster":
        from rmfs.experiments.running.cluster import read_profile

        read_profile(path)
    else:
        {"rmfs-layout": layout, "rmfs-scenario": scenario, "rmfs-controllers": control}[form].load(
            str(path)
        )


def _json(block: Block, session: Session) -> None:
    json.loads(block.content)


def _text(block: Block, session: Session) -> None:
    if "output" in block.options:
        wanted = _pattern(block.content)
        assert fnmatch(_bare(session.printed), wanted), f"{block}: printed was\n{session.printed}"


def _bare(text: str) -> str:
    return "\n".join(line.rstrip() for line in text.strip().splitlines())


def _pattern(text: str) -> str:
    """Return a shell pattern for an output: a line `...` stands for any lines."""
    quoted = re.sub(r"([\[*?])", r"[\1]", _bare(text))
    return re.sub(r"^\.\.\.$", "*", quoted, flags=re.MULTILINE)
