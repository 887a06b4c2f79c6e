//! The waypoint graph as the planner sees it: straight lines by heading, zones and shared resources.

mod build;
mod plan;

pub use plan::Plan;

use serde::Serialize;

use crate::kinematics::Kind;
use crate::units::{MicroTurn, Us};

/// "No waypoint", "no zone".
pub const NONE: u32 = u32::MAX;

/// The zone of closed waypoints, which is no robot's destination.
const CLOSED: u32 = u32::MAX - 1;

/// One directed way between tiers.
#[derive(Clone, Debug, Serialize)]
pub struct Ride {
    pub from: u32,
    pub to: u32,
    pub travel: Us,
}

/// An edge as seen from its end. Searches read edges in no order that a cache foresees, so they are
/// kept small.
#[derive(Clone, Copy, Debug)]
struct Behind {
    /// The waypoint where it starts, `NONE` if there is no edge.
    from: u32,
    /// Index of its length; with `MORE`, there are further edges.
    length: u32,
}

/// Marks an edge that is not the only one with its end and direction.
const MORE: u32 = 1 << 31;

/// The immutable graph.
#[derive(Clone, Debug)]
pub struct Network {
    pub nodes: usize,
    /// Distinct headings, ascending.
    pub headings: Vec<MicroTurn>,
    /// The opposite of each heading.
    opposite: Vec<Option<u8>>,
    /// Waypoint reached from `v` in direction `h`: `next[v * H + h]`.
    next: Vec<u32>,
    /// Length of that edge in metres.
    length: Vec<f64>,
    /// The first edge that reaches `v` in direction `h`, by `v * H + h`.
    before: Vec<Behind>,
    /// Further such edges, with their `v * H + h`, ascending.
    more_before: Vec<(u32, Behind)>,
    /// Distinct lengths of edges in metres, ascending.
    lengths: Vec<f64>,
    pub storage: Vec<bool>,
    /// Station whose private queue zone the waypoint belongs to, or `NONE`.
    pub zone: Vec<u32>,
    /// The same with closed waypoints as a separate zone, which determines who may enter a
    /// waypoint.
    access: Vec<u32>,
    /// Whether anybody may enter the waypoint: it is no storage location, in no queue zone, and not
    /// closed.
    open: Vec<bool>,
    /// What a robot at the waypoint occupies: the waypoint, or the shaft of its elevator.
    pub resource: Vec<u32>,
    pub resources: usize,
    pub stations: Vec<Vec<u32>>,
    /// Island of each waypoint: a part of the graph connected with others only by elevators.
    pub island: Vec<u32>,
    /// Number of waypoints of the largest island.
    pub largest_island: usize,
    rides_from: Vec<Vec<Ride>>,
    rides_to: Vec<Vec<Ride>>,
    x: Vec<f64>,
    y: Vec<f64>,
    /// Distinct coordinates, and the column and row of each waypoint.
    pub columns: Vec<f64>,
    pub rows: Vec<f64>,
    pub cells: Vec<(u32, u32)>,
    /// Whether all edges run along x or y and elevators move robots straight up or down.
    pub axis_parallel: bool,
}

impl Network {
    /// Position in metres.
    pub fn position(&self, node: u32) -> (f64, f64) {
        (self.x[node as usize], self.y[node as usize])
    }

    /// Whether a heading points along x (or against it); only if `axis_parallel`.
    pub fn along_x(&self, heading: u8) -> bool {
        self.headings[heading as usize] % 500_000 == 0
    }

    /// The opposite heading, if there is one.
    pub fn opposite(&self, heading: u8) -> Option<u8> {
        self.opposite[heading as usize]
    }

    /// Number of distinct headings.
    pub fn heading_count(&self) -> usize {
        self.headings.len()
    }

    /// Index of the pair in arrays over (waypoint, heading).
    pub fn index(&self, node: u32, heading: u8) -> usize {
        node as usize * self.headings.len() + heading as usize
    }

    /// The waypoint straight ahead and the metres to it.
    pub fn ahead(&self, node: u32, heading: u8) -> Option<(u32, f64)> {
        let index = self.index(node, heading);
        let target = self.next[index];
        (target != NONE).then(|| (target, self.length[index]))
    }

    /// Waypoints from which `node` is reached by driving in direction `heading`, and the metres.
    #[inline]
    pub fn behind(&self, node: u32, heading: u8) -> impl Iterator<Item = (u32, f64)> + '_ {
        let index = self.index(node, heading);
        let first = self.before[index];
        let more: &[_] = if first.length & MORE == 0 { &[] } else { self.others(index as u32) };
        let all = (first.from != NONE).then_some(first).into_iter();
        let edges = all.chain(more.iter().map(|&(_, edge)| edge));
        edges.map(|edge| (edge.from, self.lengths[(edge.length & !MORE) as usize]))
    }

    /// The edges of `more_before` at an index of (waypoint, heading).
    #[cold]
    fn others(&self, index: u32) -> &[(u32, Behind)] {
        let first = self.more_before.partition_point(|&(other, _)| other < index);
        let end = self.more_before.partition_point(|&(other, _)| other <= index);
        &self.more_before[first..end]
    }

    /// Whether a waypoint is a stop of an elevator.
    pub fn is_elevator(&self, node: u32) -> bool {
        !self.rides_from[node as usize].is_empty()
    }

    /// Elevator rides that start at `node`; to a closed waypoint only from a closed one.
    pub fn rides_from(&self, node: u32) -> impl Iterator<Item = &Ride> {
        self.rides_from[node as usize].iter().filter(|ride| self.may_ride(ride))
    }

    /// Elevator rides that end at `node`.
    pub fn rides_to(&self, node: u32) -> impl Iterator<Item = &Ride> {
        self.rides_to[node as usize].iter().filter(|ride| self.may_ride(ride))
    }

    /// All elevator rides that start on an island.
    pub fn rides_off(&self, island: u32) -> impl Iterator<Item = &Ride> {
        let rides = self.rides_from.iter().flatten();
        rides.filter(move |ride| self.island[ride.from as usize] == island && self.may_ride(ride))
    }

    fn may_ride(&self, ride: &Ride) -> bool {
        !self.is_closed(ride.to) || self.is_closed(ride.from)
    }

    /// Whether a robot on its way to `goal` may drive from `from` onto `to`: queue zones only if
    /// bound for their station; storage locations only if empty or if it is the goal; closed waypoints
    /// only from a closed one.
    #[inline]
    pub fn may_enter(&self, from: u32, to: u32, goal: u32, loaded: bool) -> bool {
        self.open[to as usize] || self.may_enter_restricted(from, to, goal, loaded)
    }

    fn may_enter_restricted(&self, from: u32, to: u32, goal: u32, loaded: bool) -> bool {
        let zone = self.access[to as usize];
        let private = zone != NONE
            && zone != self.access[from as usize]
            && (goal == NONE || zone == CLOSED || zone != self.access[goal as usize]);
        let blocked = loaded && self.storage[to as usize] && to != goal;
        !private && !blocked
    }

    /// Whether a waypoint is closed.
    pub fn is_closed(&self, node: u32) -> bool {
        self.access[node as usize] == CLOSED
    }

    /// Closes a waypoint, or opens it again.
    pub fn set_closed(&mut self, node: u32, closed: bool) {
        let node = node as usize;
        self.access[node] = if closed { CLOSED } else { self.zone[node] };
        self.open[node] = self.access[node] == NONE && !self.storage[node];
    }

    /// Waypoints that are closed.
    pub fn closed(&self) -> Vec<u32> {
        (0..self.nodes as u32).filter(|&node| self.is_closed(node)).collect()
    }

    /// A hash that identifies a network and the kinds of robots on it; closed waypoints are
    /// ignored.
    pub fn fingerprint(&self, kinds: &[Kind]) -> u32 {
        let numbers = |kind: &Kind| {
            let Kind { acceleration, deceleration, top_speed, full_turn, pod_transfer } = *kind;
            (acceleration, deceleration, top_speed, full_turn, pod_transfer)
        };
        let kinds: Vec<_> = kinds.iter().map(numbers).collect();
        let places = (&self.x, &self.y, &self.storage, &self.zone, &self.resource, &self.stations);
        let ways = (&self.headings, &self.next, &self.rides_from);
        let all = postcard::to_stdvec(&(places, ways, kinds)).expect("numbers can be written");
        crc32fast::hash(&all)
    }

    /// Walks the straight line from `from` (exclusive) to `to` (inclusive) with the distance covered.
    pub fn line(&self, from: u32, to: u32, heading: u8) -> impl Iterator<Item = (u32, f64)> + '_ {
        let mut here = from;
        let mut distance = 0.0;
        std::iter::from_fn(move || {
            if here == to {
                return None;
            }
            let (node, length) = self.ahead(here, heading)?;
            here = node;
            distance += length;
            Some((node, distance))
        })
    }
}
