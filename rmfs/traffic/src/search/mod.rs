//! Safe-interval search over stop states with whole straight runs, in continuous time.
//!
//! A state is (waypoint, heading, free interval) with the robot at rest, labelled with its earliest
//! arrival; waiting is free inside the interval. Successors are straight runs that start and end at
//! rest, and elevator rides. The set of possible departures of a run is exact: it excludes, for
//! each waypoint on the way, the reservations of others, shifted by the robot's travel time to it.
//!
//! The search is guided by exact unhindered times and expands labels partially: of the many stops
//! of a label, it first examines those that can lie on a way not much longer than the best, and the
//! others when it returns to the label.
//!
//! With guidance, a way has the least sum of arrival time and extra cost of its edges. Of two labels
//! of a state, the one that is earlier need not be the cheaper one then, so a label is only dropped
//! for one that is neither later nor dearer.
//!
//! Related: SIPP (Phillips, Likhachev 2011), stationary SIPP in MASS (Yan, Li 2025), free time
//! windows (ter Mors 2010).

mod elevators;
mod next;
mod pathfinder;
mod query;
mod runs;

pub use next::Stop;
pub use pathfinder::Pathfinder;
pub use query::{End, Guide, Move, Outcome, Query};

use std::cmp::Reverse;

use crate::costs::time;
use crate::network::{NONE, Network};
use crate::patience::look_up;
use crate::reservations::Table;
use crate::units::{FOREVER, Us};

#[derive(Clone, Debug)]
struct Label {
    node: u32,
    heading: u8,
    ride: bool,
    dead: bool,
    /// The free interval.
    from: Us,
    until: Us,
    /// Extra cost of the edges driven so far.
    extra: Us,
    arrival: Us,
    departure: Us,
    parent: u32,
    /// Next label of the same (waypoint, heading).
    sibling: u32,
    /// Successors with a total time up to this have been offered.
    scanned: Us,
    scans: u32,
}

/// Weights (in quarters) and the maximum number of labels with each: from optimal to greedy.
const STAGES: [(Us, u64); 3] = [(4, 400), (6, 2_000), (16, u64::MAX)];

/// Step by which the unhindered search is extended, in microseconds.
const GUIDE_STEP: u32 = 1 << 19;

/// Maximum difference between the estimates of a label and its successors in the first scan.
const SLACK: Us = 500_000;

/// Addition to the bound of a way over elevators when any good way is sufficient.
const HASTE: Us = 20_000_000;

/// Marks an entry of the open list that stands for waiting at a label until the window ends.
const STAY: u32 = 1 << 31;

/// One search; `GUIDED`: the query has guidance.
struct Search<'a, const GUIDED: bool> {
    memory: &'a mut Pathfinder,
    network: &'a Network,
    table: &'a Table,
    query: &'a Query<'a>,
    /// Quarters by which the time to go is weighted: 4 finds the earliest arrival.
    weight: Us,
    /// The goal cannot be reached to stay before this time.
    goal_free: Us,
    /// Arrivals after this are of no use.
    latest: Us,
    /// From an island that only elevators connect with the goal, it cannot be reached before this
    /// time.
    elevator_free: Us,
}

impl<'a, const GUIDED: bool> Search<'a, GUIDED> {
    fn new(
        memory: &'a mut Pathfinder,
        network: &'a Network,
        table: &'a Table,
        query: &'a Query<'a>,
        weight: Us,
    ) -> Self {
        memory.labels.clear();
        memory.open.clear();
        memory.stamp += 1;
        let goal_free = if query.goal == NONE || query.end != End::ForGood {
            0
        } else {
            table.row(network.resource[query.goal as usize]).last().map_or(0, |last| last.end)
        };
        Self { memory, network, table, query, weight, goal_free, latest: FOREVER, elevator_free: 0 }
    }

    fn run(&mut self, budget: u64) -> Outcome {
        let query = self.query;
        let start = self.network.resource[query.start as usize];
        let Some((from, until)) = self.table.gap_at(start, query.ready) else {
            return Outcome::NoWay;
        };
        if self.goal_free == FOREVER {
            return Outcome::NoWay;
        }
        if query.detour < FOREVER {
            let unhindered = self.time_to_go(query.start, query.heading).unwrap_or(0);
            self.latest = (query.ready + unhindered).max(self.goal_free) + query.detour;
        }
        if query.goal != NONE {
            // with an eye on speed, what leads to the ride at once comes first
            let haste = if self.weight > STAGES[0].0 { HASTE } else { 0 };
            self.elevator_free = match self.elevator_bound() {
                0 => 0,
                bound => bound + haste,
            };
        }
        self.offer(Label {
            node: query.start,
            heading: query.heading,
            ride: false,
            dead: false,
            from,
            until,
            extra: 0,
            arrival: query.ready,
            departure: query.ready,
            parent: NONE,
            sibling: NONE,
            scanned: -1,
            scans: 0,
        });
        for _ in 0..budget {
            look_up();
            match self.next_label() {
                None => return Outcome::NoWay,
                Some((_, index)) if index & STAY != 0 || self.is_end(index) => {
                    return Outcome::Found(self.trace_back(index & !STAY));
                }
                Some((estimate, index)) => self.look_at(index, estimate),
            }
        }
        Outcome::OutOfBudget
    }

    /// The most promising label and its estimate.
    fn next_label(&mut self) -> Option<(Us, u32)> {
        while let Some(Reverse((estimate, _, index))) = self.memory.open.pop() {
            if !self.memory.labels[(index & !STAY) as usize].dead {
                return (estimate < FOREVER).then_some((estimate, index));
            }
        }
        None
    }

    fn is_end(&self, index: u32) -> bool {
        let label = &self.memory.labels[index as usize];
        let at_goal = self.is_goal(label.node);
        let rests = |end: Us| at_goal || (label.arrival >= end && self.may_rest(label.node));
        match self.query.end {
            End::ForGood => label.until == FOREVER && at_goal,
            End::Arrival => at_goal,
            End::Window(end) => label.until >= end && rests(end),
            End::WindowForGood(end) => label.until == FOREVER && rests(end),
        }
    }

    /// Whether a window may end with the robot here: not in an elevator.
    fn may_rest(&self, node: u32) -> bool {
        !self.network.is_elevator(node)
    }

    /// When waiting at a label ends the search: the window closes while the robot stands there.
    fn waits_until(&self, label: &Label) -> Option<Us> {
        let (end, needed) = match self.query.end {
            End::Window(end) => (end, end),
            End::WindowForGood(end) => (end, FOREVER),
            End::ForGood | End::Arrival => return None,
        };
        let is_stop = self.may_rest(label.node) && !self.is_goal(label.node);
        (label.arrival < end && label.until >= needed && is_stop).then_some(end)
    }

    fn is_goal(&self, node: u32) -> bool {
        if self.query.goal == NONE {
            let has_pod = || self.query.stored[node as usize];
            self.network.storage[node as usize] && !(self.query.loaded && has_pod())
        } else {
            node == self.query.goal
        }
    }

    /// Scans a part of a label's successors, unless other labels are more promising.
    fn look_at(&mut self, index: u32, estimate: Us) {
        self.memory.expansions += 1;
        let label = self.memory.labels[index as usize].clone();
        if let Some(sharper) = self.sharpen(&label, estimate) {
            self.memory.open.push(Reverse((sharper, sharper - label.arrival, index)));
            return;
        }
        let upto = estimate + (SLACK << label.scans.min(8));
        let scanned = &mut self.memory.labels[index as usize];
        scanned.scanned = upto;
        scanned.scans += 1;
        let mut beyond = FOREVER;
        for heading in 0..self.network.heading_count() as u8 {
            beyond = self.drive(index, &label, heading, upto, beyond);
        }
        if label.scans == 0 {
            self.ride(index, &label);
        }
        if beyond < FOREVER {
            self.memory.open.push(Reverse((beyond, beyond - label.arrival, index)));
        }
    }

    /// Lower bound of the time (with guidance: plus extra cost) from rest to the goal, or `None` if
    /// there is no way.
    fn to_go(&self, node: u32, heading: u8) -> Option<Us> {
        if self.query.goal == NONE {
            return Some(0);
        }
        let entry = match self.query.times {
            Some(times) => times[self.network.index(node, heading)],
            None => self.memory.guide::<GUIDED>().to_go(self.network, node, heading),
        };
        time(entry)
    }

    /// Lower bound of the time alone.
    fn time_to_go(&self, node: u32, heading: u8) -> Option<Us> {
        if GUIDED {
            return time(self.memory.guide.to_go(self.network, node, heading));
        }
        self.to_go(node, heading)
    }

    /// Whether no way over a state, reached at `arrival`, arrives in time; `to_go` is what
    /// [`Search::to_go`] says of it.
    fn is_too_late(&self, (node, heading): (u32, u8), arrival: Us, to_go: Us) -> bool {
        if GUIDED && self.latest == FOREVER {
            return false;
        }
        let left = if GUIDED { self.time_to_go(node, heading).unwrap_or(FOREVER) } else { to_go };
        arrival + left > self.latest
    }

    /// The extra cost of driving from a waypoint to the next in a direction.
    fn extra(&self, node: u32, heading: u8) -> Us {
        let guidance = self.query.guidance.filter(|_| GUIDED);
        guidance.map_or(0, |guidance| Us::from(guidance[self.network.index(node, heading)]))
    }

    /// A lower bound of what [`Search::to_go`] says of a waypoint: straight lines, where these are
    /// used.
    fn straight_to_goal(&self, node: u32) -> Us {
        if self.query.goal == NONE || self.query.times.is_some() {
            return 0;
        }
        Us::from(self.memory.guide::<GUIDED>().straight_to_goal(self.network, node))
    }

    /// Total time over a label: the time at which it is reached plus a (weighted) bound of the
    /// rest.
    fn estimate(&self, node: u32, arrival: Us, to_go: Us) -> Us {
        let estimate = (arrival + to_go * self.weight / 4).max(self.goal_free);
        let is_before = self.elevator_free > estimate
            && self.network.island[node as usize] == self.network.island[self.query.start as usize];
        if is_before { self.elevator_free } else { estimate }
    }

    /// The same with the extra cost of the way to a label, which is left at `time`.
    fn total(&self, label: &Label, time: Us, to_go: Us) -> Us {
        self.estimate(label.node, time, to_go) + label.extra
    }

    /// If the guide does not know the label yet, extends it until the label is known or can wait;
    /// returns a larger estimate.
    fn sharpen(&mut self, label: &Label, estimate: Us) -> Option<Us> {
        if self.query.goal == NONE || self.query.times.is_some() {
            return None;
        }
        while self.memory.guide::<GUIDED>().reach() < self.memory.guided_to
            && !self.memory.guide::<GUIDED>().knows(self.network, label.node, label.heading)
        {
            let guide = self.memory.guide_mut::<GUIDED>();
            let reach = guide.reach().saturating_add(GUIDE_STEP);
            guide.advance(self.network, self.query.model, reach);
            let to_go = self.to_go(label.node, label.heading);
            let sharper = to_go.map_or(FOREVER, |time| self.total(label, label.arrival, time));
            if sharper > estimate {
                return Some(sharper);
            }
        }
        None
    }

    /// Adds a label unless a known one is at least as good.
    fn offer(&mut self, mut label: Label) {
        let Some(to_go) = self.to_go(label.node, label.heading) else { return };
        if self.is_too_late((label.node, label.heading), label.arrival, to_go) {
            return;
        }
        let estimate = self.total(&label, label.arrival, to_go);
        let stays = self.waits_until(&label).map(|end| self.total(&label, end, to_go));
        let memory = &mut *self.memory;
        let newest = &mut memory.newest[self.network.index(label.node, label.heading)];
        if newest.0 != memory.stamp {
            *newest = (memory.stamp, NONE);
        }
        let mut other = newest.1;
        while other != NONE {
            let known = &mut memory.labels[other as usize];
            if known.from == label.from {
                if known.arrival <= label.arrival && known.extra <= label.extra {
                    return;
                }
                known.dead |= known.arrival >= label.arrival && known.extra >= label.extra;
            }
            other = known.sibling;
        }
        label.sibling = newest.1;
        newest.1 = memory.labels.len() as u32;
        memory.open.push(Reverse((estimate, to_go, newest.1)));
        if let Some(estimate) = stays {
            memory.open.push(Reverse((estimate, to_go, newest.1 | STAY)));
        }
        memory.labels.push(label);
    }

    fn trace_back(&self, goal: u32) -> Vec<Move> {
        let labels = &self.memory.labels;
        let mut moves = Vec::new();
        let mut label = &labels[goal as usize];
        while label.parent != NONE {
            let before = &labels[label.parent as usize];
            moves.push(Move {
                from: before.node,
                to: label.node,
                heading: label.heading,
                heading_before: before.heading,
                start: label.departure,
                end: label.arrival,
                ride: label.ride,
                late: 0,
                begun: 0,
            });
            label = before;
        }
        moves.reverse();
        moves
    }
}
