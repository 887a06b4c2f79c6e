"""Kinds of station where robots get energy: plug-in places and battery swap."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from rmfs.config import Model
from rmfs.layout.kinds import StationKind


class ChargerParameters(Model):
    """What a layout file can say of plug-in places."""

    power_w: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 1000.0
    """W a place gives to the battery of the robot there; its electronics are supplied besides."""


class SwapParameters(Model):
    """What a layout file can say of battery swap."""

    swap_s: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 90.0
    """s a swap takes."""
    batteries: Annotated[int, Field(ge=1)] = 8
    """Batteries in stock at each station, all full at time zero."""
    power_w: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 500.0
    """W with which each battery in stock is charged."""
    ready_share: Annotated[float, Field(gt=0, lt=1)] = 0.9
    """Level from which a battery in stock may be put in; a robot waits until there is one."""


class RecoveryKind(StationKind):
    """A kind of station to which robots go for energy, without pods; the problem CA says when."""

    task = "rmfs.world.charging:ChargeTask"
    state = "rmfs.world.charging:RecoveryStation"

    @property
    def head_w(self) -> float:
        """W that a robot gets while it stands at the station."""
        return 0.0

    @property
    def long_run_w(self) -> float:
        """W that a station gives in the long run, at most."""
        raise NotImplementedError


class Charger(RecoveryKind):
    """Plug-in places: a robot stays until its battery has the level it is to have."""

    name = "charger"
    letter = "C"
    colour = "#B8860B"
    handles = "robots charged"
    parameters_model = ChargerParameters
    service = "rmfs.simulation.charging.service:ChargeService"

    @property
    def head_w(self) -> float:
        """The power of a place."""
        return float(self.parameters.power_w)

    @property
    def long_run_w(self) -> float:
        """The power of a place that is always in use."""
        return self.head_w


class Swap(RecoveryKind):
    """Battery swap: the robot gets the fullest battery in stock, and leaves its own to charge."""

    name = "swap"
    letter = "B"
    colour = "#8B4513"
    handles = "batteries swapped"
    parameters_model = SwapParameters
    service = "rmfs.simulation.charging.swap:SwapService"

    @property
    def long_run_w(self) -> float:
        """The power of all its batteries."""
        return float(self.parameters.power_w * self.parameters.batteries)
