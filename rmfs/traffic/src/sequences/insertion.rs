//! Where a task adds least to the routes.
//!
//! An insertion stores two pods anew: the one before the task, on the way to it, and that of the
//! task, on the way to the next.

use super::plan::{Plan, allowed, served};
use super::problem::{NEVER, NONE, Problem};

/// A task put into a route.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Insertion {
    pub robot: usize,
    pub position: usize,
    /// Where the pod before the task is stored, `NONE` if there is none.
    pub before_place: u32,
    /// Where the pod of the task is stored.
    pub place: u32,
    /// What it adds to driving and lateness.
    pub added: i64,
}

impl Plan {
    /// The insertion that adds least, if any adds less than a limit; ties go to the first.
    ///
    /// Positions may be passed over by `skips`. `work` counts those looked at.
    pub fn best_insertion(
        &self,
        problem: &Problem,
        task: u32,
        limit: i64,
        work: &mut u64,
        mut skips: impl FnMut() -> bool,
    ) -> Option<Insertion> {
        let (mut best, mut least) = (None, limit);
        for robot in 0..problem.robots {
            for position in 0..=self.tasks[robot].len() {
                *work += 1;
                if skips() {
                    continue;
                }
                if let Some(found) = self.insertion(problem, task, robot, position, least) {
                    (best, least) = (Some(found), found.added);
                }
            }
        }
        best
    }

    /// Puts a task in at a position, if that adds less than a limit.
    fn insertion(
        &self,
        problem: &Problem,
        task: u32,
        robot: usize,
        position: usize,
        limit: i64,
    ) -> Option<Insertion> {
        let next = self.after(robot, position);
        let (way, before, before_place) = match self.before(problem, robot, position) {
            None => (problem.reach(robot, task), NONE, NONE),
            Some(owner) => {
                let now = self.place[owner];
                let may = |place: u32| self.free[place as usize] || place == now;
                let place = problem.best_place(owner, task, may);
                if place == NONE {
                    return None;
                }
                (problem.via(owner, place, task), now, place)
            }
        };
        let stop = served(problem, self.stops[robot][position], way, task);
        if stop.cost >= NEVER {
            return None;
        }
        let owner = problem.owner(task);
        let may =
            |place: u32| place != before_place && (self.free[place as usize] || place == before);
        let place = problem.best_place(owner, next, may);
        if place == NONE {
            return None;
        }
        let most = self.cost[robot].saturating_add(limit);
        let mut onward = problem.via(owner, place, next);
        let mut last = stop;
        for (at, &one) in self.tasks[robot].iter().enumerate().skip(position) {
            last = served(problem, last, onward, one);
            if last.cost >= most {
                return None;
            }
            let after = self.after(robot, at + 1);
            let owner = problem.owner(one);
            onward = problem.via(owner, self.place[owner], after);
        }
        let cost = allowed(last.cost.saturating_add(onward));
        let added = cost - self.cost[robot];
        let found = Insertion { robot, position, before_place, place, added };
        (cost < NEVER && added < limit).then_some(found)
    }

    /// Carries out an insertion.
    pub fn apply(&mut self, problem: &Problem, task: u32, found: Insertion) {
        let Insertion { robot, position, .. } = found;
        if let Some(owner) = self.before(problem, robot, position) {
            self.set_place(owner, found.before_place);
        }
        self.set_place(problem.owner(task), found.place);
        self.tasks[robot].insert(position, task);
        self.doer[task as usize] = robot as u32;
        self.total -= problem.given.skip[task as usize];
        self.follow(problem, robot, position);
    }
}
