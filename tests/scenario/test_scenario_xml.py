"""The reader of all XML files: bounded, and proof against hostile ones."""

from __future__ import annotations

import resource
from pathlib import Path

import pytest

from rmfs.errors import InputError
from rmfs.rawsimo import xml
from rmfs.rawsimo.scenario import read_xgenc, read_xitem, read_xsett
from rmfs.rawsimo.xml import Unknown, read_root

LAUGHS = "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10 if i else "ha"}">' for i in range(12))
BROKEN: dict[str, tuple[str | bytes, str]] = {
    "billion laughs": (f"<!DOCTYPE r [{LAUGHS}]><r>&a11;</r>", "declares a document type"),
    "quadratic": (f'<!DOCTYPE r [<!ENTITY a "{"x" * 9999}">]><r>&a;</r>', "declares a document"),
    "external": ('<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><r>&x;</r>', "declares"),
    "subset": ('<!DOCTYPE r SYSTEM "http://localhost/"><r/>', "declares a document type"),
    "utf-16": ('<!DOCTYPE r SYSTEM "x"><r/>'.encode("utf-16"), "declares a document type"),
    "empty": ("", "empty, expected an XML file"),
    "blank": (" \n" * 99, "empty, expected an XML file"),
    "truncated": ("<r><a>", "not a complete XML file"),
    "undefined": ("<r>&x;</r>", "not a complete XML file"),
    "binary": (bytes(range(256)), "not a complete XML file"),
    "archive": (b"PK\x03\x04" + bytes(200), "not a complete XML file"),
    "encoding": ('<?xml version="1.0" encoding="none-such"?><r/>', "not a complete XML file"),
    "other root": ("<html></html>", "root element is <html>, expected <"),
    "long root": (f"<{'h' * 999}/>", "root element is <hhh"),
    "long tag": ("<r " + "".join(f"a{i}='' " for i in range(10**6)) + "/>", "more than 1 MiB"),
    "long text": ("<r>" + "x" * 10**7 + "</r>", "more than 1 MiB without an element"),
    "elements": ("<r>" + "<a/>" * 2_000_001 + "</r>", "more than 2000000 elements"),
    "depth": ("<r>" + "<a>" * 900_000, "not a complete XML file"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_file_is_one_clear_error_in_bounded_memory(tmp_path: Path, name: str):
    content, problem = BROKEN[name]
    path = tmp_path / "file.xml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(InputError) as caught:
        read_root(path, "r")
    message = str(caught.value)
    assert message.startswith(f"{path}: {problem}")
    assert "\n" not in message
    assert len(message) < len(str(path)) + 200
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 600_000


@pytest.mark.parametrize("read", [read_xgenc, read_xitem, read_xsett])
def test_every_reader_uses_it(tmp_path: Path, read):
    path = tmp_path / "file.xml"
    path.write_text(f"<!DOCTYPE r [{LAUGHS}]><r>&a11;</r>")
    with pytest.raises(InputError, match="declares a document type"):
        read(path)
    with pytest.raises(InputError, match="no such file"):
        read(tmp_path / "none.xml")
    with pytest.raises(InputError, match="cannot be read"):
        read(tmp_path)


def test_a_file_that_never_ends():
    with pytest.raises(InputError, match="not a complete XML file"):
        read_root(Path("/dev/zero"), "r")


def test_a_large_file_of_the_right_kind_is_refused(tmp_path: Path, monkeypatch):
    monkeypatch.setattr(xml, "LARGEST_MIB", 1)
    path = tmp_path / "file.xml"
    path.write_text("<r>" + "<a></a>" * 150_000 + "</r>")
    with pytest.raises(InputError, match="larger than 1 MiB"):
        read_root(path, "r")


def test_unknown_names_are_counted(tmp_path: Path):
    path = tmp_path / "file.xml"
    path.write_text('<r a="1" b="2"><s/><s/><t/></r>')
    root, unknown = read_root(path, "r"), Unknown()
    unknown.attributes(root, ("a",))
    unknown.children(root, ("t",))
    assert unknown.notes() == [
        "r.b is unknown and was left out (1 times)",
        "r/s is unknown and was left out (2 times)",
    ]
