"""The scene that a page draws: layout, motion and events of a run, as a header and flat arrays.

Motion is not sampled: the page gets all rows of the trace, and computes positions with the same
kinematics as the simulation.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np

from rmfs.layout import colours
from rmfs.layout.kinds import PICK, TASK_COLOURS
from rmfs.measure.events import KINDS
from rmfs.measure.trace import TRACE_COLUMNS
from rmfs.view.container import pack
from rmfs.view.themes import themes_of
from rmfs.world.tasks import VisitTask

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from rmfs.layout.model import Layout
    from rmfs.measure import RunFolder

Arrays = dict[str, "NDArray[Any]"]

EVENT_NUMBERS = ("robot", "pod", "station", "order", "sku", "units", "detail")


def of_run(folder: RunFolder) -> bytes:
    """Pack the scene of a recorded run.

    Raises
    ------
    InputError
        If the run cannot be replayed; see `RunFolder.replayed`.
    """
    layout, trace, log = folder.replayed()
    told = folder.parameters
    events = {name: log[name].to_numpy() for name in ("time_us", *EVENT_NUMBERS[:-1])}
    events["kind"] = log["kind"].map({name: number for number, name in enumerate(KINDS)}).to_numpy()
    detail = log["detail"].astype("category").cat
    events["detail"] = detail.codes.to_numpy()
    skus = folder.table("skus")
    header = head(
        layout,
        names={part: told[part]["name"] for part in ("layout", "scenario", "controllers")},
        seed=told["seed"],
        warmup_s=told["warmup_s"],
        end_s=told["warmup_s"] + told["duration_s"],
        title=folder.path.resolve().name,
        details=detail.categories.tolist(),
        sku_names=skus["name"].astype(str).tolist(),
        pickers=_has_pickers(told["scenario"]),
    )
    return pack(
        header,
        {
            **describe(layout, skus["space"].to_numpy()),
            **motion({name: trace[name].to_numpy() for name in TRACE_COLUMNS}, layout.robots),
            **happenings(events),
        },
    )


def head(
    layout: Layout,
    *,
    names: Mapping[str, str],
    seed: int,
    warmup_s: float,
    end_s: float,
    title: str,
    details: list[str],
    sku_names: Sequence[str] = (),
    pickers: bool = False,
) -> dict[str, Any]:
    """Return the header of a scene, with its texts and scalar values.

    Parameters
    ----------
    details
        The texts to which the numbers in the column `detail` of the events refer.
    sku_names
        Names of all SKUs; empty if SKUs have only numbers.
    pickers
        Whether the times of units depend on pickers. If so, `transfer_s` of pick stations is 0: the
        page then shows no idle share, which it would compute from a constant time.
    """
    return {
        "title": title,
        "names": dict(names),
        "seed": seed,
        "warmup_s": warmup_s,
        "end_s": end_s,
        "tiers": [asdict(tier) for tier in layout.tiers],
        "stations": [
            {
                "kind": station.kind.name,
                "letter": station.kind.letter,
                "handles": station.kind.handles,
                "waypoint": int(station.waypoint),
                "queue": [int(place) for place in station.queue],
                "radius_m": station.radius_m,
                "order_slots": getattr(station, "order_slots", 0),
                "transfer_s": 0.0
                if pickers and station.kind is PICK
                else station.kind.busy_s(station),
            }
            for station in layout.stations
        ],
        "elevators": [[int(w) for w in elevator.waypoints] for elevator in layout.elevators],
        "robot_kinds": [asdict(kind) for kind in layout.robot_kinds],
        "pod_radius_m": layout.pod_radius_m,
        "details": details,
        "sku_names": _told_names(sku_names),
        "colours": {
            name.lower(): value
            for name, value in vars(colours).items()
            if isinstance(value, str) and value.startswith("#")
        },
        "themes": themes_of(layout, _of_visits(layout)),
        "robot_colours": {
            "task": TASK_COLOURS | _of_visits(layout),
            "state": colours.STATES,
            "load": colours.LOADS,
        },
    }


def _has_pickers(scenario: Mapping[str, Any]) -> bool:
    """Return whether the entry `scenario` of a `run.json` has a table `pickers`."""
    parameters = scenario.get("parameters")
    return isinstance(parameters, dict) and parameters.get("pickers") is not None


def _told_names(names: Sequence[str]) -> list[str]:
    """Return the names of the SKUs; an empty list if each name is only the SKU's number."""
    own = any(name != str(number) for number, name in enumerate(names))
    return list(names) if own else []


def _of_visits(layout: Layout) -> dict[str, str]:
    """Return robot colours by task, for tasks at stations other than pick and replenishment."""
    return {kind.part("task", VisitTask).kind: kind.colour for kind in layout.other_kinds}


def describe(layout: Layout, sku_space: NDArray[np.float64]) -> Arrays:
    """Return the layout as arrays, with `sku_space`: the space that one unit of each SKU needs."""
    return {
        "x_m": layout.x_m.astype(np.float64),
        "y_m": layout.y_m.astype(np.float64),
        "tier": layout.tier.astype(np.uint8),
        "edge_start": layout.edge_start.astype(np.int32),
        "edge_target": layout.edge_target.astype(np.int32),
        "is_storage": layout.is_storage.astype(np.uint8),
        "is_queue": layout.is_queue.astype(np.uint8),
        "pod_waypoint": layout.pod_waypoint.astype(np.int32),
        "pod_capacity": layout.pod_capacity.astype(np.float64),
        "robot_waypoint": layout.robot_waypoint.astype(np.int32),
        "robot_heading_rad": layout.robot_heading_rad.astype(np.float64),
        "robot_kind": layout.robot_kind.astype(np.uint8),
        "sku_space": np.asarray(sku_space, np.float64),
    }


def motion(trace: Mapping[str, NDArray[Any]], robots: int) -> Arrays:
    """Return a trace as arrays; its rows must be sorted by robot and time.

    The rows of robot r begin at index `motion.robot_start[r]`. A row lasts until the robot's next
    row begins; the last row of robot r lasts until time `motion.end_us[r]`.
    """
    start = np.searchsorted(trace["robot"], np.arange(robots + 1)).astype(np.int32)
    end = np.zeros(robots)
    moved = start[1:] > start[:-1]
    end[moved] = trace["t1_us"][start[1:][moved] - 1]
    return {
        "motion.robot_start": start,
        "motion.end_us": end,
        "motion.t0_us": trace["t0_us"].astype(np.float64),
        "motion.kind": trace["kind"].astype(np.uint8),
        "motion.from_wp": trace["from_wp"].astype(np.int32),
        "motion.to_wp": trace["to_wp"].astype(np.int32),
        "motion.heading0_rad": trace["heading0_rad"].astype(np.float32),
        "motion.heading1_rad": trace["heading1_rad"].astype(np.float32),
        "motion.pod": trace["pod"].astype(np.int32),
        "motion.top_speed_m_s": trace["top_speed_m_s"].astype(np.float32),
    }


def happenings(events: Mapping[str, NDArray[Any]]) -> Arrays:
    """Return events as arrays, in the given order; kinds and details must already be numbers."""
    return {
        "events.time_us": events["time_us"].astype(np.float64),
        "events.kind": events["kind"].astype(np.uint8),
        **{f"events.{name}": events[name].astype(np.int32) for name in EVENT_NUMBERS},
    }
