"""Safe reading of XML files of unknown origin, in the formats of RAWSim-O.

The standard library's parser expands entities. A file that declares a document type is therefore
refused at the declaration, so that it cannot define entities or cause other files to be read.
Memory is bounded by limits on the size of the file, the number of its elements, and the length of
each tag and text. Unknown elements are reported (`Unknown`), never silently dropped.
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

LARGEST_MIB = 64
"""Maximum size of a file in MiB; the largest published one has 4 MiB."""

MOST_ELEMENTS = 2_000_000
"""Maximum number of elements; the largest published file has 60,000."""

LARGEST_GAP = 1 << 20
"""Maximum number of bytes from the start of one element to the next; limits tags and texts."""

_CHUNK_BYTES = 1 << 16


class _RefusedError(Exception):
    """Reading was stopped, for the reason in the message."""


class _PlainTree(ElementTree.TreeBuilder):
    """Builds the tree, but stops at a document type declaration and at too many elements."""

    def __init__(self) -> None:
        super().__init__()
        self.elements = 0

    def doctype(self, name: str, pubid: str | None, system: str | None) -> None:
        raise _RefusedError("declares a document type (<!DOCTYPE>), which is refused")

    def start(self, tag: str, attributes: dict[str, str], /) -> Element:
        self.elements += 1
        if self.elements > MOST_ELEMENTS:
            raise _RefusedError(f"more than {MOST_ELEMENTS} elements")
        return super().start(tag, attributes)


def read_root(path: Path, root: str) -> Element:
    """Parse a file and return its root element.

    Parameters
    ----------
    root
        Required name of the root element.

    Raises
    ------
    InputError
        If the file is missing or not XML, exceeds one of the limits, declares a document type, or
        has another root element.
    """
    try:
        found = _parsed(path, root)
    except _RefusedError as refused:
        raise InputError(f"{path}: {refused}") from None
    except FileNotFoundError:
        raise InputError(f"{path}: no such file") from None
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror})") from None
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        raise InputError(f"{path}: not a complete XML file ({error})") from None
    if found.tag != root:
        raise InputError(f"{path}: root element is <{found.tag:.60}>, expected <{root}>")
    return found


def _parsed(path: Path, root: str) -> Element:
    """Parse a file piece by piece, so that reading stops at the first content that is refused."""
    tree = _PlainTree()
    parser = ElementTree.XMLParser(target=tree)
    read = elements = gap = 0
    blank = True
    with path.open("rb") as file:
        while chunk := file.read(_CHUNK_BYTES):
            read += len(chunk)
            if read > LARGEST_MIB << 20:
                raise _RefusedError(f"larger than {LARGEST_MIB} MiB")
            blank = blank and not chunk.strip()
            parser.feed(chunk)
            gap = 0 if tree.elements > elements else gap + len(chunk)
            if gap > LARGEST_GAP:
                raise _RefusedError(f"more than {LARGEST_GAP >> 20} MiB without an element")
            elements = tree.elements
    if blank:
        raise _RefusedError(f"empty, expected an XML file with root <{root}>")
    found: Element = parser.close()
    return found


class Unknown:
    """Counts unknown elements and attributes.

    Attributes
    ----------
    names
        Number of occurrences by name, for example `Bot.Colour` for an attribute and
        `Waypoints/Note` for an element.
    """

    def __init__(self) -> None:
        self.names: Counter[str] = Counter()

    def attributes(self, element: Element, known: Collection[str]) -> None:
        """Count the unknown attributes of an element."""
        for name in element.attrib:
            if name not in known and not name.startswith(SCHEMA_NAMESPACE):
                self.names[f"{element.tag}.{name}"] += 1

    def children(self, element: Element, known: Collection[str]) -> None:
        """Count the unknown children of an element."""
        for child in element:
            if child.tag not in known:
                self.names[f"{element.tag}/{child.tag}"] += 1

    def notes(self) -> list[str]:
        """Return one remark per unknown name."""
        return [
            f"{name} is unknown and was left out ({times} times)"
            for name, times in sorted(self.names.items())
        ]
