//! Robots that need to drive and have found no way: they stay where they are and try again.

use std::cmp::Reverse;
use std::time::Instant;

use crate::network::NONE;
use crate::robot::{Phase, Step};
use crate::search::{End, Guide, Outcome, Query};
use crate::units::{FOREVER, Us};

use super::pace::Reply;
use super::{Due, Fleet};

/// Time between two attempts of a robot that found no way.
const RETRY: Us = 1_000_000;

impl Fleet {
    pub(super) fn schedule_retry(&mut self) {
        let needed = !self.blocked.is_empty() || !self.stalled.is_empty();
        if needed && !self.retry_due {
            self.retry_due = true;
            self.agenda.push(Reverse((self.now + RETRY, u32::MAX, Due::Retry, 0)));
        }
    }

    /// Lets robots try again if another robot has just planned to leave their goal.
    pub(super) fn retry_released(&mut self) {
        while !self.released.is_empty() {
            let released = std::mem::take(&mut self.released);
            if self.blocked.is_empty() {
                return;
            }
            self.retry(|fleet, robot| match fleet.robots[robot as usize].program.front() {
                Some(Step::Drive(goal)) => released.contains(goal),
                Some(Step::Station(station)) => {
                    released.iter().any(|&v| fleet.network.stations[*station as usize].contains(&v))
                }
                _ => true,
            });
        }
    }

    pub(super) fn retry(&mut self, concerns: impl Fn(&Self, u32) -> bool) {
        for robot in std::mem::take(&mut self.blocked) {
            let state = &self.robots[robot as usize];
            if state.phase != Phase::Blocked || self.blocked.contains(&robot) {
                continue;
            }
            if concerns(self, robot) {
                if self.ask_for_plan(robot, true) == Reply::NoWay {
                    self.step_aside(robot);
                    self.robots[robot as usize].phase = Phase::Blocked;
                    self.blocked.push(robot);
                }
            } else {
                self.blocked.push(robot);
            }
        }
        self.schedule_retry();
    }

    /// Sends a blocked robot that stands in the way of others to the nearest free storage location.
    pub(super) fn step_aside(&mut self, robot: u32) {
        self.settle(robot);
        let Fleet { network, kinds, robots, table, pathfinder, costs, stored, .. } = self;
        let state = &robots[robot as usize];
        let rests_well = network.storage[state.anchor as usize] || state.place.is_some();
        // a grid map has no storage locations: there is nowhere to look
        if !state.moves.is_empty() || rests_well || !network.storage.contains(&true) {
            return;
        }
        let begun = Instant::now();
        for held in &state.held {
            table.remove(held.resource, robot);
        }
        let query = Query {
            start: state.anchor,
            heading: state.heading,
            ready: state.rested.max(self.now).max(state.busy_until),
            goal: NONE,
            loaded: state.pod.is_some(),
            stored,
            kind: &kinds[state.kind as usize],
            model: &costs.models[state.kind as usize],
            budget: self.budget,
            end: End::ForGood,
            detour: FOREVER,
            guide: Guide::Exact,
            times: None,
            guidance: None,
        };
        let found = pathfinder.search(network, table, &query);
        self.counters.planning += begun.elapsed();
        match found {
            Outcome::Found(moves) => {
                self.counters.replans += 1;
                self.adopt(robot, 0, moves);
            }
            Outcome::NoWay | Outcome::OutOfBudget => self.reserve(robot),
        }
    }

    /// Robots that need to drive and have found no way.
    pub fn blocked(&self) -> Vec<u32> {
        let waits = |&robot: &u32| self.robots[robot as usize].phase == Phase::Blocked;
        (0..self.robots.len() as u32).filter(waits).collect()
    }
}
