//! What is recorded of motion, as tables for Python: names and columns.

use numpy::{Element, IntoPyArray};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::energy::{Energy, Spent};
use crate::fleet::Entry;
use crate::heat::{Heat, Passages};
use crate::log::Log;
use crate::network::Network;
use crate::record::{Row, Totals, Trip};
use crate::units::{Us, to_radians};

type Table<'py> = PyResult<Bound<'py, PyDict>>;

/// A table of which every column is taken from the same rows.
struct Columns<'py, 'a, R> {
    rows: &'a [R],
    dict: Bound<'py, PyDict>,
}

impl<'py, 'a, R> Columns<'py, 'a, R> {
    fn of(py: Python<'py>, rows: &'a [R]) -> Self {
        Self { rows, dict: PyDict::new(py) }
    }

    fn column<T: Element>(self, name: &str, entry: impl Fn(&R) -> T) -> PyResult<Self> {
        let values: Vec<T> = self.rows.iter().map(entry).collect();
        self.dict.set_item(name, values.into_pyarray(self.dict.py()))?;
        Ok(self)
    }
}

fn seconds(time: Us) -> f64 {
    time as f64 / 1e6
}

/// Totals, a row per robot.
pub(super) fn motion<'py>(py: Python<'py>, totals: &[Totals]) -> Table<'py> {
    let columns = Columns::of(py, totals)
        .column("distance_m", |t| t.distance)?
        .column("loaded_distance_m", |t| t.loaded_distance)?
        .column("moving_s", |t| seconds(t.moving))?
        .column("turning_s", |t| seconds(t.turning))?
        .column("waiting_s", |t| seconds(t.waiting))?
        .column("served_s", |t| seconds(t.served))?
        .column("idle_s", |t| seconds(t.idle))?
        .column("transfer_s", |t| seconds(t.transferring))?
        .column("riding_s", |t| seconds(t.riding))?
        .column("queueing_s", |t| seconds(t.queueing))?
        .column("awaiting_plan_s", |t| seconds(t.awaiting))?;
    Ok(columns.dict)
}

/// Energy, a row per robot: since the last reset, and since time zero.
pub(super) fn energy<'py>(py: Python<'py>, energy: &Energy, spent: &[Spent]) -> Table<'py> {
    let model = &energy.model;
    let rows: Vec<(u32, Spent, &Spent)> = (0..)
        .zip(spent)
        .map(|(robot, now)| (robot, energy.since_reset(robot as usize, now), now))
        .collect();
    let columns = Columns::of(py, &rows)
        .column("drive_j", |row| row.1.drive)?
        .column("turn_j", |row| row.1.turn)?
        .column("lift_j", |row| row.1.lift)?
        .column("recuperated_j", |row| row.1.recuperated)?
        .column("standby_j", |row| row.1.standby(model))?
        .column("used_j", |row| row.1.used(model))?
        .column("charged_j", |row| row.1.charged)?
        .column("charging_s", |row| seconds(row.1.charging))?
        .column("initial_j", |row| energy.initial[row.0 as usize])?
        .column("ever_used_j", |row| row.2.used(model))?
        .column("ever_charged_j", |row| row.2.charged)?
        .column("level_j", |row| energy.level_of(row.0, row.2))?;
    Ok(columns.dict)
}

/// Visits and standing time: per waypoint, and per waypoint and purpose (each station, then storing
/// pods, then neither), the latter row by row in one dimension.
pub(super) fn heat<'py>(py: Python<'py>, heat: &Heat) -> Table<'py> {
    let rows: Vec<_> = heat.stays().collect();
    let columns = Columns::of(py, &rows)
        .column("stays_waypoint", |(waypoint, _)| *waypoint)?
        .column("stays_purpose", |(_, stay)| stay.purpose)?
        .column("stays_visits", |(_, stay)| stay.visits)?
        .column("stays_waiting_s", |(_, stay)| seconds(stay.waiting))?;
    let dict = columns.dict;
    let in_seconds = |times: &[Us]| times.iter().map(|&t| seconds(t)).collect::<Vec<f64>>();
    dict.set_item("loaded_visits", heat.loaded_visits.clone().into_pyarray(py))?;
    dict.set_item("loaded_waiting_s", in_seconds(&heat.loaded_waiting).into_pyarray(py))?;
    Ok(dict)
}

/// Edges and elevator rides used.
pub(super) fn edges<'py>(py: Python<'py>, edges: &[(u32, u32, Passages)]) -> Table<'py> {
    let columns = Columns::of(py, edges)
        .column("from_wp", |edge| edge.0)?
        .column("to_wp", |edge| edge.1)?
        .column("passages", |edge| edge.2.all)?
        .column("loaded_passages", |edge| edge.2.loaded)?;
    Ok(columns.dict)
}

/// Trips finished.
pub(super) fn trips<'py>(py: Python<'py>, trips: &Log<Trip>) -> Table<'py> {
    let rows: Vec<&Trip> = trips.iter().collect();
    let columns = Columns::of(py, &rows)
        .column("robot", |trip| trip.robot)?
        .column("kind", |trip| trip.kind as i8)?
        .column("t0_us", |trip| trip.start)?
        .column("t1_us", |trip| trip.end)?
        .column("from_wp", |trip| trip.from)?
        .column("to_wp", |trip| trip.to)?
        .column("loaded", |trip| trip.loaded)?
        .column("distance_m", |trip| trip.distance)?
        .column("unhindered_s", |trip| seconds(trip.unhindered))?
        .column("energy_j", |trip| trip.energy)?
        .column("awaited_s", |trip| seconds(trip.awaited))?;
    Ok(columns.dict)
}

/// Searches for plans of trips, and the time that they took.
pub(super) fn plans<'py>(py: Python<'py>, entries: &[Entry]) -> Table<'py> {
    let columns = Columns::of(py, entries)
        .column("robot", |entry| entry.robot)?
        .column("asked_us", |entry| entry.asked)?
        .column("begun_us", |entry| entry.begun)?
        .column("labels", |entry| entry.labels)?
        .column("took_us", |entry| entry.took)?
        .column("found", |entry| entry.found)?
        .column("wall_s", |entry| entry.wall as f64 / 1e9)?;
    Ok(columns.dict)
}

/// Pieces of motion.
pub(super) fn trace<'py>(py: Python<'py>, network: &Network, rows: &[Row]) -> Table<'py> {
    let heading = |h: u8| to_radians(network.headings[h as usize]);
    let columns = Columns::of(py, rows)
        .column("robot", |row| row.robot as i32)?
        .column("t0_us", |row| row.start)?
        .column("t1_us", |row| row.end)?
        .column("kind", |row| row.piece as i8)?
        .column("from_wp", |row| row.from as i32)?
        .column("to_wp", |row| row.to as i32)?
        .column("heading0_rad", |row| heading(row.heading_before))?
        .column("heading1_rad", |row| heading(row.heading))?
        .column("pod", |row| row.pod)?
        .column("top_speed_m_s", |row| row.top_speed)?;
    Ok(columns.dict)
}
