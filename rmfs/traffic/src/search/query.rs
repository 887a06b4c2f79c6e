//! What is asked of a search, and what it answers.

use serde::{Deserialize, Serialize};

use crate::costs::Model;
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
    /// By how much the end is later than the motion says, for robots that follow a plan late.
    pub late: Us,
    /// Waypoints of the run already in use when it was last found to be late.
    pub begun: u32,
}

/// When a search has found what it looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The robot is at the goal and can stay there for good.
    ForGood,
    /// The robot is at the goal, whoever comes there later.
    Arrival,
    /// The window ends at this time: the robot is at the goal or on the way, and can stay where it
    /// is until then. What others do later does not count.
    Window(Us),
    /// The same, and the robot can stay there for good.
    WindowForGood(Us),
}

/// Of which labels the unhindered times are searched for, before they are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Guide {
    /// Of all.
    Exact,
    /// Of those over which a way is at most so much longer than the best; of others straight lines
    /// to the goal tell how far it is at least.
    Near(Us),
}

/// What a robot wants.
#[derive(Clone, Debug)]
pub struct Query<'a> {
    pub start: u32,
    pub heading: u8,
    /// Earliest departure; the robot is at rest at `start` then.
    pub ready: Us,
    /// Where to go; `NONE`: to the nearest storage place that nobody holds, and for a loaded robot
    /// one without a pod.
    pub goal: u32,
    pub loaded: bool,
    /// At which waypoints pods are stored; needed without a goal only.
    pub stored: &'a [bool],
    pub kind: &'a Kind,
    pub model: &'a Model,
    /// Labels that may be looked at.
    pub budget: u64,
    pub end: End,
    /// How much later than unhindered, or than the goal is free, an arrival is still of use.
    pub detour: Us,
    pub guide: Guide,
    /// Exact unhindered times to the goal, as [`crate::costs::Table`]; searched for if not given.
    pub times: Option<&'a [u32]>,
}

/// How a search ended.
#[derive(Debug, PartialEq, Eq)]
pub enum Outcome {
    Found(Vec<Move>),
    NoWay,
    OutOfBudget,
}
