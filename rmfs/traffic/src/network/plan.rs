//! The input for building the graph, and its check.

use crate::units::MicroTurn;

use super::Ride;

/// The input for building a [`Network`]: plain arrays, one entry per waypoint.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub tier: Vec<i16>,
    pub edge_start: Vec<u32>,
    pub edge_target: Vec<u32>,
    pub storage: Vec<bool>,
    pub queue: Vec<bool>,
    /// Queue places per station, head first.
    pub stations: Vec<Vec<u32>>,
    /// Waypoints of each elevator.
    pub elevators: Vec<Vec<u32>>,
    pub rides: Vec<Ride>,
    /// Headings of robots at the start, which need not be those of an edge.
    pub extra_headings: Vec<MicroTurn>,
}

impl Plan {
    /// Whether all arrays are consistent and refer to existing waypoints.
    pub(super) fn check(&self) -> Result<(), String> {
        let nodes = self.x.len();
        let lengths = [self.y.len(), self.tier.len(), self.storage.len(), self.queue.len()];
        let starts = &self.edge_start;
        let ends_well = starts.last().is_some_and(|&end| end as usize == self.edge_target.len());
        if lengths != [nodes; 4] || starts.len() != nodes + 1 || !starts.is_sorted() || !ends_well {
            return Err("the arrays of the waypoints and edges do not fit together".into());
        }
        if let Some(station) = self.stations.iter().position(Vec::is_empty) {
            return Err(format!("station {station} has no waypoint"));
        }
        if let Some(elevator) = self.elevators.iter().position(Vec::is_empty) {
            return Err(format!("elevator {elevator} has no waypoint"));
        }
        let places = self.stations.iter().chain(&self.elevators).flatten();
        let ends = self.rides.iter().flat_map(|ride| [&ride.from, &ride.to]);
        let mut named = self.edge_target.iter().chain(places).chain(ends);
        match named.find(|&&waypoint| waypoint as usize >= nodes) {
            Some(waypoint) => Err(format!("there is no waypoint {waypoint}")),
            None => Ok(()),
        }
    }
}
