//! Large neighbourhood search: visits are taken out of a plan, and others put in (Shaw 1998).
//!
//! A step changes one or two stations; what the others serve stays with them, so a step costs the
//! same however many stations there are.

use super::appeal::Appeal;
use super::filling::{Draft, Filling};
use crate::random::Random;

/// Of ten steps, those that let two visits change places.
const SWAPS: u64 = 3;
/// Most visits of a station that are taken out at a time.
const MOST_TAKEN: u64 = 2;
/// Pods that a new visit is drawn from, those that look best.
const LIST: usize = 8;

/// Searches from a draft; what is found is not worth less.
pub fn improved(
    filling: &mut Filling,
    appeal: &mut Appeal,
    draft: Draft,
    steps: u64,
    seed: u64,
) -> Draft {
    let mut random = Random::new(seed);
    let mut draft = draft;
    let stations = filling.problem.stations;
    for _ in 0..steps {
        let mut changed = vec![random.below(stations as u64) as usize];
        if stations > 1 && random.below(2) == 0 {
            let other = random.below(stations as u64 - 1) as usize;
            changed.push(other + usize::from(other >= changed[0]));
        }
        let before: f64 = changed.iter().map(|&s| draft.at[s].value).sum();
        let saved = draft.saved(&changed);
        if random.below(10) < SWAPS {
            swap(filling, &mut draft, &changed, &mut random);
        } else {
            renew(filling, appeal, &mut draft, &changed, &mut random);
        }
        let after: f64 = changed.iter().map(|&s| draft.at[s].value).sum();
        if after < before {
            draft.restore(saved);
        }
    }
    // orders that stations have kept from each other may be better shared out anew
    let whole = filling.draft(&draft.pods());
    if whole.value() > draft.value() { whole } else { draft }
}

/// Lets two visits of one station, or of two, change places if their pods can come there.
fn swap(filling: &mut Filling, draft: &mut Draft, changed: &[usize], random: &mut Random) {
    let (one, other) = (changed[0], changed[changed.len() - 1]);
    let lengths = (draft.at[one].pods.len(), draft.at[other].pods.len());
    if lengths.0 == 0 || lengths.1 == 0 || one == other && lengths.0 < 2 {
        return;
    }
    let visit = random.below(lengths.0 as u64) as usize;
    let its = if one == other {
        let its = random.below(lengths.1 as u64 - 1) as usize;
        its + usize::from(its >= visit)
    } else {
        random.below(lengths.1 as u64) as usize
    };
    let (pod, its_pod) = (draft.at[one].pods[visit], draft.at[other].pods[its]);
    let problem = filling.problem;
    if problem.cost(its_pod, one).is_finite() && problem.cost(pod, other).is_finite() {
        draft.at[one].pods[visit] = its_pod;
        draft.at[other].pods[its] = pod;
        filling.fill(draft, changed);
    }
}

/// Takes out a few visits, and puts others in their place and at the ends.
fn renew(
    filling: &mut Filling,
    appeal: &mut Appeal,
    draft: &mut Draft,
    changed: &[usize],
    random: &mut Random,
) {
    let mut gaps = Vec::new();
    for &station in changed {
        for _ in 0..=random.below(MOST_TAKEN) {
            let pods = &mut draft.at[station].pods;
            if !pods.is_empty() {
                let visit = random.below(pods.len() as u64) as usize;
                pods.remove(visit);
                gaps.push((station, visit));
            }
        }
        gaps.push((station, usize::MAX));
    }
    filling.fill(draft, changed);
    while !gaps.is_empty() {
        let (station, visit) = gaps.swap_remove(random.below(gaps.len() as u64) as usize);
        if draft.at[station].pods.len() < filling.problem.given.visits {
            insert(filling, appeal, draft, station, visit, random);
        }
    }
}

/// Lets a pod that looks good come in between, if that pays.
fn insert(
    filling: &mut Filling,
    appeal: &mut Appeal,
    draft: &mut Draft,
    station: usize,
    visit: usize,
    random: &mut Random,
) {
    appeal.score(filling, draft, station);
    let best = appeal.best(LIST);
    if best.is_empty() {
        return;
    }
    // the minimum of two draws: better ones more often
    let pick = random.below(best.len() as u64).min(random.below(best.len() as u64));
    let pod = best[pick as usize];
    let saved = draft.saved(&[station]);
    let before = draft.at[station].value;
    let visit = visit.min(draft.at[station].pods.len());
    draft.at[station].pods.insert(visit, pod);
    filling.fill(draft, &[station]);
    if draft.at[station].value <= before {
        draft.restore(saved);
    }
}
