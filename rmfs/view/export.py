"""Export of one or two runs to a self-contained HTML file, which can be shared."""

from __future__ import annotations

import gzip
from typing import TYPE_CHECKING

from rmfs.files import replacing
from rmfs.view import pages, scene

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from rmfs.measure import RunFolder


def export(runs: Sequence[RunFolder], path: Path) -> None:
    """Write the page with the scenes of one or two runs to one file.

    Raises
    ------
    InputError
        If a run has no readable trace, or the file cannot be written.
    """
    # no time stamp: the same run gives the same file
    packed = [gzip.compress(scene.of_run(run), compresslevel=6, mtime=0) for run in runs]
    html = pages.single_file(packed)
    with replacing(path) as temporary:
        temporary.write_bytes(html)
