//! The start rule: one visit after another, each by the best of a few promising pods.

use super::appeal::Appeal;
use super::draft::Draft;
use super::filling::Filling;
use super::problem::Problem;

/// Number of pods tried for each visit, and of orders for which several pods are tried.
const TRIED: usize = 5;

/// Adds visits to the given ones as long as they are worthwhile; the station with the fewest units
/// comes first.
pub fn extended(filling: &mut Filling, appeal: &mut Appeal, pods: &[Vec<u32>]) -> Draft {
    let problem = filling.problem;
    let mut draft = filling.draft(pods);
    let mut done = vec![false; problem.stations];
    loop {
        let open = |&s: &usize| !done[s] && draft.at[s].pods.len() < problem.given.visits;
        let Some(station) =
            (0..problem.stations).filter(open).min_by_key(|&s| (draft.at[s].units, s))
        else {
            return draft;
        };
        let better = one_more(filling, appeal, &draft, station)
            .or_else(|| for_one_order(filling, appeal, &draft, station));
        match better {
            Some(better) => draft = better,
            None => done[station] = true,
        }
    }
}

/// The best next visit of a station; `None` if none is worthwhile.
fn one_more(
    filling: &mut Filling,
    appeal: &mut Appeal,
    draft: &Draft,
    station: usize,
) -> Option<Draft> {
    appeal.score(filling, draft, station);
    let mut best: Option<Draft> = None;
    for &pod in appeal.best(TRIED) {
        let mut pods = draft.pods();
        pods[station].push(pod);
        let trial = filling.draft(&pods);
        if trial.value() > best.as_ref().unwrap_or(draft).value() {
            best = Some(trial);
        }
    }
    best
}

/// Adds visits of all pods that one order lacks; `None` if this is not worthwhile for any of a few
/// orders.
///
/// Otherwise, an order that needs several additional pods would never be started, as a single
/// further visit would serve nothing of it.
fn for_one_order(
    filling: &mut Filling,
    appeal: &mut Appeal,
    draft: &Draft,
    station: usize,
) -> Option<Draft> {
    let problem = filling.problem;
    appeal.score(filling, draft, station);
    let room = problem.given.visits - draft.at[station].pods.len();
    let waits = |&order: &u32| {
        draft.order_station[order as usize] < 0 && problem.lines_of[order as usize].len() > 1
    };
    let mut orders: Vec<u32> = (0..problem.lines_of.len() as u32).filter(waits).collect();
    let worth = &problem.given.order_worth;
    orders.sort_by(|&a, &b| worth[b as usize].total_cmp(&worth[a as usize]));
    for &order in orders.iter().take(TRIED) {
        let lacking = lacking(problem, &appeal.scores, draft, station, order);
        if lacking.is_empty() || lacking.len() > room {
            continue;
        }
        let mut pods = draft.pods();
        pods[station].extend(lacking);
        let trial = filling.draft(&pods);
        if trial.value() > draft.value() {
            return Some(trial);
        }
    }
    None
}

/// Pods for the lines of an order that no visit of a station serves; none if there is no pod for
/// one of them.
fn lacking(
    problem: &Problem,
    scores: &[f64],
    draft: &Draft,
    station: usize,
    order: u32,
) -> Vec<u32> {
    let under_way = &problem.given.under_way[station];
    let mut there: Vec<u32> = under_way.iter().chain(&draft.at[station].pods).copied().collect();
    let before = there.len();
    for (_, line) in problem.lines(order) {
        if there.iter().any(|&pod| problem.units(pod, line.sku) >= line.units) {
            continue;
        }
        let mut best: Option<u32> = None;
        for stocked in &problem.with_sku[line.sku as usize] {
            let score = scores[stocked.of as usize];
            let is_better = best.is_none_or(|pod| score > scores[pod as usize]);
            if stocked.units >= line.units && score.is_finite() && is_better {
                best = Some(stocked.of);
            }
        }
        let Some(best) = best else { return Vec::new() };
        there.push(best);
    }
    there.split_off(before)
}
