//! What the traffic reports: positions, plans, travel times, statistics and the trace.

use std::collections::HashMap;

use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::costs;
use crate::fleet::Entry;
use crate::units::{Us, to_radians};

use super::core::Core;
use super::tables;

/// A move as passed to Python.
type PlannedMove = (u32, u32, f64, Us, Us, bool);

/// Times of a table in seconds; infinite where there is no way.
fn seconds(entries: impl Iterator<Item = u32>) -> Vec<f64> {
    entries.map(|entry| costs::time(entry).map_or(f64::INFINITY, |t| t as f64 / 1e6)).collect()
}

#[pymethods]
impl Core {
    fn rest_waypoint(&self, robot: usize) -> PyResult<u32> {
        Ok(self.robot(robot)?.destination().0)
    }

    fn next_stop(&self, robot: usize) -> PyResult<u32> {
        Ok(self.robot(robot)?.next_stop(self.fleet.now))
    }

    fn blocked(&self) -> Vec<u32> {
        self.fleet.blocked()
    }

    /// The moves of a robot's plan that have not ended: from, to, heading (radians), start, end and
    /// whether it is an elevator ride.
    fn plan(&mut self, robot: u32) -> PyResult<Vec<PlannedMove>> {
        self.with_robot(robot, |fleet| fleet.settle_all())?;
        let heading = |h: u8| to_radians(self.fleet.network.headings[h as usize]);
        let moves = self.fleet.robots[robot as usize].moves.iter();
        Ok(moves.map(|m| (m.from, m.to, heading(m.heading), m.start, m.end, m.ride)).collect())
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

    /// Searches for plans of trips since time zero, if plans take time.
    fn plans<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let entries = self.fleet.pace.iter().flat_map(|pace| pace.entries.iter());
        tables::plans(py, &entries.cloned().collect::<Vec<Entry>>())
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
