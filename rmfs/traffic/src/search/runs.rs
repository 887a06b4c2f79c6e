//! Successors of a label: straight runs with exact departure times, and elevator rides.

use crate::network::NONE;
use crate::units::{FOREVER, Us, ceil_us, floor_us};

use super::{Label, Search};

impl<const GUIDED: bool> Search<'_, GUIDED> {
    /// Offers the useful stops of a straight run in one direction whose total time lies between
    /// what was scanned before and `upto`. Returns the least total time beyond, or `beyond` if that
    /// is less.
    pub(super) fn drive(
        &mut self,
        parent: u32,
        label: &Label,
        heading: u8,
        upto: Us,
        mut beyond: Us,
    ) -> Us {
        let network = self.network;
        let ready = label.arrival + Us::from(self.query.model.turning(label.heading, heading));
        if ready > label.until {
            return beyond;
        }
        self.memory.stable.clear();
        self.memory.stable.push((ready, label.until));
        self.memory.line.clear();
        self.memory.line.push((label.node, 0.0));
        let mut settled = 0;
        let mut here = (label.node, 0.0);
        let mut extra = label.extra;
        let mut nearest = Us::MAX;
        while let Some((next, length)) = network.ahead(here.0, heading) {
            if !self.may_enter(here.0, next) {
                break;
            }
            extra += self.extra(here.0, heading);
            here = (next, here.1 + length);
            let arrival = ready + Us::from(self.query.model.run(here.1));
            let straight = self.straight_to_goal(next);
            if self.nothing_ahead((arrival, extra), straight, nearest, upto.max(beyond)) {
                break;
            }
            nearest = straight;
            self.memory.line.push(here);
            if let Some(to_go) = self.to_go(next, heading) {
                let estimate = self.estimate(next, arrival, to_go) + extra;
                if self.is_too_late((next, heading), arrival, to_go) {
                    // of no use, now or later
                } else if estimate > upto {
                    beyond = beyond.min(estimate);
                } else if estimate > label.scanned
                    && (label.until < FOREVER || self.is_useful_stop(next, heading))
                {
                    settled = self.settle(settled, label.until);
                    if self.memory.stable.is_empty() {
                        break;
                    }
                    self.stop(parent, label, heading, (settled, extra));
                }
            }
            if self.query.loaded && network.storage[next as usize] {
                break;
            }
        }
        beyond
    }

    /// Whether no stop from here on along a line can be reached so soon that its total time is below
    /// `bound`. `reached`: time and extra cost here; `straight` and `nearest`: lower bounds of the
    /// time to the goal from here and from the waypoint before.
    fn nothing_ahead(&self, reached: (Us, Us), straight: Us, nearest: Us, bound: Us) -> bool {
        let (arrival, extra) = reached;
        // once the line leads away from the goal, it does so to its end
        let to_go = if straight >= nearest { straight } else { 0 };
        arrival + to_go * self.weight / 4 + extra >= bound || arrival + to_go > self.latest
    }

    fn may_enter(&self, from: u32, to: u32) -> bool {
        self.network.may_enter(from, to, self.query.goal, self.query.loaded)
            || (self.is_goal(to) && !self.network.is_closed(to))
    }

    /// Whether stopping at a waypoint can be useful: it is the goal, the robot can turn there, it
    /// is an elevator, or traffic ahead makes it a waiting place. (If the robot cannot stay
    /// indefinitely before the run, every stop can be useful.)
    fn is_useful_stop(&self, node: u32, heading: u8) -> bool {
        let network = self.network;
        let leads_on = |other: u8| {
            let Some((next, _)) = network.ahead(node, other) else { return false };
            if other == heading {
                !self.table.row(network.resource[next as usize]).is_empty()
            } else {
                self.may_enter(node, next)
            }
        };
        self.is_goal(node)
            || network.is_elevator(node)
            || (0..network.heading_count() as u8).any(leads_on)
    }

    /// Restricts the departures by the reservations of those waypoints of the line that a robot
    /// stopping at its end passes before it brakes: these restrict all longer runs as well.
    /// `settled` of
    /// them have been applied before; returns how many have been now.
    fn settle(&mut self, mut settled: usize, until: Us) -> usize {
        let (network, kind) = (self.network, self.query.kind);
        let memory = &mut *self.memory;
        let last = memory.line.len() - 1;
        let total = memory.line[last].1;
        if total < kind.run_up() + kind.braking() {
            return settled;
        }
        let brakes_at = total - kind.braking();
        while settled < last && memory.line[settled + 1].1 <= brakes_at {
            let leave = ceil_us(kind.unbraked(memory.line[settled + 1].1));
            if settled == 0 {
                leave_by(&mut memory.stable, until - leave);
            } else {
                let enter = floor_us(kind.unbraked(memory.line[settled - 1].1));
                let resource = network.resource[memory.line[settled].0 as usize];
                self.table.restrict(resource, enter, leave, &mut memory.stable);
            }
            if memory.stable.is_empty() {
                break;
            }
            settled += 1;
        }
        settled
    }

    /// Offers a stop at the end of the line, one label per free interval there; the extra cost of
    /// the way up to it is given.
    fn stop(&mut self, parent: u32, label: &Label, heading: u8, (settled, extra): (usize, Us)) {
        let network = self.network;
        let memory = &mut *self.memory;
        let last = memory.line.len() - 1;
        let (node, total) = memory.line[last];
        let profile = self.query.kind.run(total);
        memory.windows.clone_from(&memory.stable);
        for i in settled..last {
            let leave = ceil_us(profile.time_at(memory.line[i + 1].1));
            let resource = network.resource[memory.line[i].0 as usize];
            if i == 0 {
                leave_by(&mut memory.windows, label.until - leave);
            } else if !self.table.row(resource).is_empty() {
                let enter = floor_us(profile.time_at(memory.line[i - 1].1));
                self.table.restrict(resource, enter, leave, &mut memory.windows);
            }
            if memory.windows.is_empty() {
                return;
            }
        }
        let enter = floor_us(profile.time_at(memory.line[last - 1].1));
        let duration = ceil_us(profile.duration());
        for (from, until) in self.table.gaps(network.resource[node as usize]) {
            let fits = self.memory.windows.iter().find_map(|&(low, high)| {
                let departure = low.max(from - enter);
                (departure <= high && departure + duration <= until).then_some(departure)
            });
            if let Some(departure) = fits {
                self.offer(Label {
                    node,
                    heading,
                    ride: false,
                    dead: false,
                    from,
                    until,
                    extra,
                    arrival: departure + duration,
                    departure,
                    parent,
                    sibling: NONE,
                    scanned: -1,
                    scans: 0,
                });
            }
        }
    }

    /// Offers the elevator rides from a label; the shaft stays the robot's, so the interval stays.
    pub(super) fn ride(&mut self, parent: u32, label: &Label) {
        for ride in self.network.rides_from(label.node) {
            let arrival = label.arrival + ride.travel;
            if arrival <= label.until {
                self.offer(Label {
                    node: ride.to,
                    ride: true,
                    arrival,
                    departure: label.arrival,
                    parent,
                    sibling: NONE,
                    scanned: -1,
                    scans: 0,
                    ..label.clone()
                });
            }
        }
    }
}

/// Keeps the departures up to `latest`.
fn leave_by(windows: &mut Vec<(Us, Us)>, latest: Us) {
    windows.retain_mut(|window| {
        window.1 = window.1.min(latest);
        window.0 <= window.1
    });
}
