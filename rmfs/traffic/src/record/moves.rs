//! Quantities of a single move: its turn, the part completed by a time, the time at which it enters
//! a zone.

use super::{Record, Totals};
use crate::kinematics::Kind;
use crate::network::{NONE, Network};
use crate::search::Move;
use crate::units::{MicroTurn, Us, floor_us, turn_between};

/// Angle by which the robot turns before a move.
pub fn angle(network: &Network, step: &Move) -> MicroTurn {
    turn_between(
        network.headings[step.heading_before as usize],
        network.headings[step.heading as usize],
    )
}

/// The part of a move in progress that a robot has completed at `now`.
pub fn partly(network: &Network, kind: &Kind, step: &Move, pod: Option<u32>, now: Us) -> Totals {
    let turn = kind.turn(
        network.headings[step.heading_before as usize],
        network.headings[step.heading as usize],
    );
    let turning = (now - (step.start - turn)).clamp(0, turn);
    let driving = (now - step.start).clamp(0, step.end - step.start);
    if step.ride {
        return Totals { turning, riding: driving, ..Totals::default() };
    }
    let length = network.line(step.from, step.to, step.heading).last().map_or(0.0, |end| end.1);
    let distance = kind.run(length).position_at(driving as f64 / 1e6);
    let loaded_distance = if pod.is_some() { distance } else { 0.0 };
    Totals { turning, moving: driving, distance, loaded_distance, ..Totals::default() }
}

/// When a run enters a zone: the time at which its first waypoint there is reached.
/// `None` if it does not, or starts inside.
pub fn enters_zone(network: &Network, kind: &Kind, step: &Move, zone: u32) -> Option<Us> {
    if zone == NONE || network.zone[step.from as usize] == zone {
        return None;
    }
    if step.ride {
        return (network.zone[step.to as usize] == zone).then_some(step.end);
    }
    let line: Vec<(u32, f64)> = network.line(step.from, step.to, step.heading).collect();
    let length = line.last()?.1;
    let (_, distance) = line.iter().find(|(node, _)| network.zone[*node as usize] == zone)?;
    Some(step.start + floor_us(kind.run(length).time_at(*distance)))
}

impl Record {
    /// When a move enters a zone, delays included; `None` if it does not, or starts inside.
    pub fn enters_zone(
        &self,
        network: &Network,
        kind: &Kind,
        robot: u32,
        step: &Move,
        zone: u32,
    ) -> Option<Us> {
        let planned = enters_zone(network, kind, step, zone);
        if planned.is_none() || step.late == 0 || step.ride {
            return planned;
        }
        let (_, reached) = self.reached(network, kind, robot, step);
        let within = |&&(node, _): &&(u32, Us)| network.zone[node as usize] == zone;
        reached.iter().find(within).map(|&(_, time)| time)
    }
}
