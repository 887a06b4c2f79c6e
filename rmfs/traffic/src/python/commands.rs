//! Commands to robots, the passing of time, and disturbances.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::fleet::{CutOff, Event, Rest, Shift};
use crate::robot::Step;
use crate::units::{Us, from_radians};

use super::core::Core;

fn step_of((code, value): (u8, u32)) -> PyResult<Step> {
    match code {
        0 => Ok(Step::Drive(value)),
        1 => Ok(Step::Lift(value)),
        2 => Ok(Step::SetDown(value)),
        3 => Ok(Step::Station(value)),
        _ => Err(PyValueError::new_err(format!("unknown step {code}"))),
    }
}

#[pymethods]
impl Core {
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

    fn delay(&mut self, robot: u32, by: Us, begun: bool) -> PyResult<bool> {
        if by < 0 {
            return Err(PyValueError::new_err(format!("a delay of {by} us")));
        }
        let shift = if begun { Shift::Begun } else { Shift::Planned };
        self.with_robot(robot, |fleet| fleet.delay(robot, by, shift))
    }

    fn hold(&mut self, robot: u32, by: Us) -> PyResult<Option<Us>> {
        if by < 0 {
            return Err(PyValueError::new_err(format!("a stop of {by} us")));
        }
        self.with_robot(robot, |fleet| fleet.hold(robot, by))
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
}
