"""Pickers in whole runs: what the tables say, recomputed; and what changes nothing."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

import rmfs
from rmfs.errors import InputError
from rmfs.measure.dictionary import reproducible
from rmfs.measure.measures.pickers import Pickers
from rmfs.world import verify
from rmfs.world.pickers import after_rest, after_work

OWN = {column.name for column in Pickers.columns}
EMPTY = {"units_per_h_at_pile_on"}
FULL = {
    "unit_time": {"distribution": "lognormal", "variation": 0.4},
    "speed_variation": 0.15,
    "learning": {"rate": 0.9, "incompressible": 0.5, "units_before": 500, "standard_units": 500},
    "fatigue": {"per_h": 1.5, "recovery_per_h": 3.0, "slowdown": 0.5, "waiting_rests": 0.5},
    "layers": {},
    "errors": {"share": 0.05, "at_full_fatigue": 0.3, "noticed_share": 0.6, "rework_s": 20.0},
    "roster": {"cycle_s": 1200, "shifts_s": [[0, 700], [700, 1100]], "breaks_s": [[300, 400]]},
}
COLUMNS = [name for name in reproducible("footprint") if name not in OWN | EMPTY]


def keys(pickers, duration_s=1500, **more):
    given = {"scenario.duration_s": duration_s, "scenario.warmup_s": 300, **more}
    return given if pickers is None else given | {"scenario.pickers": pickers}


def simulate(pickers, seed=1, duration_s=1500, **more):
    return rmfs.simulate(
        "small", "small", "default", seed=seed, set=keys(pickers, duration_s, **more)
    )


@pytest.fixture(scope="module")
def full():
    return simulate(FULL)


def test_pickers_who_are_all_alike_change_nothing():
    """Footprint and motion, bit for bit; also if layers make no difference."""
    runs = [
        rmfs.simulate("small", "small", "default", seed=1, set=keys(given), trace=True)
        for given in (
            None,
            {},
            {"layers": {"time_factors": [1.0, 1.0]}, "speeds": [1.0]},
            {"faces": {"count": 1}},
        )
    ]
    without = runs[0]
    for run in runs[1:]:
        assert run.footprint[COLUMNS].equals(without.footprint[COLUMNS])
        for name, values in without.trace.items():
            assert np.array_equal(values, run.trace[name])
        assert run.footprint["pickers_mean"] == 2
        assert run.footprint["pick_time_mean_s"] == 10
    assert without.footprint[list(OWN)].isna().all()


def test_tables_agree(full):
    verify(full.world)
    picks, people, footprint = full.table("picks"), full.table("pickers"), full.footprint
    assert len(picks) == footprint["units_picked"] == people["units_picked"].sum() > 100
    assert len(people) == 4
    for row in people.itertuples():
        own = picks[picks["picker"] == row.picker]
        assert set(own["station"]) == {row.station}
        assert row.unit_mean_s == pytest.approx(own["handling_s"].mean())
        assert row.fatigue_max == own["fatigue"].max()
        assert row.errors == own["error"].sum()
        # units that lie wholly in the measured time
        ends = own["time_s"] + own["handling_s"]
        inside = own["handling_s"][ends <= 1800].sum()
        assert inside - 1e-6 <= row.work_s <= inside + 120
    assert footprint["picker_work_variation"] == pytest.approx(
        people["busy_share"].std(ddof=0) / people["busy_share"].mean()
    )
    assert footprint["pick_errors"] > footprint["pick_errors_unnoticed"] > 0
    assert (picks["layer"] >= 0).all()
    assert not (picks["noticed"] & ~picks["error"]).any()


def test_units_follow_each_other(full):
    """No picker begins before the last unit is done, and the station says the same."""
    picks = full.table("picks")
    for _, own in picks.groupby("station"):
        ends = own["time_s"].to_numpy() + own["handling_s"].to_numpy()
        assert (own["time_s"].to_numpy()[1:] >= ends[:-1] - 2e-6).all()
    busy = full.table("stations")["busy_s"].iloc[:2].sum()
    assert busy == pytest.approx(full.table("pickers")["work_s"].sum(), abs=1e-3)


def test_nobody_picks_in_a_break_or_in_another_shift(full):
    picks, people = full.table("picks"), full.table("pickers").set_index("picker")
    clock = picks["time_s"] % 1200
    shift = people["shift"].loc[picks["picker"]].to_numpy()
    assert not ((clock >= 300) & (clock < 400)).any()
    assert (clock < 1100).all()
    assert np.array_equal(shift, np.where(clock < 700, 0, 1))
    # measured from 300 to 1800: of shift 0 [400, 700) and [1200, 1500) and [1600, 1800)
    assert people["present_s"].to_numpy() == pytest.approx([800, 800, 400, 400], abs=90)


def test_presence_counts_once_if_a_unit_lasts_longer_than_a_break():
    roster = {"cycle_s": 100, "shifts_s": [[0, 100]], "breaks_s": [[50, 51]]}
    run = simulate({"speeds": [0.2], "roster": roster}, duration_s=1150)
    people = run.table("pickers")
    assert (people["present_s"] <= 1150 + 1e-6).all()
    assert (people["work_s"] <= people["present_s"] + 1e-6).all()
    assert run.footprint["pickers_mean"] <= len(people)


def test_robots_wait_out_a_night():
    """Nobody is there for hours, pods queue, and work goes on in the morning."""
    roster = {"cycle_s": 12000, "shifts_s": [[600, 1200]]}
    more = {"scenario.warmup_s": 0, "layout.robots": 2}
    run = simulate({"roster": roster}, duration_s=13500, **more)
    clock = run.table("picks")["time_s"] % 12000
    assert ((clock >= 600) & (clock < 1200)).all()
    assert (run.table("picks")["time_s"] > 12600).any()
    verify(run.world)


def test_fatigue_is_that_of_the_equations():
    """By the recursion over all units, from when they began and how long they took."""
    given = {"fatigue": {"per_h": 2.0, "recovery_per_h": 4.0, "slowdown": 0.8, "waiting_rests": 1}}
    run = simulate(given, **{"scenario.warmup_s": 0, "layout.robots": 4})
    picks = run.table("picks")
    for _, own in picks.groupby("picker"):
        fatigue, until_s = 0.0, 0.0
        for time_s, took_s, told in zip(
            own["time_s"], own["handling_s"], own["fatigue"], strict=True
        ):
            fatigue = after_rest(fatigue, 4.0, time_s - until_s)
            assert told == pytest.approx(fatigue, abs=1e-6)
            assert took_s == pytest.approx(10.0 * (1 + 0.8 * fatigue), abs=1e-5)
            fatigue = after_work(fatigue, 2.0, took_s)
            until_s = time_s + took_s
        assert 0.05 < own["fatigue"].max() < 1


@pytest.mark.parametrize(("name", "variation"), [("gamma", 0.5), ("lognormal", 0.8)])
def test_a_fit_to_the_table_recovers_the_distribution(name, variation):
    """Parameters within the intervals of the fit, and the fitted distribution is not refused."""
    given = {"unit_time": {"distribution": name, "variation": variation}}
    times = simulate(given, duration_s=4500).table("picks")["handling_s"].to_numpy()
    assert len(times) > 500
    if name == "gamma":
        shape, _, scale = stats.gamma.fit(times, floc=0)
        found, mean = shape**-0.5, shape * scale
        expected = stats.gamma(variation**-2, scale=10.0 * variation**2)
    else:
        logs = np.log(times)
        found, mean = np.sqrt(np.expm1(logs.var())), np.exp(logs.mean() + logs.var() / 2)
        sigma = np.sqrt(np.log(1 + variation**2))
        expected = stats.lognorm(sigma, scale=10.0 * np.exp(-(sigma**2) / 2))
    # both have 99.9 % intervals of about 3.3 sd, by the sampling error of fits
    assert found == pytest.approx(variation, abs=3.3 * 1.5 * variation / np.sqrt(2 * len(times)))
    assert mean == pytest.approx(10.0, abs=3.3 * 10.0 * variation / np.sqrt(len(times)))
    assert stats.kstest(times, expected.cdf).pvalue > 0.001


def test_errors_are_as_frequent_as_said():
    given = {"errors": {"share": 0.1, "noticed_share": 0.5, "rework_s": 7.0}}
    picks = simulate(given, duration_s=3600).table("picks")
    assert stats.binomtest(int(picks["error"].sum()), len(picks), 0.1).pvalue > 0.001
    wrong = picks[picks["error"]]
    assert stats.binomtest(int(wrong["noticed"].sum()), len(wrong), 0.5).pvalue > 0.001
    assert picks["handling_s"].to_numpy() == pytest.approx(np.where(picks["noticed"], 17.0, 10.0))


def test_layers_take_their_times():
    picks = simulate({"layers": {"time_factors": [1.5, 0.5, 1.0]}}).table("picks")
    factors = np.array([1.5, 0.5, 1.0])[picks["layer"]]
    assert picks["handling_s"].to_numpy() == pytest.approx(10.0 * factors)
    assert len(set(picks["layer"])) == 3


def test_every_unit_in_layers_is_one_in_stock():
    run = rmfs.Simulation("small", "small", "default", seed=1, set=keys({"layers": {}}))
    run.run()
    hands = next(one for one in run.events.observers if type(one).__name__ == "Hands")
    contained = run.world.inventory.contained
    for sku, pod in np.argwhere(contained > 0)[:300]:
        assert hands._layers.units(int(pod), int(sku)) == contained[sku, pod]
    used = (contained * run.world.skus.space_per_unit[:, None]).sum(axis=0)
    np.testing.assert_allclose(hands._layers.used.sum(axis=1), used)


FACES = {"faces": {"count": 4, "turn_face_s": 6.0}}


def test_faces_are_turned_and_turning_takes_its_time():
    """Visit by visit: the first face is free, every change of the face costs a turn."""
    run = simulate(FACES)
    picks, visits = run.table("picks"), run.table("visits")
    assert picks["handling_s"].to_numpy() == pytest.approx(np.where(picks["turned"], 16.0, 10.0))
    assert run.footprint["face_turns"] == picks["turned"].sum() > 20
    assert set(picks["face"]) == {0, 1, 2, 3}
    several = 0
    for visit in visits[visits["begin_s"] >= 300].itertuples():
        end_s = visit.end_s if visit.end_s == visit.end_s else np.inf
        here = (picks["station"] == visit.station) & picks["time_s"].between(visit.begin_s, end_s)
        own = picks[here & (picks["robot"] == visit.robot)]
        changed = own["face"].ne(own["face"].shift())
        changed.iloc[:1] = False
        assert (own["turned"] == changed).all()
        several += own["face"].nunique() > 1
    assert several > 20


def test_every_unit_on_a_face_is_one_in_stock():
    run = rmfs.Simulation("small", "small", "default", seed=1, set=keys(FACES))
    run.run()
    hands = next(one for one in run.events.observers if type(one).__name__ == "Hands")
    contained = run.world.inventory.contained
    for sku, pod in np.argwhere(contained > 0)[:300]:
        assert hands._faces.units(int(pod), int(sku)) == contained[sku, pod]
    used = (contained * run.world.skus.space_per_unit[:, None]).sum(axis=0)
    np.testing.assert_allclose(hands._faces.used.sum(axis=1), used)


class TestBound:
    def test_it_is_empty_where_draws_have_no_least(self, full):
        columns = ["units_per_h_bound", "units_score", "units_per_h_at_pile_on"]
        assert full.footprint[columns].isna().all()

    @pytest.mark.parametrize(
        "given",
        [
            {"speeds": [2.0]},
            {"speeds": [0.5, 1.6]},
            {"layers": {"time_factors": [0.6, 0.9]}},
            {"learning": {"rate": 0.7, "incompressible": 0.4}},
            {"fatigue": {"per_h": 2.0}},
        ],
    )
    def test_it_holds_for_people_who_are_faster(self, given):
        footprint = simulate(given, **{"layout.robots": 12}).footprint
        assert 0 < footprint["units_score"] <= 1
        if given == {"speeds": [2.0]}:
            assert footprint["units_per_h"] > 900
            assert footprint["units_per_h_bound"] == pytest.approx(1440, rel=0.01)


def test_a_saved_and_a_copied_run_go_on_alike(tmp_path, full):
    run = rmfs.Simulation("small", "small", "default", seed=1, set=keys(FULL))
    run.run_until(950)
    twin = run.fork()
    run.save(tmp_path / "file")
    again = rmfs.Simulation.load(tmp_path / "file")
    for one in (run, twin, again):
        one.run()
        assert (
            one.result()
            .footprint[reproducible("footprint")]
            .equals(full.footprint[reproducible("footprint")])
        )


def test_looking_ahead_goes_on_with_them():
    more = {"controllers.poa": {"name": "rollout"}}
    run = simulate(FULL, duration_s=200, **more)
    assert run.footprint["units_picked"] > 0
    verify(run.world)


def test_causes_have_draws_of_their_own():
    """Switching errors on does not change the times that are drawn."""
    times = {"unit_time": FULL["unit_time"]}
    errors = {"errors": {"share": 0.5, "noticed_share": 0.0}}
    first, second = simulate(times), simulate(times | errors)
    assert first.table("picks")["handling_s"].equals(second.table("picks")["handling_s"])
    assert second.footprint["pick_errors_unnoticed"] > 0


STAFFED = {"controllers.sa": {"name": "staffed"}}


class TestRules:
    def test_staffed_follows_the_roster(self):
        """Station 1 has a picker in the first shift only: later it gets nothing."""
        roster = {"shifts_s": [[0, 900], [900, 86400]], "pickers": [2, 1]}
        run = simulate({"roster": roster}, **STAFFED)
        switches = run.recorder.switches.columns()
        late = switches["time_s"] == 900
        assert switches["station"][late].tolist() == [1]
        assert not switches["active"][late].any()
        assigned = run.table("orders")
        assert (assigned["assigned_s"][assigned["station"] == 1] < 900).all()

    def test_staffed_gives_a_rest(self):
        tired = {"fatigue": {"per_h": 6.0, "recovery_per_h": 20.0}}
        rule = {"name": "staffed", "tired": 0.4, "rested": 0.2, "look_every_s": 10.0}
        free = simulate(tired, **STAFFED).footprint
        rested = simulate(tired, **{"controllers.sa": rule}).footprint
        assert rested["picker_fatigue_max"] < 0.7 < free["picker_fatigue_max"]
        assert rested["picker_busy_share"] < free["picker_busy_share"]

    def test_picker_load_spares_the_slow_and_tired(self):
        """One picker is half as fast as the other: with as many orders, that one would tire."""
        tired = {"per_h": 1.0, "recovery_per_h": 2.0}
        demand = {"mode": "poisson", "orders_per_h": 160.0, "per_station": False}
        rules = {
            "workload": {"name": "workload"},
            "picker-load": {"name": "picker-load"},
            "weighted": {"name": "picker-load", "fatigue_weight": 20.0},
        }
        most = {}
        for name, rule in rules.items():
            more = {"scenario.demand": demand, "controllers.poa": rule}
            run = simulate({"speeds": [1.6, 0.8], "fatigue": tired}, duration_s=5400, **more)
            most[name] = run.footprint["picker_fatigue_max"]
        assert most["weighted"] < most["picker-load"] < 0.9 * most["workload"]


class TestOptimisers:
    NAMES = ("pile-on", "planning", "ta-balance", "ta-routes")

    def run(self, name, pickers):
        short = keys(pickers, 400)
        return rmfs.simulate("small", "small", name, seed=1, set=short, pacing="work")

    @pytest.mark.parametrize("name", NAMES)
    def test_they_plan_with_the_times_of_pickers(self, name):
        """As in the layout if these are; otherwise they still pick, and know what they wait for."""
        alike = self.run(name, {}).footprint[COLUMNS]
        assert alike.equals(self.run(name, None).footprint[COLUMNS])
        run = self.run(name, FULL)
        verify(run.world)
        assert run.footprint["units_picked"] > 20

    def test_a_rule_sees_the_mean_time(self):
        run = rmfs.Simulation("small", "small", "default", set=keys({"speeds": [2.0, 0.5]}))
        assert run.view.unit_s(0) == 10.0  # nobody is there yet
        run.run_until(1.0)
        assert (run.view.unit_s(0), run.view.unit_s(1)) == (5.0, 20.0)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"speeds": [20.0]}, "speeds"),
        ({"unit_time": {"distribution": "gamma"}}, "variation"),
        ({"unit_time": {"distribution": "empirical", "file": "nowhere.csv"}}, "no such file"),
        ({"roster": {"shifts_s": [[0, 60]], "pickers": [9]}}, "only 2 pick stations"),
        ({"rest": {}}, "rest"),
    ],
)
def test_bad_input_is_told_in_one_line(given, told):
    with pytest.raises(InputError, match=told) as error:
        simulate(given)
    assert "\n" not in str(error.value)
