"""Times in a file: seconds from time zero, or date and time in ISO 8601."""

from __future__ import annotations

import math
from datetime import datetime, timedelta

from rmfs.scenario.clock import nearest_us

LATEST_S = 1e9
"""Latest time in a file, in s: thirty years."""

EXAMPLE = "2026-03-01T08:00:00"

_US = timedelta(microseconds=1)


class FieldError(ValueError):
    """An invalid field; the message states the column, the reason, and what would be valid."""


class Times:
    """Reads the times in a file, which must all be in seconds or all in ISO 8601.

    Parameters
    ----------
    zero
        Date and time at which simulated time is 0. Default: midnight at the beginning of the day
        of the first time read. If `zero` has no time zone, it is assumed to be in the zone of the
        first time that has one.
    """

    def __init__(self, zero: datetime | None = None) -> None:
        self._zero = zero
        self._moments: bool | None = None

    def us(self, column: str, text: str) -> int:
        """Return the time in a field, in microseconds from time zero.

        Raises
        ------
        FieldError
            If the field does not contain a time, or the time is out of bounds or in another format
            than earlier times.
        """
        moment = self._moment(column, text)
        if moment is not None:
            return self._since_zero(column, moment, text)
        time_s = number(column, text)
        if not 0 <= time_s <= LATEST_S:
            raise FieldError(f"{column} must be from 0 to {LATEST_S:g} s (given: {text:.40})")
        return nearest_us(time_s)

    def _moment(self, column: str, text: str) -> datetime | None:
        """Return the date and time in a field, or None if the field contains a number."""
        plain = is_number(text)
        moment = None if plain else parsed(text)
        if moment is None and not plain:
            given = f"(given: {text!r:.40})" if text else "(empty)"
            raise FieldError(f"{column} must be a number of s, or a time such as {EXAMPLE} {given}")
        if self._moments is None:
            self._moments = moment is not None
        elif self._moments != (moment is not None):
            kind = f"a time such as {EXAMPLE}" if self._moments else "a number of s"
            raise FieldError(f"{column} must be {kind}, as in earlier lines (given: {text!r:.40})")
        return moment

    def _since_zero(self, column: str, moment: datetime, text: str) -> int:
        if self._zero is None:
            self._zero = midnight(moment)
        elif self._zero.tzinfo is None and moment.tzinfo is not None:
            self._zero = self._zero.replace(tzinfo=moment.tzinfo)
        if moment.tzinfo is None and self._zero.tzinfo is not None:
            zone = self._zero.isoformat()
            raise FieldError(f"{column} must have a time zone, as {zone} has (given: {text:.40})")
        time_us = (moment - self._zero) // _US
        if not 0 <= time_us <= LATEST_S * 1e6:
            zero = self._zero.isoformat()
            raise FieldError(
                f"{column} must be from {zero}, which is time zero (scenario.start), to "
                f"{LATEST_S:g} s later (given: {text:.40})"
            )
        return time_us


def parsed(text: str) -> datetime | None:
    """Return the date and time given by a text in ISO 8601; None if the text is invalid."""
    try:
        return datetime.fromisoformat(text)
    except ValueError:
        return None


def midnight(moment: datetime) -> datetime:
    """Return the beginning (0:00) of the day of a given time, in the same time zone."""
    return moment.replace(hour=0, minute=0, second=0, microsecond=0)


def number(column: str, text: str) -> float:
    """Return the finite number in a field.

    Raises
    ------
    FieldError
        If the field does not contain a finite number.
    """
    found = float(text) if is_number(text) else math.nan
    if math.isfinite(found):
        return found
    given = f"(given: {text!r:.40})" if text else "(empty)"
    raise FieldError(f"{column} must be a number {given}")


def is_number(text: str) -> bool:
    """Return whether a field contains a number; nan and inf count as numbers."""
    try:
        float(text)
    except ValueError:
        return False
    return "_" not in text
