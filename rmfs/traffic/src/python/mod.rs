//! The Python interface of the crate: arrays in, arrays and events out.

mod guard;
mod matching;
mod motion;
mod planner;
mod ranking;
mod sequences;
mod tables;
mod visits;

use std::collections::HashMap;

use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::costs;
use crate::energy::{Battery, Energy, Model, Spent};
use crate::fleet::{CutOff, Entry, Event, Fleet, Lateness, Pace, Price, Rest, Shift};
use crate::kinematics::Kind;
use crate::network::{Network, Plan, Ride};
use crate::planner::{Planner, Rhythm, Settings, build};
use crate::robot::Step;
use crate::units::{Us, from_radians, to_radians};

use guard::{guarded, internal_error, replay_error};
use motion::Motion;
use planner::{Along, Conflict, Fault, PlannerInPython, Reserved, Search, Way};
use sequences::Sequences;
use visits::Visits;

/// A kind of robot as passed by Python: acceleration, deceleration, top speed, full turn (µs),
/// pod transfer (µs).
type KindTuple = (f64, f64, f64, Us, Us);

/// A move as passed to Python.
type PlannedMove = (u32, u32, f64, Us, Us, bool);

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

fn step_of((code, value): (u8, u32)) -> PyResult<Step> {
    match code {
        0 => Ok(Step::Drive(value)),
        1 => Ok(Step::Lift(value)),
        2 => Ok(Step::SetDown(value)),
        3 => Ok(Step::Station(value)),
        _ => Err(PyValueError::new_err(format!("unknown step {code}"))),
    }
}

/// The traffic of one warehouse.
#[pyclass]
struct Core {
    fleet: Fleet,
    /// How often a planner written in Python is called, if there is one, and the error it has
    /// raised.
    in_python: Option<Rhythm>,
    fault: Fault,
    /// An earlier defect or interrupt, if any, after which the state of the fleet is undefined.
    defect: Option<String>,
}

impl Core {
    fn over(fleet: Fleet, in_python: Option<Rhythm>, fault: Fault) -> Self {
        Self { fleet, in_python, fault, defect: None }
    }

    /// Runs a function on the fleet.
    fn with<T>(&mut self, work: impl FnOnce(&mut Fleet) -> T) -> PyResult<T> {
        if let Some(said) = &self.defect {
            return Err(internal_error(said));
        }
        guarded(|| work(&mut self.fleet)).map_err(|failure| {
            self.defect = Some(failure.said());
            failure.into()
        })
    }

    /// Runs a function that can return an error.
    fn try_with<T>(&mut self, work: impl FnOnce(&mut Fleet) -> Result<T, String>) -> PyResult<T> {
        self.with(work)?.map_err(PyValueError::new_err)
    }

    /// Runs a function for one robot.
    fn with_robot<T>(&mut self, robot: u32, work: impl FnOnce(&mut Fleet) -> T) -> PyResult<T> {
        self.robot(robot as usize)?;
        self.with(work)
    }

    fn robot(&self, robot: usize) -> PyResult<&crate::robot::Robot> {
        let missing = || PyValueError::new_err(format!("no robot {robot}"));
        self.fleet.robots.get(robot).ok_or_else(missing)
    }

    /// Raises an error if the run is not that of the tape of plans.
    fn check_tape(&self) -> PyResult<()> {
        let fault = self.fleet.pace.as_ref().and_then(|pace| pace.fault.as_ref());
        fault.map_or(Ok(()), |told| Err(replay_error(told)))
    }

    fn check_place(&self, waypoint: u32, kind: u8) -> PyResult<()> {
        if waypoint as usize >= self.fleet.network.nodes {
            return Err(PyValueError::new_err(format!("no waypoint {waypoint}")));
        }
        if kind as usize >= self.fleet.kinds.len() {
            return Err(PyValueError::new_err(format!("no kind {kind}")));
        }
        Ok(())
    }
}

fn no_energy() -> PyErr {
    PyValueError::new_err("energy is not counted")
}

/// Times of a table in seconds; infinite where there is no way.
fn seconds(entries: impl Iterator<Item = u32>) -> Vec<f64> {
    entries.map(|entry| costs::time(entry).map_or(f64::INFINITY, |t| t as f64 / 1e6)).collect()
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

    /// Lets the planner prefer ways by extra costs of edges (from, to, microseconds).
    fn set_guidance(&mut self, edges: Vec<(u32, u32, u32)>) -> PyResult<()> {
        self.try_with(|fleet| fleet.set_guidance(&edges))
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

    fn command(&mut self, robot: u32, program: Vec<(u8, u32)>) -> PyResult<()> {
        self.robot(robot as usize)?;
        let steps = program.into_iter().map(step_of).collect::<PyResult<Vec<Step>>>()?;
        self.try_with(|fleet| fleet.command(robot, &steps))?;
        self.check_tape()
    }

    #[pyo3(signature = (until, ignored=0))]
    fn advance(
        &mut self,
        py: Python<'_>,
        until: Us,
        ignored: u32,
    ) -> PyResult<Vec<(Us, i64, u32, u32)>> {
        let events = py.detach(|| self.with(|fleet| fleet.advance(until, ignored)))?;
        if let Some(error) = self.fault.lock().ok().and_then(|mut fault| fault.take()) {
            return Err(error);
        }
        self.check_tape()?;
        let plain = |event: Event| (event.time, event.kind as i64, event.robot, event.value);
        Ok(events.into_iter().map(plain).collect())
    }

    fn rest_waypoint(&self, robot: usize) -> PyResult<u32> {
        Ok(self.robot(robot)?.destination().0)
    }

    fn next_stop(&self, robot: usize) -> PyResult<u32> {
        Ok(self.robot(robot)?.next_stop(self.fleet.now))
    }

    fn blocked(&self) -> Vec<u32> {
        self.fleet.blocked()
    }

    fn travel_times_to<'py>(
        &mut self,
        py: Python<'py>,
        waypoint: u32,
        kind: u8,
        loaded: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.check_place(waypoint, kind)?;
        let times = self.with(|fleet| {
            let count = fleet.network.heading_count();
            let table = fleet.costs.towards(&fleet.network, waypoint, kind, loaded);
            let best = |headings: &[u32]| headings.iter().copied().min();
            seconds(table.chunks(count).map(|at| best(at).unwrap_or(costs::UNREACHABLE)))
        })?;
        Ok(times.into_pyarray(py).into_any())
    }

    fn travel_times_from<'py>(
        &mut self,
        py: Python<'py>,
        waypoint: u32,
        kind: u8,
        loaded: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.check_place(waypoint, kind)?;
        let times = self.with(|fleet| {
            let times = fleet.costs.away_from(&fleet.network, waypoint, kind, loaded);
            seconds(times.into_iter())
        })?;
        Ok(times.into_pyarray(py).into_any())
    }

    /// Totals per robot since the last reset, at the current time.
    fn motion<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::motion(py, &self.with(|fleet| fleet.totals())?)
    }

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

    /// Visits and standing time since the last reset.
    fn heat<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.with(|fleet| {
            fleet.settle_all();
            tables::heat(py, &fleet.record.heat)
        })?
    }

    /// Edges and elevator rides used since the last reset.
    fn edges<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.with(|fleet| fleet.settle_all())?;
        tables::edges(py, &self.fleet.record.heat.edges(&self.fleet.network))
    }

    /// Trips finished since the last reset.
    fn trips<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        tables::trips(py, &self.fleet.record.trips)
    }

    /// The trace up to now without the rows already known, sorted by robot and time, and the number
    /// of rows to pass in the next call.
    fn trace<'py>(
        &mut self,
        py: Python<'py>,
        known: usize,
    ) -> PyResult<(Bound<'py, PyDict>, usize)> {
        let not_recorded = || "the trace is not recorded".to_owned();
        let (rows, count) = self.try_with(|fleet| fleet.trace(known).ok_or_else(not_recorded))?;
        Ok((tables::trace(py, &self.fleet.network, &rows)?, count))
    }

    fn counters(&self) -> HashMap<&'static str, u64> {
        let fleet = &self.fleet;
        HashMap::from([
            ("plans", fleet.counters.plans),
            ("plan_failures", fleet.counters.failures),
            ("replans", fleet.counters.replans),
            ("refusals", fleet.counters.refusals),
            ("improvements", fleet.counters.improvements),
            ("motions", fleet.counters.motions),
            ("late_motions", fleet.counters.late_motions),
            ("lateness_us", fleet.counters.lateness),
            ("repairs", fleet.counters.repairs),
            ("charged_us", fleet.counters.charged),
            ("expansions", fleet.pathfinder.expansions),
            ("cost_tables", fleet.costs.computed),
            ("planning_ns", fleet.counters.planning.as_nanos() as u64),
        ])
    }

    /// Wall time of each call of the planner since the last reset, in nanoseconds.
    fn call_times<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        let calls: Vec<u64> = self.fleet.counters.calls.iter().copied().collect();
        calls.into_pyarray(py).into_any()
    }

    /// The moves of a robot's plan that have not ended: from, to, heading (radians), start, end and
    /// whether it is an elevator ride.
    fn plan(&mut self, robot: u32) -> PyResult<Vec<PlannedMove>> {
        self.with_robot(robot, |fleet| fleet.settle_all())?;
        let heading = |h: u8| to_radians(self.fleet.network.headings[h as usize]);
        let moves = self.fleet.robots[robot as usize].moves.iter();
        Ok(moves.map(|m| (m.from, m.to, heading(m.heading), m.start, m.end, m.ride)).collect())
    }

    fn delay(&mut self, robot: u32, by: Us, begun: bool) -> PyResult<bool> {
        if by < 0 {
            return Err(PyValueError::new_err(format!("a delay of {by} us")));
        }
        let shift = if begun { Shift::Begun } else { Shift::Planned };
        self.with_robot(robot, |fleet| fleet.delay(robot, by, shift))
    }

    fn clearance(&mut self, robot: u32) -> PyResult<Vec<u32>> {
        self.with_robot(robot, |fleet| fleet.clearance(robot))
    }

    /// Puts robots at rest at `(waypoint, heading in radians, time)` and plans anew.
    fn regroup(&mut self, rests: Vec<Option<(u32, f64, Us)>>) -> PyResult<()> {
        let headings = &self.fleet.network.headings;
        let rest = |given: &Option<(u32, f64, Us)>| {
            let Some((waypoint, angle, time)) = *given else { return Ok(None) };
            let heading = headings.binary_search(&from_radians(angle)).map_err(|_| {
                PyValueError::new_err(format!("no edge has the heading {angle} rad"))
            })?;
            Ok(Some(Rest { waypoint, heading: heading as u8, time }))
        };
        let rests = rests.iter().map(rest).collect::<PyResult<Vec<Option<Rest>>>>()?;
        self.try_with(|fleet| fleet.regroup(&rests))
    }

    fn hold(&mut self, robot: u32, by: Us) -> PyResult<Option<Us>> {
        if by < 0 {
            return Err(PyValueError::new_err(format!("a stop of {by} us")));
        }
        self.with_robot(robot, |fleet| fleet.hold(robot, by))
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

    /// Searches for plans of trips since time zero, if plans take time.
    fn plans<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let entries = self.fleet.pace.iter().flat_map(|pace| pace.entries.iter());
        tables::plans(py, &entries.cloned().collect::<Vec<Entry>>())
    }

    fn change_kind(&mut self, robot: u32, kind: u8) -> PyResult<bool> {
        self.check_place(0, kind)?;
        self.with_robot(robot, |fleet| fleet.change_kind(robot, kind))
    }

    fn close(&mut self, waypoints: Vec<u32>) -> PyResult<Vec<u32>> {
        self.try_with(|fleet| fleet.close(&waypoints))
    }

    fn reopen(&mut self, waypoints: Vec<u32>) -> PyResult<()> {
        self.try_with(|fleet| fleet.reopen(&waypoints))
    }

    /// Storage places and stations that cannot be served because of closed waypoints.
    fn cut_off(&mut self) -> PyResult<(Vec<u32>, Vec<u32>)> {
        let CutOff { storage, stations } = self.with(|fleet| fleet.cut_off())?;
        Ok((storage, stations))
    }

    fn reset_statistics(&mut self) -> PyResult<()> {
        self.with(|fleet| fleet.reset_statistics())
    }

    /// One line per robot, for reports on traffic that stands still.
    fn state_report(&self) -> String {
        let lines = self.fleet.robots.iter().enumerate().map(|(id, robot)| {
            let (to, _, end) = robot.destination();
            format!("robot {id}: {:?} at waypoint {}, plan ends at {to} at {:.3} s, program {:?}, queue place {:?}", robot.phase, robot.anchor, end as f64 / 1e6, robot.program, robot.place)
        });
        lines.collect::<Vec<_>>().join("\n")
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
