//! Motion on a straight line with constant acceleration, top speed and constant deceleration.
//!
//! The closed forms follow equations 1-9 of Merschformann, Xie, Li (2018), derived anew from the
//! physics: Algorithm 1 there is misprinted in lines 5 and 7.

use crate::units::{MicroTurn, TURN, Us, ceil_us, turn_between};

/// Size and motion of a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// m/s², greater than 0.
    pub acceleration: f64,
    /// m/s², greater than 0.
    pub deceleration: f64,
    /// m/s, greater than 0.
    pub top_speed: f64,
    /// Time for a turn of 360 degrees on the spot.
    pub full_turn: Us,
    /// Time to lift or to set down a pod.
    pub pod_transfer: Us,
}

impl Kind {
    /// Metres needed to reach top speed from rest.
    pub fn run_up(&self) -> f64 {
        self.top_speed * self.top_speed / (2.0 * self.acceleration)
    }

    /// Metres needed to stop from top speed.
    pub fn braking(&self) -> f64 {
        self.top_speed * self.top_speed / (2.0 * self.deceleration)
    }

    /// Time to turn on the spot by the shorter way.
    pub fn turn(&self, from: MicroTurn, to: MicroTurn) -> Us {
        let angle = Us::from(turn_between(from, to));
        (angle * self.full_turn + Us::from(TURN) - 1) / Us::from(TURN)
    }

    /// Seconds until `distance` metres of a run from rest that will not brake are covered; for runs
    /// that are long enough, equal to [`Profile::time_at`] to the last bit.
    pub fn unbraked(&self, distance: f64) -> f64 {
        let run_up = self.run_up();
        if distance <= run_up {
            (2.0 * self.acceleration * distance).sqrt() / self.acceleration
        } else {
            self.top_speed / self.acceleration + (distance - run_up) / self.top_speed
        }
    }

    /// The rest-to-rest run over `length` metres.
    pub fn run(&self, length: f64) -> Profile {
        Profile::new(self, 0.0, length)
    }

    /// Time of the rest-to-rest run over `length` metres, rounded up.
    pub fn run_time(&self, length: f64) -> Us {
        ceil_us(self.run(length).duration())
    }
}

/// Speed over time on a straight line: accelerate, cruise, brake. Ends at rest, unless the line is
/// too short to stop from the initial speed: then it brakes all the way.
#[derive(Clone, Debug)]
pub struct Profile {
    initial_speed: f64,
    acceleration: f64,
    deceleration: f64,
    peak: f64,
    length: f64,
    accelerating_for: f64,
    accelerating_over: f64,
    cruising_for: f64,
    braking_over: f64,
    braking_for: f64,
}

impl Profile {
    /// The fastest motion over `length` metres from `initial_speed` m/s (at most the top speed).
    pub fn new(kind: &Kind, initial_speed: f64, length: f64) -> Self {
        let (a, b, v0) = (kind.acceleration, kind.deceleration, initial_speed);
        let stopping = v0 * v0 / (2.0 * b);
        if stopping >= length {
            let end_speed = (v0 * v0 - 2.0 * b * length).max(0.0).sqrt();
            return Self {
                initial_speed: v0,
                acceleration: a,
                deceleration: b,
                peak: v0,
                length,
                accelerating_for: 0.0,
                accelerating_over: 0.0,
                cruising_for: 0.0,
                braking_over: length,
                braking_for: (v0 - end_speed) / b,
            };
        }
        let top = kind.top_speed;
        let cruises = length >= (top * top - v0 * v0) / (2.0 * a) + kind.braking();
        // below that length, the speed at which accelerating and braking just meet
        let meeting = ((2.0 * a * b * length + b * v0 * v0) / (a + b)).sqrt();
        let peak = if cruises { top } else { meeting.min(top) };
        let accelerating_over = (peak * peak - v0 * v0) / (2.0 * a);
        let braking_over = peak * peak / (2.0 * b);
        let cruising_over = (length - accelerating_over - braking_over).max(0.0);
        Self {
            initial_speed: v0,
            acceleration: a,
            deceleration: b,
            peak,
            length,
            accelerating_for: (peak - v0) / a,
            accelerating_over,
            cruising_for: if cruises { cruising_over / peak } else { 0.0 },
            braking_over,
            braking_for: peak / b,
        }
    }

    /// Seconds for the whole line.
    pub fn duration(&self) -> f64 {
        self.accelerating_for + self.cruising_for + self.braking_for
    }

    /// Metres of the first `distance` metres in which the robot accelerates, cruises and brakes.
    pub fn phases_until(&self, distance: f64) -> [f64; 3] {
        let accelerating = distance.min(self.accelerating_over);
        let braking = (distance - (self.length - self.braking_over)).max(0.0);
        [accelerating, (distance - accelerating - braking).max(0.0), braking]
    }

    /// Seconds until `distance` metres are covered (`0 <= distance <= length`).
    pub fn time_at(&self, distance: f64) -> f64 {
        if distance >= self.length {
            return self.duration();
        }
        if distance <= self.accelerating_over {
            let v0 = self.initial_speed;
            let speed = (v0 * v0 + 2.0 * self.acceleration * distance).sqrt();
            return (speed - v0) / self.acceleration;
        }
        let remaining = self.length - distance;
        if remaining >= self.braking_over {
            return self.accelerating_for + (distance - self.accelerating_over) / self.peak;
        }
        let covered = self.braking_over - remaining;
        let speed = (self.peak * self.peak - 2.0 * self.deceleration * covered).max(0.0).sqrt();
        let before = self.accelerating_for + self.cruising_for;
        before + (self.peak - speed) / self.deceleration
    }

    /// Metres covered after `time` seconds (clamped to the line).
    pub fn position_at(&self, time: f64) -> f64 {
        if time <= 0.0 {
            return 0.0;
        }
        if time <= self.accelerating_for {
            return (self.initial_speed + self.acceleration * time / 2.0) * time;
        }
        let cruising = time - self.accelerating_for;
        if cruising <= self.cruising_for {
            return self.accelerating_over + self.peak * cruising;
        }
        let braking = cruising - self.cruising_for;
        if braking >= self.braking_for {
            return self.length;
        }
        let before = self.length - self.braking_over;
        before + (self.peak - self.deceleration * braking / 2.0) * braking
    }

    /// Speed after `time` seconds, m/s.
    pub fn speed_at(&self, time: f64) -> f64 {
        if time <= self.accelerating_for {
            return self.initial_speed + self.acceleration * time.max(0.0);
        }
        let braking = time - self.accelerating_for - self.cruising_for;
        if braking <= 0.0 {
            return self.peak;
        }
        (self.peak - self.deceleration * braking.min(self.braking_for)).max(0.0)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A slow robot, also for the tests of other modules.
    pub const KIND: Kind = Kind {
        acceleration: 0.5,
        deceleration: 0.5,
        top_speed: 1.5,
        full_turn: 2_500_000,
        pod_transfer: 3_000_000,
    };

    #[test]
    fn known_run_times() {
        // path-planning study: 1, 2, 5, 10, 20 m at 0.5 m/s² and 1.5 m/s
        for (length, seconds) in [
            (1.0, 2.828_427),
            (2.0, 4.0),
            (5.0, 19.0 / 3.0),
            (10.0, 29.0 / 3.0),
            (20.0, 49.0 / 3.0),
        ] {
            assert!((KIND.run(length).duration() - seconds).abs() < 1e-6);
        }
    }

    #[test]
    fn a_quarter_turn() {
        assert_eq!(KIND.turn(0, 250_000), 625_000);
        assert_eq!(KIND.turn(250_000, 0), 625_000);
    }

    #[test]
    fn time_and_position_are_inverse() {
        let kind = Kind { acceleration: 1.0, deceleration: 0.4, ..KIND };
        for initial_speed in [0.0, 0.3, 1.0, 1.5] {
            for length in [0.05, 0.7, 1.0, 3.0, 4.0, 30.0] {
                let profile = Profile::new(&kind, initial_speed, length);
                for step in 0..=20 {
                    let distance = length * f64::from(step) / 20.0;
                    let back = profile.position_at(profile.time_at(distance));
                    assert!(
                        (back - distance).abs() < 1e-9,
                        "{initial_speed} {length} {distance}: {back}"
                    );
                }
            }
        }
    }

    #[test]
    fn position_is_the_integral_of_speed() {
        for initial_speed in [0.0, 0.8, 1.5] {
            for length in [0.5, 2.0, 12.0] {
                let profile = Profile::new(&KIND, initial_speed, length);
                let steps = 20_000;
                let dt = profile.duration() / f64::from(steps);
                let mut position = 0.0;
                for step in 0..steps {
                    position += profile.speed_at((f64::from(step) + 0.5) * dt) * dt;
                }
                assert!((position - length).abs() < 1e-5, "{initial_speed} {length}: {position}");
            }
        }
    }
}
