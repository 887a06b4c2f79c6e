//! The input in whole ticks, and the places on the shortest ways.

/// No place, no robot.
pub const NONE: u32 = u32::MAX;

/// Ticks that stand for a trip that is not allowed, or a time that never comes.
pub const NEVER: i64 = 1 << 46;

/// Places kept for each way from an owner to a task. If all are taken, every place is looked at.
const KEPT: usize = 8;

/// What is given: see `rmfs.solvers.models.tasks.sequence.Ticks`, where all of it has been checked.
///
/// An *owner* of a pod is robot r, or task R + t. Tables are stored row by row.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// When each robot can begin.
    pub ready: Vec<i64>,
    /// Whether each robot carries a pod.
    pub carrying: Vec<bool>,
    /// From each robot to the pod of each task.
    pub reach: Vec<i64>,
    /// From the station of each owner to each place.
    pub store: Vec<i64>,
    /// From each place to the pod of each task.
    pub fetch: Vec<i64>,
    /// From the pod of each task to its station.
    pub bring: Vec<i64>,
    pub service: Vec<i64>,
    pub earliest: Vec<i64>,
    pub latest: Vec<i64>,
    pub due: Vec<i64>,
    pub skip: Vec<i64>,
    /// Cost of a tick of lateness.
    pub weight: i64,
}

/// The input with the best places of every way.
#[derive(Clone, Debug)]
pub struct Problem {
    pub given: Given,
    pub robots: usize,
    pub tasks: usize,
    pub places: usize,
    /// Shortest ways from an owner via a place to a task, or to the end of a route (column T).
    near: Vec<[u32; KEPT]>,
}

impl Problem {
    pub fn new(given: Given) -> Self {
        let (robots, tasks) = (given.ready.len(), given.bring.len());
        let places = given.store.len() / (robots + tasks).max(1);
        let mut made = Self { robots, tasks, places, near: Vec::new(), given };
        for owner in 0..robots + tasks {
            for next in 0..=tasks {
                let kept = made.nearest(owner, next);
                made.near.push(kept);
            }
        }
        made
    }

    /// The owner of the pod of a task.
    pub fn owner(&self, task: u32) -> usize {
        self.robots + task as usize
    }

    /// From a robot without a pod to the pod of a task.
    pub fn reach(&self, robot: usize, task: u32) -> i64 {
        self.given.reach[robot * self.tasks + task as usize]
    }

    pub fn store(&self, owner: usize, place: u32) -> i64 {
        self.given.store[owner * self.places + place as usize]
    }

    pub fn fetch(&self, place: u32, task: u32) -> i64 {
        self.given.fetch[place as usize * self.tasks + task as usize]
    }

    /// From the station of an owner via a place to the pod of the next task; without one (`NONE`),
    /// to the place. At least `NEVER` if it is not allowed.
    pub fn via(&self, owner: usize, place: u32, next: u32) -> i64 {
        let onward = if next == NONE { 0 } else { self.fetch(place, next) };
        self.store(owner, place) + onward
    }

    /// The place on the shortest way from an owner to the next task among those allowed.
    pub fn best_place(&self, owner: usize, next: u32, allowed: impl Fn(u32) -> bool) -> u32 {
        let column = if next == NONE { self.tasks } else { next as usize };
        let near = &self.near[owner * (self.tasks + 1) + column];
        for &place in near {
            if place == NONE || allowed(place) {
                return place;
            }
        }
        let others = (0..self.places as u32).filter(|&place| allowed(place));
        let way = |&place: &u32| self.via(owner, place, next);
        others.min_by_key(way).filter(|place| way(place) < NEVER).unwrap_or(NONE)
    }

    /// The places on the shortest ways, ties by number; `NONE` where there are fewer.
    fn nearest(&self, owner: usize, column: usize) -> [u32; KEPT] {
        let next = if column == self.tasks { NONE } else { column as u32 };
        let mut ways = [NEVER; KEPT];
        let mut kept = [NONE; KEPT];
        for place in 0..self.places as u32 {
            let way = self.via(owner, place, next);
            if way >= ways[KEPT - 1] {
                continue;
            }
            let rank = ways.partition_point(|&other| other <= way);
            ways.copy_within(rank..KEPT - 1, rank + 1);
            kept.copy_within(rank..KEPT - 1, rank + 1);
            (ways[rank], kept[rank]) = (way, place);
        }
        kept
    }
}
