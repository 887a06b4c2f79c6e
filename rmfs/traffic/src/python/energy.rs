//! Energy that robots draw, and their batteries.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::energy::{Battery, Energy, Model, Spent};

use super::core::Core;
use super::tables;

fn no_energy() -> PyErr {
    PyValueError::new_err("energy is not counted")
}

#[pymethods]
impl Core {
    /// Counts energy from now on: model, mass of each pod (kg), battery (capacity in J, share of it
    /// from which the power of charging falls), power of each waypoint (W) and J in each robot.
    fn count_energy(
        &mut self,
        model: [f64; 11],
        pods: Vec<f64>,
        battery: Option<(f64, f64)>,
        power: Vec<f64>,
        initial: Vec<f64>,
    ) -> PyResult<()> {
        let [robot, rolling, inertia, efficiency, recuperation, turning, ref rest @ ..] = model;
        let [gyration, lift_height, lift_efficiency, empty, loaded] = *rest;
        let model = Model {
            robot,
            rolling,
            inertia,
            efficiency,
            recuperation,
            turning,
            gyration,
            lift_height,
            lift_efficiency,
            standby: [empty, loaded],
        };
        let battery = battery.map(|(capacity, taper_from)| Battery { capacity, taper_from });
        if initial.len() != self.fleet.robots.len() {
            return Err(PyValueError::new_err("not one level per robot"));
        }
        if !power.is_empty() && power.len() != self.fleet.network.nodes {
            return Err(PyValueError::new_err("not one power per waypoint"));
        }
        self.with(|fleet| {
            fleet.count_energy(Energy::new(model, pods, battery, power, initial));
        })
    }

    /// Energy per robot, at the current time.
    fn energy<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let robots = self.fleet.robots.len() as u32;
        let spent: Vec<Spent> =
            self.with(|fleet| (0..robots).filter_map(|robot| fleet.spent(robot)).collect())?;
        let energy = self.fleet.record.energy.as_ref().ok_or_else(no_energy)?;
        tables::energy(py, energy, &spent)
    }

    /// J drawn by a robot since time zero.
    fn used(&mut self, robot: u32) -> PyResult<f64> {
        let spent = self.with_robot(robot, |fleet| fleet.spent(robot))?;
        let energy = self.fleet.record.energy.as_ref().ok_or_else(no_energy)?;
        Ok(spent.ok_or_else(no_energy)?.used(&energy.model))
    }

    /// J in the battery of a robot.
    fn level(&mut self, robot: u32) -> PyResult<f64> {
        let spent = self.with_robot(robot, |fleet| fleet.spent(robot))?;
        let energy = self.fleet.record.energy.as_ref().ok_or_else(no_energy)?;
        Ok(energy.level_of(robot, &spent.ok_or_else(no_energy)?))
    }

    /// Sets the mass of a pod from now on, kg.
    fn set_pod_mass(&mut self, pod: usize, mass: f64) -> PyResult<()> {
        let energy = self.fleet.record.energy.as_mut().ok_or_else(no_energy)?;
        *energy.pods.get_mut(pod).ok_or_else(|| PyValueError::new_err("no such pod"))? = mass;
        Ok(())
    }

    /// Sets the power that a waypoint supplies, W.
    fn set_power(&mut self, waypoint: u32, watts: f64) -> PyResult<()> {
        self.check_place(waypoint, 0)?;
        self.with(|fleet| fleet.set_power(waypoint, watts))
    }

    /// Exchanges a robot's battery for one with the given energy, J.
    fn exchange_battery(&mut self, robot: u32, level: f64) -> PyResult<()> {
        self.with_robot(robot, |fleet| fleet.exchange_battery(robot, level))
    }
}
