//! Uncertain execution: with some probability a motion begins later than planned.
//!
//! Just before a robot turns for a run, its delay is drawn, which may be zero. The order in which
//! robots use waypoints is kept (`late.rs`), so robots behind it wait and there are no collisions.
//! A delay that would force a driving robot to stop is applied at the late robot's next stop
//! instead; no delay is lost. With repair, robots that are made to wait are planned again, in front
//! of the late robot if that is better for both.

use std::cmp::Reverse;

use serde::{Deserialize, Serialize};

use crate::random::Random;
use crate::units::{FOREVER, Us};

use super::disturbed::turn;
use super::{Counters, Due, Fleet};

/// Denominator of probabilities.
const PARTS: u64 = 1 << 32;

/// Minimum wait of a robot from which repair is attempted.
const WORTH: Us = 1_000_000;

/// Maximum number of labels of a plan in repair.
const EFFORT: u64 = 300;

/// Distribution of delays, and their state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Lateness {
    /// Probability that a motion begins late, in units of 2^-32.
    probability: u64,
    /// Shortest and longest delay; all between are equally likely.
    length: (Us, Us),
    repairs: bool,
    random: Random,
    /// Delays that could not be applied yet, per robot.
    owed: Vec<Us>,
    /// For each robot whose next motion has its delay already, the last time at which this holds:
    /// that of the draw or, if the motion is delayed, any.
    drawn: Vec<Option<Us>>,
}

impl Lateness {
    /// Delays of `length` with a probability per motion, for a number of robots.
    pub fn new(
        probability: f64,
        length: (Us, Us),
        repairs: bool,
        seed: u64,
        robots: usize,
    ) -> Self {
        Self {
            probability: (probability * PARTS as f64) as u64,
            length,
            repairs,
            random: Random::new(seed),
            owed: vec![0; robots],
            drawn: vec![None; robots],
        }
    }

    /// Draws from another seed from now on.
    pub fn reseed(&mut self, seed: u64) {
        self.random = Random::new(seed);
    }

    /// Draws and counts the delay of a robot's motion that is about to begin.
    fn draw(&mut self, robot: u32, now: Us, counters: &mut Counters) -> Us {
        let owed = std::mem::take(&mut self.owed[robot as usize]);
        // a motion that replaces another at the moment of its draw has the same delay
        if self.drawn[robot as usize].replace(now).is_some() {
            return owed;
        }
        counters.motions += 1;
        if self.random.below(PARTS) >= self.probability {
            return owed;
        }
        let (least, most) = self.length;
        let by = least + self.random.below((most - least + 1) as u64) as Us;
        counters.late_motions += 1;
        counters.lateness += by as u64;
        owed + by
    }
}

impl Fleet {
    /// Lets motions be late from now on.
    pub fn set_lateness(&mut self, lateness: Lateness) {
        self.lateness = Some(lateness);
        for robot in 0..self.robots.len() as u32 {
            self.expect_motion(robot);
        }
    }

    /// Draws the lateness of motions from another seed from now on.
    pub fn reseed_lateness(&mut self, seed: u64) {
        if let Some(lateness) = &mut self.lateness {
            lateness.reseed(seed);
        }
    }

    /// Schedules the draw for the robot's next motion, if motions can be late.
    pub(super) fn expect_motion(&mut self, robot: u32) {
        let Some(lateness) = &mut self.lateness else { return };
        let drawn = &mut lateness.drawn[robot as usize];
        *drawn = drawn.filter(|&until| until >= self.now);
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let begun = state.committed(&self.network, kind, self.now);
        if let Some(next) = state.moves.get(begun) {
            let due = next.start - turn(&self.network, kind, next);
            self.agenda.push(Reverse((due, robot, Due::Motion, state.version)));
        }
    }

    /// Handles the start of a robot's motion, unless its plan has changed.
    pub(super) fn motion_due(&mut self, robot: u32, version: u32) {
        let Some(lateness) = &mut self.lateness else { return };
        if self.robots[robot as usize].version != version {
            return;
        }
        let by = lateness.draw(robot, self.now, &mut self.counters);
        if by > 0 && self.begins_late(robot, by) {
            return;
        }
        self.agenda.push(Reverse((self.now + 1, robot, Due::NextMotion, version)));
    }

    /// Handles that a motion has begun: the next one will be drawn.
    pub(super) fn next_motion_due(&mut self, robot: u32, version: u32) {
        if self.robots[robot as usize].version == version {
            self.expect_motion(robot);
        }
    }

    /// Lets a robot stand still for longer. Returns whether this was possible; otherwise it happens
    /// later.
    fn begins_late(&mut self, robot: u32, by: Us) -> bool {
        let ends = |fleet: &Self| -> Vec<Us> {
            fleet.robots.iter().map(|state| state.destination().2).collect()
        };
        let before = ends(self);
        let begins = self.hold(robot, by).is_some();
        let Some(lateness) = &mut self.lateness else { return begins };
        if !begins {
            lateness.owed[robot as usize] += by;
            return false;
        }
        lateness.drawn[robot as usize] = Some(FOREVER);
        if lateness.repairs && self.rolling.is_none() {
            let after = ends(self);
            let waits = |&other: &u32| {
                other != robot && after[other as usize] - before[other as usize] > WORTH
            };
            let waiting: Vec<u32> = (0..self.robots.len() as u32).filter(waits).collect();
            self.repair(robot, &waiting);
        }
        true
    }

    /// Replans the robots that wait for a late robot, alone or in front of it.
    fn repair(&mut self, late: u32, waiting: &[u32]) {
        let mut repaired = 0;
        for &robot in waiting {
            repaired += u64::from(
                self.can_change(robot)
                    && (self.replan_together(&[robot], EFFORT)
                        || self.replan_together(&[robot, late], EFFORT)),
            );
        }
        self.counters.repairs += repaired;
    }
}
