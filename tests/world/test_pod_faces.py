"""Faces of pods: where bundles go, which face is turned, and that no unit is lost."""

from __future__ import annotations

import numpy as np
import pytest

from rmfs.errors import InputError
from rmfs.scenario import load
from rmfs.scenario.parameters.pickers import Faces
from rmfs.world.pod_faces import PodFaces


def pods(count=2, space=(2.0, 3.0, 5.0), capacity=20.0) -> PodFaces:
    return PodFaces(Faces(count=count), np.array(space), np.array([capacity, 4.0]))


def test_a_bundle_goes_to_the_face_with_most_room():
    made = pods()
    made.put(0, 0, 3)
    made.put(0, 1, 2)
    assert made.used[0].tolist() == [6.0, 6.0]
    made.put(0, 0, 3)  # two fit on the first face, which has as much room as the other
    assert made.used[0].tolist() == [10.0, 8.0]


def test_what_fits_on_no_face_is_stored_all_the_same():
    made = pods()
    made.put(1, 2, 1)  # 5 of space, where each face has 2
    assert made.units(1, 2) == 1
    assert made.take(1, 2, -1) == 0


def test_the_face_that_is_shown_comes_first_then_the_one_with_most():
    made = pods()
    made.put(0, 0, 5)  # fills face 0
    made.put(0, 0, 3)
    assert made.take(0, 0, 1) == 1
    assert made.take(0, 0, -1) == 0  # four there, two on the other
    assert [made.take(0, 0, 1) for _ in range(3)] == [1, 1, 0]
    assert made.has(0, 0, 0)
    assert not made.has(0, 0, 1)
    assert not made.has(0, 1, 0)


def test_no_unit_is_lost():
    rng = np.random.default_rng(3)
    made, held, space = pods(count=3), np.zeros(3, int), np.array([2.0, 3.0, 5.0])
    for _ in range(2000):
        sku, units = int(rng.integers(3)), int(rng.integers(1, 4))
        if rng.random() < 0.5 and held @ space + units * space[sku] <= 20.0:
            made.put(0, sku, units)
            held[sku] += units
        elif held[sku]:
            made.take(0, sku, int(rng.integers(-1, 3)))
            held[sku] -= 1
        assert [made.units(0, one) for one in range(3)] == held.tolist()
        assert made.used[0].sum() == held @ space


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"faces": {}, "layers": {}}, "must be left out where pods have layers"),
        ({"faces": {"count": 0}}, "count"),
        ({"faces": {"turn_face_s": -1.0}}, "turn_face_s"),
    ],
)
def test_what_cannot_be_is_refused(given, told):
    with pytest.raises(InputError) as refused:
        load("small", [(["pickers"], given)])
    assert told in str(refused.value)
