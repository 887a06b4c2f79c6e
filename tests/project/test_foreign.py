"""Files of other systems are read by their suffix."""

from __future__ import annotations

from pathlib import Path

import pytest

from rmfs import foreign
from rmfs.errors import InputError


def test_a_file_without_a_reader_is_refused_with_the_valid_suffixes() -> None:
    with pytest.raises(InputError, match=r"plan\.xyz: no reader for this suffix; valid: .*\.xinst"):
        foreign.read(Path("plan.xyz"))
