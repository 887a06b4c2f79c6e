"""Spoiling what is well-formed: trees of values, rows of cells, texts and bytes."""

from __future__ import annotations

import copy
import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from random import Random

NUMBERS: tuple[Any, ...] = (
    *(0, -1, 1, 2, 3, 7, 255, 256, 65_536, 2**31, 2**63 - 1, 2**63, -(2**63), 10**30),
    *(0.0, -0.0, 0.5, 1e-9, 1e-10, 1e-300, 5e-324, 1e6, 1e9, 1e10, 1e20, 1e308),
    *(float("inf"), float("-inf"), float("nan"), -1e-9, -0.5),
)
TEXTS = (
    *("", " ", "x", "x" * 300, "x" * 5000, "../../x", "/", "\x07", "a\nb", "<b>&amp;</b>"),
    *("ä€𝄞", ":x", ".x:y", "json:loads", "nan", "1e3", "none", "random", "default", "%s{0}"),
)
OTHERS: tuple[Any, ...] = (True, False, None, [], {}, [[]], [0], {"name": "x"}, [{}], [[1, 2], 3])


def number(rng: Random, old: Any) -> Any:
    """Return a number in the place of another: near to it, far from it, or none at all."""
    if rng.random() < 0.5:
        return rng.choice(NUMBERS)
    factor = rng.choice((-1.0, 0.5, 2.0, 3.0, 10.0, 0.1, 10.0 ** rng.randint(-12, 12)))
    new = old * factor + rng.choice((0, 0, 1, -1))
    return int(new) if isinstance(old, int) and rng.random() < 0.8 else new


def value(rng: Random, old: Any) -> Any:
    """Return something in the place of a value: mostly of its kind."""
    if rng.random() < 0.15:
        return copy.deepcopy(rng.choice((*NUMBERS, *TEXTS, *OTHERS)))
    if isinstance(old, bool):
        return rng.choice((not old, "yes", 1, None))
    if isinstance(old, int | float):
        return number(rng, old)
    if isinstance(old, str):
        return rng.choice((*TEXTS, old + "x", old[:-1], old.upper(), old * 2))
    return copy.deepcopy(rng.choice((*OTHERS, *NUMBERS)))


def places(tree: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Return the paths of everything in a tree."""
    found = [path] if path else []
    items = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, below in items:
        if isinstance(below, dict | list):
            found += places(below, (*path, key))
        else:
            found.append((*path, key))
    return found


def tree(rng: Random, whole: Any) -> Any:
    """Spoil a tree of tables, lists and values at one to three places; the original stays."""
    spoilt = copy.deepcopy(whole)
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        # lists of thousands must not hide what stands beside them: go down level by level
        path = _descend(rng, spoilt)
        if path:
            _spoil(rng, spoilt, path)
    return spoilt


def _descend(rng: Random, node: Any) -> tuple[Any, ...]:
    path: tuple[Any, ...] = ()
    while isinstance(node, dict | list) and node and (not path or rng.random() < 0.9):
        key = rng.choice(list(node)) if isinstance(node, dict) else rng.randrange(len(node))
        path, node = (*path, key), node[key]
    return path


def _spoil(rng: Random, spoilt: Any, path: tuple[Any, ...]) -> None:
    node = spoilt
    for key in path[:-1]:
        node = node[key]
    key = path[-1]
    what = rng.choice(("value",) * 6 + ("delete", "copy", "swap", "add"))
    if what == "value":
        node[key] = value(rng, node[key])
    elif what == "delete":
        del node[key]
    elif what == "copy" and isinstance(node, list):
        node.insert(rng.randrange(len(node) + 1), copy.deepcopy(node[key]))
    elif what == "copy":
        node[rng.choice((f"{key}s", key.upper(), "x", ""))] = copy.deepcopy(node[key])
    elif what == "swap":
        other = rng.choice(list(node)) if isinstance(node, dict) else rng.randrange(len(node))
        node[key], node[other] = node[other], node[key]
    elif isinstance(node, list):
        node.append(value(rng, node[key]))
    else:
        node[key] = {str(key): node[key]} if rng.random() < 0.5 else [node[key]]


def text(rng: Random, whole: str) -> bytes:
    """Spoil a text by lines, words and bytes."""
    lines = whole.split("\n")
    at = rng.randrange(len(lines))
    match rng.choice(("delete", "twice", "swap", "cut", "bytes", "junk", "digits")):
        case "delete":
            del lines[at]
        case "twice":
            lines.insert(at, lines[at])
        case "swap":
            other = rng.randrange(len(lines))
            lines[at], lines[other] = lines[other], lines[at]
        case "cut":
            return whole.encode()[: rng.randrange(len(whole) + 1)]
        case "bytes":
            return raw(rng, whole.encode())
        case "junk":
            lines[at] += str(rng.choice((*TEXTS, "[" * 2000, "9" * 5000, '"', "'", "\\", "=", ",")))
        case "digits":
            word = rng.choice(lines[at].split() or [""])
            lines[at] = lines[at].replace(word, str(rng.choice(NUMBERS)), 1)
    return "\n".join(lines).encode("utf-8", "surrogatepass")


def raw(rng: Random, whole: bytes) -> bytes:
    """Spoil single bytes, take some away, or cut the rest off."""
    content = bytearray(whole)
    for _ in range(rng.choice((1, 2, 8))):
        if content:
            content[rng.randrange(len(content))] = rng.randrange(256)
    at = rng.randrange(len(content) + 1)
    match rng.choice(("as it is", "as it is", "cut", "gap", "more")):
        case "cut":
            del content[at:]
        case "gap":
            del content[at : at + rng.randint(1, 64)]
        case "more":
            content[at:at] = bytes(rng.randrange(256) for _ in range(rng.randint(1, 64)))
    return bytes(content)


def rows(rng: Random, whole: str) -> bytes:
    """Spoil a table of cells (CSV)."""
    table = [line.split(",") for line in whole.splitlines()]
    for _ in range(rng.choice((1, 1, 2, 3))):
        line = rng.choice(table)
        at = rng.randrange(len(line))
        match rng.choice(("cell", "cell", "cell", "delete", "more", "swap", "row")):
            case "cell":
                line[at] = str(rng.choice((*NUMBERS, *TEXTS, "2020-01-01", "1,5", '"')))
            case "delete":
                del line[at]
                line += [] if line else [""]
            case "more":
                line.append("1")
            case "swap":
                other = rng.choice(table)
                line[:], other[:] = other[:], line[:]
            case "row":
                table.insert(rng.randrange(len(table)), list(line))
    return "\n".join(",".join(line) for line in table).encode("utf-8", "surrogatepass")


def toml(whole: dict[str, Any]) -> str:
    """Write a tree as TOML, tables inline; what TOML cannot say becomes a text."""
    return "\n".join(f"{_key(key)} = {toml_value(below)}" for key, below in whole.items()) + "\n"


def _key(key: Any) -> str:
    return json.dumps(str(key))


def toml_value(node: Any) -> str:
    """Write a value as TOML has it on one line."""
    if isinstance(node, dict):
        return (
            "{"
            + ", ".join(f"{_key(key)} = {toml_value(below)}" for key, below in node.items())
            + "}"
        )
    if isinstance(node, list | tuple):
        return "[" + ", ".join(toml_value(below) for below in node) + "]"
    if isinstance(node, float):
        return repr(node)
    return '""' if node is None else json.dumps(node, default=str)
