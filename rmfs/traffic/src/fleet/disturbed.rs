//! Robots that are disturbed: they stop for a while, or drive slower than they should.
//!
//! Both only make plans late. The order in which waypoints are used stays (`late.rs`), so whoever
//! had a plan keeps its way, nobody meets anybody, and no new deadlock can come about.

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
    /// Nothing changes, and the result is `None`, if somebody is already driving who would have to
    /// wait for it. Otherwise the time at which it may go on.
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

    /// Makes a robot that stands still one of another kind; its plan takes as long as that needs.
    ///
    /// Nothing changes, and the result is false, if it is in motion, or somebody is already driving
    /// who would have to wait for it.
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

/// Moves as they are when a robot of another kind makes them: none begins earlier or ends earlier.
///
/// A run that gets longer begins when it did; one that gets shorter ends when it did, so that the
/// robot is never anywhere before the time planned.
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

/// How long the robot turns before a move.
pub(super) fn turn(network: &Network, kind: &Kind, step: &Move) -> Us {
    let heading = |index: u8| network.headings[index as usize];
    kind.turn(heading(step.heading_before), heading(step.heading))
}
