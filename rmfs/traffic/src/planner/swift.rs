//! Faster searches for big fleets, whose ways may arrive slightly later than the earliest.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::network::Network;
use crate::reservations::Table;
use crate::search::{Guide, Outcome, Pathfinder, Query};
use crate::units::Us;

/// A search: the weight of the remaining time (in quarters: 4 finds the earliest arrival), and the
/// limit of labels.
type Effort = (Us, u64);

/// Searches with few labels: first at once; then from increasingly late departures, since waiting
/// at the start is always free and the traffic ahead passes; finally with more labels.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Swift {
    pub first: Effort,
    /// Additional labels of the first search, for each second of the unhindered way.
    pub per_second: u64,
    /// Each search from a later departure.
    pub later: Effort,
    /// Delay of the first of these departures; the steps double from one to the next.
    pub wait: Us,
    /// From the earliest departure again, if none of them found a way.
    pub last: [Effort; 2],
    /// Unhindered times are searched for only on the best ways.
    pub guide: Guide,
    /// Optional plans: limit of labels, and maximum lateness compared with the unhindered time.
    pub labels_to_try: u64,
    pub detour_to_try: Us,
}

impl Swift {
    /// Settings that work well for hundreds of robots (`docs/traffic.md`, Scale).
    pub const FOR_BIG_FLEETS: Self = Self {
        first: (5, 400),
        per_second: 4,
        later: (6, 200),
        wait: 5_000_000,
        last: [(6, 2_000), (16, 10_000)],
        guide: Guide::Near(0),
        labels_to_try: 100,
        detour_to_try: 20_000_000,
    };

    /// Searches for a way. The robot must leave its start by `until`; `urgency` determines the
    /// effort.
    pub fn search(
        &self,
        pathfinder: &mut Pathfinder,
        network: &Network,
        table: &Table,
        query: &Query,
        until: Us,
        urgency: Urgency,
    ) -> Outcome {
        let mut query = Query { guide: self.guide, ..query.clone() };
        let Some(unhindered) = pathfinder.aim(network, &query) else { return Outcome::NoWay };
        let (weight, labels) = self.first;
        let labels = labels + self.per_second * (unhindered / 1_000_000) as u64;
        let row = table.row(network.resource[query.goal as usize]);
        let goal_free = row.last().map_or(0, |last| last.end);
        if urgency == Urgency::Try {
            if goal_free > query.ready + unhindered + self.detour_to_try {
                return Outcome::NoWay; // any way is too late
            }
            query.detour = self.detour_to_try;
            let labels = self.labels_to_try.min(query.budget);
            return pathfinder.seek(network, table, &query, weight, labels);
        }
        let earliest = query.ready;
        // who would have to wait for the goal to be free starts in time for that
        let least = match query.guidance {
            Some(_) => pathfinder.least_cost(network, &query),
            None => unhindered,
        };
        let in_time = earliest.max(goal_free - least - self.wait);
        query.ready = if in_time < until { in_time } else { earliest };
        let mut outcome = pathfinder.seek(network, table, &query, weight, labels.min(query.budget));
        if outcome == Outcome::OutOfBudget {
            let last = until.min(table.horizon());
            let mut wait = self.wait;
            let (weight, labels) = self.later;
            while outcome == Outcome::OutOfBudget && query.ready + wait < last {
                query.ready += wait;
                wait *= 2;
                outcome = pathfinder.seek(network, table, &query, weight, labels.min(query.budget));
            }
        }
        // that no way leaves later does not say that none leaves now
        let mut starved = outcome == Outcome::NoWay && query.ready > earliest;
        query.ready = earliest;
        let last = if urgency == Urgency::Whatever { &self.last[..] } else { &self.last[..1] };
        for &(weight, labels) in last {
            if urgency == Urgency::Soon && outcome == Outcome::OutOfBudget {
                break;
            }
            if outcome == Outcome::OutOfBudget || std::mem::take(&mut starved) {
                outcome = pathfinder.seek(network, table, &query, weight, labels.min(query.budget));
            }
        }
        outcome
    }
}

/// Urgency of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Urgency {
    /// The plan would be better than the robot's present one.
    Try,
    /// The robot needs a plan, but can ask again.
    Soon,
    /// The robot has asked long enough.
    Whatever,
}

/// Running mean of labels per plan, which determines when [`Swift`] is used.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Load {
    /// The mean times [`Load::PLANS`].
    sum: u64,
}

impl Load {
    /// Number of plans over which the mean is taken.
    const PLANS: u64 = 256;

    /// Adds the labels of a plan. Returns the mean.
    pub fn count(&mut self, labels: u64) -> u64 {
        self.sum += labels;
        let mean = self.sum / Self::PLANS;
        self.sum -= mean;
        mean
    }
}

/// Robots without a way, which first wait until others have moved, before a way around all planned
/// motion is searched for: such ways take long to find, are late, and make others wait.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Waiting(BTreeMap<u32, Wait>);

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Wait {
    goal: u32,
    since: Us,
    again: Us,
    pause: Us,
}

/// Time for which a robot repeats its question: longer than the rush at the start lasts.
const PATIENCE: Us = 300_000_000;

/// First pause between two attempts; pauses double.
const PAUSE: Us = 1_000_000;

impl Waiting {
    /// Urgency of the search for a robot's way now; `None`: the robot must wait before the next
    /// attempt.
    pub fn urgency(&self, robot: u32, goal: u32, now: Us) -> Option<Urgency> {
        match self.0.get(&robot).filter(|wait| wait.goal == goal) {
            None => Some(Urgency::Soon),
            Some(wait) if now - wait.since >= PATIENCE => Some(Urgency::Whatever),
            Some(wait) => (now >= wait.again).then_some(Urgency::Soon),
        }
    }

    /// Records that no way was found.
    pub fn wait(&mut self, robot: u32, goal: u32, now: Us) {
        let fresh = Wait { goal, since: now, again: now, pause: PAUSE };
        let wait = self.0.entry(robot).or_insert_with(|| fresh.clone());
        if wait.goal != goal {
            *wait = fresh;
        }
        wait.again = now + wait.pause;
        wait.pause *= 2;
    }

    /// Records that a way was found.
    pub fn end(&mut self, robot: u32) {
        self.0.remove(&robot);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_load_is_a_running_mean() {
        let mut load = Load::default();
        assert!((0..2_000).all(|_| load.count(50) <= 50));
        assert!((45..=50).contains(&load.count(50)));
        // one plan of many labels says little, many of them do
        assert!(load.count(10_000) < 100);
        assert!((0..40).map(|_| load.count(10_000)).last() > Some(1_000));
    }

    #[test]
    fn who_waits_asks_less_and_less_often_until_it_has_waited_long_enough() {
        const SECOND: Us = 1_000_000;
        let mut waiting = Waiting::default();
        let mut asked = Vec::new();
        for second in 0..310 {
            match waiting.urgency(3, 8, second * SECOND) {
                Some(Urgency::Soon) => {
                    asked.push(second);
                    waiting.wait(3, 8, second * SECOND);
                }
                Some(urgency) => assert_eq!((second >= 300, urgency), (true, Urgency::Whatever)),
                None => assert!(second < 300),
            }
        }
        assert_eq!(asked, [0, 1, 3, 7, 15, 31, 63, 127, 255]);
        // another goal is another matter, and so is another wait
        assert_eq!(waiting.urgency(3, 9, 310 * SECOND), Some(Urgency::Soon));
        waiting.end(3);
        assert_eq!(waiting.urgency(3, 8, 311 * SECOND), Some(Urgency::Soon));
    }
}
