//! Bringing robots and their record up to the present.

use crate::kinematics::Kind;
use crate::network::{NONE, Network};
use crate::record::{Piece, Row, Standing, enters_zone, move_rows};
use crate::robot::{Phase, Step};
use crate::search::Move;
use crate::units::{Us, floor_us};

use super::Fleet;

impl Fleet {
    /// Brings a robot's state and record up to now.
    pub(super) fn settle(&mut self, robot: u32) {
        let now = self.now;
        let state = &mut self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let why = if state.phase != Phase::Idle {
            Standing::Waiting
        } else if state.place.is_some() {
            Standing::Served
        } else {
            Standing::Idle
        };
        while state.moves.front().is_some_and(|step| step.end <= now) {
            let step = state.moves.pop_front().expect("checked");
            let turn = kind.turn(
                self.network.headings[step.heading_before as usize],
                self.network.headings[step.heading as usize],
            );
            self.record.stand(
                robot,
                step.start - turn,
                step.from,
                step.heading_before,
                state.pod,
                why,
            );
            self.record.drive(&self.network, kind, robot, &step, state.pod);
            let station = state.station();
            if let Some(leg) = &mut self.legs[robot as usize]
                && station != NONE
                && leg.zone_entered.is_none()
            {
                leg.zone_entered = enters_zone(&self.network, kind, &step, station);
            }
            if !step.ride {
                state.anchored = last_approach(&self.network, kind, &step);
            }
            state.anchor = step.to;
            state.heading = step.heading;
            state.rested = step.end;
        }
        if state.phase == Phase::Transferring {
            return;
        }
        let standing_until = match state.moves.front() {
            Some(step) => {
                let turn = kind.turn(
                    self.network.headings[step.heading_before as usize],
                    self.network.headings[step.heading as usize],
                );
                now.min(step.start - turn)
            }
            None => now,
        };
        self.record.stand(robot, standing_until, state.anchor, state.heading, state.pod, why);
    }

    /// Brings all robots' states and records up to now.
    pub fn settle_all(&mut self) {
        for robot in 0..self.robots.len() as u32 {
            self.settle(robot);
        }
    }

    /// The trace up to now, by robot and time; the motion each robot is in the middle of is whole.
    /// `None` if it is not recorded.
    pub fn trace(&mut self) -> Option<Vec<Row>> {
        self.settle_all();
        let mut rows = self.record.trace.clone()?;
        for (id, state) in self.robots.iter().enumerate() {
            let robot = id as u32;
            let kind = &self.kinds[state.kind as usize];
            match (state.phase, state.program.front()) {
                (Phase::Transferring, Some(&(Step::Lift(pod) | Step::SetDown(pod)))) => {
                    let piece = if matches!(state.program.front(), Some(Step::Lift(_))) {
                        Piece::Lift
                    } else {
                        Piece::SetDown
                    };
                    rows.push(Row {
                        robot,
                        start: self.record.recorded(robot),
                        end: state.busy_until,
                        piece,
                        from: state.anchor,
                        to: state.anchor,
                        heading_before: state.heading,
                        heading: state.heading,
                        pod: pod as i32,
                    });
                }
                _ if state.committed(&self.network, kind, self.now) > 0 => {
                    rows.extend(move_rows(&self.network, kind, robot, &state.moves[0], state.pod));
                }
                _ => {}
            }
        }
        rows.sort_by_key(|row| (row.robot, row.start));
        Some(rows)
    }
}

/// When the robot left the waypoint before the last of a run: from then on it occupies the last.
fn last_approach(network: &Network, kind: &Kind, step: &Move) -> Us {
    let line: Vec<(u32, f64)> = network.line(step.from, step.to, step.heading).collect();
    if line.len() < 2 {
        return step.start;
    }
    let length = line[line.len() - 1].1;
    step.start + floor_us(kind.run(length).time_at(line[line.len() - 2].1))
}
