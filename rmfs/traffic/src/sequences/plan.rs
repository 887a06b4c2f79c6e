//! Routes of all robots with their places and costs.

use super::problem::{NEVER, NONE, Problem};

/// Where a robot is on its route: ready to leave with the pod of an owner, or to begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stop {
    pub time: i64,
    /// Driving and lateness so far.
    pub cost: i64,
}

/// Routes of all robots.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The tasks of each robot in sequence.
    pub tasks: Vec<Vec<u32>>,
    /// Where the pod of each owner is stored.
    pub place: Vec<u32>,
    /// The robot of each task.
    pub doer: Vec<u32>,
    /// Whether each place is free.
    pub free: Vec<bool>,
    /// Before the first task of each robot, and after the service of each task.
    pub stops: Vec<Vec<Stop>>,
    /// Cost of each route, at least `NEVER` if it is not allowed.
    pub cost: Vec<i64>,
    /// Cost of all routes and of all tasks left.
    pub total: i64,
}

impl Plan {
    /// Given routes.
    pub fn new(problem: &Problem, tasks: Vec<Vec<u32>>, place: Vec<u32>) -> Self {
        let robots = problem.robots;
        let mut plan = Self {
            doer: vec![NONE; problem.tasks],
            free: vec![true; problem.places],
            stops: vec![Vec::new(); robots],
            cost: vec![0; robots],
            total: problem.given.skip.iter().sum(),
            tasks,
            place,
        };
        for &place in plan.place.iter().filter(|&&place| place != NONE) {
            plan.free[place as usize] = false;
        }
        for robot in 0..robots {
            for &task in &plan.tasks[robot] {
                plan.doer[task as usize] = robot as u32;
                plan.total -= problem.given.skip[task as usize];
            }
            plan.follow(problem, robot, 0);
        }
        plan
    }

    /// Becomes like another plan; takes no new memory as a rule.
    pub fn copy(&mut self, other: &Self) {
        self.tasks.clone_from(&other.tasks);
        self.stops.clone_from(&other.stops);
        self.place.copy_from_slice(&other.place);
        self.doer.copy_from_slice(&other.doer);
        self.free.copy_from_slice(&other.free);
        self.cost.copy_from_slice(&other.cost);
        self.total = other.total;
    }

    /// The tasks of no robot.
    pub fn left(&self) -> impl Iterator<Item = u32> {
        let doers = (0..).zip(&self.doer);
        doers.filter(|(_, doer)| **doer == NONE).map(|(task, _)| task)
    }

    /// Whose pod a robot has before its task of this number: `None` if it has none.
    pub fn before(&self, problem: &Problem, robot: usize, position: usize) -> Option<usize> {
        match position {
            0 => problem.given.carrying[robot].then_some(robot),
            _ => Some(problem.owner(self.tasks[robot][position - 1])),
        }
    }

    /// The task of this number of a robot, or `NONE`.
    pub fn after(&self, robot: usize, position: usize) -> u32 {
        self.tasks[robot].get(position).copied().unwrap_or(NONE)
    }

    /// Stores the pod of an owner elsewhere, or nowhere.
    pub fn set_place(&mut self, owner: usize, place: u32) {
        let before = std::mem::replace(&mut self.place[owner], place);
        if before != NONE {
            self.free[before as usize] = true;
        }
        if place != NONE {
            self.free[place as usize] = false;
        }
    }

    /// Stores the pod of an owner where the way to the next task is shortest.
    pub fn place_again(&mut self, problem: &Problem, owner: usize, next: u32) {
        let now = self.place[owner];
        let free = &self.free;
        let best = problem.best_place(owner, next, |place| free[place as usize] || place == now);
        if best != NONE {
            self.set_place(owner, best);
        }
    }

    /// Stores the pods of some owners anew, one after another, as if none of them had a place.
    /// Nothing changes if one of them finds none.
    pub fn store_again(&mut self, problem: &Problem, owners: &[u32]) {
        let before: Vec<u32> = owners.iter().map(|&owner| self.place[owner as usize]).collect();
        self.take_places(owners);
        for &owner in owners {
            let (robot, position) = self.stop_of(problem, owner as usize);
            let next = self.after(robot, position);
            let free = &self.free;
            let place = problem.best_place(owner as usize, next, |place| free[place as usize]);
            self.set_place(owner as usize, place);
        }
        if owners.iter().any(|&owner| self.place[owner as usize] == NONE) {
            self.take_places(owners);
            for (&owner, &place) in owners.iter().zip(&before) {
                self.set_place(owner as usize, place);
            }
            return;
        }
        for &owner in owners {
            let (robot, position) = self.stop_of(problem, owner as usize);
            self.follow(problem, robot, position);
        }
    }

    fn take_places(&mut self, owners: &[u32]) {
        for &owner in owners {
            self.set_place(owner as usize, NONE);
        }
    }

    /// The robot that stores the pod of an owner, and the number of its next task.
    fn stop_of(&self, problem: &Problem, owner: usize) -> (usize, usize) {
        if owner < problem.robots {
            return (owner, 0);
        }
        let task = (owner - problem.robots) as u32;
        let robot = self.doer[task as usize] as usize;
        let position = self.tasks[robot].iter().position(|&one| one == task);
        (robot, position.map_or(0, |position| position + 1))
    }

    /// Takes a task out of its route; the pod before it is stored anew.
    pub fn remove(&mut self, problem: &Problem, task: u32) {
        let robot = self.doer[task as usize] as usize;
        let Some(position) = self.tasks[robot].iter().position(|&one| one == task) else { return };
        self.tasks[robot].remove(position);
        self.doer[task as usize] = NONE;
        self.set_place(problem.owner(task), NONE);
        self.total += problem.given.skip[task as usize];
        if let Some(owner) = self.before(problem, robot, position) {
            self.place_again(problem, owner, self.after(robot, position));
        }
        self.follow(problem, robot, position);
    }

    /// Drives a route anew from the stop of a number on.
    pub fn follow(&mut self, problem: &Problem, robot: usize, from: usize) {
        self.total -= self.cost[robot];
        let stops = &mut self.stops[robot];
        stops.truncate(from + 1);
        if stops.is_empty() {
            stops.push(Stop { time: problem.given.ready[robot], cost: 0 });
        }
        for position in from..self.tasks[robot].len() {
            let owner = self.before(problem, robot, position);
            let way = |task| match owner {
                Some(owner) => problem.via(owner, self.place[owner], task),
                None => problem.reach(robot, task),
            };
            let task = self.tasks[robot][position];
            let last = self.stops[robot][position];
            self.stops[robot].push(served(problem, last, way(task), task));
        }
        let count = self.tasks[robot].len();
        let ends = self.before(problem, robot, count);
        let home = ends.map_or(0, |owner| problem.store(owner, self.place[owner]));
        let cost = self.stops[robot][count].cost;
        self.cost[robot] = allowed(cost.saturating_add(home));
        self.total += self.cost[robot];
    }
}

/// The stop after a task, reached from the last stop by a way to its pod.
pub fn served(problem: &Problem, last: Stop, way: i64, task: u32) -> Stop {
    let (given, task) = (&problem.given, task as usize);
    let way = way + given.bring[task];
    let arrive = (last.time + way).max(given.earliest[task]);
    if way >= NEVER || arrive > given.latest[task] {
        return Stop { time: arrive.min(NEVER), cost: NEVER };
    }
    let late = given.weight.saturating_mul((arrive - given.due[task]).max(0));
    let cost = last.cost.saturating_add(way).saturating_add(late);
    Stop { time: arrive + given.service[task], cost: allowed(cost) }
}

/// A cost, or `NEVER` if it is more.
pub fn allowed(cost: i64) -> i64 {
    cost.min(NEVER)
}
