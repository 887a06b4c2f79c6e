//! All robots on one network: programs, plans and the events they cause.
//!
//! Every robot always owns one conflict-free plan, at whose end it stays indefinitely. A new plan
//! replaces the old one only if all of it is free, so "no plan" means to stay, and nothing can
//! collide.

mod blocked;
mod closing;
mod disturbed;
mod energy;
mod improve;
mod late;
mod lateness;
mod pace;
mod planning;
mod programs;
mod progress;
mod queues;
mod regroup;
mod rolling;
mod saved;

pub use closing::CutOff;
pub use late::Shift;
pub use lateness::Lateness;
pub use pace::{Entry, Pace, Price};
pub use regroup::Rest;

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};
use std::sync::Arc;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::costs::Cache;
use crate::guidance::{Guidance, guidance};
use crate::kinematics::Kind;
use crate::log::Log;
use crate::network::Network;
use crate::patience::look_up;
use crate::planner::{Planner, TimeWindows};
use crate::record::Record;
use crate::reservations::Table;
use crate::robot::{Phase, Robot, Step};
use crate::search::Pathfinder;
use crate::units::Us;

use rolling::Rolling;

/// Maximum number of events per robot at one instant, far more than ever occur.
const AT_ONCE: usize = 10_000;

/// Kind of an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    pub time: Us,
    pub kind: EventKind,
    pub robot: u32,
    pub value: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
enum Due {
    TransferEnd,
    LegEnd,
    Retry,
    /// A robot needs to turn for its next run; see `rolling.rs`.
    Depart,
    /// The rolling planner is called.
    Call,
    /// A robot is about to begin a motion; see `lateness.rs`.
    Motion,
    /// A motion has begun.
    NextMotion,
    /// A planner can begin with the next robot; see `pace.rs`.
    Plan,
}

/// Counters of planning.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Counters {
    pub plans: u64,
    pub failures: u64,
    pub replans: u64,
    /// Runs proposed by a rolling planner that were not free.
    pub refusals: u64,
    /// Number of times that plans were replaced by better ones.
    pub improvements: u64,
    /// Number of motions drawn, number of late ones, and total delay.
    pub motions: u64,
    pub late_motions: u64,
    pub lateness: u64,
    /// Plans replaced because another robot was late.
    pub repairs: u64,
    /// Simulated time that plans took.
    pub charged: u64,
    /// Wall time spent planning.
    pub planning: Duration,
    /// Wall time of each call of the planner, in nanoseconds.
    pub calls: Log<u64>,
}

impl Counters {
    /// Counts a call of the planner.
    fn called(&mut self, took: Duration) {
        self.planning += took;
        self.calls.push(took.as_nanos() as u64);
    }
}

/// A robot's current leg, for the table of trips.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Leg {
    from: u32,
    /// When the robot could have set off, had there been a way.
    start: Us,
    /// When it could set off once there was a way.
    ready: Us,
    /// Duration without other robots; `None` while no way has been found.
    unhindered: Option<Us>,
    distance_before: f64,
    energy_before: f64,
    /// When the robot reached the queue zone of the station it drives to.
    zone_entered: Option<Us>,
    /// Time at its beginning in which the robot waited for its plan.
    awaited: Us,
}

/// The traffic of one warehouse.
#[derive(Clone, Debug)]
pub struct Fleet {
    pub network: Arc<Network>,
    pub kinds: Vec<Kind>,
    pub robots: Vec<Robot>,
    pub now: Us,
    pub record: Record,
    pub counters: Counters,
    pub pathfinder: Pathfinder,
    pub costs: Cache,
    table: Table,
    /// Whether a pod is stored at each waypoint.
    stored: Vec<bool>,
    budget: u64,
    /// Extra costs of edges for the trip planner.
    guidance: Option<Guidance>,
    /// Plans whole legs; with a rolling planner, only moves within queues.
    trip_planner: Box<dyn Planner>,
    rolling: Option<Rolling>,
    /// Lateness of motions, if they can be late.
    lateness: Option<Lateness>,
    /// What plans cost in time, if they take any.
    pub pace: Option<Pace>,
    /// Robots with a place in each station's queue, in the order of their places.
    queues: Vec<Vec<u32>>,
    legs: Vec<Option<Leg>>,
    blocked: Vec<u32>,
    /// Stations in whose queue a robot could not move up although places are free.
    stalled: Vec<u32>,
    released: Vec<u32>,
    /// Robots whose legs have just been planned.
    fresh: Vec<u32>,
    retry_due: bool,
    agenda: BinaryHeap<Reverse<(Us, u32, Due, u32)>>,
    outbox: Vec<Event>,
}

impl Fleet {
    /// Puts robots `(waypoint, heading, kind)` on a network.
    ///
    /// # Errors
    /// If two robots stand on one waypoint, or on none, or are of a kind that does not exist.
    pub fn new(
        network: Network,
        kinds: Vec<Kind>,
        robots: &[(u32, u8, u8)],
        planner: Box<dyn Planner>,
        budget: u64,
        cost_bytes: usize,
        with_trace: bool,
    ) -> Result<Self, String> {
        let known = |&&(node, _, kind): &&(u32, u8, u8)| {
            (node as usize) < network.nodes && (kind as usize) < kinds.len()
        };
        if let Some(robot) = robots.iter().position(|robot| !known(&robot)) {
            return Err(format!("robot {robot} has no waypoint, or no kind"));
        }
        let (trip_planner, rolling): (Box<dyn Planner>, _) =
            match Rolling::of(planner, robots.len()) {
                Ok(rolling) => {
                    (Box::new(TimeWindows { budget, ..TimeWindows::default() }), Some(rolling))
                }
                Err(trip_planner) => (trip_planner, None),
            };
        let mut fleet = Self {
            pathfinder: Pathfinder::new(&network),
            trip_planner,
            rolling,
            guidance: None,
            lateness: None,
            pace: None,
            costs: Cache::new(&network, &kinds, cost_bytes),
            table: Table::new(network.resources),
            stored: vec![false; network.nodes],
            record: Record::new(robots.len(), &network, with_trace),
            queues: vec![Vec::new(); network.stations.len()],
            robots: Vec::new(),
            legs: vec![None; robots.len()],
            stalled: Vec::new(),
            counters: Counters::default(),
            blocked: Vec::new(),
            released: Vec::new(),
            fresh: Vec::new(),
            retry_due: false,
            agenda: BinaryHeap::new(),
            outbox: Vec::new(),
            now: 0,
            network: Arc::new(network),
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

    /// Puts pods at waypoints, where they are stored at the start.
    ///
    /// # Errors
    /// If there is no such waypoint; nothing has changed then.
    pub fn put_pods(&mut self, waypoints: &[u32]) -> Result<(), String> {
        if let Some(waypoint) = waypoints.iter().find(|&&v| v as usize >= self.network.nodes) {
            return Err(format!("no waypoint {waypoint} for a pod"));
        }
        waypoints.iter().for_each(|&waypoint| self.stored[waypoint as usize] = true);
        Ok(())
    }

    /// Lets the planner prefer ways by extra costs of edges (from, to, microseconds).
    ///
    /// # Errors
    /// If there is no such edge, or the planner is rolling.
    pub fn set_guidance(&mut self, edges: &[(u32, u32, u32)]) -> Result<(), String> {
        if self.rolling.is_some() {
            return Err("only trip planners use guidance".into());
        }
        self.guidance = guidance(&self.network, edges)?;
        Ok(())
    }

    /// Replaces the rest of a robot's program; a moving robot first continues to its next stop.
    ///
    /// # Errors
    /// If a waypoint or station does not exist, the robot is lifting or setting down, or the program starts with that away from rest.
    pub fn command(&mut self, robot: u32, program: &[Step]) -> Result<(), String> {
        let state = &self.robots[robot as usize];
        if state.phase == Phase::Transferring {
            return Err(format!("robot {robot} is lifting or setting down a pod"));
        }
        program.iter().try_for_each(|&step| self.exists(step))?;
        self.settle(robot);
        let queueing_since = self.queueing_since(robot as usize);
        let state = &mut self.robots[robot as usize];
        if !state.moves.is_empty()
            && matches!(program.first(), Some(Step::Lift(_) | Step::SetDown(_)))
        {
            return Err(format!("robot {robot} is driving and cannot lift or set down"));
        }
        if let Some(entered) = queueing_since {
            // it leaves the queue without having been served
            let totals = &mut self.record.totals[robot as usize];
            totals.queueing += self.now - entered.max(self.record.since);
        }
        state.program = VecDeque::from(program.to_vec());
        state.awaits = (0, 0);
        if let Some(pace) = &mut self.pace {
            pace.withdraw(robot);
        }
        self.begin(robot);
        Ok(())
    }

    fn exists(&self, step: Step) -> Result<(), String> {
        match step {
            Step::Drive(waypoint) if waypoint as usize >= self.network.nodes => {
                Err(format!("no waypoint {waypoint}"))
            }
            Step::Station(station) if station as usize >= self.network.stations.len() => {
                Err(format!("no station {station}"))
            }
            _ => Ok(()),
        }
    }

    /// Advances to the first time not after `until` at which something happens, or to `until`.
    ///
    /// Events of the kinds in the bit set `ignored` are left out.
    pub fn advance(&mut self, until: Us, ignored: u32) -> Vec<Event> {
        loop {
            self.outbox.retain(|event| ignored >> event.kind as u32 & 1 == 0);
            if !self.outbox.is_empty() {
                break;
            }
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
        let mut left = AT_ONCE * (self.robots.len() + 1);
        while let Some(&Reverse((at, robot, due, version))) = self.agenda.peek() {
            if at > time {
                break;
            }
            self.agenda.pop();
            look_up();
            left -= 1;
            assert!(left > 0, "what happens at {time} has no end");
            match due {
                Due::TransferEnd => self.transfer_ended(robot),
                Due::LegEnd if self.robots[robot as usize].version == version => {
                    self.leg_ended(robot)
                }
                Due::LegEnd => {}
                Due::Depart => self.departure_due(robot, version),
                Due::Call => self.call_planner(),
                Due::Motion => self.motion_due(robot, version),
                Due::Plan => self.planners_due(),
                Due::NextMotion => self.next_motion_due(robot, version),
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
        self.improve();
    }

    fn emit(&mut self, kind: EventKind, robot: u32, value: u32) {
        self.outbox.push(Event { time: self.now, kind, robot, value });
    }
}
