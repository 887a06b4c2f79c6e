"""Reading RAWSim-O's XML files from anybody's hands.

The standard library's parser expands entities; a file that declares a document type is refused, so
that none can be defined. What a reader does not know is noted, never silently dropped.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from rmfs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Collection
    from pathlib import Path
    from xml.etree.ElementTree import Element

SCHEMA_NAMESPACE = "{http://www.w3.org/2001/XMLSchema-instance}"
LARGEST_MIB = 256
"""The largest published layout takes 2 MiB."""


class _PlainTree(ElementTree.TreeBuilder):
    """Builds the tree, but stops at a document type declaration."""

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        raise _DocumentTypeError


class _DocumentTypeError(Exception):
    """The file declares a document type."""


def read_root(path: Path, root: str) -> Element:
    """Parse a file and return its root element.

    Parameters
    ----------
    root
        The name the root element must have.

    Raises
    ------
    InputError
        If the file is missing, too large, not XML, declares a document type or has another root.
    """
    try:
        if path.stat().st_size > LARGEST_MIB << 20:
            raise InputError(f"{path}: larger than {LARGEST_MIB} MiB")
        data = path.read_bytes()
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    if not data.strip():
        raise InputError(f"{path}: empty, expected an XML file with root <{root}>")
    parser = ElementTree.XMLParser(target=_PlainTree())
    try:
        parser.feed(data)
        found: Element = parser.close()
    except _DocumentTypeError:
        raise InputError(
            f"{path}: declares a document type (<!DOCTYPE>), which is refused"
        ) from None
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise InputError(f"{path}: not a complete XML file ({error})") from None
    if found.tag != root:
        raise InputError(f"{path}: root element is <{found.tag}>, expected <{root}>")
    return found


class Unknown:
    """Counts elements and attributes that a reader does not know.

    Attributes
    ----------
    names
        How often each was met, for example `Bot.Colour` (attribute) or `Waypoints/Note` (element).
    """

    def __init__(self) -> None:
        self.names: Counter[str] = Counter()

    def attributes(self, element: Element, known: Collection[str]) -> None:
        """Count the attributes of an element that are not known."""
        for name in element.attrib:
            if name not in known and not name.startswith(SCHEMA_NAMESPACE):
                self.names[f"{element.tag}.{name}"] += 1

    def children(self, element: Element, known: Collection[str]) -> None:
        """Count the children of an element that are not known."""
        for child in element:
            if child.tag not in known:
                self.names[f"{element.tag}/{child.tag}"] += 1

    def notes(self) -> list[str]:
        """Return one remark per unknown name."""
        return [
            f"{name} is unknown and was left out ({times} times)"
            for name, times in sorted(self.names.items())
        ]
