//! Where robots drive and stand: counts per waypoint and per edge.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::network::Network;
use crate::units::Us;

/// How often robots drove an edge or rode an elevator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Passages {
    pub all: u32,
    pub loaded: u32,
}

impl Passages {
    fn add(&mut self, loaded: bool) {
        self.all += 1;
        self.loaded += u32::from(loaded);
    }
}

/// Counts of robots of one purpose at a waypoint.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stay {
    pub purpose: u32,
    pub visits: u32,
    pub waiting: Us,
}

/// Counts since the last reset. A robot's *purpose* is the station it is bound for, storing a pod,
/// or neither.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Heat {
    /// By waypoint, the purposes that occurred, ascending: of hundreds of stations, robots pass a
    /// waypoint on the way to only a few.
    stays: Vec<Vec<Stay>>,
    /// By waypoint.
    pub loaded_visits: Vec<u32>,
    pub loaded_waiting: Vec<Us>,
    /// By waypoint and heading.
    edges: Vec<Passages>,
    rides: BTreeMap<(u32, u32), Passages>,
}

impl Heat {
    /// Empty counts.
    pub fn new(network: &Network) -> Self {
        Self {
            stays: vec![Vec::new(); network.nodes],
            loaded_visits: vec![0; network.nodes],
            loaded_waiting: vec![0; network.nodes],
            edges: vec![Passages::default(); network.nodes * network.heading_count()],
            rides: BTreeMap::new(),
        }
    }

    /// Resets all counts.
    pub fn reset(&mut self) {
        self.stays.iter_mut().for_each(Vec::clear);
        self.loaded_visits.fill(0);
        self.loaded_waiting.fill(0);
        self.edges.fill(Passages::default());
        self.rides.clear();
    }

    fn stay(&mut self, node: u32, purpose: usize) -> &mut Stay {
        let (stays, purpose) = (&mut self.stays[node as usize], purpose as u32);
        let at = stays.partition_point(|stay| stay.purpose < purpose);
        if stays.get(at).is_none_or(|stay| stay.purpose != purpose) {
            stays.insert(at, Stay { purpose, visits: 0, waiting: 0 });
        }
        &mut stays[at]
    }

    /// The counts with their waypoints, sorted by waypoint and purpose.
    pub fn stays(&self) -> impl Iterator<Item = (u32, &Stay)> {
        let rows = self.stays.iter().enumerate();
        rows.flat_map(|(node, stays)| stays.iter().map(move |stay| (node as u32, stay)))
    }

    /// Counts a robot that passed a waypoint or stopped there.
    pub fn visit(&mut self, node: u32, purpose: usize, loaded: bool) {
        self.stay(node, purpose).visits += 1;
        self.loaded_visits[node as usize] += u32::from(loaded);
    }

    /// Counts time for which a robot stood at a waypoint.
    pub fn wait(&mut self, node: u32, purpose: usize, loaded: bool, time: Us) {
        self.stay(node, purpose).waiting += time;
        if loaded {
            self.loaded_waiting[node as usize] += time;
        }
    }

    /// Counts a robot that drove the edge that leaves a waypoint in a direction.
    pub fn pass(&mut self, network: &Network, from: u32, heading: u8, loaded: bool) {
        self.edges[network.index(from, heading)].add(loaded);
    }

    /// Counts a robot that rode an elevator.
    pub fn ride(&mut self, from: u32, to: u32, loaded: bool) {
        self.rides.entry((from, to)).or_default().add(loaded);
    }

    /// Edges and rides that were used, with their two ends, ascending.
    pub fn edges(&self, network: &Network) -> Vec<(u32, u32, Passages)> {
        let mut used: Vec<_> = self.rides.iter().map(|(&(from, to), &n)| (from, to, n)).collect();
        for from in 0..network.nodes as u32 {
            for heading in 0..network.heading_count() as u8 {
                let passages = self.edges[network.index(from, heading)];
                if let Some((to, _)) = network.ahead(from, heading)
                    && passages.all > 0
                {
                    used.push((from, to, passages));
                }
            }
        }
        used.sort_by_key(|&(from, to, _)| (from, to));
        used
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_counted_is_told_by_waypoint_and_purpose() {
        let mut heat = Heat {
            stays: vec![Vec::new(); 2],
            loaded_visits: vec![0; 2],
            loaded_waiting: vec![0; 2],
            edges: Vec::new(),
            rides: BTreeMap::new(),
        };
        heat.visit(1, 2, true);
        heat.visit(1, 0, false);
        heat.visit(1, 2, false);
        heat.wait(0, 1, true, 7);
        heat.wait(1, 2, false, 5);
        let told: Vec<_> = heat.stays().map(|(v, s)| (v, s.purpose, s.visits, s.waiting)).collect();
        assert_eq!(told, [(0, 1, 0, 7), (1, 0, 1, 0), (1, 2, 2, 5)]);
        assert_eq!(
            (heat.loaded_visits.clone(), heat.loaded_waiting.clone()),
            (vec![0, 1], vec![7, 0])
        );
        heat.reset();
        assert_eq!(heat.stays().next(), None);
    }
}
