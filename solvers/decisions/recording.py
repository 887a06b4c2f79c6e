"""Recording of the questions that optimisers are asked during a run, one file per question."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, Any

from rmfs.measure.provenance import commit, version
from rmfs.observer import Observer
from rmfs.solvers.decisions.asking import found_of, question_of
from rmfs.solvers.decisions.files import Decision, write

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from rmfs.control.asks import Call


class QuestionListener(Observer):
    """Converts each question asked during a run, together with its answer, to a `Decision`.

    Parameters
    ----------
    run
        Description of the run: layout, scenario, controllers, seed, ...

    Attributes
    ----------
    strange
        Number of questions skipped because they belong to no known family, such as those of users'
        own optimisers.
    """

    def __init__(self, run: Mapping[str, Any]) -> None:
        self._run = {"rmfs": {"version": version(), **commit()}, **run}
        self._open: dict[int, Call] = {}
        self.strange = 0

    @abstractmethod
    def take(self, decision: Decision) -> None:
        """Process a converted question; called once for each question of a known family."""

    def optimiser_asked(self, call: Call) -> None:
        """Remember the question until its answer arrives."""
        self._open[call.number] = call

    def optimiser_answered(self, call: Call) -> None:
        """Convert the question with its answer, and pass it to `take`."""
        self._open.pop(call.number, None)
        self._told(call)

    def run_ended(self, time_s: float) -> None:
        """Convert the questions that are still unanswered, and pass them to `take`."""
        for call in self._open.values():
            self._told(call)
        self._open.clear()

    def _told(self, call: Call) -> None:
        question = question_of(call.ask.question)
        if question is None:
            self.strange += 1
            return
        told = {
            "number": call.number,
            "time_s": call.requested_us / 1e6,
            "problem": str(call.problem),
            "controller": type(call.controller).__name__,
            "state": call.state,
            "outcome": str(call.outcome),
            "applied": call.applied,
            "stale": call.stale,
        }
        recorded = None
        if call.answer is not None:  # it may be known before it takes effect
            recorded = found_of(question.family, call.answer)
        self.take(
            Decision(
                question.family, question.data, {**self._run, **told}, question.asked, recorded
            )
        )


class DecisionRecorder(QuestionListener):
    """Writes each question of a run, with its answer, to a file.

    Parameters
    ----------
    folder
        Folder for the files; created if it does not exist.
    run
        As for `QuestionListener`.

    Attributes
    ----------
    written
        Number of files written; questions whose files already existed do not count.
    """

    def __init__(self, folder: Path, run: Mapping[str, Any]) -> None:
        super().__init__(run)
        self._folder = folder
        self.written = 0

    def take(self, decision: Decision) -> None:
        """Write a question to a file."""
        self.written += write(decision, self._folder)

    def summary(self) -> str:
        """Return one line that states how many questions were written and how many left out."""
        told = f"{self.written} questions written to {self._folder}"
        return f"{told}; {self.strange} of other families left out" if self.strange else told
