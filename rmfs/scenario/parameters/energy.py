"""What robots draw from their batteries: nothing is counted unless a file says so."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import pydantic
from pydantic import Field

from rmfs.scenario.quantities import Block, NotNegative, Positive, Share, not_below

Efficiency = Annotated[float, Field(gt=0, le=1)]

PRESETS: dict[str, dict[str, Any]] = {
    "standard": {},
    "kiva-like": {"robot_kg": 145.0, "pod_kg": 120.0},
    "light": {"robot_kg": 60.0, "pod_kg": 40.0, "standby_w": 5.0, "standby_loaded_w": 8.0},
}
"""What the presets change of the default values; docs/energy.md names the sources."""


class Battery(Block):
    """What robots carry, and what may be taken of it."""

    capacity_wh: Positive = Field(1000.0, description="Wh")
    taper_from_share: Efficiency = Field(
        0.8, description="level from which a charger gives less, evenly to 0 when full; 1: never"
    )
    full_share: Efficiency = Field(0.98, description="level that counts as full")
    least_share: Share = Field(
        0.1, description="level below which a robot strands; must be less than full_share"
    )
    reserve_share: Share = Field(
        0.05, description="kept besides for waiting: no task that could end below both"
    )
    initial_least_share: Share = Field(
        0.5, description="at time zero levels are drawn evenly between this ..."
    )
    initial_most_share: Share = Field(1.0, description="... and this")
    rescue_after_s: Positive = Field(
        900.0, description="s a stranded robot waits until somebody brings energy"
    )
    rescue_share: Efficiency = Field(0.5, description="its level then")

    @pydantic.field_validator("initial_most_share")
    @classmethod
    def _in_order(cls, value: float, info: pydantic.ValidationInfo) -> float:
        return not_below(value, info, "initial_least_share")

    @pydantic.model_validator(mode="after")
    def _some_use(self) -> Battery:
        bottom = self.least_share + self.reserve_share
        for key in ("full_share", "rescue_share", "initial_least_share"):
            if getattr(self, key) <= bottom:
                raise ValueError(
                    f"{key} = {getattr(self, key):g} must be more than least_share + reserve_share "
                    f"= {bottom:g}"
                )
        return self


class Inductive(Block):
    """Waypoints that charge robots while they wait or are served."""

    power_w: Positive = Field(200.0, description="W given to a robot that stands there")
    at: Literal["pick-stations", "replenishment-stations", "all-stations"] = Field(
        "all-stations", description="whose queues"
    )
    places: Annotated[int, Field(ge=1)] = Field(
        4, description="places of each queue, the station's own place first"
    )


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
    battery: Battery | None = Field(
        None, description="what robots carry; default: as much as they need"
    )
    inductive: Inductive | None = Field(
        None, description="charging while waiting; default: nowhere"
    )

    @pydantic.field_validator("inductive")
    @classmethod
    def _charges_something(
        cls, value: Inductive | None, info: pydantic.ValidationInfo
    ) -> Inductive | None:
        if value is not None and "battery" in info.data and info.data["battery"] is None:
            raise ValueError("needs a battery to charge: energy.battery")
        return value

    @pydantic.model_validator(mode="before")
    @classmethod
    def _of_preset(cls, given: Any) -> Any:
        """Take from the preset what is not given."""
        if not isinstance(given, dict):
            return given
        name = given.get("preset", "standard")
        return {**PRESETS.get(name, {}), **given} if isinstance(name, str) else given
