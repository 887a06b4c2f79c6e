"""Import of RAWSim-O's layout parameters (.xlayo)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.config import Table, validate
from rmfs.layout.parameters import LayoutParameters
from rmfs.layout.problems import stop_if_any
from rmfs.rawsimo.xml import Unknown, read_root

if TYPE_CHECKING:
    from pathlib import Path

_SIDES = ("West", "East", "South", "North")

_NUMBERS: dict[str, str] = {
    "TierHeight": "tier_height_m",
    "BotRadius": "robot_radius_m",
    "MaxAcceleration": "acceleration_m_s2",
    "MaxDeceleration": "deceleration_m_s2",
    "MaxVelocity": "top_speed_m_s",
    "TurnSpeed": "full_turn_s",
    "PodTransferTime": "pod_transfer_s",
    "PodAmount": "pod_share",
    "PodRadius": "pod_radius_m",
    "PodCapacity": "pod_capacity",
    "StationRadius": "station_radius_m",
    "ItemTransferTime": "unit_transfer_s",
    "ItemPickTime": "unit_pick_s",
    "ItemBundleTransferTime": "bundle_transfer_s",
    "IStationCapacity": "replenishment_station_capacity",
    "ElevatorTransportationTimePerTier": "elevator_s_per_tier",
}
_COUNTS: dict[str, str] = {
    "Seed": "seed",
    "TierCount": "tiers",
    "BotCount": "robots",
    "OStationCapacity": "order_slots",
    "NrHorizontalAisles": "horizontal_aisles",
    "NrVerticalAisles": "vertical_aisles",
    "HorizontalLengthBlock": "block_length",
    "WidthHall": "hall_width",
    "WidthBuffer": "buffer_width",
    "DistanceEntryExitStation": "entry_exit_distance",
    **{f"NPickStation{side}": f"pick_stations.{side.lower()}" for side in _SIDES},
    **{f"NReplenishmentStation{side}": f"replenishment_stations.{side.lower()}" for side in _SIDES},
    **{f"NElevators{side}": f"elevators.{side.lower()}" for side in _SIDES},
}
_SWITCHES: dict[str, str] = {
    "AislesTwoDirectional": "two_directional_aisles",
    "SingleLane": "single_lane",
    "CounterClockwiseRingwayDirection": "counter_clockwise_ring",
}
_PATTERNS = {"Tim": "tim", "HighwayHallway": "highway"}
_UNUSED = {"CollisionPenaltyTime": "robots never collide in rmfs"}
_KNOWN = {
    "NameLayout",
    "AisleLayoutType",
    *_NUMBERS,
    *_COUNTS,
    *_SWITCHES,
    *_UNUSED,
}

_DEFAULT_NAME = "tiny"


def read_xlayo_table(path: Path) -> tuple[Table, list[str]]:
    """Read a file into a table of layout parameters, not yet validated.

    Parameters missing in the file take RAWSim-O's default values.

    Returns
    -------
    The table, and remarks on what was left out.

    Raises
    ------
    InputError
        If the file cannot be read or values have the wrong form; the message names all of them.
    """
    root = read_root(path, "LayoutConfiguration")
    table: Table = {"format": "rmfs-layout/1", "name": _DEFAULT_NAME, "robots": 32}
    # absent means none here, not the defaults of our own format
    table |= _rawsimo_stations()
    notes: list[str] = []
    problems: list[str] = []
    unknown = Unknown()
    unknown.attributes(root, ())
    unknown.children(root, _KNOWN)
    seen: set[str] = set()
    for element in root:
        name, text = element.tag, (element.text or "").strip()
        if name not in _KNOWN:
            continue
        if name in seen:
            problems.append(f"{name} occurs twice")
            continue
        seen.add(name)
        if name in _UNUSED:
            notes.append(f"{name} is not used: {_UNUSED[name]}")
            continue
        try:
            key, value = _entry(name, text)
        except ValueError as error:
            problems.append(f"{name}: {error} (given: {text!r})")
        else:
            _put(table, key, value)
    if "Seed" not in seen:
        notes.append("Seed is missing: 0 is used")
    stop_if_any(problems, path)
    return table, notes + unknown.notes()


def read_xlayo(path: Path) -> tuple[LayoutParameters, list[str]]:
    """Read a file; return the parameters, and remarks on what was left out.

    Raises
    ------
    InputError
        If the file cannot be read or the parameters are not valid.
    """
    table, notes = read_xlayo_table(path)
    return validate(LayoutParameters, table, str(path)), notes


def _rawsimo_stations() -> Table:
    return {
        "pick_stations": {"west": 0, "east": 4, "south": 0, "north": 0},
        "replenishment_stations": {"west": 4, "east": 0, "south": 0, "north": 0},
        "elevators": {"west": 0, "east": 0, "south": 0, "north": 0},
    }


def _entry(name: str, text: str) -> tuple[str, Any]:
    """Return the key and the value in rmfs of a known element."""
    if name == "NameLayout":
        return "name", text or _DEFAULT_NAME
    if name == "AisleLayoutType":
        if text not in _PATTERNS:
            raise ValueError(f"expected {' or '.join(_PATTERNS)}")
        return "hall_pattern", _PATTERNS[text]
    if name in _SWITCHES:
        if text not in ("true", "false", "1", "0"):
            raise ValueError("expected true or false")
        return _SWITCHES[name], text in ("true", "1")
    if name in _COUNTS:
        return _COUNTS[name], _number(int, text, "a whole number")
    return _NUMBERS[name], _number(float, text, "a number")


def _number(kind: type[int] | type[float], text: str, expected: str) -> float:
    try:
        return kind(text)
    except ValueError:
        raise ValueError(f"expected {expected}") from None


def _put(table: Table, key: str, value: Any) -> None:
    *above, last = key.split(".")
    for part in above:
        table = table[part]
    table[last] = value
