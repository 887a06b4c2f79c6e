"""Packing in whole runs: what the tables say of it, recomputed; and what costs nothing."""

from __future__ import annotations

from heapq import heappop, heappush

import numpy as np
import pytest
from hand_made import HandMade

import rmfs
from rmfs.control.decisions import AssignLines
from rmfs.errors import InputError
from rmfs.measure.dictionary import reproducible
from rmfs.measure.measures.packing import Packing
from rmfs.observer import Observer
from rmfs.world import verify

OWN = {column.name for column in Packing.columns}
NEVER = {"by_hand_after_s": 1e6}
SHORT = {"scenario.duration_s": 1200}
PACKERS = {"packers": 2, "order_s": 20.0, "part_s": 10.0}
CASES = {
    "room": {**PACKERS, "travel": {"constant_s": 25.0}},
    "full": {**PACKERS, **NEVER, "slots": 25, "travel": {"constant_s": 25.0}},
    "by hand": {"slots": 8, "by_hand_after_s": 200.0, "travel": {"constant_s": 10.0}},
    "per order": {
        **PACKERS,
        **NEVER,
        "slots": 12,
        "slot_for": "order",
        "travel": {"constant_s": 10.0},
    },
    "conveyor": {**PACKERS, **NEVER, "travel": {"speed_m_s": 0.5, "constant_s": 40.0, "totes": 2}},
    "at once": {**NEVER, "slots": 25, "packers": 1, "order_s": 5.0},
    "all packed": {**PACKERS, "bypass": False, "variation": 0.5, "travel": {"speed_m_s": 1.0}},
}


BLIND = {"controllers.poa.split_orders": 10**6}
"""Orders are split whether the wall has room or not."""


def simulate(packing, controllers="pile-on-split", **given):
    keys = SHORT if packing is None else SHORT | {"scenario.packing": packing}
    if controllers == "pile-on-split":
        keys = keys | BLIND
    return rmfs.simulate("small", "small", controllers, seed=1, pacing="work", set=keys, **given)


@pytest.fixture(scope="module")
def runs():
    return {name: simulate(given) for name, given in CASES.items()}


@pytest.mark.parametrize("controllers", ["pile-on-split", "planning-split"])
def test_packing_that_costs_nothing_changes_nothing(controllers):
    """Footprint and motion, bit for bit."""
    without = simulate(None, controllers, trace=True)
    free = simulate({}, controllers, trace=True)
    columns = [name for name in reproducible("footprint") if name not in OWN]
    assert free.footprint[columns].equals(without.footprint[columns])
    for name, values in without.trace.items():
        assert np.array_equal(values, free.trace[name])
    assert without.footprint[list(OWN)].isna().all()
    footprint = free.footprint
    assert footprint["orders_packed"] == footprint["orders_completed"] > 0
    assert footprint["order_cycle_mean_s"] == footprint["order_turnover_mean_s"]
    assert footprint["orders_packed_split_share"] > 0.1


@pytest.mark.parametrize("name", CASES)
def test_every_count_holds(runs, name):
    run, given = runs[name], CASES[name]
    verify(run.world)
    parcels, totes = run.table("parcels"), run.table("totes")
    done = parcels[parcels["packed_s"].notna()]
    assert run.footprint["orders_packed"] == len(done) > 5
    assert parcels["totes"].sum() == len(totes)
    order = ["created_s", "picked_s", "packing_s", "packed_s"]
    assert (done[order].diff(axis=1).iloc[:, 1:] >= 0).all(axis=None)
    by_order = totes.groupby("order")
    last = by_order["arrived_s"].max().loc[done["order"]].to_numpy()
    went = done["consolidated_s"].notna().to_numpy()
    assert np.array_equal(last[went], done["consolidated_s"].to_numpy()[went])
    # what was never split went nowhere, where it may
    alone = done["totes"].to_numpy() == 1
    if given.get("bypass", True):
        assert np.array_equal(~went, alone)
        assert (done["packed_s"] == done["picked_s"])[alone].all()
    else:
        assert went.all()
        assert alone.any()


@pytest.mark.parametrize("name", CASES)
def test_travel_takes_what_it_should(runs, name):
    run, travel = runs[name], CASES[name].get("travel", {})
    totes = run.table("totes").dropna(subset="arrived_s")
    layout = run.layout
    at = [station.waypoint for station in layout.pick_stations]
    x_m, y_m = layout.x_m[at], layout.y_m[at]
    way_m = np.abs(x_m - x_m.mean()) + np.abs(y_m - y_m.mean())
    expected = np.full(len(at), travel.get("constant_s", 0.0))
    if "speed_m_s" in travel:
        expected += way_m / travel["speed_m_s"]
        assert way_m.min() > 0
    took = totes["arrived_s"] - totes["released_s"]
    np.testing.assert_allclose(took, expected[totes["station"]], atol=2e-6)


def kept_over_time(run, slot_for):
    """Slots kept just after each change: by the definition, tote by tote."""
    changes = []
    for _, own in run.table("totes").groupby("order"):
        times, done = own["released_s"].tolist(), own["consolidated_s"].iloc[0]
        row = run.table("parcels").set_index("order").loc[own["order"].iloc[0]]
        kept = times[:-1] if row["picked_s"] == row["picked_s"] else times
        kept = kept[:1] if slot_for == "order" else kept
        changes += [(time_s, 1) for time_s in kept]
        changes += [(done, -1) for _ in kept if done == done]
    times = np.array(sorted({time_s for time_s, _ in changes}))
    level = np.array([sum(by for at, by in changes if at <= time_s) for time_s in times])
    return times, level


@pytest.mark.parametrize("name", ["full", "per order", "at once", "by hand", "conveyor"])
def test_no_tote_finds_the_wall_full_and_none_waits_without_cause(runs, name):
    run, given = runs[name], CASES[name]
    times, kept = kept_over_time(run, given.get("slot_for", "part"))
    totes = run.table("totes")
    parcels = run.table("parcels").set_index("order")
    went = parcels["packed_s"].isna() | parcels["consolidated_s"].notna()
    totes = totes[went.loc[totes["order"]].to_numpy()]
    limit = given.get("travel", {}).get("totes")
    if name == "by hand":
        assert run.footprint["totes_by_hand"] == totes["by_hand"].sum() > 0
        assert kept.max() > given["slots"]
        return
    assert not totes["by_hand"].any()
    if "slots" in given:
        assert kept.max() == given["slots"]
    if limit is not None:
        begin, end = totes["released_s"].to_numpy(), totes["arrived_s"].fillna(np.inf).to_numpy()
        on_it = np.array([((begin <= time_s) & (end > time_s)).sum() for time_s in begin])
        assert on_it.max() == limit
    held = run.recorder.packing.held.columns()
    assert len(held["begin_s"]) > 0
    for begin_s, end_s in zip(held["begin_s"], held["end_s"], strict=True):
        for time_s in np.linspace(begin_s, end_s - 1e-3, 5):
            if end_s - begin_s < 0.01:
                continue
            level = kept[np.searchsorted(times, time_s, side="right") - 1]
            moving = ((totes["released_s"] <= time_s) & ~(totes["arrived_s"] <= time_s)).sum()
            assert level == given.get("slots") or moving == limit
    blocked = (held["end_s"] - held["begin_s"]).sum() / SHORT["scenario.duration_s"]
    assert run.footprint["totes_held_mean"] == pytest.approx(blocked)
    assert run.footprint["station_blocked_share"] == pytest.approx(blocked / 12)


def test_a_held_tote_keeps_its_slot(runs):
    """With a wall that is always full, orders stand at the stations instead: fewer units."""
    full, room = runs["by hand"].footprint, runs["room"].footprint
    assert full["station_blocked_share"] > 0.3
    assert room["station_blocked_share"] == 0
    assert full["units_per_h"] < 0.9 * room["units_per_h"]


@pytest.mark.parametrize("name", ["room", "full", "conveyor", "at once", "all packed"])
def test_packers_serve_in_turn(runs, name):
    """Begin of every packing, by the recursion for c servers and one queue."""
    run, given = runs[name], CASES[name]
    went = run.table("parcels").dropna(subset="consolidated_s")
    went = went.sort_values(["consolidated_s", "packing_s"])
    free = [0.0] * given["packers"]
    for row in went.itertuples():
        begin_s = max(row.consolidated_s, heappop(free))
        if row.packing_s != row.packing_s:
            assert begin_s > SHORT["scenario.duration_s"] - 1e-6
            break
        assert row.packing_s == pytest.approx(begin_s, abs=1e-5)
        took_s = row.packed_s - row.packing_s
        if row.packed_s != row.packed_s:
            took_s = np.inf
        elif not given.get("variation"):
            expected_s = given["order_s"] + given.get("part_s", 0.0) * row.totes
            assert took_s == pytest.approx(expected_s, abs=1e-5)
        heappush(free, row.packing_s + took_s)
    assert 0 < run.footprint["packer_busy_share"] <= 1


@pytest.mark.parametrize("name", ["room", "full", "per order"])
def test_littles_law_on_wall_slots(runs, name):
    """Slots in use = arrivals per second x time in a slot, as far as both lie in the run."""
    run, given = runs[name], CASES[name]
    end_s = SHORT["scenario.duration_s"]
    totes = run.table("totes").dropna(subset="arrived_s")
    if given.get("slot_for") == "order":
        totes = totes.groupby("order").agg({"arrived_s": "min", "consolidated_s": "first"})
    stay = totes["consolidated_s"].fillna(end_s) - totes["arrived_s"]
    stay = stay[stay > 0]
    rate = len(stay) / end_s
    assert run.footprint["wall_slots_mean"] == pytest.approx(rate * stay.mean())
    assert run.footprint["wall_slots_max"] <= given.get("slots", np.inf)


def test_a_saved_and_a_copied_run_go_on_alike(tmp_path):
    given = SHORT | BLIND | {"scenario.packing": CASES["full"] | {"variation": 1.0}}
    run = rmfs.Simulation("small", "small", "pile-on-split", seed=2, set=given, pacing="work")
    run.run_until(700)
    assert run.world.put_wall.held
    twin = run.fork()
    run.save(tmp_path / "file")
    again = rmfs.Simulation.load(tmp_path / "file")
    for one in (run, twin, again):
        one.run()
    columns = reproducible("footprint")
    for one in (twin, again):
        assert one.result().footprint[columns].equals(run.result().footprint[columns])
    other = rmfs.simulate("small", "small", "pile-on-split", seed=2, set=given, pacing="work")
    assert other.footprint[columns].equals(run.result().footprint[columns])


def test_looking_ahead_goes_on_with_it():
    packing = {"scenario.packing": {"slots": 3, "packers": 1, "order_s": 5.0, "variation": 1.0}}
    given = {"scenario.duration_s": 300, "controllers.poa": {"name": "rollout"}}
    run = rmfs.simulate("small", "small-arrivals", "sequ", seed=1, set=given | packing)
    assert run.footprint["orders_packed"] == run.footprint["orders_completed"] > 0
    verify(run.world)


class Held(Observer):
    """Station, begin and end of each wait of a tote at its station."""

    def __init__(self):
        self.waits = []

    def tote_held(self, station, from_s, to_s):
        self.waits.append((station, from_s, to_s))


@pytest.mark.parametrize("slot_for", ["part", "order"])
def test_the_last_part_leaves_with_the_one_that_is_carried_by_hand(slot_for):
    """An order that lacks SKU 4 keeps the only slot; both parts of another order wait.

    When the first is carried away after 100 s, the second is the last of its order: it needs no
    slot, although the first is still on its way.
    """
    held = Held()
    packing = {"slots": 1, "slot_for": slot_for, "by_hand_after_s": 100.0}
    made = HandMade(
        {"pick_stations": 2},
        {"packing": {**packing, "travel": {"constant_s": 50.0}}},
        observers=(held,),
    )
    made.stock(0, s0=1, s1=1)
    made.stock(1, s2=1)
    made.order(0.0, s0=1, s4=1)
    made.order(0.0, s1=1, s2=1)

    def assign():
        blocking, waiting = made.ledger.orders.values()
        for order, station, sku in [(blocking, 0, 0), (blocking, 1, 4), (waiting, 0, 1)]:
            made.simulation.applying(AssignLines(order, station, [sku]), None)
        made.simulation.applying(AssignLines(waiting, 1, [2]), None)

    made.at(0.0, assign)
    made.run()
    first, last = (time_s + 10.0 for time_s, _, order, *_ in made.diary.of("unit") if order == 1)
    assert held.waits == [(0, first, first + 100.0), (1, last, first + 100.0)]
    verify(made.world)


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"slots": 0}, "scenario.packing.slots"),
        ({"packers": 1.5}, "scenario.packing.packers"),
        ({"slot_for": "tote"}, "scenario.packing.slot_for"),
        ({"travel": {"speed_m_s": 0}}, "scenario.packing.travel.speed_m_s"),
        ({"travel": {"second": 1}}, "scenario.packing.travel.second"),
        ({"order_s": -1}, "scenario.packing.order_s"),
    ],
)
def test_bad_numbers_are_told_in_one_line(given, told):
    with pytest.raises(InputError) as error:
        simulate(given)
    assert told.rpartition(".")[2] in str(error.value)
    assert "\n" not in str(error.value)
