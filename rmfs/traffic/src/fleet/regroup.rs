//! A new beginning from where robots really are.
//!
//! When a robot is somewhere it should not be, plans are worth nothing: everybody stops at the last
//! waypoint it may use, and all are planned anew from there.

use std::collections::HashMap;

use crate::robot::Phase;
use crate::units::Us;

use super::Fleet;

/// Where a robot will stand still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rest {
    pub waypoint: u32,
    pub heading: u8,
    /// When it stands there.
    pub time: Us,
}

impl Fleet {
    /// Puts every robot at rest where it really is and plans the programs anew.
    ///
    /// # Errors
    /// If there is not one rest per robot, or two share a waypoint; nothing has changed then.
    pub fn regroup(&mut self, rests: &[Rest]) -> Result<(), String> {
        self.check_rests(rests)?;
        self.settle_all();
        for robot in 0..self.robots.len() as u32 {
            self.forget(robot);
        }
        for (robot, rest) in rests.iter().enumerate() {
            let now = self.now;
            let state = &mut self.robots[robot];
            state.moves.clear();
            state.version += 1;
            (state.anchor, state.heading) = (rest.waypoint, rest.heading);
            (state.anchored, state.rested) = (now, rest.time.max(now));
        }
        for robot in 0..self.robots.len() as u32 {
            self.occupy(robot);
        }
        self.begin_again();
        Ok(())
    }

    fn check_rests(&self, rests: &[Rest]) -> Result<(), String> {
        if rests.len() != self.robots.len() {
            return Err(format!("{} rests for {} robots", rests.len(), self.robots.len()));
        }
        let mut holders = HashMap::new();
        for (robot, rest) in rests.iter().enumerate() {
            let Some(&resource) = self.network.resource.get(rest.waypoint as usize) else {
                return Err(format!("no waypoint {}", rest.waypoint));
            };
            if let Some(other) = holders.insert(resource, robot) {
                return Err(format!(
                    "robots {other} and {robot} both stand at waypoint {}",
                    rest.waypoint
                ));
            }
        }
        Ok(())
    }

    /// Lets every robot that was on its way look for a new one.
    fn begin_again(&mut self) {
        self.blocked.clear();
        for robot in 0..self.robots.len() as u32 {
            if !matches!(self.robots[robot as usize].phase, Phase::Driving | Phase::Blocked) {
                continue;
            }
            if let Some((station, _)) = self.robots[robot as usize].place.take() {
                self.queues[station as usize].retain(|&other| other != robot);
            }
            if self.rolling.is_some() {
                self.set_off_rolling(robot);
                continue;
            }
            self.robots[robot as usize].phase = Phase::Blocked;
            self.blocked.push(robot);
        }
        self.retry(|_, _| true);
    }
}
