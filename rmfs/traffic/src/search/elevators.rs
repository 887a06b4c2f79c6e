//! The earliest time at which an elevator can be used, which delays ways to other tiers.
//!
//! Elevators are the narrowest places of a warehouse, and reserved far ahead. If the search
//! estimated ways to another tier as without traffic, it would expand everything on its own tier
//! until the elevator is free.

use crate::kinematics::Kind;
use crate::network::Ride;
use crate::units::{FOREVER, Us, floor_us};

use super::Search;

impl<const GUIDED: bool> Search<'_, GUIDED> {
    /// No way from the start's island to the goal's takes less: that of the best ride, over
    /// everything the elevators are reserved for. 0 if the goal is on the same island.
    pub(super) fn elevator_bound(&self) -> Us {
        let island = self.network.island[self.query.start as usize];
        let goal = self.query.goal as usize;
        if self.network.island[goal] == island || self.network.is_elevator(self.query.start) {
            return 0;
        }
        self.network.rides_off(island).map(|ride| self.arrival_over(ride)).min().unwrap_or(0)
    }

    /// A lower bound of the arrival at the goal over a ride (weighted as all estimates).
    fn arrival_over(&self, ride: &Ride) -> Us {
        let network = self.network;
        let headings = 0..network.heading_count() as u8;
        let to_go = headings.clone().filter_map(|heading| self.to_go(ride.to, heading)).min();
        let Some(to_go) = to_go else { return FOREVER };
        let shortest = |metres: Option<f64>| metres.unwrap_or(0.0);
        let before = headings.clone().flat_map(|h| network.behind(ride.from, h));
        let entering = shortest(before.map(|edge| edge.1).min_by(f64::total_cmp));
        let behind = headings.filter_map(|h| network.ahead(ride.to, h));
        let leaving = shortest(behind.map(|edge| edge.1).min_by(f64::total_cmp));
        let kind = self.query.kind;
        let (enter, leave) = (
            at_least(kind, kind.deceleration, entering),
            at_least(kind, kind.acceleration, leaving),
        );
        // the shaft is the robot's from leaving the waypoint before to reaching the one behind
        let reached = self.query.ready + self.straight_to(ride.from);
        let shaft = network.resource[ride.from as usize];
        for (from, until) in self.table.gaps(shaft) {
            let departure = reached.max(from + enter);
            if departure + ride.travel + leave <= until {
                return departure + ride.travel + to_go * self.weight / 4;
            }
        }
        FOREVER
    }

    /// A lower bound of the time from the start to rest at a waypoint.
    fn straight_to(&self, node: u32) -> Us {
        if !self.network.axis_parallel {
            return 0;
        }
        let (x, y) = self.network.position(self.query.start);
        let (to_x, to_y) = self.network.position(node);
        let run = |metres: f64| self.query.model.run(metres).saturating_sub(1);
        Us::from(run((to_x - x).abs()) + run((to_y - y).abs()))
    }
}

/// The least time for the last metres before a stop, or for the first after it.
fn at_least(kind: &Kind, rate: f64, metres: f64) -> Us {
    let top = kind.top_speed;
    let ramp = top * top / (2.0 * rate);
    let seconds = if metres <= ramp {
        (2.0 * metres / rate).sqrt()
    } else {
        (metres - ramp) / top + top / rate
    };
    floor_us(seconds)
}
