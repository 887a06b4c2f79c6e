//! Selection of promising pods for a station, by a rough estimate of what each could add.

use super::draft::Draft;
use super::filling::Filling;
use super::problem::Problem;

/// Share of its worth at which a line counts whose order lacks other lines in the plan.
const PARTLY: f64 = 0.35;

/// Scores pods for one more visit; keeps the tables it needs for that.
///
/// A unit in stock counts with the mean worth of the remaining lines of its SKU, up to the units
/// they need. Lines of orders that are open elsewhere do not count, and lines whose order lacks
/// other lines at the station count in part.
pub struct Appeal {
    pub scores: Vec<f64>,
    at_hand: Vec<bool>,
    lacking: Vec<u32>,
    wanted: Vec<f64>,
    worth: Vec<f64>,
    line_worth: Vec<f64>,
    best: Vec<u32>,
}

impl Appeal {
    pub fn new(problem: &Problem) -> Self {
        let given = &problem.given;
        let line_worth =
            |line: &super::problem::Line| line.worth + given.order_worth[line.order as usize];
        Self {
            scores: vec![0.0; problem.pods],
            at_hand: vec![false; given.skus],
            lacking: vec![0; given.order_station.len()],
            wanted: vec![0.0; given.skus],
            worth: vec![0.0; given.skus],
            line_worth: given.lines.iter().map(line_worth).collect(),
            best: Vec::new(),
        }
    }

    /// Estimates what each pod would add to a draft, less its cost; minus infinity for pods that
    /// cannot come, or come already.
    pub fn score(&mut self, filling: &mut Filling, draft: &Draft, station: usize) {
        let problem = filling.problem;
        let given = &problem.given;
        self.at_hand.fill(false);
        self.lacking.fill(0);
        self.wanted.fill(0.0);
        self.worth.fill(0.0);
        for &pod in given.under_way[station].iter().chain(&draft.at[station].pods) {
            for stocked in &problem.on_pod[pod as usize] {
                self.at_hand[stocked.of as usize] = true;
            }
        }
        for (line, visit) in given.lines.iter().zip(&draft.line_visit) {
            if *visit < 0 && !self.at_hand[line.sku as usize] {
                self.lacking[line.order as usize] += 1;
            }
        }
        for (number, line) in given.lines.iter().enumerate() {
            let (order, sku) = (line.order as usize, line.sku as usize);
            let at = given.order_station[order];
            if draft.line_visit[number] >= 0 || at >= 0 && at as usize != station {
                continue;
            }
            let alone = self.lacking[order] <= u32::from(!self.at_hand[sku]);
            let share = if alone { 1.0 } else { PARTLY };
            self.wanted[sku] += line.units as f64 * share;
            self.worth[sku] += self.line_worth[number] * share;
        }
        for (pod, score) in self.scores.iter_mut().enumerate() {
            *score = -problem.cost(pod as u32, station);
        }
        // thrice the pods: they are gone through here, and to choose the best
        filling.work += (3 * problem.pods + 2 * given.lines.len() + given.skus) as u64;
        for (sku, pods) in problem.with_sku.iter().enumerate() {
            if self.wanted[sku] <= 0.0 {
                continue;
            }
            let per_unit = self.worth[sku] / self.wanted[sku];
            filling.work += pods.len() as u64;
            for stocked in pods {
                let units = self.wanted[sku].min(stocked.units as f64);
                self.scores[stocked.of as usize] += units * per_unit;
            }
        }
        for &pod in draft.at.iter().flat_map(|at| &at.pods) {
            self.scores[pod as usize] = f64::NEG_INFINITY;
        }
    }

    /// The most promising pods that can come, the best first.
    pub fn best(&mut self, count: usize) -> &[u32] {
        let scores = &self.scores;
        let before =
            |&a: &u32, &b: &u32| scores[b as usize].total_cmp(&scores[a as usize]).then(a.cmp(&b));
        self.best.clear();
        self.best.extend(0..scores.len() as u32);
        if count < self.best.len() {
            self.best.select_nth_unstable_by(count, before);
            self.best.truncate(count);
        }
        self.best.sort_unstable_by(before);
        self.best.retain(|&pod| scores[pod as usize].is_finite());
        &self.best
    }
}
