//! Planning of one leg, and adoption of the plan.

use std::cmp::Reverse;
use std::time::Instant;

use crate::kinematics::Kind;
use crate::network::Network;
use crate::planner::{Agent, Answer, Scene};
use crate::postpone::postpone;
use crate::record::enters_zone;
use crate::reservations::Interval;
use crate::robot::{Phase, Robot};
use crate::search::Move;
use crate::units::Us;

use super::disturbed::turn;
use super::pace::{departure, stop_for};
use super::{Due, EventKind, Fleet, Leg};

/// Effort of the search for a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effort {
    /// The robot needs it.
    Full,
    /// The plan would be better than the robot's present one.
    Try,
}

impl Effort {
    fn labels(self) -> u64 {
        match self {
            Effort::Full => u64::MAX,
            Effort::Try => 300,
        }
    }
}

impl Fleet {
    /// Plans from the first rest that can still be chosen to `goal` and, if that works, makes it
    /// the robot's plan. The first `keep` moves, and those that have begun, are not changed.
    pub(super) fn plan(&mut self, robot: u32, goal: u32, effort: Effort, keep: usize) -> bool {
        let begun = Instant::now();
        let planned = self.plan_untimed(robot, goal, effort, keep);
        self.counters.called(begun.elapsed());
        planned
    }

    fn plan_untimed(&mut self, robot: u32, goal: u32, effort: Effort, keep: usize) -> bool {
        self.settle(robot);
        let Fleet {
            network,
            kinds,
            robots,
            table,
            pathfinder,
            costs,
            trip_planner,
            pace,
            guidance,
            ..
        } = self;
        let guidance = guidance.as_ref();
        let state = &robots[robot as usize];
        let kind = &kinds[state.kind as usize];
        let holder = table.final_holder(network.resource[goal as usize]);
        if network.is_closed(goal) || holder.is_some_and(|holder| holder != robot) {
            self.counters.failures += 1;
            return false;
        }
        let mut kept = state.committed(network, kind, self.now).max(keep);
        let agent_after = |kept: usize, not_before: Us| {
            let (start, heading, rested) = stop_after(state, kept);
            Agent {
                robot,
                kind: state.kind,
                start,
                heading,
                ready: rested.max(self.now).max(state.busy_until).max(not_before),
                goal,
                loaded: state.pod.is_some(),
                effort: effort.labels(),
                needs_plan: true,
            }
        };
        for held in &state.held {
            table.remove(held.resource, robot);
        }
        let now = self.now;
        let mut pace = pace.as_mut().filter(|pace| pace.turn_of(robot).is_some());
        if let Some(pace) = &pace {
            kept = stop_for(network, table, state, now, kept, now + pace.known());
        }
        let in_turn = pace.is_some();
        let mut agent = agent_after(kept, now);
        let (begun, labels) = (Instant::now(), pathfinder.expansions);
        let mut scene = Scene { now, network, kinds, robots, table, pathfinder, costs, guidance };
        let mut answer = trip_planner.plan(&mut scene, std::slice::from_ref(&agent)).pop();
        let mut awaited = 0;
        let mut could_depart = agent.ready;
        if let Some(pace) = &mut pace {
            let labels = pathfinder.expansions - labels;
            let found = matches!(answer, Some(Answer::Way(_)));
            let until = now + pace.charge(now, labels, begun.elapsed(), found);
            if let Some(Answer::Way(moves)) = &answer
                && departure(network, kind, moves) < until
            {
                // its plan is there later than it departs: the search is repeated from then on
                kept = stop_for(network, table, state, now, kept, until);
                agent = agent_after(kept, until);
                let mut scene =
                    Scene { now, network, kinds, robots, table, pathfinder, costs, guidance };
                answer = trip_planner.plan(&mut scene, std::slice::from_ref(&agent)).pop();
            }
            let turn = pace.turn_of(robot).expect("its turn");
            could_depart = turn.could_depart(stop_after(state, kept).2);
            awaited = (until - could_depart).max(0);
        }
        let (start, heading) = (agent.start, agent.heading);
        let Some(Answer::Way(mut moves)) = answer else {
            self.counters.failures += 1;
            self.reserve(robot);
            return false;
        };
        // a trip to a station ends at its queue zone, and so does the time it is compared with
        let zone = network.zone[goal as usize];
        let unhindered = pathfinder.unhindered(network, start, heading)
            - time_in_zone(network, kind, &moves, zone);
        postpone(network, table, kind, &mut moves);
        let departs = kept == 0 && !moves.is_empty();
        if self.legs[robot as usize].as_ref().is_some_and(|leg| leg.unhindered.is_some()) {
            self.counters.replans += 1;
        } else {
            self.counters.plans += 1;
            let new = self.new_leg(robot, start, could_depart);
            let waiting = self.legs[robot as usize].take();
            // a leg begins when the robot begins to stand without a way
            let leg = waiting.filter(|leg| leg.start <= could_depart).unwrap_or(new);
            self.legs[robot as usize] =
                Some(Leg { ready: could_depart, unhindered: Some(unhindered), awaited, ..leg });
        }
        if in_turn {
            self.robots[robot as usize].awaits = (could_depart, could_depart + awaited);
        }
        self.adopt(robot, kept, moves);
        if departs && self.network.storage[start as usize] {
            self.emit(EventKind::Departed, robot, start);
        }
        self.released.push(start);
        self.fresh.push(robot);
        true
    }

    /// A leg for which no way has been found yet.
    pub(super) fn new_leg(&self, robot: u32, from: u32, start: Us) -> Leg {
        Leg {
            from,
            start,
            ready: start,
            unhindered: None,
            distance_before: self.record.totals[robot as usize].distance,
            energy_before: self.record.used(robot),
            zone_entered: None,
            awaited: 0,
        }
    }

    /// Makes the kept moves and the new ones the robot's plan.
    pub(super) fn adopt(&mut self, robot: u32, kept: usize, moves: Vec<Move>) {
        let state = &mut self.robots[robot as usize];
        state.moves.truncate(kept);
        state.moves.extend(moves);
        state.version += 1;
        state.phase = Phase::Driving;
        let (_, _, end) = state.destination();
        let due = end.max(self.now).max(state.busy_until);
        self.agenda.push(Reverse((due, robot, Due::LegEnd, state.version)));
        self.occupy(robot);
        self.expect_motion(robot);
    }

    /// Computes what the robot's plan occupies and reserves it.
    pub(super) fn occupy(&mut self, robot: u32) {
        let state = &mut self.robots[robot as usize];
        state.held = state.occupation(&self.network, &self.kinds[state.kind as usize]);
        self.reserve(robot);
    }

    pub(super) fn reserve(&mut self, robot: u32) {
        for held in &self.robots[robot as usize].held {
            if held.end > self.now {
                let interval = Interval { start: held.start, end: held.end, robot };
                self.table.insert(held.resource, interval, self.now);
            }
        }
    }
}

/// Where a robot stands after some of its moves, with heading and time.
fn stop_after(state: &Robot, kept: usize) -> (u32, u8, Us) {
    match kept.checked_sub(1) {
        Some(last) => (state.moves[last].to, state.moves[last].heading, state.moves[last].end),
        None => (state.anchor, state.heading, state.rested),
    }
}

/// Time of a plan that ends in a queue zone from entering the zone to its end, without the waits
/// between its moves there.
pub(super) fn time_in_zone(network: &Network, kind: &Kind, moves: &[Move], zone: u32) -> Us {
    let enters = |(index, step): (usize, &Move)| {
        enters_zone(network, kind, step, zone).map(|at| (index, at))
    };
    let Some((first, at)) = moves.iter().enumerate().find_map(enters) else { return 0 };
    let within = &moves[first..];
    let waits: Us = within
        .windows(2)
        .map(|pair| pair[1].start - turn(network, kind, &pair[1]) - pair[0].end)
        .sum();
    within[within.len() - 1].end - at - waits
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::tests::KIND;
    use crate::network::Plan;

    /// Three waypoints in a row, a metre apart; the second and third are the queue of a station.
    fn queue() -> Network {
        Network::new(Plan {
            x: vec![0.0, 1.0, 2.0],
            y: vec![0.0; 3],
            tier: vec![0; 3],
            edge_start: vec![0, 1, 2, 2],
            edge_target: vec![1, 2],
            storage: vec![false; 3],
            queue: vec![false, true, true],
            stations: vec![vec![2, 1]],
            ..Plan::default()
        })
        .expect("a queue")
    }

    fn step(from: u32, start: Us) -> Move {
        Move {
            from,
            to: from + 1,
            heading: 0,
            heading_before: 0,
            start,
            end: start + 2_828_428,
            ride: false,
            late: 0,
            begun: 0,
        }
    }

    #[test]
    fn waits_in_the_queue_are_not_time_of_the_drive() {
        let network = queue();
        let zone = network.zone[2];
        let time = |second| time_in_zone(&network, &KIND, &[step(0, 0), step(1, second)], zone);
        // the queue is entered when the first step ends; times of entering are rounded down
        assert_eq!(time(2_828_428), 2_828_429);
        assert_eq!(time(9_000_000), 2_828_429);
    }
}
