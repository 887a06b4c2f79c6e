"""Batteries in whole runs: rules, places, swap, power while waiting, and what goes wrong."""

from __future__ import annotations

import numpy as np
import pytest
from doubles import Situation

import rmfs
from rmfs.control.ca.by_demand import ByDemand
from rmfs.control.ca.levels import ByLevel
from rmfs.control.ca.opportunity import Opportunity
from rmfs.control.decisions import Charge, Unplug
from rmfs.control.problems import Problem, Trigger
from rmfs.control.registry import built_in, solver_backed
from rmfs.control.ta.balanced import Balanced
from rmfs.errors import InputError
from rmfs.measure import load_run, write_run
from rmfs.simulation.decision import ImpossibleError
from rmfs.world import verify
from rmfs.world.batteries import Batteries
from rmfs.world.charging import ChargeTask
from tests.simulation.energy_ledger import EnergyLedger

SHORT = {"layout.robots": 12, "scenario.warmup_s": 0, "scenario.duration_s": 2400}
BATTERY = {"capacity_wh": 150.0, "initial_least_share": 0.3, "initial_most_share": 0.6}
PLACES = {"kind": "charger", "north": 3, "parameters": {"power_w": 600.0}}
CHARGERS = {
    **SHORT,
    "scenario.energy": {"battery": BATTERY},
    "layout.other_stations.charger": PLACES,
}


def simulate(seed=1, **given):
    ledger = EnergyLedger()
    run = rmfs.simulate(seed=seed, set=CHARGERS | given, trace=True, observers=[ledger])
    ledger.check(run)
    verify(run.world)
    report = run.check()
    assert not report.findings, report.findings[:3]
    return run


RULES = [name for name in built_in(Problem.CA) if name != "dummy"]
RULES += solver_backed(Problem.CA)


@pytest.mark.parametrize("rule", RULES)
def test_nobody_strands_whatever_the_rule(rule):
    breaks = {"controllers.ca.breaks_s": [[600, 1500]]} if rule == "breaks" else {}
    run = simulate(**{"controllers.ca.name": rule} | breaks)
    footprint = run.footprint
    assert footprint["robots_stranded"] == 0
    assert footprint["charges"] > 3
    assert footprint["battery_level_least_share"] > 0.1
    assert 0 < footprint["charging_share"] < footprint["charge_task_share"] < 0.9
    assert footprint["energy_charged_kwh"] > 0.2
    charged = run.table("stations").query("kind == 'charger'")
    assert charged["visits"].sum() > 0
    assert run.table("controllers").set_index("problem").loc["ca", "decisions"] > 3


def test_rules_that_do_nothing_are_overruled():
    """A threshold of 0 never sends anybody: who could not finish a task goes in any case."""
    run = simulate(**{"controllers.ca.below_share": 0.0, "scenario.duration_s": 3600})
    assert run.footprint["robots_stranded"] == 0
    assert run.footprint["charges"] > 3
    assert run.footprint["battery_level_least_share"] > 0.1


def test_levels_are_kept_between_threshold_and_target():
    run = simulate(**{"controllers.ca": {"below_share": 0.4, "until_share": 0.55}})
    levels = run.table("robots")["level_wh"] / 150.0
    assert levels.max() < 0.62
    # nobody goes to a place of its own with more than the threshold, but for those from the start
    assert run.footprint["battery_level_least_share"] > 0.2


def test_battery_swap():
    swap = {"kind": "swap", "north": 2, "parameters": {"swap_s": 60.0, "batteries": 3}}
    run = simulate(**{"layout.other_stations.charger.north": 0, "layout.other_stations.swap": swap})
    assert run.footprint["robots_stranded"] == 0
    swapped = run.table("stations").query("kind == 'swap'")
    assert swapped["visits"].sum() > 3
    assert (run.footprint["charging_share"], run.footprint["charge_task_share"] > 0) == (0, True)
    assert run.footprint["energy_charged_kwh"] > 0.2


def test_power_while_waiting():
    given = {
        **SHORT,
        "scenario.energy": {
            "battery": BATTERY | {"capacity_wh": 600},
            "inductive": {"power_w": 400.0, "places": 3},
        },
    }
    ledger = EnergyLedger()
    run = rmfs.simulate(seed=2, set=given, trace=True, observers=[ledger])
    ledger.check(run)
    assert run.footprint["charging_share"] > 0.1
    assert run.footprint["energy_charged_kwh"] > 0.1
    assert run.footprint["charges"] == 0


def test_a_stranded_robot_is_counted_and_rescued():
    """Places that fail for long: robots strand, are rescued, and every run goes on."""
    failing = {
        "scenario.disturbances.chargers": {"every_s": 120, "lasting_s": 3000},
        "scenario.energy.battery.rescue_after_s": 200,
        "scenario.energy.battery.capacity_wh": 60,
        "scenario.duration_s": 4500,
    }
    given = {**CHARGERS, "layout.other_stations.charger.north": 2}
    run = rmfs.simulate(seed=3, set=given | failing)
    strandings = run.world.batteries.strandings
    assert run.footprint["robots_stranded"] == len(strandings) > 0
    assert len(run.world.batteries.stranded) < len(strandings)  # some were rescued
    assert run.footprint["disturbances"] > 2


def test_places_are_handed_over():
    few = {"layout.other_stations.charger.north": 1, "controllers.ca.below_share": 0.55}
    kept = simulate(**few)
    handed = simulate(**few, **{"controllers.ca.hand_over_share": 0.05})
    assert handed.table("stations")["visits"].iloc[-1] > kept.table("stations")["visits"].iloc[-1]


def test_places_are_handed_over_to_robots_in_the_queue_only(monkeypatch):
    """A robot on its way does not count: the place would be empty until it arrives."""
    waiting, hand_over = [], ByLevel._hand_over

    def watched(self, shares, gap):
        for one in hand_over(self, shares, gap):
            station = self.view.all_stations[one.robot.station]
            queue = self.view.layout.stations[station.index].queue
            there = [r for r in station.tasks if self.view.travel.robot_waypoint(r) in queue]
            waiting.append(min(shares[r] for r in there) + gap < shares[one.robot.index])
            yield one

    monkeypatch.setattr(ByLevel, "_hand_over", watched)
    simulate(
        **{
            "layout.other_stations.charger.north": 1,
            "controllers.ca": {"below_share": 0.55, "hand_over_share": 0.05},
        }
    )
    assert len(waiting) > 5
    assert all(waiting)


def test_orders_that_are_there_at_the_start_are_not_arriving():
    """50 orders wait at the start; then one arrives every 10 s, until demand falls at 300 s."""
    situation = Situation()
    rule = situation.make(ByDemand, window_s=100.0)
    calm = []
    for at_s in [0.0] * 50 + [float(second) for second in range(10, 301, 10)]:
        situation.world.now_s = at_s
        rule.hear(Trigger.NEW_ORDER, situation.order(s0=1))
        calm.append(rule.is_calm())
    assert not any(calm)
    situation.world.now_s = 350.0
    assert rule.is_calm()


def test_copies_and_saved_runs_go_on_alike(tmp_path):
    simulation = rmfs.Simulation(seed=4, set=CHARGERS)
    simulation.run_until(1000)
    fork = simulation.fork()
    simulation.save(tmp_path / "saved")
    saved = rmfs.Simulation.load(tmp_path / "saved")
    for one in (simulation, fork, saved):
        one.run()
    rows = [
        one.result().footprint.filter(regex="energy|charg|batter|units")
        for one in (simulation, fork, saved)
    ]
    assert rows[0].equals(rows[1])
    assert rows[0].equals(rows[2])


def test_rules_are_exchanged_in_the_middle():
    exchanges = [
        {"at_s": 500.0, "ca": "opportunity"},
        {"at_s": 1000.0, "ca": "schedule"},
        {"at_s": 1630.0, "ca": "to-full"},
    ]
    run = simulate(**{"controllers.mm": {"name": "scheduled", "exchanges": exchanges}})
    assert run.footprint["robots_stranded"] == 0
    assert run.footprint["charges"] > 3


@pytest.mark.parametrize("place", ["nearest", "soonest"])
def test_robots_without_work_charge_only_where_a_place_is_free(monkeypatch, place):
    """Two of the three chargers are far from where the robots rest."""
    sent, decide = [], Opportunity.decide

    def watched(self):
        for one in decide(self):
            if isinstance(one, Charge) and self.view.batteries.share(one.robot.index) >= 0.25:
                sent.append(len(self.view.all_stations[one.station].tasks))
            yield one

    monkeypatch.setattr(Opportunity, "decide", watched)
    simulate(**{"controllers.ca": {"name": "opportunity", "place": place}, "layout.robots": 30})
    assert len(sent) > 5
    assert not any(sent)


def test_robots_that_charge_do_not_count_at_the_station_they_worked_for(monkeypatch):
    """Whether a robot may work for a station, beside a count of the robots that do not charge."""
    answers, may_work = [], Balanced.may_work

    def watched(self, robot, station):
        may = may_work(self, robot, station)
        workers = [
            one
            for one, works_for in zip(self.view.robots, self._works_for, strict=True)
            if one is not robot and works_for == station and not isinstance(one.task, ChargeTask)
        ]
        answers.append((may, len(workers) < 2))
        return may

    monkeypatch.setattr(Balanced, "may_work", watched)
    simulate(**{"controllers.ta": {"robots_per_station": 2, "search_all": True}})
    assert answers.count((False, False)) > 20
    assert set(answers) == {(True, True), (False, False)}


def test_robots_that_charge_are_not_matched_by_swarm():
    """The stimulus of a station, with multipliers of 1: work less the robots matched with it."""
    simulation = rmfs.Simulation(seed=1, set=CHARGERS | {"controllers.ta.name": "swarm"})
    swarm = simulation.controller_set[Problem.TA]
    charging = 0
    for time_s in range(300, 2400, 100):
        simulation.run_until(time_s)
        view, robots = simulation.view, simulation.view.robots
        busy = [robot for robot in robots if not isinstance(robot.task, ChargeTask)]
        charging += len(robots) - len(busy)
        work = [len(station.orders) for station in view.pick_stations]
        work += [station.bundles for station in view.replenishment_stations]
        matched = [swarm._matched[robot.index] for robot in busy]
        expected = [
            max(min(amount, 6) - matched.count(station), 0) for station, amount in enumerate(work)
        ]
        swarm._multiplier[:] = 1.0
        assert swarm._stimulus().tolist() == expected
    assert charging > 20


def test_charging_is_decided_outside():
    simulation = rmfs.Simulation(seed=1, outside=["ca"], set=CHARGERS)
    sent = unplugged = 0
    while (decision := simulation.step()) is not None:
        assert decision.problem == "ca"
        rows = decision.candidates.frame() if len(decision.candidates) else None
        chosen = None
        if rows is not None:
            low = rows[(rows["station"] >= 0) & (rows["level_share"] < 0.35)]
            if len(low):
                chosen = decision.candidates[int(low.index[0])]
                chosen = chosen._replace(until_share=0.5)
            elif (rows["station"] < 0).any() and unplugged < 2:
                chosen = decision.candidates[int(rows[rows["station"] < 0].index[0])]
        if chosen is None:
            decision.decline()
        else:
            sent += isinstance(chosen, Charge)
            unplugged += isinstance(chosen, Unplug)
            decision.answer(chosen)
    assert sent > 3
    assert unplugged == 2
    assert simulation.result().footprint["robots_stranded"] == 0


def test_impossible_charges_say_why():
    simulation = rmfs.Simulation(seed=1, outside=["ca"], set=CHARGERS)
    decision = simulation.step()
    robot, charger = decision.view.robots[0], decision.view.recovery_stations[0].index
    for wrong, why in [
        (Charge(robot, 0, 0.5), "is not an energy station"),
        (Charge(robot, charger, 1.5), "must be a share of the capacity"),
        (Unplug(robot), "is not at a charger"),
    ]:
        with pytest.raises(ImpossibleError, match=why):
            decision.answer(wrong)
    assert decision.advice() is None or isinstance(decision.advice(), Charge)


def test_charging_times_are_the_inverse_of_charging():
    given = rmfs.scenario.load("default", [(["energy", "battery", "capacity_wh"], 500.0)])
    for taper in (0.7, 1.0):
        battery = Batteries(
            given.energy.battery.model_copy(update={"taper_from_share": taper}), None
        )
        for begin, end in [(0.1, 0.5), (0.2, 0.95), (0.8, 0.99)]:
            seconds = battery.seconds(begin, end, 700.0)
            assert battery.charged(begin, 700.0, seconds) == pytest.approx(end, rel=1e-12)
    constant = battery.seconds(0.0, 1.0, 700.0)
    assert constant == pytest.approx(500 * 3600 / 700)
    assert battery.seconds(0.5, 0.4, 700.0) == 0
    assert np.isinf(battery.seconds(0.5, 0.6, 0.0))


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"layout.other_stations.charger.north": 0}, "batteries cannot be charged"),
        (
            {"layout.other_stations.charger.parameters.power_w": 50.0},
            "12 robots draw 360 W even at standstill, but all chargers together supply only "
            "150 W: 210 W are",
        ),
        ({"controllers.ca": {"below_share": 0.8, "until_share": 0.5}}, "below_share = 0.8 must be"),
        ({"scenario.energy.battery.capacity_wh": -5}, "capacity_wh: .*greater than 0"),
        ({"scenario.energy.battery.least_share": 0.95}, "must be more than least_share"),
        ({"scenario.energy.battery.initial_most_share": 0.2}, "at least initial_least_share"),
        ({"layout.other_stations.charger.parameters.power_w": 0}, "power_w: .*greater than 0"),
        ({"layout.other_stations.charger.kind": "socket"}, "valid: charger, swap"),
    ],
)
def test_bad_input_gets_one_line(given, says):
    with pytest.raises(InputError, match=says) as error:
        rmfs.Simulation(set=CHARGERS | given)
    assert "\n" not in str(error.value)


def test_the_events_tell_levels(tmp_path):
    given = CHARGERS | {"scenario.duration_s": 600}
    run = rmfs.simulate(seed=1, set=given, trace=True)
    write_run(run, tmp_path / "run", trace=True)
    events = load_run(tmp_path / "run").events
    levels = events[events["kind"] == "battery-level"]
    assert set(levels["robot"]) == set(range(12))
    assert (levels["time_us"] == 0).sum() >= 12
    last = levels.groupby("robot")["units"].last() / 1000
    told = run.table("robots")["level_wh"].to_numpy() / 150
    np.testing.assert_allclose(last, told, atol=5e-4)  # the last minute ends with the run
