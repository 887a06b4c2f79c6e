//! One robot: its program, position and plan.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::kinematics::Kind;
use crate::network::{NONE, Network};
use crate::search::Move;
use crate::units::{FOREVER, Us, ceil_us, floor_us};

/// The steps of a robot's program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Step {
    /// Drive to a waypoint and stop there.
    Drive(u32),
    /// Lift the pod stored here.
    Lift(u32),
    /// Set the carried pod down here.
    SetDown(u32),
    /// Drive to a station's queue, move up and reach its head.
    Station(u32),
}

impl Step {
    fn is_lift(&self) -> bool {
        matches!(self, Step::Lift(_))
    }
}

/// Progress of a robot on the first step of its program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// No program.
    Idle,
    /// On the way, or standing in a queue.
    Driving,
    /// Needs to drive and has found no way yet.
    Blocked,
    /// At rest until a lift or set-down ends.
    Transferring,
    /// Needs to drive and waits for its turn with a planner.
    Planning,
}

/// An occupation in the reservation table that belongs to the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Held {
    pub resource: u32,
    pub start: Us,
    pub end: Us,
    /// Which of the robot's moves enters it; `NONE` where the robot already is.
    pub entered_by: u32,
}

/// The state of one robot.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Robot {
    pub kind: u8,
    /// Where the robot rests, or where the first of `moves` began.
    pub anchor: u32,
    pub heading: u8,
    /// Time from which the anchor is occupied.
    pub anchored: Us,
    /// When the robot is (or was) at rest at the anchor.
    pub rested: Us,
    pub moves: VecDeque<Move>,
    pub held: Vec<Held>,
    pub pod: Option<u32>,
    pub program: VecDeque<Step>,
    pub phase: Phase,
    /// Time until which the robot stays: it lifts, sets down or has broken down.
    pub busy_until: Us,
    /// When the current lift or set-down ends.
    pub transfer_end: Us,
    /// Station, and the place in its queue assigned to the robot.
    pub place: Option<(u32, usize)>,
    /// Changes whenever the plan changes, so that events of old plans are recognised.
    pub version: u32,
    /// When it began to stand without the plan it needs, and when the plan is there.
    pub awaits: (Us, Us),
}

impl Robot {
    /// A robot at rest.
    pub fn at(anchor: u32, heading: u8, kind: u8) -> Self {
        Self {
            kind,
            anchor,
            heading,
            anchored: 0,
            rested: 0,
            moves: VecDeque::new(),
            held: Vec::new(),
            pod: None,
            program: VecDeque::new(),
            phase: Phase::Idle,
            busy_until: 0,
            transfer_end: 0,
            place: None,
            version: 0,
            awaits: (0, 0),
        }
    }

    /// Where the plan ends, with heading and time.
    pub fn destination(&self) -> (u32, u8, Us) {
        self.moves.back().map_or((self.anchor, self.heading, self.rested), |last| {
            (last.to, last.heading, last.end)
        })
    }

    /// Everything the robot occupies: the anchor, the way, and the end of the plan indefinitely.
    pub fn occupation(&self, network: &Network, kind: &Kind) -> Vec<Held> {
        occupation(network, kind, self.anchor, self.anchored, &self.moves)
    }
    /// Number of moves that can no longer be changed at `now`, because their turn has begun.
    pub fn committed(&self, network: &Network, kind: &Kind, now: Us) -> usize {
        self.moves
            .iter()
            .take_while(|step| {
                let turn = kind.turn(
                    network.headings[step.heading_before as usize],
                    network.headings[step.heading as usize],
                );
                step.start - turn < now
            })
            .count()
    }

    /// Whether the robot owns a place in a queue of `station`.
    pub fn queues_at(&self, station: u32) -> bool {
        self.place.is_some_and(|(own, _)| own == station)
    }

    /// The waypoint where the robot stands at `now` or will stop next. Moves that have ended may
    /// not have been recorded yet.
    pub fn next_stop(&self, now: Us) -> u32 {
        let under_way = self.moves.iter().find(|step| step.end > now);
        under_way.or(self.moves.back()).map_or(self.anchor, |step| step.to)
    }

    /// Station of the current step, or `NONE`.
    pub fn station(&self) -> u32 {
        match self.program.front() {
            Some(Step::Station(station)) => *station,
            _ => NONE,
        }
    }

    /// Purpose of the robot, as counted by [`crate::heat::Heat`]: the station for which it is bound
    /// or at which it stands; otherwise `stations` if it carries or fetches a pod, and `stations +
    /// 1` if not.
    pub fn purpose(&self, stations: usize) -> usize {
        let bound = self.program.iter().find_map(|step| match step {
            Step::Station(station) => Some(*station as usize),
            _ => None,
        });
        let served = if self.program.is_empty() { self.place } else { None };
        let for_pod = || self.pod.is_some() || self.program.iter().any(Step::is_lift);
        bound
            .or(served.map(|(station, _)| station as usize))
            .unwrap_or_else(|| if for_pod() { stations } else { stations + 1 })
    }
}

/// What a robot occupies if it stands at `from` from a given time on and then makes the moves: the
/// start, the way, and the end indefinitely.
pub fn occupation<'a>(
    network: &Network,
    kind: &Kind,
    from: u32,
    since: Us,
    moves: impl IntoIterator<Item = &'a Move>,
) -> Vec<Held> {
    let mut held = Vec::new();
    let (mut since, mut entered_by) = (since, NONE);
    let mut end = from;
    for (index, step) in moves.into_iter().enumerate() {
        end = step.to;
        if step.ride {
            // the shaft is one resource, so the ride continues the same occupation
            continue;
        }
        let line: Vec<(u32, f64)> = network.line(step.from, step.to, step.heading).collect();
        let length = line.last().map_or(0.0, |end| end.1);
        let profile = kind.run(length);
        let mut node = step.from;
        let mut passed = 0.0;
        for (i, &(next, distance)) in line.iter().enumerate() {
            let reached = profile.time_at(distance);
            // what had been left when the delay came was not left later for it
            let late = if i + 1 < step.begun as usize { 0 } else { step.late };
            held.push(Held {
                resource: network.resource[node as usize],
                start: since,
                end: step.start + late + ceil_us(reached),
                entered_by,
            });
            let late = if i < step.begun as usize { 0 } else { step.late };
            since = step.start + late + floor_us(passed);
            entered_by = index as u32;
            passed = reached;
            node = next;
        }
    }
    let resource = network.resource[end as usize];
    held.push(Held { resource, start: since, end: FOREVER, entered_by });
    held
}
