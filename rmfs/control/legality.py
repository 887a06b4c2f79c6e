"""Explains why a decision is impossible in the current state of the warehouse."""

from __future__ import annotations

from numbers import Integral
from typing import TYPE_CHECKING, Any

from rmfs.control import decisions as say
from rmfs.control.problems import Problem
from rmfs.control.repositioning import Move
from rmfs.world.charging import ChargeTask

if TYPE_CHECKING:
    from collections.abc import Callable

    from rmfs.control.questions import Question
    from rmfs.control.view import View

KINDS: dict[Problem, tuple[type, ...]] = {
    problem: tuple(getattr(say, name) for name in problem.decisions) for problem in Problem
}
"""For each problem, the classes of its decisions."""


def why_not(given: Any, question: Question, view: View) -> str:
    """Return why an answer is impossible now, or an empty string if there is no objection.

    Parameters
    ----------
    given
        The answer: a decision if the question is of kind `turn`; otherwise, the number of a pod,
        station or waypoint, or a `Move`.
    """
    if question.kind != "turn":
        return _ANSWERS[question.kind](given, question, view)
    kinds = KINDS[question.problem]
    if not isinstance(given, kinds):
        names = ", ".join(kind.__name__ for kind in kinds)
        return f"in a turn of {question.problem}, expected {names} of rmfs.control.decisions"
    return reason(given, view)


def reason(decision: Any, view: View) -> str:
    """Return why a decision is impossible now, or an empty string if there is no objection.

    `Prepare` and `Exchange` are not checked. For `WorkFor` and `MovePod`, it is not checked whether
    PPS or repositioning will find a pod.
    """
    check = _DECISIONS.get(type(decision))
    if check is None:
        return f"{type(decision).__name__} is not a decision of rmfs.control.decisions"
    return check(decision, view)


# --- orders and bundles ---------------------------------------------------------------------------


def _is_number(given: Any) -> bool:
    """Whether it is an integer, of Python or of NumPy."""
    return isinstance(given, Integral) and not isinstance(given, bool)


def _station(number: Any, count: int, what: str, first: int = 0) -> str:
    if not _is_number(number):
        return f"{number!r} is not the number of a {what}"
    if not first <= number < first + count:
        return f"there is no {what} {number} (valid: {first} to {first + count - 1})"
    return ""


def _pick_station(number: Any, view: View) -> str:
    return _station(number, len(view.pick_stations), "pick station")


def _assign(decision: say.AssignOrder | say.AssignLines, view: View) -> str:
    order, station = decision[0], decision[1]
    wrong = _pick_station(station, view)
    if wrong:
        return wrong
    if order not in view.orders:
        return f"order {order.index} is not in the backlog"
    if order.queued_at not in (-1, station):
        return f"order {order.index} is queued at station {order.queued_at}"
    target = view.pick_stations[station]
    if order.index in target.orders:
        return ""
    if not target.active:
        return f"station {station} is switched off"
    return "" if target.free_slots > 0 else f"station {station} has no free slot"


def _assign_lines(decision: say.AssignLines, view: View) -> str:
    order, _, skus = decision
    wrong = _assign(decision, view)
    if wrong:
        return wrong
    if order.queued_at >= 0:
        return f"order {order.index} is in a pool and cannot be split"
    missing = set(skus) - {line.sku for line in order.lines}
    if missing or not skus:
        return f"order {order.index} has no open lines of SKUs {sorted(missing)}"
    return ""


def _queue(decision: say.QueueOrder, view: View) -> str:
    order, station = decision
    if station == -1:
        return "" if order.queued_at >= 0 else f"order {order.index} is in no pool"
    wrong = _pick_station(station, view)
    if wrong:
        return wrong
    if order not in view.orders:
        return f"order {order.index} is not in the backlog"
    return "" if order.queued_at < 0 else f"order {order.index} is already in a pool"


def _send(decision: say.SendBundle, view: View) -> str:
    bundle, station = decision
    count, first = len(view.replenishment_stations), len(view.pick_stations)
    wrong = _station(station, count, "replenishment station", first)
    if wrong:
        return wrong
    if bundle.station >= 0:
        return f"bundle {bundle.index} is already assigned to station {bundle.station}"
    target = view.replenishment_stations[station - first]
    if not target.active:
        return f"station {station} is switched off"
    if bundle.space > target.free_space:
        return (
            f"station {station} has {target.free_space:g} space units left, but bundle "
            f"{bundle.index} takes {bundle.space:g}"
        )
    return ""


def _promise(decision: say.PromiseBundle, view: View) -> str:
    bundle, pod = decision
    wrong = _station(pod, len(view.inventory.capacity), "pod")
    if wrong:
        return wrong
    if bundle.pod >= 0:
        return f"bundle {bundle.index} is already assigned to pod {bundle.pod}"
    free = float(view.inventory.capacity[pod] - view.inventory.load[pod])
    if bundle.space > free:
        return (
            f"pod {pod} has {free:g} space units left, but bundle {bundle.index} takes "
            f"{bundle.space:g}"
        )
    return ""


def _release(decision: say.ReleasePod, view: View) -> str:
    held = decision.pod in view.bundles.unreleased
    return "" if held else f"pod {decision.pod} has no assigned bundles to release"


def _switch(decision: say.SwitchStation, view: View) -> str:
    return _station(decision.station, len(view.stations), "station")


# --- tasks ----------------------------------------------------------------------------------------


def _may_begin(robot: Any, view: View) -> str:
    """Return why a robot cannot be given a task."""
    if robot.index in view.asking or robot.index in view.resting:
        return ""
    return f"robot {robot.index} already has a task"


def _fetches(robot: Any, pod: int, view: View) -> str:
    """Return why a robot cannot use the pod it carries, or cannot fetch a pod."""
    wrong = _may_begin(robot, view) or _station(pod, len(view.inventory.capacity), "pod")
    if wrong or robot.pod == pod:
        return wrong
    if robot.pod >= 0:
        return f"robot {robot.index} carries pod {robot.pod}"
    return "" if view.storage.is_at_hand[pod] else f"pod {pod} is not available"


def _pick(decision: say.BringForPicks, view: View) -> str:
    robot, pod, station = decision
    return _pick_station(station, view) or _fetches(robot, pod, view)


def _bundles(decision: say.BringForBundles, view: View) -> str:
    robot, pod, station = decision
    count, first = len(view.replenishment_stations), len(view.pick_stations)
    wrong = _station(station, count, "replenishment station", first) or _fetches(robot, pod, view)
    if wrong:
        return wrong
    waits = view.bundles_waiting[view.all_stations[station].number, pod]
    return "" if waits else f"no bundle waits for pod {pod} at station {station}"


def _visit(decision: say.Visit, view: View) -> str:
    robot, pod, station, _ = decision
    first = len(view.stations)
    others = len(view.all_stations) - first
    wrong = _station(station, others, "station other than pick and replenishment stations", first)
    if wrong or robot.pod == pod:
        return wrong or _may_begin(robot, view)
    return _fetches(robot, pod, view)


def _charge(decision: say.Charge, view: View) -> str:
    robot, station, until = decision
    wrong = _may_begin(robot, view)
    if wrong:
        return wrong
    if robot.pod >= 0:
        return f"robot {robot.index} carries pod {robot.pod}"
    if any(other.robot == robot.index for other in view.recovery_stations):
        return f"robot {robot.index} stands at an energy station and must leave it first"
    places = [other.index for other in view.recovery_stations]
    if station not in places:
        return f"station {station} is not an energy station (energy stations: {places})"
    if not isinstance(until, int | float) or not 0 < until <= 1:
        return f"the level must be a share of the capacity above 0 and at most 1 (given: {until!r})"
    bound = len(view.all_stations[station].tasks)
    most = len(view.layout.stations[station].queue)
    return (
        ""
        if bound < most
        else f"{bound} robots are already on their way to or at station {station}"
    )


def _unplug(decision: say.Unplug, view: View) -> str:
    robot = decision.robot
    if any(station.robot == robot.index for station in view.chargers):
        if not isinstance(robot.task, ChargeTask):
            return f"robot {robot.index} is not charging"
        batteries = view.batteries
        if batteries is None or batteries.share(robot.index) >= batteries.enough_share:
            return ""
        return f"robot {robot.index} has too little charge for a task"
    return f"robot {robot.index} is not at a charger"


def _empty_place(place: Any, view: View) -> str:
    if not _is_number(place) or not 0 <= place < len(view.storage.place_index):
        return f"{place!r} is not a waypoint"
    index = view.storage.place_index[place]
    if index < 0:
        return f"waypoint {place} is not a storage location"
    return "" if view.storage.is_empty[index] else f"place {place} is not empty"


def _park(decision: say.Park, view: View) -> str:
    robot, place = decision
    wrong = _may_begin(robot, view)
    if wrong:
        return wrong
    if robot.pod < 0:
        return f"robot {robot.index} carries no pod"
    return _empty_place(place, view)


def _reposition(decision: say.Reposition, view: View) -> str:
    robot, pod, place = decision
    if robot.pod >= 0:
        return f"robot {robot.index} carries pod {robot.pod}"
    return _fetches(robot, pod, view) or _empty_place(place, view)


def _rest(decision: say.Rest, view: View) -> str:
    robot, place = decision
    wrong = _may_begin(robot, view)
    if wrong:
        return wrong
    if robot.pod >= 0:
        return f"robot {robot.index} carries pod {robot.pod}"
    if not 0 <= place < len(view.storage.kept_by):
        return f"{place} is not a waypoint"
    keeper = view.storage.kept_by[place]
    return "" if keeper in (-1, robot.index) else f"waypoint {place} is reserved for robot {keeper}"


def _work_for(decision: say.WorkFor, view: View) -> str:
    return _switch(say.SwitchStation(decision.station, True), view) or _may_begin(
        decision.robot, view
    )


def _store(decision: say.Store, view: View) -> str:
    wrong = _may_begin(decision.robot, view)
    if wrong:
        return wrong
    return "" if decision.robot.pod >= 0 else f"robot {decision.robot.index} carries no pod"


def _move_pod(decision: say.MovePod, view: View) -> str:
    wrong = _may_begin(decision.robot, view)
    carried = decision.robot.pod
    return wrong or (f"robot {decision.robot.index} carries pod {carried}" if carried >= 0 else "")


def _nothing_wrong(decision: Any, view: View) -> str:
    return ""


_DECISIONS: dict[type, Callable[[Any, View], str]] = {
    say.AssignOrder: _assign,
    say.AssignLines: _assign_lines,
    say.QueueOrder: _queue,
    say.SendBundle: _send,
    say.PromiseBundle: _promise,
    say.ReleasePod: _release,
    say.SwitchStation: _switch,
    say.Exchange: _nothing_wrong,
    say.Charge: _charge,
    say.Unplug: _unplug,
    say.BringForPicks: _pick,
    say.BringForBundles: _bundles,
    say.Visit: _visit,
    say.Park: _park,
    say.Reposition: _reposition,
    say.Rest: _rest,
    say.Prepare: _nothing_wrong,
    say.WorkFor: _work_for,
    say.Store: _store,
    say.MovePod: _move_pod,
}


# --- answers to what TA asks ----------------------------------------------------------------------


def _pod_at_hand(given: Any, question: Question, view: View) -> str:
    wrong = _station(given, len(view.inventory.capacity), "pod")
    if wrong:
        return wrong
    return "" if view.storage.is_at_hand[given] else f"pod {given} is not available"


def _replenishment_pod(given: Any, question: Question, view: View) -> str:
    wrong = _pod_at_hand(given, question, view)
    if wrong:
        return wrong
    station = question.stations[0]
    waits = view.bundles_waiting[view.all_stations[station].number, given]
    return "" if waits else f"no bundle waits for pod {given} at station {station}"


def _one_of(given: Any, question: Question, view: View) -> str:
    return "" if given in question.stations else f"the station must be one of {question.stations}"


def _place(given: Any, question: Question, view: View) -> str:
    return _empty_place(given, view)


def _move(given: Any, question: Question, view: View) -> str:
    if not isinstance(given, Move):
        return "expected a Move of rmfs.control.repositioning"
    return _pod_at_hand(given.pod, question, view) or _empty_place(given.place, view)


_ANSWERS: dict[str, Callable[[Any, Question, View], str]] = {
    "pick pod": _pod_at_hand,
    "replenishment pod": _replenishment_pod,
    "next station": _one_of,
    "place": _place,
    "move": _move,
}
