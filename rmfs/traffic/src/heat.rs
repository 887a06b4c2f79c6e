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

/// Counts since the last reset. What robots drive for is one of several *purposes*: the station
/// they are bound for, storing a pod, or neither.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Heat {
    purposes: usize,
    /// By waypoint and purpose.
    pub visits: Vec<u32>,
    pub waiting: Vec<Us>,
    /// By waypoint.
    pub loaded_visits: Vec<u32>,
    pub loaded_waiting: Vec<Us>,
    /// By waypoint and heading.
    edges: Vec<Passages>,
    rides: BTreeMap<(u32, u32), Passages>,
}

impl Heat {
    /// Nothing counted yet.
    pub fn new(network: &Network) -> Self {
        let purposes = network.stations.len() + 2;
        Self {
            purposes,
            visits: vec![0; network.nodes * purposes],
            waiting: vec![0; network.nodes * purposes],
            loaded_visits: vec![0; network.nodes],
            loaded_waiting: vec![0; network.nodes],
            edges: vec![Passages::default(); network.nodes * network.heading_count()],
            rides: BTreeMap::new(),
        }
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        self.visits.fill(0);
        self.waiting.fill(0);
        self.loaded_visits.fill(0);
        self.loaded_waiting.fill(0);
        self.edges.fill(Passages::default());
        self.rides.clear();
    }

    /// A robot passed a waypoint or stopped there.
    pub fn visit(&mut self, node: u32, purpose: usize, loaded: bool) {
        self.visits[node as usize * self.purposes + purpose] += 1;
        self.loaded_visits[node as usize] += u32::from(loaded);
    }

    /// A robot stood at a waypoint.
    pub fn wait(&mut self, node: u32, purpose: usize, loaded: bool, time: Us) {
        self.waiting[node as usize * self.purposes + purpose] += time;
        if loaded {
            self.loaded_waiting[node as usize] += time;
        }
    }

    /// A robot drove the edge that leaves a waypoint in a direction.
    pub fn pass(&mut self, network: &Network, from: u32, heading: u8, loaded: bool) {
        self.edges[network.index(from, heading)].add(loaded);
    }

    /// A robot rode an elevator.
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
