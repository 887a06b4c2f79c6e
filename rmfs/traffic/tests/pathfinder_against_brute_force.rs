//! The pathfinder against an exhaustive search over critical departure times on small random grids.

use std::collections::{BTreeSet, HashSet};

use _core::costs::Model;
use _core::kinematics::Kind;
use _core::network::{Network, Plan, Ride};
use _core::reservations::{Interval, Table};
use _core::search::{End, Guide, Outcome, Pathfinder, Query};
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

fn free(world: &World, node: u32, from: Us, until: Us) -> bool {
    let row = world.table.row(world.network.resource[node as usize]);
    row.iter().all(|taken| until <= taken.start || from >= taken.end)
}

/// Where a query is asked.
struct World<'a> {
    network: &'a Network,
    table: &'a Table,
}

/// Earliest arrival by trying every departure at which something changes.
fn brute_force(world: &World, query: &Query) -> Option<Us> {
    let network = world.network;
    let mut open = BTreeSet::from([(query.ready, query.start, query.heading)]);
    let mut seen: HashSet<(Us, u32, u8)> = HashSet::new();
    while let Some((time, node, heading)) = open.pop_first() {
        if !seen.insert((time, node, heading)) {
            continue;
        }
        if node == query.goal && free(world, node, time, FOREVER) {
            return Some(time);
        }
        if time > 60_000_000 {
            return None;
        }
        for ride in network.rides_from(node) {
            if free(world, node, time, time + ride.travel) {
                open.insert((time + ride.travel, ride.to, heading));
            }
        }
        for towards in 0..network.heading_count() as u8 {
            let turn = query
                .kind
                .turn(network.headings[heading as usize], network.headings[towards as usize]);
            let mut line = vec![(node, 0.0)];
            while let Some((next, length)) = network.ahead(line[line.len() - 1].0, towards) {
                let here = line[line.len() - 1];
                if !network.may_enter(here.0, next, query.goal, query.loaded) {
                    break;
                }
                line.push((next, here.1 + length));
                for departure in departures(world, query.kind, &line, time + turn) {
                    if let Some(arrival) = drive(world, query.kind, &line, time, departure) {
                        open.insert((arrival, next, towards));
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
    let (found, impossible) = compare(42, 2_000, 1, Guide::Exact, FOREVER);
    assert!(found > 500 && impossible > 300, "{found} found, {impossible} impossible");
}

/// The search knows when elevators can be used at the earliest, and may not think it is later.
#[test]
fn earliest_arrivals_over_elevators_agree_with_exhaustive_search() {
    let (found, impossible) = compare(43, 1_000, 2, Guide::Exact, FOREVER);
    assert!(found > 250 && impossible > 150, "{found} found, {impossible} impossible");
}

/// Where unhindered times are not searched for, straight lines to the goal are a bound as well.
#[test]
fn earliest_arrivals_are_found_with_unhindered_times_near_the_best_way_only() {
    for (seed, floors, near) in [(44, 1, 0), (45, 1, 2_000_000), (46, 2, 0)] {
        let (found, impossible) = compare(seed, 300, floors, Guide::Near(near), FOREVER);
        assert!(found > 70 && impossible > 40, "{found} found, {impossible} impossible");
    }
}

/// Arrivals that are too late are not found, all others are.
#[test]
fn arrivals_within_a_detour_agree_with_exhaustive_search() {
    for (seed, guide) in [(47, Guide::Exact), (48, Guide::Near(0))] {
        let (found, none) = compare(seed, 300, 1, guide, 3_000_000);
        assert!(found > 40 && none > 70, "{found} found, {none} not");
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
fn compare(seed: u64, cases: usize, floors: usize, guide: Guide, detour: Us) -> (u32, u32) {
    let kind = kind();
    let mut random = Random(seed);
    let (mut found, mut impossible) = (0, 0);
    for case in 0..cases {
        let network = random_network(&mut random, floors);
        let start = random.below(12) as u32;
        let goal = random.below(12) as u32;
        let table = random_table(&mut random, &network, start);
        let model = Model::new(&network, &kind);
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
        };
        let world = World { network: &network, table: &table };
        if !free(&world, start, query.ready, query.ready + 1) {
            continue;
        }
        let expected = brute_force(&world, &query).filter(|&end| end <= latest(&world, &query));
        let mut pathfinder = Pathfinder::new(&network);
        let outcome = match guide {
            Guide::Exact => pathfinder.search(&network, &table, &query),
            Guide::Near(_) if pathfinder.aim(&network, &query).is_none() => Outcome::NoWay,
            Guide::Near(_) => pathfinder.seek(&network, &table, &query, 4, u64::MAX),
        };
        let got = match outcome {
            Outcome::Found(moves) => Some(moves.last().map_or(query.ready, |last| last.end)),
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
            };
            let bound = times[network.index(start, 0)];
            match brute_force(&World { network: &network, table: &table }, &query) {
                // each run's time is rounded down in the bound and up in the plan
                Some(time) => {
                    assert!((0..20).contains(&(time - Us::from(bound))), "{time} {bound}")
                }
                None => assert_eq!(bound, u32::MAX),
            }
        }
    }
}
