//! Conflicts between plans: two robots at one waypoint at the same time.

use crate::robot::Held;
use crate::units::Us;

/// Two agents, by index, that occupy a resource at the same time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conflict {
    pub agents: [usize; 2],
    pub resource: u32,
    /// The overlap.
    pub start: Us,
    pub end: Us,
}

/// The conflict that begins first among what agents occupy.
pub fn first<'a>(occupied: impl IntoIterator<Item = &'a [Held]>) -> Option<Conflict> {
    let mut all: Vec<(u32, Us, Us, usize)> = Vec::new();
    for (agent, plan) in occupied.into_iter().enumerate() {
        all.extend(plan.iter().map(|held| (held.resource, held.start, held.end, agent)));
    }
    all.sort_unstable();
    let mut first: Option<Conflict> = None;
    // of the intervals before on the same resource, the one that ends last
    let mut longest = (u32::MAX, 0, 0, 0);
    for &(resource, start, end, agent) in &all {
        let overlaps = longest.0 == resource && start < longest.2 && agent != longest.3;
        if overlaps && first.as_ref().is_none_or(|known| start < known.start) {
            let agents = [longest.3, agent];
            first = Some(Conflict { agents, resource, start, end: end.min(longest.2) });
        }
        if longest.0 != resource || end > longest.2 {
            longest = (resource, start, end, agent);
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    fn held(resource: u32, start: Us, end: Us) -> Held {
        Held { resource, start, end, entered_by: 0 }
    }

    #[test]
    fn the_earliest_overlap_is_found() {
        let one = [held(1, 0, 10), held(2, 10, 20)];
        let two = [held(2, 0, 10), held(1, 9, 12)];
        let three = [held(2, 15, 17), held(3, 0, 1)];
        let plans = [&one[..], &two[..], &three[..]];
        let expected = Conflict { agents: [0, 1], resource: 1, start: 9, end: 10 };
        assert_eq!(first(plans), Some(expected));
        let expected = Conflict { agents: [0, 1], resource: 2, start: 15, end: 17 };
        assert_eq!(first([&one[..], &three[..]]), Some(expected));
        assert_eq!(first([&two[..], &three[..]]), None);
    }

    #[test]
    fn touching_is_no_conflict_and_neither_is_one_robot() {
        let one = [held(1, 0, 10), held(1, 5, 20)];
        let two = [held(1, 20, 30)];
        assert_eq!(first([&one[..], &two[..]]), None);
    }
}
