//! Programs: the steps of a robot, and the events it reports.

use std::cmp::Reverse;

use crate::record::{Piece, Trip, TripKind};
use crate::robot::{Phase, Step};
use crate::units::Us;

use super::pace::Reply;
use super::planning::Effort;
use super::{Due, EventKind, Fleet};

impl Fleet {
    /// Starts the first step of the robot's program.
    pub(super) fn begin(&mut self, robot: u32) {
        self.legs[robot as usize] = None;
        match self.robots[robot as usize].program.front().copied() {
            None => {
                self.robots[robot as usize].phase = Phase::Idle;
                let at = self.robots[robot as usize].destination().0;
                self.emit(EventKind::Idle, robot, at);
            }
            Some(Step::Drive(_) | Step::Station(_)) => self.set_off(robot),
            Some(Step::Lift(pod)) => self.lift(robot, pod),
            Some(Step::SetDown(pod)) => self.set_down(robot, pod),
        }
    }

    /// Plans the way of a driving step; without one the robot is blocked and tries again later.
    pub(super) fn set_off(&mut self, robot: u32) {
        if self.rolling.is_some() {
            return self.set_off_rolling(robot);
        }
        let state = &mut self.robots[robot as usize];
        if self.pace.is_some() && state.phase == Phase::Transferring {
            // its lift or set-down has ended
            state.phase = Phase::Planning;
        }
        if self.ask_for_plan(robot, false) == Reply::NoWay {
            self.wait_for_a_way(robot);
        }
    }

    /// Plans the first step of the program, a driving one. Returns whether that worked.
    pub(super) fn plan_step(&mut self, robot: u32) -> bool {
        match self.robots[robot as usize].program.front().copied() {
            Some(Step::Drive(goal)) => self.plan_drive(robot, goal),
            Some(Step::Station(station)) => self.plan_station(robot, station),
            _ => unreachable!("only driving steps are planned"),
        }
    }

    pub(super) fn plan_drive(&mut self, robot: u32, goal: u32) -> bool {
        let left_place = self.robots[robot as usize].place;
        if !self.plan(robot, goal, Effort::Full, 0) {
            return false;
        }
        if let Some((station, _)) = left_place {
            self.leave_queue(robot, station);
        }
        true
    }

    pub(super) fn lift(&mut self, robot: u32, pod: u32) {
        self.emit(EventKind::LiftStarted, robot, pod);
        let state = &mut self.robots[robot as usize];
        state.pod = Some(pod);
        self.start_transfer(robot);
        // plan ahead, so that the robot leaves the moment it has its pod
        let state = &mut self.robots[robot as usize];
        let drives_on = matches!(state.program.get(1), Some(Step::Drive(_) | Step::Station(_)));
        if let Some(pace) = &self.pace {
            if drives_on && !pace.lazy {
                self.ask_for_plan(robot, false);
            }
        } else if drives_on && self.rolling.is_none() {
            let step = state.program.pop_front().expect("the lift");
            self.plan_step(robot);
            let state = &mut self.robots[robot as usize];
            state.program.push_front(step);
            state.phase = Phase::Transferring;
        }
    }

    pub(super) fn set_down(&mut self, robot: u32, pod: u32) {
        self.emit(EventKind::SetDownStarted, robot, pod);
        self.start_transfer(robot);
    }

    pub(super) fn start_transfer(&mut self, robot: u32) {
        let now = self.now;
        let state = &mut self.robots[robot as usize];
        state.phase = Phase::Transferring;
        // a robot that is broken down begins when it can
        let begin = now.max(state.busy_until);
        state.transfer_end = begin + self.kinds[state.kind as usize].pod_transfer;
        state.busy_until = state.transfer_end;
        self.agenda.push(Reverse((state.transfer_end, robot, Due::TransferEnd, 0)));
    }

    pub(super) fn transfer_ended(&mut self, robot: u32) {
        self.stand_until_transfer(robot);
        let state = &mut self.robots[robot as usize];
        let (step, node, heading) =
            (state.program.pop_front().expect("a transfer"), state.anchor, state.heading);
        match step {
            Step::Lift(pod) => {
                self.stored[node as usize] = false;
                self.record.transfer(robot, self.now, node, heading, pod, Piece::Lift);
                self.emit(EventKind::Lifted, robot, pod);
            }
            Step::SetDown(pod) => {
                state.pod = None;
                self.stored[node as usize] = true;
                self.record.transfer(robot, self.now, node, heading, pod, Piece::SetDown);
                self.emit(EventKind::SetDown, robot, pod);
            }
            Step::Drive(_) | Step::Station(_) => unreachable!("a transfer ended"),
        }
        if let Some(leg) = &mut self.legs[robot as usize] {
            // planned while the robot lifted its pod: it begins now
            leg.energy_before = self.record.used(robot);
        }
        let state = &mut self.robots[robot as usize];
        if state.moves.is_empty() {
            self.begin(robot);
        } else if self.gets_there(robot) {
            self.robots[robot as usize].phase = Phase::Driving;
        } else {
            // its plan has been cut short while it was lifting
            self.wait_for_a_way(robot);
        }
    }

    /// Whether the robot's plan ends at the destination of the first step of its program.
    fn gets_there(&self, robot: u32) -> bool {
        let state = &self.robots[robot as usize];
        match state.program.front() {
            Some(&Step::Drive(goal)) => state.destination().0 == goal,
            Some(&Step::Station(station)) => state.queues_at(station),
            _ => false,
        }
    }

    /// Lets the robot continue to the end of its plan, and repeatedly try to continue from there.
    pub(super) fn wait_for_a_way(&mut self, robot: u32) {
        let state = &mut self.robots[robot as usize];
        state.phase = Phase::Blocked;
        if self.legs[robot as usize].is_none() {
            let (from, _, rested) = state.destination();
            let stands_from = if self.pace.is_some() {
                state.awaits.0
            } else {
                rested.max(self.now).max(state.busy_until)
            };
            self.legs[robot as usize] = Some(self.new_leg(robot, from, stands_from));
        }
        self.blocked.push(robot);
        self.schedule_retry();
    }

    pub(super) fn leg_ended(&mut self, robot: u32) {
        self.settle(robot);
        let state = &self.robots[robot as usize];
        debug_assert!(state.moves.is_empty());
        if state.phase != Phase::Driving {
            // a blocked robot came to the end of what it still had to drive
            return;
        }
        if self.rolling.is_some() {
            return self.run_ended(robot);
        }
        match state.program.front().copied() {
            Some(Step::Drive(goal)) if state.anchor == goal => self.arrived(robot, goal),
            Some(Step::Station(station)) if state.queues_at(station) => {
                self.stopped_in_queue(robot, station);
            }
            _ => self.wait_for_a_way(robot),
        }
    }

    pub(super) fn arrived(&mut self, robot: u32, goal: u32) {
        let state = &self.robots[robot as usize];
        let kind = match (state.pod, state.program.get(1)) {
            (None, Some(Step::Lift(_))) => TripKind::ToPod,
            (None, _) => TripKind::ToRest,
            (Some(_), _) => TripKind::ToStorage,
        };
        self.finish_trip(robot, kind, self.now);
        self.emit(EventKind::Arrived, robot, goal);
        self.robots[robot as usize].program.pop_front();
        self.begin(robot);
    }

    pub(super) fn stopped_in_queue(&mut self, robot: u32, station: u32) {
        let (_, place) = self.robots[robot as usize].place.expect("planned to a place");
        if place > 0 {
            self.move_up(station);
            return;
        }
        let entered =
            self.legs[robot as usize].as_ref().and_then(|leg| leg.zone_entered).unwrap_or(self.now);
        self.record.totals[robot as usize].queueing += self.now - entered.max(self.record.since);
        self.finish_trip(robot, TripKind::ToStation, entered);
        self.at_head(robot, station);
    }

    pub(super) fn at_head(&mut self, robot: u32, station: u32) {
        self.robots[robot as usize].program.pop_front();
        self.robots[robot as usize].phase = Phase::Idle;
        self.emit(EventKind::AtHead, robot, station);
    }

    pub(super) fn finish_trip(&mut self, robot: u32, kind: TripKind, end: Us) {
        let state = &self.robots[robot as usize];
        let Some(leg) = self.legs[robot as usize].take() else { return };
        self.record.trips.push(Trip {
            robot,
            kind,
            start: leg.start.min(end),
            end,
            from: leg.from,
            to: state.anchor,
            loaded: state.pod.is_some(),
            distance: self.record.totals[robot as usize].distance - leg.distance_before,
            unhindered: leg.unhindered.unwrap_or(0),
            energy: self.record.used(robot) - leg.energy_before,
            awaited: leg.awaited.min(end - leg.start.min(end)),
        });
    }
}
