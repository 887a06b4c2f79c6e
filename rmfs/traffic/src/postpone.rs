//! Postponing departures: moves the waits of a plan from the aisles back to its start.
//!
//! The search reaches every stop as early as possible and waits there. For a fixed arrival at the
//! goal, each run may start later, which keeps the aisles free for others.

use crate::kinematics::Kind;
use crate::network::Network;
use crate::reservations::{Table, Windows};
use crate::search::Move;
use crate::units::{Us, ceil_us, floor_us};

/// Starts every move but the last as late as the next one and the reservations of others allow.
///
/// The first move is left alone if the robot does not start from a storage location: a robot at a
/// station or in an aisle should leave soon.
pub fn postpone(network: &Network, table: &Table, kind: &Kind, moves: &mut [Move]) {
    for i in (0..moves.len().saturating_sub(1)).rev() {
        if i == 0 && !network.storage[moves[0].from as usize] {
            return;
        }
        let next = &moves[i + 1];
        let turn = kind.turn(
            network.headings[next.heading_before as usize],
            network.headings[next.heading as usize],
        );
        let step = &moves[i];
        let slack = next.start - turn - step.end;
        if slack > 0 {
            let later = if step.ride { slack } else { latest(network, table, kind, step, slack) };
            moves[i].start += later;
            moves[i].end += later;
        }
    }
}

/// By how much a run can start later, at most `slack`.
fn latest(network: &Network, table: &Table, kind: &Kind, step: &Move, slack: Us) -> Us {
    let line: Vec<(u32, f64)> = network.line(step.from, step.to, step.heading).collect();
    let profile = kind.run(line[line.len() - 1].1);
    let start = network.resource[step.from as usize];
    let until = table.gap_at(start, step.start).map_or(step.start, |gap| gap.1);
    let gone = until - ceil_us(profile.time_at(line[0].1));
    let mut windows: Windows = vec![(step.start, gone.min(step.start + slack))];
    let mut before = 0.0;
    let mut at = profile.time_at(line[0].1);
    for pair in line.windows(2) {
        let (node, beyond) = (pair[0].0, profile.time_at(pair[1].1));
        let resource = network.resource[node as usize];
        table.restrict(resource, floor_us(before), ceil_us(beyond), &mut windows);
        before = at;
        at = beyond;
    }
    windows.last().map_or(0, |window| window.1 - step.start)
}
