"""Report of a run as one self-contained HTML file."""

from __future__ import annotations

import base64
import io
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rmfs.files import write_text
from rmfs.measure.dictionary import TABLES
from rmfs.measure.pictures import PICTURES, picture
from rmfs.measure.summary import summarised

if TYPE_CHECKING:
    from rmfs.measure.folder import RunFolder

TEMPLATE = Path(__file__).with_name("report.html.jinja")

SHOWN = ("stations", "controllers")
"""Tables that the report shows completely."""

INPUTS = ("layout", "scenario", "controllers", "overrides", "notes")
"""Keys of `run.json` that describe what was simulated; its other keys describe the provenance."""


def write_report(run: RunFolder, path: Path) -> None:
    """Write the report of a run.

    Raises
    ------
    InputError
        If the run folder lacks a table, or the file cannot be written.
    """
    write_text(path, render(run))


def render(run: RunFolder) -> str:
    """Return the report as HTML; everything taken from the run is escaped."""
    import jinja2

    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    footprint = run.footprint
    names = " / ".join(str(footprint[part]) for part in ("layout", "scenario", "controllers"))
    told = run.parameters
    provenance = {key: value for key, value in told.items() if key not in INPUTS}
    return environment.from_string(TEMPLATE.read_text(encoding="utf-8")).render(
        title=f"{names}, seed {footprint['seed']}",
        subtitle=f"{footprint['duration_s'] / 3600.0:g} h measured after "
        f"{footprint['warmup_s'] / 3600.0:g} h of warm-up, written {told.get('written', '')}",
        main=summarised(footprint).rows,
        pictures=[(name, title, _png(run, name)) for name, (_, _, title) in PICTURES.items()],
        footprint=[
            (column.name, _text(footprint[column.name]), column.unit, column.meaning)
            for column in (*TABLES["footprint"], *run.own_columns)
        ],
        tables=[_table(run, name) for name in SHOWN],
        parameters=[
            *((f"Parameters: {key}", _json(told.get(key))) for key in INPUTS),
            ("Provenance", _json(provenance)),
        ],
    )


def _png(run: RunFolder, name: str) -> str:
    """Return a plot encoded for a data URL."""
    content = io.BytesIO()
    picture(run, name).savefig(content, format="png", dpi=110, metadata={"Software": None})
    return base64.b64encode(content.getvalue()).decode("ascii")


def _table(run: RunFolder, name: str) -> tuple[str, list[str], list[list[str]]]:
    frame = run.table(name)
    rows = [[_text(value) for value in row] for row in frame.itertuples(index=False)]
    return name.capitalize(), list(frame.columns), rows


def _text(value: Any) -> str:
    """Return a value as readable text; empty for what was not measured."""
    import pandas as pd

    if pd.isna(value):
        return ""
    return f"{value:,.6g}" if isinstance(value, float) else str(value)


def _json(value: Any) -> str:
    return json.dumps(value, indent=2, ensure_ascii=False)
