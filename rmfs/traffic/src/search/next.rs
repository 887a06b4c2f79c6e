//! Next steps of a robot, single runs and rides, for planners that assemble ways piece by piece.

use crate::network::{NONE, Network};
use crate::reservations::Table;
use crate::units::Us;

use super::{Label, Move, Pathfinder, Query, Search};

/// A run or ride, and the time until which the robot can stay at its end.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stop {
    pub step: Move,
    pub until: Us,
}

impl Pathfinder {
    /// The stops that one run or ride leads to, each as early as a table allows; of the stops along
    /// a line, those that can be useful and from which the goal can be reached, by the given times,
    /// at most `slack` after the unhindered arrival.
    pub fn next_stops(
        &mut self,
        network: &Network,
        table: &Table,
        query: &Query,
        slack: Us,
    ) -> Vec<Stop> {
        match query.guidance {
            Some(_) => self.stops::<true>(network, table, query, slack),
            None => self.stops::<false>(network, table, query, slack),
        }
    }

    fn stops<const GUIDED: bool>(
        &mut self,
        network: &Network,
        table: &Table,
        query: &Query,
        slack: Us,
    ) -> Vec<Stop> {
        let mut search = Search::<GUIDED>::new(self, network, table, query, 4);
        let here = network.resource[query.start as usize];
        let free = table.gap_at(here, query.ready).filter(|gap| gap.1 > query.ready);
        let to_go = search.to_go(query.start, query.heading);
        let (Some((from, until)), Some(to_go)) = (free, to_go) else { return Vec::new() };
        search.offer(Label {
            node: query.start,
            heading: query.heading,
            ride: false,
            dead: false,
            from,
            until,
            extra: 0,
            arrival: query.ready,
            departure: query.ready,
            parent: NONE,
            sibling: NONE,
            scanned: -1,
            scans: 0,
        });
        search.look_at(0, query.ready + to_go + slack);
        let offered = self.labels.iter().skip(1).filter(|label| !label.dead);
        let step = |label: &Label| Move {
            from: query.start,
            to: label.node,
            heading: label.heading,
            heading_before: query.heading,
            start: label.departure,
            end: label.arrival,
            ride: label.ride,
            late: 0,
            begun: 0,
        };
        offered.map(|label| Stop { step: step(label), until: label.until }).collect()
    }
}
