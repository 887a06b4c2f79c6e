"""The compiled core of one layout's traffic: built, copied, and saved as bytes."""

from __future__ import annotations

import copy
import json
import pickle
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from rmfs.traffic._core import Core
from rmfs.traffic.planner import Conversation
from rmfs.traffic.settings import EXPANSION_BUDGET, PlannerSettings

if TYPE_CHECKING:
    from typing import Any

    from rmfs.layout.model import Layout

_FORMAT = "rmfs-traffic"


class Options(NamedTuple):
    """Options of the traffic core; see `rmfs.traffic.Traffic`."""

    record_trace: bool
    cost_table_bytes: int
    planner: PlannerSettings
    slow_shares: tuple[float, ...]


def build(layout: Layout, options: Options) -> Core:
    """Build the core of a layout in its initial state."""
    planner = options.planner
    core = Core(
        layout.x_m,
        layout.y_m,
        layout.tier.astype(np.int16),
        layout.edge_start.astype(np.uint32),
        layout.edge_target.astype(np.uint32),
        layout.is_storage,
        layout.is_queue,
        [list(station.queue) for station in layout.stations],
        [list(elevator.waypoints) for elevator in layout.elevators],
        [
            (a, b, _us(seconds))
            for elevator in layout.elevators
            for (a, b), seconds in elevator.travel_s.items()
        ],
        list(
            zip(
                layout.robot_waypoint.tolist(),
                layout.robot_heading_rad.tolist(),
                layout.robot_kind.tolist(),
                strict=True,
            )
        ),
        layout.pod_waypoint.tolist(),
        [
            (
                kind.acceleration_m_s2,
                kind.deceleration_m_s2,
                kind.top_speed_m_s * share,
                _us(kind.full_turn_s),
                _us(kind.pod_transfer_s),
            )
            for share in (1.0, *options.slow_shares)
            for kind in layout.robot_kinds
        ],
        (planner.name, planner.parameters, planner.seed, _conversation(planner)),
        EXPANSION_BUDGET,
        options.cost_table_bytes,
        options.record_trace,
    )
    if planner.guidance:
        core.set_guidance([(a, b, _us(extra_s)) for a, b, extra_s in planner.guidance])
    return core


def fork(core: Core, options: Options, memo: dict[int, Any]) -> tuple[Core, Options]:
    """Copy a core and its options in their current state; a planner in Python is deep-copied."""
    code = copy.deepcopy(options.planner.code, memo)
    options = options._replace(planner=options.planner._replace(code=code))
    return core.fork(_conversation(options.planner)), options


def to_bytes(core: Core, options: Options) -> bytes:
    """Return a core as bytes.

    The bytes consist of a line of JSON, the planner (pickled) if it is written in Python, and the
    state of the core.
    """
    planner = options.planner
    code = b"" if planner.code is None else pickle.dumps(planner.code)
    head = {
        "format": _FORMAT,
        "record_trace": options.record_trace,
        "cost_table_bytes": options.cost_table_bytes,
        "planner": [planner.name, planner.parameters, planner.seed],
        "guidance": planner.guidance,
        "slow_shares": list(options.slow_shares),
        "code_bytes": len(code),
    }
    return json.dumps(head).encode() + b"\n" + code + core.save()


def from_bytes(layout: Layout, saved: bytes) -> tuple[Core, Options]:
    """Return the core saved by `to_bytes`, and its options.

    Raises
    ------
    ValueError
        If the bytes are not a saved core, or belong to another layout or version.
    """
    line, _, rest = saved.partition(b"\n")
    try:
        head = json.loads(line)
        known = head["format"] == _FORMAT
    except (ValueError, KeyError, TypeError):
        known = False
    if not known:
        raise ValueError("these are not the bytes of saved traffic")
    name, parameters, seed = head["planner"]
    guidance = tuple((a, b, extra_s) for a, b, extra_s in head["guidance"])
    size = head["code_bytes"]
    code = pickle.loads(rest[:size]) if size else None
    options = Options(
        head["record_trace"],
        head["cost_table_bytes"],
        PlannerSettings(name, parameters, seed, code, guidance),
        tuple(head["slow_shares"]),
    )
    core = build(layout, options)
    core.restore(rest[size:])
    return core, options


def _conversation(planner: PlannerSettings) -> Conversation | None:
    return None if planner.code is None else Conversation(planner.code)


def _us(seconds: float) -> int:
    return round(seconds * 1e6)
