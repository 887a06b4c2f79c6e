//! The record of motion: totals per robot, heat, trips and the trace.

mod moves;
mod rows;

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use crate::energy::{Done, Energy};
use crate::heat::Heat;
use crate::kinematics::Kind;
use crate::log::Log;
use crate::network::Network;
use crate::robot::Robot;
use crate::search::Move;
use crate::units::{Us, ceil_us};

pub use moves::{angle, enters_zone, partly};
pub use rows::{Piece, Row};
use rows::{guided, move_rows, pod_id};

/// Why a robot stands still; with the purpose of its way, see [`Heat`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    Idle,
    Waiting(usize),
    Served(usize),
}

/// A delay of a run that had begun.
#[derive(Clone, Debug)]
struct Late {
    /// When the run starts, which tells it from others of the robot.
    start: Us,
    /// Waypoints of the run in use when the delay came.
    begun: u32,
    /// Total delay since then.
    by: Us,
}

/// Totals of one robot since the last reset.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Totals {
    pub distance: f64,
    pub loaded_distance: f64,
    pub moving: Us,
    pub turning: Us,
    pub waiting: Us,
    pub served: Us,
    pub idle: Us,
    pub transferring: Us,
    pub riding: Us,
    /// From entering a queue zone to reaching its head; overlaps with the others.
    pub queueing: Us,
    /// Standing without the plan it needs; part of `waiting`.
    pub awaiting: Us,
}

impl Totals {
    /// The sum, or with a factor of -1 the difference, of two totals.
    pub fn plus(&self, other: &Self, factor: Us) -> Self {
        let metres = |a: f64, b: f64| a + factor as f64 * b;
        Self {
            distance: metres(self.distance, other.distance),
            loaded_distance: metres(self.loaded_distance, other.loaded_distance),
            moving: self.moving + factor * other.moving,
            turning: self.turning + factor * other.turning,
            waiting: self.waiting + factor * other.waiting,
            served: self.served + factor * other.served,
            idle: self.idle + factor * other.idle,
            transferring: self.transferring + factor * other.transferring,
            riding: self.riding + factor * other.riding,
            queueing: self.queueing + factor * other.queueing,
            awaiting: self.awaiting + factor * other.awaiting,
        }
    }
}

/// One leg, from the decision to drive to the arrival (for a station: at the queue zone).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Trip {
    pub robot: u32,
    pub kind: TripKind,
    pub start: Us,
    pub end: Us,
    pub from: u32,
    pub to: u32,
    pub loaded: bool,
    pub distance: f64,
    pub unhindered: Us,
    /// J drawn, less what braking returned; for a station, up to its head; 0 if energy is not
    /// counted.
    pub energy: f64,
    /// Time at its beginning in which the robot waited for its plan.
    pub awaited: Us,
}

/// Purpose of a trip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(i8)]
pub enum TripKind {
    ToPod = 0,
    ToStation = 1,
    ToStorage = 2,
    ToRest = 3,
}

/// Everything recorded.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Record {
    pub totals: Vec<Totals>,
    pub heat: Heat,
    pub trips: Log<Trip>,
    pub trace: Option<Log<Row>>,
    /// The energy of the motion, if it is counted.
    pub energy: Option<Box<Energy>>,
    /// Start of the counting of totals, heat and trips.
    pub since: Us,
    /// Time up to which each robot's motion is recorded.
    recorded: Vec<Us>,
    /// Delays of each robot's run in progress. Only robots outside the simulation delay runs in
    /// progress, and these cannot be saved.
    #[serde(skip)]
    late: HashMap<u32, Vec<Late>>,
}

impl Record {
    /// An empty record.
    pub fn new(robots: usize, network: &Network, with_trace: bool) -> Self {
        Self {
            totals: vec![Totals::default(); robots],
            heat: Heat::new(network),
            trips: Log::default(),
            trace: with_trace.then(Log::default),
            energy: None,
            since: 0,
            recorded: vec![0; robots],
            late: HashMap::new(),
        }
    }

    /// Resets totals, heat and trips at `now`; the trace is kept. Motion in progress is recorded
    /// when it ends, so its part before `now` is subtracted in advance.
    pub fn reset(&mut self, now: Us, in_progress: &[Totals]) {
        self.since = now;
        for (totals, done) in self.totals.iter_mut().zip(in_progress) {
            *totals = Totals::default().plus(done, -1);
        }
        self.heat.reset();
        self.trips.clear();
    }

    /// J drawn by the robot as far as recorded; 0 if energy is not counted.
    pub fn used(&self, robot: u32) -> f64 {
        self.energy.as_ref().map_or(0.0, |energy| energy.used(robot))
    }

    /// Time up to which the robot's motion is recorded.
    pub fn recorded(&self, robot: u32) -> Us {
        self.recorded[robot as usize]
    }

    /// Counts the part of a standing time until `end` in which the robot had no plan.
    pub fn await_plan(&mut self, robot: u32, end: Us, awaits: (Us, Us)) {
        let begin = self.recorded[robot as usize].max(awaits.0);
        let awaiting = &mut self.totals[robot as usize].awaiting;
        *awaiting += (end.min(awaits.1) - begin).max(0);
    }

    /// Records that the robot stood still until `end`.
    pub fn stand(
        &mut self,
        robot: u32,
        end: Us,
        node: u32,
        heading: u8,
        pod: Option<u32>,
        why: Standing,
    ) {
        let start = self.recorded[robot as usize];
        if end <= start {
            return;
        }
        let totals = &mut self.totals[robot as usize];
        match why {
            Standing::Idle => totals.idle += end - start,
            Standing::Waiting(_) => totals.waiting += end - start,
            Standing::Served(_) => totals.served += end - start,
        }
        if let Standing::Waiting(purpose) | Standing::Served(purpose) = why {
            self.heat.wait(node, purpose, pod.is_some(), end - start);
        }
        if let Some(energy) = &mut self.energy {
            energy.stood(robot, start, end, node, pod);
        }
        self.push(Row {
            robot,
            start,
            end,
            piece: Piece::Hold,
            from: node,
            to: node,
            heading_before: heading,
            heading,
            pod: pod_id(pod),
            top_speed: 0.0,
        });
    }

    /// Records a lift or set-down that ends now.
    pub fn transfer(
        &mut self,
        robot: u32,
        end: Us,
        node: u32,
        heading: u8,
        pod: u32,
        piece: Piece,
    ) {
        let start = self.recorded[robot as usize];
        self.totals[robot as usize].transferring += end - start;
        if let Some(energy) = &mut self.energy {
            let done = if piece == Piece::Lift { Done::Lift(1.0) } else { Done::Time };
            energy.moved(robot, start, end, Some(pod), done);
        }
        self.push(Row {
            robot,
            start,
            end,
            piece,
            from: node,
            to: node,
            heading_before: heading,
            heading,
            pod: pod as i32,
            top_speed: 0.0,
        });
    }

    /// Records the present delay of a run in progress.
    pub fn hold_up(&mut self, robot: u32, step: &Move) {
        let known = self.late.entry(robot).or_default();
        if known.last().is_none_or(|last| (last.start, last.by) != (step.start, step.late)) {
            known.push(Late { start: step.start, begun: step.begun, by: step.late });
        }
    }

    /// When the robot starts a run, and when it reaches each waypoint, delays included.
    fn reached(
        &self,
        network: &Network,
        kind: &Kind,
        robot: u32,
        step: &Move,
    ) -> (Us, Vec<(u32, Us)>) {
        let line: Vec<(u32, f64)> = network.line(step.from, step.to, step.heading).collect();
        let profile = kind.run(line.last().map_or(0.0, |end| end.1));
        let known = self.late.get(&robot).map_or(&[][..], Vec::as_slice);
        let mine: Vec<&Late> = known.iter().filter(|late| late.start == step.start).collect();
        let of = |(index, &(node, distance)): (usize, &(u32, f64))| {
            // a waypoint in use may have been reached, unless it was the last of them
            let behind = |late: &&&Late| late.begun as usize <= index + 1;
            let by = mine.iter().rev().find(behind).map_or(0, |late| late.by);
            (node, step.start + by + ceil_us(profile.time_at(distance)))
        };
        let before = mine.iter().rev().find(|late| late.begun == 0).map_or(0, |late| late.by);
        (step.start + before, line.iter().enumerate().map(of).collect())
    }

    /// A move as rows of the trace: the turn before it, if any, and the run or ride. A delayed run
    /// is recorded waypoint by waypoint.
    pub fn rows(
        &self,
        network: &Network,
        kind: &Kind,
        robot: u32,
        step: &Move,
        pod: Option<u32>,
    ) -> Vec<Row> {
        let mut rows: Vec<Row> = move_rows(network, kind, robot, step, pod).collect();
        if step.late == 0 || step.ride {
            return rows;
        }
        let whole = rows.pop().expect("a move has a row");
        let (set_off, reached) = self.reached(network, kind, robot, step);
        if set_off > whole.start {
            let start = (whole.from, whole.start);
            let stands = guided(&whole, start, (whole.from, set_off));
            rows.push(Row { piece: Piece::Hold, ..stands });
        }
        let mut here = (whole.from, set_off);
        for (node, time) in reached {
            rows.push(guided(&whole, here, (node, time)));
            here = (node, time);
        }
        if let Some(last) = rows.last_mut() {
            last.end = whole.end;
        }
        rows
    }

    /// Records that a robot abandons its plan and is at rest as `later` states: at the end of the
    /// part of its run that it may still drive, or wherever it was put.
    pub fn abandon(
        &mut self,
        network: &Network,
        kind: &Kind,
        robot: u32,
        state: &Robot,
        later: &Robot,
        now: Us,
    ) {
        let (anchor, pod, mut heading) = (state.anchor, state.pod, state.heading);
        let under_way = state.committed(network, kind, now) > 0;
        let step = state.moves.front().filter(|step| under_way && !step.ride);
        let begin = self.recorded[robot as usize];
        let still = Row {
            robot,
            start: begin,
            end: begin,
            piece: Piece::Guided,
            from: anchor,
            to: anchor,
            heading_before: heading,
            heading,
            pod: pod_id(pod),
            top_speed: 0.0,
        };
        let mut rows: Vec<Row> = Vec::new();
        let mut here = (anchor, begin);
        if let Some(step) = step {
            let turned = step.start.min(now);
            if turned > begin {
                rows.push(Row { end: turned, heading: step.heading, ..still.clone() });
            }
            heading = step.heading;
            let (set_off, reached) = self.reached(network, kind, robot, step);
            here.1 = turned.max(begin);
            if set_off.min(now) > here.1 {
                let end = (anchor, set_off.min(now));
                rows.push(guided(&Row { heading, ..still.clone() }, here, end));
                here = end;
            }
            for (node, time) in reached {
                if time > now {
                    break;
                }
                rows.push(guided(&Row { heading, ..still.clone() }, here, (node, time)));
                here = (node, time);
            }
        }
        if later.anchor != here.0 {
            let end = (later.anchor, later.rested.max(here.1));
            rows.push(guided(&Row { heading, ..still.clone() }, here, end));
            here = end;
        }
        if later.heading != heading {
            let last = guided(&Row { heading: later.heading, ..still.clone() }, here, here);
            rows.push(Row { heading_before: heading, ..last });
        }
        self.late.remove(&robot);
        for row in rows {
            let (a, b) = (network.position(row.from), network.position(row.to));
            let length = (b.0 - a.0).hypot(b.1 - a.1);
            let totals = &mut self.totals[robot as usize];
            totals.distance += length;
            if pod.is_some() {
                totals.loaded_distance += length;
            }
            *(if row.from == row.to { &mut totals.turning } else { &mut totals.moving }) +=
                row.end - row.start;
            if let Some(energy) = &mut self.energy {
                energy.moved(robot, row.start, row.end, pod, Done::Time);
            }
            self.push(row);
        }
    }

    /// Records a whole move, the turn before it included; the robot stood until the turn.
    pub fn drive(
        &mut self,
        network: &Network,
        kind: &Kind,
        robot: u32,
        step: &Move,
        pod: Option<u32>,
        purpose: usize,
    ) {
        let mut length = 0.0;
        let loaded = pod.is_some();
        if step.ride {
            self.heat.ride(step.from, step.to, loaded);
            self.heat.visit(step.to, purpose, loaded);
        } else {
            let mut here = step.from;
            for (node, distance) in network.line(step.from, step.to, step.heading) {
                self.heat.pass(network, here, step.heading, loaded);
                self.heat.visit(node, purpose, loaded);
                (here, length) = (node, distance);
            }
        }
        let totals = &mut self.totals[robot as usize];
        totals.distance += length;
        if loaded {
            totals.loaded_distance += length;
        }
        let profile = self.energy.is_some().then(|| kind.run(length));
        let rows = self.rows(network, kind, robot, step, pod);
        if let Some(late) = self.late.get_mut(&robot) {
            late.retain(|late| late.start > step.start);
        }
        for row in rows {
            if let Some(energy) = &mut self.energy {
                let done = match row.piece {
                    // the whole run at its first waypoint
                    Piece::Guided if row.from == step.from => {
                        Done::Run(kind, profile.as_ref().expect("made above"), length)
                    }
                    Piece::Turn => Done::Turn(kind, angle(network, step), 1.0),
                    Piece::Run => Done::Run(kind, profile.as_ref().expect("made above"), length),
                    _ => Done::Time,
                };
                energy.moved(robot, row.start, row.end, pod, done);
            }
            let totals = &mut self.totals[robot as usize];
            let time = row.end - row.start;
            match row.piece {
                Piece::Turn => totals.turning += time,
                Piece::Ride => totals.riding += time,
                _ => totals.moving += time,
            }
            self.push(row);
        }
    }

    fn push(&mut self, row: Row) {
        self.recorded[row.robot as usize] = row.end;
        if let Some(trace) = &mut self.trace {
            trace.push(row);
        }
    }
}
