//! Planning that takes time: a robot departs when its plan is there.
//!
//! A robot that needs a plan for a trip asks a planner, of which there is one for all robots or one
//! for each. Until its plan is there it stays where it stands, or drives its previous plan; its
//! reservations cover both. A planner serves one robot after the other. It begins with the
//! reservations of that moment, looks for a departure after the time that the plan takes, and
//! reserves the plan at once, so plans never conflict. Only plans of trips take time; moving up in
//! a queue, making way and replanning after disturbances do not.

use std::cmp::Reverse;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::kinematics::Kind;
use crate::log::Log;
use crate::network::Network;
use crate::reservations::Table;
use crate::robot::{Phase, Robot, Step};
use crate::search::Move;
use crate::units::{FOREVER, Us};

use super::disturbed::turn;
use super::{Due, Fleet};

/// How much time a plan takes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Price {
    /// The same for each plan.
    Fixed(Us),
    /// Microseconds per search, and per label of it.
    Work { search: f64, label: f64 },
    /// The wall time of the search times a factor.
    Wall(f64),
    /// As recorded in another run.
    Tape(Vec<Entry>),
}

/// A search for the plan of a trip, and the time that it took.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    pub robot: u32,
    /// When the robot asked, and when its turn came.
    pub asked: Us,
    pub begun: Us,
    pub labels: u64,
    pub took: Us,
    pub found: bool,
    /// Wall time of the search, in nanoseconds.
    pub wall: u64,
}

/// A robot that waits for its turn.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Job {
    robot: u32,
    asked: Us,
    /// When planners may begin with it.
    from: Us,
    loaded: bool,
    /// Whether an earlier attempt found no way.
    again: bool,
}

/// The job that is being done.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Turn {
    pub robot: u32,
    asked: Us,
    /// Until when the robot has something else to do.
    busy_until: Us,
    /// Time charged so far.
    took: Us,
}

/// The answer to a robot that needs a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Reply {
    Planned,
    NoWay,
    /// Its turn has not come.
    Later,
}

/// When plans are made, and what they cost.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Pace {
    price: Price,
    /// Plans are begun at multiples of this, loaded robots first; 0: at any time.
    period: Us,
    /// Whether a robot asks only when it could depart, and not while it lifts its pod.
    pub lazy: bool,
    queue: Vec<Job>,
    /// When each planner has finished its last plan: one entry for all robots, or one per robot.
    free: Vec<Us>,
    turn: Option<Turn>,
    /// When planners look at the queue next.
    wakes: Option<Us>,
    pub entries: Log<Entry>,
    /// Why the tape cannot be that of this run.
    pub fault: Option<String>,
}

impl Pace {
    /// Planners for a number of robots; `period` is at least 0.
    pub fn new(price: Price, period: Us, lazy: bool, planners: usize) -> Self {
        Self {
            price,
            period,
            lazy,
            queue: Vec::new(),
            free: vec![0; planners],
            turn: None,
            wakes: None,
            entries: Log::default(),
            fault: None,
        }
    }

    fn planner_of(&self, robot: u32) -> usize {
        if self.free.len() == 1 { 0 } else { robot as usize }
    }

    fn begins(&self, job: &Job) -> Us {
        job.from.max(self.free[self.planner_of(job.robot)])
    }

    /// The first job whose turn has come.
    fn next(&self, now: Us) -> Option<usize> {
        self.queue.iter().position(|job| self.begins(job) <= now)
    }

    /// Puts a robot into the queue, unless it is there already.
    fn ask(&mut self, robot: u32, loaded: bool, now: Us, again: bool) {
        if self.queue.iter().any(|job| job.robot == robot) {
            return;
        }
        let mut from = now;
        let mut place = self.queue.len();
        if self.period > 0 {
            from = (now + self.period - 1) / self.period * self.period;
            // of those planned together, the loaded ones come first
            let behind = |other: &Job| loaded && other.from == from && !other.loaded;
            place = self.queue.iter().position(behind).unwrap_or(place);
        }
        self.queue.insert(place, Job { robot, asked: now, from, loaded, again });
    }

    /// Withdraws a robot's request.
    pub fn withdraw(&mut self, robot: u32) {
        self.queue.retain(|job| job.robot != robot);
    }

    /// The job being done, if it is this robot's.
    pub(super) fn turn_of(&self, robot: u32) -> Option<&Turn> {
        self.turn.as_ref().filter(|turn| turn.robot == robot)
    }

    /// The time that the robot's plan is known to take before it is searched.
    pub(super) fn known(&self) -> Us {
        match self.price {
            Price::Fixed(time) => time,
            _ => 0,
        }
    }

    /// Charges a search of the job being done; returns the time charged for the job so far.
    pub(super) fn charge(&mut self, now: Us, labels: u64, wall: Duration, found: bool) -> Us {
        let Some(turn) = &mut self.turn else { return 0 };
        let took = match &self.price {
            Price::Fixed(_) if turn.took > 0 || labels == 0 => 0,
            &Price::Fixed(time) => time,
            Price::Work { search, label } => (search + label * labels as f64).ceil() as Us,
            Price::Wall(speed) => (wall.as_nanos() as f64 / 1e3 * speed).ceil() as Us,
            Price::Tape(tape) => {
                let number = self.entries.len();
                let same = |entry: &&Entry| {
                    (entry.robot, entry.begun, entry.labels) == (turn.robot, now, labels)
                };
                match tape.get(number).filter(same) {
                    Some(entry) => entry.took,
                    None => {
                        let told = format!(
                            "plan {number} (robot {} at {:.6} s, {labels} labels)",
                            turn.robot,
                            now as f64 / 1e6
                        );
                        self.fault.get_or_insert(told);
                        0
                    }
                }
            }
        };
        turn.took += took;
        let (robot, asked) = (turn.robot, turn.asked);
        let wall = wall.as_nanos() as u64;
        self.entries.push(Entry { robot, asked, begun: now, labels, took, found, wall });
        turn.took
    }
}

impl Turn {
    /// When the robot could depart from a stop that it reaches at `rested`, if it had a plan.
    pub(super) fn could_depart(&self, rested: Us) -> Us {
        rested.max(self.asked).max(self.busy_until)
    }
}

impl Fleet {
    /// Lets plans of trips take time from now on.
    pub fn set_pace(&mut self, pace: Pace) {
        self.pace = Some(pace);
    }

    /// Plans the first step of a robot's program if its turn has come; otherwise it will be planned
    /// when it comes. `again`: whether an earlier attempt found no way.
    pub(super) fn ask_for_plan(&mut self, robot: u32, again: bool) -> Reply {
        let now = self.now;
        let Some(pace) = &mut self.pace else {
            return if self.plan_step(robot) { Reply::Planned } else { Reply::NoWay };
        };
        let state = &mut self.robots[robot as usize];
        pace.ask(robot, state.pod.is_some(), now, again);
        if let Some(first) = pace.next(now).filter(|&first| pace.queue[first].robot == robot) {
            // it may have asked before, while it was lifting
            let asked = pace.queue.remove(first).asked;
            return self.plan_in_turn(robot, asked);
        }
        let stands_from = state.destination().2.max(now).max(state.busy_until);
        if state.phase != Phase::Transferring {
            self.settle(robot);
            let state = &mut self.robots[robot as usize];
            state.phase = Phase::Planning;
            state.awaits = (stands_from, FOREVER);
        }
        self.wake_planners();
        Reply::Later
    }

    /// Plans for the robots whose turn has come.
    pub(super) fn planners_due(&mut self) {
        if let Some(pace) = &mut self.pace {
            pace.wakes = pace.wakes.filter(|&due| due > self.now);
        }
        while let Some(pace) = &mut self.pace
            && let Some(first) = pace.next(self.now)
        {
            let Job { robot, asked, again, .. } = pace.queue.remove(first);
            let lifting = self.is_lifting_ahead(robot);
            if !lifting && self.robots[robot as usize].phase != Phase::Planning {
                continue;
            }
            let reply = self.plan_in_turn(robot, asked);
            if reply == Reply::NoWay && !lifting {
                if again {
                    self.step_aside(robot);
                }
                self.wait_for_a_way(robot);
            }
        }
        self.wake_planners();
    }

    /// Whether a robot lifts a pod to drive on with it, and has no plan for that yet.
    fn is_lifting_ahead(&self, robot: u32) -> bool {
        let state = &self.robots[robot as usize];
        state.phase == Phase::Transferring
            && state.moves.is_empty()
            && matches!(state.program.front(), Some(Step::Lift(_)))
            && matches!(state.program.get(1), Some(Step::Drive(_) | Step::Station(_)))
    }

    /// Plans for a robot whose turn has come, and lets the planner be busy with it.
    fn plan_in_turn(&mut self, robot: u32, asked: Us) -> Reply {
        self.settle(robot);
        let state = &mut self.robots[robot as usize];
        let busy_until = state.busy_until;
        let stands_from = match state.phase {
            Phase::Planning => state.awaits.0,
            _ => state.destination().2.max(self.now).max(busy_until),
        };
        state.awaits = (stands_from, self.now);
        // who lifts is planned for what comes after
        let lift =
            if state.phase == Phase::Transferring { state.program.pop_front() } else { None };
        let pace = self.pace.as_mut().expect("a pace");
        pace.turn = Some(Turn { robot, asked, busy_until, took: 0 });
        // it is ranked in a queue by when it can depart
        state.busy_until = busy_until.max(self.now + pace.known());
        let planned = self.plan_step(robot);
        let pace = self.pace.as_mut().expect("a pace");
        let took = pace.turn.take().map_or(0, |turn| turn.took);
        let planner = pace.planner_of(robot);
        pace.free[planner] = self.now + took;
        self.counters.charged += took as u64;
        let state = &mut self.robots[robot as usize];
        let until = self.now + took;
        if planned {
            state.busy_until = busy_until.max(until);
        } else {
            state.busy_until = busy_until;
            state.awaits.1 = until;
        }
        if let Some(lift) = lift {
            state.program.push_front(lift);
            state.phase = Phase::Transferring;
        } else if planned && state.phase == Phase::Planning {
            // it has a place in the queue of its station already
            state.phase = Phase::Driving;
            state.version += 1;
            let due = state.destination().2.max(self.now).max(state.busy_until);
            self.agenda.push(Reverse((due, robot, Due::LegEnd, state.version)));
        }
        if planned { Reply::Planned } else { Reply::NoWay }
    }

    /// Schedules the next turn of a planner.
    fn wake_planners(&mut self) {
        let Some(pace) = &mut self.pace else { return };
        let Some(due) = pace.queue.iter().map(|job| pace.begins(job)).min() else { return };
        let due = due.max(self.now);
        if pace.wakes.is_none_or(|wakes| due < wakes) {
            pace.wakes = Some(due);
            self.agenda.push(Reverse((due, u32::MAX, Due::Plan, 0)));
        }
    }
}

/// The number of moves after which a robot that drives its previous plan can stand until a time: at
/// least `first`. The table is without its own reservations.
pub(super) fn stop_for(
    network: &Network,
    table: &Table,
    state: &Robot,
    now: Us,
    first: usize,
    until: Us,
) -> usize {
    let can_stand = |&kept: &usize| {
        let (node, since) = match kept.checked_sub(1) {
            Some(last) => (state.moves[last].to, state.moves[last].end),
            None => (state.anchor, now),
        };
        since >= until
            || (!network.is_elevator(node)
                && table
                    .gap_at(network.resource[node as usize], since)
                    .is_some_and(|g| g.1 > until))
    };
    (first..state.moves.len()).find(can_stand).unwrap_or(first.max(state.moves.len()))
}

/// When a robot turns for the first of its moves; `FOREVER` without any.
pub(super) fn departure(network: &Network, kind: &Kind, moves: &[Move]) -> Us {
    moves.first().map_or(FOREVER, |first| first.start - turn(network, kind, first))
}
