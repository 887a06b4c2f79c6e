"""Visits: controllers that bring pods to stations of user-defined kinds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rmfs.control.legality import reason
from rmfs.observer import Observer
from rmfs.random import Stream, generator
from rmfs.world.stations import Station
from rmfs.world.tasks import VisitTask

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rmfs.control.decisions import Visit
    from rmfs.control.view import View
    from rmfs.layout.kinds import StationKind
    from rmfs.simulation.dispatch import Dispatch
    from rmfs.world import World
    from rmfs.world.robots import Robot

S = TypeVar("S", bound=Station[Any])


class VisitController(Observer, Generic[S]):
    """Base class of controllers that decide which pods go to the stations of a kind, and when.

    A controller is asked about each robot that needs a task, before TA is asked, and observes the
    run with the callbacks of `Observer`. It changes nothing itself; its decisions are applied by
    the simulation. It may hold only plain data, no open files or functions created on the fly,
    because a run can be copied or saved at any moment.

    Parameters
    ----------
    kind
        The kind of the stations, with its parameters.
    stations
        The current state of each station of this kind.
    view
        The world, read-only.
    seed
        Seed of the run.

    Attributes
    ----------
    task
        The class of task to pass as `what` to a `Visit`.
    rng
        Random generator of the controller.
    """

    def __init__(self, kind: StationKind, stations: Sequence[S], view: View, seed: int = 0) -> None:
        self.parameters = kind.parameters
        self.task: type[VisitTask] = kind.part("task", VisitTask)
        self.stations = list(stations)
        self.view = view
        self.rng = generator(seed, Stream.VISITS, *kind.name.encode())

    def visit_for(self, robot: Robot) -> Visit | None:
        """Return the visit to give to a robot that needs a task, or None to give it none.

        A robot that carries a pod can only bring this pod to a station; a robot without a pod may
        fetch any available pod (`view.storage.is_at_hand`).
        """
        raise NotImplementedError


class Visits:
    """Asks the controllers of user-defined kinds of station, and applies their decisions."""

    def __init__(self, world: World, view: View, dispatch: Dispatch, seed: int) -> None:
        self._world, self._view, self._dispatch = world, view, dispatch
        self.controllers: list[VisitController[Any]] = []
        plans = world.layout.stations
        for kind in world.layout.other_kinds:
            if kind.controller is not None:
                own = [s for s in world.stations if plans[s.index].kind.name == kind.name]
                controller = kind.part("controller", VisitController)
                self.controllers.append(controller(kind, own, view, seed))

    def give(self) -> None:
        """Ask the controllers about each robot that needs a task, and apply their decisions.

        Raises
        ------
        ValueError
            If a decision is impossible.
        """
        for robot in list(self._world.asking.values()):
            for controller in self.controllers:
                visit = controller.visit_for(robot)
                if visit is not None:
                    wrong = reason(visit, self._view)
                    if wrong:
                        raise ValueError(f"{type(controller).__qualname__}: {visit}: {wrong}")
                    self._dispatch.start(visit)
                    break
