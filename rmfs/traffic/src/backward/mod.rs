//! Unhindered times to one goal, searched backwards and only as far as needed; with guidance, times
//! plus the extra cost of the edges driven.

mod bounds;

use std::sync::Arc;

use crate::buckets::Buckets;
use crate::costs::{Model, UNREACHABLE};
use crate::guidance::Guidance;
use crate::network::Network;
use crate::patience::look_up;

use bounds::{Bound, Turns, bounds};

/// Each (waypoint, heading) has two states, at rest and rolling; times noted for rest before going
/// straight on or back are only values, and not expanded. What is looked up together is adjacent:
/// for a waypoint, first the times of one sort for all headings, then those of the next.
const AT_REST: usize = 0;
const STRAIGHT: usize = 1;
const ROLLING: usize = 2;
const SORTS: usize = 3;

/// Extra costs add up to at most this, so that no sum exceeds the range of a time; beyond it, costs
/// are lower bounds.
const CEILING: u32 = 1 << 31;

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
    /// Bounds of the turning times from the start, if they are used.
    turns: Turns,
    counts_turns: bool,
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
        let queue = Buckets::new(network.nodes * headings * SORTS);
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
            turns: Turns::default(),
            counts_turns: false,
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
        self.counts_turns = false;
        self.columns_to_go.clear();
        self.queue.clear();
        for heading in 0..self.headings as u8 {
            self.queue.improve(self.entry(goal, AT_REST, heading), 0, 0);
        }
    }

    #[inline]
    fn entry(&self, node: u32, sort: usize, heading: u8) -> usize {
        (node as usize * SORTS + sort) * self.headings + heading as usize
    }

    /// The least time found so far from rest at (waypoint, heading).
    pub fn best(&self, node: u32, heading: u8) -> u32 {
        let entry = self.entry(node, AT_REST, heading);
        self.queue.best(entry).min(self.queue.best(entry + STRAIGHT * self.headings))
    }

    /// From now on, bounds of the time from the start include turning there from a heading and on the
    /// way, so that the search looks at fewer waypoints off the best way. To be called right after
    /// [`Backward::begin`].
    pub fn count_turns(&mut self, network: &Network, model: &Model, from: u8) {
        if let Some(start) = self.start.filter(|_| network.axis_parallel) {
            self.turns.prepare(network, model, start, from);
            self.counts_turns = true;
        }
    }

    /// A lower bound of the driving time from the start to rest at a waypoint.
    fn driving(&self, network: &Network, node: u32) -> u32 {
        let (column, row) = network.cells[node as usize];
        self.columns[column as usize].at_rest + self.rows[row as usize].at_rest
    }

    /// A lower bound of the time from the start to rest at (waypoint, heading).
    fn bound_at_rest(&self, network: &Network, node: u32, heading: u8) -> u32 {
        let turns = if self.counts_turns { self.turns.bound(network, node, heading) } else { 0 };
        self.driving(network, node) + turns
    }

    /// A lower bound of the driving time from the start to passing a waypoint in a run whose speeding
    /// up and braking is counted on the way from there to the goal.
    #[inline]
    fn bound_rolling(&self, network: &Network, node: u32, heading: u8) -> u32 {
        let (column, row) = network.cells[node as usize];
        let (column, row) = (&self.columns[column as usize], &self.rows[row as usize]);
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
        let (column, row) = network.cells[node as usize];
        self.columns_to_go[column as usize].at_rest + self.rows_to_go[row as usize].at_rest
    }

    /// Lower bound of the time from rest at (waypoint, heading) to the goal; exact where the search
    /// has been completed.
    pub fn to_go(&self, network: &Network, node: u32, heading: u8) -> u32 {
        let known = self.best(node, heading);
        let bound = self.bound_at_rest(network, node, heading);
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
        let known = self.best(node, heading);
        self.queue.exhausted()
            || (known != UNREACHABLE
                && known.saturating_add(self.bound_at_rest(network, node, heading))
                    < self.queue.settled())
    }

    /// Total time (from start to goal over a state) up to which every state is known.
    pub fn reach(&self) -> u32 {
        self.queue.settled()
    }

    /// Continues the search until every state with a total time below `limit` is known.
    pub fn advance(&mut self, network: &Network, model: &Model, limit: u32) {
        match (self.guidance.is_some(), self.counts_turns) {
            (false, false) => self.advance_to::<false, false>(network, model, limit),
            (false, true) => self.advance_to::<false, true>(network, model, limit),
            (true, false) => self.advance_to::<true, false>(network, model, limit),
            (true, true) => self.advance_to::<true, true>(network, model, limit),
        }
    }

    /// `GUIDED`: extra costs are added; `TURNS`: bounds include turning.
    fn advance_to<const GUIDED: bool, const TURNS: bool>(
        &mut self,
        network: &Network,
        model: &Model,
        limit: u32,
    ) {
        while let Some((cost, state)) = self.queue.pop(limit) {
            look_up();
            let (row, headings) = (state as u32 / self.headings as u32, self.headings as u32);
            let (node, heading) = (row / SORTS as u32, (state as u32 % headings) as u8);
            if row % SORTS as u32 == ROLLING as u32 {
                self.roll_back::<GUIDED, TURNS>(network, model, node, heading, cost);
            } else {
                self.come_from::<GUIDED, TURNS>(network, model, node, heading, cost);
            }
        }
    }

    /// A run that has reached top speed started at this waypoint or before it.
    fn roll_back<const GUIDED: bool, const TURNS: bool>(
        &mut self,
        network: &Network,
        model: &Model,
        node: u32,
        heading: u8,
        cost: u32,
    ) {
        self.start_here::<TURNS>(network, model, node, heading, cost);
        for (from, length) in network.behind(node, heading) {
            if !self.passable(network, from, node) {
                continue;
            }
            let mut cost = cost + model.roll(length);
            if GUIDED {
                cost = dearer(cost, self.extra(network, from, heading));
            }
            if self.loaded && network.storage[from as usize] {
                self.start_here::<TURNS>(network, model, from, heading, cost);
            } else {
                self.offer_rolling::<TURNS>(network, from, heading, cost);
            }
        }
    }

    /// The robot stops here: short runs that end so, the first long one, and rides.
    fn come_from<const GUIDED: bool, const TURNS: bool>(
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
            for (from, length) in network.behind(here, heading) {
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
                    self.offer_rolling::<TURNS>(network, from, heading, started);
                } else {
                    self.start_here::<TURNS>(network, model, from, heading, started);
                    if !only_start {
                        walk.push((from, total, extra));
                    }
                }
            }
        }
        self.walk = walk;
        for ride in network.rides_to(node) {
            let cost = cost + ride.travel as u32;
            let total = cost + self.bound_at_rest(network, ride.from, heading);
            self.queue.improve(self.entry(ride.from, AT_REST, heading), cost, total);
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
    fn start_here<const TURNS: bool>(
        &mut self,
        network: &Network,
        model: &Model,
        node: u32,
        heading: u8,
        cost: u32,
    ) {
        if self.queue.best(self.entry(node, STRAIGHT, heading)) <= cost {
            return; // a run like this with a lower cost, after which none of the times below is new
        }
        let back = network.opposite(heading).map(usize::from);
        let first = self.entry(node, AT_REST, 0);
        let driving = self.driving(network, node);
        for (before, &turn) in model.turns_to(heading).iter().enumerate() {
            let (entry, cost) = (first + before, cost + turn);
            let straight = before == usize::from(heading) || back == Some(before);
            if self.comes(network, node, before as u8, straight) {
                let mut total = cost + driving;
                if TURNS {
                    total += self.turns.bound(network, node, before as u8);
                }
                self.queue.improve(entry, cost, total);
            } else {
                self.queue.note(entry + STRAIGHT * self.headings, cost);
            }
        }
    }

    /// Whether a robot on a quickest way may come to rest at a waypoint with the heading `before`
    /// and continue with another: unless it comes by elevator, a robot does not stop to go
    /// `straight` on or back, nor arrive in a direction that no edge has.
    #[inline]
    fn comes(&self, network: &Network, node: u32, before: u8, straight: bool) -> bool {
        match self.arrivals[network.index(node, before)] {
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

    #[inline]
    fn offer_rolling<const TURNS: bool>(
        &mut self,
        network: &Network,
        node: u32,
        heading: u8,
        cost: u32,
    ) {
        let entry = self.entry(node, ROLLING, heading);
        if cost < self.queue.best(entry) {
            let mut total = cost + self.bound_rolling(network, node, heading);
            if TURNS {
                total += self.turns.bound(network, node, heading);
            }
            self.queue.improve(entry, cost, total);
        }
    }
}

/// A cost plus an extra cost.
#[inline]
fn dearer(cost: u32, extra: u32) -> u32 {
    if cost < CEILING { cost.saturating_add(extra).min(CEILING) } else { cost }
}

fn arrival(network: &Network, node: u32, heading: u8) -> Arrival {
    let mut before = network.behind(node, heading).peekable();
    if network.is_elevator(node) {
        Arrival::OverElevator
    } else if before.peek().is_none() {
        Arrival::Never
    } else if before.all(|(from, _)| network.storage[from as usize]) {
        Arrival::FromStorage
    } else {
        Arrival::FromAisle
    }
}
