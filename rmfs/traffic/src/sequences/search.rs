//! Neighbourhood search: tasks are taken out of the routes and inserted again where they add least
//! (ruin and recreate, Schrimpf et al. 2000); positions are passed over at random (Christiaens and
//! Vanden Berghe 2020). Slightly worse routes are accepted at first (threshold accepting, Dueck and
//! Scheuer 1990, with a threshold drawn anew for each step).

use super::plan::Plan;
use super::problem::{NEVER, NONE, Problem};
use crate::patience::look_up;
use crate::random::Random;

/// Most tasks taken out in a step.
const MOST: u64 = 6;
/// One of so many positions is passed over.
const PASSED_OVER: u64 = 20;
/// One of so many steps stores pods anew instead.
const STORES: u64 = 10;
/// How much worse routes may be at first, as a share of the mean cost of a task.
const WORSE: f64 = 0.1;
/// Parts that a threshold is drawn in.
const PARTS: u64 = 1 << 20;

/// The routes found, and the positions looked at.
pub struct Found {
    pub plan: Plan,
    pub work: u64,
}

/// Inserts the tasks that each start leaves, the most urgent first, and searches from the better
/// of these plans. The plan found costs no more. `None` without a start.
pub fn improved(problem: &Problem, starts: Vec<Plan>, steps: u64, seed: u64) -> Option<Found> {
    let mut search = Search { problem, random: Random::new(seed), work: 0, out: Vec::new() };
    let mut complete = |mut plan| {
        search.insert_left(&mut plan);
        plan
    };
    let mut plan = starts.into_iter().map(&mut complete).min_by_key(|plan| plan.total)?;
    let (mut trial, mut best) = (plan.clone(), plan.clone());
    let worse = WORSE * plan.total as f64 / problem.tasks.max(1) as f64;
    for step in 0..steps {
        look_up();
        if search.random.below(STORES) == 0 {
            search.store_anew(&mut trial);
        } else {
            search.insert_anew(&mut trial);
        }
        let threshold = worse * (steps - step) as f64 / steps as f64;
        let drawn = threshold * search.random.below(PARTS) as f64 / PARTS as f64;
        if (trial.total - plan.total) as f64 > drawn {
            trial.copy(&plan);
            continue;
        }
        plan.copy(&trial);
        if plan.total < best.total {
            best.copy(&plan);
        }
    }
    Some(Found { plan: best, work: search.work })
}

struct Search<'a> {
    problem: &'a Problem,
    random: Random,
    work: u64,
    /// Tasks to insert, or owners whose pods are stored anew.
    out: Vec<u32>,
}

impl Search<'_> {
    /// Inserts the tasks left: first those that must be done, then the most urgent.
    fn insert_left(&mut self, plan: &mut Plan) {
        let given = &self.problem.given;
        self.out.clear();
        self.out.extend(plan.left());
        self.out.sort_by_key(|&task| {
            let task = task as usize;
            (given.skip[task] < NEVER, given.due[task].min(given.latest[task]))
        });
        for at in 0..self.out.len() {
            self.insert(plan, self.out[at], false);
        }
    }

    /// Takes some tasks out and inserts them, and those left, in random order.
    fn insert_anew(&mut self, plan: &mut Plan) {
        let tasks = self.problem.tasks as u64;
        if tasks == 0 {
            return;
        }
        for _ in 0..=self.random.below(MOST) {
            let task = self.random.below(tasks) as u32;
            if plan.doer[task as usize] != NONE {
                plan.remove(self.problem, task);
            }
        }
        self.out.clear();
        self.out.extend(plan.left());
        for last in (1..self.out.len()).rev() {
            self.out.swap(last, self.random.below(last as u64 + 1) as usize);
        }
        for at in 0..self.out.len() {
            self.insert(plan, self.out[at], true);
        }
    }

    /// Inserts a task unless leaving it costs less.
    fn insert(&mut self, plan: &mut Plan, task: u32, passes: bool) {
        let limit = self.problem.given.skip[task as usize];
        let random = &mut self.random;
        let passed = || passes && random.below(PASSED_OVER) == 0;
        if let Some(found) = plan.best_insertion(self.problem, task, limit, &mut self.work, passed)
        {
            plan.apply(self.problem, task, found);
        }
    }

    /// Takes the places from some pods, and stores them anew in random order.
    fn store_anew(&mut self, plan: &mut Plan) {
        let owners = (self.problem.robots + self.problem.tasks) as u64;
        if owners == 0 {
            return;
        }
        self.out.clear();
        for _ in 0..2 + self.random.below(MOST) {
            let owner = self.random.below(owners) as u32;
            if plan.place[owner as usize] != NONE && !self.out.contains(&owner) {
                self.out.push(owner);
            }
        }
        plan.store_again(self.problem, &self.out);
    }
}
