//! Unhindered times to one goal, searched backwards and only as far as needed; with guidance, times
//! plus the extra cost of the edges driven.

use std::sync::Arc;

use crate::buckets::Buckets;
use crate::costs::{Model, UNREACHABLE};
use crate::guidance::Guidance;
use crate::network::Network;
use crate::patience::look_up;

/// Keeps the bound from the start below the sum of rounded edge times.
const SAFETY: f64 = 0.999_99;

/// Each (waypoint, heading) has two states: at rest (0) and rolling (1).
pub const ROLLING: usize = 1;

/// Times of states that are not expanded; they are only values.
const STRAIGHT: usize = 2;

/// Entries of an index of (waypoint, heading), which are looked up together.
const ENTRIES: usize = 4;

/// Extra costs add up to at most this, so that no sum exceeds the range of a time; beyond it, costs
/// are lower bounds.
const CEILING: u32 = 1 << 31;

/// Least times to cover an extent along one axis: as whole runs, or as part of a run already
/// counted.
#[derive(Clone, Copy, Debug, Default)]
struct Bound {
    at_rest: u32,
    rolling: u32,
}

impl Bound {
    fn of(model: &Model, metres: f64) -> Self {
        let safe = |time: u32| (f64::from(time) * SAFETY) as u32;
        Self { at_rest: safe(model.run(metres)), rolling: safe(model.roll(metres)) }
    }
}

/// How robots can come to rest at a waypoint with a heading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Arrival {
    /// Not by driving.
    Never,
    /// From storage locations only: loaded robots on the first run of their way.
    FromStorage,
    FromAisle,
    /// Perhaps by elevator.
    OverElevator,
}

/// Resumable backward search from a goal, guided towards a start if there is one.
#[derive(Clone, Debug)]
pub struct Backward {
    queue: Buckets,
    headings: usize,
    goal: u32,
    loaded: bool,
    start: Option<u32>,
    /// Extra costs of edges, if the search counts them.
    guidance: Option<Guidance>,
    /// How robots come to rest at an index of (waypoint, heading).
    arrivals: Vec<Arrival>,
    columns: Vec<Bound>,
    rows: Vec<Bound>,
    /// Lower bounds of the time to the goal by column and by row; empty if not used.
    columns_to_go: Vec<Bound>,
    rows_to_go: Vec<Bound>,
    /// Waypoint, metres and extra cost from there to the end of the run.
    walk: Vec<(u32, f64, u32)>,
}

impl Backward {
    /// Memory for searches on `network`.
    pub fn new(network: &Network) -> Self {
        let headings = network.heading_count();
        let queue = Buckets::new(network.nodes * headings * ENTRIES);
        let arrivals = (0..network.nodes as u32)
            .flat_map(|node| {
                (0..headings as u8).map(move |heading| arrival(network, node, heading))
            })
            .collect();
        Self {
            queue,
            headings,
            goal: 0,
            loaded: false,
            start: None,
            guidance: None,
            arrivals,
            columns: Vec::new(),
            rows: Vec::new(),
            columns_to_go: Vec::new(),
            rows_to_go: Vec::new(),
            walk: Vec::new(),
        }
    }

    /// Memory for searches that add the extra costs of guidance to times.
    pub fn guided(network: &Network, guidance: Guidance) -> Self {
        Self { guidance: Some(guidance), ..Self::new(network) }
    }

    /// Whether the search adds the extra costs of this guidance.
    pub fn is_guided_by(&self, guidance: &Guidance) -> bool {
        self.guidance.as_ref().is_some_and(|own| Arc::ptr_eq(own, guidance))
    }

    /// Starts a new search for times to `goal`, first those that matter on the way from `start`.
    pub fn begin(
        &mut self,
        network: &Network,
        model: &Model,
        goal: u32,
        loaded: bool,
        start: Option<u32>,
    ) {
        (self.goal, self.loaded, self.start) = (goal, loaded, start);
        let led = start.filter(|_| network.axis_parallel);
        bounds(network, model, led, &mut self.columns, &mut self.rows);
        self.columns_to_go.clear();
        self.queue.clear();
        for heading in 0..self.headings as u8 {
            self.queue.improve(network.index(goal, heading) * ENTRIES, 0, 0);
        }
    }

    /// The least time found so far from rest at an index of (waypoint, heading).
    pub fn best(&self, index: usize) -> u32 {
        let entry = index * ENTRIES;
        self.queue.best(entry).min(self.queue.best(entry + STRAIGHT))
    }

    /// A lower bound of the time from the start to rest at a waypoint.
    fn bound_at_rest(&self, network: &Network, node: u32) -> u32 {
        let (column, row) = (network.column[node as usize], network.row[node as usize]);
        self.columns[column as usize].at_rest + self.rows[row as usize].at_rest
    }

    /// A lower bound of the time from the start to passing a waypoint in a run whose speeding up and
    /// braking is counted on the way from there to the goal.
    fn bound_rolling(&self, network: &Network, node: u32, heading: u8) -> u32 {
        let column = &self.columns[network.column[node as usize] as usize];
        let row = &self.rows[network.row[node as usize] as usize];
        if network.along_x(heading) {
            column.rolling + row.at_rest
        } else {
            column.at_rest + row.rolling
        }
    }

    /// Also bounds unknown times by straight lines to the goal. Returns whether that is possible.
    pub fn bound_to_goal(&mut self, network: &Network, model: &Model) -> bool {
        if network.axis_parallel {
            let (columns, rows) = (&mut self.columns_to_go, &mut self.rows_to_go);
            bounds(network, model, Some(self.goal), columns, rows);
        }
        network.axis_parallel
    }

    /// The least time in which straight lines lead from a waypoint to the goal, if that is used.
    pub fn straight_to_goal(&self, network: &Network, node: u32) -> u32 {
        if self.columns_to_go.is_empty() {
            return 0;
        }
        let (column, row) = (network.column[node as usize], network.row[node as usize]);
        self.columns_to_go[column as usize].at_rest + self.rows_to_go[row as usize].at_rest
    }

    /// Lower bound of the time from rest at (waypoint, heading) to the goal; exact where the search
    /// has been completed.
    pub fn to_go(&self, network: &Network, node: u32, heading: u8) -> u32 {
        let known = self.best(network.index(node, heading));
        let bound = self.bound_at_rest(network, node);
        let settled = self.queue.settled();
        if known != UNREACHABLE && known.saturating_add(bound) < settled {
            return known;
        }
        if self.queue.exhausted() {
            return known;
        }
        known.min(settled.saturating_sub(bound).max(self.straight_to_goal(network, node)))
    }

    /// Whether [`Backward::to_go`] cannot get any better for this state.
    pub fn knows(&self, network: &Network, node: u32, heading: u8) -> bool {
        let known = self.best(network.index(node, heading));
        self.queue.exhausted()
            || (known != UNREACHABLE
                && known.saturating_add(self.bound_at_rest(network, node)) < self.queue.settled())
    }

    /// Total time (from start to goal over a state) up to which every state is known.
    pub fn reach(&self) -> u32 {
        self.queue.settled()
    }

    /// Continues the search until every state with a total time below `limit` is known.
    pub fn advance(&mut self, network: &Network, model: &Model, limit: u32) {
        if self.guidance.is_some() {
            self.advance_to::<true>(network, model, limit);
        } else {
            self.advance_to::<false>(network, model, limit);
        }
    }

    fn advance_to<const GUIDED: bool>(&mut self, network: &Network, model: &Model, limit: u32) {
        while let Some((cost, state)) = self.queue.pop(limit) {
            look_up();
            let (index, headings) = ((state / ENTRIES) as u32, self.headings as u32);
            let (node, heading) = (index / headings, (index % headings) as u8);
            if state % ENTRIES == ROLLING {
                self.roll_back::<GUIDED>(network, model, node, heading, cost);
            } else {
                self.come_from::<GUIDED>(network, model, node, heading, cost);
            }
        }
    }

    /// A run that has reached top speed started at this waypoint or before it.
    fn roll_back<const GUIDED: bool>(
        &mut self,
        network: &Network,
        model: &Model,
        node: u32,
        heading: u8,
        cost: u32,
    ) {
        self.start_here(network, model, node, heading, cost);
        for &(from, length) in network.behind(node, heading) {
            if !self.passable(network, from, node) {
                continue;
            }
            let mut cost = cost + model.roll(length);
            if GUIDED {
                cost = dearer(cost, self.extra(network, from, heading));
            }
            if self.loaded && network.storage[from as usize] {
                self.start_here(network, model, from, heading, cost);
            } else {
                self.offer(network, from, heading, ROLLING, cost);
            }
        }
    }

    /// The robot stops here: short runs that end so, the first long one, and rides.
    fn come_from<const GUIDED: bool>(
        &mut self,
        network: &Network,
        model: &Model,
        node: u32,
        heading: u8,
        cost: u32,
    ) {
        if self.loaded && network.storage[node as usize] && node != self.goal {
            return;
        }
        let mut walk = std::mem::take(&mut self.walk);
        walk.push((node, 0.0, 0));
        while let Some((here, total, extra)) = walk.pop() {
            for &(from, length) in network.behind(here, heading) {
                if !self.passable(network, from, here) {
                    continue;
                }
                let total = total + length;
                let mut extra = extra;
                let mut started = cost + model.run(total);
                if GUIDED {
                    extra = u32::saturating_add(extra, self.extra(network, from, heading));
                    started = dearer(started, extra);
                }
                let only_start = self.loaded && network.storage[from as usize];
                if total >= model.full_speed && !only_start {
                    self.offer(network, from, heading, ROLLING, started);
                } else {
                    self.start_here(network, model, from, heading, started);
                    if !only_start {
                        walk.push((from, total, extra));
                    }
                }
            }
        }
        self.walk = walk;
        for ride in network.rides_to(node) {
            self.offer(network, ride.from, heading, 0, cost + ride.travel as u32);
        }
    }

    /// The extra cost of driving from a waypoint to the next in a direction.
    #[inline]
    fn extra(&self, network: &Network, from: u32, heading: u8) -> u32 {
        self.guidance.as_ref().map_or(0, |guidance| guidance[network.index(from, heading)])
    }

    fn passable(&self, network: &Network, from: u32, to: u32) -> bool {
        network.may_enter(from, to, self.goal, self.loaded)
    }

    /// The robot is at rest with any heading, turns and starts a run of known cost.
    fn start_here(&mut self, network: &Network, model: &Model, node: u32, heading: u8, cost: u32) {
        let first = network.index(node, 0);
        let same = first + heading as usize;
        if self.queue.best(same * ENTRIES + STRAIGHT) <= cost {
            return; // a run like this with a lower cost, after which none of the times below is new
        }
        let back = network.opposite(heading).map(usize::from);
        let bound = self.bound_at_rest(network, node);
        for (before, &turn) in model.turns_to(heading).iter().enumerate() {
            let (index, cost) = (first + before, cost + turn);
            let straight = before == usize::from(heading) || back == Some(before);
            if self.comes(network, node, index, before as u8, straight) {
                self.queue.improve(index * ENTRIES, cost, cost + bound);
            } else {
                self.queue.note(index * ENTRIES + STRAIGHT, cost);
            }
        }
    }

    /// Whether a robot on a quickest way may come to rest at a waypoint with the heading `before`
    /// and continue with another: unless it comes by elevator, a robot does not stop to go
    /// `straight` on or back, nor arrive in a direction that no edge has. `index` is that of
    /// (waypoint, heading).
    #[inline]
    fn comes(
        &self,
        network: &Network,
        node: u32,
        index: usize,
        before: u8,
        straight: bool,
    ) -> bool {
        match self.arrivals[index] {
            Arrival::Never => false,
            Arrival::OverElevator => true,
            _ if straight => false,
            Arrival::FromAisle => true,
            Arrival::FromStorage => {
                // a loaded robot leaves no storage location but the one where it starts
                let start = self.start.filter(|_| self.loaded);
                start.is_none_or(|start| {
                    network.ahead(start, before).is_some_and(|(next, _)| next == node)
                })
            }
        }
    }

    fn offer(&mut self, network: &Network, node: u32, heading: u8, rolling: usize, cost: u32) {
        let state = network.index(node, heading) * ENTRIES + rolling;
        if cost < self.queue.best(state) {
            let bound = if rolling == ROLLING {
                self.bound_rolling(network, node, heading)
            } else {
                self.bound_at_rest(network, node)
            };
            let total = cost + bound;
            self.queue.improve(state, cost, total);
        }
    }
}

/// A cost plus an extra cost.
#[inline]
fn dearer(cost: u32, extra: u32) -> u32 {
    if cost < CEILING { cost.saturating_add(extra).min(CEILING) } else { cost }
}

/// Prepares bounds of the times from a waypoint: a way covers its extent in x and in y by at least
/// one run each. Without a waypoint they are 0.
fn bounds(
    network: &Network,
    model: &Model,
    from: Option<u32>,
    columns: &mut Vec<Bound>,
    rows: &mut Vec<Bound>,
) {
    let position = from.map(|node| network.position(node));
    let along = |places: &[f64], at: Option<f64>, into: &mut Vec<Bound>| {
        into.clear();
        into.extend(places.iter().map(|place| match at {
            Some(at) => Bound::of(model, (place - at).abs()),
            None => Bound::default(),
        }));
    };
    along(&network.columns, position.map(|p| p.0), columns);
    along(&network.rows, position.map(|p| p.1), rows);
}

fn arrival(network: &Network, node: u32, heading: u8) -> Arrival {
    let before = network.behind(node, heading);
    if network.is_elevator(node) {
        Arrival::OverElevator
    } else if before.is_empty() {
        Arrival::Never
    } else if before.iter().all(|&(from, _)| network.storage[from as usize]) {
        Arrival::FromStorage
    } else {
        Arrival::FromAisle
    }
}
