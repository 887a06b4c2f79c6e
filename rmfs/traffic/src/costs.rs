//! Unhindered travel times: the planner's heuristic and the distances that controllers ask for.
//!
//! Exact times of the best way without traffic, from rest to rest, over states (waypoint, heading).
//! A run shorter than the way to top speed and back is one step of the search; a longer one rolls on
//! edge by edge, since every further metre takes the same time.

use std::collections::HashMap;
use std::sync::Arc;

use crate::kinematics::Kind;
use crate::network::Network;
use crate::units::Us;

/// Time that stands for "cannot be reached".
pub const UNREACHABLE: u32 = u32::MAX;

/// Microseconds from rest at (waypoint, heading) to rest at the goal, indexed as in [`Network`].
pub type Table = Arc<[u32]>;

/// Width of a bucket of the search's queue, in microseconds: about a third of an edge.
const BUCKET: u32 = 1 << 18;

/// Keeps the straight-line bound below the sum of rounded edge times.
const SAFETY: f64 = 0.999_99;

/// What is constant for one kind of robot on one network.
#[derive(Debug)]
pub struct Model {
    /// Microseconds per metre at top speed.
    pace: f64,
    /// Metres from which a run reaches top speed.
    full_speed: f64,
    /// Microseconds a run that reaches top speed takes longer than at top speed throughout.
    run_constant: f64,
    /// `2 (a + b) / (a b)`: a shorter run of `l` metres takes the root of `l` times this, in seconds.
    short_run: f64,
    /// Turning time between two headings, row-major.
    turn: Vec<u32>,
    headings: usize,
}

impl Model {
    /// Prepares the costs of one kind of robot.
    pub fn new(network: &Network, kind: &Kind) -> Self {
        let (a, b, v) = (kind.acceleration, kind.deceleration, kind.top_speed);
        let turn = network
            .headings
            .iter()
            .flat_map(|&from| network.headings.iter().map(move |&to| kind.turn(from, to) as u32))
            .collect();
        Self {
            pace: 1e6 / v,
            full_speed: kind.run_up() + kind.braking(),
            run_constant: (v / (2.0 * a) + v / (2.0 * b)) * 1e6,
            short_run: 2.0 * (a + b) / (a * b),
            turn,
            headings: network.heading_count(),
        }
    }

    fn roll(&self, length: f64) -> u32 {
        (length * self.pace) as u32
    }

    /// Time of a rest-to-rest run, rounded down.
    pub fn run(&self, length: f64) -> u32 {
        if length >= self.full_speed {
            (length * self.pace + self.run_constant) as u32
        } else {
            ((length * self.short_run).sqrt() * 1e6) as u32
        }
    }

    /// Turning time between two headings by index.
    pub fn turning(&self, from: u8, to: u8) -> u32 {
        self.turn[from as usize * self.headings + to as usize]
    }

    /// Times from every (waypoint, heading) at rest to `goal`.
    pub fn towards(&self, network: &Network, goal: u32, loaded: bool) -> Vec<u32> {
        let mut search = Backward::new(network);
        search.begin(network, self, goal, loaded, None);
        search.advance(network, self, u32::MAX);
        (0..network.nodes * self.headings).map(|index| search.best(index)).collect()
    }

    /// Times from rest at `source` (any heading) to rest at every waypoint.
    pub fn away_from(&self, network: &Network, source: u32, loaded: bool) -> Vec<u32> {
        let count = network.heading_count();
        let mut queue = Buckets::new(network.nodes * count * 2);
        queue.clear();
        for heading in 0..count {
            queue.improve((source as usize * count + heading) * 2, 0, 0);
        }
        while let Some((cost, state)) = queue.pop(u32::MAX) {
            let (node, heading) = ((state / 2 / count) as u32, (state / 2 % count) as u8);
            let ends_here = loaded && network.storage[node as usize] && node != source;
            if state % 2 == ROLLING {
                queue.improve(state - ROLLING, cost, cost);
                // any waypoint may be the goal, so only foreign queue zones stay closed
                if !ends_here
                    && let Some((next, length)) = network.ahead(node, heading)
                    && network.may_enter(node, next, next, false)
                {
                    let cost = cost + self.roll(length);
                    queue.improve(network.index(next, heading) * 2 + ROLLING, cost, cost);
                }
            } else if !ends_here {
                for towards in 0..count as u8 {
                    self.set_off(
                        network,
                        &mut queue,
                        (node, towards),
                        cost + self.turning(heading, towards),
                        loaded,
                    );
                }
                for lift in network.lifts_from(node) {
                    let cost = cost + lift.travel as u32;
                    queue.improve(network.index(lift.to, heading) * 2, cost, cost);
                }
            }
        }
        (0..network.nodes)
            .map(|v| {
                (v * count..(v + 1) * count)
                    .map(|index| queue.best(index * 2))
                    .min()
                    .unwrap_or(UNREACHABLE)
            })
            .collect()
    }

    /// Offers all short runs in one direction, and the first long one as rolling on.
    fn set_off(
        &self,
        network: &Network,
        queue: &mut Buckets,
        from: (u32, u8),
        cost: u32,
        loaded: bool,
    ) {
        let (mut here, heading) = from;
        let mut total = 0.0;
        while let Some((next, length)) = network.ahead(here, heading) {
            if !network.may_enter(here, next, next, false) {
                return;
            }
            total += length;
            let arrival = cost + self.run(total);
            if total >= self.full_speed {
                queue.improve(network.index(next, heading) * 2 + ROLLING, arrival, arrival);
                return;
            }
            queue.improve(network.index(next, heading) * 2, arrival, arrival);
            if loaded && network.storage[next as usize] {
                return;
            }
            here = next;
        }
    }
}

const ROLLING: usize = 1;

/// Least times to cover an extent along one axis: as runs, or as a part of one that is paid for.
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

/// Resumable backward search from a goal, led towards a start if there is one.
#[derive(Debug)]
pub struct Backward {
    queue: Buckets,
    headings: usize,
    goal: u32,
    loaded: bool,
    columns: Vec<Bound>,
    rows: Vec<Bound>,
    /// Times with their stamps of states that nobody comes to, so that they are only values.
    straight: Vec<(u32, u32)>,
    walk: Vec<(u32, f64)>,
}

impl Backward {
    /// Memory for searches on `network`.
    pub fn new(network: &Network) -> Self {
        let headings = network.heading_count();
        let queue = Buckets::new(network.nodes * headings * 2);
        let straight = vec![(0, UNREACHABLE); network.nodes * headings];
        Self {
            queue,
            headings,
            goal: 0,
            loaded: false,
            columns: Vec::new(),
            rows: Vec::new(),
            straight,
            walk: Vec::new(),
        }
    }

    /// Starts anew: times to `goal`, first where they matter on the way from `start`.
    pub fn begin(
        &mut self,
        network: &Network,
        model: &Model,
        goal: u32,
        loaded: bool,
        start: Option<u32>,
    ) {
        (self.goal, self.loaded) = (goal, loaded);
        self.prepare_bounds(network, model, start);
        self.queue.clear();
        for heading in 0..self.headings as u8 {
            self.queue.improve(network.index(goal, heading) * 2, 0, 0);
        }
    }

    /// The least time found so far from rest at an index of (waypoint, heading).
    fn best(&self, index: usize) -> u32 {
        let (stamp, straight) = self.straight[index];
        let turning = self.queue.best(index * 2);
        if stamp == self.queue.stamp { straight.min(turning) } else { turning }
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

    /// Prepares the bounds: a way covers its extent in x and in y, in a run each at least.
    fn prepare_bounds(&mut self, network: &Network, model: &Model, start: Option<u32>) {
        let led = start.filter(|_| network.axis_parallel);
        let bounds = |places: &[f64], at: Option<f64>, into: &mut Vec<Bound>| {
            into.clear();
            into.extend(places.iter().map(|place| match at {
                Some(at) => Bound::of(model, (place - at).abs()),
                None => Bound::default(),
            }));
        };
        let position = led.map(|node| network.position(node));
        bounds(&network.columns, position.map(|p| p.0), &mut self.columns);
        bounds(&network.rows, position.map(|p| p.1), &mut self.rows);
    }

    /// Lower bound of the time from rest at (waypoint, heading) to the goal; exact where the search
    /// has been.
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
        known.min(settled.saturating_sub(bound))
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

    /// Searches on until every state with a total time below `limit` is known.
    pub fn advance(&mut self, network: &Network, model: &Model, limit: u32) {
        while let Some((cost, state)) = self.queue.pop(limit) {
            let index = state / 2;
            let (node, heading) = ((index / self.headings) as u32, (index % self.headings) as u8);
            if state % 2 == ROLLING {
                self.roll_back(network, model, node, heading, cost);
            } else {
                self.come_from(network, model, node, heading, cost);
            }
        }
    }

    /// A run that has reached top speed started at this waypoint or before it.
    fn roll_back(&mut self, network: &Network, model: &Model, node: u32, heading: u8, cost: u32) {
        self.start_here(network, model, node, heading, cost);
        for &(from, length) in network.behind(node, heading) {
            if !self.passable(network, from, node) {
                continue;
            }
            let cost = cost + model.roll(length);
            if self.loaded && network.storage[from as usize] {
                self.start_here(network, model, from, heading, cost);
            } else {
                self.offer(network, from, heading, ROLLING, cost);
            }
        }
    }

    /// The robot stops here: short runs that end so, the first long one, and rides.
    fn come_from(&mut self, network: &Network, model: &Model, node: u32, heading: u8, cost: u32) {
        if self.loaded && network.storage[node as usize] && node != self.goal {
            return;
        }
        let mut walk = std::mem::take(&mut self.walk);
        walk.push((node, 0.0));
        while let Some((here, total)) = walk.pop() {
            for &(from, length) in network.behind(here, heading) {
                if !self.passable(network, from, here) {
                    continue;
                }
                let total = total + length;
                let started = cost + model.run(total);
                let only_start = self.loaded && network.storage[from as usize];
                if total >= model.full_speed && !only_start {
                    self.offer(network, from, heading, ROLLING, started);
                } else {
                    self.start_here(network, model, from, heading, started);
                    if !only_start {
                        walk.push((from, total));
                    }
                }
            }
        }
        self.walk = walk;
        for lift in network.lifts_to(node) {
            self.offer(network, lift.from, heading, 0, cost + lift.travel as u32);
        }
    }

    fn passable(&self, network: &Network, from: u32, to: u32) -> bool {
        network.may_enter(from, to, self.goal, self.loaded)
    }

    /// The robot is at rest with any heading, turns and starts a run of known cost.
    fn start_here(&mut self, network: &Network, model: &Model, node: u32, heading: u8, cost: u32) {
        for before in 0..self.headings as u8 {
            let cost = cost + model.turning(before, heading);
            let index = network.index(node, before);
            // nobody stops to go straight on, or arrives in a direction that no edge has
            if before != heading && !network.behind(node, before).is_empty() {
                self.offer(network, node, before, 0, cost);
            } else {
                let known = &mut self.straight[index];
                if known.0 != self.queue.stamp || cost < known.1 {
                    *known = (self.queue.stamp, cost);
                }
            }
        }
    }

    fn offer(&mut self, network: &Network, node: u32, heading: u8, rolling: usize, cost: u32) {
        let state = network.index(node, heading) * 2 + rolling;
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

/// A queue of states in buckets of their total time; improving a state again is allowed.
#[derive(Debug)]
struct Buckets {
    /// Least cost of each state, and in which search that was.
    best: Vec<(u32, u32)>,
    stamp: u32,
    buckets: Vec<Vec<(u32, u32)>>,
    at: usize,
    waiting: usize,
}

impl Buckets {
    fn new(states: usize) -> Self {
        Self {
            best: vec![(0, UNREACHABLE); states],
            stamp: 0,
            buckets: Vec::new(),
            at: 0,
            waiting: 0,
        }
    }

    fn clear(&mut self) {
        self.stamp += 1;
        let first = self.at.min(self.buckets.len());
        for bucket in &mut self.buckets[first..] {
            bucket.clear();
        }
        self.at = 0;
        self.waiting = 0;
    }

    fn best(&self, state: usize) -> u32 {
        let (stamp, cost) = self.best[state];
        if stamp == self.stamp { cost } else { UNREACHABLE }
    }

    fn improve(&mut self, state: usize, cost: u32, total: u32) {
        if cost >= self.best(state) {
            return;
        }
        self.best[state] = (self.stamp, cost);
        let bucket = ((total / BUCKET) as usize).max(self.at);
        if bucket >= self.buckets.len() {
            self.buckets.resize_with(bucket + 1, Vec::new);
        }
        self.buckets[bucket].push((cost, state as u32));
        self.waiting += 1;
    }

    /// The next state whose bucket ends at or before `limit`.
    fn pop(&mut self, limit: u32) -> Option<(u32, usize)> {
        while self.waiting > 0 && (self.at as u32).saturating_mul(BUCKET) < limit {
            while let Some((cost, state)) = self.buckets[self.at].pop() {
                self.waiting -= 1;
                if self.best(state as usize) == cost {
                    return Some((cost, state as usize));
                }
            }
            self.at += 1;
        }
        None
    }

    /// All states with a total time below this are final.
    fn settled(&self) -> u32 {
        if self.waiting == 0 { UNREACHABLE } else { (self.at as u32).saturating_mul(BUCKET) }
    }

    fn exhausted(&self) -> bool {
        self.waiting == 0
    }
}

/// Models of all kinds, and full tables for the goals that are asked for again and again.
#[derive(Debug)]
pub struct Cache {
    pub models: Vec<Model>,
    tables: HashMap<(u32, u8, bool), (Table, u64)>,
    clock: u64,
    capacity: usize,
    pub computed: u64,
}

impl Cache {
    /// A cache for at most `bytes` of tables.
    pub fn new(network: &Network, kinds: &[Kind], bytes: usize) -> Self {
        let size = network.nodes * network.heading_count() * size_of::<u32>();
        Self {
            models: kinds.iter().map(|kind| Model::new(network, kind)).collect(),
            tables: HashMap::new(),
            clock: 0,
            capacity: (bytes / size.max(1)).max(2),
            computed: 0,
        }
    }

    /// The table towards `goal`; the least recently used is dropped when the memory is full.
    pub fn towards(&mut self, network: &Network, goal: u32, kind: u8, loaded: bool) -> Table {
        self.clock += 1;
        let clock = self.clock;
        if let Some((table, used)) = self.tables.get_mut(&(goal, kind, loaded)) {
            *used = clock;
            return Arc::clone(table);
        }
        if self.tables.len() >= self.capacity {
            let oldest = self.tables.iter().min_by_key(|(_, (_, used))| *used).map(|(key, _)| *key);
            self.tables.remove(&oldest.expect("the cache is full"));
        }
        let table: Table = self.models[kind as usize].towards(network, goal, loaded).into();
        self.computed += 1;
        self.tables.insert((goal, kind, loaded), (Arc::clone(&table), clock));
        table
    }

    /// Times from rest at `source` to rest at every waypoint.
    pub fn away_from(&self, network: &Network, source: u32, kind: u8, loaded: bool) -> Vec<u32> {
        self.models[kind as usize].away_from(network, source, loaded)
    }
}

/// The time of a table entry, or `None` if the goal cannot be reached.
pub fn time(entry: u32) -> Option<Us> {
    (entry != UNREACHABLE).then(|| Us::from(entry))
}
