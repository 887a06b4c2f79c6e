//! Rows of the trace: pieces of motion.

use serde::{Deserialize, Serialize};

use crate::kinematics::Kind;
use crate::network::Network;
use crate::search::Move;
use crate::units::Us;

/// Kinds of pieces of motion in the trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[repr(i8)]
pub enum Piece {
    Hold = 0,
    Turn = 1,
    Run = 2,
    Ride = 3,
    Lift = 4,
    SetDown = 5,
    /// Somewhere on the straight way between two waypoints, or turning at one: all that is known of
    /// a run that was delayed on its way.
    Guided = 6,
}

/// One piece of motion of one robot.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Row {
    pub robot: u32,
    pub start: Us,
    pub end: Us,
    pub piece: Piece,
    pub from: u32,
    pub to: u32,
    pub heading_before: u8,
    pub heading: u8,
    pub pod: i32,
    /// Top speed of a run, which is reduced while the robot is slow; 0 for other pieces.
    pub top_speed: f64,
}

pub(super) fn pod_id(pod: Option<u32>) -> i32 {
    pod.map_or(-1, |pod| pod as i32)
}

/// A part of a delayed run.
pub(super) fn guided(whole: &Row, from: (u32, Us), to: (u32, Us)) -> Row {
    Row {
        start: from.1,
        end: to.1,
        piece: Piece::Guided,
        from: from.0,
        to: to.0,
        heading_before: whole.heading,
        top_speed: 0.0,
        ..whole.clone()
    }
}

/// A move as rows of the trace: the turn before it, if any, and the run or ride.
pub(super) fn move_rows(
    network: &Network,
    kind: &Kind,
    robot: u32,
    step: &Move,
    pod: Option<u32>,
) -> impl Iterator<Item = Row> + use<> {
    let turn = kind.turn(
        network.headings[step.heading_before as usize],
        network.headings[step.heading as usize],
    );
    let row = |start: Us, end: Us, piece: Piece, to: u32, heading_before: u8| Row {
        robot,
        start,
        end,
        piece,
        from: step.from,
        to,
        heading_before,
        heading: step.heading,
        pod: pod_id(pod),
        top_speed: if piece == Piece::Run { kind.top_speed } else { 0.0 },
    };
    let turning = (turn > 0)
        .then(|| row(step.start - turn, step.start, Piece::Turn, step.from, step.heading_before));
    let piece = if step.ride { Piece::Ride } else { Piece::Run };
    let driving = row(step.start, step.end, piece, step.to, step.heading);
    turning.into_iter().chain(std::iter::once(driving))
}
