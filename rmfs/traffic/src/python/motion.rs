//! Motion on one straight line, for Python.

use pyo3::prelude::*;

use crate::kinematics::{Kind, Profile};

/// Seconds, positions and speeds of a straight line driven from an initial speed.
#[pyclass(frozen)]
pub(super) struct Motion {
    profile: Profile,
}

#[pymethods]
impl Motion {
    #[new]
    fn new(
        acceleration: f64,
        deceleration: f64,
        top_speed: f64,
        initial_speed: f64,
        length: f64,
    ) -> Self {
        let kind = Kind { acceleration, deceleration, top_speed, full_turn: 0, pod_transfer: 0 };
        Self { profile: Profile::new(&kind, initial_speed, length) }
    }

    fn duration(&self) -> f64 {
        self.profile.duration()
    }

    fn time_at(&self, distance: f64) -> f64 {
        self.profile.time_at(distance)
    }

    fn position_at(&self, time: f64) -> f64 {
        self.profile.position_at(time)
    }

    fn speed_at(&self, time: f64) -> f64 {
        self.profile.speed_at(time)
    }
}
