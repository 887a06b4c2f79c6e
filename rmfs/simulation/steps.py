"""The steps of a decision phase, and which of them are due."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.control.problems import Problem, Trigger

if TYPE_CHECKING:
    from rmfs.simulation.controller_set import ControllerSet
    from rmfs.world import World

# in this order; the earliest one that is due comes next
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
"""The decision problem whose controller is called in each of these steps."""

STEP_OF: dict[Problem, int] = {
    **{problem: step for step, problem in PROBLEM_OF.items()},
    Problem.MM: MANAGE,
    Problem.TA: TASKS,
    Problem.REPOSITIONING: TASKS,
}
"""The step in which the controller of each decision problem is called; PP has none."""

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
    """The steps that are due, one bit each.

    Attributes
    ----------
    bits
        Bit k is set if step k is due.
    storage_version
        Value of `world.storage.version` when the controllers were last notified that pods have
        become available.
    """

    def __init__(self, world: World, controllers: ControllerSet) -> None:
        self._world = world
        self._controllers = controllers
        self._masks: list[int] = []
        self.storage_version = world.storage.version
        self.bits = 0
        self.connect()

    def connect(self) -> None:
        """Determine which steps become due after each trigger, given the installed controllers."""
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
        """Process a trigger: mark as due the steps that it causes, and call its listeners."""
        self.bits |= self._masks[trigger]
        for listener in self._controllers.listeners[trigger]:
            listener(trigger, subject)

    def want(self, problem: Problem) -> None:
        """Mark as due the step that calls the controller of a problem."""
        self.bits |= 1 << STEP_OF[problem]

    def want_arrivals(self) -> None:
        """Mark as due the step that creates orders and bundles."""
        self.bits |= 1 << ARRIVALS

    def want_answers(self) -> None:
        """Mark as due the step that passes answers of optimisers to controllers."""
        self.bits |= 1 << ANSWERS

    def place_left(self) -> None:
        """Record that a robot has left a storage location, for which others may be waiting."""
        if self._world.asking:
            self.bits |= 1 << TASKS

    def storage_changed(self) -> None:
        """Signal that pods have become available."""
        self.storage_version = self._world.storage.version
        self.signal(Trigger.POD_AT_HAND)
