//! Time in whole microseconds and angles in whole micro-turns, so that runs are identical
//! everywhere.

/// A point in time or a duration in microseconds.
pub type Us = i64;

/// The end of a reservation without a planned end.
pub const FOREVER: Us = i64::MAX / 4;

/// An angle in millionths of a full turn, `0..TURN`.
pub type MicroTurn = i32;

/// One full turn.
pub const TURN: MicroTurn = 1_000_000;

/// Rounds a non-negative time in seconds down: the start of an occupation.
pub fn floor_us(seconds: f64) -> Us {
    // a conversion cuts off: many times quicker than the functions of the platform
    let time = seconds * 1e6;
    let cut = time as Us;
    cut - Us::from(cut as f64 > time)
}

/// Rounds a non-negative time in seconds up: the end of an occupation.
pub fn ceil_us(seconds: f64) -> Us {
    let time = seconds * 1e6;
    let cut = time as Us;
    cut + Us::from((cut as f64) < time)
}

/// The heading of the vector `(dx, dy)`, rounded so that it does not depend on the platform's libm.
pub fn heading_of(dx: f64, dy: f64) -> MicroTurn {
    from_radians(dy.atan2(dx))
}

/// An angle in radians as micro-turns in `0..TURN`.
pub fn from_radians(angle: f64) -> MicroTurn {
    let turns = angle / std::f64::consts::TAU;
    ((turns * f64::from(TURN)).round() as MicroTurn).rem_euclid(TURN)
}

/// A heading in radians, in `-pi..=pi`.
pub fn to_radians(heading: MicroTurn) -> f64 {
    let signed = if heading > TURN / 2 { heading - TURN } else { heading };
    f64::from(signed) / f64::from(TURN) * std::f64::consts::TAU
}

/// The shorter way between two headings, in micro-turns `0..=TURN / 2`.
pub fn turn_between(from: MicroTurn, to: MicroTurn) -> MicroTurn {
    let difference = (to - from).rem_euclid(TURN);
    difference.min(TURN - difference)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compass_headings_are_exact() {
        assert_eq!(heading_of(1.0, 0.0), 0);
        assert_eq!(heading_of(0.0, 1.0), 250_000);
        assert_eq!(heading_of(-1.0, 0.0), 500_000);
        assert_eq!(heading_of(0.0, -1.0), 750_000);
    }

    #[test]
    fn times_are_rounded_down_and_up() {
        for seconds in [0.0, 1e-7, 0.1, 0.3, 1.0, 2.999_999_9, 12.5, 86_400.000_000_4, 1e9] {
            let time: f64 = seconds * 1e6;
            assert_eq!(floor_us(seconds), time.floor() as Us);
            assert_eq!(ceil_us(seconds), time.ceil() as Us);
        }
    }

    #[test]
    fn turns_take_the_shorter_way() {
        assert_eq!(turn_between(0, 750_000), 250_000);
        assert_eq!(turn_between(900_000, 100_000), 200_000);
        assert_eq!(turn_between(0, 500_000), 500_000);
    }
}
