"""The policy of `rmfs.learning.ppo`: networks in PyTorch that score candidates one by one.

Needs the extra `ppo`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from sb3_contrib.common.maskable.policies import MaskableActorCriticPolicy
from torch import nn

from rmfs.control.features import COLUMNS
from rmfs.control.network import CONSTANT, PREFIX, WHOLE, Layer, Network

if TYPE_CHECKING:
    from collections.abc import Mapping

    from rmfs.learning.observing import Observing

HIDDEN_VALUE = 64
"""Number of units in each of the two hidden layers of the value network."""
NEVER = -1e4
"""Score of declining for networks that always choose a candidate."""


class KindScorer(nn.Module):
    """Scores candidates in questions of one kind, by the formula of `rmfs.control.network.Scorer`.

    Parameters
    ----------
    kind
        The kind of question.
    first
        Network from which training starts. If it has no layers, a hidden layer and an output layer
        are added; at first, their output is 0.
    places
        Indices of the features of this kind among the F features of a candidate in an observation.
    hidden
        Number of units in the hidden layer that is added.
    """

    def __init__(self, kind: str, first: Network, places: list[int], hidden: int) -> None:
        super().__init__()
        self.kind, self.places = kind, places
        names = COLUMNS[kind]
        self.linear = nn.Parameter(torch.tensor([first.linear.get(name, 0.0) for name in names]))
        self.inputs = first.inputs or (*names, *(PREFIX + name for name in WHOLE))
        own = {name: place for place, name in enumerate(names)}
        all_own = len(names)
        wholes = {PREFIX + name: all_own + place for place, name in enumerate(WHOLE)}
        self.columns = [{**own, **wholes}[name] for name in self.inputs]
        sizes = [hidden, 1] if not first.layers else [len(one.biases) for one in first.layers]
        entering = [len(self.inputs), *sizes[:-1]]
        self.layers = nn.ModuleList(nn.Linear(i, o) for i, o in zip(entering, sizes, strict=True))
        with torch.no_grad():
            if first.layers:
                for layer, known in zip(self.layers, first.layers, strict=True):
                    layer.weight.copy_(torch.tensor(known.weights).T)
                    layer.bias.copy_(torch.tensor(known.biases))
            else:
                self.layers[-1].weight.zero_()
                self.layers[-1].bias.zero_()
        declining = first.decline
        self.may_decline = declining is not None
        given = declining or {}
        self.constant = nn.Parameter(torch.tensor(given.get(CONSTANT, 0.0)))
        self.decline = nn.Parameter(torch.tensor([given.get(name, 0.0) for name in WHOLE]))

    def forward(self, whole: torch.Tensor, candidates: torch.Tensor) -> torch.Tensor:
        """Return the scores of k candidates and of declining, for B questions, shape (B, k + 1).

        Parameters
        ----------
        whole
            Features of the warehouse (without those of the question), shape (B, W).
        candidates
            The F features of each candidate, in order of the observation, shape (B, k, F).
        """
        own = candidates[:, :, self.places]
        around = whole[:, None, :].expand(-1, own.shape[1], -1)
        values = torch.cat([own, around], dim=2)[:, :, self.columns]
        for layer in self.layers[:-1]:
            values = torch.relu(layer(values))
        scores = own @ self.linear + self.layers[-1](values)[:, :, 0]
        if self.may_decline:
            declining = self.constant + whole @ self.decline
        else:
            declining = torch.full((len(whole),), NEVER)
        return torch.cat([scores, declining[:, None]], dim=1)

    def network(self, digits: int = 7) -> Network:
        """Return the network learned so far; weights are rounded to `digits` significant digits."""

        def short(values: Any) -> Any:
            if isinstance(values, list):
                return tuple(short(one) for one in values)
            rounded = float(f"{values:.{digits}g}")
            return rounded if abs(rounded) >= 1e-9 else 0.0

        declining = None
        if self.may_decline:
            values = short(self.decline.tolist())
            named = dict(zip(WHOLE, values, strict=True))
            declining = {CONSTANT: short(self.constant.item()), **named}
        return Network(
            linear=dict(zip(COLUMNS[self.kind], short(self.linear.tolist()), strict=True)),
            decline=declining,
            inputs=tuple(self.inputs),
            layers=tuple(
                Layer(weights=short(one.weight.T.tolist()), biases=short(one.bias.tolist()))
                for one in self.layers
            ),
        )


class Scores(nn.Module):
    """Computes scores of actions, and features for the value function, from flat observations.

    Parameters
    ----------
    observing
        Definition of the observations: kinds of question, features, and number k of candidates.
    first
        Networks from which training starts, by kind of question.
    hidden
        Number of units in the hidden layers that are added to networks without layers.
    """

    def __init__(self, observing: Observing, first: Mapping[str, Network], hidden: int) -> None:
        super().__init__()
        self.kinds, self.k = observing.kinds, observing.k
        names = [feature.name for feature in observing.features]
        self.count = len(names)
        self.scorers = nn.ModuleList(
            KindScorer(kind, first[kind], [names.index(n) for n in COLUMNS[kind]], hidden)
            for kind in self.kinds
        )
        entering = len(observing.global_features) + 2 * self.count
        self.value = nn.Sequential(
            nn.Linear(entering, HIDDEN_VALUE),
            nn.Tanh(),
            nn.Linear(HIDDEN_VALUE, HIDDEN_VALUE),
            nn.Tanh(),
        )
        self.latent_dim_pi, self.latent_dim_vf = self.k + 1, HIDDEN_VALUE

    def forward(self, seen: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Return the results of `forward_actor` and `forward_critic` for B observations."""
        return self.forward_actor(seen), self.forward_critic(seen)

    def forward_actor(self, seen: torch.Tensor) -> torch.Tensor:
        """Return the scores of the k + 1 actions for B observations, shape (B, k + 1)."""
        whole, asked, candidates = self._parts(seen)
        which = asked.argmax(dim=1)
        found = torch.empty(len(seen), self.k + 1)
        for number, scorer in enumerate(self.scorers):
            rows = (which == number).nonzero()[:, 0]
            if len(rows):
                found[rows] = scorer(whole[rows], candidates[rows])
        return found

    def forward_critic(self, seen: torch.Tensor) -> torch.Tensor:
        """Return the features from which the value function is computed, shape (B, 64).

        They depend on the warehouse, the question and all candidates.
        """
        whole, asked, candidates = self._parts(seen)
        mean, top = candidates.mean(dim=1), candidates.amax(dim=1)
        found: torch.Tensor = self.value(torch.cat([whole, asked, mean, top], dim=1))
        return found

    def _parts(self, seen: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        wide = len(WHOLE)
        asked = seen[:, wide : wide + len(self.kinds)]
        rest = seen[:, wide + len(self.kinds) :]
        return seen[:, :wide], asked, rest.reshape(len(seen), self.k, self.count)


class ScoringPolicy(MaskableActorCriticPolicy):
    """A policy of sb3-contrib in which `Scores` computes the scores of the actions."""

    def __init__(
        self,
        *given: Any,
        observing: Observing,
        first: Mapping[str, Network],
        hidden: int,
        **more: Any,
    ) -> None:
        self._made = (observing, first, hidden)
        super().__init__(*given, ortho_init=False, **more)

    def _build_mlp_extractor(self) -> None:
        self.mlp_extractor = Scores(*self._made)

    def _build(self, lr_schedule: Any) -> None:
        super()._build(lr_schedule)
        self.action_net = nn.Identity()  # the scores are the logits
        self.optimizer = self.optimizer_class(
            self.parameters(), lr=lr_schedule(1), **self.optimizer_kwargs
        )

    def networks(self) -> dict[str, Network]:
        """Return the networks learned so far, by kind of question."""
        return {one.kind: one.network() for one in self.mlp_extractor.scorers}


def scores(policy: ScoringPolicy, seen: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the scores of the k + 1 actions for B flat observations, shape (B, k + 1)."""
    with torch.no_grad():
        found: np.ndarray[Any, Any] = policy.mlp_extractor.forward_actor(
            torch.as_tensor(seen, dtype=torch.float32)
        ).numpy()
    return found
