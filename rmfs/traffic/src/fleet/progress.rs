//! Updates of robots and their record to the present.

use crate::kinematics::Kind;
use crate::network::Network;
use crate::record::{Piece, Row, Standing, Totals, partly};
use crate::robot::{Phase, Step};
use crate::search::Move;
use crate::units::{Us, floor_us};

use super::{Counters, Fleet};

impl Fleet {
    /// Updates a robot's state and record to the present.
    pub(super) fn settle(&mut self, robot: u32) {
        let now = self.now;
        let state = &mut self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let purpose = state.purpose(self.network.stations.len());
        let why = if state.phase != Phase::Idle {
            Standing::Waiting(purpose)
        } else if state.place.is_some() {
            Standing::Served(purpose)
        } else {
            Standing::Idle
        };
        while state.moves.front().is_some_and(|step| step.end <= now) {
            let step = state.moves.pop_front().expect("checked");
            let turn = kind.turn(
                self.network.headings[step.heading_before as usize],
                self.network.headings[step.heading as usize],
            );
            if matches!(why, Standing::Waiting(_)) {
                self.record.await_plan(robot, step.start - turn, state.awaits);
            }
            self.record.stand(
                robot,
                step.start - turn,
                step.from,
                step.heading_before,
                state.pod,
                why,
            );
            let station = state.station();
            let entered = self.record.enters_zone(&self.network, kind, robot, &step, station);
            self.record.drive(&self.network, kind, robot, &step, state.pod, purpose);
            if let Some(leg) = &mut self.legs[robot as usize] {
                if step.end <= leg.start {
                    // it was still driving its previous plan
                    leg.distance_before = self.record.totals[robot as usize].distance;
                    leg.energy_before = self.record.used(robot);
                }
                leg.zone_entered = leg.zone_entered.or(entered);
            }
            if !step.ride {
                state.anchored = last_approach(&self.network, kind, &step);
            }
            state.anchor = step.to;
            state.heading = step.heading;
            state.rested = step.end;
        }
        // while it lifts, its plan for afterwards may be made
        if state.phase == Phase::Transferring || state.transfer_end > now {
            self.stand_until_transfer(robot);
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
        if matches!(why, Standing::Waiting(_)) {
            self.record.await_plan(robot, standing_until, state.awaits);
        }
        self.record.stand(robot, standing_until, state.anchor, state.heading, state.pod, why);
    }

    /// Records that a robot stood until it began to lift or set down, because it had broken down.
    pub(super) fn stand_until_transfer(&mut self, robot: u32) {
        let state = &self.robots[robot as usize];
        let begin = state.transfer_end - self.kinds[state.kind as usize].pod_transfer;
        let lifting = matches!(state.program.front(), Some(Step::Lift(_)));
        let pod = if lifting { None } else { state.pod };
        let why = Standing::Waiting(state.purpose(self.network.stations.len()));
        let until = begin.min(self.now);
        self.record.stand(robot, until, state.anchor, state.heading, pod, why);
    }

    /// Updates all robots' states and records to the present.
    pub fn settle_all(&mut self) {
        for robot in 0..self.robots.len() as u32 {
            self.settle(robot);
        }
    }

    /// The completed part of a robot's motion in progress.
    fn in_progress(&self, robot: usize) -> Totals {
        let state = &self.robots[robot];
        if state.phase == Phase::Transferring {
            let transferring = self.now - self.record.recorded(robot as u32);
            return Totals { transferring, ..Totals::default() };
        }
        let kind = &self.kinds[state.kind as usize];
        state.moves.front().map_or_else(Totals::default, |step| {
            partly(&self.network, kind, step, state.pod, self.now)
        })
    }

    /// When the robot entered the queue zone in which it is, on its way to the station.
    pub(super) fn queueing_since(&self, robot: usize) -> Option<Us> {
        let state = &self.robots[robot];
        let leg = self.legs[robot].as_ref()?;
        let entering = || {
            let kind = &self.kinds[state.kind as usize];
            let step = state.moves.front()?;
            self.record.enters_zone(&self.network, kind, robot as u32, step, state.station())
        };
        leg.zone_entered.or_else(entering).filter(|&entered| entered <= self.now)
    }

    /// Totals of each robot since the last reset, up to now.
    pub fn totals(&mut self) -> Vec<Totals> {
        self.settle_all();
        let totals = self.record.totals.iter().enumerate();
        totals
            .map(|(robot, done)| {
                let mut totals = done.plus(&self.in_progress(robot), 1);
                if let Some(entered) = self.queueing_since(robot) {
                    totals.queueing += self.now - entered.max(self.record.since);
                }
                totals
            })
            .collect()
    }

    /// Resets totals, heat, trips and counters.
    pub fn reset_statistics(&mut self) {
        let until_now = self.totals();
        for (leg, totals) in self.legs.iter_mut().zip(&until_now) {
            if let Some(leg) = leg {
                leg.distance_before -= totals.distance;
            }
        }
        let in_progress: Vec<Totals> =
            (0..self.robots.len()).map(|r| self.in_progress(r)).collect();
        self.record.reset(self.now, &in_progress);
        self.reset_energy();
        self.counters = Counters::default();
        self.pathfinder.expansions = 0;
    }

    /// The trace up to now without its first `known` rows in the order of recording, by robot and
    /// time, and the number of rows recorded. Motions in progress are included as a whole and do
    /// not count as recorded. `None` if the trace is not recorded.
    pub fn trace(&mut self, known: usize) -> Option<(Vec<Row>, usize)> {
        self.settle_all();
        let recorded = self.record.trace.as_ref()?;
        let count = recorded.len();
        let mut rows: Vec<Row> = recorded.since(known).cloned().collect();
        for (id, state) in self.robots.iter().enumerate() {
            let robot = id as u32;
            let kind = &self.kinds[state.kind as usize];
            match (state.phase, state.program.front()) {
                (Phase::Transferring, _) if state.transfer_end - kind.pod_transfer >= self.now => {}
                (Phase::Transferring, Some(&(Step::Lift(pod) | Step::SetDown(pod)))) => {
                    let piece = if matches!(state.program.front(), Some(Step::Lift(_))) {
                        Piece::Lift
                    } else {
                        Piece::SetDown
                    };
                    rows.push(Row {
                        robot,
                        start: self.record.recorded(robot),
                        end: state.transfer_end,
                        piece,
                        from: state.anchor,
                        to: state.anchor,
                        heading_before: state.heading,
                        heading: state.heading,
                        pod: pod as i32,
                        top_speed: 0.0,
                    });
                }
                _ if state.committed(&self.network, kind, self.now) > 0 => {
                    let step = &state.moves[0];
                    rows.extend(self.record.rows(&self.network, kind, robot, step, state.pod));
                }
                _ => {}
            }
        }
        rows.sort_by_key(|row| (row.robot, row.start));
        Some((rows, count))
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
