"""Recorded data of pickers: their presence, and the units that they handled."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rmfs.measure.log import Log

if TYPE_CHECKING:
    from rmfs.scenario.parameters import Pickers
    from rmfs.world.pickers import Handled, Staff


class PickerLog:
    """Records pickers' presence and the units that they handled; empty without pickers.

    Attributes
    ----------
    staff
        All pickers of the scenario; None if there are no pickers.
    units
        One row per picked unit, in chronological order.
    presence
        Periods in which a picker was at a station, with start and end in s.
    """

    def __init__(self) -> None:
        self.staff: Staff | None = None
        self.units = Log(
            **{"picker": "i2", "handling_s": "f8", "layer": "i1", "fatigue": "f8"},
            **{"error": "?", "noticed": "?", "face": "i1", "turned": "?"},
        )
        self.presence = Log(picker="i2", station="i2", begin_s="f8", end_s="f8")

    @property
    def given(self) -> Pickers | None:
        """The parameters of pickers; None if the scenario has no pickers."""
        return None if self.staff is None else self.staff.given

    def begin(self, staff: Staff) -> None:
        """Start recording."""
        self.staff = staff

    def handled(self, one: Handled) -> None:
        """Record how a unit was handled."""
        how = (one.picker, one.seconds, one.layer, one.fatigue, one.error, one.noticed)
        self.units.add(*how, one.face, one.turned)

    def ended(self, time_s: float) -> None:
        """Record the presence of the pickers who are still there at the end of the run."""
        for picker in self.staff.pickers if self.staff is not None else ():
            if picker.station >= 0:
                since_s = picker.since_s
                self.presence.add(picker.index, picker.station, since_s, max(since_s, time_s))
