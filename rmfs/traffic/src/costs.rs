//! Unhindered travel times: the planner's heuristic, and the distances that controllers use.
//!
//! Exact times of the best way without traffic, from rest to rest, over states (waypoint, heading).
//! A run shorter than the way to top speed and back is one step of the search; a longer one rolls on
//! edge by edge, since every further metre takes the same time.

use std::collections::HashMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::backward::Backward;
use crate::buckets::Buckets;
use crate::kinematics::Kind;
use crate::network::Network;
use crate::patience::look_up;
use crate::units::Us;

/// Each (waypoint, heading) has two states in a search forwards: at rest (0) and rolling (1).
const ROLLING: usize = 1;

/// Time that stands for "cannot be reached".
pub const UNREACHABLE: u32 = u32::MAX;

/// Microseconds from rest at (waypoint, heading) to rest at the goal, indexed as in [`Network`].
pub type Table = Arc<[u32]>;

/// Constants of one kind of robot on one network.
#[derive(Clone, Debug)]
pub struct Model {
    /// Microseconds per metre at top speed.
    pub pace: f64,
    /// Metres from which a run reaches top speed.
    pub full_speed: f64,
    /// Additional microseconds of a run that reaches top speed, compared with top speed throughout.
    run_constant: f64,
    /// `2 (a + b) / (a b)`: a shorter run of `l` metres takes the root of `l` times this, in seconds.
    short_run: f64,
    /// Turning time between two headings, row-major: from, to.
    turn: Vec<u32>,
    /// The same by the heading to which a robot turns.
    turn_to: Vec<u32>,
    headings: usize,
}

impl Model {
    /// Prepares the costs of one kind of robot.
    pub fn new(network: &Network, kind: &Kind) -> Self {
        let (a, b, v) = (kind.acceleration, kind.deceleration, kind.top_speed);
        let pairs = || {
            let headings = &network.headings;
            headings.iter().flat_map(move |&one| headings.iter().map(move |&other| (one, other)))
        };
        let turn = pairs().map(|(from, to)| kind.turn(from, to) as u32).collect();
        let turn_to = pairs().map(|(to, from)| kind.turn(from, to) as u32).collect();
        Self {
            pace: 1e6 / v,
            full_speed: kind.run_up() + kind.braking(),
            run_constant: (v / (2.0 * a) + v / (2.0 * b)) * 1e6,
            short_run: 2.0 * (a + b) / (a * b),
            turn,
            turn_to,
            headings: network.heading_count(),
        }
    }

    /// Time at top speed, rounded down.
    pub fn roll(&self, length: f64) -> u32 {
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

    /// Turning times from every heading to one.
    pub fn turns_to(&self, to: u8) -> &[u32] {
        let first = to as usize * self.headings;
        &self.turn_to[first..first + self.headings]
    }

    /// Times from every (waypoint, heading) at rest to `goal`.
    pub fn towards(&self, network: &Network, goal: u32, loaded: bool) -> Vec<u32> {
        let mut search = Backward::new(network);
        search.begin(network, self, goal, loaded, None);
        search.advance(network, self, u32::MAX);
        let states = (0..network.nodes as u32)
            .flat_map(|node| (0..self.headings as u8).map(move |heading| (node, heading)));
        states.map(|(node, heading)| search.best(node, heading)).collect()
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
            look_up();
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
                for ride in network.rides_from(node) {
                    let cost = cost + ride.travel as u32;
                    queue.improve(network.index(ride.to, heading) * 2, cost, cost);
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

/// Key of a table: goal, kind of robot, and whether it is loaded.
type Key = (u32, u8, bool);

/// The keys of a cache's tables in the order of last use, and its counts, from which the tables can
/// be restored.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Known {
    keys: Vec<(u64, Key)>,
    clock: u64,
    computed: u64,
}

/// Models of all kinds, and full tables for goals that are requested repeatedly.
#[derive(Clone, Debug)]
pub struct Cache {
    pub models: Vec<Model>,
    /// Tables with the time of last use; missing ones are computed on request.
    tables: HashMap<Key, (Option<Table>, u64)>,
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
        let model = &self.models[kind as usize];
        if let Some((table, used)) = self.tables.get_mut(&(goal, kind, loaded)) {
            *used = clock;
            let compute = || model.towards(network, goal, loaded).into();
            return Arc::clone(table.get_or_insert_with(compute));
        }
        if self.tables.len() >= self.capacity {
            let oldest = self.tables.iter().min_by_key(|(_, (_, used))| *used).map(|(key, _)| *key);
            self.tables.remove(&oldest.expect("the cache is full"));
        }
        let table: Table = model.towards(network, goal, loaded).into();
        self.computed += 1;
        self.tables.insert((goal, kind, loaded), (Some(Arc::clone(&table)), clock));
        table
    }

    /// Returns the state from which the same tables can be restored.
    pub fn known(&self) -> Known {
        let mut keys: Vec<_> = self.tables.iter().map(|(key, (_, used))| (*used, *key)).collect();
        keys.sort_unstable();
        Known { keys, clock: self.clock, computed: self.computed }
    }

    /// Restores the tables of another cache.
    pub fn remember(&mut self, known: Known) {
        self.tables = known.keys.into_iter().map(|(used, key)| (key, (None, used))).collect();
        (self.clock, self.computed) = (known.clock, known.computed);
    }

    /// Drops all tables: the network has changed.
    pub fn forget(&mut self) {
        self.tables.clear();
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
