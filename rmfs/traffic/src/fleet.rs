//! All robots on one network: programs, plans and the events they cause.
//!
//! Every robot always owns one conflict-free plan that ends in an unlimited hold. A new plan
//! replaces the old one only when the whole of it is free, so "no plan" means to stay parked, and
//! nothing can collide.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};
use std::time::{Duration, Instant};

use crate::costs::Cache;
use crate::kinematics::Kind;
use crate::network::{NONE, Network};
use crate::postpone::postpone;
use crate::record::{Piece, Record, Row, Standing, Trip, TripKind, enters_zone, move_rows};
use crate::reservations::{Interval, Table};
use crate::robot::{Phase, Robot, Step};
use crate::search::{Move, Outcome, Planner, Query};
use crate::units::Us;

/// How often robots that found no way try again.
const RETRY: Us = 1_000_000;

/// What happened to a robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i64)]
pub enum EventKind {
    Arrived = 0,
    LiftStarted = 1,
    Lifted = 2,
    Departed = 3,
    QueueEntered = 4,
    AtHead = 5,
    SetDownStarted = 6,
    SetDown = 7,
    Idle = 8,
}

/// An event with its time; `value` is a waypoint, pod or station.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    pub time: Us,
    pub kind: EventKind,
    pub robot: u32,
    pub value: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Due {
    TransferEnd,
    LegEnd,
    Retry,
}

/// What planning has cost so far.
#[derive(Clone, Debug, Default)]
pub struct Counters {
    pub plans: u64,
    pub failures: u64,
    pub replans: u64,
    /// Wall time spent planning.
    pub planning: Duration,
}

/// How hard a plan is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Effort {
    /// The robot needs it.
    Full,
    /// It would be better than what the robot has.
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

/// What a robot's current leg is, for the table of trips.
#[derive(Clone, Debug)]
struct Leg {
    from: u32,
    start: Us,
    unhindered: Us,
    distance_before: f64,
    /// When the robot reached the queue zone of the station it drives to.
    zone_entered: Option<Us>,
}

/// The traffic of one warehouse.
#[derive(Debug)]
pub struct Fleet {
    pub network: Network,
    pub kinds: Vec<Kind>,
    pub robots: Vec<Robot>,
    pub now: Us,
    pub record: Record,
    pub counters: Counters,
    pub planner: Planner,
    pub costs: Cache,
    table: Table,
    budget: u64,
    /// Robots with a place in each station's queue, in the order of their places.
    queues: Vec<Vec<u32>>,
    legs: Vec<Option<Leg>>,
    blocked: Vec<u32>,
    /// Stations in whose queue somebody could not move up although places are free.
    stalled: Vec<u32>,
    released: Vec<u32>,
    retry_due: bool,
    agenda: BinaryHeap<Reverse<(Us, u32, Due, u32)>>,
    outbox: Vec<Event>,
}

impl Fleet {
    /// Puts robots `(waypoint, heading, kind)` on a network.
    ///
    /// # Errors
    /// If two robots stand on one waypoint.
    pub fn new(
        network: Network,
        kinds: Vec<Kind>,
        robots: &[(u32, u8, u8)],
        budget: u64,
        cost_bytes: usize,
        with_trace: bool,
    ) -> Result<Self, String> {
        let mut fleet = Self {
            planner: Planner::new(&network),
            costs: Cache::new(&network, &kinds, cost_bytes),
            table: Table::new(network.resources),
            record: Record::new(robots.len(), network.nodes, with_trace),
            queues: vec![Vec::new(); network.stations.len()],
            robots: Vec::new(),
            legs: vec![None; robots.len()],
            stalled: Vec::new(),
            counters: Counters::default(),
            blocked: Vec::new(),
            released: Vec::new(),
            retry_due: false,
            agenda: BinaryHeap::new(),
            outbox: Vec::new(),
            now: 0,
            network,
            kinds,
            budget,
        };
        for (id, &(node, heading, kind)) in robots.iter().enumerate() {
            if let Some(other) = fleet.table.final_holder(fleet.network.resource[node as usize]) {
                return Err(format!("robots {other} and {id} both start at waypoint {node}"));
            }
            fleet.robots.push(Robot::at(node, heading, kind));
            fleet.occupy(id as u32);
        }
        Ok(fleet)
    }

    /// Replaces what is left of a robot's program; a moving robot goes on to its next stop first.
    ///
    /// # Errors
    /// If the robot is lifting or setting down, or the program starts with that away from rest.
    pub fn command(&mut self, robot: u32, program: &[Step]) -> Result<(), String> {
        let state = &self.robots[robot as usize];
        if state.phase == Phase::Transferring {
            return Err(format!("robot {robot} is lifting or setting down a pod"));
        }
        self.settle(robot);
        let state = &mut self.robots[robot as usize];
        if !state.moves.is_empty()
            && matches!(program.first(), Some(Step::Lift(_) | Step::SetDown(_)))
        {
            return Err(format!("robot {robot} is driving and cannot lift or set down"));
        }
        state.program = VecDeque::from(program.to_vec());
        self.begin(robot);
        Ok(())
    }

    /// Advances to the first time not after `until` at which something happens, or to `until`.
    pub fn advance(&mut self, until: Us) -> Vec<Event> {
        while self.outbox.is_empty() {
            match self.agenda.peek() {
                Some(&Reverse((time, ..))) if time <= until => self.instant(time),
                _ => {
                    self.now = self.now.max(until);
                    break;
                }
            }
        }
        std::mem::take(&mut self.outbox)
    }

    /// Handles everything due at one time.
    fn instant(&mut self, time: Us) {
        self.now = time;
        while let Some(&Reverse((at, robot, due, version))) = self.agenda.peek() {
            if at > time {
                break;
            }
            self.agenda.pop();
            match due {
                Due::TransferEnd => self.transfer_ended(robot),
                Due::LegEnd if self.robots[robot as usize].version == version => {
                    self.leg_ended(robot)
                }
                Due::LegEnd => {}
                Due::Retry => {
                    self.retry_due = false;
                    for station in std::mem::take(&mut self.stalled) {
                        self.move_up(station);
                    }
                    self.retry(|_, _| true);
                }
            }
        }
        self.retry_released();
    }

    fn emit(&mut self, kind: EventKind, robot: u32, value: u32) {
        self.outbox.push(Event { time: self.now, kind, robot, value });
    }

    // ------------------------------------------------------------------ programs

    /// Starts the first step of the robot's program.
    fn begin(&mut self, robot: u32) {
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
    fn set_off(&mut self, robot: u32) {
        if !self.plan_step(robot) {
            self.robots[robot as usize].phase = Phase::Blocked;
            self.blocked.push(robot);
            self.schedule_retry();
        }
    }

    /// Plans the first step of the program, a driving one. Returns whether that worked.
    fn plan_step(&mut self, robot: u32) -> bool {
        match self.robots[robot as usize].program.front().copied() {
            Some(Step::Drive(goal)) => self.plan_drive(robot, goal),
            Some(Step::Station(station)) => self.plan_station(robot, station),
            _ => unreachable!("only driving steps are planned"),
        }
    }

    fn plan_drive(&mut self, robot: u32, goal: u32) -> bool {
        let left_place = self.robots[robot as usize].place;
        if !self.plan(robot, goal, Effort::Full, |_, _| false) {
            return false;
        }
        if let Some((station, _)) = left_place {
            self.leave_queue(robot, station);
        }
        true
    }

    fn lift(&mut self, robot: u32, pod: u32) {
        self.emit(EventKind::LiftStarted, robot, pod);
        let state = &mut self.robots[robot as usize];
        state.pod = Some(pod);
        self.start_transfer(robot);
        // plan ahead, so that the robot leaves the moment it has its pod
        let state = &mut self.robots[robot as usize];
        if matches!(state.program.get(1), Some(Step::Drive(_) | Step::Station(_))) {
            let step = state.program.pop_front().expect("the lift");
            self.plan_step(robot);
            let state = &mut self.robots[robot as usize];
            state.program.push_front(step);
            state.phase = Phase::Transferring;
        }
    }

    fn set_down(&mut self, robot: u32, pod: u32) {
        self.emit(EventKind::SetDownStarted, robot, pod);
        self.start_transfer(robot);
    }

    fn start_transfer(&mut self, robot: u32) {
        let now = self.now;
        let state = &mut self.robots[robot as usize];
        state.phase = Phase::Transferring;
        state.busy_until = now + self.kinds[state.kind as usize].pod_transfer;
        self.agenda.push(Reverse((state.busy_until, robot, Due::TransferEnd, 0)));
    }

    fn transfer_ended(&mut self, robot: u32) {
        let state = &mut self.robots[robot as usize];
        let (step, node, heading) =
            (state.program.pop_front().expect("a transfer"), state.anchor, state.heading);
        match step {
            Step::Lift(pod) => {
                self.record.transfer(robot, self.now, node, heading, pod, Piece::Lift);
                self.emit(EventKind::Lifted, robot, pod);
            }
            Step::SetDown(pod) => {
                state.pod = None;
                self.record.transfer(robot, self.now, node, heading, pod, Piece::SetDown);
                self.emit(EventKind::SetDown, robot, pod);
            }
            Step::Drive(_) | Step::Station(_) => unreachable!("a transfer ended"),
        }
        let state = &mut self.robots[robot as usize];
        if state.moves.is_empty() {
            self.begin(robot);
        } else {
            state.phase = Phase::Driving;
        }
    }

    fn leg_ended(&mut self, robot: u32) {
        self.settle(robot);
        let state = &self.robots[robot as usize];
        debug_assert!(state.moves.is_empty());
        if state.phase != Phase::Driving {
            // a blocked robot came to the end of what it still had to drive
            return;
        }
        match state.program.front().copied() {
            Some(Step::Drive(goal)) if state.anchor == goal => self.arrived(robot, goal),
            Some(Step::Station(station)) => self.stopped_in_queue(robot, station),
            _ => unreachable!("a leg ends where the step wants to be"),
        }
    }

    fn arrived(&mut self, robot: u32, goal: u32) {
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

    fn stopped_in_queue(&mut self, robot: u32, station: u32) {
        let (_, place) = self.robots[robot as usize].place.expect("planned to a place");
        if place > 0 {
            self.move_up(station);
            return;
        }
        let entered =
            self.legs[robot as usize].as_ref().and_then(|leg| leg.zone_entered).unwrap_or(self.now);
        self.record.totals[robot as usize].queueing += self.now - entered;
        self.finish_trip(robot, TripKind::ToStation, entered);
        self.at_head(robot, station);
    }

    fn at_head(&mut self, robot: u32, station: u32) {
        self.robots[robot as usize].program.pop_front();
        self.robots[robot as usize].phase = Phase::Idle;
        self.emit(EventKind::AtHead, robot, station);
    }

    fn finish_trip(&mut self, robot: u32, kind: TripKind, end: Us) {
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
            unhindered: leg.unhindered,
        });
    }

    // ------------------------------------------------------------------ planning

    /// Plans from the first rest that can still be chosen to `goal` and, if that works, makes it
    /// the robot's plan. `keep` says which of the moves not yet begun stay as they are.
    fn plan(
        &mut self,
        robot: u32,
        goal: u32,
        effort: Effort,
        keep: impl Fn(&Network, &Move) -> bool,
    ) -> bool {
        let begun = Instant::now();
        let planned = self.plan_untimed(robot, goal, effort, keep);
        self.counters.planning += begun.elapsed();
        planned
    }

    fn plan_untimed(
        &mut self,
        robot: u32,
        goal: u32,
        effort: Effort,
        keep: impl Fn(&Network, &Move) -> bool,
    ) -> bool {
        self.settle(robot);
        let Fleet { network, kinds, robots, table, planner, costs, .. } = self;
        let state = &robots[robot as usize];
        let kind = &kinds[state.kind as usize];
        if table.final_holder(network.resource[goal as usize]).is_some_and(|holder| holder != robot)
        {
            self.counters.failures += 1;
            return false;
        }
        let kept = state
            .committed(network, kind, self.now)
            .max(state.moves.iter().take_while(|step| keep(network, step)).count());
        let (start, heading, rested) = match kept.checked_sub(1) {
            Some(last) => (state.moves[last].to, state.moves[last].heading, state.moves[last].end),
            None => (state.anchor, state.heading, state.rested),
        };
        let ready = rested.max(self.now).max(state.busy_until);
        let loaded = state.pod.is_some();
        let model = &costs.models[state.kind as usize];
        for held in &state.held {
            table.remove(held.resource, robot);
        }
        let mut query = Query {
            start,
            heading,
            ready,
            goal,
            loaded,
            kind,
            model,
            budget: self.budget.min(effort.labels()),
        };
        let mut outcome = planner.search(network, table, &query);
        if outcome == Outcome::OutOfBudget && effort == Effort::Full {
            // with every planned motion over, the search is an ordinary shortest path
            query.ready = query.ready.max(table.horizon());
            query.budget = u64::MAX;
            outcome = planner.search(network, table, &query);
        }
        let Outcome::Found(mut moves) = outcome else {
            self.counters.failures += 1;
            self.reserve(robot);
            return false;
        };
        let unhindered = planner.unhindered(network, &query);
        postpone(network, table, kind, &mut moves);
        let departs = kept == 0 && !moves.is_empty();
        if self.legs[robot as usize].is_none() {
            self.counters.plans += 1;
            self.legs[robot as usize] = Some(Leg {
                from: start,
                start: ready,
                unhindered,
                distance_before: self.record.totals[robot as usize].distance,
                zone_entered: None,
            });
        } else {
            self.counters.replans += 1;
        }
        self.adopt(robot, kept, moves);
        if departs && self.network.storage[start as usize] {
            self.emit(EventKind::Departed, robot, start);
        }
        self.released.push(start);
        true
    }

    /// Makes the kept moves and the new ones the robot's plan.
    fn adopt(&mut self, robot: u32, kept: usize, moves: Vec<Move>) {
        let state = &mut self.robots[robot as usize];
        state.moves.truncate(kept);
        state.moves.extend(moves);
        state.version += 1;
        state.phase = Phase::Driving;
        let (_, _, end) = state.destination();
        let due = end.max(self.now).max(state.busy_until);
        self.agenda.push(Reverse((due, robot, Due::LegEnd, state.version)));
        self.occupy(robot);
    }

    /// Computes what the robot's plan occupies and reserves it.
    fn occupy(&mut self, robot: u32) {
        let state = &mut self.robots[robot as usize];
        state.held = state.occupation(&self.network, &self.kinds[state.kind as usize]);
        self.reserve(robot);
    }

    fn reserve(&mut self, robot: u32) {
        for held in &self.robots[robot as usize].held {
            if held.end > self.now {
                let interval = Interval { start: held.start, end: held.end, robot };
                self.table.insert(held.resource, interval, self.now);
            }
        }
    }

    /// Brings a robot's state and record up to now.
    fn settle(&mut self, robot: u32) {
        let now = self.now;
        let state = &mut self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let why = if state.phase != Phase::Idle {
            Standing::Waiting
        } else if state.place.is_some() {
            Standing::Served
        } else {
            Standing::Idle
        };
        while state.moves.front().is_some_and(|step| step.end <= now) {
            let step = state.moves.pop_front().expect("checked");
            let turn = kind.turn(
                self.network.headings[step.heading_before as usize],
                self.network.headings[step.heading as usize],
            );
            self.record.stand(
                robot,
                step.start - turn,
                step.from,
                step.heading_before,
                state.pod,
                why,
            );
            self.record.drive(&self.network, kind, robot, &step, state.pod);
            let station = state.station();
            if let Some(leg) = &mut self.legs[robot as usize]
                && station != NONE
                && leg.zone_entered.is_none()
            {
                leg.zone_entered = enters_zone(&self.network, kind, &step, station);
            }
            if !step.ride {
                state.anchored = last_approach(&self.network, kind, &step);
            }
            state.anchor = step.to;
            state.heading = step.heading;
            state.rested = step.end;
        }
        if state.phase == Phase::Transferring {
            return;
        }
        let standing_until = match state.moves.front() {
            Some(step) => {
                let turn = kind.turn(
                    self.network.headings[step.heading_before as usize],
                    self.network.headings[step.heading as usize],
                );
                now.min(step.start - turn)
            }
            None => now,
        };
        self.record.stand(robot, standing_until, state.anchor, state.heading, state.pod, why);
    }

    /// Brings all robots' states and records up to now.
    pub fn settle_all(&mut self) {
        for robot in 0..self.robots.len() as u32 {
            self.settle(robot);
        }
    }

    /// The trace up to now, by robot and time; the motion each robot is in the middle of is whole.
    /// `None` if it is not recorded.
    pub fn trace(&mut self) -> Option<Vec<Row>> {
        self.settle_all();
        let mut rows = self.record.trace.clone()?;
        for (id, state) in self.robots.iter().enumerate() {
            let robot = id as u32;
            let kind = &self.kinds[state.kind as usize];
            match (state.phase, state.program.front()) {
                (Phase::Transferring, Some(&(Step::Lift(pod) | Step::SetDown(pod)))) => {
                    let piece = if matches!(state.program.front(), Some(Step::Lift(_))) {
                        Piece::Lift
                    } else {
                        Piece::SetDown
                    };
                    rows.push(Row {
                        robot,
                        start: self.record.recorded(robot),
                        end: state.busy_until,
                        piece,
                        from: state.anchor,
                        to: state.anchor,
                        heading_before: state.heading,
                        heading: state.heading,
                        pod: pod as i32,
                    });
                }
                _ if state.committed(&self.network, kind, self.now) > 0 => {
                    rows.extend(move_rows(&self.network, kind, robot, &state.moves[0], state.pod));
                }
                _ => {}
            }
        }
        rows.sort_by_key(|row| (row.robot, row.start));
        Some(rows)
    }

    // ------------------------------------------------------------------ robots without a way

    fn schedule_retry(&mut self) {
        let needed = !self.blocked.is_empty() || !self.stalled.is_empty();
        if needed && !self.retry_due {
            self.retry_due = true;
            self.agenda.push(Reverse((self.now + RETRY, u32::MAX, Due::Retry, 0)));
        }
    }

    /// Lets robots try again whose goal somebody has just planned to leave.
    fn retry_released(&mut self) {
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

    fn retry(&mut self, concerns: impl Fn(&Self, u32) -> bool) {
        for robot in std::mem::take(&mut self.blocked) {
            let state = &self.robots[robot as usize];
            if state.phase != Phase::Blocked || self.blocked.contains(&robot) {
                continue;
            }
            if concerns(self, robot) {
                if !self.plan_step(robot) {
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

    /// Sends a blocked robot that stands in the way of others to the nearest free storage place.
    fn step_aside(&mut self, robot: u32) {
        self.settle(robot);
        let Fleet { network, kinds, robots, table, planner, costs, .. } = self;
        let state = &robots[robot as usize];
        let rests_well = network.storage[state.anchor as usize] || state.place.is_some();
        if !state.moves.is_empty() || rests_well {
            return;
        }
        for held in &state.held {
            table.remove(held.resource, robot);
        }
        let query = Query {
            start: state.anchor,
            heading: state.heading,
            ready: self.now.max(state.busy_until),
            goal: NONE,
            loaded: state.pod.is_some(),
            kind: &kinds[state.kind as usize],
            model: &costs.models[state.kind as usize],
            budget: self.budget,
        };
        match planner.search(network, table, &query) {
            Outcome::Found(moves) => {
                self.counters.replans += 1;
                self.adopt(robot, 0, moves);
            }
            Outcome::NoWay | Outcome::OutOfBudget => self.reserve(robot),
        }
    }

    /// Robots that want to drive and have found no way.
    pub fn blocked(&self) -> &[u32] {
        &self.blocked
    }

    // ------------------------------------------------------------------ queues

    fn place_of(&self, robot: u32) -> usize {
        self.robots[robot as usize].place.expect("it is in a queue").1
    }

    /// Gives the robot a place in the station's queue and plans its way there.
    fn plan_station(&mut self, robot: u32, station: u32) -> bool {
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

    /// The rank in the queue by expected arrival at its head; nobody in the zone is overtaken.
    fn rank(&mut self, robot: u32, station: u32) -> usize {
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
            if inside(state.anchor) || inside(state.next_stop()) {
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

    /// Earliest time at which the robot could be at `head` if nobody hindered it.
    fn expected(&mut self, robot: u32, head: u32) -> Us {
        let state = &self.robots[robot as usize];
        let ready = state.rested.max(self.now).max(state.busy_until);
        let table = self.costs.towards(&self.network, head, state.kind, state.pod.is_some());
        ready + Us::from(table[self.network.index(state.anchor, state.heading)])
    }

    /// Moves robots from `rank` on back by a place where needed. Returns whether a place is free.
    fn make_room(&mut self, station: u32, rank: usize) -> bool {
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
    fn join(&mut self, robot: u32, station: u32, rank: usize) -> bool {
        let queue = &self.queues[station as usize];
        let place = if rank == 0 { 0 } else { self.place_of(queue[rank - 1]) + 1 };
        let taken = queue.get(rank).is_some_and(|&next| self.place_of(next) <= place);
        let Some(&goal) = self.network.stations[station as usize].get(place) else { return false };
        let effort =
            if rank < self.queues[station as usize].len() { Effort::Try } else { Effort::Full };
        if taken || !self.plan(robot, goal, effort, |_, _| false) {
            return false;
        }
        self.queues[station as usize].insert(rank, robot);
        self.robots[robot as usize].place = Some((station, place));
        true
    }

    /// Replans the last part of a robot's way to another place of the queue it is bound for.
    fn change_place(&mut self, robot: u32, station: u32, place: usize) -> bool {
        let goal = self.network.stations[station as usize][place];
        let outside = |network: &Network, step: &Move| {
            network.zone[step.to as usize] != station
                && !network.stations[station as usize].contains(&step.to)
        };
        let phase = self.robots[robot as usize].phase;
        let changed = self.plan(robot, goal, Effort::Try, outside);
        if changed {
            self.robots[robot as usize].place = Some((station, place));
        }
        if phase == Phase::Transferring {
            self.robots[robot as usize].phase = phase;
        }
        changed
    }

    /// Moves everybody up as far as places are free.
    fn move_up(&mut self, station: u32) {
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

    fn leave_queue(&mut self, robot: u32, station: u32) {
        self.robots[robot as usize].place = None;
        self.leave_queue_list(robot, station);
    }

    fn leave_queue_list(&mut self, robot: u32, station: u32) {
        self.queues[station as usize].retain(|&other| other != robot);
        self.move_up(station);
    }
}

/// When the robot left the waypoint before the last of a run: from then on it occupies the last.
fn last_approach(network: &Network, kind: &Kind, step: &Move) -> Us {
    let line: Vec<(u32, f64)> = network.line(step.from, step.to, step.heading).collect();
    if line.len() < 2 {
        return step.start;
    }
    let length = line[line.len() - 1].1;
    step.start + crate::units::floor_us(kind.run(length).time_at(line[line.len() - 2].1))
}
