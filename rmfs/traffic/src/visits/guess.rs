//! Pods for a visit, drawn among those that serve something and chosen by a quick estimate.

use super::draft::{Draft, Saved};
use super::filling::Filling;
use super::problem::{NONE, Problem, has, lines_in, put};
use crate::random::Random;

/// Share of its worth at which a line counts whose order lacks other lines at the station.
const PARTLY: f64 = 0.35;
/// Pods that are drawn for each visit.
const DRAWS: usize = 16;

/// Estimates what pods would serve; keeps the tables it needs for that.
pub struct Guess {
    /// Worth of a line with its share of that of its order.
    worth: Vec<f64>,
    /// Lines to be served, as a set, and as a list.
    open: Vec<u64>,
    list: Vec<u32>,
    /// Lines that the other visits of the station could serve, as a set.
    at_hand: Vec<u64>,
    /// Units given to lines, per SKU; 0 in between.
    given: Vec<i64>,
    /// Pods that make a new visit.
    comes: Vec<bool>,
}

impl Guess {
    pub fn new(problem: &Problem, draft: &Draft) -> Self {
        let mut comes = vec![false; problem.pods];
        for &pod in draft.at.iter().flat_map(|at| &at.pods) {
            comes[pod as usize] = true;
        }
        let given = &problem.given;
        let share = |order: u32| {
            given.order_worth[order as usize] / problem.lines_of[order as usize].len() as f64
        };
        Self {
            worth: given.lines.iter().map(|line| line.worth + share(line.order)).collect(),
            open: vec![0; problem.words],
            list: Vec::new(),
            at_hand: vec![0; problem.words],
            given: vec![0; given.skus],
            comes,
        }
    }

    /// Mean worth of a line with its share of that of its order; 0 of none.
    pub fn mean_worth(&self) -> f64 {
        self.worth.iter().sum::<f64>() / self.worth.len().max(1) as f64
    }

    /// Updates the tables after a change of stations.
    pub fn changed(&mut self, before: &Saved, draft: &Draft, stations: &[usize]) {
        for pod in before.pods() {
            self.comes[pod as usize] = false;
        }
        for &pod in stations.iter().flat_map(|&station| &draft.at[station].pods) {
            self.comes[pod as usize] = true;
        }
    }

    /// Draws pods and returns the most promising one; `None` if none of them can come.
    ///
    /// `gone` is the new visit, counted from 0, that the pod is to replace, if any.
    pub fn pod(
        &mut self,
        filling: &mut Filling,
        draft: &Draft,
        station: usize,
        gone: Option<usize>,
        random: &mut Random,
    ) -> Option<u32> {
        let problem = filling.problem;
        self.look(problem, draft, station, gone);
        filling.work += (problem.words * (2 + problem.longest) + self.list.len()) as u64;
        let mut best: Option<(f64, u32)> = None;
        for _ in 0..DRAWS {
            let &line = random.choose(&self.list)?;
            let line = &problem.given.lines[line as usize];
            let Some(stocked) = random.choose(&problem.with_sku[line.sku as usize]) else {
                continue;
            };
            let pod = stocked.of;
            let may_come = problem.cost(pod, station).is_finite() && !self.comes[pod as usize];
            if stocked.units < line.units || !may_come {
                continue;
            }
            let worth = self.worth(filling, pod) - problem.cost(pod, station);
            if best.is_none_or(|(most, _)| worth > most) {
                best = Some((worth, pod));
            }
        }
        best.map(|(_, pod)| pod)
    }

    /// Collects the lines to be served, and those that the other visits could serve.
    fn look(&mut self, problem: &Problem, draft: &Draft, station: usize, gone: Option<usize>) {
        let first = problem.first(station);
        let visit = gone.map_or(NONE, |gone| (first + gone) as i32);
        self.open.copy_from_slice(&draft.free);
        for &line in &draft.at[station].lines {
            if draft.line_visit[line as usize] == visit {
                put(&mut self.open, line);
            }
        }
        for &order in &problem.open_at[station] {
            for &line in &problem.lines_of[order as usize] {
                if draft.line_visit[line as usize] == NONE {
                    put(&mut self.open, line);
                }
            }
        }
        self.list.clear();
        self.list.extend(lines_in(self.open.iter().copied()));
        self.at_hand.fill(0);
        let new = draft.at[station].pods.iter().enumerate();
        let others = new.filter(|(number, _)| Some(*number) != gone).map(|(_, pod)| pod);
        for &pod in problem.given.under_way[station].iter().chain(others) {
            for (all, its) in self.at_hand.iter_mut().zip(problem.serves(pod)) {
                *all |= its;
            }
        }
    }

    /// What a pod would serve of the lines.
    fn worth(&mut self, filling: &mut Filling, pod: u32) -> f64 {
        let problem = filling.problem;
        let serves = problem.serves(pod);
        let mut sum = 0.0;
        for (word, (its, open)) in serves.iter().zip(&self.open).enumerate() {
            let mut bits = its & open;
            while bits != 0 {
                let number = word as u32 * 64 + bits.trailing_zeros();
                bits &= bits - 1;
                filling.work += 2;
                let line = &problem.given.lines[number as usize];
                let given = &mut self.given[line.sku as usize];
                if *given > 0 && *given + line.units > problem.units(pod, line.sku) {
                    continue;
                }
                *given += line.units;
                let lines = &problem.lines_of[line.order as usize];
                let lacks = |&other: &u32| {
                    has(&self.open, other) && !has(serves, other) && !has(&self.at_hand, other)
                };
                let share = if lines.iter().any(lacks) { PARTLY } else { 1.0 };
                sum += share * self.worth[number as usize];
            }
        }
        for stocked in &problem.on_pod[pod as usize] {
            self.given[stocked.of as usize] = 0;
        }
        sum
    }
}
