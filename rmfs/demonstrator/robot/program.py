"""The robot's program, which carries out route orders and reports progress to the server.

`Program.step` is to be called repeatedly (20 times a second is enough); it never waits for a motion
to end.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from .client import Link
from .create2 import TRACK_M, Counts, Create2
from .order import Memory, Order
from .pid import Pid
from .protocol import Message, ProtocolError
from .tags import TagReader


class LineSensor(Protocol):
    """A sensor that sees the line on the floor ahead."""

    def offset_m(self) -> float | None:
        """Return how far left of the robot's centre the line is, in m; None if no line is seen.

        The distance is negative if the line is to the right of the centre.
        """


@dataclass(frozen=True)
class Settings:
    """Settings of a robot's motion.

    Attributes
    ----------
    speed_m_s, acceleration_m_s2
        Top speed and acceleration of straight runs.
    turn_rad_s
        Angular speed of turns on the spot.
    creep_m_s
        Lowest speed, used for the last millimetres before a stop and when searching for a tag.
    tag_ahead_m
        Distance before the centre of a tag at which the reader detects it.
    overshoot_m
        Distance past a waypoint after which its tag counts as missed.
    blind_m
        Maximum distance that the robot drives without seeing a line.
    search_m, searches
        Length of the stretch in which a missed tag is searched for, and maximum number of searches.
        The stretch ends `overshoot_m` past the expected position of the tag.
    steering
        Weights and limit of the PID controller (`Pid`), which turns the offset of the line in m
        into an angular speed in rad/s.
    """

    speed_m_s: float = 0.21
    acceleration_m_s2: float = 0.5
    turn_rad_s: float = 2 * math.pi / 5.5
    creep_m_s: float = 0.03
    tag_ahead_m: float = 0.015
    overshoot_m: float = 0.04
    blind_m: float = 0.3
    search_m: float = 0.08
    searches: int = 6
    steering: tuple[float, float, float, float] = (18.0, 0.5, 0.6, 1.2)


ANGLE_TOLERANCE_RAD = math.radians(1.5)
PLACE_TOLERANCE_M = 0.004


class Program:
    """The program that drives one robot.

    Parameters
    ----------
    base
        Driver of the robot's base.
    line
        Line sensor.
    tags
        Tag reader.
    link
        Link to the server.
    settings
        Settings of the robot's motion.
    memory
        File that keeps the route order in case the program is killed. Default: nothing is kept.
    """

    def __init__(
        self,
        base: Create2,
        line: LineSensor,
        tags: TagReader,
        link: Link,
        settings: Settings | None = None,
        memory: Path | None = None,
    ) -> None:
        self.base, self.line, self.tags, self.link = base, line, tags, link
        self.settings = settings or Settings()
        self.memory = Memory.load(memory)
        self._pid = Pid(*self.settings.steering)
        self._speed = 0.0
        self._blind_m = 0.0
        self._searches = 0
        self._back = False
        self._last_us: int | None = None
        self._last_counts: Counts | None = None
        base.start()

    def step(self, now_us: int) -> None:
        """Read the sensors and the server's messages, set the wheels' speeds, and send messages."""
        seconds = 0.0 if self._last_us is None else (now_us - self._last_us) / 1e6
        self._last_us = now_us
        counts = self.base.counts()
        for message in self.link.poll(now_us):
            try:
                self._hear(message, counts)
            except (ProtocolError, KeyError, ValueError, TypeError) as error:
                self.link.send({"type": "trouble", "id": 0, "reason": repr(error)})
        tag = self.tags.read()
        if tag is not None:
            self._pass(tag, counts)
        self._move(counts, seconds)
        self._last_counts = counts
        self.memory.save()
        self.link.flush(now_us)

    # --- what the server says ---------------------------------------------------------------

    def _hear(self, message: Message, counts: Counts) -> None:
        kind = message.get("type")
        if kind == "connected":
            self._tell_state()
        elif kind == "go":
            self._take(Order.of(message), counts)
        elif kind == "grant" and self._has(message):
            assert self.memory.order is not None
            self.memory.order.granted = max(self.memory.order.granted, int(message["granted"]))
        elif kind == "cut" and self._has(message):
            assert self.memory.order is not None
            self.memory.order.cut(int(message["upto"]))

    def _has(self, message: Message) -> bool:
        order = self.memory.order
        return order is not None and order.number == message.get("id")

    def _take(self, order: Order, counts: Counts) -> None:
        known = self.memory.order
        if order.number <= self.memory.last_done:
            self._tell_state()
            return
        if known is not None and known.number == order.number:
            known.granted = max(known.granted, order.granted)
            known.cut(len(order.tags))
            return
        order.since = counts
        order.turned = order.turned or order.turn_rad == 0.0
        self.memory.order = order
        self._begin_line()

    def _tell_state(self) -> None:
        order = self.memory.order
        self.link.send(
            {
                "type": "state",
                "id": order.number if order else 0,
                "turned": bool(order and order.turned),
                "passed": order.passed if order else 0,
                "last_done": self.memory.last_done,
            }
        )

    # --- tags ---------------------------------------------------------------------------------

    def _pass(self, tag: str, counts: Counts) -> None:
        order = self.memory.order
        if order is None or tag == order.start or tag in order.tags[: order.passed]:
            self.link.send({"type": "seen", "tag": tag})
            return
        ahead = order.tags[order.passed :]
        if tag not in ahead or not order.turned:
            self.memory.order = None
            self.link.send({"type": "astray", "id": order.number, "tag": tag})
            return
        order.passed += ahead.index(tag) + 1
        forward = -1.0 if self._back else 1.0
        order.since, order.ahead_m = counts, -forward * self.settings.tag_ahead_m
        self._searches, self._back = 0, False
        self.link.send({"type": "tag", "id": order.number, "tag": tag})

    # --- motion -------------------------------------------------------------------------------

    def _move(self, counts: Counts, seconds: float) -> None:
        order = self.memory.order
        if order is None:
            self._halt()
            return
        assert order.since is not None
        left, right = counts.rolled_m(order.since)
        if not order.turned:
            self._turn(order, (right - left) / TRACK_M, counts)
        else:
            self._follow(order, (left + right) / 2, counts, seconds)

    def _turn(self, order: Order, turned_rad: float, counts: Counts) -> None:
        left_rad = order.turn_rad - turned_rad
        if abs(left_rad) < ANGLE_TOLERANCE_RAD:
            self._halt()
            order.turned, order.since, order.ahead_m = True, counts, 0.0
            self._begin_line()
            self.link.send({"type": "turned", "id": order.number})
            return
        rate = math.copysign(min(self.settings.turn_rad_s, 0.15 + 4 * abs(left_rad)), left_rad)
        self.base.drive(-rate * TRACK_M / 2, rate * TRACK_M / 2)

    def _follow(self, order: Order, rolled_m: float, counts: Counts, seconds: float) -> None:
        to_stop = order.to_stop_m(rolled_m)
        if order.passed == len(order.tags) and to_stop < PLACE_TOLERANCE_M:
            self._finish(order)
            return
        missing = order.passed < min(order.granted, len(order.tags))
        overshot = order.to_stop_m(rolled_m) if order.passed + 1 >= order.granted else None
        if missing and overshot is None:
            self._count_missed(order, rolled_m, counts)
        if (
            missing
            and overshot is not None
            and (overshot < -self.settings.overshoot_m or self._back)
        ):
            self._search(order, overshot, counts)
            return
        if not missing and to_stop < PLACE_TOLERANCE_M:
            self._halt()
            return
        limit = math.sqrt(2 * self.settings.acceleration_m_s2 * max(0.0, to_stop))
        wanted = max(self.settings.creep_m_s, min(self.settings.speed_m_s, limit))
        self._speed = min(wanted, self._speed + self.settings.acceleration_m_s2 * seconds)
        self._steer(self._speed, order, counts, seconds)

    def _steer(self, speed: float, order: Order, counts: Counts, seconds: float) -> None:
        offset = self.line.offset_m()
        if offset is None:
            self._blind_m += speed * seconds
            rate = 0.0
            if self._blind_m > self.settings.blind_m:
                self.memory.order = None
                self._halt()
                self.link.send({"type": "trouble", "id": order.number, "reason": "no line"})
                return
        else:
            self._blind_m = 0.0
            rate = self._pid.output(offset, seconds)
        self.base.drive(speed - rate * TRACK_M / 2, speed + rate * TRACK_M / 2)

    def _count_missed(self, order: Order, rolled_m: float, counts: Counts) -> None:
        """Count a waypoint as reached although its tag was missed; the next tag will confirm it."""
        beyond = rolled_m + order.ahead_m - order.metres[order.passed]
        if beyond > self.settings.overshoot_m:
            order.passed += 1
            order.since, order.ahead_m = counts, beyond

    def _search(self, order: Order, overshot_m: float, counts: Counts) -> None:
        """Drive back and forth over the expected position of a missed tag."""
        if not self._back and overshot_m < -self.settings.overshoot_m:
            self._back = True
            self._searches += 1
        elif self._back and overshot_m > self.settings.search_m - self.settings.overshoot_m:
            self._back = False
        if self._searches > self.settings.searches:
            # the wheels' counters say it is here
            order.passed = min(order.granted, len(order.tags))
            order.since, order.ahead_m = counts, -overshot_m
            self._searches, self._back = 0, False
            self.link.send({"type": "tag", "id": order.number, "tag": order.tags[order.passed - 1]})
            return
        creep = -self.settings.creep_m_s if self._back else self.settings.creep_m_s
        self._speed = 0.0
        self.base.drive(creep, creep)

    def _finish(self, order: Order) -> None:
        self._halt()
        self.memory.order, self.memory.last_done = None, order.number
        self.link.send({"type": "done", "id": order.number})

    def _begin_line(self) -> None:
        self._pid.reset()
        self._blind_m, self._searches, self._back = 0.0, 0, False

    def _halt(self) -> None:
        self._speed = 0.0
        self.base.stop()
