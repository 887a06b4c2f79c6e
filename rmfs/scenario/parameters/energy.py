"""What robots draw from their batteries: nothing is counted unless a file says so."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.quantities import Block, NotNegative, Positive, Share

Efficiency = Annotated[float, Field(gt=0, le=1)]

PRESETS: dict[str, dict[str, Any]] = {
    "standard": {},
    "kiva-like": {"robot_kg": 145.0, "pod_kg": 120.0},
    "light": {"robot_kg": 60.0, "pod_kg": 40.0, "standby_w": 5.0, "standby_loaded_w": 8.0},
}
"""What the presets change of the default values; docs/energy.md names the sources."""


class Energy(Block):
    """Masses, resistances and powers; see `rmfs/traffic/src/energy.rs` for the equations."""

    preset: Literal["standard", "kiva-like", "light"] = Field(
        "standard", description="where values come from that are not given (docs/energy.md)"
    )
    robot_kg: Positive = Field(100.0, description="kg of a robot without load")
    pod_kg: NotNegative = Field(100.0, description="kg of an empty pod")
    goods_kg_per_space: NotNegative = Field(
        0.5, description="kg of goods that take one space unit; a pod has some hundred of these"
    )
    rolling_resistance: NotNegative = Field(
        0.02, description="rolling resistance per weight (0.01 to 0.03 on concrete)"
    )
    inertia_share: NotNegative = Field(
        0.15, description="share by which turning parts of the drive add to the mass"
    )
    drive_efficiency: Efficiency = Field(
        0.8, description="share of the power drawn that reaches the wheels"
    )
    recuperation_share: Share = Field(
        0.3, description="share of the work of braking that comes back"
    )
    turning_resistance_m: NotNegative = Field(
        0.006, description="torque against a turn on the spot per weight, m"
    )
    gyration_m: NotNegative = Field(
        0.35, description="m, radius of gyration of the robot with its load about its axis"
    )
    lift_m: NotNegative = Field(0.05, description="m a pod is lifted")
    lift_efficiency: Efficiency = Field(0.5, description="share of the power drawn that lifts")
    standby_w: NotNegative = Field(30.0, description="W of electronics, all the time, without pod")
    standby_loaded_w: NotNegative = Field(40.0, description="W of electronics with a pod")

    @pydantic.model_validator(mode="before")
    @classmethod
    def _of_preset(cls, given: Any) -> Any:
        """Take from the preset what is not given."""
        if not isinstance(given, dict):
            return given
        name = given.get("preset", "standard")
        return {**PRESETS.get(name, {}), **given} if isinstance(name, str) else given
