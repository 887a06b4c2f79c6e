//! The traffic of one warehouse: how it is made, copied, saved and set up.

use std::collections::HashMap;

use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::fleet::{Entry, Fleet, Lateness, Pace, Price};
use crate::kinematics::Kind;
use crate::network::{Network, Plan, Ride};
use crate::planner::{Planner, Rhythm, Settings, build};
use crate::robot::Robot;
use crate::units::{Us, from_radians};

use super::guard::{guarded, internal_error, replay_error};
use super::planner::{Fault, PlannerInPython};

/// A kind of robot as passed by Python: acceleration, deceleration, top speed, full turn (µs),
/// pod transfer (µs).
type KindTuple = (f64, f64, f64, Us, Us);

fn kind_of((acceleration, deceleration, top_speed, full_turn, pod_transfer): KindTuple) -> Kind {
    Kind { acceleration, deceleration, top_speed, full_turn, pod_transfer }
}

/// The adapter of a planner written in Python.
fn in_python_with(
    code: Py<PyAny>,
    rhythm: Rhythm,
    network: &Network,
    fault: &Fault,
) -> Box<dyn Planner> {
    Box::new(PlannerInPython::new(code, rhythm, network.resources, Fault::clone(fault)))
}

/// The traffic of one warehouse.
#[pyclass]
pub(super) struct Core {
    pub(super) fleet: Fleet,
    /// How often a planner written in Python is called, if there is one, and the error it has
    /// raised.
    in_python: Option<Rhythm>,
    pub(super) fault: Fault,
    /// An earlier defect or interrupt, if any, after which the state of the fleet is undefined.
    defect: Option<String>,
}

impl Core {
    pub(super) fn over(fleet: Fleet, in_python: Option<Rhythm>, fault: Fault) -> Self {
        Self { fleet, in_python, fault, defect: None }
    }

    /// Runs a function on the fleet.
    pub(super) fn with<T>(&mut self, work: impl FnOnce(&mut Fleet) -> T) -> PyResult<T> {
        if let Some(said) = &self.defect {
            return Err(internal_error(said));
        }
        guarded(|| work(&mut self.fleet)).map_err(|failure| {
            self.defect = Some(failure.said());
            failure.into()
        })
    }

    /// Runs a function that can return an error.
    pub(super) fn try_with<T>(
        &mut self,
        work: impl FnOnce(&mut Fleet) -> Result<T, String>,
    ) -> PyResult<T> {
        self.with(work)?.map_err(PyValueError::new_err)
    }

    /// Runs a function for one robot.
    pub(super) fn with_robot<T>(
        &mut self,
        robot: u32,
        work: impl FnOnce(&mut Fleet) -> T,
    ) -> PyResult<T> {
        self.robot(robot as usize)?;
        self.with(work)
    }

    pub(super) fn robot(&self, robot: usize) -> PyResult<&Robot> {
        let missing = || PyValueError::new_err(format!("no robot {robot}"));
        self.fleet.robots.get(robot).ok_or_else(missing)
    }

    /// Raises an error if the run is not that of the tape of plans.
    pub(super) fn check_tape(&self) -> PyResult<()> {
        let fault = self.fleet.pace.as_ref().and_then(|pace| pace.fault.as_ref());
        fault.map_or(Ok(()), |told| Err(replay_error(told)))
    }

    pub(super) fn check_place(&self, waypoint: u32, kind: u8) -> PyResult<()> {
        if waypoint as usize >= self.fleet.network.nodes {
            return Err(PyValueError::new_err(format!("no waypoint {waypoint}")));
        }
        if kind as usize >= self.fleet.kinds.len() {
            return Err(PyValueError::new_err(format!("no kind {kind}")));
        }
        Ok(())
    }
}

#[pymethods]
impl Core {
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        x: PyReadonlyArray1<f64>,
        y: PyReadonlyArray1<f64>,
        tier: PyReadonlyArray1<i16>,
        edge_start: PyReadonlyArray1<u32>,
        edge_target: PyReadonlyArray1<u32>,
        storage: PyReadonlyArray1<bool>,
        queue: PyReadonlyArray1<bool>,
        stations: Vec<Vec<u32>>,
        elevators: Vec<Vec<u32>>,
        rides: Vec<(u32, u32, Us)>,
        robots: Vec<(u32, f64, u8)>,
        pods: Vec<u32>,
        kinds: Vec<KindTuple>,
        planner: (String, HashMap<String, f64>, u64, Option<Py<PyAny>>),
        budget: u64,
        cost_bytes: usize,
        with_trace: bool,
    ) -> PyResult<Self> {
        let plan = Plan {
            x: x.as_slice()?.to_vec(),
            y: y.as_slice()?.to_vec(),
            tier: tier.as_slice()?.to_vec(),
            edge_start: edge_start.as_slice()?.to_vec(),
            edge_target: edge_target.as_slice()?.to_vec(),
            storage: storage.as_slice()?.to_vec(),
            queue: queue.as_slice()?.to_vec(),
            stations,
            elevators,
            rides: rides.into_iter().map(|(from, to, travel)| Ride { from, to, travel }).collect(),
            extra_headings: robots.iter().map(|robot| from_radians(robot.1)).collect(),
        };
        let kinds: Vec<Kind> = kinds.into_iter().map(kind_of).collect();
        let (name, parameters, seed, code) = planner;
        let settings = Settings { name, parameters: parameters.into_iter().collect(), seed };
        let fault = Fault::default();
        let in_python = code.as_ref().map(|_| settings.rhythm()).transpose();
        let in_python = in_python.map_err(PyValueError::new_err)?;
        let fleet = guarded(|| -> Result<Fleet, String> {
            let network = Network::new(plan)?;
            let robots = placed(&network, &robots)?;
            let planner = match (code, in_python) {
                (Some(code), Some(rhythm)) => in_python_with(code, rhythm, &network, &fault),
                _ => build(&settings, &network)?,
            };
            let mut fleet =
                Fleet::new(network, kinds, &robots, planner, budget, cost_bytes, with_trace)?;
            fleet.put_pods(&pods)?;
            Ok(fleet)
        });
        Ok(Self::over(fleet?.map_err(PyValueError::new_err)?, in_python, fault))
    }

    /// An independent copy, with the given copy of a planner written in Python.
    fn fork(&mut self, code: Option<Py<PyAny>>) -> PyResult<Self> {
        let in_python = self.in_python;
        let fault = Fault::default();
        let fleet = self.with(|fleet| {
            let mut fleet = fleet.clone();
            if let (Some(code), Some(rhythm)) = (code, in_python) {
                fleet.exchange_planner(in_python_with(code, rhythm, &fleet.network, &fault));
            }
            fleet
        })?;
        Ok(Self::over(fleet, in_python, fault))
    }

    /// The whole state as bytes, except for the network and the settings.
    fn save<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(PyBytes::new(py, &self.try_with(|fleet| fleet.to_bytes())?))
    }

    /// Restores the state from the bytes of another core, built in the same way.
    fn restore(&mut self, bytes: &[u8]) -> PyResult<()> {
        self.try_with(|fleet| fleet.restore(bytes))
    }

    #[getter]
    fn now(&self) -> Us {
        self.fleet.now
    }

    /// Lets the planner prefer ways by extra costs of edges (from, to, microseconds).
    fn set_guidance(&mut self, edges: Vec<(u32, u32, u32)>) -> PyResult<()> {
        self.try_with(|fleet| fleet.set_guidance(&edges))
    }

    /// Lets motions begin late: probability, shortest and longest delay (us), whether plans of those
    /// who wait are repaired, seed.
    fn set_lateness(
        &mut self,
        probability: f64,
        least: Us,
        most: Us,
        repairs: bool,
        seed: u64,
    ) -> PyResult<()> {
        if !(0.0..=1.0).contains(&probability) || least < 0 || most < least {
            return Err(PyValueError::new_err("no such delays"));
        }
        let robots = self.fleet.robots.len();
        let lateness = Lateness::new(probability, (least, most), repairs, seed, robots);
        self.with(|fleet| fleet.set_lateness(lateness))
    }

    /// Draws the lateness of motions from another seed from now on.
    fn reseed_lateness(&mut self, seed: u64) -> PyResult<()> {
        self.with(|fleet| fleet.reseed_lateness(seed))
    }

    /// Lets plans of trips take time: constant (us), share of the wall time, us per search and per
    /// label, or a tape; us between batches, whether robots ask only when they could depart, and
    /// whether each robot has a planner of its own.
    #[pyo3(signature = (price, numbers, tape, period, lazy, each))]
    fn set_pace(
        &mut self,
        price: &str,
        numbers: (f64, f64),
        tape: Vec<(u32, Us, u64, Us)>,
        period: Us,
        lazy: bool,
        each: bool,
    ) -> PyResult<()> {
        let (first, second) = numbers;
        if !(first >= 0.0 && second >= 0.0 && period >= 0) {
            return Err(PyValueError::new_err("times of plans must not be negative"));
        }
        let entry = |(robot, begun, labels, took)| Entry {
            robot,
            asked: begun,
            begun,
            labels,
            took,
            found: true,
            wall: 0,
        };
        let price = match price {
            "fixed" => Price::Fixed(first.round() as Us),
            "work" => Price::Work { search: first, label: second },
            "wall" => Price::Wall(first),
            "replay" => Price::Tape(tape.into_iter().map(entry).collect()),
            other => return Err(PyValueError::new_err(format!("no price of plans {other}"))),
        };
        let planners = if each { self.fleet.robots.len() } else { 1 };
        self.with(|fleet| fleet.set_pace(Pace::new(price, period, lazy, planners)))
    }
}

/// Initial state of the robots: waypoint, index of the heading, kind.
fn placed(network: &Network, robots: &[(u32, f64, u8)]) -> Result<Vec<(u32, u8, u8)>, String> {
    let place = |&(node, angle, kind): &(u32, f64, u8)| {
        let heading = network.headings.binary_search(&from_radians(angle));
        let heading = heading.map_err(|_| format!("no heading of {angle} rad"))?;
        Ok((node, heading as u8, kind))
    };
    robots.iter().map(place).collect()
}
