"""Maps the name of a controller to its class.

Controllers come from three sources:

- `rmfs` itself: the tables of this module refer to the classes by strings, so that this module
  does not import `rmfs.solvers`;
- other installed packages, by entry points named `PROBLEM.NAME` in the group `rmfs.controllers`;
- classes that a controllers file names as `module:Class` or `path/to/file.py:Class`.
"""

from __future__ import annotations

import difflib
from functools import cache
from importlib.metadata import entry_points
from typing import Any

from rmfs.control.base import Controller
from rmfs.control.problems import Problem
from rmfs.errors import InputError
from rmfs.references import is_reference, require_allowed, resolve

GROUP = "rmfs.controllers"
"""Group of entry points by which other packages provide controllers."""

_BUILT_IN: dict[Problem, dict[str, str]] = {
    Problem.POA: {
        "pod-match": "rmfs.control.poa.pod_match:PodMatch",
        "wave": "rmfs.control.poa.wave:Wave",
        "lines-in-common": "rmfs.control.poa.lines_in_common:LinesInCommon",
        "foresight": "rmfs.control.poa.foresight:Foresight",
        "queue": "rmfs.control.poa.queue:Queue",
        "related": "rmfs.control.poa.related:Related",
        "near-best-pod": "rmfs.control.poa.near_best_pod:NearBestPod",
        "workload": "rmfs.control.poa.workload:Workload",
        "picker-load": "rmfs.control.poa.picker_load:PickerLoad",
        "first-come": "rmfs.control.poa.order_rules:FirstCome",
        "due-time": "rmfs.control.poa.order_rules:DueTime",
        "tardiness-cost": "rmfs.control.poa.order_rules:TardinessCost",
        "slack": "rmfs.control.poa.order_rules:Slack",
        "critical-ratio": "rmfs.control.poa.order_rules:CriticalRatio",
        "frequency-age": "rmfs.control.poa.order_rules:FrequencyAge",
        "random": "rmfs.control.poa.order_rules:RandomOrder",
        "linear": "rmfs.control.poa.linear:Linear",
        "network": "rmfs.control.poa.network:NetworkRule",
        "rollout": "rmfs.control.poa.rollout:Rollout",
        "dummy": "rmfs.control.dummies:DummyPOA",
    },
    Problem.ROA: {
        "same-pod": "rmfs.control.roa.same_pod:SamePod",
        "random": "rmfs.control.roa.random:RandomStation",
        "dummy": "rmfs.control.dummies:DummyROA",
    },
    Problem.RPS: {
        "emptiest": "rmfs.control.rps.emptiest:Emptiest",
        "least-demand": "rmfs.control.rps.least_demand:LeastDemand",
        "correlative": "rmfs.control.rps.correlative:Correlative",
        "turnover": "rmfs.control.rps.turnover:Turnover",
        "nearest": "rmfs.control.rps.located:Nearest",
        "reactive": "rmfs.control.rps.located:Reactive",
        "random": "rmfs.control.rps.random:RandomPod",
        "dummy": "rmfs.control.dummies:DummyRPS",
    },
    Problem.PPS: {
        "lexicographic": "rmfs.control.pps.lexicographic:Lexicographic",
        "random": "rmfs.control.pps.random:RandomPod",
        "linear": "rmfs.control.pps.linear:Linear",
        "network": "rmfs.control.pps.network:NetworkRule",
        "dummy": "rmfs.control.dummies:DummyPPS",
    },
    Problem.PSA: {
        "nearest": "rmfs.control.psa.nearest:Nearest",
        "random": "rmfs.control.psa.random:RandomPlace",
        "fixed": "rmfs.control.psa.fixed:Fixed",
        "station-based": "rmfs.control.psa.station_based:StationBased",
        "turnover": "rmfs.control.psa.turnover:Turnover",
        "cache": "rmfs.control.psa.cache:Cache",
        "utility": "rmfs.control.psa.utility:Utility",
        "linear": "rmfs.control.psa.linear:Linear",
        "network": "rmfs.control.psa.network:NetworkRule",
        "dummy": "rmfs.control.dummies:DummyPSA",
    },
    Problem.TA: {
        "balanced": "rmfs.control.ta.balanced:Balanced",
        "constant-ratio": "rmfs.control.ta.constant_ratio:ConstantRatio",
        "random": "rmfs.control.ta.random:RandomTasks",
        "brute-force": "rmfs.control.ta.brute_force:BruteForce",
        "swarm": "rmfs.control.ta.swarm:Swarm",
        "linear": "rmfs.control.ta.linear:Linear",
        "network": "rmfs.control.ta.network:NetworkRule",
        "rollout": "rmfs.control.ta.rollout:Rollout",
        "dummy": "rmfs.control.dummies:DummyTA",
    },
    Problem.SA: {
        "all": "rmfs.control.sa.all:AllStations",
        "backlog-threshold": "rmfs.control.sa.backlog_threshold:BacklogThreshold",
        "constant-ratio": "rmfs.control.sa.constant_ratio:ConstantRatio",
        "work-shifts": "rmfs.control.sa.work_shifts:WorkShifts",
        "staffed": "rmfs.control.sa.staffed:Staffed",
        "dummy": "rmfs.control.dummies:DummySA",
    },
    Problem.MM: {
        "none": "rmfs.control.mm.none:NoExchange",
        "scheduled": "rmfs.control.mm.scheduled:Scheduled",
        "random": "rmfs.control.mm.random:RandomExchange",
    },
    Problem.REPOSITIONING: {
        "none": "rmfs.control.repositioning.none:NoMoves",
        "cache": "rmfs.control.repositioning.cache:Cache",
        "cache-drop-off": "rmfs.control.repositioning.cache_drop_off:CacheDropOff",
        "utility": "rmfs.control.repositioning.utility:Utility",
        "dummy": "rmfs.control.dummies:DummyRepositioning",
    },
    Problem.PP: {
        "time-windows": "rmfs.control.pp.time_windows:TimeWindows",
        "whca-v": "rmfs.control.pp.whca:WhcaVolatile",
        "whca-n": "rmfs.control.pp.whca:WhcaPersistent",
        "od-id": "rmfs.control.pp.od_id:OdId",
        "pas": "rmfs.control.pp.pas:Pas",
        "pibt": "rmfs.control.pp.pibt:Pibt",
        "far": "rmfs.control.pp.far:Far",
        "bcp": "rmfs.control.pp.bcp:Bcp",
        "cbs": "rmfs.control.pp.trees:Cbs",
        "pbs": "rmfs.control.pp.trees:Pbs",
    },
    Problem.CA: {
        "threshold": "rmfs.control.ca.threshold:Threshold",
        "to-full": "rmfs.control.ca.threshold:ToFull",
        "opportunity": "rmfs.control.ca.opportunity:Opportunity",
        "breaks": "rmfs.control.ca.breaks:Breaks",
        "by-demand": "rmfs.control.ca.by_demand:ByDemand",
        "dummy": "rmfs.control.dummies:DummyCA",
    },
}

_SOLVER_BACKED: dict[Problem, dict[str, str]] = {
    Problem.POA: {"pile-on": "rmfs.solvers.control.pile_on:PileOnControl"},
    Problem.RPS: {"stocking": "rmfs.solvers.control.stocking:StockingControl"},
    Problem.PSA: {
        "placement": "rmfs.solvers.control.storage.placement:PlacementControl",
        "prices": "rmfs.solvers.control.storage.prices:PricesControl",
        "stays": "rmfs.solvers.control.storage.stays:StaysControl",
    },
    Problem.TA: {
        "pile-on": "rmfs.solvers.control.pile_on:PileOnTasks",
        "dispatch": "rmfs.solvers.control.tasks.dispatch:DispatchControl",
        "routes": "rmfs.solvers.control.tasks.routes:RoutesControl",
        "planning": "rmfs.solvers.control.planning:PlanningControl",
    },
    Problem.CA: {"schedule": "rmfs.solvers.control.charging:ScheduleControl"},
}
"""References to the controllers in `rmfs.solvers`, which ask optimisers, by problem and name."""


def names(problem: Problem) -> list[str]:
    """Return the names of all controllers for a problem, in `rmfs` and other installed packages."""
    return [*_BUILT_IN[problem], *solver_backed(problem), *sorted(_installed(problem))]


def built_in(problem: Problem) -> list[str]:
    """Return the names of a problem's controllers in `rmfs.control`."""
    return list(_BUILT_IN[problem])


def solver_backed(problem: Problem) -> list[str]:
    """Return the names of a problem's controllers in `rmfs.solvers`; they all ask optimisers."""
    return list(_SOLVER_BACKED.get(problem, ()))


def find(problem: Problem, name: str) -> type[Controller[Any]]:
    """Find the class of a controller.

    Parameters
    ----------
    name
        A name that `names` returns, or a class as `module:Class` or `path/to/file.py:Class`.

    Raises
    ------
    InputError
        If there is no such controller, or if its class cannot be imported, lacks a method or is for
        another problem.
    """
    shipped = _BUILT_IN[problem] | _SOLVER_BACKED.get(problem, {})
    reference = shipped.get(name) or _installed(problem).get(name)
    if reference is None and is_reference(name):
        require_allowed(name)
        reference = name
    if reference is None:
        known = names(problem)
        near = difflib.get_close_matches(name, known, n=1)
        hint = f"did you mean {near[0]}?" if near else f"valid: {', '.join(known)}"
        raise InputError(f"no {problem} rule named {name}; {hint}")
    return _load(problem, reference)


def _load(problem: Problem, reference: str) -> type[Controller[Any]]:
    found = resolve(reference, Controller, "controller")
    own = found.__module__.partition(".")[0] == "rmfs"
    if not own and (lacking := _lacking(found)):
        raise InputError(f"{reference}: {found.__qualname__} has no {', '.join(lacking)}")
    if found.problem is not problem:
        raise InputError(f"{reference}: solves {found.problem}, not {problem}")
    return resolve(found, resolve(problem.protocol, Controller, "controller"), "controller")


def _lacking(found: type) -> list[str]:
    """Return the names of the abstract methods that a class does not define."""
    members = ((name, getattr(found, name, None)) for name in dir(found))
    return [name for name, member in members if getattr(member, "__isabstractmethod__", False)]


@cache
def _installed(problem: Problem) -> dict[str, str]:
    prefix = f"{problem}."
    found = entry_points(group=GROUP)
    return {
        entry.name.removeprefix(prefix): entry.value
        for entry in found
        if entry.name.startswith(prefix)
    }
