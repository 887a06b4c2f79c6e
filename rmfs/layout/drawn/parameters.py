"""What is said of a drawn layout beside the picture: everything has a default."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from rmfs.layout.parameters import LayoutParameters
from rmfs.layout.values import Amount, Count, Positive, Radius, Strict


def _as_generated(key: str) -> Any:
    """Return the field of that key of generated layouts: its default, and what it means."""
    field = LayoutParameters.model_fields[key]
    return Field(field.default, description=field.description)


class Equipment(Strict):
    """Robots, pods and stations of a layout whose cells are given."""

    name: str = Field("", description="name shown in results; default: that of the file")
    seed: Amount = Field(0, description="random seed for the places of pods and robots")
    cell_m: Positive = Field(1.0, description="m from the middle of a cell to that of the next")
    queue_length: Amount = Field(
        3, description="places of the queue of a station for which none are given"
    )

    robots: Count | None = Field(
        None,
        description="robots in all; those that are not drawn stand on aisles; default: those that "
        "are drawn, or else 4 per pick station, as far as there is room",
    )
    robot_radius_m: Radius = _as_generated("robot_radius_m")
    acceleration_m_s2: Positive = _as_generated("acceleration_m_s2")
    deceleration_m_s2: Positive = _as_generated("deceleration_m_s2")
    top_speed_m_s: Positive = _as_generated("top_speed_m_s")
    full_turn_s: Positive = _as_generated("full_turn_s")
    pod_transfer_s: Positive = _as_generated("pod_transfer_s")

    pod_share: Annotated[float, Field(ge=0, le=1)] = Field(
        0.85, description="pods per storage place that is drawn neither full nor empty"
    )
    pod_radius_m: Radius = _as_generated("pod_radius_m")
    pod_capacity: Positive = _as_generated("pod_capacity")

    station_radius_m: Radius = _as_generated("station_radius_m")
    unit_transfer_s: Positive = _as_generated("unit_transfer_s")
    unit_pick_s: Positive = _as_generated("unit_pick_s")
    order_slots: Count = _as_generated("order_slots")
    bundle_transfer_s: Positive = _as_generated("bundle_transfer_s")
    replenishment_station_capacity: Positive = _as_generated("replenishment_station_capacity")


class PictureHead(Equipment):
    """The head of a layout drawn as text (`.txt`)."""

    format: Literal["rmfs-layout-drawn/1"] = Field(
        "rmfs-layout-drawn/1", description="version of this format"
    )


Place = Annotated[list[Amount], Field(min_length=2, max_length=2)]
StationPlaces = Annotated[list[Place], Field(min_length=1)]


class MapStations(Equipment):
    """What stands beside a grid map (`NAME.map`): stations and storage places (`NAME.map.toml`)."""

    format: Literal["rmfs-map-stations/1"] = Field(description="version of this format")
    storage: str = Field(
        "", description="signs of the map that are storage places where an aisle is beside them"
    )
    pick_stations: list[StationPlaces] = Field(
        default_factory=list,
        description="each by its cell [row, column], from 0 at the top left, and those of its "
        "queue up to the entrance",
    )
    replenishment_stations: list[StationPlaces] = Field(
        default_factory=list, description="as pick_stations"
    )
