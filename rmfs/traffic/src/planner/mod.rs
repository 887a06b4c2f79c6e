//! Path planners: one trait, and the methods behind it.
//!
//! There are two rhythms. A planner *per leg* gives a robot its whole way when it is told where to
//! go, free of conflict with everything granted before. A *rolling* planner is asked for all robots
//! again and again; what it returns are wishes, of which the fleet grants a few straight runs at a
//! time, when the robot is at rest and they are free (`fleet/rolling.rs`). Either way only the
//! fleet reserves, so that no planner can cause a collision.

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
use crate::kinematics::Kind;
use crate::network::Network;
use crate::reservations::Table;
use crate::robot::Robot;
use crate::search::{Move, Pathfinder};
use crate::units::Us;

pub use resumable::Resumable;
pub use settings::{Settings, build};
pub use time_windows::TimeWindows;

/// What a planner may look at and work with.
pub struct Scene<'a> {
    pub now: Us,
    pub network: &'a Network,
    pub kinds: &'a [Kind],
    pub robots: &'a [Robot],
    /// What is granted. A planner per leg is asked with the robot's own reservations taken out.
    pub table: &'a Table,
    pub pathfinder: &'a mut Pathfinder,
    pub costs: &'a mut Cache,
}

/// A robot that wants to drive.
#[derive(Clone, Debug)]
pub struct Agent {
    pub robot: u32,
    pub kind: u8,
    /// The first rest from which the rest of its way can be chosen, and when it is there.
    pub start: u32,
    pub heading: u8,
    pub ready: Us,
    pub goal: u32,
    pub loaded: bool,
    /// Labels that may be looked at for it; `u64::MAX` if it needs a way whatever that takes.
    pub effort: u64,
    /// Rolling planners: whether it has no way, or was refused its last wish.
    pub needs_plan: bool,
}

/// When a planner is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Rhythm {
    /// Once for each leg, for one robot at a time.
    PerLeg,
    /// For all robots that drive, when one of them needs a plan, but not before `period` has passed
    /// since the last call. Robots are granted at most so many runs of their wishes at once.
    Rolling { period: Us, runs: usize },
}

/// What a planner says of an agent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Moves from rest to rest that begin at the agent's start, not before it is ready there.
    Way(Vec<Move>),
    /// Rolling planners: what was wanted before stands.
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
    /// When it is asked.
    fn rhythm(&self) -> Rhythm;

    /// Planners per leg: labels that may be looked at for each robot of a group when plans are to be
    /// improved; 0 for never.
    fn improvement(&self) -> u64 {
        0
    }

    /// Plans ways for agents; one answer each.
    ///
    /// A planner per leg returns a way to the goal that is free in the scene's table and ends where
    /// the robot can stay; a rolling planner what it would like.
    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer>;
}
