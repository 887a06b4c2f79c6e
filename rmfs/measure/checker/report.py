"""Results of the checker: one finding per violation, and the report that collects them."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum


class FindingKind(StrEnum):
    """The kinds of violations that a trace can contain."""

    GAP = "gap"
    JUMP = "jump"
    HEADING = "heading"
    DURATION = "duration"
    SPEED = "speed"
    EDGE = "edge"
    ELEVATOR_PAIR = "elevator pair"
    ROBOTS_OVERLAP = "robots overlap"
    POD_CROSSED = "pod crossed"
    POD_PLACE = "pod place"
    POD_HANDLING = "pod handling"
    ELEVATOR_SHARED = "elevator shared"
    QUEUE_PLACE_SHARED = "queue place shared"


MEANING = {
    FindingKind.GAP: "{amount:g} s are missing from the trace (negative: covered twice)",
    FindingKind.JUMP: "position jumps by {amount:g} m",
    FindingKind.HEADING: "heading is off by {amount:g} rad",
    FindingKind.DURATION: "duration is off by {amount:+g} s from that at the robot's limits",
    FindingKind.SPEED: "top speed in the trace is off by {amount:+g} m/s",
    FindingKind.EDGE: "this straight run of {amount:g} m does not follow edges of the layout",
    FindingKind.ELEVATOR_PAIR: "no elevator connects this waypoint with waypoint {amount:g}",
    FindingKind.ROBOTS_OVERLAP: "the robots overlap by {amount:g} m",
    FindingKind.POD_CROSSED: "carried pod overlaps a stored pod by {amount:g} m",
    FindingKind.POD_PLACE: "pod {amount:g} is set down where no pod may be stored",
    FindingKind.POD_HANDLING: "pod {amount:g} is not where the robot takes, carries or leaves it",
    FindingKind.ELEVATOR_SHARED: "two robots share the elevator for {amount:g} s",
    FindingKind.QUEUE_PLACE_SHARED: "two robots share the queue place for {amount:g} s",
}
"""Message for each kind; `amount` is the number stored in the finding."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One violation found in a trace.

    Attributes
    ----------
    time_s
        Time of the violation; for overlaps, the time of the closest approach.
    robots
        Numbers of the robots concerned, in ascending order.
    place
        Waypoint at or near which the violation occurs; -1 if the trace contains no row of the
        robot.
    amount
        Size of the violation, or the number of the pod or waypoint concerned; see `MEANING` for
        each kind.
    """

    kind: FindingKind
    time_s: float
    robots: tuple[int, ...]
    place: int
    amount: float

    def __str__(self) -> str:
        """Return one readable line."""
        who = " and ".join(f"robot {robot}" for robot in self.robots) or "no robot"
        where = f" at waypoint {self.place}" if self.place >= 0 else ""
        what = MEANING[self.kind].format(amount=self.amount)
        return f"{self.time_s:.6f} s, {who}{where}: {what}"


@dataclass(frozen=True, slots=True)
class CheckReport:
    """The result of checking a trace.

    Attributes
    ----------
    findings
        Every violation, in order of time.
    pieces
        Number of motions checked; each is a row of the trace.
    pairs
        Number of pairs of sections of motions that were examined for an overlap of two robots,
        because they are close in time and space. Acceleration is constant in a section.
    """

    findings: list[Finding] = field(default_factory=list)
    pieces: int = 0
    pairs: int = 0

    @property
    def ok(self) -> bool:
        """Whether the trace violates no rule."""
        return not self.findings

    @property
    def collisions(self) -> int:
        """Number of overlaps of two bodies: two robots, or a carried and a stored pod."""
        bodies = (FindingKind.ROBOTS_OVERLAP, FindingKind.POD_CROSSED)
        return sum(finding.kind in bodies for finding in self.findings)

    def of(self, kind: FindingKind) -> list[Finding]:
        """Return the findings of one kind."""
        return [finding for finding in self.findings if finding.kind == kind]

    def summary(self, limit: int = 10) -> str:
        """Return the result in a few lines: findings per kind, and the first `limit` findings."""
        if self.ok:
            return f"trace is safe: {self.pieces} motions, {self.pairs} close pairs proven apart"
        counts = {kind: len(self.of(kind)) for kind in FindingKind}
        told = ", ".join(f"{kind}: {count}" for kind, count in counts.items() if count)
        shown = [str(finding) for finding in self.findings[:limit]]
        return "\n".join([f"trace is not safe ({told})", *shown])
