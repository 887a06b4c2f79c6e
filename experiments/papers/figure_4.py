"""Figure 4 of Merschformann, Xie and Li (2018): a layout with two stations of each kind.

Nothing is simulated: the layout is generated and drawn. The provenance file of the picture states
the numbers of waypoints, storage locations, pods and other elements of the layout.
"""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path

from rmfs import layout as layouts
from rmfs.digest import digest
from rmfs.experiments.papers.study import PUBLISHED, command
from rmfs.files import write_text
from rmfs.measure.provenance import commit

LAYOUT = "default"
OVERRIDES: list[tuple[list[str], object]] = [
    (["pick_stations"], {"east": 2}),
    (["replenishment_stations"], {"west": 2}),
    (["robots"], 16),
]


def counts(layout: layouts.Layout) -> dict[str, object]:
    """Return the numbers of waypoints, pods etc. of a layout, and whether it is well-formed."""
    return {
        "waypoints": layout.waypoints,
        "edges": len(layout.edge_target),
        "storage_places": int(layout.is_storage.sum()),
        "pods": layout.pods,
        "robots": layout.robots,
        "pick_stations": len(layout.pick_stations),
        "replenishment_stations": len(layout.replenishment_stations),
        "queue_places": [len(station.queue) for station in layout.pick_stations],
        "well_formed": not layouts.check(layout),
    }


def main(arguments: list[str] | None = None) -> None:
    """Draw the picture and write its provenance file."""
    options = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    options.add_argument("--published", type=Path, default=PUBLISHED)
    given = options.parse_args(arguments)
    layout = layouts.load(LAYOUT, OVERRIDES)
    path = given.published / "figure-4.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    layouts.save_picture(layout, path)
    told = {
        "format": "rmfs-provenance/1",
        "file": path.name,
        "layout": LAYOUT,
        "overrides": {".".join(keys): value for keys, value in OVERRIDES},
        "layout_digest": digest(layout),
        **counts(layout),
        "written_by": commit(),
    }
    write_text(path.with_name(f"{path.name}.provenance.json"), json.dumps(told, indent=1) + "\n")
    for name, value in counts(layout).items():
        print(f"{name}: {value}")
    print(path)


if __name__ == "__main__":
    sys.exit(command(main))
