//! Replanning of all robots from their actual positions.
//!
//! When a robot is not where it should be, plans are invalid: all robots stop at the last waypoint
//! they may use and are planned anew from there.

use std::collections::{HashMap, HashSet};

use crate::robot::{Phase, Robot};
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
    /// Puts robots at rest at their actual positions and plans their programs anew. A robot without
    /// a rest continues its run as far as the way is clear, and keeps everything it occupies until
    /// it stands there.
    ///
    /// # Errors
    /// If there is not one entry per robot, or two would have one waypoint; nothing has changed
    /// then.
    pub fn regroup(&mut self, rests: &[Option<Rest>]) -> Result<(), String> {
        if rests.len() != self.robots.len() {
            return Err(format!("{} rests for {} robots", rests.len(), self.robots.len()));
        }
        self.settle_all();
        let robots: Vec<Robot> =
            rests.iter().enumerate().map(|(robot, rest)| self.moved(robot, *rest)).collect();
        self.check_apart(&robots)?;
        for robot in 0..self.robots.len() as u32 {
            self.forget(robot);
        }
        for (robot, state) in robots.iter().enumerate() {
            if rests[robot].is_some() {
                let old = &self.robots[robot];
                let kind = &self.kinds[old.kind as usize];
                self.record.abandon(&self.network, kind, robot as u32, old, state, self.now);
            }
        }
        self.robots = robots;
        for robot in 0..self.robots.len() as u32 {
            self.occupy(robot);
        }
        self.begin_again();
        Ok(())
    }

    /// Sets the robot to its rest, or to the clear part of its present run.
    fn moved(&mut self, robot: usize, rest: Option<Rest>) -> Robot {
        let clear = self.clearance(robot as u32).last().copied();
        let mut state = self.robots[robot].clone();
        state.version += 1;
        if let Some(rest) = rest {
            state.moves.clear();
            (state.anchor, state.heading) = (rest.waypoint, rest.heading);
            (state.anchored, state.rested) = (self.now, rest.time.max(self.now));
            return state;
        }
        let kind = &self.kinds[state.kind as usize];
        let begun = state.committed(&self.network, kind, self.now);
        state.moves.truncate(if clear.is_some() { begun } else { 0 });
        if let (Some(step), Some(clear)) = (state.moves.front_mut(), clear)
            && step.to != clear
            && !step.ride
        {
            // it stops sooner: what it occupies until then stays its own
            step.to = clear;
            let line = self.network.line(step.from, clear, step.heading);
            let length = line.last().map_or(0.0, |(_, distance)| distance);
            step.end = step.start + step.late + kind.run_time(length);
        }
        state
    }

    fn check_apart(&self, robots: &[Robot]) -> Result<(), String> {
        let mut holders = HashMap::new();
        for (robot, state) in robots.iter().enumerate() {
            let (end, ..) = state.destination();
            if end as usize >= self.network.nodes {
                return Err(format!("no waypoint {end}"));
            }
            let used: HashSet<u32> = state
                .occupation(&self.network, &self.kinds[state.kind as usize])
                .iter()
                .filter(|held| held.end > self.now)
                .map(|held| held.resource)
                .collect();
            for resource in used {
                if let Some(other) = holders.insert(resource, robot) {
                    return Err(format!(
                        "robots {other} and {robot} cannot both have waypoint {resource}"
                    ));
                }
            }
        }
        Ok(())
    }

    /// Lets every robot that was under way search for a new way.
    fn begin_again(&mut self) {
        self.blocked.clear();
        for robot in 0..self.robots.len() as u32 {
            let state = &self.robots[robot as usize];
            let phase = state.phase;
            if phase == Phase::Idle {
                // who was served and is elsewhere now holds no place that it would be moved from
                if let Some((station, place)) = state.place
                    && state.anchor != self.network.stations[station as usize][place]
                {
                    self.robots[robot as usize].place = None;
                    self.queues[station as usize].retain(|&other| other != robot);
                }
                continue;
            }
            // who lifts may have planned its way to a place
            if let Some((station, _)) = self.robots[robot as usize].place.take() {
                self.queues[station as usize].retain(|&other| other != robot);
            }
            if matches!(phase, Phase::Transferring | Phase::Planning) {
                continue;
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
