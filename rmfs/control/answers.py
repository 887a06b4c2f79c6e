"""A table of the possible answers to a question: one row per answer, one column per attribute."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    import pandas as pd
    from numpy.typing import NDArray

    Columns = dict[str, NDArray[Any]]


class Candidates:
    """A table of the C possible answers to a question: a row per answer, a column per attribute.

    The question is one that a program outside the simulation can answer in place of a controller
    (`rmfs.control.questions`). `candidates[row]` is the answer of that row, to be passed to
    `rmfs.simulation.decision.Decision.answer`.

    Parameters
    ----------
    columns
        Arrays of shape (C,) by name.
    answer
        Function that returns the answer of a row.
    """

    def __init__(self, columns: Columns, answer: Callable[[int], Any]) -> None:
        self._columns = columns
        self._answer = answer

    @property
    def columns(self) -> Columns:
        """Arrays of shape (C,) by name; `MEANINGS` gives their units and meanings."""
        return self._columns

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, row: int) -> Any:
        count = len(self)
        if not -count <= row < count:
            raise IndexError(f"there are {count} candidates, no row {row}")
        return self._answer(row % count)

    def __iter__(self) -> Iterator[Any]:
        return (self._answer(row) for row in range(len(self)))

    def frame(self) -> pd.DataFrame:
        """Return the columns as a data frame."""
        import pandas as pd

        return pd.DataFrame(self.columns)


class Meaning(NamedTuple):
    """Unit and meaning of a column of `Candidates`."""

    unit: str
    text: str


MEANINGS = {
    "order": Meaning("", "ordinal of arrival of a pick order"),
    "bundle": Meaning("", "ordinal of arrival of a bundle"),
    "station": Meaning("", "number of a station, pick stations first"),
    "robot": Meaning("", "number of a robot"),
    "pod": Meaning("", "number of a pod"),
    "place": Meaning("", "waypoint of a storage location"),
    "lines": Meaning("lines", "lines of the order"),
    "units": Meaning(
        "units",
        "units that the order or station needs, or that the pod can serve; for a replenishment "
        "station, the number of pods for which bundles wait there",
    ),
    "inbound_units": Meaning(
        "units", "units of the order that are spare on pods at the station or on their way there"
    ),
    "in_stock": Meaning("", "1 if stock can serve the whole order, 0 if not"),
    "age_s": Meaning("s", "time since arrival"),
    "due_in_s": Meaning("s", "time until the due time, negative if late"),
    "free_slots": Meaning("orders", "free slots of the station"),
    "orders": Meaning("orders", "orders that the pod completes"),
    "bundles": Meaning("bundles", "bundles that wait for the pod, or that the station has"),
    "space": Meaning("space units", "space the bundle takes"),
    "free_space": Meaning("space units", "room left on the pod, or at the station"),
    "reach_s": Meaning("s", "estimated travel time from the robot to the pod"),
    "bring_s": Meaning("s", "unhindered travel time from the pod to the station"),
    "away_s": Meaning(
        "s",
        "unhindered time from the robot to the place or station; in decisions of TA, an estimate",
    ),
    "back_s": Meaning("s", "unhindered time from the place to the nearest active pick station"),
    "distance_m": Meaning("m", "straight distance from the pod to the place"),
    "robots": Meaning("robots", "robots working for the station or on their way there"),
    "level_share": Meaning("share", "charge of the robot's battery, as a share of its capacity"),
    "active": Meaning("", "1 if the station takes new work, 0 if not"),
    "pick": Meaning("", "1 if the station is a pick station, 0 if not"),
    "kind": Meaning(
        "", "kind of task: 0 work for a station, 1 store the pod, 2 move an idle pod, 3 rest"
    ),
}
"""Units and meanings of the columns of `Candidates`, by name."""
