"""The route order that a robot carries out, and the robot's progress."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path

from .create2 import Counts
from .protocol import Message, ProtocolError

TURNS = {"left": math.pi / 2, "right": -math.pi / 2, "around": math.pi}
"""Angle of each turning action, in radians; positive angles are anticlockwise."""
STRAIGHT = "straight"


@dataclass
class Order:
    """A route order: the server's command to turn, if necessary, and then to drive straight ahead.

    The turn is made on the spot; the run that follows it leads over one or more waypoints.

    Attributes
    ----------
    number
        Number of the route order.
    turn_rad
        Angle of the turn in radians, positive anticlockwise; 0 without a turn.
    start
        Tag of the waypoint where the run begins.
    tags, metres
        Tags of the waypoints of the run after `start`, and the distance in m of each of these
        waypoints from the one before it.
    granted
        Number of waypoints in `tags` that the robot may drive to so far. It must stop at the last
        of them.
    turned
        Whether the turn is done.
    passed
        Number of waypoints in `tags` that have been reached.
    since
        Wheel counters, read when the route order arrived, the turn ended or a waypoint was reached,
        whichever was last.
    ahead_m
        Position of the robot at the moment when `since` was read, in m beyond the last waypoint
        reached. It is negative if the robot was still before the centre of that waypoint, since the
        reader detects a tag at some distance.
    """

    number: int
    turn_rad: float
    start: str
    tags: list[str]
    metres: list[float]
    granted: int
    turned: bool = False
    passed: int = 0
    since: Counts | None = None
    ahead_m: float = 0.0

    @classmethod
    def of(cls, message: Message) -> Order:
        """Create a route order from a message of the server.

        Raises
        ------
        ProtocolError
            If the message is not a valid route order.
        """
        try:
            actions = [str(action) for action in message["actions"]]
            turn = TURNS[actions.pop(0)] if actions and actions[0] in TURNS else 0.0
            if set(actions) - {STRAIGHT} or not len(actions) == len(message["tags"]) == len(
                message["metres"]
            ):
                raise ValueError(
                    "after an optional turn, actions must be straight, one for each of tags "
                    "and metres"
                )
            return cls(
                number=int(message["id"]),
                turn_rad=turn,
                start=str(message["start"]),
                tags=[str(tag) for tag in message["tags"]],
                metres=[float(metres) for metres in message["metres"]],
                granted=int(message["granted"]),
                turned=bool(message["turned"]),
                passed=int(message["passed"]),
            )
        except (KeyError, TypeError, ValueError) as error:
            raise ProtocolError(f"no order: {error!r}") from None

    def cut(self, upto: int) -> None:
        """Shorten the run to `upto` waypoints, or to those already reached if these are more."""
        upto = max(upto, self.passed)
        del self.tags[upto:], self.metres[upto:]

    def to_stop_m(self, rolled_m: float) -> float:
        """Return the distance to the last granted waypoint, in m; negative beyond it.

        Parameters
        ----------
        rolled_m
            Distance in m that the robot has rolled since the wheel counters `since` were read.
        """
        granted = min(self.granted, len(self.tags))
        return sum(self.metres[self.passed : granted]) - rolled_m - self.ahead_m


@dataclass
class Memory:
    """The part of the state of a robot's program that is saved in a file.

    Attributes
    ----------
    path
        The file; None if the state is not saved.
    order
        The route order in progress; None if there is none.
    last_done
        Number of the last completed route order; 0 before the first.
    """

    path: Path | None = None
    order: Order | None = None
    last_done: int = 0
    _written: str = field(default="", repr=False)

    def save(self) -> None:
        """Write the memory to the file `path`, unless `path` is None or nothing has changed."""
        if self.path is None:
            return
        order = None if self.order is None else vars(self.order)
        text = json.dumps({"order": order, "last_done": self.last_done})
        if text == self._written:
            return
        draft = self.path.with_suffix(".draft")
        draft.write_text(text, encoding="utf-8")
        draft.replace(self.path)
        self._written = text

    @classmethod
    def load(cls, path: Path | None) -> Memory:
        """Return the memory saved in a file; an empty memory if none can be read."""
        memory = cls(path)
        try:
            known = json.loads(path.read_text(encoding="utf-8")) if path is not None else {}
            memory.last_done = int(known.get("last_done", 0))
            if known.get("order"):
                order = Order(**known["order"])
                order.since = None if order.since is None else Counts(*order.since)
                memory.order = order
        except (OSError, ValueError, TypeError):
            return cls(path)
        return memory
