"""Task allocation as a PettingZoo environment, in which robots are the agents."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from gymnasium import spaces
from pettingzoo import ParallelEnv

from rmfs.control.decisions import MovePod, Rest, Store, WorkFor
from rmfs.control.features import LIMIT
from rmfs.control.legality import why_not
from rmfs.control.problems import Problem
from rmfs.control.questions import Question
from rmfs.errors import InputError
from rmfs.learning.episode import Episodes
from rmfs.world.stations import PickStation

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.control.settings import ControllerSettings
    from rmfs.control.view import View
    from rmfs.layout.model import Layout
    from rmfs.learning.episode import Episode
    from rmfs.learning.rewards import Wanted
    from rmfs.scenario import Scenario
    from rmfs.world.robots import Robot

LARGEST_SEED = 2**31 - 1
SECONDS = 30.0
UNITS = 10.0
ROBOTS = 5.0

_TURN = Question(Problem.TA, "turn")


class RobotsEnv(ParallelEnv[str, Any, np.int64]):
    """Task allocation with robots as agents; controllers decide everything else.

    All robots are agents at all times. A step is a turn of TA: robots that need a task or are at
    rest choose what to do, in order of their numbers; all other robots can only wait. Let S be the
    number of pick and replenishment stations. The actions are:

    - 0: wait
    - 1 to S: work for station 0 to S - 1 (PPS chooses the pod)
    - S + 1: store the pod that the robot carries (PSA chooses the storage location)
    - S + 2: move an idle pod (repositioning chooses the pod)
    - S + 3: rest

    If a robot with a lower number takes the work in the same step, an action can become impossible;
    it then counts as waiting.

    An observation consists of `observation`, shape (3 S + 4,), and `action_mask`, shape (S + 4,).
    The elements of `observation` are, in this order:

    - for each station, the estimated travel time from the robot to the station, divided by 30 s
    - for each station, the amount of work for which no robot is on its way, divided by 10: units
      at pick stations, pods with waiting bundles at replenishment stations
    - for each station, the number of robots working for it, divided by 5
    - 1 if the robot can choose an action, otherwise 0
    - 1 if the robot carries a pod, otherwise 0
    - the share of the run that is left
    - the number of orders in the backlog, divided by 100

    All elements are clipped to the range from -10 to 10. All robots receive the same reward, that
    of the whole warehouse.

    Parameters
    ----------
    layout, scenario, controllers, set, reward
        As for `DecisionEnv`.
    render_mode
        `rgb_array` if `render` is to return pictures; otherwise None.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "render_modes": ["rgb_array"],
        "name": "rmfs_robots_v0",
        "is_parallelizable": True,
    }

    def __init__(
        self,
        layout: str | Path | Layout = "small",
        scenario: str | Path | Scenario = "small",
        controllers: str | Path | ControllerSettings = "default",
        *,
        set: Mapping[str, Any] | None = None,
        reward: Wanted = "units",
        render_mode: str | None = None,
    ) -> None:
        self.episodes = Episodes(
            layout, scenario, controllers, problems=["ta"], reward=reward, set=set
        )
        self.render_mode = render_mode
        plan = self.episodes.layout
        self._stations = len(plan.pick_stations) + len(plan.replenishment_stations)
        self.possible_agents = [f"robot_{number}" for number in range(plan.robots)]
        self.agents: list[str] = []
        self._random = np.random.default_rng()
        self._run: Episode | None = None
        actions = self._stations + 4
        self._observation_space = spaces.Dict(
            {
                "observation": spaces.Box(
                    -LIMIT, LIMIT, (3 * self._stations + 4,), dtype=np.float32
                ),
                "action_mask": spaces.MultiBinary(actions),
            }
        )
        self._action_space = spaces.Discrete(actions)

    @property
    def run(self) -> Episode:
        """The run of the current episode.

        Raises
        ------
        RuntimeError
            If `reset` has not been called yet.
        """
        if self._run is None:
            raise RuntimeError("reset the environment first")
        return self._run

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of observations, which is the same for all robots."""
        return self._observation_space

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """Return the space of actions, which is the same for all robots."""
        return self._action_space

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Start a run; if no seed is given, the environment draws one."""
        if seed is not None:
            self._random = np.random.default_rng(seed)
        else:
            seed = int(self._random.integers(LARGEST_SEED))
        self._run = self.episodes.begin(seed)
        self.agents = list(self.possible_agents)
        self._run.step()
        self._run.reward.take()
        return self._observations(), self._infos(0.0)

    def step(
        self, actions: dict[str, Any]
    ) -> tuple[dict[str, Any], dict[str, float], dict[str, bool], dict[str, bool], dict[str, Any]]:
        """Carry out the actions of the robots, and simulate up to the next turn of TA.

        Robots without an action wait.

        Raises
        ------
        InputError
            If an action is given for an unknown agent.
        """
        run, agents, known = self.run, self.agents, frozenset(self.possible_agents)
        if unknown := [str(agent) for agent in actions if agent not in known]:
            valid = f"{self.possible_agents[0]} to {self.possible_agents[-1]}"
            raise InputError(f"actions: no agent {', '.join(unknown)} (agents: {valid})")
        before_s = run.now_s
        for number, agent in enumerate(self.possible_agents):
            if agent in actions:
                self._act(run.view.robots[number], int(actions[agent]))
        decision = run.decision
        if decision is not None:
            decision.decline()
        ended = run.step() is None
        earned = run.reward.take()
        observations, infos = self._observations(), self._infos(run.now_s - before_s)
        if ended:
            self.agents = []
        return (
            observations,
            dict.fromkeys(agents, earned),
            dict.fromkeys(agents, False),
            dict.fromkeys(agents, ended),
            infos,
        )

    def render(self) -> Any:
        """Return a picture of the warehouse, shape (height, width, 3).

        The result is None if the environment has no `render_mode`.
        """
        if self.render_mode != "rgb_array":
            return None
        from rmfs.learning.rendering import picture

        return picture(self.run)

    def close(self) -> None:
        """Discard the run of the current episode."""
        self._run = None

    # --- inside ---------------------------------------------------------------------------------

    def _act(self, robot: Robot, action: int) -> None:
        decision = self.run.decision
        if decision is None or not self._is_asked(robot):
            return
        answer = self._answer(robot, action)
        if answer is not None and not why_not(answer, _TURN, self.run.view):
            decision.answer(answer)
            self.run.step()  # questions that the answer causes

    def _answer(self, robot: Robot, action: int) -> Any:
        if not 0 < action < self._stations + 4 or not self._mask(robot)[action]:
            return None
        if action <= self._stations:
            return WorkFor(robot, action - 1)
        kinds: list[Any] = [Store(robot), MovePod(robot), Rest(robot, robot.waypoint)]
        return kinds[action - self._stations - 1]

    def _is_asked(self, robot: Robot) -> bool:
        view = self.run.view
        return robot.index in view.asking or robot.index in view.resting

    def _mask(self, robot: Robot) -> NDArray[np.int8]:
        view, stations = self.run.view, self._stations
        mask = np.zeros(stations + 4, np.int8)
        mask[0] = 1
        if self.run.decision is None or not self._is_asked(robot):
            return mask
        for station in range(stations):
            mask[1 + station] = self._can_work(view, robot, station)
        mask[stations + 1] = robot.pod >= 0
        moves = self.run.controller_set[Problem.REPOSITIONING]
        mask[stations + 2] = robot.pod < 0 and not moves.never
        mask[stations + 3] = robot.pod < 0 and robot.index in view.asking
        return mask

    def _can_work(self, view: View, robot: Robot, station: int) -> bool:
        if robot.pod < 0:
            return view.has_open_work(station)
        target = view.stations[station]
        if isinstance(target, PickStation):
            return view.inventory.serves(robot.pod, list(target.requests.lines))
        return bool(view.bundles_waiting[target.number, robot.pod])

    def _observations(self) -> dict[str, Any]:
        view = self.run.view
        stations = view.stations
        places = np.array([station.waypoint for station in stations])
        work = np.array([self._open_work(view, number) for number in range(len(stations))])
        busy = np.array([len(station.tasks) for station in stations])
        rest = [1.0 - view.now_s / view.end_s, len(view.orders) / 100.0]
        found = {}
        for number, agent in enumerate(self.agents):
            robot = view.robots[number]
            away_s = view.travel.estimate_s(robot.waypoint, places)
            asked = self._is_asked(robot)
            vector = np.concatenate(
                [away_s / SECONDS, work / UNITS, busy / ROBOTS, [asked, robot.pod >= 0, *rest]]
            )
            found[agent] = {
                "observation": np.clip(vector, -LIMIT, LIMIT).astype(np.float32),
                "action_mask": self._mask(robot),
            }
        return found

    @staticmethod
    def _open_work(view: View, number: int) -> int:
        station = view.stations[number]
        if isinstance(station, PickStation):
            return station.requests.units
        return len(station.waiting)

    def _infos(self, elapsed_s: float) -> dict[str, Any]:
        run = self.run
        told: dict[str, Any] = {"elapsed_s": elapsed_s, "now_s": run.now_s}
        infos = {agent: dict(told) for agent in self.agents}
        if run.ended and infos:
            infos[self.agents[0]]["footprint"] = run.result().footprint
        return infos
