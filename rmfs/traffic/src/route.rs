//! Ways in space alone: the quickest sequence of runs without other robots.
//!
//! An A* over rest states (waypoint, heading), guided by exact unhindered times, so that without
//! penalties it expands only the best way. Waypoints can be closed or made more expensive.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use crate::costs::{Model, UNREACHABLE};
use crate::kinematics::Kind;
use crate::network::Network;
use crate::search::Move;
use crate::units::Us;

/// Where a way begins and ends.
#[derive(Clone, Debug)]
pub struct Leg<'a> {
    pub start: u32,
    pub heading: u8,
    pub ready: Us,
    pub goal: u32,
    pub loaded: bool,
    pub kind: &'a Kind,
    pub model: &'a Model,
    /// Exact unhindered times to the goal, as [`crate::costs::Table`].
    pub times: &'a [u32],
}

/// A state that has been reached: cost, arrival, and how.
struct Reached {
    cost: Us,
    arrival: Us,
    from: Option<(u32, u8)>,
    departure: Us,
    ride: bool,
}

/// The quickest way without waits, where `penalty` is the additional cost, in time, of passing a
/// waypoint or stopping there (`None`: it is closed). `None` if there is no way.
pub fn route(
    network: &Network,
    leg: &Leg,
    penalty: impl Fn(u32) -> Option<Us>,
) -> Option<Vec<Move>> {
    let to_go = |node: u32, heading: u8| match leg.times[network.index(node, heading)] {
        UNREACHABLE => None,
        time => Some(Us::from(time)),
    };
    let mut reached: BTreeMap<(u32, u8), Reached> = BTreeMap::new();
    let mut open = BinaryHeap::new();
    let start = (leg.start, leg.heading);
    let first = Reached { cost: 0, arrival: leg.ready, from: None, departure: 0, ride: false };
    reached.insert(start, first);
    open.push(Reverse((to_go(leg.start, leg.heading)?, 0, start)));
    while let Some(Reverse((_, cost, state))) = open.pop() {
        let here = &reached[&state];
        if here.cost < cost {
            continue;
        }
        if state.0 == leg.goal {
            return Some(moves(&reached, state));
        }
        let arrival = here.arrival;
        let mut offer = |to: (u32, u8), dearer: Us, departure: Us, end: Us, ride: bool| {
            let cost = cost + dearer + (end - arrival);
            let Some(rest) = to_go(to.0, to.1) else { return };
            if reached.get(&to).is_none_or(|known| cost < known.cost) {
                let from = Some(state);
                reached.insert(to, Reached { cost, arrival: end, from, departure, ride });
                open.push(Reverse((cost + rest, cost, to)));
            }
        };
        for heading in 0..network.heading_count() as u8 {
            let departure = arrival + Us::from(leg.model.turning(state.1, heading));
            for (node, length, dearer) in stops(network, leg, state.0, heading, &penalty) {
                let end = departure + leg.kind.run_time(length);
                offer((node, heading), dearer, departure, end, false);
            }
        }
        for ride in network.rides_from(state.0) {
            if let Some(dearer) = penalty(ride.to) {
                offer((ride.to, state.1), dearer, arrival, arrival + ride.travel, true);
            }
        }
    }
    None
}

/// Waypoints at which a run in one direction can end, with its length and additional cost.
fn stops<'a>(
    network: &'a Network,
    leg: &'a Leg,
    from: u32,
    heading: u8,
    penalty: &'a impl Fn(u32) -> Option<Us>,
) -> impl Iterator<Item = (u32, f64, Us)> + 'a {
    let mut here = Some((from, 0.0, 0));
    std::iter::from_fn(move || {
        let (node, length, dearer) = here?;
        let (next, metres) = network.ahead(node, heading)?;
        if !network.may_enter(node, next, leg.goal, leg.loaded) {
            return None;
        }
        let stop = (next, length + metres, dearer + penalty(next)?);
        let ends = leg.loaded && network.storage[next as usize];
        here = (!ends).then_some(stop);
        Some(stop)
    })
}

fn moves(reached: &BTreeMap<(u32, u8), Reached>, end: (u32, u8)) -> Vec<Move> {
    let mut moves = Vec::new();
    let mut state = end;
    while let Some(before) = reached[&state].from {
        let Reached { arrival, departure, ride, .. } = reached[&state];
        moves.push(Move {
            from: before.0,
            to: state.0,
            heading: state.1,
            heading_before: before.1,
            start: departure,
            end: arrival,
            ride,
            late: 0,
            begun: 0,
        });
        state = before;
    }
    moves.reverse();
    moves
}
