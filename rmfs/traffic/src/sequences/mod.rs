//! Task sequences of robots, for the model `rmfs.solvers.models.tasks.sequence`: arrays in, routes
//! out.
//!
//! Nothing here knows of traffic. It is part of this crate as the package has one compiled library.

mod insertion;
mod plan;
mod problem;
mod search;

pub use plan::Plan;
pub use problem::{Given, NEVER, NONE, Problem};
pub use search::{Found, improved};

#[cfg(test)]
mod tests;
