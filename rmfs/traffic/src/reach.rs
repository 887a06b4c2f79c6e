//! Where a pod can be carried to and from at all, however long that takes.

use crate::network::Network;

/// The waypoints to which a loaded robot can drive from `source`.
///
/// Queues are open to it, since any waypoint may be its goal; storage locations and closed waypoints
/// are not.
pub fn carried_from(network: &Network, source: u32) -> Vec<bool> {
    let ends = |node: u32| network.storage[node as usize] && node != source;
    spread(network, source, ends, |node, next| {
        for heading in 0..network.heading_count() as u8 {
            let ahead = network.ahead(node, heading).map(|(to, _)| to);
            next.extend(ahead.filter(|&to| network.may_enter(node, to, to, false)));
        }
        next.extend(network.rides_from(node).map(|ride| ride.to));
    })
}

/// The waypoints from which a loaded robot can drive to `goal`.
pub fn carried_to(network: &Network, goal: u32) -> Vec<bool> {
    let ends = |node: u32| network.storage[node as usize] && node != goal;
    spread(network, goal, ends, |node, next| {
        for heading in 0..network.heading_count() as u8 {
            let behind = network.behind(node, heading).map(|(from, _)| from);
            next.extend(behind.filter(|&from| network.may_enter(from, node, goal, true)));
        }
        next.extend(network.rides_to(node).map(|ride| ride.from));
    })
}

/// Visits waypoints one after another, without continuing from those for which `ends` holds.
fn spread(
    network: &Network,
    first: u32,
    ends: impl Fn(u32) -> bool,
    neighbours: impl Fn(u32, &mut Vec<u32>),
) -> Vec<bool> {
    let mut reached = vec![false; network.nodes];
    let (mut open, mut next) = (vec![first], Vec::new());
    reached[first as usize] = true;
    while let Some(node) = open.pop() {
        if ends(node) {
            continue;
        }
        neighbours(node, &mut next);
        for node in next.drain(..) {
            if !std::mem::replace(&mut reached[node as usize], true) {
                open.push(node);
            }
        }
    }
    reached
}
