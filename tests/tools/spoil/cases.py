"""Cases: a number says what is spoilt, how, and which command is called with it."""

from __future__ import annotations

import json
import random
import shutil
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs import instances
from tests.tools.spoil import mutations, samples
from tests.tools.spoil.folders import spoil_run, spoil_study

if TYPE_CHECKING:
    from collections.abc import Callable
    from random import Random

RUN = ["run", "--layout", "small", "--scenario", "small", "--controllers", "default"]
OUT = ["--out", "out"]


@dataclass(frozen=True)
class Case:
    """One call of the command line, its files written already.

    Attributes
    ----------
    kind
        What was spoilt.
    """

    number: int
    kind: str
    arguments: list[str]


def made(number: int, whole: Path, here: Path) -> Case:
    """Write the files of a case into an empty folder.

    Parameters
    ----------
    whole
        Folder of `samples.prepared`.
    here
        Working folder of the command.
    """
    rng = random.Random(f"spoil/{number}")
    kind = rng.choice([kind for kind, (weight, _) in KINDS.items() for _ in range(weight)])
    return Case(number, kind, KINDS[kind][1](rng, whole, here))


def run_with(option: str, name: str, *, short: bool = True) -> list[str]:
    """Return a run of the small site in which one input is another."""
    arguments = [*RUN, *OUT, *(samples.SHORT if short else [])]
    arguments[arguments.index(option) + 1] = name
    return arguments


@cache
def _trees(kind: str) -> list[tuple[str, dict[str, Any]]]:
    return samples.shipped(kind)


def _tree_or_text(rng: Random, tree: Any, write: Callable[[Any], str]) -> bytes:
    """Spoil values and keys, or, more rarely, letters of the file."""
    if rng.random() < 0.8:
        return write(mutations.tree(rng, tree)).encode("utf-8", "surrogatepass")
    return mutations.text(rng, write(tree))


def _layout(rng: Random, whole: Path, here: Path) -> list[str]:
    _, tree = rng.choice([one for one in _trees("layouts") if one[0] in ("small", "basic")])
    (here / "in.toml").write_bytes(_tree_or_text(rng, tree, mutations.toml))
    return _with_layout(rng, "in.toml")


def _with_layout(rng: Random, name: str) -> list[str]:
    return rng.choice(
        (
            run_with("--layout", name),
            run_with("--layout", name),
            ["layout", "check", name],
            ["layout", "show", name, "--out", "out.svg"],
            ["layout", "convert", name, "--out", "out.json"],
        )
    )


def _explicit(rng: Random, whole: Path, here: Path) -> list[str]:
    tree = samples.tree(whole / "small.json")
    (here / "in.json").write_bytes(_tree_or_text(rng, tree, json.dumps))
    return _with_layout(rng, "in.json")


def _scenario(rng: Random, whole: Path, here: Path) -> list[str]:
    _, tree = rng.choice([one for one in _trees("scenarios") if "large" not in one[0]])
    content = _tree_or_text(rng, tree, mutations.toml)
    (here / "in.toml").write_bytes(content)
    for words in (instances.ROOT / "scenarios").glob("*.txt"):
        shutil.copy(words, here)
    if rng.random() < 0.25:
        return ["scenario", rng.choice(("check", "show", "sku-set")), "in.toml"]
    return run_with("--scenario", "in.toml")


def _controllers(rng: Random, whole: Path, here: Path) -> list[str]:
    _, tree = rng.choice(_trees("controllers"))
    (here / "in.toml").write_bytes(_tree_or_text(rng, tree, mutations.toml))
    if rng.random() < 0.2:
        return ["controllers", rng.choice(("check", "show")), "in.toml"]
    return run_with("--controllers", "in.toml")


def _design(rng: Random, whole: Path, here: Path) -> list[str]:
    trees = [tomllib.loads(samples.DESIGN), samples.design("smoke")]
    (here / "in.toml").write_bytes(_tree_or_text(rng, rng.choice(trees), mutations.toml))
    return ["experiment", "plan", "in.toml", "--no-pilot", "--out", "out"]


def _stream(rng: Random, whole: Path, here: Path) -> list[str]:
    part, name = rng.choice((("demand", "orders.csv"), ("replenishment", "bundles.csv")))
    text = (whole / name).read_text("utf-8")
    spoilt = mutations.rows(rng, text) if rng.random() < 0.8 else mutations.text(rng, text)
    (here / "in.csv").write_bytes(spoilt)
    given = f'scenario.{part}={{ mode = "stream", file = "in.csv" }}'
    return [*RUN, *OUT, *samples.SHORT, "--set", given]


def _xml(rng: Random, whole: Path, here: Path) -> list[str]:
    files = samples.of_rawsimo()
    name = rng.choice(list(files))
    shutil.copytree(whole / "parts", here, dirs_exist_ok=True)
    (here / name).write_bytes(_spoilt_xml(rng, files[name]))
    options = {
        "a.xsett": "--scenario",
        "a.xconf": "--controllers",
        "a.xlayo": "--layout",
    }
    if name in options and rng.random() < 0.6:
        return run_with(options[name], name)
    return ["import", name, *OUT]


def _spoilt_xml(rng: Random, text: str) -> bytes:
    """Put numbers and words in the place of what stands between tags or quotes, or spoil text."""
    if rng.random() < 0.3:
        return mutations.text(rng, text)
    ends = [at for at, letter in enumerate(text) if letter in '<"']
    starts = [at + 1 for at, letter in enumerate(text) if letter in '>"']
    start = rng.choice([at for at in starts if any(end >= at for end in ends)])
    end = min(end for end in ends if end >= start)
    new = str(rng.choice((*mutations.NUMBERS, *mutations.TEXTS[:-1])))
    return (text[:start] + new.replace("<", "&lt;") + text[end:]).encode()


def _run_folder(rng: Random, whole: Path, here: Path) -> list[str]:
    shutil.copytree(whole / "run", here / "run")
    spoil_run(rng, here / "run")
    return rng.choice(
        (
            ["view", "run", "--export", "out.html"],
            ["view", "run", "--export", "out.html"],
            ["report", "run", "--out", "out.html"],
            ["plot", "run", "--out", "out", "--what", rng.choice(PICTURES)],
            ["compare", "run", str(whole / "run")],
            [*RUN[:-1], "pile-on", *OUT, *samples.SHORT, "--pacing", "replay=run"],
        )
    )


PICTURES = ("progression", "heat", "backlog", "turnover", "stations", "robots", "pile-on", "warmup")


def _study(rng: Random, whole: Path, here: Path) -> list[str]:
    shutil.copytree(whole / "study", here / "study")
    spoil_study(rng, here / "study")
    column = ["--column", "units_per_h"]
    return rng.choice(
        (
            ["experiment", "status", "study"],
            ["experiment", "table", "study", *column],
            ["experiment", "table", "study", "--anova", *column],
            ["experiment", "plot", "study", *column, "--file", "out.svg"],
            ["compare", "study", str(whole / "study")],
        )
    )


def _decision(rng: Random, whole: Path, here: Path) -> list[str]:
    question, solution = whole / "question.json", whole / "solution.json"
    spoilt = question if rng.random() < 0.7 else solution
    tree = samples.tree(spoilt)
    (here / "in.json").write_bytes(_tree_or_text(rng, tree, json.dumps))
    if spoilt is solution:
        return ["decisions", "check", str(question), "in.json"]
    commands = (
        ["decisions", "check", "in.json", str(solution)],
        ["decisions", "solve", "in.json", "--work", "0.02", *OUT],
        ["decisions", "bound", "in.json", "--work", "0.02"],
        ["decisions", "convert", "in.json", *OUT],
    )
    return rng.choice(commands)


def _options(rng: Random, whole: Path, here: Path) -> list[str]:
    """Call a run with `--set` of parameters that exist, and spoilt values; other options, too."""
    arguments = [*RUN, *OUT]
    for _ in range(rng.choice((1, 1, 2, 3))):
        if rng.random() < 0.2:
            arguments += rng.choice(
                (
                    ["--seed", str(rng.choice(mutations.NUMBERS))],
                    ["--pacing", f"{rng.choice(PACINGS)}{rng.choice(mutations.NUMBERS)}"],
                    ["--checkpoint-every", str(rng.choice(mutations.NUMBERS))],
                    ["--measure", str(rng.choice(mutations.TEXTS))],
                    ["--out", str(rng.choice(mutations.TEXTS)) + "o"],
                    ["--controllers", str(rng.choice(mutations.TEXTS))],
                )
            )
            continue
        part, sort = rng.choice(
            (("layout", "layouts"), ("scenario", "scenarios"), ("controllers", "controllers"))
        )
        tree = dict(_trees(sort))["small" if part != "controllers" else "default"]
        path = mutations.places(tree)
        chosen = rng.choice([one for one in path if not any(isinstance(k, int) for k in one)])
        node = tree
        for key in chosen:
            node = node[key]
        new = mutations.value(rng, node)
        bare = isinstance(new, str) and rng.random() < 0.5
        word = new if bare else mutations.toml_value(new)
        arguments += ["--set", f"{'.'.join((part, *chosen))}={word}"]
    return [*arguments, *samples.SHORT]


PACINGS = ("fixed=", "work", "wall", "instant", "replay=", "fixed", "")

KINDS: dict[str, tuple[int, Callable[[Random, Path, Path], list[str]]]] = {
    "layout": (3, _layout),
    "explicit layout": (3, _explicit),
    "scenario": (4, _scenario),
    "controllers": (3, _controllers),
    "design": (2, _design),
    "stream": (2, _stream),
    "xml": (3, _xml),
    "run folder": (4, _run_folder),
    "study": (2, _study),
    "decision": (2, _decision),
    "options": (4, _options),
}
"""Each kind with its weight."""
