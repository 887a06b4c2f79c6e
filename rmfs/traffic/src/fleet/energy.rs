//! Energy of robots at the present moment, motion in progress included.

use crate::energy::{Done, Energy, Spent};
use crate::record::angle;
use crate::robot::{Phase, Step};

use super::Fleet;

impl Fleet {
    /// Counts energy from now on.
    pub fn count_energy(&mut self, energy: Energy) {
        self.record.energy = Some(Box::new(energy));
    }

    /// Energy of a robot since time zero; zero if energy is not counted.
    pub fn spent(&mut self, robot: u32) -> Option<Spent> {
        self.record.energy.as_ref()?;
        self.settle(robot);
        let energy = self.record.energy.as_ref()?;
        let recorded = self.record.recorded(robot);
        let lasting = self.now - recorded;
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let mut spent = energy.spent_at(robot, recorded);
        if lasting <= 0 {
            return Some(spent);
        }
        if state.phase == Phase::Transferring {
            let share = lasting as f64 / kind.pod_transfer as f64;
            let lifts = matches!(state.program.front(), Some(Step::Lift(_)));
            let done = if lifts { Done::Lift(share) } else { Done::Time };
            energy.add(&mut spent, lasting, state.pod, done);
        } else if let Some(step) = state.moves.front() {
            let by = angle(&self.network, step);
            let turn = kind.turn(
                self.network.headings[step.heading_before as usize],
                self.network.headings[step.heading as usize],
            );
            let turning = lasting.min(turn);
            if turn > 0 {
                let share = turning as f64 / turn as f64;
                energy.add(&mut spent, turning, state.pod, Done::Turn(kind, by, share));
            }
            let driving = lasting - turning;
            if step.ride {
                energy.add(&mut spent, driving, state.pod, Done::Time);
            } else if driving > 0 {
                let line = self.network.line(step.from, step.to, step.heading);
                let profile = kind.run(line.last().map_or(0.0, |end| end.1));
                let distance = profile.position_at(driving as f64 / 1e6);
                energy.add(&mut spent, driving, state.pod, Done::Run(kind, &profile, distance));
            }
        }
        Some(spent)
    }

    /// Changes the power that a waypoint supplies from now on.
    pub fn set_power(&mut self, waypoint: u32, watts: f64) {
        self.settle_all();
        for robot in 0..self.robots.len() as u32 {
            let recorded = self.record.recorded(robot);
            let Some(energy) = &mut self.record.energy else { return };
            if self.robots[robot as usize].anchor == waypoint {
                energy.unplug(robot, recorded);
            }
        }
        let Some(energy) = &mut self.record.energy else { return };
        if energy.power.is_empty() {
            energy.power = vec![0.0; self.network.nodes];
        }
        energy.power[waypoint as usize] = watts;
    }

    /// Exchanges or fills the battery of a robot that stands still.
    pub fn exchange_battery(&mut self, robot: u32, level: f64) {
        self.settle(robot);
        let recorded = self.record.recorded(robot);
        if let Some(energy) = &mut self.record.energy {
            energy.exchange(robot, recorded, level);
        }
    }

    pub(super) fn reset_energy(&mut self) {
        let spent: Vec<Spent> =
            (0..self.robots.len() as u32).filter_map(|robot| self.spent(robot)).collect();
        if let Some(energy) = &mut self.record.energy {
            energy.reset(spent);
        }
    }
}
