"""What goes wrong in a run: as often as asked, always the same, and never at the cost of safety."""

import pytest
from ledger import Ledger

from rmfs import simulate
from rmfs.errors import InputError
from rmfs.layout import load
from rmfs.scenario.parameters.disturbances import Disturbances
from rmfs.simulation.agenda import Agenda
from rmfs.simulation.disturbances import DisturbanceSource
from rmfs.world import verify

EVERYTHING = {
    "breakdowns": {"every_s": 20.0, "lasting_s": 40.0},
    "slow": {"every_s": 20.0, "lasting_s": 60.0, "speed_share": 0.4},
    "closures": {"every_s": 60.0, "lasting_s": 100.0},
}


def disturbed(kinds, *, layout="basic", duration_s=600.0, warmup_s=0.0, observers=()):
    overrides = [
        (["scenario", "duration_s"], duration_s),
        (["scenario", "warmup_s"], warmup_s),
        (["controllers", "psa", "prefer_same_tier"], False),  # robots ride elevators
        *((["scenario", "disturbances", kind], given) for kind, given in kinds.items()),
    ]
    return simulate(
        layout, "pp-minimal", "random", seed=4, trace=True, overrides=overrides, observers=observers
    )


def test_everything_at_once():
    ledger = Ledger()
    run = disturbed(EVERYTHING, observers=[ledger])
    report = run.check()
    assert report.ok, report.summary()
    verify(run.world)
    ledger.check()
    kinds = {one.kind for one in run.disturbances.begun}
    assert kinds == {"breakdown", "slow", "closure"}
    in_time = [one for one in run.disturbances.begun if one.from_us < 600e6]
    assert run.footprint["disturbances"] == len(in_time) > 30
    again = disturbed(EVERYTHING)
    assert again.disturbances.begun == run.disturbances.begun
    assert again.footprint["distance_m"] == run.footprint["distance_m"]


def test_nothing_goes_wrong_unless_asked():
    run = disturbed({}, duration_s=120.0)
    assert run.disturbances.begun == []
    assert run.footprint["disturbances"] == 0
    assert run.footprint["disturbed_s"] == 0


def test_how_often_and_how_long():
    """600 / 20 of 20 to 60 s each are expected; only the measured part of each counts."""
    run = disturbed({"breakdowns": EVERYTHING["breakdowns"]}, duration_s=500.0, warmup_s=100.0)
    begun = run.disturbances.begun
    assert 15 <= len(begun) <= 45
    assert all(20e6 <= one.to_us - one.from_us <= 60e6 for one in begun)
    measured = [min(one.to_us, 600e6) - max(one.from_us, 100e6) for one in begun]
    assert run.footprint["disturbances"] == sum(part > 0 for part in measured)
    assert run.footprint["disturbed_s"] == pytest.approx(
        sum(part for part in measured if part > 0) / 1e6
    )


@pytest.mark.slow
def test_an_elevator_out_of_use_is_not_used():
    """Once the shaft is empty no robot rides in it until it is back."""
    run = disturbed({"elevators_out": [[0, 120.0, 260.0]]}, layout="study-tiers", duration_s=400.0)
    assert run.check().ok
    shaft = set(run.layout.elevators[0].waypoints)
    trace = run.trace
    rides = [
        int(t0)
        for t0, kind, place in zip(trace["t0_us"], trace["kind"], trace["from_wp"], strict=True)
        if kind == 3 and int(place) in shaft
    ]
    assert any(t0 < 120e6 for t0 in rides)
    assert any(t0 > 260e6 for t0 in rides)
    assert not any(160e6 < t0 < 260e6 for t0 in rides)


class Shafts:
    """A fleet that keeps the closed waypoints."""

    def __init__(self):
        self.closed = set()

    def close(self, waypoints):
        self.closed |= set(waypoints)

    def reopen(self, waypoints):
        self.closed -= set(waypoints)


@pytest.mark.parametrize(
    ("outages", "out_s"),
    [
        ([(0, 2.0, 5.0), (0, 5.0, 8.0)], [2, 3, 4, 5, 6, 7]),
        ([(0, 2.0, 6.0), (0, 4.0, 8.0)], [2, 3, 4, 5, 6, 7]),
        ([(0, 2.0, 8.0), (0, 3.0, 4.0)], [2, 3, 4, 5, 6, 7]),
        ([(0, 2.0, 4.0), (1, 3.0, 9.0), (0, 6.0, 8.0)], [2, 3, 6, 7]),
    ],
)
def test_an_elevator_is_out_until_its_last_outage_ends(outages, out_s):
    layout, agenda, fleet = load("study-tiers"), Agenda(), Shafts()
    given = Disturbances(elevators_out=outages)
    source = DisturbanceSource(layout, given, 0, agenda=agenda, fleet=fleet)
    source.begin()
    shaft = set(layout.elevators[0].waypoints)
    found = []
    for second in range(10):
        while agenda.next_us <= second * 1_000_000:
            agenda.now_us = agenda.next_us
            agenda.run_due()
        if shaft <= fleet.closed:
            found.append(second)
        else:
            assert not shaft & fleet.closed
    assert found == out_s
    periods = {(one.element, one.from_us / 1e6, one.to_us / 1e6) for one in source.begun}
    assert periods == set(outages)


def test_what_cannot_be():
    with pytest.raises(InputError, match="there is no elevator 7"):
        disturbed({"elevators_out": [[7, 0.0, 1.0]]}, layout="study-tiers")
    with pytest.raises(InputError, match="must end after it begins"):
        disturbed({"elevators_out": [[0, 5.0, 5.0]]}, layout="study-tiers")
    with pytest.raises(InputError, match=r"disturbances\.slow\.speed_share"):
        disturbed({"slow": {"every_s": 1.0, "lasting_s": 1.0, "speed_share": 1.5}})
    with pytest.raises(InputError, match="did you mean breakdowns"):
        disturbed({"breakdown": {"every_s": 1.0, "lasting_s": 1.0}})
