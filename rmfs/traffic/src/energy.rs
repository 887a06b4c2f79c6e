//! Energy that each piece of motion draws from a robot's battery, and energy charged while it
//! stands.
//!
//! Traction is work against rolling resistance and inertia, phase by phase of a run (accelerate,
//! cruise, brake), so that force times distance is exact. A share of the work of braking is
//! recovered.
//! Turning has its own resistance and inertia; lifting is potential energy; electronics draw power
//! all the time. If a waypoint supplies power, a robot that stands there is charged and its
//! electronics are supplied.

use serde::{Deserialize, Serialize};

use crate::kinematics::{Kind, Profile};
use crate::units::{MicroTurn, TURN, Us};

/// m/s².
pub const GRAVITY: f64 = 9.806_65;

/// Parameters of the energy drawn by the motion of a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// Mass of the robot, kg.
    pub robot: f64,
    /// Rolling resistance per weight.
    pub rolling: f64,
    /// Share by which wheels and motors add to the inertia of the mass.
    pub inertia: f64,
    /// Share of the power drawn that reaches the wheels.
    pub efficiency: f64,
    /// Share of the work of braking that is recovered.
    pub recuperation: f64,
    /// Torque against a turn on the spot per weight, m.
    pub turning: f64,
    /// Radius of gyration of robot and load, m.
    pub gyration: f64,
    /// Height by which a pod is lifted, m.
    pub lift_height: f64,
    /// Share of the power drawn that is used for lifting.
    pub lift_efficiency: f64,
    /// Power of the electronics, W: without and with a pod.
    pub standby: [f64; 2],
}

/// Energy drawn from the battery, and returned to it by braking, J.
type Drawn = (f64, f64);

impl Model {
    /// The run `profile` as far as `distance`, with a total mass of `mass` kg.
    pub fn run(&self, kind: &Kind, profile: &Profile, distance: f64, mass: f64) -> Drawn {
        let [speeding, cruising, braking] = profile.phases_until(distance);
        let inert = (1.0 + self.inertia) * mass;
        let resistance = self.rolling * mass * GRAVITY;
        let surplus = inert * kind.deceleration - resistance;
        let drawn = ((resistance + inert * kind.acceleration) * speeding
            + resistance * cruising
            + (-surplus).max(0.0) * braking)
            / self.efficiency;
        (drawn, self.recuperation * surplus.max(0.0) * braking)
    }

    /// A turn on the spot by `angle`, of which `share` is done.
    pub fn turn(&self, kind: &Kind, angle: MicroTurn, share: f64, mass: f64) -> Drawn {
        if angle == 0 || share <= 0.0 {
            return (0.0, 0.0);
        }
        let radians = f64::from(angle) / f64::from(TURN) * std::f64::consts::TAU;
        let speed = std::f64::consts::TAU / (kind.full_turn as f64 / 1e6);
        let kinetic = 0.5 * mass * (self.gyration * speed).powi(2);
        let resistance = self.turning * mass * GRAVITY * radians * share;
        let back = if share >= 1.0 { self.recuperation * kinetic } else { 0.0 };
        ((resistance + kinetic) / self.efficiency, back)
    }

    /// The lift of a pod of `mass` kg, of which `share` is done.
    pub fn lift(&self, mass: f64, share: f64) -> f64 {
        mass * GRAVITY * self.lift_height * share / self.lift_efficiency
    }
}

/// A battery: constant power up to a level, from there on power that falls evenly to 0 when full.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Battery {
    /// J.
    pub capacity: f64,
    /// Share of the capacity from which the power falls; 1 for constant power.
    pub taper_from: f64,
}

impl Battery {
    /// The level after `seconds` at a charger of `power` W, J.
    pub fn charged(&self, level: f64, power: f64, seconds: f64) -> f64 {
        let bend = self.taper_from * self.capacity;
        let constant_for = ((bend - level) / power).max(0.0);
        if seconds <= constant_for {
            return level + power * seconds;
        }
        if self.taper_from >= 1.0 {
            return self.capacity.max(level);
        }
        let begun = level.max(bend).min(self.capacity);
        let pace = power / (self.capacity - bend);
        self.capacity - (self.capacity - begun) * (-(seconds - constant_for) * pace).exp()
    }
}

/// Energy drawn and charged by a robot since time zero.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spent {
    /// J drawn in runs, turns and lifts.
    pub drive: f64,
    pub turn: f64,
    pub lift: f64,
    /// J returned by braking.
    pub recuperated: f64,
    /// Time without and with a pod: the electronics draw power all the time.
    pub standing_by: [Us; 2],
    /// J from chargers.
    pub charged: f64,
    /// Time at chargers.
    pub charging: Us,
}

impl Spent {
    /// J drawn by the electronics.
    pub fn standby(&self, model: &Model) -> f64 {
        let [empty, loaded] = self.standing_by;
        (model.standby[0] * empty as f64 + model.standby[1] * loaded as f64) / 1e6
    }

    /// Total J drawn, less what braking returned.
    pub fn used(&self, model: &Model) -> f64 {
        self.drive + self.turn + self.lift - self.recuperated + self.standby(model)
    }

    /// The difference from an earlier state, `before`.
    pub fn since(&self, before: &Self) -> Self {
        let [empty, loaded] = self.standing_by;
        Self {
            drive: self.drive - before.drive,
            turn: self.turn - before.turn,
            lift: self.lift - before.lift,
            recuperated: self.recuperated - before.recuperated,
            standing_by: [empty - before.standing_by[0], loaded - before.standing_by[1]],
            charged: self.charged - before.charged,
            charging: self.charging - before.charging,
        }
    }
}

/// A robot that stands where there is power.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Plugged {
    since: Us,
    level: f64,
    power: f64,
    loaded: bool,
}

/// One piece of motion, whole or begun.
#[derive(Clone, Copy, Debug)]
pub enum Done<'a> {
    /// A turn by an angle, and the share of it done.
    Turn(&'a Kind, MicroTurn, f64),
    /// A run, and the metres driven.
    Run(&'a Kind, &'a Profile, f64),
    /// A ride in an elevator, or a set-down: these only take time.
    Time,
    /// The share of a lift that is done.
    Lift(f64),
}

/// Energy of all robots.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Energy {
    pub model: Model,
    /// Mass of each pod with its stock, kg.
    pub pods: Vec<f64>,
    pub battery: Option<Battery>,
    /// Power supplied by each waypoint, W; empty if none supplies any.
    pub power: Vec<f64>,
    /// J in each battery at time zero.
    pub initial: Vec<f64>,
    spent: Vec<Spent>,
    before: Vec<Spent>,
    plugged: Vec<Option<Plugged>>,
}

impl Energy {
    /// Robots that have not moved yet; `initial` has an entry per robot.
    pub fn new(
        model: Model,
        pods: Vec<f64>,
        battery: Option<Battery>,
        power: Vec<f64>,
        initial: Vec<f64>,
    ) -> Self {
        let robots = initial.len();
        Self {
            model,
            pods,
            battery,
            power,
            initial,
            spent: vec![Spent::default(); robots],
            before: vec![Spent::default(); robots],
            plugged: vec![None; robots],
        }
    }

    /// Adds time in which a robot stood at a waypoint.
    pub fn stood(&mut self, robot: u32, start: Us, end: Us, node: u32, pod: Option<u32>) {
        let index = robot as usize;
        let power = self.power.get(node as usize).copied().unwrap_or(0.0);
        if power > 0.0 && self.battery.is_some() && self.plugged[index].is_none() {
            let level = self.level_of(robot, &self.spent[index]);
            self.plugged[index] =
                Some(Plugged { since: start, level, power, loaded: pod.is_some() });
        }
        self.spent[index].standing_by[usize::from(pod.is_some())] += end - start;
    }

    /// Adds a piece of motion that began at `start`.
    pub fn moved(&mut self, robot: u32, start: Us, end: Us, pod: Option<u32>, done: Done<'_>) {
        self.unplug(robot, start);
        let mut spent = std::mem::take(&mut self.spent[robot as usize]);
        self.add(&mut spent, end - start, pod, done);
        self.spent[robot as usize] = spent;
    }

    /// Adds a piece of motion, or the completed part of it, to the energy of a robot.
    pub fn add(&self, spent: &mut Spent, lasting: Us, pod: Option<u32>, done: Done<'_>) {
        spent.standing_by[usize::from(pod.is_some())] += lasting;
        let load = pod.map_or(0.0, |pod| self.pods[pod as usize]);
        let mass = self.model.robot + load;
        match done {
            Done::Turn(kind, angle, share) => {
                let (drawn, back) = self.model.turn(kind, angle, share, mass);
                spent.turn += drawn;
                spent.recuperated += back;
            }
            Done::Run(kind, profile, distance) => {
                let (drawn, back) = self.model.run(kind, profile, distance, mass);
                spent.drive += drawn;
                spent.recuperated += back;
            }
            Done::Lift(share) => spent.lift += self.model.lift(load, share),
            Done::Time => {}
        }
    }

    /// Ends the charging of a robot.
    pub fn unplug(&mut self, robot: u32, at: Us) {
        if self.plugged[robot as usize].is_some() {
            let spent = self.spent_at(robot, at);
            self.spent[robot as usize] = spent;
            self.plugged[robot as usize] = None;
        }
    }

    /// Energy of a robot whose motion has been recorded until `at`.
    pub fn spent_at(&self, robot: u32, at: Us) -> Spent {
        let mut spent = self.spent[robot as usize].clone();
        if let (Some(plugged), Some(battery)) = (&self.plugged[robot as usize], &self.battery) {
            let lasted = at - plugged.since;
            let seconds = lasted as f64 / 1e6;
            let gain = battery.charged(plugged.level, plugged.power, seconds) - plugged.level;
            let standby = self.model.standby[usize::from(plugged.loaded)] * seconds;
            spent.charged += gain + standby;
            spent.charging += lasted;
        }
        spent
    }

    /// J drawn by a robot as far as recorded, less what braking returned.
    pub fn used(&self, robot: u32) -> f64 {
        self.spent[robot as usize].used(&self.model)
    }

    /// J in the battery of a robot with this balance.
    pub fn level_of(&self, robot: u32, spent: &Spent) -> f64 {
        self.initial[robot as usize] + spent.charged - spent.used(&self.model)
    }

    /// Exchanges the battery of a robot, recorded until `at`, for one with `level` J.
    pub fn exchange(&mut self, robot: u32, at: Us, level: f64) {
        self.unplug(robot, at);
        let present = self.level_of(robot, &self.spent[robot as usize]);
        self.spent[robot as usize].charged += level - present;
    }

    /// Energy of a robot since the statistics were reset.
    pub fn since_reset(&self, robot: usize, spent: &Spent) -> Spent {
        spent.since(&self.before[robot])
    }

    /// Resets the statistics; levels are kept.
    pub fn reset(&mut self, spent: Vec<Spent>) {
        self.before = spent;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> Model {
        Model {
            robot: 100.0,
            rolling: 0.02,
            inertia: 0.15,
            efficiency: 0.8,
            recuperation: 0.5,
            turning: 0.01,
            gyration: 0.3,
            lift_height: 0.05,
            lift_efficiency: 0.5,
            standby: [20.0, 30.0],
        }
    }

    fn kind() -> Kind {
        Kind {
            acceleration: 0.7,
            deceleration: 1.1,
            top_speed: 1.5,
            full_turn: 2_500_000,
            pod_transfer: 2_200_000,
        }
    }

    #[test]
    fn a_run_costs_the_integral_of_its_power() {
        let (model, kind) = (model(), kind());
        for (length, mass) in [(0.4, 100.0), (3.0, 450.0), (25.0, 613.0)] {
            let profile = kind.run(length);
            let steps = 400_000;
            let dt = profile.duration() / f64::from(steps);
            let (mut drawn, mut back) = (0.0, 0.0);
            for step in 0..steps {
                let (v0, v1) = (
                    profile.speed_at(f64::from(step) * dt),
                    profile.speed_at(f64::from(step + 1) * dt),
                );
                let force =
                    model.rolling * mass * GRAVITY + (1.0 + model.inertia) * mass * (v1 - v0) / dt;
                let work = force * (v0 + v1) / 2.0 * dt;
                drawn += work.max(0.0) / model.efficiency;
                back += (-work).max(0.0) * model.recuperation;
            }
            let (exact, exact_back) = model.run(&kind, &profile, length, mass);
            assert!((drawn / exact - 1.0).abs() < 1e-4, "{drawn} {exact}");
            assert!((back / exact_back - 1.0).abs() < 1e-4, "{back} {exact_back}");
        }
    }

    #[test]
    fn charging_in_two_parts_is_charging_at_once() {
        let battery = Battery { capacity: 1000.0, taper_from: 0.8 };
        for (level, power) in [(100.0, 5.0), (700.0, 2.0), (900.0, 4.0)] {
            let half = battery.charged(level, power, 60.0);
            let whole = battery.charged(level, power, 200.0);
            assert!((battery.charged(half, power, 140.0) - whole).abs() < 1e-9);
            assert!(whole < 1000.0 && whole > half);
        }
        let constant = Battery { capacity: 1000.0, taper_from: 1.0 };
        assert_eq!(constant.charged(100.0, 5.0, 60.0), 400.0);
        assert_eq!(constant.charged(100.0, 5.0, 600.0), 1000.0);
    }
}
