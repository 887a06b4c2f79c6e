"""The parameters of a generated layout, as in a `rmfs-layout/1` file.

The parameters and their default values follow RAWSim-O (section 3.1.1 of the paper on RAWSim-O, and
the file format `.xlayo`). Unlike in RAWSim-O, the names are plain words with the unit as suffix.
The `Field` descriptions are the only explanations of the parameters; `rmfs layout new` writes them
as comments.
"""

from __future__ import annotations

from typing import Any, Literal, cast

import pydantic
from pydantic import Field
from pydantic_core import InitErrorDetails, PydanticCustomError

from rmfs.layout.generator.conditions import RULES
from rmfs.layout.values import Amount, Metres, Radius, Rate, Seconds, Some, Space, Strict


class PerSide(Strict):
    """Numbers of stations of one kind, or of elevators, on each side of a tier."""

    west: Amount = Field(0, description="number on the side with the smallest x")
    east: Amount = Field(0, description="number on the side with the largest x")
    south: Amount = Field(
        0, description="number on the side with the largest y, the top of a picture"
    )
    north: Amount = Field(
        0,
        description="number on the side with the smallest y, the bottom of a picture",
    )

    @property
    def total(self) -> int:
        """Total number of stations or elevators on the four sides of a tier."""
        return self.west + self.east + self.south + self.north


class OtherStations(PerSide):
    """Numbers and parameters of the stations of a further kind.

    Unlike pick and replenishment stations, such stations can also be placed within the storage
    area, where each of them replaces a storage location.
    """

    within: Amount = Field(0, description="number within the storage area of a tier")
    kind: str = Field(
        description="class of the stations, as `module:Class`, `path/to/file.py:Class` or a "
        "registered name such as `charger`"
    )
    parameters: dict[str, Any] = Field(default_factory=dict, description="parameters of this class")


class LayoutParameters(Strict):
    """Parameters of a generated layout.

    All errors are reported together: invalid values, and violated conditions on several values.
    Conditions that involve an invalid value are not checked.
    """

    format: Literal["rmfs-layout/1"] = Field("rmfs-layout/1", description="version of this format")
    name: str = Field("unnamed", min_length=1, description="name shown in results")
    seed: Amount = Field(0, description="random seed for the positions of pods and robots")

    tiers: Some = Field(
        1, description="number of tiers (floors); elevators are required if it is above 1"
    )
    tier_height_m: Metres = Field(4.0, description="height of a tier in m, for drawing only")

    robots: Some = Field(16, description="number of robots per tier")
    robot_radius_m: Radius = Field(0.35, description="radius of a robot, m")
    acceleration_m_s2: Rate = Field(1.0, description="acceleration of robots, m/s2")
    deceleration_m_s2: Rate = Field(1.0, description="deceleration of robots, m/s2")
    top_speed_m_s: Rate = Field(1.5, description="top speed of robots, m/s")
    full_turn_s: Seconds = Field(
        2.5, description="duration of a turn of 360 degrees on the spot, s"
    )
    pod_transfer_s: Seconds = Field(2.2, description="duration of lifting or setting down a pod, s")

    pod_share: float = Field(
        0.85,
        gt=0,
        lt=1,
        description="share of the storage locations that hold a pod at the start; the number of "
        "pods is rounded down per tier",
    )
    pod_radius_m: Radius = Field(0.45, description="radius of a pod, m")
    pod_capacity: Space = Field(500.0, description="capacity of a pod in space units")

    station_radius_m: Radius = Field(0.45, description="radius of a station, m")
    unit_transfer_s: Seconds = Field(
        10.0, description="time in s for which a unit keeps the pick station busy"
    )
    unit_pick_s: Seconds = Field(
        3.0, description="time in s for which a unit keeps the robot at the pick station"
    )
    order_slots: Some = Field(12, description="maximum number of open orders at a pick station")
    bundle_transfer_s: Seconds = Field(
        10.0,
        description="time in s for which a bundle keeps the replenishment station and the robot "
        "busy",
    )
    replenishment_station_capacity: Space = Field(
        1000.0,
        description="maximum total size, in space units, of the bundles assigned to a "
        "replenishment station at any time",
    )
    elevator_s_per_tier: Seconds = Field(
        10.0, description="duration of an elevator ride from one tier to the next, s"
    )

    hall_pattern: Literal["tim", "highway"] = Field(
        "tim",
        description="pattern of the lanes in the halls (the areas between the storage area and "
        'the queues of stations). With "tim", two lanes run along each hall, beside the queues; '
        'with "highway", a lane runs along the hall on each tile of its width. In both patterns, '
        "further lanes cross the hall",
    )
    two_directional_aisles: bool = Field(
        False, description="whether all aisles are two-way; otherwise all are one-way"
    )
    single_lane: bool = Field(
        True, description="whether aisles are one tile wide; otherwise they are two tiles wide"
    )
    horizontal_aisles: int = Field(
        8,
        ge=2,
        le=1000,
        description="number of horizontal aisles; must be even if aisles are one-way, or if they "
        'are one tile wide and the hall pattern is "highway"',
    )
    vertical_aisles: int = Field(
        6,
        ge=2,
        le=1000,
        description="number of vertical aisles; must be even under the same conditions as "
        "`horizontal_aisles`",
    )
    block_length: int = Field(
        4,
        ge=2,
        le=1000,
        multiple_of=2,
        description="length of a storage block in x, in tiles of 1 m; its depth in y is 2 tiles",
    )
    hall_width: int = Field(
        6,
        ge=2,
        le=1000,
        description='width of a hall in tiles; must be even if the hall pattern is "highway"',
    )
    buffer_width: int = Field(
        4,
        ge=2,
        le=1000,
        description="length, in tiles, of the parallel segments that form the queue zone of a "
        "station; there are `entry_exit_distance` + 1 of them",
    )
    entry_exit_distance: int = Field(
        3,
        ge=1,
        le=1000,
        description="distance from the entrance of a queue zone to its exit, in tiles; must be "
        "odd and at most 5",
    )
    counter_clockwise_ring: bool = Field(
        True,
        description="whether the one-way road around the storage area runs counter-clockwise, with "
        "x to the right and y upwards; if false, all one-way roads are reversed",
    )

    pick_stations: PerSide = Field(PerSide(east=4), description="pick stations per tier")
    replenishment_stations: PerSide = Field(
        PerSide(west=4), description="replenishment stations per tier"
    )
    elevators: PerSide = Field(PerSide(), description="elevators, each of which connects all tiers")
    other_stations: dict[str, OtherStations] = Field(
        default_factory=dict, description="stations of other kinds, per tier, by name of the kind"
    )

    @pydantic.model_validator(mode="wrap")
    @classmethod
    def _report_everything(
        cls, data: Any, handler: pydantic.ModelWrapValidatorHandler[LayoutParameters]
    ) -> LayoutParameters:
        """Check conditions between values even if some values are invalid."""
        try:
            parameters = handler(data)
            wrong: list[InitErrorDetails] = []
            wrong_keys: set[str] = set()
        except pydantic.ValidationError as error:
            wrong = [_again(detail) for detail in error.errors()]
            wrong_keys = {str(detail["loc"][0]) for detail in wrong if detail["loc"]}
            if not isinstance(data, dict):
                raise
            parameters = handler({k: v for k, v in data.items() if k not in wrong_keys})
        wrong += [
            InitErrorDetails(type=PydanticCustomError("layout", cast("Any", problem)), input={})
            for keys, rule in RULES
            if not wrong_keys.intersection(keys)
            for problem in rule(parameters)
        ]
        if wrong:
            raise pydantic.ValidationError.from_exception_data(cls.__name__, wrong)
        return parameters


def _again(detail: Any) -> InitErrorDetails:
    """Convert a reported problem into one that can be raised together with others."""
    kept = InitErrorDetails(type=detail["type"], loc=detail["loc"], input=detail["input"])
    if "ctx" in detail:
        kept["ctx"] = detail["ctx"]
    return kept
