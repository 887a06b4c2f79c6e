"""Reading XML from strangers."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

from rmfs.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

LARGEST_BYTES = 2**26
"""Files above 64 MiB are refused: the largest published SKU set takes 2 MiB."""

CHUNK_BYTES = 2**16


class _DoctypeError(Exception):
    """The file declares a document type, with which entities could be defined."""


class _PlainTree(ElementTree.TreeBuilder):
    def doctype(self, name: str, pubid: str, system: str) -> None:
        raise _DoctypeError


def read_xml(path: Path, root: str) -> ElementTree.Element:
    """Read an XML file that must have a given root element and no document type declaration.

    Without such a declaration there are no entities but the five of XML itself, so nothing can
    expand and nothing outside the file is read.

    Raises
    ------
    InputError
        If the file cannot be read, is too large, is not such XML or has another root.
    """
    try:
        element = _parse(path)
    except _DoctypeError:
        raise InputError(f"{path}: a document type declaration is not allowed") from None
    except (ElementTree.ParseError, LookupError, ValueError) as error:
        raise InputError(f"{path}: not valid XML: {error}") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    if element.tag != root:
        raise InputError(f"{path}: root element is <{element.tag}>, expected <{root}>")
    return element


def _parse(path: Path) -> ElementTree.Element:
    parser = ElementTree.XMLParser(target=_PlainTree())
    with path.open("rb") as file:
        read = 0
        # in pieces, so that a forbidden declaration stops the reading where it stands
        while chunk := file.read(CHUNK_BYTES):
            read += len(chunk)
            if read > LARGEST_BYTES:
                raise ValueError(f"larger than {LARGEST_BYTES >> 20} MiB")
            parser.feed(chunk)
    element: ElementTree.Element = parser.close()
    return element
