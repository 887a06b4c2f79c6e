//! Traffic of a Robotic Mobile Fulfillment System: the motion of robots, regardless of its purpose.
//!
//! The compiled parts of rules (`matching`, `ranking`) and models (`sequences`, `visits`) are here
//! as well, since the package has one compiled library; they know nothing of traffic.

pub mod backward;
pub mod buckets;
pub mod costs;
pub mod energy;
pub mod fleet;
pub mod guidance;
pub mod heat;
pub mod kinematics;
pub mod log;
pub mod matching;
pub mod network;
pub mod patience;
pub mod planner;
pub mod postpone;
pub mod random;
pub mod ranking;
pub mod reach;
pub mod record;
pub mod reservations;
pub mod robot;
pub mod route;
pub mod search;
pub mod sequences;
pub mod units;
pub mod visits;

#[cfg(feature = "python")]
mod python;
