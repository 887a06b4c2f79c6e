"""Turnover classes, worked out by hand."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from doubles import Situation, small_layout, small_skus

from rmfs.control.problems import Problem
from rmfs.control.settings import settings
from rmfs.control.trackers.turnover import TurnoverClasses, TurnoverParameters
from rmfs.errors import InputError

HEAD = {"format": "rmfs-controllers/1", "name": "test"}


def classes(situation: Situation, **parameters) -> TurnoverClasses:
    given = TurnoverParameters(**({"place_metric": "euclidean"} | parameters))
    return situation.view.trackers.get(TurnoverClasses, given)


@pytest.fixture
def situation() -> Situation:
    """Ten places at x = 0 ... 9, the pick station at x = 0; pods 0 to 4 at x = 0 to 4.

    Pod 0 has SKU 0, pod 1 SKUs 1 and 2, pod 2 SKU 3, pod 3 nothing, pod 4 SKU 3.
    """
    made = Situation(small_layout(places=10, pods=5))
    made.stock(0, s0=1)
    made.stock(1, s1=1, s2=1)
    made.stock(2, s3=1)
    made.stock(4, s3=9)
    return made


def test_places_by_distance(situation) -> None:
    """Borders at 1, 3 and 10 of ten places."""
    assert classes(situation).place_class.tolist() == [0, 1, 1, 2, 2, 2, 2, 2, 2, 2]


def test_places_by_the_nearest_of_two_stations() -> None:
    """Stations at x = 0 and x = 10; places at 0 ... 9. Nearest: 0, then 1 and 9, and so on."""
    situation = Situation(small_layout(places=10, pods=4, pick_stations=2))
    found = classes(situation, class_borders=(0.3, 1.0)).place_class
    assert found.tolist() == [0, 0, 1, 1, 1, 1, 1, 1, 1, 0]


def test_the_fastest_pods_are_of_the_first_class(situation) -> None:
    """Ordered: 2 of SKU 0, 9 of SKU 1, 1 of SKU 2, 6 of SKU 3.

    Means over the SKUs on pods: 2, (9 + 1) / 2 = 5, 6, 0, 6. Pods 2 and 4 are equally fast, pod 2
    is nearer to the station. In order: 2, 4, 1, 0, 3; two fifths of ten places are four.
    """
    situation.order(s0=2, s1=9, s2=1, s3=6)
    found = classes(situation, class_borders=(0.2, 0.6, 1.0)).pod_class
    assert found.tolist() == [2, 1, 0, 2, 1]


def test_skus_fill_the_classes() -> None:
    """SKUs 0 to 3 take 1, 1, 2 and 4 space units each and were ordered 1, 4, 2 and 1 times.

    Most first: SKU 1 (4/8 + 1/8) / 2 = 5/16; SKU 2 (2/8 + 2/8) / 2 = 4/16; SKU 0 (1/8 + 1/8) / 2
    = 2/16, before SKU 3, (1/8 + 4/8) / 2 = 5/16. Sums before them: 0, 5/16, 9/16, 11/16. The two
    pods of the first class have half of the capacity: SKUs 1 and 2 are of it.
    """
    skus = dataclasses.replace(small_skus(4), space_per_unit=np.array([1.0, 1.0, 2.0, 4.0]))
    situation = Situation(small_layout(places=4, pods=4), skus)
    situation.order(s0=1, s1=4, s2=2, s3=1)
    found = classes(situation, class_borders=(0.5, 1.0))
    assert found.sku_class.tolist() == [1, 0, 0, 1]


def test_without_orders_skus_go_by_space() -> None:
    """Four SKUs of a quarter each (halved: 1/8): sums before them 0, 1/8, 2/8 and 3/8.

    The first class has a quarter of the capacity: SKUs 0 and 1; SKU 2 would begin at its border.
    """
    situation = Situation(small_layout(places=4, pods=4), small_skus(4))
    found = classes(situation, class_borders=(0.25, 1.0))
    assert found.sku_class.tolist() == [0, 0, 1, 1]


class TestAnew:
    def test_never_unless_wished(self, situation) -> None:
        found = classes(situation)
        before = found.pod_class.tolist()
        situation.order(s3=99)
        situation.world.now_s = 1e6
        assert found.pod_class.tolist() == before

    def test_after_a_time(self, situation) -> None:
        """First pod 0 is the fastest; from 100 s on, SKU 3 counts alone: pods 2 and 4."""
        situation.order(s0=50)
        found = classes(situation, class_borders=(0.2, 1.0), reallocation_period_s=100.0)
        situation.order(s3=9)
        situation.world.now_s = 99.0
        assert found.pod_class.tolist() == [0, 1, 1, 1, 1]
        situation.world.now_s = 100.0
        assert found.pod_class.tolist() == [1, 1, 0, 1, 1]
        assert found.sku_class.tolist() == [1, 1, 1, 0, 1]

    def test_after_some_orders(self, situation) -> None:
        situation.order(s0=50)
        found = classes(situation, class_borders=(0.2, 1.0), reallocation_orders=2)
        situation.order(s3=9)
        assert found.pod_class.tolist() == [0, 1, 1, 1, 1]
        situation.order(s3=9)
        assert found.pod_class.tolist() == [1, 1, 0, 1, 1]

    def test_rules_with_the_same_parameters_share_the_classes(self, situation) -> None:
        assert classes(situation) is classes(situation)
        assert classes(situation) is not classes(situation, class_borders=(1.0,))


class TestParameters:
    @pytest.mark.parametrize(
        ("rps", "message"),
        [
            ({"class_borders": [0.3, 0.1, 1.0]}, "must ascend from above 0 to 1"),
            ({"class_borders": [0.5, 0.9]}, "must ascend from above 0 to 1"),
            ({"class_borders": []}, "class_borders"),
            ({"class_borders": [0.5, 1.0]}, "buffer_thresholds must have 2 values"),
            ({"buffer_timeouts_s": [1.0]}, "buffer_timeouts_s must have 3 values"),
        ],
    )
    def test_mistakes_are_named(self, rps, message) -> None:
        with pytest.raises(InputError) as error:
            settings({**HEAD, "rps": {"name": "turnover", **rps}})
        assert message in str(error.value)
        assert "\n" not in str(error.value)

    def test_rules_that_class_pods_must_agree(self) -> None:
        table = {**HEAD, "psa": {"name": "turnover"}, "rps": {"name": "turnover"}}
        assert settings(table).choices[Problem.PSA].name == "turnover"
        table["psa"] = {"name": "turnover", "place_metric": "path"}
        with pytest.raises(InputError, match=r"place_metric.* must be equal"):
            settings(table)


class TestWaitingForEachOther:
    @pytest.mark.parametrize("rps", ["nearest", "reactive"])
    def test_is_refused(self, rps) -> None:
        """Same-pod, the default, waits for the pod; these rules wait for the station."""
        with pytest.raises(InputError) as error:
            settings({**HEAD, "rps": {"name": rps}})
        message = str(error.value)
        assert message.startswith("controllers: ")
        assert "roa same-pod waits for the decision of rps" in message
        assert f"rps {rps} for that of roa" in message
        assert "for roa random; or for rps emptiest" in message
        assert "\n" not in message

    @pytest.mark.parametrize("rps", ["nearest", "reactive"])
    def test_random_stations_do_not_wait(self, rps) -> None:
        settings({**HEAD, "rps": {"name": rps}, "roa": {"name": "random"}})
