//! Planners written in Python: rolling planners that put questions to the core, one at a time.
//!
//! `plan` of a Python planner is a generator. It yields the questions below, receives the answers,
//! and returns its proposals. The core therefore hands out no references to its state, and the
//! proposals, like those of all rolling planners, are granted only as far as they are free.

use std::sync::{Arc, Mutex};

use pyo3::exceptions::{PyStopIteration, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::planner::{Agent, Answer, Planner, Resumable, Rhythm, Scene, conflicts, rolling};
use crate::reservations::Table;
use crate::search::{End, Move};
use crate::units::{Us, to_radians};

/// The first error that a planner has raised, until it is taken.
pub type Fault = Arc<Mutex<Option<PyErr>>>;

/// A way of one agent: straight runs and rides from the point from which it can choose.
#[pyclass(frozen, module = "rmfs.traffic._core")]
pub struct Way {
    #[pyo3(get)]
    agent: usize,
    /// Where it ends, and when.
    #[pyo3(get)]
    waypoint: u32,
    #[pyo3(get)]
    end_us: Us,
    /// When the agent would reach its goal if the rest of its way were unhindered.
    #[pyo3(get)]
    total_us: Us,
    moves: Vec<Move>,
    headings: Arc<Vec<f64>>,
}

#[pymethods]
impl Way {
    /// Its moves: from, to, heading (radians), start, end, whether a ride.
    fn moves(&self) -> Vec<(u32, u32, f64, Us, Us, bool)> {
        let heading = |step: &Move| self.headings[step.heading as usize];
        self.moves.iter().map(|m| (m.from, m.to, heading(m), m.start, m.end, m.ride)).collect()
    }
}

/// Asks for the best way of an agent around what is granted and around ways of others.
#[pyclass(frozen, module = "rmfs.traffic._core")]
pub struct Search {
    agent: usize,
    around: Vec<Py<Way>>,
    until_us: Option<Us>,
    labels: u64,
}

#[pymethods]
impl Search {
    #[new]
    #[pyo3(signature = (agent, around = Vec::new(), until_us = None, labels = 2_000))]
    fn new(agent: usize, around: Vec<Py<Way>>, until_us: Option<Us>, labels: u64) -> Self {
        Self { agent, around, until_us, labels }
    }
}

/// Asks for the way over given stops, as early as possible, ignoring other robots.
#[pyclass(frozen, module = "rmfs.traffic._core")]
pub struct Along {
    agent: usize,
    stops: Vec<u32>,
    ready_us: Option<Us>,
}

#[pymethods]
impl Along {
    #[new]
    #[pyo3(signature = (agent, stops, ready_us = None))]
    fn new(agent: usize, stops: Vec<u32>, ready_us: Option<Us>) -> Self {
        Self { agent, stops, ready_us }
    }
}

/// Asks where and when two ways meet first.
#[pyclass(frozen, module = "rmfs.traffic._core")]
pub struct Conflict {
    ways: Vec<Py<Way>>,
    until_us: Us,
}

#[pymethods]
impl Conflict {
    #[new]
    #[pyo3(signature = (ways, until_us = 0))]
    fn new(ways: Vec<Py<Way>>, until_us: Us) -> Self {
        Self { ways, until_us }
    }
}

/// Asks for the granted reservations of a waypoint.
#[pyclass(frozen, module = "rmfs.traffic._core")]
pub struct Reserved {
    waypoint: u32,
}

#[pymethods]
impl Reserved {
    #[new]
    fn new(waypoint: u32) -> Self {
        Self { waypoint }
    }
}

/// The adapter.
#[derive(Debug)]
pub struct PlannerInPython {
    rhythm: Rhythm,
    planner: Py<PyAny>,
    table: Table,
    fault: Fault,
}

impl PlannerInPython {
    pub fn new(planner: Py<PyAny>, rhythm: Rhythm, resources: usize, fault: Fault) -> Self {
        Self { rhythm, planner, table: Table::new(resources), fault }
    }
}

/// Its state is that of its Python object, which [`super::Core`] copies and saves.
impl Resumable for PlannerInPython {
    fn boxed(&self) -> Box<dyn Planner> {
        let planner = Python::attach(|py| self.planner.clone_ref(py));
        let (table, fault) = (self.table.clone(), Arc::clone(&self.fault));
        Box::new(Self { rhythm: self.rhythm, planner, table, fault })
    }

    fn remembered(&self) -> Result<Vec<u8>, String> {
        Ok(Vec::new())
    }

    fn remember(&mut self, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}

impl Planner for PlannerInPython {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        rolling::block(scene, agents, &mut self.table);
        let fault = Arc::clone(&self.fault);
        let Ok(mut fault) = fault.lock() else { return vec![Answer::Keep; agents.len()] };
        let nothing = || vec![Answer::Keep; agents.len()];
        if fault.is_some() || agents.is_empty() {
            return nothing();
        }
        let times = rolling::times(scene, agents);
        let degrees = scene.network.headings.iter().map(|&heading| to_radians(heading));
        let headings = Arc::new(degrees.collect());
        let table = &mut self.table;
        let mut desk = Desk { scene, agents, times: &times, table, headings };
        Python::attach(|py| desk.consult(self.planner.bind(py))).unwrap_or_else(|error| {
            *fault = Some(error);
            nothing()
        })
    }
}

/// Answers the questions of one call.
struct Desk<'s, 'n> {
    scene: &'s mut Scene<'n>,
    agents: &'s [Agent],
    times: &'s [Arc<[u32]>],
    table: &'s mut Table,
    headings: Arc<Vec<f64>>,
}

impl Desk<'_, '_> {
    fn consult(&mut self, planner: &Bound<'_, PyAny>) -> PyResult<Vec<Answer>> {
        let py = planner.py();
        let agents: Vec<_> = self
            .agents
            .iter()
            .zip(self.times)
            .map(|(agent, times)| {
                let to_go = crate::costs::time(rolling::to_go(self.scene, agent, times));
                let Agent { robot, start, heading, ready, goal, loaded, needs_plan, .. } = *agent;
                let angle = self.headings[heading as usize];
                (robot, start, angle, ready, goal, loaded, needs_plan, to_go)
            })
            .collect();
        let talk = planner.call_method1("begin", (self.scene.now, agents))?;
        let mut reply = py.None();
        loop {
            match talk.call_method1("send", (reply,)) {
                Ok(question) => reply = self.answer(&question)?,
                Err(end) if end.is_instance_of::<PyStopIteration>(py) => {
                    return self.wishes(&end.value(py).getattr("value")?);
                }
                Err(error) => return Err(error),
            }
        }
    }

    fn answer(&mut self, question: &Bound<'_, PyAny>) -> PyResult<Py<PyAny>> {
        let py = question.py();
        if let Ok(search) = question.cast::<Search>() {
            let found = self.search(py, search.get())?;
            return Ok(found.into_pyobject(py)?.unbind());
        }
        if let Ok(along) = question.cast::<Along>() {
            let way = self.along(along.get())?;
            return Ok(Py::new(py, way)?.into_any());
        }
        if let Ok(conflict) = question.cast::<Conflict>() {
            return self.conflict(py, conflict.get());
        }
        if let Ok(reserved) = question.cast::<Reserved>() {
            return self.reserved(py, reserved.get().waypoint);
        }
        Err(PyTypeError::new_err(format!(
            "a planner yields Search, Along, Conflict or Reserved (given: {question})"
        )))
    }

    fn agent(&self, index: usize) -> PyResult<&Agent> {
        let known = self.agents.len();
        let missing = || PyValueError::new_err(format!("no agent {index}: there are {known}"));
        self.agents.get(index).ok_or_else(missing)
    }

    fn search(&mut self, py: Python<'_>, search: &Search) -> PyResult<Option<Py<Way>>> {
        let agent = self.agent(search.agent)?.clone();
        let times = &self.times[search.agent];
        let end = search.until_us.map_or(End::Arrival, End::Window);
        let until = search.until_us.unwrap_or(0);
        let mut held = Vec::new();
        for way in &search.around {
            let way = way.get();
            held.extend(rolling::occupied(self.scene, self.agent(way.agent)?, &way.moves, until));
        }
        let before = rolling::overlay(self.table, &held);
        let (ready, labels) = (agent.ready, search.labels);
        let found = rolling::search(self.scene, self.table, &agent, ready, times, end, labels);
        rolling::restore(self.table, before);
        found.map(|moves| Py::new(py, self.way(search.agent, moves, until))).transpose()
    }

    fn along(&self, along: &Along) -> PyResult<Way> {
        let agent = self.agent(along.agent)?;
        let network = self.scene.network;
        let kind = &self.scene.kinds[agent.kind as usize];
        let model = &self.scene.costs.models[agent.kind as usize];
        let (mut from, mut before) = (agent.start, agent.heading);
        let mut time = along.ready_us.unwrap_or(agent.ready).max(agent.ready);
        let mut moves: Vec<Move> = Vec::new();
        for &to in &along.stops {
            let ride = network.rides_from(from).find(|ride| ride.to == to);
            let (heading, start, end) = match ride {
                Some(ride) => (before, time, time + ride.travel),
                None => {
                    let (heading, length) = self.straight(agent, from, to)?;
                    let start = time + Us::from(model.turning(before, heading));
                    (heading, start, start + kind.run_time(length))
                }
            };
            moves.push(Move {
                from,
                to,
                heading,
                heading_before: before,
                start,
                end,
                ride: ride.is_some(),
                late: 0,
                begun: 0,
            });
            (from, before, time) = (to, heading, end);
        }
        Ok(self.way(along.agent, moves, 0))
    }

    /// Heading and length of the straight run between two waypoints that the agent may do.
    fn straight(&self, agent: &Agent, from: u32, to: u32) -> PyResult<(u8, f64)> {
        let network = self.scene.network;
        for heading in 0..network.heading_count() as u8 {
            let (mut here, mut length) = (from, 0.0);
            while let Some((next, metres)) = network.ahead(here, heading) {
                if !network.may_enter(here, next, agent.goal, agent.loaded) {
                    break;
                }
                (here, length) = (next, length + metres);
                if here == to {
                    return Ok((heading, length));
                }
            }
        }
        let robot = agent.robot;
        Err(PyValueError::new_err(format!("no straight run of robot {robot} from {from} to {to}")))
    }

    fn way(&self, index: usize, moves: Vec<Move>, until: Us) -> Way {
        let agent = &self.agents[index];
        let (waypoint, heading, end) =
            moves.last().map_or((agent.start, agent.heading, agent.ready), |last| {
                (last.to, last.heading, last.end)
            });
        let left = self.times[index][self.scene.network.index(waypoint, heading)];
        let waits = if waypoint == agent.goal { end } else { end.max(until) };
        let total_us = crate::costs::time(left).map_or(Us::MAX, |left| waits + left);
        let headings = Arc::clone(&self.headings);
        Way { agent: index, waypoint, end_us: end, total_us, moves, headings }
    }

    fn conflict(&self, py: Python<'_>, conflict: &Conflict) -> PyResult<Py<PyAny>> {
        let mut held = Vec::new();
        for way in &conflict.ways {
            let way = way.get();
            let agent = self.agent(way.agent)?;
            held.push(rolling::occupied(self.scene, agent, &way.moves, conflict.until_us));
        }
        let first = conflicts::first(held.iter().map(Vec::as_slice));
        let found = first.map(|at| (at.agents[0], at.agents[1], at.resource, at.start, at.end));
        Ok(found.into_pyobject(py)?.unbind())
    }

    fn reserved(&self, py: Python<'_>, waypoint: u32) -> PyResult<Py<PyAny>> {
        let resource = self.scene.network.resource.get(waypoint as usize);
        let missing = || PyValueError::new_err(format!("no waypoint {waypoint}"));
        let row = self.table.row(*resource.ok_or_else(missing)?);
        let rows = row.iter().map(|taken| (taken.start, taken.end, taken.robot));
        Ok(PyList::new(py, rows)?.into_any().unbind())
    }

    /// What the planner returns: a way or None for each agent.
    fn wishes(&self, returned: &Bound<'_, PyAny>) -> PyResult<Vec<Answer>> {
        let ways: Vec<Option<Py<Way>>> = returned.extract()?;
        if ways.len() != self.agents.len() {
            let (given, wanted) = (ways.len(), self.agents.len());
            return Err(PyValueError::new_err(format!("{given} ways for {wanted} agents")));
        }
        let wish = |(index, way): (usize, Option<Py<Way>>)| {
            let Some(way) = way else { return Ok(Answer::NoWay) };
            let way = way.get();
            if way.agent != index {
                let other = way.agent;
                return Err(PyValueError::new_err(format!("agent {index} gets a way of {other}")));
            }
            let mut moves = way.moves.clone();
            let agent = &self.agents[index];
            let times = &self.times[index];
            rolling::append_rest(self.scene, agent, &mut moves, way.end_us, times);
            Ok(Answer::Way(moves))
        };
        ways.into_iter().enumerate().map(wish).collect()
    }
}
