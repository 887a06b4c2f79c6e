"""The fields of the questions and answers of each family, in the format `rmfs-decision/1`.

A *question* is a problem instance for an optimiser; questions of the same kind form a *family*.
This module defines the format. It imports no model, so that answers can be checked independently of
the models.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

Plain = dict[str, Any]
"""The fields of a question or an answer by name: NumPy arrays, numbers, texts, lists of lists."""

Kind = Literal["whole", "real", "cost", "worth", "ms", "cost_ms", "space", "flag", "lists", "text"]
"""Kind of the entries of a field; see `KINDS`."""

KINDS: Mapping[Kind, str] = {
    "whole": "a whole number",
    "real": "a finite number",
    "cost": 'a number, or "inf": not allowed, or without limit',
    "worth": 'a number, or "-inf": not allowed',
    "ms": "a number of seconds in whole milliseconds",
    "cost_ms": 'a number of seconds in whole milliseconds, or "inf"',
    "space": "a number of space units in whole sixteenths",
    "flag": "0 or 1",
    "lists": "lists of whole numbers, which may differ in length",
    "text": "one of the texts listed",
}
"""Description of each kind of entry."""


@dataclass(frozen=True)
class Field:
    """Definition of a field of a question or answer.

    Attributes
    ----------
    name
        Name of the field; in a group of fields, GROUP.NAME, such as `weights.travel`.
    kind
        Kind of the entries, a key of `KINDS`.
    shape
        Letters of the dimensions, separated by spaces, such as `P K`; empty for a single value.
        For the kind `lists`, the letter of the number of lists.
    optional
        Whether the field may be omitted.
    meaning
        Description of the field, with the unit.
    texts
        Allowed values, if the kind is `text`.
    """

    name: str
    kind: Kind
    shape: str = ""
    optional: bool = False
    meaning: str = ""
    texts: tuple[str, ...] = ()


@dataclass(frozen=True)
class Schema:
    """The fields of the questions and answers of one family.

    Attributes
    ----------
    data, values
        Fields of a question (`data`) and of an answer (`values`).
    derived
        Functions that compute the size of a dimension from a question, by the letter of the
        dimension. They are needed for dimensions that occur only in optional fields.
    maximise
        Whether the objective is maximised.
    """

    data: tuple[Field, ...]
    values: tuple[Field, ...]
    derived: Mapping[str, Callable[[Plain], int]]
    maximise: bool = False


def fields_of(text: str) -> tuple[Field, ...]:
    """Parse fields from lines `name | kind | shape | meaning`; `name?` marks an optional field."""
    found = []
    for line in text.strip().splitlines():
        name, kind, shape, meaning = (part.strip() for part in line.split("|"))
        texts: tuple[str, ...] = ()
        if kind.startswith("text "):
            kind, _, listed = kind.partition(" ")
            texts = tuple(listed.split("/"))
        found.append(
            Field(name.rstrip("?"), cast("Kind", kind), shape, name.endswith("?"), meaning, texts)
        )
    return tuple(found)


def _orders(data: Plain) -> int:
    return int(data["line_order"][-1]) + 1 if len(data["line_order"]) else 0


def _robots(data: Plain) -> int:
    return 0 if data.get("fetch") is None else len(data["fetch"])


_WEIGHTS = """
weights.travel     | real |     | cost per unit of `travel` and `fetch`
weights.visit      | real |     | cost per called pod, in addition to the travel
weights.empty_slot | real |     | cost per slot that stays empty
weights.complete   | real |     | reward per order covered in full
weights.unit       | real |     | reward per unit of an order covered in full
weights.prospects  | flag |     | whether prospects also earn `complete` and `unit`
weights.open_unit  | real |     | cost per open unit
weights.open_line  | real |     | cost per open line (variant `later`)
weights.line       | real |     | reward per line covered
weights.part       | real |     | cost per slot that an order takes beyond its first
"""

_VARIANTS = "whole/later/split-stations/split-time/split-both"

SCHEMAS: Mapping[str, Schema] = {
    "pile_on": Schema(
        fields_of(
            f"""
slots        | whole | S   | free order slots
line_order   | whole | L   | number of the order of each line; ascending, from 0 without gaps
line_sku     | whole | L   | SKU of each line, increasing within an order
line_units   | whole | L   | units of each line
stock        | whole | P K | unreserved units per pod and SKU
travel       | real  | P S | cost of bringing a pod to a station
available    | flag  | P   | whether a pod may be called
inbound      | whole | P   | station that a pod is on its way to, or -1
open_units   | whole | S K | units that open orders of a station need and have not reserved, per SKU
fetch?       | real  | R P | cost for a robot to reach a pod; if absent, no robots are assigned
robot_pod?   | whole | R   | pod that a robot is bound to, or -1
worth?       | real  | O   | extra reward for giving an order its first slot
may_call?    | flag  | S   | whether pods may be called to a station
variant      | text {_VARIANTS} | | how orders may be covered
{_WEIGHTS.strip()}
"""
        ),
        fields_of(
            """
slot         | flag  | O S | whether an order takes a slot at a station
line_station | whole | L   | station whose pods cover a line now, or -1
pod_station  | whole | P   | station that a pod is called to, or -1
pod_robot    | whole | P   | robot that fetches a pod, or -1
prospect     | whole | O   | station whose pods could serve an order (a prospect), or -1
"""
        ),
        {"O": _orders, "R": _robots},
    ),
    "planning": Schema(
        fields_of(
            """
slots         | whole | S   | order slots, 1 or more
coming        | whole | F   | pods under way; pods to the same station in order of arrival
coming_to     | whole | F   | station of each pod under way
order_station | whole | O   | station at which an order is open, or -1 if the order waits
order_until   | whole | O   | last position at which a pod under way has units for an order, or -1
order_worth   | real  | O   | value of completing an order, s of robot time
line_order    | whole | L   | order of each line
line_sku      | whole | L   | SKU of each line
line_units    | whole | L   | units of each line
line_worth    | real  | L   | value of serving a line, s of robot time
stock         | whole | P K | unreserved units per pod and SKU
cost          | cost  | P S | cost of a new visit of a pod, s of robot time
visits        | whole |     | maximum number of new visits per station
decay         | real  |     | discount factor from one visit to the next, in (0, 1]
"""
        ),
        fields_of(
            """
pods          | lists | S   | pods of the new visits of each station, in order
order_station | whole | O   | station of each order, or -1 if the order keeps waiting
line_visit    | whole | L   | position of the visit that serves a line, or -1
"""
        ),
        {},
    ),
    "sequencing": Schema(
        fields_of(
            """
needs    | flag  | O K | whether an order needs a SKU
holds    | flag  | P K | whether a pod holds a SKU
capacity | whole |     | maximum number of open orders at any time
opened   | flag  | O   | whether an order is open before the first visit
"""
        ),
        fields_of(
            """
pods  | whole | T | pods of the visits, in order
start | whole | O | visit in which an order is opened, or -1 if it was open before
"""
        ),
        {},
    ),
    "rack_allocation": Schema(
        fields_of(
            """
units | whole | O K | units of a SKU that an order needs
stock | whole | P K | units of a SKU that a pod holds
slots | whole | S   | order slots of a station; all are filled
"""
        ),
        fields_of(
            """
order_station | whole | O | station of an order, or -1
pod_station   | whole | P | station of a pod, or -1
"""
        ),
        {},
    ),
    "placement": Schema(
        fields_of(
            """
travel_s | cost | P L | travel time of a pod to a location, s
access_s | real | L   | travel time of a later visit: from a location to a station and back, s
visits   | real | P   | expected visits of a pod to stations from its new location
"""
        ),
        fields_of("place | whole | P | location of each pod"),
        {},
    ),
    "stays": Schema(
        fields_of(
            """
begin_s  | real  | N   | when a stay begins, s
end_s    | real  | N   | when a stay ends, s
cost_s   | cost  | N Z | robot time of a stay in a zone, s
capacity | whole | Z   | storage locations of a zone
"""
        ),
        fields_of("zone | whole | N | zone of each stay"),
        {},
    ),
    "zones": Schema(
        fields_of(
            """
visit_s        | real | I J | robot time of a visit by a pod of a class that is stored in a zone, s
rate_per_h     | real | I   | visits per pod of a class, 1/h
pods           | real | I   | number of pods of a class
places         | real | J   | storage locations of a zone
congestion_s_h | real | J   | delay per visit from a zone, divided by visits an hour from it, s h
"""
        ),
        fields_of(
            """
standing    | real | I J | pods of a class in a zone
price_per_h | real | J   | robot time that one more location in a zone would save, s/h; not checked
"""
        ),
        {},
    ),
    "charging": Schema(
        fields_of(
            """
level      | real  | R   | current level of a battery, as a share of its capacity
drain      | real  | R   | consumption of a robot in a slot of work, as a share of the capacity
ready      | whole | R   | first time slot in which a robot may leave its work
waits      | flag  | R   | whether a robot is already on its way to a charger
here       | whole | R   | group of the charger at which a robot is now, or -1
way_s      | cost  | R G | travel time of a robot to a charger of a group, s
places     | whole | G T | maximum number of robots at a group in a slot
gain       | real  | G   | share of the capacity charged per slot at constant power
swapped    | real  | G   | level after a swap; 0 if the group consists of chargers
wanted     | whole | Q T | robots needed for work in a slot, in each of the equally likely cases
slot_s     | real  |     | length of a time slot, s
worth_s    | real  |     | value of a full battery at the end, s of robot time
longest    | whole |     | maximum number of time slots of a stay
taper_from | real  |     | level above which charging slows down; 1 if it never does
full       | real  |     | level that counts as full
least      | real  |     | level below which no robot should fall
short_s    | real  |     | cost of a shortfall below `least`, s of robot time per full battery
idle       | real  |     | cost of an unneeded robot's time away, as a share of a needed robot's
curve      | real  |     | marginal over mean value of energy: 1 + curve if empty, 1 - curve if full
"""
        ),
        fields_of(
            """
group  | whole | R | group of the stay of each robot, or -1
begin  | whole | R | first time slot of the stay, 0 if there is none
length | whole | R | number of time slots of the stay, 0 if there is none
"""
        ),
        {},
    ),
    "matching": Schema(
        fields_of(
            """
travel_s | cost | R T | travel time of a robot to a task, s
leave_s  | cost | T   | cost of leaving a task undone, s; "inf" if it must be done
"""
        ),
        fields_of("robot | whole | T | robot of each task, or -1"),
        {},
    ),
    "balance": Schema(
        fields_of(
            """
arrive_s    | cost  | R T | time until a robot is at the station with the pod of a task, s
leave_s     | cost  | T   | cost of leaving a task undone, s; "inf" if it must be done
due_s       | cost  | T   | time until a task's pod is due at the station, s; "inf": no due time
station     | whole | T   | station of a task
queue       | whole | S   | pods at a station or on their way to it
service_s   | real  | S   | time for which a pod occupies a station, s
room        | whole | S   | maximum number of robots that may be sent to a station now
late_weight | real  |     | cost of a second of lateness, in seconds of travel
"""
        ),
        fields_of("robot | whole | T | robot of each task, or -1"),
        {},
    ),
    "sequence": Schema(
        fields_of(
            """
ready_s     | ms      | R   | earliest time at which a robot can begin, s
carrying    | flag    | R   | whether a robot carries a pod
reach_s     | cost_ms | R T | empty drive from a robot's position to the pod of a task, s
stow_s      | cost_ms | R L | drive of a robot with the pod that it carries to a location, s
fetch_s     | cost_ms | L T | empty drive from a location to the pod of a task, s
bring_s     | ms      | T   | lifting the pod of a task and driving to the station, s
service_s   | ms      | T   | time for which the pod of a task stays at the station, s
store_s     | cost_ms | T L | drive from the station of a task to a location, s
earliest_s  | ms      | T   | earliest arrival at the station, s
latest_s    | cost_ms | T   | latest arrival at the station, s
due_s       | cost_ms | T   | due time of the pod at the station, s
skip_s      | cost_ms | T   | cost of leaving a task undone, s; "inf" if it must be done
late_weight | whole   |     | cost of a second of lateness, in seconds of driving
"""
        ),
        fields_of(
            """
tasks       | lists | R | tasks of a robot, in the order in which it does them
place       | whole | T | location where a task's pod is stored, or -1 if the task is left undone
robot_place | whole | R | location where a robot stores the pod that it carries, or -1
"""
        ),
        {},
    ),
    "replenishment": Schema(
        fields_of(
            """
worth_s       | worth | B P | robot time saved by storing a bundle in a pod, s
leave_s       | cost  | B   | cost of not storing a bundle, s; "inf" if it must be stored
space         | space | B   | space of a bundle
pod_space     | space | P   | free space of a pod
trip_s        | cost  | P S | robot time of bringing a pod to a station, s
station_space | space | S   | free space of a station
"""
        ),
        fields_of(
            """
pod     | whole | B | pod of a bundle, or -1
station | whole | P | station of a pod, or -1
"""
        ),
        {},
    ),
    "run_bound": Schema(
        fields_of(
            """
duration_s                 | real  |   | length of the measured time, s
robots                     | whole |   | number of robots
picking.unit_transfer_s    | real  | S | time for which a unit keeps the station busy, s
picking.unit_pick_s        | real  | S | time for which a unit keeps the robot at the station, s
picking.changeover_s       | real  | S | least time from a robot's departure to the next service, s
picking.inbound_s          | real  | S | shortest drive to the station, s
picking.outbound_s         | real  | S | shortest drive from the station, s
picking.order_slots        | whole | S | order slots
refill.bundle_transfer_s   | real  | Q | time for which a bundle keeps station and robot busy, s
refill.inbound_s           | real  | Q | shortest drive to the station, s
refill.outbound_s          | real  | Q | shortest drive from the station, s
refill.bundle_units        | whole |   | maximum number of units in a bundle
refill.bundles_per_visit   | whole |   | maximum number of bundles in a visit
stock.pod_units            | whole | P | maximum number of units in a pod at the beginning
stock.largest_pod_units    | whole |   | maximum number of units in any pod at any time
orders.units               | cost  |   | maximum number of units ordered in total
orders.largest_order_units | cost  |   | maximum number of units in a single order
orders.lone_units          | cost  |   | maximum units in orders that one visit serves completely
orders.join_visits         | flag  |   | whether orders may join a visit in progress
"""
        ),
        fields_of(
            """
units         | real | S | units picked
visits        | real | S | visits to pick stations
lone_units    | real | S | units of orders that a single visit serves completely
bundles       | real | Q | bundles stored
refill_visits | real | Q | visits to replenishment stations
"""
        ),
        {},
        maximise=True,
    ),
}
"""The families by name."""


def sizes(schema: Schema, data: Plain) -> dict[str, int]:
    """Return the size of every dimension of a question, by the letter of the dimension.

    Parameters
    ----------
    schema
        The family of the question.
    data
        The fields of the question.
    """
    found = {letter: count(data) for letter, count in schema.derived.items()}
    for field in schema.data:
        value = data.get(field.name)
        if value is not None and field.shape:
            found.update(zip(field.shape.split(), np.shape(value), strict=True))
    return found


def described(family: str) -> str:
    """Return a Markdown table of the fields of a family, for the documentation.

    Parameters
    ----------
    family
        Name of the family.
    """
    schema = SCHEMAS[family]
    lines = ["| field | entries | shape | meaning |", "|---|---|---|---|"]
    for part, fields in (("data", schema.data), ("values", schema.values)):
        for field in fields:
            kind = "/".join(field.texts) if field.texts else field.kind
            shape = f"({', '.join(field.shape.split())})" if field.shape else ""
            optional = " (optional)" if field.optional else ""
            name = f"`{part}.{field.name}`"
            lines.append(f"| {name} | {kind} | {shape} | {field.meaning}{optional} |")
    return "\n".join(lines)
