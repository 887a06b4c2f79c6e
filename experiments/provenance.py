"""Writes provenance files, which say where the numbers of tables and plots come from."""

from __future__ import annotations

import hashlib
import json
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.experiments.running.code import code
from rmfs.files import write_text
from rmfs.measure.provenance import commit

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pandas as pd

FORMAT = "rmfs-provenance/1"
SUFFIX = ".provenance.json"


def write(
    path: Path,
    frame: pd.DataFrame,
    *,
    design: str,
    design_hash: str,
    columns: Sequence[str],
    **more: Any,
) -> Path:
    """Write the provenance file of a table or plot.

    Parameters
    ----------
    path
        The file of the table or plot. The provenance file is named after it, with
        `.provenance.json` appended.
    frame
        The rows from which the table or plot was made, as returned by `experiments.load`.
    design, design_hash
        Name and hash of the design.
    columns
        Columns that the table or plot shows.
    more
        Anything else that determines the table or plot, such as the confidence.

    Returns
    -------
    The path of the provenance file.
    """
    made_by = sorted({(row.code, row.git_commit) for row in frame.itertuples()})
    told = {
        "format": FORMAT,
        "file": path.name,
        "design": design,
        "design_hash": design_hash,
        "columns": list(columns),
        **more,
        "rows": {
            "count": len(frame),
            "arms": int(frame["arm"].nunique()),
            "seeds": sorted({int(seed) for seed in frame["replication"]}),
            "sha256": rows_hash(frame, columns),
            "runs": sorted(frame["run"]),
        },
        "runs_made_by": [{"code": made, "git_commit": told} for made, told in made_by],
        "written_by": {**code(), **commit()},
        "command": command(),
    }
    target = path.with_name(path.name + SUFFIX)
    write_text(target, json.dumps(told, indent=1, ensure_ascii=False, default=str) + "\n")
    return target


def command() -> str:
    """Return the command line of this process; absolute paths like `/a/b/c` become `.../c`."""
    module = getattr(sys.modules["__main__"], "__spec__", None)
    name = Path(sys.argv[0]).name if module is None else f"python -m {module.name}"
    given = [f".../{Path(one).name}" if Path(one).is_absolute() else one for one in sys.argv[1:]]
    return shlex.join([*name.split(), *given])


def rows_hash(frame: pd.DataFrame, columns: Sequence[str]) -> str:
    """Return a hash of the values of `arm`, `replication` and `columns` in all rows.

    Equal results have the same hash on all machines.
    """
    chosen = [*dict.fromkeys(["arm", "replication", *(c for c in columns if c in frame)])]
    text = frame.sort_values(["arm", "replication"], kind="stable")[chosen].to_csv(index=False)
    return hashlib.sha256(text.encode()).hexdigest()
