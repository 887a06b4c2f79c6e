//! Plans of pod visits, for the model `rmfs.solvers.models.planning`: arrays in, a plan out.
//!
//! This module is independent of traffic. It is part of this crate because the package has only one
//! compiled library.

mod appeal;
mod draft;
mod filling;
mod guess;
mod problem;
mod rule;
mod search;

pub use appeal::Appeal;
pub use draft::Draft;
pub use filling::Filling;
pub use problem::{Given, Line, NONE, Problem, Stocked};
pub use rule::extended;
pub use search::improved;
