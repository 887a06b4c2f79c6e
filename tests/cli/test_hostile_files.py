"""Files of every kind from hostile hands: one clear error each, in bounded memory."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from rawsimo_files import resources

from rmfs.cli import main

LAUGHS = "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10 if i else "ha"}">' for i in range(12))
ROOTS = {
    ".xinst": "Instance",
    ".xlayo": "LayoutConfiguration",
    ".xsett": "SettingConfiguration",
    ".xconf": "ControlConfiguration",
    ".xgenc": "SimpleItemGeneratorConfiguration",
    ".xitem": "OrderList",
}
HOSTILE = {  # and a line of 1 GB, see below
    "empty": "empty",
    "truncated": "not a complete XML file",
    "binary": "not a complete XML file",
    "billion laughs": "declares a document type",
    "external entity": "declares a document type",
}
GIB = 1 << 30


def content(what: str, root: str) -> bytes:
    texts = {
        "empty": "",
        "truncated": f"<{root}><Name>cut o",
        "billion laughs": f"<!DOCTYPE {root} [{LAUGHS}]><{root}>&a11;</{root}>",
        "external entity": f'<!DOCTYPE {root} [<!ENTITY x SYSTEM "file:///etc/passwd">]>'
        f"<{root}><Name>&x;</Name></{root}>",
        "1 GB line": f"<{root}><!--",
    }
    return bytes(range(256)) * 9 if what == "binary" else texts[what].encode()


def written(path: Path, what: str, start: bytes) -> Path:
    """Write a file; one whose line has no end is a gibibyte long but takes no room on the disk."""
    with path.open("wb") as file:
        file.write(start)
        if what == "1 GB line":
            file.truncate(GIB)
    return path


def refused(arguments: list[str], capsys) -> str:
    """Return the one line that a command ends in."""
    assert main(arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert len(line) < 500
    return line


@pytest.mark.parametrize("what", HOSTILE)
@pytest.mark.parametrize("suffix", ROOTS)
def test_hostile_xml_in_place_of_a_part(suffix, what, tmp_path, capsys):
    path = written(tmp_path / f"file{suffix}", what, content(what, ROOTS[suffix]))
    parts = {".xsett": ["--scenario", str(path)], ".xconf": ["--controllers", str(path)]}
    parts[".xgenc"] = ["--set", f'scenario.skus={{ file = "{path}" }}']
    parts[".xitem"] = ["--set", f'scenario.demand={{ mode = "stream", file = "{path}" }}']
    given = parts.get(suffix, ["--layout", str(path)])
    line = refused(["run", "--scenario", "basic", *given, "--out", str(tmp_path / "o")], capsys)
    assert line.startswith(f"rmfs: {path}: ")
    assert HOSTILE[what] in line
    assert not (tmp_path / "o").exists()


HEAD = "time,order,sku,quantity,due\n"
BROKEN_ROWS = {
    "negative quantity": (HEAD + "1,a,0,-2,\n", "line 2: quantity must be from 1 to"),
    "unknown SKU": (HEAD + "1,a,4711,2,\n", "line 2: sku 4711 is unknown"),
    "times out of order": (HEAD + "9,a,0,2,\n3,b,0,2,\n", "line 3: time 3 is earlier"),
    "empty": ("", "empty; line 1 must hold the names of the columns"),
    "truncated": (HEAD + "1,a,0", "line 2: "),
    "binary": (bytes(range(256)), "not text"),
    "1 GB line": (HEAD + "1,a,0,2,", "line 2: "),
}


@pytest.mark.parametrize("what", BROKEN_ROWS)
@pytest.mark.parametrize("part", ["demand", "replenishment"])
def test_hostile_streams(part, what, tmp_path, capsys):
    text, problem = BROKEN_ROWS[what]
    start = text if isinstance(text, bytes) else text.encode()
    path = written(tmp_path / "stream.csv", what, start)
    given = f'scenario.{part}={{ mode = "stream", file = "{path}" }}'
    line = refused(["run", "--scenario", "basic", "--set", given], capsys)
    assert str(path) in line
    assert problem in line


@pytest.mark.parametrize("name", ["file.toml", "file.json", "orders.parquet", "words.txt"])
@pytest.mark.parametrize("what", ["empty", "truncated", "binary", "deep", "1 GB line"])
def test_hostile_files_of_our_own_kinds(name, what, tmp_path, capsys):
    deep = b"" if name.endswith(".json") else b"a = "
    starts = {"truncated": b'{"format": "rmfs-l', "deep": deep + b"[" * 100_000}
    start = starts[what] if what in starts else content(what, "x")
    path = written(tmp_path / name, what, start)
    arguments = {
        "file.toml": ["--scenario", str(path)],
        "file.json": ["--layout", str(path)],
        "orders.parquet": ["--set", f'scenario.demand={{ mode = "stream", file = "{path}" }}'],
        "words.txt": ["--scenario", "letters", "--set", f'scenario.skus.words="{path}"'],
    }
    if name == "words.txt" and what in ("truncated", "deep"):
        pytest.skip("any letters are words")
    line = refused(["run", *arguments[name], "--out", str(tmp_path / "out")], capsys)
    assert str(path) in line


def reading(path: Path) -> list[str]:
    """Return a command that reads a file."""
    if path.suffix in ROOTS:
        return ["import", str(path), "--out", str(path.with_name("out"))]
    if path.suffix in (".toml", ".json"):
        return ["layout", "check", str(path)]
    given = f'scenario.demand={{ mode = "stream", file = "{path}" }}'
    return ["scenario", "check", "basic", "--set", given]


def test_a_line_of_1_gb_takes_no_memory(tmp_path):
    """One process reads a file of each kind; it may map 400 MiB more than it has before."""
    resources(tmp_path)
    names = [*(f"file{suffix}" for suffix in ROOTS), "a.csv", "a.toml", "a.json", "a.parquet"]
    paths = [tmp_path / name for name in names]
    for path in paths:
        xml = path.suffix in ROOTS
        start = content("1 GB line", ROOTS[path.suffix]) if xml else HEAD.encode()
        written(path, "1 GB line", start)
    done = subprocess.run(
        [sys.executable, str(Path(__file__).with_name("hostile.py")), "400"],
        input=json.dumps([reading(path) for path in paths]),
        capture_output=True,
        text=True,
        check=True,
    )
    for path, (code, told) in zip(paths, json.loads(done.stdout), strict=True):
        assert code == 2, path
        (line,) = told.splitlines()
        assert str(path) in line
