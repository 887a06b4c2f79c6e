"""Replay: the answers of a recorded run take effect again, at the recorded times."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rmfs.control.asks import Answer
from rmfs.control.solutions import from_text
from rmfs.simulation.agenda import NEVER_US
from rmfs.simulation.pacing.errors import ReplayError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from rmfs.control.asks import Call
    from rmfs.simulation.pacing.settings import ReplayPacing


class Replay:
    """Pacing that gives recorded answers and calls no solver.

    Parameters
    ----------
    settings
        The run to replay.
    answers
        Rows of the table `answers` of that run.
    """

    waits = False

    def __init__(self, settings: ReplayPacing, answers: list[dict[str, Any]]) -> None:
        self._settings = settings
        self._run = settings.run
        self._rows = answers

    def digested(self) -> tuple[str, list[dict[str, Any]]]:
        """Return the settings and the answers, by which checkpoints tell replays apart."""
        return repr(self._settings), self._rows

    def begin(self, modules: Iterable[str], give: Callable[[Call, int], None]) -> None:
        """Store the callback for answers."""
        self._give = give

    def ask(self, call: Call) -> None:
        """Give the recorded answer, if the question was answered in the recorded run.

        Raises
        ------
        ReplayError
            If the recorded run did not ask this question at the same time and in the same state.
        """
        row = self._recorded(call)
        completed_us = int(row["completed_us"])
        call.failure = row["failure"]
        if row["status"]:
            call.answer = Answer(
                solution=from_text(row["solution"]) if row["solution"] else None,
                objective=row["objective"],
                bound=row["bound"],
                status=row["status"],
                backend=row["backend"],
                work=row["work"],
                wall_s=row["wall_s"],
                build_s=row["build_s"],
                built=row["built"],
                scale=row["scale"],
            )
        if completed_us >= 0:
            self._give(call, completed_us)

    def limit_us(self, now_us: int) -> int:
        """Return no limit, as all answers are known."""
        return NEVER_US

    def end(self) -> None:
        """Do nothing, as there are no resources to release."""

    def _recorded(self, call: Call) -> dict[str, Any]:
        at_s = call.requested_us / 1e6
        asked = f"question {call.number} ({call.problem} at {at_s:.6f} s)"
        if call.number >= len(self._rows):
            raise ReplayError(f"{self._run}: does not contain {asked}")
        row = self._rows[call.number]
        there = f"{row['problem']} at {row['requested_us'] / 1e6:.6f} s"
        if (row["problem"], int(row["requested_us"])) != (str(call.problem), call.requested_us):
            raise ReplayError(
                f"{self._run}: {asked} was recorded as {there}: layout, scenario, controllers, "
                "seed or version differ"
            )
        if row["state"] != call.state:
            raise ReplayError(
                f"{self._run}: {asked} was recorded in another state: layout, scenario, "
                "controllers, seed or version differ"
            )
        return row
