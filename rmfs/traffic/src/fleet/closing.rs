//! Waypoints that are closed for a while, or for good: an elevator out of service, a spill.
//!
//! From then on, no robot enters them. A robot that is on one, or can no longer stop before it,
//! continues and leaves; a robot whose way leads there later is planned anew. If there is no other
//! way, it stops earlier, where it hinders no other robot, and waits. If there is no such place
//! either, it still drives through: a plan on which others rely is only replaced by one that is as
//! safe.

use std::sync::Arc;

use crate::reach::{carried_from, carried_to};
use crate::robot::{Phase, Robot};
use crate::search::Move;

use super::Fleet;
use super::planning::Effort;

/// Storage places and stations that cannot be served while waypoints are closed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CutOff {
    /// Storage places from which, or to which, a pod cannot be carried for one of the remaining
    /// stations.
    pub storage: Vec<u32>,
    /// Stations that no pod can reach or leave.
    pub stations: Vec<u32>,
}

impl Fleet {
    /// Closes waypoints. Returns the robots that still drive through one.
    ///
    /// # Errors
    /// If there is no such waypoint; nothing has changed then.
    pub fn close(&mut self, waypoints: &[u32]) -> Result<Vec<u32>, String> {
        self.set_closed(waypoints, true)?;
        let mut still = Vec::new();
        for robot in 0..self.robots.len() as u32 {
            let state = &self.robots[robot as usize];
            let Some(first) = self.first_closed(state) else { continue };
            let kind = &self.kinds[state.kind as usize];
            let begun = state.committed(&self.network, kind, self.now);
            if first < begun || !self.keeps_off(robot, begun, first) {
                still.push(robot);
            }
        }
        self.forget_wishes();
        self.retry(|_, _| true);
        Ok(still)
    }

    /// Reopens waypoints.
    ///
    /// # Errors
    /// If there is no such waypoint; nothing has changed then.
    pub fn reopen(&mut self, waypoints: &[u32]) -> Result<(), String> {
        self.set_closed(waypoints, false)?;
        self.forget_wishes();
        self.retry(|_, _| true);
        Ok(())
    }

    fn set_closed(&mut self, waypoints: &[u32], closed: bool) -> Result<(), String> {
        if let Some(waypoint) = waypoints.iter().find(|&&v| v as usize >= self.network.nodes) {
            return Err(format!("no waypoint {waypoint}"));
        }
        self.settle_all();
        let network = Arc::make_mut(&mut self.network);
        waypoints.iter().for_each(|&waypoint| network.set_closed(waypoint, closed));
        self.costs.forget();
        Ok(())
    }

    /// The first move of a robot's plan that enters a closed waypoint from an open one.
    fn first_closed(&self, state: &Robot) -> Option<usize> {
        state.moves.iter().position(|step| self.enters_closed(step))
    }

    fn enters_closed(&self, step: &Move) -> bool {
        let network = &self.network;
        if step.ride {
            return network.is_closed(step.to) && !network.is_closed(step.from);
        }
        let mut from = step.from;
        network.line(step.from, step.to, step.heading).any(|(to, _)| {
            let enters = network.is_closed(to) && !network.is_closed(from);
            from = to;
            enters
        })
    }

    /// Changes a plan that would enter a closed waypoint with its move `first`, and of which the
    /// moves up to `begun` cannot be changed. Returns whether that worked.
    fn keeps_off(&mut self, robot: u32, begun: usize, first: usize) -> bool {
        let state = &self.robots[robot as usize];
        let (phase, goal) = (state.phase, state.destination().0);
        let replanned = self.rolling.is_none() && self.plan(robot, goal, Effort::Full, begun);
        if replanned {
            // also who has not set off yet, or has given up its goal, has a plan to be changed
            self.robots[robot as usize].phase = phase;
            return true;
        }
        let Some(kept) = (begun..=first).rev().find(|&kept| self.can_stay_after(robot, kept))
        else {
            return false;
        };
        self.stop_after(robot, kept);
        true
    }

    /// Whether a robot can stay indefinitely where its first `kept` moves end.
    fn can_stay_after(&self, robot: u32, kept: usize) -> bool {
        let state = &self.robots[robot as usize];
        let (node, since) = match kept.checked_sub(1) {
            Some(last) => (state.moves[last].to, state.moves[last].end),
            None => (state.anchor, self.now),
        };
        let row = self.table.row(self.network.resource[node as usize]);
        let others = row.iter().filter(|used| used.robot != robot);
        !self.network.is_elevator(node) && others.clone().all(|used| used.end <= since)
    }

    /// Drops a robot's plan after its first moves; the robot stays there and tries again.
    fn stop_after(&mut self, robot: u32, kept: usize) {
        self.forget(robot);
        let state = &self.robots[robot as usize];
        let (phase, place) = (state.phase, state.place);
        self.adopt(robot, kept, Vec::new());
        let state = &mut self.robots[robot as usize];
        // also who lifts, or has given up its goal, may have had a plan
        state.phase = phase;
        let stop = state.destination().0;
        if let Some((station, _)) = place {
            let places = &self.network.stations[station as usize];
            if let Some(at) = places.iter().position(|&node| node == stop) {
                // it stays in the queue and moves up from there
                self.take_place(robot, station, at);
                return;
            }
            self.leave_queue(robot, station);
        }
        if self.rolling.is_none() && phase == Phase::Driving {
            self.robots[robot as usize].phase = Phase::Blocked;
            self.blocked.push(robot);
        }
    }

    /// Storage places and stations that cannot be served because of closed waypoints.
    pub fn cut_off(&self) -> CutOff {
        let network = &*self.network;
        let storage: Vec<u32> =
            (0..network.nodes as u32).filter(|&v| network.storage[v as usize]).collect();
        let mut result = CutOff::default();
        let mut reached = vec![true; network.nodes];
        for (station, places) in network.stations.iter().enumerate() {
            let head = places[0];
            let (to, from) = (carried_to(network, head), carried_from(network, head));
            let serves = |v: u32| to[v as usize] && from[v as usize];
            if network.is_closed(head) || !storage.iter().any(|&v| serves(v)) {
                result.stations.push(station as u32);
                continue;
            }
            storage.iter().for_each(|&v| reached[v as usize] &= serves(v));
        }
        let lost = |&v: &u32| network.is_closed(v) || !reached[v as usize];
        result.storage = storage.into_iter().filter(lost).collect();
        result
    }
}
