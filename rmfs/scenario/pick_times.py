"""Picking times per unit: draws, means, and lower bounds."""

from __future__ import annotations

import csv
import io
from math import inf, isfinite, log, log2, sqrt
from typing import TYPE_CHECKING

import numpy as np

from rmfs.errors import InputError
from rmfs.files import read_bounded
from rmfs.scenario.parameters.pickers import GammaTime, LognormalTime, MeasuredTime

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from rmfs.scenario.parameters.pickers import Learning, Pickers, UnitTime

LONGEST_S = 86400.0
"""Maximum time of a single unit: a day."""


class UnitTimes:
    """Distribution of the picking time of a unit, before the effects of picker and pod.

    Parameters
    ----------
    given
        The table `pickers.unit_time` of a scenario.

    Raises
    ------
    InputError
        If the file of measured times is invalid.
    """

    def __init__(self, given: UnitTime) -> None:
        self._given = given
        self._measured = measured_s(given.file) if isinstance(given, MeasuredTime) else None

    def draw_s(self, station_s: float, rng: np.random.Generator) -> float:
        """Draw the time of a unit, in s.

        Parameters
        ----------
        station_s
            Time per unit that the layout gives for the station, in s. It is the mean of the
            distribution, except if times are measured.
        """
        given = self._given
        if isinstance(given, GammaTime):
            square = given.variation**2
            return float(rng.gamma(1.0 / square, station_s * square))
        if isinstance(given, LognormalTime):
            square = log(1.0 + given.variation**2)
            return station_s * float(rng.lognormal(-0.5 * square, sqrt(square)))
        if self._measured is not None:
            return float(self._measured[int(rng.integers(len(self._measured)))])
        return station_s

    def mean_s(self, station_s: float) -> float:
        """Return the mean of the distribution, in s."""
        return station_s if self._measured is None else float(self._measured.mean())

    def least_s(self, station_s: float) -> float:
        """Return the lower bound of the distribution, in s; 0 if the bound is not positive."""
        if isinstance(self._given, GammaTime | LognormalTime):
            return 0.0
        return station_s if self._measured is None else float(self._measured.min())


def learned(given: Learning | None, units: float) -> float:
    """Return the factor by which learning changes the time of a picker's next unit.

    The factor is the time of the next unit divided by the time of unit number
    `given.standard_units`. By the learning curve, a picker's n-th unit takes the time
    T1 (M + (1 - M) n**-b), where T1 is the time of the first unit, M is `given.incompressible`, and
    b = -log2(`given.rate`). This is the curve of De Jong (1957); with M = 0, it is that of Wright
    (1936).

    Parameters
    ----------
    given
        The table `pickers.learning` of a scenario. If it is None, the factor is 1.
    units
        Number of units that the picker has picked in this run. The next unit therefore has the
        number n = `given.units_before` + `units` + 1.
    """
    if given is None:
        return 1.0
    stays, power = given.incompressible, log2(given.rate)
    at: float = stays + (1.0 - stays) * (given.units_before + units + 1.0) ** power
    standard: float = stays + (1.0 - stays) * given.standard_units**power
    return at / standard


def least_factor(given: Pickers) -> float:
    """Return a lower bound of the factor by which pickers and pods change a unit's drawn time.

    This is the product of the bounds for speeds, layers and learning, or 0 if speeds are drawn.
    Fatigue and errors do not affect the bound, since they only increase the time.
    """
    if given.speed_variation:
        return 0.0
    least = 1.0 / max(given.speeds, default=1.0)
    if given.layers is not None:
        least *= min(given.layers.time_factors)
    # the curve falls: no picker is faster than after more units than a run can have
    return least * learned(given.learning, 1e300)


def measured_s(path: Path) -> NDArray[np.float64]:
    """Return the column `time_s` of a CSV file: picking times in s, shape (n,).

    Raises
    ------
    InputError
        If the file cannot be read, lacks the column, contains no times, or contains an invalid
        time; for an invalid time, the message names the line.
    """
    try:
        text = read_bounded(path).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError(f"{path}: is not UTF-8 text") from None
    reader = csv.reader(io.StringIO(text, newline=""), strict=True)
    times: list[float] = []
    try:
        head = [name.strip() for name in next(reader, [])]
        if head.count("time_s") != 1:
            raise InputError(f"{path}: line 1: must have one column time_s (given: {head!s:.80})")
        place = head.index("time_s")
        for fields in reader:
            if fields:
                given = fields[place] if place < len(fields) else ""
                times.append(_seconds(given, path, reader.line_num))
    except csv.Error as error:
        raise InputError(f"{path}: line {reader.line_num}: {error}") from None
    if not times:
        raise InputError(f"{path}: contains no times")
    made = np.array(times)
    made.setflags(write=False)
    return made


def _seconds(text: str, path: Path, line: int) -> float:
    try:
        value = inf if "_" in text else float(text)
    except ValueError:
        value = inf
    if not isfinite(value) or not 0 < value <= LONGEST_S:
        raise InputError(
            f"{path}: line {line}: time_s must be a number of seconds above 0, to {LONGEST_S:g} "
            f"(given: {text!r:.40})"
        )
    return value
