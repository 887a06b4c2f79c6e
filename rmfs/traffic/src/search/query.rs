//! Input and result of a search.

use serde::{Deserialize, Serialize};

use crate::costs::Model;
use crate::guidance::Guidance;
use crate::kinematics::Kind;
use crate::units::Us;

/// One piece of a plan, from rest to rest.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Move {
    pub from: u32,
    pub to: u32,
    /// Direction driven; for a ride the heading kept.
    pub heading: u8,
    /// Heading before, at rest at `from`.
    pub heading_before: u8,
    pub start: Us,
    pub end: Us,
    pub ride: bool,
    /// Delay of the end compared with the motion, for robots that follow a plan late.
    pub late: Us,
    /// Waypoints of the run that were in use when it was last delayed.
    pub begun: u32,
}

/// Condition under which a search ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The robot is at the goal and can stay there indefinitely.
    ForGood,
    /// The robot is at the goal, even if others come there later.
    Arrival,
    /// The window ends at this time: the robot is at the goal or on the way, and can stay where it
    /// is until then. Later motion of others is ignored.
    Window(Us),
    /// The same, and the robot can stay there indefinitely.
    WindowForGood(Us),
}

/// Labels whose unhindered times are computed before they are examined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Guide {
    /// All labels.
    Exact,
    /// Labels over which a way is at most this much longer than the best; for others, straight
    /// lines to the goal give a lower bound.
    Near(Us),
}

/// A search for a way of one robot.
#[derive(Clone, Debug)]
pub struct Query<'a> {
    pub start: u32,
    pub heading: u8,
    /// Earliest departure; the robot is at rest at `start` then.
    pub ready: Us,
    /// The goal; `NONE`: the nearest storage location that no robot holds and, for a loaded robot,
    /// without a pod.
    pub goal: u32,
    pub loaded: bool,
    /// Waypoints at which pods are stored; only needed without a goal.
    pub stored: &'a [bool],
    pub kind: &'a Kind,
    pub model: &'a Model,
    /// Maximum number of labels.
    pub budget: u64,
    pub end: End,
    /// Maximum delay of a useful arrival, compared with the unhindered arrival or the time at which
    /// the goal is free.
    pub detour: Us,
    pub guide: Guide,
    /// Exact unhindered times to the goal, as [`crate::costs::Table`]; searched for if not given.
    pub times: Option<&'a [u32]>,
    /// Extra costs of edges: the way found has the least sum of arrival time and extra cost. Only
    /// with a goal and without given times.
    pub guidance: Option<&'a Guidance>,
}

/// How a search ended.
#[derive(Debug, PartialEq, Eq)]
pub enum Outcome {
    Found(Vec<Move>),
    NoWay,
    OutOfBudget,
}
