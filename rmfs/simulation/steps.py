"""The steps of a decision phase, and which of them are due."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.world import World

# in their order; the earliest one that is due comes next
ANSWERS = 0
MANAGE = 1
ARRIVALS = 2
ASKED = (Problem.SA, Problem.RPS, Problem.ROA, Problem.POA)
LATE_BINDING = ARRIVALS + len(ASKED) + 1
# these may ask optimisers; what they decide, TA asks
AHEAD = (Problem.PPS, Problem.PSA)
CHARGES = LATE_BINDING + len(AHEAD) + 1
TASKS = CHARGES + 1

PROBLEM_OF: dict[int, Problem] = {
    **dict(enumerate(ASKED, start=ARRIVALS + 1)),
    **dict(enumerate(AHEAD, start=LATE_BINDING + 1)),
    CHARGES: Problem.CA,
}
"""Whose controller is asked in a step."""

STEP_OF: dict[Problem, int] = {
    **{problem: step for step, problem in PROBLEM_OF.items()},
    Problem.MM: MANAGE,
    Problem.TA: TASKS,
    Problem.REPOSITIONING: TASKS,
}
"""In which step a controller is asked; all but PP."""

_ARRIVALS_AFTER = frozenset(
    {
        Trigger.START,
        Trigger.ORDER_ASSIGNED,
        Trigger.BUNDLE_ASSIGNED,
        Trigger.UNIT_PICKED,
        Trigger.BUNDLE_STORED,
    }
)
_LATE_BINDING_AFTER = frozenset(
    {Trigger.ORDER_ASSIGNED, Trigger.ORDER_QUEUED, Trigger.BUNDLE_ASSIGNED, Trigger.POD_LIFTED}
)


class Due:
    """Which steps are due: one bit each.

    Attributes
    ----------
    bits
        Bit k is set if step k is due.
    storage_version
        Of the pods and places that those who are due have been told of.
    """

    def __init__(self, world: World, controllers: ControllerSet) -> None:
        self._world = world
        self._controllers = controllers
        self._masks: list[int] = []
        self.storage_version = world.storage.version
        self.bits = 0
        self.connect()

    def connect(self) -> None:
        """Take note of who is asked after which trigger."""
        self._masks = []
        asked = set(STEP_OF)
        if self._world.batteries is None:
            asked.remove(Problem.CA)  # robots have as much energy as they need
        for trigger in Trigger:
            mask = 0
            for problem in self._controllers.calls[trigger] & asked:
                mask |= 1 << STEP_OF[problem]
            mask |= (trigger in _ARRIVALS_AFTER) << ARRIVALS
            mask |= (trigger in _LATE_BINDING_AFTER) << LATE_BINDING
            self._masks.append(mask)

    def signal(self, trigger: Trigger, subject: Any = None) -> None:
        """Take note of an event: whom it concerns is asked in the phase of this instant."""
        self.bits |= self._masks[trigger]
        for listener in self._controllers.listeners[trigger]:
            listener(trigger, subject)

    def want(self, problem: Problem) -> None:
        """Let a controller be asked."""
        self.bits |= 1 << STEP_OF[problem]

    def want_arrivals(self) -> None:
        """Let orders or bundles be made now."""
        self.bits |= 1 << ARRIVALS

    def want_answers(self) -> None:
        """Let answers of optimisers be passed on."""
        self.bits |= 1 << ANSWERS

    def place_left(self) -> None:
        """Take note that a storage place was left: a robot may wait for an empty one."""
        if self._world.asking:
            self.bits |= 1 << TASKS

    def storage_changed(self) -> None:
        """Take note that pods or places have become free or taken."""
        self.storage_version = self._world.storage.version
        self.signal(Trigger.POD_AT_HAND)
