//! Disturbances of robots, which stop for a while or drive more slowly than planned.
//!
//! Both only delay plans. The order in which robots use waypoints is kept (`late.rs`), so all
//! robots keep their ways, and there can be no collision and no new deadlock.

use crate::kinematics::Kind;
use crate::network::Network;
use crate::robot::Phase;
use crate::search::Move;
use crate::units::{Us, ceil_us};

use super::Fleet;
use super::late::{Delays, Shift};

impl Fleet {
    /// Lets a robot stand still for `by` where it next comes to rest.
    ///
    /// Returns the time at which it continues. Returns `None` and changes nothing if a robot that
    /// is already driving would have to wait for it.
    pub fn hold(&mut self, robot: u32, by: Us) -> Option<Us> {
        self.settle_all();
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let begun = state.committed(&self.network, kind, self.now);
        let rests = begun.checked_sub(1).map_or(self.now, |last| state.moves[last].end);
        let until = rests.max(state.busy_until) + by;
        let late = state
            .moves
            .get(begun)
            .map_or(0, |next| until - (next.start - turn(&self.network, kind, next)));
        if late > 0 && !self.delay(robot, late, Shift::Planned) {
            return None;
        }
        self.robots[robot as usize].busy_until = until;
        self.forget_wish(robot);
        Some(until)
    }

    /// Changes the kind of a robot that stands still, and adapts the times of its plan.
    ///
    /// Returns false and changes nothing if it is in motion, or if a robot that is already driving
    /// would have to wait for it.
    pub fn change_kind(&mut self, robot: u32, kind: u8) -> bool {
        self.settle_all();
        let state = &self.robots[robot as usize];
        let present = &self.kinds[state.kind as usize];
        if state.phase == Phase::Transferring
            || state.committed(&self.network, present, self.now) > 0
        {
            return false;
        }
        let mut delays = Delays::new(self, Shift::Planned);
        if !delays.change_kind(robot, kind) {
            return false;
        }
        let plans = delays.into_plans();
        self.robots[robot as usize].kind = kind;
        self.follow(plans);
        self.forget_wish(robot);
        true
    }
}

/// The moves as made by a robot of another kind; none begins or ends earlier.
///
/// A run that takes longer keeps its start, and one that takes less time keeps its end, so that the
/// robot never arrives anywhere before the planned time.
pub(super) fn stretched<'a>(
    network: &Network,
    kind: &Kind,
    moves: impl IntoIterator<Item = &'a Move>,
) -> Vec<Move> {
    let mut made: Vec<Move> = Vec::new();
    for step in moves {
        let mut step = step.clone();
        let length = network.line(step.from, step.to, step.heading).last().map_or(0.0, |l| l.1);
        let needs =
            if step.ride { step.end - step.start } else { ceil_us(kind.run(length).duration()) };
        let ready =
            made.last().map_or(step.start, |before| before.end + turn(network, kind, &step));
        step.end = step.end.max(step.start.max(ready) + needs);
        step.start = step.end - needs;
        made.push(step);
    }
    made
}

/// Duration of the robot's turn before a move.
pub(super) fn turn(network: &Network, kind: &Kind, step: &Move) -> Us {
    let heading = |index: u8| network.headings[index as usize];
    kind.turn(heading(step.heading_before), heading(step.heading))
}
