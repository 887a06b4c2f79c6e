//! Building the graph: headings, edges seen from both ends, queue zones, islands and shafts.

use std::collections::VecDeque;

use crate::units::{MicroTurn, TURN, heading_of};

use super::{Behind, MORE, NONE, Network, Plan, Ride};

/// Maximum number of headings, which are indexed by bytes.
const MOST_HEADINGS: usize = 256;

impl Network {
    /// Builds the graph.
    ///
    /// # Errors
    /// If a waypoint has two edges in one direction.
    pub fn new(plan: Plan) -> Result<Self, String> {
        plan.check()?;
        let nodes = plan.x.len();
        let angle = |v: usize, w: usize| heading_of(plan.x[w] - plan.x[v], plan.y[w] - plan.y[v]);
        let targets = |v: usize| {
            let range = plan.edge_start[v] as usize..plan.edge_start[v + 1] as usize;
            plan.edge_target[range].iter().map(|&w| w as usize)
        };
        let mut headings = plan.extra_headings.clone();
        for v in 0..nodes {
            headings.extend(targets(v).map(|w| angle(v, w)));
        }
        headings.sort_unstable();
        headings.dedup();
        if headings.len() > MOST_HEADINGS {
            let found = headings.len();
            return Err(format!(
                "edges have {found} directions; at most {MOST_HEADINGS} are known"
            ));
        }
        let count = headings.len();
        let mut next = vec![NONE; nodes * count];
        let mut length = vec![0.0; nodes * count];
        let mut incoming: Vec<Vec<(u32, f64)>> = vec![Vec::new(); nodes * count];
        for v in 0..nodes {
            for w in targets(v) {
                let h = headings.binary_search(&angle(v, w)).expect("collected above");
                if next[v * count + h] != NONE {
                    return Err(format!("waypoint {v} has two edges in one direction"));
                }
                next[v * count + h] = w as u32;
                let metres = (plan.x[w] - plan.x[v]).hypot(plan.y[w] - plan.y[v]);
                length[v * count + h] = metres;
                incoming[w * count + h].push((v as u32, metres));
            }
        }
        let (lengths, before, more_before) = edges_behind(&incoming);
        let zone = zones(&plan, nodes);
        let island = islands(&plan, nodes);
        let axis_parallel = is_axis_parallel(&plan, &headings);
        let (columns, column) = distinct(&plan.x);
        let (rows, row) = distinct(&plan.y);
        let open = zone.iter().zip(&plan.storage).map(|(&z, &storage)| z == NONE && !storage);
        let open = open.collect();
        let (resource, resources) = shared_resources(&plan.elevators, nodes);
        let mut rides_from = vec![Vec::new(); nodes];
        let mut rides_to = vec![Vec::new(); nodes];
        for ride in plan.rides {
            rides_to[ride.to as usize].push(ride.clone());
            rides_from[ride.from as usize].push(ride);
        }
        Ok(Self {
            nodes,
            opposite: opposites(&headings),
            headings,
            next,
            length,
            before,
            more_before,
            lengths,
            storage: plan.storage,
            access: zone.clone(),
            open,
            zone,
            resource,
            resources,
            stations: plan.stations,
            largest_island: largest(&island),
            island,
            rides_from,
            rides_to,
            x: plan.x,
            y: plan.y,
            columns,
            rows,
            cells: column.into_iter().zip(row).collect(),
            axis_parallel,
        })
    }
}

fn opposites(headings: &[MicroTurn]) -> Vec<Option<u8>> {
    let back = |&heading: &MicroTurn| headings.binary_search(&((heading + TURN / 2) % TURN)).ok();
    headings.iter().map(|heading| back(heading).map(|index| index as u8)).collect()
}

/// Distinct values, ascending, and the index of each value among them.
fn distinct(values: &[f64]) -> (Vec<f64>, Vec<u32>) {
    let mut known = values.to_vec();
    known.sort_by(f64::total_cmp);
    known.dedup();
    let index = values.iter().map(|v| known.partition_point(|k| k < v) as u32).collect();
    (known, index)
}

fn is_axis_parallel(plan: &Plan, headings: &[MicroTurn]) -> bool {
    let straight_up = |ride: &Ride| {
        let (from, to) = (ride.from as usize, ride.to as usize);
        (plan.x[from] - plan.x[to]).abs() + (plan.y[from] - plan.y[to]).abs() < 1e-6
    };
    plan.rides.iter().all(straight_up) && headings.iter().all(|heading| heading % 250_000 == 0)
}

/// Returns the distinct lengths of edges, the first edge of each list, and the others with the
/// index of their list.
fn edges_behind(lists: &[Vec<(u32, f64)>]) -> (Vec<f64>, Vec<Behind>, Vec<(u32, Behind)>) {
    let all: Vec<f64> = lists.iter().flatten().map(|edge| edge.1).collect();
    let (lengths, which) = distinct(&all);
    let mut which = which.into_iter();
    let mut firsts = Vec::with_capacity(lists.len());
    let mut others = Vec::new();
    for (index, list) in lists.iter().enumerate() {
        let edges = list.iter().zip(&mut which);
        let mut edges = edges.map(|(&(from, _), length)| Behind { from, length });
        let mut first = edges.next().unwrap_or(Behind { from: NONE, length: 0 });
        others.extend(edges.map(|edge| (index as u32, edge)));
        if list.len() > 1 {
            first.length |= MORE;
        }
        firsts.push(first);
    }
    (lengths, firsts, others)
}

/// Assigns each queue waypoint to the station whose queue list is nearest over queue edges.
fn zones(plan: &Plan, nodes: usize) -> Vec<u32> {
    let mut neighbours = vec![Vec::new(); nodes];
    for v in 0..nodes {
        for &w in &plan.edge_target[plan.edge_start[v] as usize..plan.edge_start[v + 1] as usize] {
            if plan.queue[v] && plan.queue[w as usize] {
                neighbours[v].push(w);
                neighbours[w as usize].push(v as u32);
            }
        }
    }
    let mut zone = vec![NONE; nodes];
    let mut shared = vec![false; nodes];
    for elevator in &plan.elevators {
        // an elevator's access is for everybody
        let mut open: Vec<u32> = elevator.clone();
        while let Some(v) = open.pop() {
            if plan.queue[v as usize] && !std::mem::replace(&mut shared[v as usize], true) {
                open.extend_from_slice(&neighbours[v as usize]);
            }
        }
    }
    let mut front: VecDeque<u32> = VecDeque::new();
    for (station, places) in plan.stations.iter().enumerate() {
        for &v in places {
            if plan.queue[v as usize] && !shared[v as usize] && zone[v as usize] == NONE {
                zone[v as usize] = station as u32;
                front.push_back(v);
            }
        }
    }
    while let Some(v) = front.pop_front() {
        for &w in &neighbours[v as usize] {
            if zone[w as usize] == NONE {
                zone[w as usize] = zone[v as usize];
                front.push_back(w);
            }
        }
    }
    zone
}

/// Connected parts of the graph without elevators, each named by its first waypoint.
fn islands(plan: &Plan, nodes: usize) -> Vec<u32> {
    let mut neighbours = vec![Vec::new(); nodes];
    for v in 0..nodes {
        for &w in &plan.edge_target[plan.edge_start[v] as usize..plan.edge_start[v + 1] as usize] {
            neighbours[v].push(w);
            neighbours[w as usize].push(v as u32);
        }
    }
    let mut island = vec![NONE; nodes];
    for first in 0..nodes as u32 {
        let mut open = vec![first];
        while let Some(v) = open.pop() {
            if island[v as usize] == NONE {
                island[v as usize] = first;
                open.extend_from_slice(&neighbours[v as usize]);
            }
        }
    }
    island
}

/// Returns the number of waypoints of the largest island, given the island of each waypoint.
fn largest(island: &[u32]) -> usize {
    let mut sizes = vec![0; island.len()];
    for &first in island {
        sizes[first as usize] += 1;
    }
    sizes.into_iter().max().unwrap_or(0)
}

/// All waypoints of an elevator are one resource: its shaft holds one robot.
fn shared_resources(elevators: &[Vec<u32>], nodes: usize) -> (Vec<u32>, usize) {
    let mut resource: Vec<u32> = (0..nodes as u32).collect();
    for waypoints in elevators {
        for &v in waypoints {
            resource[v as usize] = waypoints[0];
        }
    }
    (resource, nodes)
}
