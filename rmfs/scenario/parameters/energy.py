"""Energy use of robots; modelled only if a scenario has a table `energy`."""

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
"""Values that replace the defaults in each preset; docs/energy.md names the sources."""


class Battery(Block):
    """The battery of each robot, and how much of it may be used."""

    capacity_wh: Positive = Field(1000.0, description="capacity, Wh")
    taper_from_share: Efficiency = Field(
        0.8,
        description="charge level above which the charging power falls, linearly to 0 at full; "
        "1: it never falls",
    )
    full_share: Efficiency = Field(0.98, description="charge level that counts as full")
    least_share: Share = Field(
        0.1, description="charge level below which a robot strands; must be less than full_share"
    )
    reserve_share: Share = Field(
        0.05,
        description="reserve for waiting: no task is taken that could end below least_share + "
        "reserve_share",
    )
    initial_least_share: Share = Field(
        0.5,
        description="lowest charge level at time zero; levels are uniform from here to "
        "initial_most_share",
    )
    initial_most_share: Share = Field(1.0, description="highest charge level at time zero")
    rescue_after_s: Positive = Field(
        900.0, description="time in s until a stranded robot is recharged on the spot"
    )
    rescue_share: Efficiency = Field(0.5, description="charge level after such a rescue")

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
    """Inductive charging at waypoints of queues, while robots wait or are served."""

    power_w: Positive = Field(200.0, description="power in W for a robot at such a waypoint")
    at: Literal["pick-stations", "replenishment-stations", "all-stations"] = Field(
        "all-stations", description="stations whose queues charge robots"
    )
    places: Annotated[int, Field(ge=1)] = Field(
        4, description="number of charging places in each queue, starting at the station"
    )


class Energy(Block):
    """Parameters of the energy use of robots; see docs/energy.md for the equations."""

    preset: Literal["standard", "kiva-like", "light"] = Field(
        "standard", description="set of values for keys that are not given (docs/energy.md)"
    )
    robot_kg: Positive = Field(100.0, description="mass of a robot without load, kg")
    pod_kg: NotNegative = Field(100.0, description="mass of an empty pod, kg")
    goods_kg_per_space: NotNegative = Field(
        0.5, description="mass of goods per space unit, kg; a pod holds some hundred space units"
    )
    rolling_resistance: NotNegative = Field(
        0.02, description="rolling resistance coefficient (0.01 to 0.03 on concrete)"
    )
    inertia_share: NotNegative = Field(
        0.15, description="inertia of rotating drive parts, as a share of the mass"
    )
    drive_efficiency: Efficiency = Field(
        0.8, description="share of the power drawn that reaches the wheels"
    )
    recuperation_share: Share = Field(
        0.3, description="share of the braking energy that is recovered"
    )
    turning_resistance_m: NotNegative = Field(
        0.006, description="resisting torque of a turn on the spot divided by the weight, m"
    )
    gyration_m: NotNegative = Field(
        0.35, description="radius of gyration of the robot and its load about its vertical axis, m"
    )
    lift_m: NotNegative = Field(0.05, description="height to which a pod is lifted, m")
    lift_efficiency: Efficiency = Field(
        0.5, description="share of the power drawn that does lifting work"
    )
    standby_w: NotNegative = Field(
        30.0, description="power of the electronics while the robot carries no pod, W"
    )
    standby_loaded_w: NotNegative = Field(
        40.0, description="power of the electronics with a pod, W"
    )
    battery: Battery | None = Field(
        None, description="battery of each robot; default: unlimited energy"
    )
    inductive: Inductive | None = Field(
        None, description="charging while waiting in queues; default: none"
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
        """Add the values of the preset for keys that are not given."""
        if not isinstance(given, dict):
            return given
        name = given.get("preset", "standard")
        return {**PRESETS.get(name, {}), **given} if isinstance(name, str) else given
