//! Queues of stations: places are assigned in the order of expected arrival.
//!
//! A robot bound for a station gets the first place behind those that will arrive before it; when
//! places become free, all robots move up in the order of places, whether driving or standing.
//! Robots are ordered by place, never by the time of their command: with short cuts a later robot
//! may overtake, and a queue ordered otherwise would freeze.

use crate::robot::Phase;
use crate::search::Move;
use crate::units::Us;

use super::Fleet;
use super::planning::Effort;

impl Fleet {
    pub(super) fn place_of(&self, robot: u32) -> usize {
        self.robots[robot as usize].place.expect("it is in a queue").1
    }

    /// Assigns the robot a place in the station's queue and plans its way there.
    pub(super) fn plan_station(&mut self, robot: u32, station: u32) -> bool {
        if self.robots[robot as usize].queues_at(station) {
            let place = self.place_of(robot);
            if place == 0 && self.robots[robot as usize].moves.is_empty() {
                self.at_head(robot, station);
            }
            return true;
        }
        let left_place = self.robots[robot as usize].place;
        let last = self.queues[station as usize].len();
        let wanted = self.rank(robot, station);
        let joined =
            (wanted < last && self.make_room(station, wanted) && self.join(robot, station, wanted))
                || self.join(robot, station, last);
        if joined && let Some((old, _)) = left_place {
            self.leave_queue_list(robot, old);
        }
        self.move_up(station);
        joined
    }

    /// The rank in the queue by expected arrival at its head; robots in the zone are not overtaken.
    pub(super) fn rank(&mut self, robot: u32, station: u32) -> usize {
        let head = self.network.stations[station as usize][0];
        let mine = self.expected(robot, head);
        let queue = &self.queues[station as usize];
        let mut rank = queue.len();
        while rank > 0 {
            let other = queue[rank - 1];
            let state = &self.robots[other as usize];
            let inside = |node: u32| {
                self.network.zone[node as usize] == station
                    || self.network.stations[station as usize].contains(&node)
            };
            if inside(state.anchor) || inside(state.next_stop(self.now)) {
                break;
            }
            let (node, heading, end) = state.destination();
            let to_go = self.costs.towards(&self.network, head, state.kind, state.pod.is_some())
                [self.network.index(node, heading)];
            if end + Us::from(to_go) <= mine {
                break;
            }
            rank -= 1;
        }
        rank
    }

    /// Earliest time at which the robot could be at `head` without hindrance.
    pub(super) fn expected(&mut self, robot: u32, head: u32) -> Us {
        let state = &self.robots[robot as usize];
        let ready = state.rested.max(self.now).max(state.busy_until);
        let table = self.costs.towards(&self.network, head, state.kind, state.pod.is_some());
        ready + Us::from(table[self.network.index(state.anchor, state.heading)])
    }

    /// Moves robots from `rank` on back by a place where needed. Returns whether a place is free.
    pub(super) fn make_room(&mut self, station: u32, rank: usize) -> bool {
        let queue = self.queues[station as usize].clone();
        let first = if rank == 0 { 0 } else { self.place_of(queue[rank - 1]) + 1 };
        let mut back: Vec<(u32, usize)> = Vec::new();
        for (i, &other) in queue[rank..].iter().enumerate() {
            let place = first + 1 + i;
            if self.place_of(other) >= place {
                break;
            }
            back.push((other, place));
        }
        let places = self.network.stations[station as usize].len();
        back.iter().all(|&(_, place)| place < places)
            && back.iter().rev().all(|&(other, place)| self.change_place(other, station, place))
    }

    /// Plans the robot to the first place behind those ranked before it.
    pub(super) fn join(&mut self, robot: u32, station: u32, rank: usize) -> bool {
        let queue = &self.queues[station as usize];
        let place = if rank == 0 { 0 } else { self.place_of(queue[rank - 1]) + 1 };
        let taken = queue.get(rank).is_some_and(|&next| self.place_of(next) <= place);
        let Some(&goal) = self.network.stations[station as usize].get(place) else { return false };
        let effort =
            if rank < self.queues[station as usize].len() { Effort::Try } else { Effort::Full };
        if taken || !self.plan(robot, goal, effort, 0) {
            return false;
        }
        self.queues[station as usize].insert(rank, robot);
        self.robots[robot as usize].place = Some((station, place));
        true
    }

    /// Replans the last part of a robot's way to another place of the queue it is bound for.
    pub(super) fn change_place(&mut self, robot: u32, station: u32, place: usize) -> bool {
        self.settle(robot);
        let goal = self.network.stations[station as usize][place];
        let outside = |step: &&Move| {
            self.network.zone[step.to as usize] != station
                && !self.network.stations[station as usize].contains(&step.to)
        };
        let state = &self.robots[robot as usize];
        let (phase, kept) = (state.phase, state.moves.iter().take_while(outside).count());
        let changed = self.plan(robot, goal, Effort::Try, kept);
        if changed {
            self.robots[robot as usize].place = Some((station, place));
        }
        if matches!(phase, Phase::Transferring | Phase::Planning) {
            self.robots[robot as usize].phase = phase;
        }
        changed
    }

    /// Moves all robots up as far as places are free.
    pub(super) fn move_up(&mut self, station: u32) {
        let mut first_free = 0;
        for robot in self.queues[station as usize].clone() {
            let place = self.place_of(robot);
            if place > first_free && self.change_place(robot, station, first_free) {
                first_free += 1;
                continue;
            }
            if place > first_free && !self.stalled.contains(&station) {
                self.stalled.push(station);
                self.schedule_retry();
            }
            first_free = place + 1;
        }
    }

    /// Records the robot's place in the queue, which no other robot may have.
    pub(super) fn take_place(&mut self, robot: u32, station: u32, place: usize) {
        self.queues[station as usize].retain(|&other| other != robot);
        let queue = &self.queues[station as usize];
        let rank = queue.partition_point(|&other| self.place_of(other) < place);
        self.queues[station as usize].insert(rank, robot);
        self.robots[robot as usize].place = Some((station, place));
    }

    pub(super) fn leave_queue(&mut self, robot: u32, station: u32) {
        self.robots[robot as usize].place = None;
        self.leave_queue_list(robot, station);
    }

    pub(super) fn leave_queue_list(&mut self, robot: u32, station: u32) {
        self.queues[station as usize].retain(|&other| other != robot);
        self.move_up(station);
    }
}
