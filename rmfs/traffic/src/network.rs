//! The waypoint graph as the planner sees it: straight lines by heading, zones and shared resources.

use serde::Serialize;

use crate::kinematics::Kind;
use crate::units::{MicroTurn, TURN, Us, heading_of};

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

/// The input for building a [`Network`]: plain arrays, one entry per waypoint.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub tier: Vec<i16>,
    pub edge_start: Vec<u32>,
    pub edge_target: Vec<u32>,
    pub storage: Vec<bool>,
    pub queue: Vec<bool>,
    /// Queue places per station, head first.
    pub stations: Vec<Vec<u32>>,
    /// Waypoints of each elevator.
    pub elevators: Vec<Vec<u32>>,
    pub rides: Vec<Ride>,
    /// Headings of robots at the start, which need not be those of an edge.
    pub extra_headings: Vec<MicroTurn>,
}

/// Maximum number of headings, which are indexed by bytes.
const MOST_HEADINGS: usize = 256;

impl Plan {
    /// Whether all arrays are consistent and refer to existing waypoints.
    fn check(&self) -> Result<(), String> {
        let nodes = self.x.len();
        let lengths = [self.y.len(), self.tier.len(), self.storage.len(), self.queue.len()];
        let starts = &self.edge_start;
        let ends_well = starts.last().is_some_and(|&end| end as usize == self.edge_target.len());
        if lengths != [nodes; 4] || starts.len() != nodes + 1 || !starts.is_sorted() || !ends_well {
            return Err("the arrays of the waypoints and edges do not fit together".into());
        }
        if let Some(station) = self.stations.iter().position(Vec::is_empty) {
            return Err(format!("station {station} has no waypoint"));
        }
        if let Some(elevator) = self.elevators.iter().position(Vec::is_empty) {
            return Err(format!("elevator {elevator} has no waypoint"));
        }
        let places = self.stations.iter().chain(&self.elevators).flatten();
        let ends = self.rides.iter().flat_map(|ride| [&ride.from, &ride.to]);
        let mut named = self.edge_target.iter().chain(places).chain(ends);
        match named.find(|&&waypoint| waypoint as usize >= nodes) {
            Some(waypoint) => Err(format!("there is no waypoint {waypoint}")),
            None => Ok(()),
        }
    }
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
    /// Builds the graph.
    ///
    /// # Errors
    /// If a waypoint has two edges in one direction.
    pub fn new(plan: Plan) -> Result<Self, String> {
        plan.check()?;
        let nodes = plan.x.len();
        let angle = |v: usize, w: usize| heading_of(plan.x[w] - plan.x[v], plan.y[w] - plan.y[v]);
        let targets = |v: usize| {
            let range = plan.edge_start[v] as usize..plan.edge_start[v + 1] as usize;
            plan.edge_target[range].iter().map(|&w| w as usize)
        };
        let mut headings = plan.extra_headings.clone();
        for v in 0..nodes {
            headings.extend(targets(v).map(|w| angle(v, w)));
        }
        headings.sort_unstable();
        headings.dedup();
        if headings.len() > MOST_HEADINGS {
            let found = headings.len();
            return Err(format!(
                "edges have {found} directions; at most {MOST_HEADINGS} are known"
            ));
        }
        let count = headings.len();
        let mut next = vec![NONE; nodes * count];
        let mut length = vec![0.0; nodes * count];
        let mut incoming: Vec<Vec<(u32, f64)>> = vec![Vec::new(); nodes * count];
        for v in 0..nodes {
            for w in targets(v) {
                let h = headings.binary_search(&angle(v, w)).expect("collected above");
                if next[v * count + h] != NONE {
                    return Err(format!("waypoint {v} has two edges in one direction"));
                }
                next[v * count + h] = w as u32;
                let metres = (plan.x[w] - plan.x[v]).hypot(plan.y[w] - plan.y[v]);
                length[v * count + h] = metres;
                incoming[w * count + h].push((v as u32, metres));
            }
        }
        let (lengths, before, more_before) = edges_behind(&incoming);
        let zone = zones(&plan, nodes);
        let island = islands(&plan, nodes);
        let axis_parallel = is_axis_parallel(&plan, &headings);
        let (columns, column) = distinct(&plan.x);
        let (rows, row) = distinct(&plan.y);
        let open = zone.iter().zip(&plan.storage).map(|(&z, &storage)| z == NONE && !storage);
        let open = open.collect();
        let (resource, resources) = shared_resources(&plan.elevators, nodes);
        let mut rides_from = vec![Vec::new(); nodes];
        let mut rides_to = vec![Vec::new(); nodes];
        for ride in plan.rides {
            rides_to[ride.to as usize].push(ride.clone());
            rides_from[ride.from as usize].push(ride);
        }
        Ok(Self {
            nodes,
            opposite: opposites(&headings),
            headings,
            next,
            length,
            before,
            more_before,
            lengths,
            storage: plan.storage,
            access: zone.clone(),
            open,
            zone,
            resource,
            resources,
            stations: plan.stations,
            island,
            rides_from,
            rides_to,
            x: plan.x,
            y: plan.y,
            columns,
            rows,
            cells: column.into_iter().zip(row).collect(),
            axis_parallel,
        })
    }

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

fn opposites(headings: &[MicroTurn]) -> Vec<Option<u8>> {
    let back = |&heading: &MicroTurn| headings.binary_search(&((heading + TURN / 2) % TURN)).ok();
    headings.iter().map(|heading| back(heading).map(|index| index as u8)).collect()
}

/// Distinct values, ascending, and the index of each value among them.
fn distinct(values: &[f64]) -> (Vec<f64>, Vec<u32>) {
    let mut known = values.to_vec();
    known.sort_by(f64::total_cmp);
    known.dedup();
    let index = values.iter().map(|v| known.partition_point(|k| k < v) as u32).collect();
    (known, index)
}

fn is_axis_parallel(plan: &Plan, headings: &[MicroTurn]) -> bool {
    let straight_up = |ride: &Ride| {
        let (from, to) = (ride.from as usize, ride.to as usize);
        (plan.x[from] - plan.x[to]).abs() + (plan.y[from] - plan.y[to]).abs() < 1e-6
    };
    plan.rides.iter().all(straight_up) && headings.iter().all(|heading| heading % 250_000 == 0)
}

/// Returns the distinct lengths of edges, the first edge of each list, and the others with the
/// index of their list.
fn edges_behind(lists: &[Vec<(u32, f64)>]) -> (Vec<f64>, Vec<Behind>, Vec<(u32, Behind)>) {
    let all: Vec<f64> = lists.iter().flatten().map(|edge| edge.1).collect();
    let (lengths, which) = distinct(&all);
    let mut which = which.into_iter();
    let mut firsts = Vec::with_capacity(lists.len());
    let mut others = Vec::new();
    for (index, list) in lists.iter().enumerate() {
        let edges = list.iter().zip(&mut which);
        let mut edges = edges.map(|(&(from, _), length)| Behind { from, length });
        let mut first = edges.next().unwrap_or(Behind { from: NONE, length: 0 });
        others.extend(edges.map(|edge| (index as u32, edge)));
        if list.len() > 1 {
            first.length |= MORE;
        }
        firsts.push(first);
    }
    (lengths, firsts, others)
}

/// Assigns each queue waypoint to the station whose queue list is nearest over queue edges.
fn zones(plan: &Plan, nodes: usize) -> Vec<u32> {
    let mut neighbours = vec![Vec::new(); nodes];
    for v in 0..nodes {
        for &w in &plan.edge_target[plan.edge_start[v] as usize..plan.edge_start[v + 1] as usize] {
            if plan.queue[v] && plan.queue[w as usize] {
                neighbours[v].push(w);
                neighbours[w as usize].push(v as u32);
            }
        }
    }
    let mut zone = vec![NONE; nodes];
    let mut shared = vec![false; nodes];
    for elevator in &plan.elevators {
        // an elevator's access is for everybody
        let mut open: Vec<u32> = elevator.clone();
        while let Some(v) = open.pop() {
            if plan.queue[v as usize] && !std::mem::replace(&mut shared[v as usize], true) {
                open.extend_from_slice(&neighbours[v as usize]);
            }
        }
    }
    let mut front: std::collections::VecDeque<u32> = std::collections::VecDeque::new();
    for (station, places) in plan.stations.iter().enumerate() {
        for &v in places {
            if plan.queue[v as usize] && !shared[v as usize] && zone[v as usize] == NONE {
                zone[v as usize] = station as u32;
                front.push_back(v);
            }
        }
    }
    while let Some(v) = front.pop_front() {
        for &w in &neighbours[v as usize] {
            if zone[w as usize] == NONE {
                zone[w as usize] = zone[v as usize];
                front.push_back(w);
            }
        }
    }
    zone
}

/// Connected parts of the graph without elevators, each named by its first waypoint.
fn islands(plan: &Plan, nodes: usize) -> Vec<u32> {
    let mut neighbours = vec![Vec::new(); nodes];
    for v in 0..nodes {
        for &w in &plan.edge_target[plan.edge_start[v] as usize..plan.edge_start[v + 1] as usize] {
            neighbours[v].push(w);
            neighbours[w as usize].push(v as u32);
        }
    }
    let mut island = vec![NONE; nodes];
    for first in 0..nodes as u32 {
        let mut open = vec![first];
        while let Some(v) = open.pop() {
            if island[v as usize] == NONE {
                island[v as usize] = first;
                open.extend_from_slice(&neighbours[v as usize]);
            }
        }
    }
    island
}

/// All waypoints of an elevator are one resource: its shaft holds one robot.
fn shared_resources(elevators: &[Vec<u32>], nodes: usize) -> (Vec<u32>, usize) {
    let mut resource: Vec<u32> = (0..nodes as u32).collect();
    for waypoints in elevators {
        for &v in waypoints {
            resource[v as usize] = waypoints[0];
        }
    }
    (resource, nodes)
}
