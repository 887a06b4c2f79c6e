//! Neighbourhood search: visits are removed from a plan and others inserted (Shaw 1998). Slightly
//! worse plans are accepted at first (threshold accepting, Dueck and Scheuer 1990, with a threshold
//! drawn for each step).
//!
//! A step changes one or two stations; the others keep what they serve, so the time of a step does
//! not depend on the number of stations.

use super::draft::{Draft, Saved};
use super::filling::Filling;
use super::guess::Guess;
use super::problem::Problem;
use crate::patience::look_up;
use crate::random::Random;

/// Percentages of steps that replace a visit, move one, add one, and swap visits of two stations.
/// The other steps redistribute what two stations serve.
const REPLACE: u64 = 51;
const MOVE: u64 = 37;
const ADD: u64 = 6;
const SWAP: u64 = 3;
/// One in this number of steps on a single station also refills another station, which may take
/// what the first releases.
const WITH_ANOTHER: u64 = 5;
/// Initial threshold, as a share of the mean worth of a line.
const WORSE: f64 = 0.5;
/// Number of steps into which a threshold is divided for drawing.
const PARTS: u64 = 1 << 20;

/// Searches from a draft; the result is never worse.
pub fn improved(filling: &mut Filling, draft: Draft, steps: u64, seed: u64) -> Draft {
    let problem = filling.problem;
    let mut random = Random::new(seed);
    let mut guess = Guess::new(problem, &draft);
    let mut value = draft.value();
    let (mut draft, mut best_value, mut best) = (draft.clone(), value, draft);
    let (mut saved, mut changed) = (Saved::default(), Vec::new());
    let worse = WORSE * guess.mean_worth();
    for step in 0..steps {
        look_up();
        let kind = random.below(100);
        choose_stations(problem, kind, &mut changed, &mut random);
        draft.save(&changed, &mut saved);
        if !change(filling, &mut guess, &mut draft, &changed, kind, &mut random) {
            continue;
        }
        filling.fill(&mut draft, &changed);
        let gain = draft.value_of(&changed) - saved.value();
        let threshold = worse * (steps - step) as f64 / steps as f64;
        if gain < -threshold * random.below(PARTS) as f64 / PARTS as f64 {
            draft.restore(problem, &saved);
            continue;
        }
        guess.changed(&saved, &draft, &changed);
        value += gain;
        if value > best_value {
            best_value = value;
            best.clone_from(&draft);
        }
    }
    // orders that stations have kept from each other may be better shared out anew
    let whole = filling.draft(&best.pods());
    if whole.value() > best.value() { whole } else { best }
}

/// Chooses the stations that a step changes; swapping and redistributing take two if there are two.
fn choose_stations(problem: &Problem, kind: u64, changed: &mut Vec<usize>, random: &mut Random) {
    let stations = problem.stations as u64;
    let one = random.below(stations) as usize;
    changed.clear();
    changed.push(one);
    let takes_two = kind >= REPLACE + MOVE + ADD;
    if stations > 1 && (takes_two || random.below(WITH_ANOTHER) == 0) {
        let other = random.below(stations - 1) as usize;
        changed.push(other + usize::from(other >= one));
    }
}

/// Changes the visits of the first station, or of both; returns whether anything has changed.
fn change(
    filling: &mut Filling,
    guess: &mut Guess,
    draft: &mut Draft,
    changed: &[usize],
    kind: u64,
    random: &mut Random,
) -> bool {
    let station = changed[0];
    if kind < REPLACE {
        replace(filling, guess, draft, station, random)
    } else if kind < REPLACE + MOVE {
        relocate(draft, station, random)
    } else if kind < REPLACE + MOVE + ADD {
        add(filling, guess, draft, station, random)
    } else if kind < REPLACE + MOVE + ADD + SWAP {
        changed.len() > 1 && swap(filling.problem, draft, station, changed[1], random)
    } else {
        changed.len() > 1
    }
}

/// Removes a visit and inserts another one, in its place or anywhere.
fn replace(
    filling: &mut Filling,
    guess: &mut Guess,
    draft: &mut Draft,
    station: usize,
    random: &mut Random,
) -> bool {
    let visits = draft.at[station].pods.len() as u64;
    if visits == 0 {
        return false;
    }
    let visit = random.below(visits) as usize;
    let Some(pod) = guess.pod(filling, draft, station, Some(visit), random) else { return false };
    let to = if random.below(2) == 0 { visit } else { random.below(visits) as usize };
    draft.at[station].pods.remove(visit);
    draft.at[station].pods.insert(to, pod);
    true
}

/// Moves a visit within the sequence of its station.
fn relocate(draft: &mut Draft, station: usize, random: &mut Random) -> bool {
    let pods = &mut draft.at[station].pods;
    if pods.len() < 2 {
        return false;
    }
    let visit = random.below(pods.len() as u64) as usize;
    let to = random.below(pods.len() as u64 - 1) as usize;
    let pod = pods.remove(visit);
    pods.insert(to + usize::from(to >= visit), pod);
    true
}

/// Inserts a further visit.
fn add(
    filling: &mut Filling,
    guess: &mut Guess,
    draft: &mut Draft,
    station: usize,
    random: &mut Random,
) -> bool {
    let visits = draft.at[station].pods.len();
    if visits >= filling.problem.given.visits {
        return false;
    }
    let Some(pod) = guess.pod(filling, draft, station, None, random) else { return false };
    draft.at[station].pods.insert(random.below(visits as u64 + 1) as usize, pod);
    true
}

/// Swaps two visits of two stations if their pods can go there.
fn swap(
    problem: &Problem,
    draft: &mut Draft,
    one: usize,
    other: usize,
    random: &mut Random,
) -> bool {
    let (visits, its_visits) = (draft.at[one].pods.len(), draft.at[other].pods.len());
    if visits == 0 || its_visits == 0 {
        return false;
    }
    let visit = random.below(visits as u64) as usize;
    let its_visit = random.below(its_visits as u64) as usize;
    let (pod, its_pod) = (draft.at[one].pods[visit], draft.at[other].pods[its_visit]);
    if problem.cost(its_pod, one).is_infinite() || problem.cost(pod, other).is_infinite() {
        return false;
    }
    draft.at[one].pods[visit] = its_pod;
    draft.at[other].pods[its_visit] = pod;
    true
}
