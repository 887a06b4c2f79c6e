//! Driving by the proposals of a rolling planner, granted a few straight runs at a time.
//!
//! A robot at rest requests the next runs of its proposal when it is to turn for the first. Of
//! these, the longest sequence is granted that the planner allows, that is free, and at whose end
//! the robot can stay indefinitely. If not even the first run can be granted, the proposal is
//! dropped and a new plan is needed. A run onto an elevator is granted only together with the
//! ride and the run that leaves the shaft. A robot that stops in the queue of its station has
//! arrived there: from then on it moves up like all others in the queue (`queues.rs`).

use std::cmp::Reverse;
use std::collections::VecDeque;
use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::network::NONE;
use crate::planner::{Agent, Answer, Planner, Rhythm, Scene};
use crate::robot::{Phase, Step, occupation};
use crate::route::{Leg as Way, route};
use crate::search::Move;
use crate::units::Us;

use super::planning::time_in_zone;
use super::{Due, EventKind, Fleet, Leg};

/// A rolling planner and its proposals.
#[derive(Clone, Debug)]
pub struct Rolling {
    pub planner: Box<dyn Planner>,
    period: Us,
    /// Maximum number of runs granted at once.
    runs: usize,
    pub wishes: Wishes,
}

/// The proposals of a rolling planner for each robot, and the time of its next call.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Wishes {
    ways: Vec<VecDeque<Move>>,
    needs_plan: Vec<bool>,
    /// Changes with every proposal, so that departures of old ones are recognised.
    serial: Vec<u32>,
    last_call: Us,
    call_due: bool,
}

impl Rolling {
    /// State without proposals; returns the planner itself if it is a trip planner.
    pub fn of(planner: Box<dyn Planner>, robots: usize) -> Result<Self, Box<dyn Planner>> {
        let Rhythm::Rolling { period, runs } = planner.rhythm() else { return Err(planner) };
        Ok(Self {
            planner,
            period,
            runs,
            wishes: Wishes {
                ways: vec![VecDeque::new(); robots],
                needs_plan: vec![false; robots],
                serial: vec![0; robots],
                last_call: -period,
                call_due: false,
            },
        })
    }

    fn replace(&mut self, robot: u32, wish: Vec<Move>) {
        self.wishes.ways[robot as usize] = wish.into();
        self.wishes.serial[robot as usize] += 1;
    }
}

impl Fleet {
    /// Replaces a rolling planner by another one of the same rhythm.
    pub fn exchange_planner(&mut self, planner: Box<dyn Planner>) {
        if let Some(rolling) = &mut self.rolling {
            rolling.planner = planner;
        }
    }

    /// Starts a driving step: the robot waits for a plan, or for the end of its motion in progress.
    pub(super) fn set_off_rolling(&mut self, robot: u32) {
        let begun = Instant::now();
        self.begin_leg(robot);
        self.counters.planning += begun.elapsed();
        let rolling = self.rolling.as_mut().expect("a rolling planner");
        rolling.replace(robot, Vec::new());
        let state = &mut self.robots[robot as usize];
        state.phase = Phase::Driving;
        if state.moves.is_empty() {
            // it may be where it wants to be
            state.version += 1;
            let due = self.now.max(state.busy_until);
            self.agenda.push(Reverse((due, robot, Due::LegEnd, state.version)));
        }
        self.need_plan(robot);
    }

    /// Handles that the robot stopped, at its destination or on the way.
    pub(super) fn run_ended(&mut self, robot: u32) {
        let state = &self.robots[robot as usize];
        let anchor = state.anchor;
        match state.program.front().copied() {
            Some(Step::Drive(goal)) if anchor == goal => return self.arrived(robot, goal),
            Some(Step::Station(station)) if state.queues_at(station) => {
                return self.stopped_in_queue(robot, station);
            }
            Some(Step::Station(station)) => {
                let places = &self.network.stations[station as usize];
                if let Some(place) = places.iter().position(|&node| node == anchor) {
                    return self.enter_queue(robot, station, place);
                }
            }
            _ => {}
        }
        self.robots[robot as usize].phase = Phase::Blocked;
        self.depart(robot);
    }

    /// Takes the place in the queue at which the robot stands.
    fn enter_queue(&mut self, robot: u32, station: u32, place: usize) {
        if let Some((old, _)) = self.robots[robot as usize].place {
            self.leave_queue(robot, old);
        }
        self.take_place(robot, station, place);
        self.rolling.as_mut().expect("a rolling planner").replace(robot, Vec::new());
        self.stopped_in_queue(robot, station);
        self.move_up(station);
    }

    /// Requests the next run of a resting robot's proposal, or schedules the request.
    pub(super) fn depart(&mut self, robot: u32) {
        if !self.departs_now(robot) {
            self.refuse(robot);
        }
    }

    /// Starts the first run of a resting robot's proposal, schedules it, or records that a proposal
    /// is needed. Returns false if it was refused.
    fn departs_now(&mut self, robot: u32) -> bool {
        let rolling = self.rolling.as_mut().expect("a rolling planner");
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let fits =
            |first: &&Move| first.from == state.anchor && first.heading_before == state.heading;
        let Some(first) = rolling.wishes.ways[robot as usize].front().filter(fits) else {
            self.drop_wish(robot);
            return true;
        };
        let turn = kind.turn(
            self.network.headings[first.heading_before as usize],
            self.network.headings[first.heading as usize],
        );
        let due = first.start - turn;
        if due > self.now {
            let serial = rolling.wishes.serial[robot as usize];
            self.agenda.push(Reverse((due, robot, Due::Depart, serial)));
            return true;
        }
        self.is_granted(robot, self.now - due)
    }

    /// Lets resting robots request the first runs of their new proposals. A robot that is refused
    /// requests again when another one has been granted its run, which may have made room.
    fn depart_together(&mut self, mut robots: Vec<u32>) {
        loop {
            let before = robots.len();
            robots.retain(|&robot| !self.departs_now(robot));
            if robots.is_empty() || robots.len() == before {
                break;
            }
        }
        robots.into_iter().for_each(|robot| self.refuse(robot));
    }

    /// Handles that it is time to turn for the first run of a proposal.
    pub(super) fn departure_due(&mut self, robot: u32, serial: u32) {
        let rolling = self.rolling.as_ref().expect("a rolling planner");
        if rolling.wishes.serial[robot as usize] == serial {
            self.depart(robot);
        }
    }

    /// Grants the first runs of the proposal, delayed by `late`: as many as are allowed and free.
    fn is_granted(&mut self, robot: u32, late: Us) -> bool {
        let rolling = self.rolling.as_mut().expect("a rolling planner");
        let wish = &mut rolling.wishes.ways[robot as usize];
        for step in wish.iter_mut() {
            step.start += late;
            step.end += late;
        }
        let outside = |at: &usize| !self.network.is_elevator(wish[*at].to);
        let ends: Vec<usize> = (0..wish.len()).filter(outside).take(rolling.runs).collect();
        let most = ends.last().map_or(0, |last| last + 1);
        let moves: Vec<Move> = wish.range(..most).cloned().collect();
        for &last in ends.iter().rev() {
            if self.is_free(robot, &moves[..=last]) {
                let rolling = self.rolling.as_mut().expect("a rolling planner");
                rolling.wishes.ways[robot as usize].drain(..=last);
                let moves = moves[..=last].to_vec();
                self.grant(robot, moves);
                return true;
            }
        }
        false
    }

    fn is_free(&self, robot: u32, moves: &[Move]) -> bool {
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let held = occupation(&self.network, kind, state.anchor, state.anchored, moves);
        held.iter().all(|want| {
            let row = self.table.row(want.resource).iter();
            row.filter(|taken| taken.robot != robot)
                .all(|taken| taken.end <= want.start || want.end <= taken.start)
        })
    }

    fn refuse(&mut self, robot: u32) {
        self.counters.refusals += 1;
        self.drop_wish(robot);
    }

    fn grant(&mut self, robot: u32, moves: Vec<Move>) {
        for held in &self.robots[robot as usize].held {
            self.table.remove(held.resource, robot);
        }
        let state = &self.robots[robot as usize];
        let (anchor, place) = (state.anchor, state.place);
        self.adopt(robot, 0, moves);
        if self.network.storage[anchor as usize] {
            self.emit(EventKind::Departed, robot, anchor);
        }
        if let Some((station, _)) = place {
            self.leave_queue(robot, station);
        }
    }

    fn drop_wish(&mut self, robot: u32) {
        self.rolling.as_mut().expect("a rolling planner").replace(robot, Vec::new());
        self.need_plan(robot);
    }

    /// Records that a robot under way has to be planned anew, if it drives by proposals.
    pub(super) fn forget_wish(&mut self, robot: u32) {
        let phase = self.robots[robot as usize].phase;
        if self.rolling.is_some() && matches!(phase, Phase::Driving | Phase::Blocked) {
            self.drop_wish(robot);
        }
    }

    /// Drops all proposals, since the network has changed.
    pub(super) fn forget_wishes(&mut self) {
        for robot in 0..self.robots.len() as u32 {
            self.forget_wish(robot);
        }
    }

    fn need_plan(&mut self, robot: u32) {
        let rolling = self.rolling.as_mut().expect("a rolling planner");
        rolling.wishes.needs_plan[robot as usize] = true;
        if !std::mem::replace(&mut rolling.wishes.call_due, true) {
            let due = self.now.max(rolling.wishes.last_call + rolling.period);
            self.agenda.push(Reverse((due, u32::MAX, Due::Call, 0)));
        }
    }

    /// Calls the planner for all robots that drive.
    pub(super) fn call_planner(&mut self) {
        let begun = Instant::now();
        let agents = self.agents();
        let Fleet { network, kinds, robots, table, pathfinder, costs, rolling, .. } = self;
        let rolling = rolling.as_mut().expect("a rolling planner");
        rolling.wishes.call_due = false;
        rolling.wishes.last_call = self.now;
        let mut scene = Scene {
            now: self.now,
            network,
            kinds,
            robots,
            table,
            pathfinder,
            costs,
            guidance: None,
        };
        let answers = rolling.planner.plan(&mut scene, &agents);
        self.counters.called(begun.elapsed());
        let mut resting = Vec::new();
        for (agent, answer) in agents.iter().zip(answers) {
            let changed = self.take_answer(agent.robot, answer);
            if changed && self.robots[agent.robot as usize].phase == Phase::Blocked {
                resting.push(agent.robot);
            }
        }
        self.depart_together(resting);
    }

    /// Stores the answer as the robot's proposal. Returns whether it is a new one.
    fn take_answer(&mut self, robot: u32, answer: Answer) -> bool {
        let rolling = self.rolling.as_mut().expect("a rolling planner");
        match answer {
            Answer::Way(moves) => {
                self.counters.replans += 1;
                rolling.wishes.needs_plan[robot as usize] = false;
                rolling.replace(robot, moves);
            }
            Answer::NoWay => {
                self.counters.failures += 1;
                self.need_plan(robot);
                return false;
            }
            Answer::Keep if rolling.wishes.needs_plan[robot as usize] => {
                self.need_plan(robot);
                return false;
            }
            Answer::Keep => return false,
        }
        true
    }

    /// Robots under way or waiting for a way, with their destination waypoints.
    fn agents(&mut self) -> Vec<Agent> {
        let mut agents = Vec::new();
        let mut bound: Vec<Vec<usize>> = vec![Vec::new(); self.network.stations.len()];
        for robot in 0..self.robots.len() as u32 {
            let state = &self.robots[robot as usize];
            if !matches!(state.phase, Phase::Driving | Phase::Blocked) {
                continue;
            }
            let goal = match state.program.front() {
                Some(&Step::Drive(goal)) => goal,
                Some(&Step::Station(station)) if !state.queues_at(station) => {
                    bound[station as usize].push(agents.len());
                    NONE
                }
                _ => continue,
            };
            let (start, heading, end) = state.destination();
            let needs_plan =
                self.rolling.as_ref().expect("a rolling planner").wishes.needs_plan[robot as usize];
            agents.push(Agent {
                robot,
                kind: state.kind,
                start,
                heading,
                ready: end.max(self.now).max(state.busy_until),
                goal,
                loaded: state.pod.is_some(),
                effort: u64::MAX,
                needs_plan,
            });
        }
        for (station, members) in bound.iter().enumerate() {
            self.aim_at_places(station as u32, members, &mut agents);
        }
        agents.retain(|agent| agent.goal != agent.start);
        agents
    }

    /// Assigns robots outside a queue the places behind those in it, nearest first; if no place is
    /// left, the others drive towards the last place.
    fn aim_at_places(&mut self, station: u32, members: &[usize], agents: &mut [Agent]) {
        let places = self.network.stations[station as usize].clone();
        let in_queue = self.queues[station as usize].iter();
        let mut free = in_queue.map(|&robot| self.place_of(robot) + 1).max().unwrap_or(0);
        let mut nearest: Vec<(u32, usize)> = Vec::new();
        for &index in members {
            let agent = &agents[index];
            let table = self.costs.towards(&self.network, places[0], agent.kind, agent.loaded);
            nearest.push((table[self.network.index(agent.start, agent.heading)], index));
        }
        nearest.sort_unstable();
        for (_, index) in nearest {
            // a run that ends at a place of the queue is its own
            let own = places.iter().position(|&node| node == agents[index].start);
            let place = own.unwrap_or(free.min(places.len() - 1));
            agents[index].goal = places[place];
            free = free.max(place + 1);
        }
    }

    /// Records the reference with which the new leg is compared.
    fn begin_leg(&mut self, robot: u32) {
        let state = &self.robots[robot as usize];
        let (goal, zone) = match state.program.front() {
            Some(&Step::Station(station)) => {
                let places = &self.network.stations[station as usize];
                (places[places.len() - 1], station)
            }
            Some(&Step::Drive(goal)) => (goal, NONE),
            _ => return,
        };
        let (start, heading, end) = state.destination();
        let ready = end.max(self.now).max(state.busy_until);
        let loaded = state.pod.is_some();
        let times = self.costs.towards(&self.network, goal, state.kind, loaded);
        let way = Way {
            start,
            heading,
            ready,
            goal,
            loaded,
            kind: &self.kinds[state.kind as usize],
            model: &self.costs.models[state.kind as usize],
            times: &times,
        };
        let moves = route(&self.network, &way, |_| Some(0)).unwrap_or_default();
        let whole = moves.last().map_or(0, |last| last.end - ready);
        let unhindered = whole - time_in_zone(&self.network, way.kind, &moves, zone);
        self.counters.plans += 1;
        let leg = self.new_leg(robot, start, ready);
        self.legs[robot as usize] = Some(Leg { unhindered: Some(unhindered), ..leg });
    }
}
