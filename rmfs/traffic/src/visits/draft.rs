//! Drafts of plans: visits of the stations, and what they serve.

use super::problem::{NONE, Problem, put, take_out};

/// Visits and what they serve.
#[derive(Clone, Debug)]
pub struct Draft {
    pub at: Vec<Station>,
    /// Station of each order; open orders have theirs from the start.
    pub order_station: Vec<i32>,
    /// Visit of each line.
    pub line_visit: Vec<i32>,
    /// Lines of orders without a station, as a set.
    pub free: Vec<u64>,
}

/// The part of a plan at one station.
#[derive(Clone, Debug, Default)]
pub struct Station {
    /// Pods of new visits.
    pub pods: Vec<u32>,
    /// Worth of what is served and closed less the cost of the visits.
    pub value: f64,
    /// Units served.
    pub units: i64,
    /// Lines served, and waiting orders taken.
    pub lines: Vec<u32>,
    pub orders: Vec<u32>,
}

impl Draft {
    /// A draft of given visits that serve nothing yet.
    pub fn new(problem: &Problem, pods: &[Vec<u32>]) -> Self {
        let at = pods.iter().map(|pods| Station { pods: pods.clone(), ..Station::default() });
        Self {
            at: at.collect(),
            order_station: problem.given.order_station.clone(),
            line_visit: vec![NONE; problem.given.lines.len()],
            free: problem.waiting.clone(),
        }
    }

    /// The objective with the other sign.
    pub fn value(&self) -> f64 {
        self.at.iter().map(|station| station.value).sum()
    }

    /// The worth of some stations.
    pub fn value_of(&self, stations: &[usize]) -> f64 {
        stations.iter().map(|&station| self.at[station].value).sum()
    }

    pub fn pods(&self) -> Vec<Vec<u32>> {
        self.at.iter().map(|station| station.pods.clone()).collect()
    }

    /// Releases everything that a station serves.
    pub(super) fn release(&mut self, problem: &Problem, station: usize) {
        let at = &mut self.at[station];
        for line in at.lines.drain(..) {
            self.line_visit[line as usize] = NONE;
        }
        for order in at.orders.drain(..) {
            self.order_station[order as usize] = NONE;
            for &line in &problem.lines_of[order as usize] {
                put(&mut self.free, line);
            }
        }
    }

    /// Saves the parts of some stations, so that they can be restored.
    pub fn save(&self, stations: &[usize], saved: &mut Saved) {
        saved.stations.clear();
        saved.stations.extend_from_slice(stations);
        saved.at.resize_with(stations.len().max(saved.at.len()), Default::default);
        for (&station, (at, visits)) in stations.iter().zip(&mut saved.at) {
            at.copy(&self.at[station]);
            visits.clear();
            visits.extend(at.lines.iter().map(|&line| self.line_visit[line as usize]));
        }
    }

    /// Restores the saved parts of some stations.
    pub fn restore(&mut self, problem: &Problem, saved: &Saved) {
        for &station in &saved.stations {
            self.release(problem, station);
        }
        for (&station, (at, visits)) in saved.stations.iter().zip(&saved.at) {
            for (&line, &visit) in at.lines.iter().zip(visits) {
                self.line_visit[line as usize] = visit;
            }
            for &order in &at.orders {
                self.place(problem, order, station);
            }
            self.at[station].copy(at);
        }
    }

    /// Gives a waiting order a station.
    pub(super) fn place(&mut self, problem: &Problem, order: u32, station: usize) {
        self.order_station[order as usize] = station as i32;
        for &line in &problem.lines_of[order as usize] {
            take_out(&mut self.free, line);
        }
    }
}

impl Station {
    /// Copies another draft, normally without allocating memory.
    fn copy(&mut self, other: &Self) {
        self.pods.clone_from(&other.pods);
        self.lines.clone_from(&other.lines);
        self.orders.clone_from(&other.orders);
        (self.value, self.units) = (other.value, other.units);
    }
}

/// The saved parts of some stations, with the visit of each of their lines.
#[derive(Default)]
pub struct Saved {
    stations: Vec<usize>,
    at: Vec<(Station, Vec<i32>)>,
}

impl Saved {
    /// The worth of the stations.
    pub fn value(&self) -> f64 {
        self.stations.iter().zip(&self.at).map(|(_, (at, _))| at.value).sum()
    }

    /// The pods of their new visits.
    pub fn pods(&self) -> impl Iterator<Item = u32> {
        self.stations.iter().zip(&self.at).flat_map(|(_, (at, _))| at.pods.iter().copied())
    }
}
