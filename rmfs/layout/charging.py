"""Kinds of station where robots get energy: chargers and battery swap stations."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from rmfs.config import Model
from rmfs.layout.kinds import StationKind


class ChargerParameters(Model):
    """Parameters of chargers in a layout file."""

    power_w: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 1000.0
    """Charging power in W of each charger; the robot's electronics are supplied in addition."""


class SwapParameters(Model):
    """Parameters of battery swap stations in a layout file."""

    swap_s: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 90.0
    """Duration of a swap in s."""
    batteries: Annotated[int, Field(ge=1)] = 8
    """Batteries in stock at each station, all full at time zero."""
    power_w: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 500.0
    """Charging power in W of each battery in stock."""
    ready_share: Annotated[float, Field(gt=0, lt=1)] = 0.9
    """Charge level (share) from which a battery in stock may be used; a robot waits for such a
    battery."""


class RecoveryKind(StationKind):
    """Kind of station where robots without pods get energy.

    Charge assignment (CA) sends them there.
    """

    task = "rmfs.world.charging:ChargeTask"
    state = "rmfs.world.charging:RecoveryStation"

    @property
    def head_w(self) -> float:
        """Power in W for charging a robot's battery at the station; 0 if the battery is swapped."""
        return 0.0

    @property
    def long_run_w(self) -> float:
        """Maximum average power in W that a station can supply in the long run."""
        raise NotImplementedError


class Charger(RecoveryKind):
    """A charger: a robot stays until its battery has reached the target level."""

    name = "charger"
    letter = "C"
    colour = "#B8860B"
    handles = "robots charged"
    parameters_model = ChargerParameters
    service = "rmfs.simulation.charging.service:ChargeService"

    @property
    def head_w(self) -> float:
        """Charging power of the charger, in W."""
        return float(self.parameters.power_w)

    @property
    def long_run_w(self) -> float:
        """Charging power in W: the average power of a charger that is always occupied."""
        return self.head_w


class Swap(RecoveryKind):
    """A swap station: a robot gets the fullest battery in stock and leaves its own for charging."""

    name = "swap"
    letter = "B"
    colour = "#8B4513"
    handles = "batteries swapped"
    parameters_model = SwapParameters
    service = "rmfs.simulation.charging.swap:SwapService"

    @property
    def long_run_w(self) -> float:
        """Total charging power of all batteries in stock, in W."""
        return float(self.parameters.power_w * self.parameters.batteries)
