"""Parameters of layouts drawn as text and of grid maps, in addition to the picture or map."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from rmfs.layout.parameters import LayoutParameters
from rmfs.layout.values import Amount, Count, Positive, Radius, Strict


def _as_generated(key: str) -> Any:
    """Return the field of the same key in generated layouts, with its default and description."""
    field = LayoutParameters.model_fields[key]
    return Field(field.default, description=field.description)


class Equipment(Strict):
    """Parameters of layouts described cell by cell: name, cell size, robots, pods, stations."""

    name: str = Field("", description="name shown in results; if empty, the name of the file")
    seed: Amount = Field(0, description="random seed for the positions of pods and robots")
    cell_m: Positive = Field(
        1.0, description="distance between the centres of neighbouring cells, m"
    )
    queue_length: Amount = Field(
        3,
        description="maximum number of queue places that a station gets if its queue is not given",
    )

    robots: Count | None = Field(
        None,
        description="total number of robots. Robots that are not drawn start at random aisle "
        "cells. Default: the number drawn or, if none is drawn, 4 per pick station, but no more "
        "than there are storage locations or free aisle cells",
    )
    robot_radius_m: Radius = _as_generated("robot_radius_m")
    acceleration_m_s2: Positive = _as_generated("acceleration_m_s2")
    deceleration_m_s2: Positive = _as_generated("deceleration_m_s2")
    top_speed_m_s: Positive = _as_generated("top_speed_m_s")
    full_turn_s: Positive = _as_generated("full_turn_s")
    pod_transfer_s: Positive = _as_generated("pod_transfer_s")

    pod_share: Annotated[float, Field(ge=0, le=1)] = Field(
        0.85,
        description="share of the storage locations that hold a pod at the start; the number of "
        "pods is rounded down. In a picture, only storage locations drawn as `x` count",
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
    """The head of a layout drawn as text (`.txt`): the parameters above the picture."""

    format: Literal["rmfs-layout-drawn/1"] = Field(
        "rmfs-layout-drawn/1", description="version of this format"
    )


Place = Annotated[list[Amount], Field(min_length=2, max_length=2)]
StationPlaces = Annotated[list[Place], Field(min_length=1)]


class MapStations(Equipment):
    """The stations and storage locations of a grid map `NAME.map`, given in `NAME.map.toml`."""

    format: Literal["rmfs-map-stations/1"] = Field(description="version of this format")
    storage: str = Field(
        "",
        description="signs that stand for storage locations in the map; a cell with such a sign "
        "but without an adjacent aisle cell becomes an obstacle",
    )
    pick_stations: list[StationPlaces] = Field(
        default_factory=list,
        description="pick stations, each as a list of cells [row, column], counted from 0 at the "
        "top left: the cell of the station, then those of its queue, from the station to the "
        "entrance",
    )
    replenishment_stations: list[StationPlaces] = Field(
        default_factory=list,
        description="replenishment stations, in the same form as `pick_stations`",
    )
