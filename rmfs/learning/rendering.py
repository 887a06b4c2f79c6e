"""Images of a run: the floor plan with the current positions of pods and robots."""

from __future__ import annotations

import io
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from rmfs.layout import picture as plan

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from rmfs.simulation.kernel import Kernel

SIZE_IN = (8.0, 6.0)
DPI = 80


def picture(run: Kernel) -> NDArray[np.uint8]:
    """Draw the current state of a run as an RGB array, shape (height, width, 3).

    Pods are drawn where they are stored, or on the robots that carry them. Robots are drawn where
    they will stop next or, without a plan, where they stand.
    """
    world = run.world
    at = [run.traffic.robot_waypoint(robot.index) for robot in world.robots]
    pods = [run.view.pod_waypoint(pod) for pod in range(run.layout.pods)]
    now = replace(
        run.layout,
        robot_waypoint=np.array(at, run.layout.robot_waypoint.dtype),
        pod_waypoint=np.array(pods, run.layout.pod_waypoint.dtype),
    )
    figure = Figure(figsize=SIZE_IN, dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    ax = figure.add_subplot()
    plan.draw(now, ax, legend=False)
    ax.set_title(
        f"{run.now_s:.0f} s: {world.units_picked} units picked, {world.orders_completed} orders "
        f"completed, {len(world.orders)} waiting"
    )
    raw = io.BytesIO()
    figure.savefig(raw, format="rgba", dpi=DPI)
    shape = round(SIZE_IN[1] * DPI), round(SIZE_IN[0] * DPI), 4
    return np.frombuffer(raw.getvalue(), np.uint8).reshape(shape)[..., :3].copy()
