//! Path planners: one trait, and the methods behind it.
//!
//! There are two rhythms. A *trip* planner gives a robot its whole way when it receives a
//! destination, free of conflict with everything granted before. A *rolling* planner is called
//! repeatedly for all robots; it returns proposals, of which the fleet grants a few straight runs
//! at a time, when the robot is at rest and they are free (`fleet/rolling.rs`). In either case only
//! the fleet reserves, so no planner can cause a collision.

mod bcp;
mod cbs;
pub(crate) mod conflicts;
mod deadlock;
mod far;
mod od_id;
mod partial;
mod pas;
mod pbs;
mod pibt;
mod resumable;
pub(crate) mod rolling;
mod settings;
mod swift;
mod time_windows;
mod whca_persistent;
mod whca_volatile;

use std::fmt::Debug;

use serde::{Deserialize, Serialize};

use crate::costs::Cache;
use crate::guidance::Guidance;
use crate::kinematics::Kind;
use crate::network::Network;
use crate::reservations::Table;
use crate::robot::Robot;
use crate::search::{Move, Pathfinder};
use crate::units::Us;

pub use resumable::Resumable;
pub use settings::{Settings, build};
pub use time_windows::TimeWindows;

/// Everything that a planner may read and use.
pub struct Scene<'a> {
    pub now: Us,
    pub network: &'a Network,
    pub kinds: &'a [Kind],
    pub robots: &'a [Robot],
    /// The reservations granted; for a trip planner, without those of the robot itself.
    pub table: &'a Table,
    pub pathfinder: &'a mut Pathfinder,
    pub costs: &'a mut Cache,
    /// Extra costs of edges, which trip planners add to times.
    pub guidance: Option<&'a Guidance>,
}

/// A robot that needs to drive.
#[derive(Clone, Debug)]
pub struct Agent {
    pub robot: u32,
    pub kind: u8,
    /// The first rest from which the rest of its way can be chosen, and the time of arrival there.
    pub start: u32,
    pub heading: u8,
    pub ready: Us,
    pub goal: u32,
    pub loaded: bool,
    /// Maximum number of labels; `u64::MAX` if it needs a way at any cost.
    pub effort: u64,
    /// Rolling planners: whether it has no way, or its last proposal was refused.
    pub needs_plan: bool,
}

/// When a planner is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rhythm {
    /// Once for each trip, for one robot at a time.
    PerTrip,
    /// For all robots that drive, when one of them needs a plan, but not before `period` has passed
    /// since the last call. At most `runs` runs of a robot's proposal are granted at once.
    Rolling { period: Us, runs: usize },
}

/// A planner's answer for one agent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Moves from rest to rest that begin at the agent's start, not before it is ready there.
    Way(Vec<Move>),
    /// Rolling planners: the previous proposal remains.
    Keep,
    /// No way has been found.
    NoWay,
}

impl Answer {
    fn of(way: Option<Vec<Move>>) -> Self {
        way.map_or(Answer::NoWay, Answer::Way)
    }
}

/// A method of path planning.
pub trait Planner: Resumable + Debug + Send + Sync {
    /// When it is called.
    fn rhythm(&self) -> Rhythm;

    /// Trip planners: maximum number of labels for each robot of a group when plans are
    /// improved; 0 for never.
    fn improvement(&self) -> u64 {
        0
    }

    /// Plans ways for agents; returns one answer per agent.
    ///
    /// A trip planner returns a way to the goal that is free in the scene's table and ends where
    /// the robot can stay; a rolling planner returns proposals.
    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer>;
}
