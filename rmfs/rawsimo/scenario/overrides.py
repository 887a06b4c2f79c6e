"""Converts the changes that RAWSim-O's settings files (.xsett) make to a layout."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rmfs.rawsimo.scenario.settings import Settings

_NUMBERS = {
    "OverrideBotPodTransferTime": "pod_transfer_s",
    "OverrideBotMaxAcceleration": "acceleration_m_s2",
    "OverrideBotMaxDeceleration": "deceleration_m_s2",
    "OverrideBotMaxVelocity": "top_speed_m_s",
    "OverrideBotTurnSpeed": "full_turn_s",
    "OverridePodCapacity": "pod_capacity",
    "OverrideInputStationCapacity": "replenishment_station_capacity",
    "OverrideInputStationItemBundleTransferTime": "bundle_transfer_s",
    "OverrideOutputStationItemTransferTime": "unit_transfer_s",
    "OverrideOutputStationItemPickTime": "unit_pick_s",
    "OverrideInputStationCount": "replenishment_station_share",
    "OverrideOutputStationCount": "pick_station_share",
}
_COUNTS = {
    "OverrideOutputStationCapacity": "order_slots",
    "OverrideBotCountPerOStation": "robots_per_pick_station",
}


def layout_overrides(block: Settings) -> list[tuple[list[str], Any]]:
    """Return the changes to the layout that are switched on, as pairs (path of keys, value).

    Each change has two elements in the block (`OverrideConfig`): a switch, and a value. The name of
    the value begins with the name of the switch.

    Raises
    ------
    InputError
        If a switch or a value is wrong.
    """
    overrides: list[tuple[list[str], Any]] = []
    for switch in (*_NUMBERS, *_COUNTS):
        values = [tag for tag in block.tags if tag.startswith(switch) and tag != switch]
        if not block.switch(switch, default=False):
            block.leave(values, f"{switch} is not true")
            continue
        if len(values) != 1:
            raise block.error(switch, "is true, so exactly one value must be given")
        key = _NUMBERS.get(switch) or _COUNTS[switch]
        value = block.whole(values[0], 0) if switch in _COUNTS else block.number(values[0], 0.0)
        overrides.append((["layout", key], value))
        block.note(f"{switch} belongs to the layout: --set layout.{key}={value:g}")
    block.leave_rest()
    return overrides
