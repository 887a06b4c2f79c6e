"""What the charts of the page show, computed by its own sources in Node."""

import json
import shutil
import subprocess
from pathlib import Path

import pytest

from rmfs.view import pages

WEB = Path(pages.__file__).parent / "web"
ROLLDOWN = WEB / "node_modules" / ".bin" / "rolldown"

needs_sources = pytest.mark.skipif(
    shutil.which("node") is None or not ROLLDOWN.exists(),
    reason="needs Node, and `npm ci` in rmfs/view/web",
)

PROGRAM = """
import {{ Kind, course }} from "./data.mjs";
const none = {{ hasLevels: false, words: [], tasks: [] }};
const all = {events}.map(([time_s, kind, order, units]) => (
  {{ time_us: 1e6 * time_s, kind: Kind[kind], order, units }}
));
console.log(JSON.stringify(course({{ all }}, none, 1e6 * {end_s})));
"""


def course(folder: Path, events: list[tuple[int, str, int, int]], end_s: int) -> dict[str, list]:
    """Return the courses of a run with the given events: time (s), kind, order and units."""
    named = (("figures", "course"), ("events", "Kind"))
    lines = [f"export {{ {what} }} from {str(WEB / 'src/data' / name)!r};" for name, what in named]
    (folder / "data.ts").write_text("\n".join(lines))
    bundle = [ROLLDOWN, "data.ts", "--format", "esm", "--file", "data.mjs"]
    subprocess.run(bundle, cwd=folder, check=True, capture_output=True)
    program = PROGRAM.format(events=json.dumps(events), end_s=end_s)
    (folder / "main.mjs").write_text(program)
    told = subprocess.run(["node", "main.mjs"], cwd=folder, check=True, capture_output=True)
    return json.loads(told.stdout)


@needs_sources
def test_an_order_waits_until_its_first_part_is_assigned_or_it_is_cancelled(tmp_path):
    events = [
        (0, "ORDER_CREATED", 0, 2),
        (0, "ORDER_CREATED", 1, 1),
        (0, "ORDER_CREATED", 2, 1),
        (10, "ORDER_ASSIGNED", 0, 1),
        (70, "ORDER_ASSIGNED", 0, 1),
        (130, "ORDER_CANCELLED", 1, 0),
    ]
    assert course(tmp_path, events, 180)["backlog"] == [2, 2, 1]


@needs_sources
def test_each_unit_is_counted_in_a_bin(tmp_path):
    events = [(60, "UNIT_PICKED", 0, 1), (119, "UNIT_PICKED", 0, 1)]
    assert course(tmp_path, events, 120)["unitsPerHour"] == [0, 120]
