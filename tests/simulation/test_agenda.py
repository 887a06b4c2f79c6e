"""The order in which the agenda calls."""

from __future__ import annotations

from functools import partial

import pytest

from rmfs.simulation.agenda import NEVER_US, Agenda


@pytest.fixture
def called() -> list[str]:
    return []


def test_by_time_then_priority_then_order_of_entry(called) -> None:
    agenda = Agenda()
    for name, time, priority in [("d", 2, 0), ("b", 1, 1), ("a", 1, 0), ("c", 1, 1)]:
        agenda.at(time, partial(called.append, name), priority)
    assert agenda.next_us == 1
    agenda.now_us = 1
    agenda.run_due()
    assert called == ["a", "b", "c"]
    assert agenda.next_us == 2
    agenda.now_us = 5
    agenda.run_due()
    assert called == ["a", "b", "c", "d"]
    assert agenda.next_us == NEVER_US


def test_what_callbacks_enter_for_the_same_time_is_called_as_well(called) -> None:
    agenda = Agenda()
    agenda.at(1, lambda: agenda.at(1, partial(called.append, "second")))
    agenda.now_us = 1
    agenda.run_due()
    assert called == ["second"]


def test_cancelled_entries_are_not_called_and_not_next(called) -> None:
    agenda = Agenda()
    first = agenda.at(1, partial(called.append, "first"))
    second = agenda.at(3, partial(called.append, "second"))
    agenda.at(4, partial(called.append, "third"))
    agenda.cancel(first)
    assert agenda.next_us == 3
    agenda.cancel(second)
    assert len(agenda) == 1
    agenda.now_us = 9
    agenda.run_due()
    assert called == ["third"]
    assert len(agenda) == 0
