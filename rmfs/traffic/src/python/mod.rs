//! The Python interface of the crate: arrays in, arrays and events out.

mod commands;
mod core;
mod energy;
mod guard;
mod matching;
mod motion;
mod planner;
mod ranking;
mod readings;
mod sequences;
mod tables;
mod visits;

use pyo3::prelude::*;

use self::core::Core;
use motion::Motion;
use planner::{Along, Conflict, Reserved, Search, Way};
use sequences::Sequences;
use visits::Visits;

#[pymodule]
#[pyo3(name = "_core")]
mod core_module {
    #[pymodule_export]
    use super::matching::{completed, matches, servable};
    #[pymodule_export]
    use super::ranking::{best_rows, offered};
    #[pymodule_export]
    use super::{Along, Conflict, Core, Motion, Reserved, Search, Sequences, Visits, Way};
}
