"""Episodes for learning: simulations with a reward, created quickly one after another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs import layout as layouts
from rmfs.learning.rewards import Reward, observers_of, reward_of
from rmfs.simulation.inputs import as_overrides, load_inputs, name_of
from rmfs.simulation.run import Simulation

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from rmfs.control.settings import ControllerSettings
    from rmfs.layout.model import Layout
    from rmfs.learning.rewards import Wanted
    from rmfs.scenario import Scenario


class Episode(Simulation):
    """A simulation with a reward that observes it; copying a simulation copies its reward, too.

    Parameters
    ----------
    reward
        The reward, which is added to the observers of the simulation.
    arguments, named
        Other arguments, as for `rmfs.Simulation`.
    """

    checks_layout = False
    """False, because `Episodes` checks the layout once for all runs."""

    def __init__(self, *arguments: Any, reward: Reward, **named: Any) -> None:
        self.reward = reward
        super().__init__(*arguments, observers=observers_of(reward), **named)


class Episodes:
    """Creates episodes of one warehouse; files are read and the layout is checked only once.

    When a seed is used for the second time, the run is stored in its state before the first event.
    This episode and later episodes with the same seed are copies of the stored run.

    Parameters
    ----------
    layout, scenario, controllers, set
        As for `rmfs.Simulation`.
    problems
        Decision problems that the learner decides instead of the controllers.
    reward
        The reward, as for `rmfs.learning.rewards.reward_of`.
    measured
        Whether runs are measured. Runs that are not measured have no result.
    """

    KEPT = 8
    """Maximum number of runs that are stored to be copied."""

    def __init__(
        self,
        layout: str | Path | Layout,
        scenario: str | Path | Scenario,
        controllers: str | Path | ControllerSettings,
        *,
        problems: Sequence[str],
        reward: Wanted,
        set: Mapping[str, Any] | None = None,
        measured: bool = True,
    ) -> None:
        inputs = load_inputs(layout, scenario, controllers, as_overrides(set or {}))
        self._names = name_of(layout), name_of(scenario), name_of(controllers)
        layouts.refuse(inputs.layout, self._names[0], allow_not_well_formed=False)
        self.layout = inputs.layout
        self._inputs = inputs
        self._problems = tuple(problems)
        self._reward = reward
        self._measured = measured
        self._known: dict[int, bool] = {}
        self._kept: dict[int, Episode] = {}
        reward_of(reward)  # reports errors early

    def begin(self, seed: int) -> Episode:
        """Return a new run with the given seed, in its state before the first event."""
        if seed in self._kept:
            return self._kept[seed].fork()
        episode = self._made(seed)
        if seed not in self._known:
            self._known[seed] = (
                True  # most seeds are used once, and keeping a run takes as long as creating it
            )
            return episode
        if len(self._kept) == self.KEPT:
            del self._kept[next(iter(self._kept))]
        self._kept[seed] = episode
        return episode.fork()

    def _made(self, seed: int) -> Episode:
        inputs = self._inputs
        episode = Episode(
            inputs.layout,
            inputs.scenario,
            inputs.controllers,
            seed=seed,
            outside=self._problems,
            reward=reward_of(self._reward),
            measured=self._measured,
        )
        episode.names, episode.inputs = self._names, inputs
        return episode
