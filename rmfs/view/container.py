"""The binary container in which a scene is sent to the page: a JSON header and arrays.

A container consists of eight fixed bytes that identify the format, the length of the header (8
bytes, little-endian), the header, and the arrays. Each array starts at a multiple of eight bytes,
so that the page can use it without copying.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

MAGIC = b"RMFSSCN1"
FORMAT = "rmfs-scene/1"
MIME = "application/vnd.rmfs.scene"

TYPES = {"|u1": "u1", "<i4": "i4", "<f4": "f4", "<f8": "f8"}
"""Names of the supported element types in the header, by their NumPy names."""


def pack(header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """Pack a header and arrays into one container.

    Parameters
    ----------
    header
        Values that JSON can represent. This function adds `format`, `size` and `arrays` (type,
        offset and length of each array).
    arrays
        One-dimensional arrays: each of unsigned bytes, 32-bit integers, or 32- or 64-bit reals.
    """
    directory: dict[str, list[Any]] = {
        name: [TYPES[a.dtype.str], 0, len(a)] for name, a in arrays.items()
    }
    # offsets change the length of the header, so room for the longest is kept
    whole = {**header, "format": FORMAT, "size": 0, "arrays": directory}
    room = len(_json(whole)) + 16 * (len(arrays) + 1)
    offset = _aligned(16 + room)
    head_length = offset - 16
    for name, array in arrays.items():
        directory[name][1] = offset
        offset = _aligned(offset + array.nbytes)
    whole["size"] = offset
    parts: list[bytes | memoryview] = [
        MAGIC,
        head_length.to_bytes(8, "little"),
        _json(whole).ljust(head_length),
    ]
    for array in arrays.values():
        # joined where they are: a run that is watched has no time for copies
        parts += [np.ascontiguousarray(array).view(np.uint8).data, bytes(-array.nbytes % 8)]
    return b"".join(parts)


def unpack(content: bytes) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
    """Return the header and the arrays of a container.

    Raises
    ------
    ValueError
        If the bytes are not a container, or the container is truncated.
    """
    if content[:8] != MAGIC:
        raise ValueError("not a scene")
    length = int.from_bytes(content[8:16], "little")
    header = json.loads(content[16 : 16 + length])
    if len(content) < header["size"]:
        raise ValueError("cut off")
    arrays = {
        name: np.frombuffer(content, kind, count, offset)
        for name, (kind, offset, count) in header["arrays"].items()
    }
    return header, arrays


def _aligned(offset: int) -> int:
    return -(-offset // 8) * 8


def _json(value: object) -> bytes:
    return json.dumps(value, ensure_ascii=False, allow_nan=False).encode()
