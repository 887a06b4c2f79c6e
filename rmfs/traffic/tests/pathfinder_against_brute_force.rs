//! The pathfinder against an exhaustive search over critical departure times on small random grids.

use std::collections::{BTreeSet, HashSet};

use _core::backward::Backward;
use _core::costs::Model;
use _core::guidance::{Guidance, guidance};
use _core::kinematics::Kind;
use _core::network::{Network, Plan, Ride};
use _core::reservations::{Interval, Table};
use _core::search::{End, Guide, Move, Outcome, Pathfinder, Query};
use _core::units::{FOREVER, Us, ceil_us, floor_us};

struct Random(u64);

impl Random {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % limit
    }

    fn chance(&mut self, percent: u64) -> bool {
        self.below(100) < percent
    }
}

fn kind() -> Kind {
    Kind {
        acceleration: 0.5,
        deceleration: 0.8,
        top_speed: 1.5,
        full_turn: 2_500_000,
        pod_transfer: 3_000_000,
    }
}

/// Twelve waypoints in a grid with random one-way and two-way edges and random storage locations: on
/// one floor (3 x 4), or on two (2 x 3 each) with an elevator in two of the corners.
fn random_network(random: &mut Random, floors: usize) -> Network {
    let (columns, rows) = if floors == 1 { (4, 3) } else { (3, 4) };
    let at = |c: usize, r: usize| (r * columns + c) as u32;
    let floor = |r: usize| r * floors / rows;
    let mut edges = BTreeSet::new();
    for r in 0..rows {
        for c in 0..columns {
            for (dc, dr) in [(1, 0), (0, 1)] {
                if c + dc < columns && r + dr < rows && floor(r) == floor(r + dr) {
                    let (v, w) = (at(c, r), at(c + dc, r + dr));
                    if random.chance(90) {
                        edges.insert((v, w));
                    }
                    if random.chance(90) {
                        edges.insert((w, v));
                    }
                }
            }
        }
    }
    let nodes = columns * rows;
    let mut edge_start = vec![0];
    let mut edge_target = Vec::new();
    for v in 0..nodes as u32 {
        edge_target.extend(edges.iter().filter(|e| e.0 == v).map(|e| e.1));
        edge_start.push(edge_target.len() as u32);
    }
    let shafts = if floors == 1 { Vec::new() } else { vec![[0, 6], [5, 11]] };
    let ride = |from: u32, to: u32| Ride { from, to, travel: 2_000_000 };
    Network::new(Plan {
        x: (0..nodes).map(|v| (v % columns) as f64).collect(),
        y: (0..nodes).map(|v| (v / columns % (rows / floors)) as f64).collect(),
        tier: (0..nodes).map(|v| floor(v / columns) as i16).collect(),
        edge_start,
        edge_target,
        storage: (0..nodes as u32)
            .map(|v| random.chance(25) && !shafts.iter().flatten().any(|&end| end == v))
            .collect(),
        queue: vec![false; nodes],
        stations: Vec::new(),
        elevators: shafts.iter().map(|ends| ends.to_vec()).collect(),
        rides: shafts.iter().flat_map(|&[v, w]| [ride(v, w), ride(w, v)]).collect(),
        extra_headings: vec![0, 250_000, 500_000, 750_000],
    })
    .expect("a grid")
}

fn random_table(random: &mut Random, network: &Network, start: u32) -> Table {
    let mut table = Table::new(network.resources);
    let own = |&node: &u32| network.resource[node as usize] == node;
    for node in (0..network.nodes as u32).filter(own) {
        let mut time = 0;
        for robot in 1..=random.below(4) as u32 {
            let from = time + random.below(6_000_000) as Us;
            let last = random.chance(8);
            let until = if last { FOREVER } else { from + 500_000 + random.below(5_000_000) as Us };
            let covers_start = node == network.resource[start as usize] && from <= 1_000_000;
            if !covers_start {
                table.insert(node, Interval { start: from, end: until, robot }, -1);
            }
            if last {
                break;
            }
            time = until;
        }
    }
    table
}

/// Extra costs of up to 5 s on some edges.
fn random_guidance(random: &mut Random, network: &Network) -> Guidance {
    let mut edges = Vec::new();
    for node in 0..network.nodes as u32 {
        for heading in 0..network.heading_count() as u8 {
            if let Some((next, _)) = network.ahead(node, heading)
                && random.chance(40)
            {
                edges.push((node, next, random.below(5_000_000) as u32));
            }
        }
    }
    guidance(network, &edges).expect("edges").expect("extra costs")
}

fn free(world: &World, node: u32, from: Us, until: Us) -> bool {
    let row = world.table.row(world.network.resource[node as usize]);
    row.iter().all(|taken| until <= taken.start || from >= taken.end)
}

/// Where a query is asked.
struct World<'a> {
    network: &'a Network,
    table: &'a Table,
}

/// Extra cost of driving from a waypoint to the next.
fn extra(world: &World, query: &Query, node: u32, heading: u8) -> Us {
    query.guidance.map_or(0, |extra| Us::from(extra[world.network.index(node, heading)]))
}

/// Cost of a way found: its end plus the extra costs of its edges.
fn cost(world: &World, query: &Query, moves: &[Move]) -> Us {
    let driven = moves.iter().filter(|step| !step.ride).flat_map(|step| {
        let line = world.network.line(step.from, step.to, step.heading).map(|stop| stop.0);
        let tails = std::iter::once(step.from).chain(line).filter(|&node| node != step.to);
        tails.map(|node| extra(world, query, node, step.heading))
    });
    moves.last().map_or(query.ready, |last| last.end) + driven.sum::<Us>()
}

/// Earliest arrival (with guidance, the least sum of arrival and extra cost) not after `latest`, by
/// trying every departure at which something changes.
fn brute_force(world: &World, query: &Query, latest: Us) -> Option<Us> {
    let network = world.network;
    let mut open = BTreeSet::from([(query.ready, query.ready, query.start, query.heading)]);
    let mut seen: HashSet<(Us, u32, u8)> = HashSet::new();
    while let Some((total, time, node, heading)) = open.pop_first() {
        if !seen.insert((time, node, heading)) {
            continue;
        }
        if node == query.goal && time <= latest && free(world, node, time, FOREVER) {
            return Some(total);
        }
        if time > 60_000_000 {
            continue;
        }
        for ride in network.rides_from(node) {
            if free(world, node, time, time + ride.travel) {
                open.insert((total + ride.travel, time + ride.travel, ride.to, heading));
            }
        }
        for towards in 0..network.heading_count() as u8 {
            let turn = query
                .kind
                .turn(network.headings[heading as usize], network.headings[towards as usize]);
            let mut line = vec![(node, 0.0)];
            let mut dear = total - time;
            while let Some((next, length)) = network.ahead(line[line.len() - 1].0, towards) {
                let here = line[line.len() - 1];
                if !network.may_enter(here.0, next, query.goal, query.loaded) {
                    break;
                }
                line.push((next, here.1 + length));
                dear += extra(world, query, here.0, towards);
                for departure in departures(world, query.kind, &line, time + turn) {
                    if let Some(arrival) = drive(world, query.kind, &line, time, departure) {
                        open.insert((arrival + dear, arrival, next, towards));
                    }
                }
                if query.loaded && network.storage[next as usize] {
                    break;
                }
            }
        }
    }
    None
}

/// When the robot is at each waypoint of a line, relative to its departure.
fn passing(kind: &Kind, line: &[(u32, f64)]) -> Vec<f64> {
    let profile = kind.run(line[line.len() - 1].1);
    line.iter().map(|(_, distance)| profile.time_at(*distance)).collect()
}

fn departures(world: &World, kind: &Kind, line: &[(u32, f64)], ready: Us) -> Vec<Us> {
    let times = passing(kind, line);
    let mut candidates = vec![ready];
    for i in 1..line.len() {
        for taken in world.table.row(world.network.resource[line[i].0 as usize]) {
            let departure = taken.end - floor_us(times[i - 1]);
            if taken.end < FOREVER && departure > ready {
                candidates.push(departure);
            }
        }
    }
    candidates
}

fn drive(world: &World, kind: &Kind, line: &[(u32, f64)], since: Us, departure: Us) -> Option<Us> {
    let times = passing(kind, line);
    let last = line.len() - 1;
    let arrival = departure + ceil_us(times[last]);
    let clear = (0..=last).all(|i| {
        let from = if i == 0 { since } else { departure + floor_us(times[i - 1]) };
        let until = if i == last { arrival } else { departure + ceil_us(times[i + 1]) };
        free(world, line[i].0, from, until)
    });
    clear.then_some(arrival)
}

#[test]
fn earliest_arrivals_agree_with_exhaustive_search() {
    let (found, impossible) = compare(42, 2_000, 1, Guide::Exact, FOREVER, false);
    assert!(found > 500 && impossible > 300, "{found} found, {impossible} impossible");
}

/// The search knows when elevators can be used at the earliest, and may not think it is later.
#[test]
fn earliest_arrivals_over_elevators_agree_with_exhaustive_search() {
    let (found, impossible) = compare(43, 1_000, 2, Guide::Exact, FOREVER, false);
    assert!(found > 250 && impossible > 150, "{found} found, {impossible} impossible");
}

/// Where unhindered times are not searched for, straight lines to the goal are a bound as well.
#[test]
fn earliest_arrivals_are_found_with_unhindered_times_near_the_best_way_only() {
    for (seed, floors, near) in [(44, 1, 0), (45, 1, 2_000_000), (46, 2, 0)] {
        let (found, impossible) = compare(seed, 300, floors, Guide::Near(near), FOREVER, false);
        assert!(found > 70 && impossible > 40, "{found} found, {impossible} impossible");
    }
}

/// Arrivals that are too late are not found, all others are.
#[test]
fn arrivals_within_a_detour_agree_with_exhaustive_search() {
    for (seed, guide) in [(47, Guide::Exact), (48, Guide::Near(0))] {
        let (found, none) = compare(seed, 300, 1, guide, 3_000_000, false);
        assert!(found > 40 && none > 70, "{found} found, {none} not");
    }
}

/// With guidance, ways have the least sum of arrival time and extra costs.
#[test]
fn costs_with_guidance_agree_with_exhaustive_search() {
    for (seed, floors, guide, detour) in [
        (49, 1, Guide::Exact, FOREVER),
        (50, 2, Guide::Exact, FOREVER),
        (51, 1, Guide::Near(0), FOREVER),
        (52, 1, Guide::Exact, 3_000_000),
    ] {
        let (found, none) = compare(seed, 400, floors, guide, detour, true);
        assert!(found > 50 && none > 50, "{found} found, {none} not");
    }
}

/// The last arrival that is of use: by the unhindered time (a full table), or after the goal is free.
fn latest(world: &World, query: &Query) -> Us {
    if query.detour == FOREVER {
        return FOREVER;
    }
    let times = query.model.towards(world.network, query.goal, query.loaded);
    let unhindered = Us::from(times[world.network.index(query.start, query.heading)]);
    let row = world.table.row(world.network.resource[query.goal as usize]);
    let goal_free = row.last().map_or(0, |last| last.end);
    (query.ready + unhindered).max(goal_free) + query.detour
}

/// Compares random cases; returns how many have a way that is not too late, and how many have none.
fn compare(
    seed: u64,
    cases: usize,
    floors: usize,
    guide: Guide,
    detour: Us,
    guided: bool,
) -> (u32, u32) {
    let kind = kind();
    let mut random = Random(seed);
    let (mut found, mut impossible) = (0, 0);
    for case in 0..cases {
        let network = random_network(&mut random, floors);
        let start = random.below(12) as u32;
        let goal = random.below(12) as u32;
        let table = random_table(&mut random, &network, start);
        let model = Model::new(&network, &kind);
        let extra = guided.then(|| random_guidance(&mut random, &network));
        let query = Query {
            start,
            heading: random.below(4) as u8,
            ready: 1_000_000,
            goal,
            loaded: random.chance(50),
            stored: &[],
            kind: &kind,
            model: &model,
            budget: u64::MAX,
            end: End::ForGood,
            detour,
            guide,
            times: None,
            guidance: extra.as_ref(),
        };
        let world = World { network: &network, table: &table };
        if !free(&world, start, query.ready, query.ready + 1) {
            continue;
        }
        let expected = brute_force(&world, &query, latest(&world, &query));
        let mut pathfinder = Pathfinder::new(&network);
        let outcome = match guide {
            Guide::Exact if !guided => pathfinder.search(&network, &table, &query),
            _ if pathfinder.aim(&network, &query).is_none() => Outcome::NoWay,
            _ => pathfinder.seek(&network, &table, &query, 4, u64::MAX),
        };
        let got = match outcome {
            Outcome::Found(moves) => Some(cost(&world, &query, &moves)),
            _ => None,
        };
        assert_eq!(got, expected, "case {case}: {start} to {goal}, loaded {}", query.loaded);
        if expected.is_some() { found += 1 } else { impossible += 1 }
    }
    (found, impossible)
}

#[test]
fn bounds_never_exceed_the_time_on_an_empty_network() {
    let kind = kind();
    let mut random = Random(7);
    for _ in 0..200 {
        let network = random_network(&mut random, 1);
        let table = Table::new(network.resources);
        let model = Model::new(&network, &kind);
        let goal = random.below(12) as u32;
        let loaded = random.chance(50);
        let times = model.towards(&network, goal, loaded);
        for start in 0..12 {
            let query = Query {
                start,
                heading: 0,
                ready: 0,
                goal,
                loaded,
                stored: &[],
                kind: &kind,
                model: &model,
                budget: u64::MAX,
                end: End::ForGood,
                detour: FOREVER,
                guide: Guide::Exact,
                times: None,
                guidance: None,
            };
            let bound = times[network.index(start, 0)];
            match brute_force(&World { network: &network, table: &table }, &query, FOREVER) {
                // each run's time is rounded down in the bound and up in the plan
                Some(time) => {
                    assert!((0..20).contains(&(time - Us::from(bound))), "{time} {bound}")
                }
                None => assert_eq!(bound, u32::MAX),
            }
        }
    }
}

/// With bounds that count turns, the search from the goal knows fewer states, but what it says of
/// them is as before: never too much, exact where it is known, and exact on ways that are short
/// enough.
#[test]
fn bounds_that_count_turns_leave_unhindered_times_as_they_are() {
    let kind = kind();
    let mut random = Random(11);
    let (mut known, mut unknown) = (0, 0);
    for round in 0..300 {
        let network = random_network(&mut random, 1 + round % 2);
        let model = Model::new(&network, &kind);
        let (goal, start) = (random.below(12) as u32, random.below(12) as u32);
        let (heading, loaded) = (random.below(4) as u8, random.chance(50));
        let times = model.towards(&network, goal, loaded);
        let mut search = Backward::new(&network);
        search.begin(&network, &model, goal, loaded, Some(start));
        search.count_turns(&network, &model, heading);
        while search.reach() < u32::MAX {
            // of a loaded robot, only what matters on its way is known
            for node in (0..12).filter(|&node| !loaded || node == start) {
                for facing in 0..network.heading_count() as u8 {
                    if loaded && facing != heading {
                        continue;
                    }
                    let exact = times[network.index(node, facing)];
                    let found = search.to_go(&network, node, facing);
                    assert!(found <= exact, "{found} {exact}");
                    if search.knows(&network, node, facing) {
                        assert_eq!(found, exact);
                        known += 1;
                    } else {
                        unknown += 1;
                    }
                }
            }
            let reach = search.reach() + (1 << 18);
            search.advance(&network, &model, reach);
        }
        let least = times[network.index(start, heading)];
        assert_eq!(search.to_go(&network, start, heading), least);
    }
    assert!(known > 10_000 && unknown > 10_000, "{known} {unknown}");
}

/// Extra costs of zero change no plan.
#[test]
fn guidance_of_zeros_leaves_plans_as_they_are() {
    let kind = kind();
    let mut random = Random(53);
    let mut found = 0;
    for case in 0..400 {
        let network = random_network(&mut random, 1 + case % 2);
        let start = random.below(12) as u32;
        let table = random_table(&mut random, &network, start);
        let model = Model::new(&network, &kind);
        let zeros: Guidance = vec![0; network.nodes * network.heading_count()].into();
        let query = Query {
            start,
            heading: random.below(4) as u8,
            ready: 1_000_000,
            goal: random.below(12) as u32,
            loaded: random.chance(50),
            stored: &[],
            kind: &kind,
            model: &model,
            budget: u64::MAX,
            end: End::ForGood,
            detour: FOREVER,
            guide: Guide::Exact,
            times: None,
            guidance: None,
        };
        let mut pathfinder = Pathfinder::new(&network);
        let plain = pathfinder.search(&network, &table, &query);
        let labels = pathfinder.expansions;
        let guided = Query { guidance: Some(&zeros), ..query };
        assert_eq!(plain, pathfinder.search(&network, &table, &guided), "case {case}");
        assert_eq!(pathfinder.expansions, 2 * labels, "case {case}");
        found += u32::from(matches!(plain, Outcome::Found(_)));
    }
    assert!(found > 100, "{found} found");
}
