//! Improvement of plans, because first come, first served can be short-sighted.
//!
//! When a new plan is late, the plans of the robot and of those directly in front of it are removed
//! from the table, except for moves that have begun, and planned again, the late one first. The new
//! plans are adopted only if all are found and the sum of arrival times is less. Until then the old
//! ones remain valid.

use std::collections::{BTreeMap, VecDeque};

use crate::planner::{Agent, Answer, Scene};
use crate::postpone::postpone;
use crate::reservations::Interval;
use crate::robot::{Held, Phase, occupation};
use crate::search::Move;
use crate::units::Us;

use super::Fleet;
use super::planning::time_in_zone;

/// Delay from which improving a plan is attempted.
const LATE: Us = 2_000_000;

/// Maximum time between a robot's passage of a waypoint and that of a robot that may have waited
/// for it.
const CLOSE: Us = 1_000_000;

/// Maximum number of robots that are planned again together with a late one.
const OTHERS: usize = 3;

impl Fleet {
    /// Tries to improve the plans that have just been made.
    pub(super) fn improve(&mut self) {
        let fresh = std::mem::take(&mut self.fresh);
        if self.trip_planner.improvement() == 0 {
            return;
        }
        for robot in fresh {
            let others = if self.is_late(robot) { self.in_front_of(robot) } else { Vec::new() };
            if !others.is_empty() {
                let members: Vec<u32> = std::iter::once(robot).chain(others).collect();
                let effort = self.trip_planner.improvement();
                if self.replan_together(&members, effort) {
                    self.counters.improvements += 1;
                }
            }
        }
    }

    /// Whether a robot's new plan arrives late; the drive within a queue zone does not count, as in
    /// the unhindered time.
    fn is_late(&self, robot: u32) -> bool {
        let state = &self.robots[robot as usize];
        let Some(leg) = &self.legs[robot as usize] else { return false };
        let Some(unhindered) = leg.unhindered else { return false };
        let (goal, _, end) = state.destination();
        let moves: Vec<Move> = state.moves.iter().cloned().collect();
        let kind = &self.kinds[state.kind as usize];
        let zone = self.network.zone[goal as usize];
        let within = time_in_zone(&self.network, kind, &moves, zone);
        end - within - leg.ready - unhindered > LATE
    }

    /// Robots under way that use a waypoint directly before a robot enters it.
    fn in_front_of(&mut self, robot: u32) -> Vec<u32> {
        let mut found = Vec::new();
        let now = self.now;
        let held = self.robots[robot as usize].held.clone();
        for own in held.iter().filter(|own| own.start > now) {
            let mut row = self.table.row(own.resource).iter();
            let before = row.rfind(|used| used.robot != robot && used.end <= own.start).copied();
            if let Some(used) = before
                && own.start - used.end < CLOSE
                && self.can_change(used.robot)
                && !found.contains(&used.robot)
            {
                found.push(used.robot);
                if found.len() == OTHERS {
                    break;
                }
            }
        }
        found
    }

    /// Whether some part of a robot's plan has not begun.
    pub(super) fn can_change(&mut self, robot: u32) -> bool {
        self.settle(robot);
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        matches!(state.phase, Phase::Driving | Phase::Transferring)
            && state.committed(&self.network, kind, self.now) < state.moves.len()
    }

    /// Plans robots anew in this order, each with at most this number of labels; keeps the new
    /// plans if they are better. Returns whether they are.
    pub(super) fn replan_together(&mut self, members: &[u32], effort: u64) -> bool {
        let arrivals = |fleet: &Self| -> Us {
            members.iter().map(|&robot| fleet.robots[robot as usize].destination().2).sum()
        };
        let before = arrivals(self);
        let starts: Vec<(usize, Agent)> =
            members.iter().map(|&robot| self.where_it_can_choose(robot, effort)).collect();
        for &robot in members {
            self.forget(robot);
        }
        // what has begun stays in the table while the others are planned
        let begun: Vec<Vec<Held>> = starts
            .iter()
            .map(|(kept, agent)| {
                let moves = self.robots[agent.robot as usize].moves.range(..*kept);
                self.occupied(agent.robot, moves, Some(agent.ready))
            })
            .collect();
        for (held, &robot) in begun.iter().zip(members) {
            self.insert(robot, held);
        }
        let mut plans = BTreeMap::new();
        let mut reserved = begun;
        let mut after = 0;
        for (at, (kept, agent)) in starts.iter().enumerate() {
            self.take_out(agent.robot, &reserved[at]);
            reserved[at].clear();
            let Some(moves) = self.plan_again(agent) else { break };
            let state = &self.robots[agent.robot as usize];
            let plan: VecDeque<Move> = state.moves.range(..*kept).cloned().chain(moves).collect();
            after += plan.back().map_or(agent.ready, |last| last.end);
            reserved[at] = self.occupied(agent.robot, &plan, None);
            self.insert(agent.robot, &reserved[at]);
            plans.insert(agent.robot, plan);
        }
        for (held, &robot) in reserved.iter().zip(members) {
            self.take_out(robot, held);
        }
        for &robot in members {
            self.reserve(robot);
        }
        let better = plans.len() == members.len() && after < before;
        if better {
            self.follow(plans);
        }
        better
    }

    /// Number of moves of a robot that are kept; start, time and goal of the others.
    fn where_it_can_choose(&mut self, robot: u32, effort: u64) -> (usize, Agent) {
        self.settle(robot);
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let kept = state.committed(&self.network, kind, self.now);
        let (start, heading, rested) = match kept.checked_sub(1) {
            Some(last) => (state.moves[last].to, state.moves[last].heading, state.moves[last].end),
            None => (state.anchor, state.heading, state.rested),
        };
        let agent = Agent {
            robot,
            kind: state.kind,
            start,
            heading,
            ready: rested.max(self.now).max(state.busy_until),
            goal: state.destination().0,
            loaded: state.pod.is_some(),
            effort,
            needs_plan: true,
        };
        (kept, agent)
    }

    fn plan_again(&mut self, agent: &Agent) -> Option<Vec<Move>> {
        let Fleet {
            network, kinds, robots, table, pathfinder, costs, trip_planner, guidance, ..
        } = self;
        let guidance = guidance.as_ref();
        let holder = table.final_holder(network.resource[agent.goal as usize]);
        if holder.is_some_and(|holder| holder != agent.robot) {
            return None;
        }
        let mut scene =
            Scene { now: self.now, network, kinds, robots, table, pathfinder, costs, guidance };
        let answer = trip_planner.plan(&mut scene, std::slice::from_ref(agent)).pop();
        let Some(Answer::Way(mut moves)) = answer else { return None };
        postpone(network, table, &kinds[agent.kind as usize], &mut moves);
        Some(moves)
    }

    /// What a robot occupies with these moves; the end indefinitely, or until a time.
    fn occupied<'a>(
        &self,
        robot: u32,
        moves: impl IntoIterator<Item = &'a Move>,
        until: Option<Us>,
    ) -> Vec<Held> {
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let mut held = occupation(&self.network, kind, state.anchor, state.anchored, moves);
        if let (Some(until), Some(last)) = (until, held.last_mut()) {
            last.end = until;
        }
        held.retain(|held| held.end > self.now.max(held.start));
        held
    }

    fn insert(&mut self, robot: u32, held: &[Held]) {
        for held in held {
            let interval = Interval { start: held.start, end: held.end, robot };
            self.table.insert(held.resource, interval, self.now);
        }
    }

    fn take_out(&mut self, robot: u32, held: &[Held]) {
        for held in held {
            self.table.remove(held.resource, robot);
        }
    }
}
