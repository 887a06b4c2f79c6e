//! Ways for big fleets: found sooner, and perhaps a little later than the earliest.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::network::Network;
use crate::reservations::Table;
use crate::search::{Guide, Outcome, Pathfinder, Query};
use crate::units::Us;

/// A search: the weight of the time to go (in quarters: 4 finds the earliest arrival), and labels.
type Effort = (Us, u64);

/// Searches with few labels: at once; then from later and later departures, since waiting at the
/// start is always free and the traffic ahead passes; without success with more labels.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Swift {
    pub first: Effort,
    /// Labels the first search may look at besides, for each second of the way unhindered.
    pub per_second: u64,
    /// Each search from a later departure.
    pub later: Effort,
    /// By how much the first of them is later; each further one by twice as much as the one before.
    pub wait: Us,
    /// From the earliest departure again, if none of them found a way.
    pub last: [Effort; 2],
    /// Unhindered times are searched for only near the best way.
    pub guide: Guide,
    /// Plans that need not be: labels, and how much later than unhindered they may arrive.
    pub labels_to_try: u64,
    pub detour_to_try: Us,
}

impl Swift {
    /// What has been found to pay for hundreds of robots (`docs/traffic.md`, Scale).
    pub const FOR_BIG_FLEETS: Self = Self {
        first: (5, 400),
        per_second: 4,
        later: (6, 200),
        wait: 5_000_000,
        last: [(6, 2_000), (16, 10_000)],
        guide: Guide::Near(3_000_000),
        labels_to_try: 100,
        detour_to_try: 20_000_000,
    };

    /// Looks for a way. `until` is when the robot has to have left its start; `urgency` says
    /// what that may cost.
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
        if urgency == Urgency::Try {
            query.detour = self.detour_to_try;
            let labels = self.labels_to_try.min(query.budget);
            return pathfinder.seek(network, table, &query, weight, labels);
        }
        let earliest = query.ready;
        // who would have to wait for the goal to be free starts in time for that
        let row = table.row(network.resource[query.goal as usize]);
        let goal_free = row.last().map_or(0, |last| last.end);
        let in_time = earliest.max(goal_free - unhindered - self.wait);
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

/// How much a robot needs a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Urgency {
    /// It would be better than what the robot has.
    Try,
    /// The robot needs one, but can ask again.
    Soon,
    /// The robot has asked long enough.
    Whatever,
}

/// How many labels plans take, as a running mean: whether it is time for [`Swift`].
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Load {
    /// The mean times [`Load::PLANS`].
    sum: u64,
}

impl Load {
    /// Plans over which the mean runs.
    const PLANS: u64 = 256;

    /// A plan took so many labels. Returns the mean.
    pub fn count(&mut self, labels: u64) -> u64 {
        self.sum += labels;
        let mean = self.sum / Self::PLANS;
        self.sum -= mean;
        mean
    }
}

/// Robots without a way that wait for it to come of itself, before one is looked for that leads
/// around all motion planned: such ways take long to find, are late, and keep others waiting.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Waiting(BTreeMap<u32, Wait>);

#[derive(Clone, Debug, Serialize, Deserialize)]
struct Wait {
    goal: u32,
    since: Us,
    again: Us,
    pause: Us,
}

/// How long a robot asks again and again: longer than a rush takes to get under way.
const PATIENCE: Us = 300_000_000;

/// The first pause between two questions; each is twice as long as the one before.
const PAUSE: Us = 1_000_000;

impl Waiting {
    /// How a way for a robot is to be looked for now; `None`: not yet again.
    pub fn urgency(&self, robot: u32, goal: u32, now: Us) -> Option<Urgency> {
        match self.0.get(&robot).filter(|wait| wait.goal == goal) {
            None => Some(Urgency::Soon),
            Some(wait) if now - wait.since >= PATIENCE => Some(Urgency::Whatever),
            Some(wait) => (now >= wait.again).then_some(Urgency::Soon),
        }
    }

    /// None has been found.
    pub fn wait(&mut self, robot: u32, goal: u32, now: Us) {
        let fresh = Wait { goal, since: now, again: now, pause: PAUSE };
        let wait = self.0.entry(robot).or_insert_with(|| fresh.clone());
        if wait.goal != goal {
            *wait = fresh;
        }
        wait.again = now + wait.pause;
        wait.pause *= 2;
    }

    /// One has been found.
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
