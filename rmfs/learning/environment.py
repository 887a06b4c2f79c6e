"""`rmfs/Decision-v0`: decision problems of a warehouse as a Gymnasium environment."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import gymnasium
import numpy as np
from gymnasium import spaces

from rmfs.control.features import LIMIT
from rmfs.control.problems import Problem
from rmfs.control.task_candidates import lacks_tasks
from rmfs.errors import InputError
from rmfs.learning.episode import Episodes
from rmfs.learning.observing import Observing, Options
from rmfs.simulation.decision import is_same

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.learning.episode import Episode
    from rmfs.learning.rewards import Wanted
    from rmfs.scenario import Scenario

Observation = dict[str, "NDArray[Any]"]

LARGEST_SEED = 2**31 - 1


class DecisionEnv(gymnasium.Env[Any, np.int64]):
    """An environment in which an episode is a run and a step is one decision of a chosen problem.

    In each step, the agent answers a question, for example which pod to bring to a station. Actions
    0 to k - 1 choose one of the k best candidates (possible answers), in order of their ranking.
    Action k declines, that is, chooses no candidate. With `rule`, action k + 1 gives the answer of
    the problem's controller (the installed rule). A question of POA, ROA, RPS, SA, MM, CA or TA can
    be answered by several decisions, one per step, until the agent declines.

    If only one of the actions 0 to k is possible, the environment carries it out without asking
    the agent. There is one exception: with `rule`, the agent decides even if there are no
    candidates, provided that the rule has an answer. An impossible action sets `info["invalid"]`;
    it counts as action k if declining is possible, and otherwise as action 0.

    An observation is a dictionary of the arrays `global`, shape (G,), `candidates`, shape (k, F),
    and `action_mask`, which has one element per action. If the parameter `observation` is `flat`,
    an observation is one vector: `global` followed by the rows of `candidates`. The attribute
    `observing.global_features` describes the G features in `global`, and `observing.features` the F
    features of each candidate.

    An episode ends with the run. Since the warehouse would continue, the episode is `truncated`,
    not `terminated`; `info["footprint"]` then contains the measures of the run. The time between
    decisions varies: `info["elapsed_s"]` is the simulated time, in s, since the last decision, and
    the reward is the amount accumulated over this time.

    Parameters
    ----------
    layout, scenario, controllers, set
        As for `rmfs.Simulation`. The controllers decide all problems that are not in `problems`.
    problems
        The problems that the agent decides, such as `["ta", "pps"]`.
    candidates
        Maximum number k of candidates offered in a step.
    rankings
        Weights of features for ranking the candidates, by kind of question. For kinds that are not
        given, the weights in `rmfs.control.features.RANKINGS` are used.
    reward
        The name of a reward, weights by name, or a user-defined class (`rmfs.learning.rewards`).
    observation
        Form of the observations: `dict` or `flat`.
    rule
        Whether there is an action k + 1, by which the agent follows the installed rule. A rule
        assumes that all its decisions are carried out; if some are not, its later answers may not
        suit the situation.
    footprint
        Whether to measure runs, so that `info` contains the footprint at the end. Without
        measurement, steps are 5 to 10 % faster.
    render_mode
        `rgb_array` if `render` is to return pictures; otherwise None.

    Raises
    ------
    InputError
        If an argument is invalid; the message names the argument and the valid values.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 4}  # noqa: RUF012

    def __init__(
        self,
        layout: str | Path | Layout = "small",
        scenario: str | Path | Scenario = "small",
        controllers: str | Path | ControllerSettings = "default",
        *,
        problems: Sequence[str] = ("pps",),
        set: Mapping[str, Any] | None = None,
        candidates: int = 8,
        rankings: Mapping[str, Mapping[str, float]] | None = None,
        reward: Wanted = "units",
        observation: Literal["dict", "flat"] = "dict",
        rule: bool = False,
        footprint: bool = True,
        render_mode: str | None = None,
    ) -> None:
        if observation not in ("dict", "flat"):
            raise InputError(f"observation: must be dict or flat (given: {observation})")
        self.observing = Observing(problems, candidates, rankings)
        self.episodes = Episodes(
            layout,
            scenario,
            controllers,
            problems=problems,
            reward=reward,
            set=set,
            measured=footprint,
        )
        self.render_mode = render_mode
        self._flat = observation == "flat"
        self._with_rule = rule
        self._with_footprint = footprint
        self._run: Episode | None = None
        self._options: Options | None = None
        self._advice: tuple[Any] | None = None
        self._may_move = False
        self.decline = candidates
        self.actions = candidates + 1 + rule
        self.action_space = spaces.Discrete(self.actions)
        self.observation_space = self._space()

    @property
    def run(self) -> Episode:
        """The run of the current episode.

        Raises
        ------
        RuntimeError
            If `reset` has not been called yet.
        """
        if self._run is None:
            raise RuntimeError("no episode has begun: call reset first")
        return self._run

    @property
    def options(self) -> Options | None:
        """The current question with its best candidates; None if there is no question."""
        return self._options

    def action_masks(self) -> NDArray[np.bool_]:
        """Return whether each action is possible, shape (actions,); called by MaskablePPO."""
        if self._options is None:
            mask = np.zeros(self.actions, np.bool_)
            mask[self.decline] = True
            return mask
        possible = self._options.mask
        return np.append(possible, True) if self._with_rule else possible.copy()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Start a run; if no seed is given, the environment draws one."""
        super().reset(seed=seed)
        if seed is None:
            seed = int(self.np_random.integers(LARGEST_SEED))
        self._run = self.episodes.begin(seed)
        moves = self._run.controller_set[Problem.REPOSITIONING]
        outside = self._run.phase.outside
        self._may_move = not moves.never or "repositioning" in outside.problems
        # the rule could choose something that is not among the candidates
        outside.is_idle = None if self._may_move or self._with_rule else lacks_tasks
        begun_s = self._run.now_s
        self._go_on()
        self._run.reward.take()
        mask = self.action_masks()
        return self._observation(mask), self._info(begun_s, mask)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Carry out an action, and simulate up to the next decision."""
        run, options = self.run, self._options
        if options is None:
            raise RuntimeError("the episode has ended: call reset")
        before_s = run.now_s
        invalid = not self._take(options, int(action))
        self._go_on()
        mask = self.action_masks()
        info = self._info(before_s, mask)
        if invalid:
            info["invalid"] = True
        return self._observation(mask), run.reward.take(), False, self._options is None, info

    def render(self) -> Any:
        """Return a picture of the warehouse, shape (height, width, 3).

        The result is None if the environment has no `render_mode`.
        """
        if self.render_mode != "rgb_array":
            return None
        from rmfs.learning.rendering import picture

        return picture(self.run)

    def advised(self) -> int:
        """Return the action that agrees with the installed rule; requires `rule`.

        This action chooses a candidate if the rule's answer is among the candidates offered. It is
        action k if the rule declines, and action k + 1 in all other cases.
        """
        options = self._options
        if options is None or not self._with_rule:
            raise RuntimeError(
                "advised() needs the installed rule and an open question: create the environment "
                "with rule=True, and call it before the episode ends"
            )
        advice = self._advised(options)
        if advice is None:
            return self.decline
        for action, row in enumerate(options.rows):
            if is_same(options.decision.candidates[int(row)], advice):
                return action
        return self.decline + 1

    # --- inside ---------------------------------------------------------------------------------

    def _space(self) -> spaces.Space[Any]:
        observing = self.observing
        count, features = observing.k, len(observing.features)
        whole = len(observing.global_features)
        if self._flat:
            return spaces.Box(-LIMIT, LIMIT, (whole + count * features,), np.float32)
        return spaces.Dict(
            {
                "global": spaces.Box(-LIMIT, LIMIT, (whole,), np.float32),
                "candidates": spaces.Box(-LIMIT, LIMIT, (count, features), np.float32),
                "action_mask": spaces.MultiBinary(self.actions),
            }
        )

    def _go_on(self) -> None:
        """Simulate to the next question with more than one possible action."""
        run, observing, may_move = self.run, self.observing, self._may_move
        while (decision := run.step()) is not None:
            self._advice = None
            options = observing.options(decision, may_move=may_move)
            if not options.is_forced:
                break
            if self._with_rule and not len(options.rows):
                # the rule may choose something that is not among the candidates
                self._advice = (decision.advice(),)
                if self._advice[0] is not None:
                    break
            self._apply(options, None if options.mask[self.decline] else options.rows[0])
        else:
            self._options = None
            return
        self._options = options

    def _take(self, options: Options, action: int) -> bool:
        """Carry out an action; return False if it is impossible."""
        if action == self.decline + 1 and self._with_rule:
            advice = self._advised(options)
            if advice is None:
                options.decision.decline()
            else:
                options.decision.answer(advice)
            return True
        possible = 0 <= action <= self.decline and bool(options.mask[action])
        if possible and action < self.decline:
            self._apply(options, options.rows[action])
        elif options.mask[self.decline]:
            self._apply(options, None)
        else:
            self._apply(options, options.rows[0])
        return possible

    def _apply(self, options: Options, row: np.intp | None) -> None:
        decision = options.decision
        if row is None:
            decision.decline()
        else:
            decision.choose(int(row))

    def _advised(self, options: Options) -> Any:
        if self._advice is None:
            self._advice = (options.decision.advice(),)
        return self._advice[0]

    def _observation(self, mask: NDArray[np.bool_]) -> Any:
        observing, options = self.observing, self._options
        decision = None if options is None else options.decision
        whole = observing.globals_of(self.run.view, decision)
        if options is None:
            found = np.zeros((observing.k, len(observing.features)), np.float32)
        else:
            found = options.features if len(options.rows) else options.features.copy()
        if self._flat:
            return np.concatenate([whole, found.ravel()])
        return {
            "global": whole,
            "candidates": found,
            "action_mask": mask.view(np.int8).copy(),
        }

    def _info(self, since_s: float, mask: NDArray[np.bool_]) -> dict[str, Any]:
        run, options = self._run, self._options
        assert run is not None
        info: dict[str, Any] = {
            "action_mask": mask,
            "elapsed_s": run.now_s - since_s,
            "now_s": run.now_s,
        }
        if options is not None:
            info["problem"] = str(options.decision.problem)
            info["kind"] = options.kind
        elif self._with_footprint:
            info["footprint"] = run.result().footprint
        return info
