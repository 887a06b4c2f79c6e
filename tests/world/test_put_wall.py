"""The put wall by hand: slots kept for totes, and freed together."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from rmfs.world.put_wall import PutWall

A, B = SimpleNamespace(index=0), SimpleNamespace(index=1)


@pytest.mark.parametrize(("per_part", "kept"), [(True, [1, 2, 2]), (False, [1, 1, 1])])
def test_an_order_in_three_totes(per_part, kept):
    """The last to leave needs no slot, even if it is not the last to arrive."""
    wall = PutWall(2, slot_per_part=per_part)
    totes = []
    for number, taken in enumerate(kept):
        assert wall.has_room(0, last=number == 2)
        totes.append(wall.release(A, number, 10.0 * number, last=number == 2))
        assert wall.kept == taken
        wall.verify()
    assert wall.has_room(1, last=True)
    assert wall.has_room(1, last=False) == (not per_part)
    for tote in (totes[2], totes[0]):
        assert not wall.arrive(tote, 50.0)
        wall.verify()
    assert wall.arrive(totes[1], 60.0)
    assert (wall.kept, wall.travelling, totes[0].parcel.consolidated_s) == (0, 0, 60.0)
    wall.verify()
    wall.pack(totes[0].parcel, 70.0)
    assert (wall.parcels, wall.orders_packed) == ({}, 1)


def test_an_order_in_one_tote_needs_no_slot():
    wall = PutWall(1, slot_per_part=True)
    wall.release(A, 0, 0.0, last=False)
    assert not wall.has_room(1, last=False)
    tote = wall.release(B, 0, 1.0, last=True)
    assert not tote.parcel.is_split
    assert wall.arrive(tote, 2.0)
    tote = wall.release(SimpleNamespace(index=2), 0, 3.0, last=True)
    wall.pass_by(tote, 3.0)
    wall.verify()
    assert (wall.kept, wall.travelling, wall.orders_packed) == (
        1,
        1,
        1,
    )  # what is left is the first of A


def test_wrong_counts_are_found():
    wall = PutWall(1, slot_per_part=True)
    wall.release(A, 0, 0.0, last=False)
    wall.kept = 0
    with pytest.raises(AssertionError, match="slots of the put wall"):
        wall.verify()


def test_the_last_tote_has_room_even_if_the_wall_is_overfull() -> None:
    """Totes carried by hand fill the wall beyond its one slot; the last tote needs none."""
    wall = PutWall(1, slot_per_part=False)
    for order in (A, B):
        wall.release(order, 0, 0.0, last=False)
    assert wall.kept == 2
    assert not wall.has_room(2, last=False)
    assert all(wall.has_room(number, last=True) for number in (0, 1, 2))
