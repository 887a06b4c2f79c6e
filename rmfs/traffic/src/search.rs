//! Safe-interval search over stop states with whole straight runs, in continuous time.
//!
//! A state is (waypoint, heading, free interval) with the robot at rest, labelled with its earliest
//! arrival; waiting is free inside the interval. Successors are straight runs that start and end at
//! rest, and elevator rides. The set of possible departures of a run is exact: for each waypoint on
//! the way the reservations of others, shifted by the time the robot needs to get there.
//!
//! The search is led by exact unhindered times and expands labels in part: of a label's many stops
//! only those that can lie on a way not much longer than the best are looked at, the others when
//! the search comes back to it.
//!
//! Related: SIPP (Phillips, Likhachev 2011), stationary SIPP in MASS (Yan, Li 2025), free time
//! windows (ter Mors 2010).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::backward::Backward;
use crate::costs::{Model, UNREACHABLE};
use crate::kinematics::Kind;
use crate::network::{NONE, Network};
use crate::reservations::{Table, Windows};
use crate::units::{FOREVER, Us, ceil_us, floor_us};

/// One piece of a plan, from rest to rest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Move {
    pub from: u32,
    pub to: u32,
    /// Direction driven; for a ride the heading kept.
    pub heading: u8,
    /// Heading before, at rest at `from`.
    pub heading_before: u8,
    pub start: Us,
    pub end: Us,
    pub ride: bool,
}

/// What a robot wants.
#[derive(Clone, Debug)]
pub struct Query<'a> {
    pub start: u32,
    pub heading: u8,
    /// Earliest departure; the robot is at rest at `start` then.
    pub ready: Us,
    /// Where to go; `NONE`: to the nearest storage place that nobody holds.
    pub goal: u32,
    pub loaded: bool,
    pub kind: &'a Kind,
    pub model: &'a Model,
    /// Labels that may be looked at.
    pub budget: u64,
}

/// How a search ended.
#[derive(Debug, PartialEq, Eq)]
pub enum Outcome {
    Found(Vec<Move>),
    NoWay,
    OutOfBudget,
}

#[derive(Clone, Debug)]
struct Label {
    node: u32,
    heading: u8,
    ride: bool,
    dead: bool,
    /// The free interval.
    from: Us,
    until: Us,
    arrival: Us,
    departure: Us,
    parent: u32,
    /// Next label of the same (waypoint, heading).
    sibling: u32,
    /// Successors with a total time up to this have been offered.
    scanned: Us,
    scans: u32,
}

/// Weights (in quarters) and how many labels may be looked at with each: from optimal to greedy.
const STAGES: [(Us, u64); 3] = [(4, 400), (6, 2_000), (16, u64::MAX)];

/// By how much the unhindered search goes on at a time, in microseconds.
const GUIDE_STEP: u32 = 1 << 19;

/// How much later than the label's own estimate successors may arrive in its first scan.
const SLACK: Us = 500_000;

/// Reusable memory of the search and its counters.
#[derive(Debug)]
pub struct Planner {
    labels: Vec<Label>,
    /// Labels by least total time, then by least time to go.
    open: BinaryHeap<Reverse<(Us, Us, u32)>>,
    first: Vec<(u32, u32)>,
    stamp: u32,
    stable: Windows,
    windows: Windows,
    line: Vec<(u32, f64)>,
    guide: Backward,
    pub expansions: u64,
    /// Quarters by which the time to go is weighted: 4 finds the earliest arrival.
    weight: Us,
    /// Nobody reaches the goal for good before this.
    goal_free: Us,
}

impl Planner {
    /// Memory for searches on `network`.
    pub fn new(network: &Network) -> Self {
        Self {
            labels: Vec::new(),
            open: BinaryHeap::new(),
            first: vec![(0, NONE); network.nodes * network.heading_count()],
            stamp: 0,
            stable: Vec::new(),
            windows: Vec::new(),
            line: Vec::new(),
            guide: Backward::new(network),
            expansions: 0,
            weight: 4,
            goal_free: 0,
        }
    }

    /// Finds the earliest arrival at the goal that can be held forever; when that takes more than a
    /// few hundred labels, one that is early enough.
    ///
    /// The robot's own reservations must not be in `table`.
    pub fn search(&mut self, network: &Network, table: &Table, query: &Query) -> Outcome {
        for (weight, labels) in STAGES {
            self.weight = weight;
            let budget = query.budget.min(labels);
            let outcome = self.search_within(network, table, query, budget);
            if outcome != Outcome::OutOfBudget || budget == query.budget {
                return outcome;
            }
        }
        Outcome::OutOfBudget
    }

    fn search_within(
        &mut self,
        network: &Network,
        table: &Table,
        query: &Query,
        budget: u64,
    ) -> Outcome {
        self.labels.clear();
        self.open.clear();
        self.stamp += 1;
        let Some((from, until)) = table.gap_at(network.resource[query.start as usize], query.ready)
        else {
            return Outcome::NoWay;
        };
        self.goal_free = 0;
        if query.goal != NONE {
            self.goal_free =
                table.row(network.resource[query.goal as usize]).last().map_or(0, |last| last.end);
            if self.goal_free == FOREVER || !self.guide_from_start(network, query) {
                return Outcome::NoWay;
            }
        }
        self.offer(
            network,
            query,
            Label {
                node: query.start,
                heading: query.heading,
                ride: false,
                dead: false,
                from,
                until,
                arrival: query.ready,
                departure: query.ready,
                parent: NONE,
                sibling: NONE,
                scanned: -1,
                scans: 0,
            },
        );
        let mut looked = 0;
        while let Some(Reverse((estimate, _, index))) = self.open.pop() {
            let label = self.labels[index as usize].clone();
            if label.dead {
                continue;
            }
            if label.until == FOREVER && is_goal(network, query, label.node) {
                self.expansions += looked;
                return Outcome::Found(self.trace_back(index));
            }
            if estimate >= FOREVER {
                break;
            }
            looked += 1;
            if looked > budget {
                self.expansions += looked;
                return Outcome::OutOfBudget;
            }
            if let Some(sharper) = self.sharpen(network, query, &label, estimate) {
                self.open.push(Reverse((sharper, sharper - label.arrival, index)));
                continue;
            }
            let upto = estimate + (SLACK << label.scans.min(8));
            self.labels[index as usize].scanned = upto;
            self.labels[index as usize].scans += 1;
            let mut rest = FOREVER;
            for heading in 0..network.heading_count() as u8 {
                rest = rest.min(self.drive(network, table, query, index, &label, heading, upto));
            }
            if label.scans == 0 {
                self.ride(network, query, index, &label);
            }
            if rest < FOREVER {
                self.open.push(Reverse((rest, rest - label.arrival, index)));
            }
        }
        self.expansions += looked;
        Outcome::NoWay
    }

    /// Starts the unhindered search back from the goal. Returns whether there is a way at all.
    fn guide_from_start(&mut self, network: &Network, query: &Query) -> bool {
        self.guide.begin(network, query.model, query.goal, query.loaded, Some(query.start));
        while !self.guide.knows(network, query.start, query.heading) {
            let reach = self.guide.reach().saturating_add(GUIDE_STEP);
            self.guide.advance(network, query.model, reach);
        }
        self.to_go(network, query, query.start, query.heading).is_some()
    }

    /// Lower bound of the time from rest to the goal, or `None` if there is no way.
    fn to_go(&self, network: &Network, query: &Query, node: u32, heading: u8) -> Option<Us> {
        if query.goal == NONE {
            return Some(0);
        }
        let time = self.guide.to_go(network, node, heading);
        (time != UNREACHABLE).then_some(Us::from(time))
    }

    /// Total time over a label: when it is reached, and a (weighted) bound of the rest.
    fn estimate(&self, arrival: Us, to_go: Us) -> Us {
        (arrival + to_go * self.weight / 4).max(self.goal_free)
    }

    /// Time of the way just searched for if nobody else were there.
    pub fn unhindered(&self, network: &Network, query: &Query) -> Us {
        self.to_go(network, query, query.start, query.heading).unwrap_or(0)
    }

    /// Where the guide has not been yet, lets it search on until the label is known or can wait; a
    /// larger estimate comes back.
    fn sharpen(
        &mut self,
        network: &Network,
        query: &Query,
        label: &Label,
        estimate: Us,
    ) -> Option<Us> {
        if query.goal == NONE {
            return None;
        }
        while !self.guide.knows(network, label.node, label.heading) {
            let reach = self.guide.reach().saturating_add(GUIDE_STEP);
            self.guide.advance(network, query.model, reach);
            let to_go = self.to_go(network, query, label.node, label.heading);
            let sharper = to_go.map_or(FOREVER, |time| self.estimate(label.arrival, time));
            if sharper > estimate {
                return Some(sharper);
            }
        }
        None
    }

    /// Adds a label unless a known one is at least as good.
    fn offer(&mut self, network: &Network, query: &Query, mut label: Label) {
        let at = network.index(label.node, label.heading);
        let Some(to_go) = self.to_go(network, query, label.node, label.heading) else { return };
        if self.first[at].0 != self.stamp {
            self.first[at] = (self.stamp, NONE);
        }
        let mut other = self.first[at].1;
        while other != NONE {
            let known = &mut self.labels[other as usize];
            if known.from == label.from {
                if known.arrival <= label.arrival {
                    return;
                }
                known.dead = true;
            }
            other = known.sibling;
        }
        label.sibling = self.first[at].1;
        let index = self.labels.len() as u32;
        self.first[at].1 = index;
        self.open.push(Reverse((self.estimate(label.arrival, to_go), to_go, index)));
        self.labels.push(label);
    }

    /// Offers the useful stops of a straight run in one direction whose total time lies in
    /// `scanned..=upto`. Returns the least total time beyond.
    #[allow(clippy::too_many_arguments)]
    fn drive(
        &mut self,
        network: &Network,
        table: &Table,
        query: &Query,
        parent: u32,
        label: &Label,
        heading: u8,
        upto: Us,
    ) -> Us {
        let mut beyond = FOREVER;
        let ready = label.arrival + Us::from(query.model.turning(label.heading, heading));
        if ready > label.until {
            return beyond;
        }
        self.stable.clear();
        self.stable.push((ready, label.until));
        self.line.clear();
        self.line.push((label.node, 0.0));
        // how many of the line's waypoints are settled in `stable`
        let mut settled = 0;
        let mut here = label.node;
        while let Some((next, length)) = network.ahead(here, heading) {
            let ends = is_goal(network, query, next);
            if !network.may_enter(here, next, query.goal, query.loaded) && !ends {
                break;
            }
            let total = self.line[self.line.len() - 1].1 + length;
            self.line.push((next, total));
            here = next;
            if let Some(to_go) = self.to_go(network, query, next, heading) {
                let estimate = self.estimate(ready + Us::from(query.model.run(total)), to_go);
                if estimate > upto {
                    beyond = beyond.min(estimate);
                } else if estimate > label.scanned
                    && (label.until < FOREVER || useful_stop(network, table, query, next, heading))
                {
                    if !self.settle_line(network, table, query.kind, &mut settled, label.until) {
                        break;
                    }
                    self.stop(network, table, query, parent, label, heading, settled);
                }
            }
            if query.loaded && network.storage[next as usize] {
                break;
            }
        }
        beyond
    }

    /// Applies the reservations of those waypoints of the line that a robot stopping at its end
    /// passes before it brakes: they bind all longer runs too. Returns whether a departure is left.
    fn settle_line(
        &mut self,
        network: &Network,
        table: &Table,
        kind: &Kind,
        settled: &mut usize,
        until: Us,
    ) -> bool {
        let last = self.line.len() - 1;
        let total = self.line[last].1;
        if total < kind.run_up() + kind.braking() {
            return true;
        }
        let brakes_at = total - kind.braking();
        while *settled < last && self.line[*settled + 1].1 <= brakes_at {
            let leave = kind.unbraked(self.line[*settled + 1].1);
            let enter = if *settled == 0 { 0.0 } else { kind.unbraked(self.line[*settled - 1].1) };
            self.settle(network, table, *settled, enter, leave, until);
            if self.stable.is_empty() {
                return false;
            }
            *settled += 1;
        }
        true
    }

    /// Applies one waypoint's reservations to the departures shared by all longer runs.
    fn settle(
        &mut self,
        network: &Network,
        table: &Table,
        at: usize,
        enter: f64,
        leave: f64,
        until: Us,
    ) {
        if at == 0 {
            let latest = until - ceil_us(leave);
            self.stable.retain_mut(|window| {
                window.1 = window.1.min(latest);
                window.0 <= window.1
            });
        } else {
            let resource = network.resource[self.line[at].0 as usize];
            table.restrict(resource, floor_us(enter), ceil_us(leave), &mut self.stable);
        }
    }

    /// Offers a stop at the end of the line, one label per free interval there.
    #[allow(clippy::too_many_arguments)]
    fn stop(
        &mut self,
        network: &Network,
        table: &Table,
        query: &Query,
        parent: u32,
        label: &Label,
        heading: u8,
        settled: usize,
    ) {
        let last = self.line.len() - 1;
        let (node, total) = self.line[last];
        let profile = query.kind.run(total);
        self.windows.clone_from(&self.stable);
        for i in settled..last {
            let leave = ceil_us(profile.time_at(self.line[i + 1].1));
            if i == 0 {
                let latest = label.until - leave;
                self.windows.retain_mut(|window| {
                    window.1 = window.1.min(latest);
                    window.0 <= window.1
                });
            } else {
                let resource = network.resource[self.line[i].0 as usize];
                if !table.row(resource).is_empty() {
                    let enter = floor_us(profile.time_at(self.line[i - 1].1));
                    table.restrict(resource, enter, leave, &mut self.windows);
                }
            }
            if self.windows.is_empty() {
                return;
            }
        }
        let enter = floor_us(profile.time_at(self.line[last - 1].1));
        let duration = ceil_us(profile.duration());
        let earliest = self.windows[0].0;
        for (from, until) in table.gaps(network.resource[node as usize]) {
            if until < earliest + duration {
                continue;
            }
            let fits = self.windows.iter().find_map(|&(low, high)| {
                let departure = low.max(from - enter);
                (departure <= high && departure + duration <= until).then_some(departure)
            });
            if let Some(departure) = fits {
                self.offer(
                    network,
                    query,
                    Label {
                        node,
                        heading,
                        ride: false,
                        dead: false,
                        from,
                        until,
                        arrival: departure + duration,
                        departure,
                        parent,
                        sibling: NONE,
                        scanned: -1,
                        scans: 0,
                    },
                );
            }
        }
    }

    /// Offers the elevator rides from a label; the shaft stays the robot's, so the interval stays.
    fn ride(&mut self, network: &Network, query: &Query, parent: u32, label: &Label) {
        for lift in network.lifts_from(label.node) {
            let arrival = label.arrival + lift.travel;
            if arrival <= label.until {
                self.offer(
                    network,
                    query,
                    Label {
                        node: lift.to,
                        ride: true,
                        arrival,
                        departure: label.arrival,
                        parent,
                        sibling: NONE,
                        scanned: -1,
                        scans: 0,
                        ..label.clone()
                    },
                );
            }
        }
    }

    fn trace_back(&self, goal: u32) -> Vec<Move> {
        let mut moves = Vec::new();
        let mut index = goal;
        loop {
            let label = &self.labels[index as usize];
            if label.parent == NONE {
                break;
            }
            let before = &self.labels[label.parent as usize];
            moves.push(Move {
                from: before.node,
                to: label.node,
                heading: label.heading,
                heading_before: before.heading,
                start: label.departure,
                end: label.arrival,
                ride: label.ride,
            });
            index = label.parent;
        }
        moves.reverse();
        moves
    }
}

fn is_goal(network: &Network, query: &Query, node: u32) -> bool {
    if query.goal == NONE { network.storage[node as usize] } else { node == query.goal }
}

/// Whether stopping at a waypoint can pay: it is the goal, it lets the robot turn towards somewhere,
/// it is an elevator, or traffic ahead makes it a waiting place. (Where the robot cannot stay before
/// the run for good, every stop can pay.)
fn useful_stop(network: &Network, table: &Table, query: &Query, node: u32, heading: u8) -> bool {
    if is_goal(network, query, node) || !network.lifts_from(node).is_empty() {
        return true;
    }
    for other in 0..network.heading_count() as u8 {
        let Some((next, _)) = network.ahead(node, other) else { continue };
        if other == heading {
            if !table.row(network.resource[next as usize]).is_empty() {
                return true;
            }
        } else if network.may_enter(node, next, query.goal, query.loaded)
            || is_goal(network, query, next)
        {
            return true;
        }
    }
    false
}
