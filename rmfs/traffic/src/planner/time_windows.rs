//! Prioritised planning over continuous time windows: first come, first served, and complete.

use serde::{Deserialize, Serialize};

use crate::network::Network;
use crate::reservations::Table;
use crate::search::{End, Guide, Move, Outcome, Pathfinder, Query};
use crate::units::{FOREVER, Us};

use super::{Agent, Answer, Planner, Rhythm, Scene};

/// Plans each leg once around the windows that others have reserved.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct TimeWindows {
    /// Labels a search may look at before the robot waits until all planned motion is over.
    pub budget: u64,
    /// Labels for each robot of a group when plans are to be improved; 0 for never.
    pub improvement: u64,
    /// How to find ways sooner that may be a little later than the earliest.
    pub swift: Option<Swift>,
}

/// A search: the weight of the time to go (in quarters: 4 finds the earliest arrival), and labels.
type Effort = (Us, u64);

/// Searches with few labels: at once; then from later and later departures, since waiting at the
/// start is always free and the traffic ahead passes; without success with more labels.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Swift {
    pub first: Effort,
    /// Each search from a later departure.
    pub later: Effort,
    /// By how much the first of them is later; each further one by twice as much as the one before.
    pub wait: Us,
    /// From the earliest departure again, if none of them found a way.
    pub last: [Effort; 2],
    /// Unhindered times are searched for only near the best way.
    pub guide: Guide,
    /// Plans that need not be: labels, and how much later than unhindered they may arrive.
    pub labels_to_try: u64,
    pub detour_to_try: Us,
}

impl Swift {
    /// What has been found to pay for hundreds of robots (`docs/traffic.md`, Scale).
    pub const FOR_BIG_FLEETS: Self = Self {
        first: (5, 400),
        later: (6, 200),
        wait: 5_000_000,
        last: [(6, 2_000), (16, u64::MAX)],
        guide: Guide::Near(3_000_000),
        labels_to_try: 100,
        detour_to_try: 20_000_000,
    };

    /// Looks for a way. `until` is when the robot has to have left its start; `needed` says whether
    /// it has to have a plan.
    fn search(
        &self,
        pathfinder: &mut Pathfinder,
        network: &Network,
        table: &Table,
        query: &Query,
        until: Us,
        needed: bool,
    ) -> Outcome {
        let mut query = Query { guide: self.guide, ..query.clone() };
        let Some(unhindered) = pathfinder.aim(network, &query) else { return Outcome::NoWay };
        let (weight, labels) = self.first;
        if !needed {
            query.detour = self.detour_to_try;
            let labels = self.labels_to_try.min(query.budget);
            return pathfinder.seek(network, table, &query, weight, labels);
        }
        let earliest = query.ready;
        // who would have to wait for the goal to be free starts in time for that
        let row = table.row(network.resource[query.goal as usize]);
        let goal_free = row.last().map_or(0, |last| last.end);
        let in_time = earliest.max(goal_free - unhindered - self.wait);
        query.ready = if in_time < until { in_time } else { earliest };
        let mut outcome = pathfinder.seek(network, table, &query, weight, labels.min(query.budget));
        if outcome == Outcome::OutOfBudget {
            let last = until.min(table.horizon());
            let mut wait = self.wait;
            let (weight, labels) = self.later;
            while outcome == Outcome::OutOfBudget && query.ready + wait < last {
                query.ready += wait;
                wait *= 2;
                outcome = pathfinder.seek(network, table, &query, weight, labels.min(query.budget));
            }
        }
        // that no way leaves later does not say that none leaves now
        let mut starved = outcome == Outcome::NoWay && query.ready > earliest;
        query.ready = earliest;
        for (weight, labels) in self.last {
            if outcome == Outcome::OutOfBudget || std::mem::take(&mut starved) {
                outcome = pathfinder.seek(network, table, &query, weight, labels.min(query.budget));
            }
        }
        outcome
    }
}

impl TimeWindows {
    fn plan_one(&self, scene: &mut Scene, agent: &Agent) -> Option<Vec<Move>> {
        let mut query = Query {
            start: agent.start,
            heading: agent.heading,
            ready: agent.ready,
            goal: agent.goal,
            loaded: agent.loaded,
            kind: &scene.kinds[agent.kind as usize],
            model: &scene.costs.models[agent.kind as usize],
            budget: self.budget.min(agent.effort),
            end: End::ForGood,
            detour: FOREVER,
            guide: Guide::Exact,
            times: None,
        };
        let Scene { network, table, pathfinder, .. } = scene;
        let needed = agent.effort == u64::MAX;
        let (_, until) = table.gap_at(network.resource[agent.start as usize], agent.ready)?;
        let mut outcome = match &self.swift {
            Some(swift) => swift.search(pathfinder, network, table, &query, until, needed),
            None => pathfinder.search(network, table, &query),
        };
        if outcome == Outcome::OutOfBudget && needed {
            // with every planned motion over, the search is an ordinary shortest path
            query.ready = query.ready.max(table.horizon());
            query.budget = u64::MAX;
            if until > query.ready {
                outcome = pathfinder.search(network, table, &query);
            }
        }
        match outcome {
            Outcome::Found(moves) => Some(moves),
            Outcome::NoWay | Outcome::OutOfBudget => None,
        }
    }
}

impl Planner for TimeWindows {
    fn rhythm(&self) -> Rhythm {
        Rhythm::PerLeg
    }

    fn improvement(&self) -> u64 {
        self.improvement
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        agents.iter().map(|agent| Answer::of(self.plan_one(scene, agent))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::costs::Cache;
    use crate::kinematics::Kind;
    use crate::network::Plan;
    use crate::reservations::Interval;

    const KIND: Kind = Kind {
        acceleration: 0.5,
        deceleration: 0.5,
        top_speed: 1.5,
        full_turn: 2_500_000,
        pod_transfer: 3_000_000,
    };

    /// Six waypoints in a row, a metre apart: unhindered, the way from end to end takes 19/3 s.
    fn row() -> Network {
        let edges: Vec<Vec<u32>> =
            (0..6u32).map(|v| (0..6).filter(|w| v.abs_diff(*w) == 1).collect()).collect();
        let starts = edges.iter().scan(0, |at, targets| {
            *at += targets.len() as u32;
            Some(*at)
        });
        Network::new(Plan {
            x: (0..6).map(f64::from).collect(),
            y: vec![0.0; 6],
            tier: vec![0; 6],
            edge_start: std::iter::once(0).chain(starts).collect(),
            edge_target: edges.concat(),
            storage: vec![false; 6],
            queue: vec![false; 6],
            ..Plan::default()
        })
        .expect("a row")
    }

    /// Plans from one end of the row to the other, ready at 0, around what others hold of a
    /// waypoint: its number, from and until (in seconds).
    fn plan(swift: Option<Swift>, others: &[(u32, Us, Us)]) -> Option<Vec<Move>> {
        let network = row();
        let mut table = Table::new(network.resources);
        for &(node, from, until) in others {
            let end = if until == FOREVER { FOREVER } else { until * 1_000_000 };
            table.insert(node, Interval { start: from * 1_000_000, end, robot: 1 }, -1);
        }
        let kinds = [KIND];
        let mut planner = TimeWindows { budget: 50_000, improvement: 0, swift };
        let agent = Agent {
            robot: 0,
            kind: 0,
            start: 0,
            heading: 0,
            ready: 0,
            goal: 5,
            loaded: false,
            effort: u64::MAX,
            needs_plan: true,
        };
        let mut scene = Scene {
            now: 0,
            network: &network,
            kinds: &kinds,
            robots: &[],
            table: &table,
            pathfinder: &mut Pathfinder::new(&network),
            costs: &mut Cache::new(&network, &kinds, 1_000_000),
        };
        match planner.plan(&mut scene, &[agent]).pop() {
            Some(Answer::Way(moves)) => Some(moves),
            _ => None,
        }
    }

    fn end(moves: &[Move]) -> Us {
        moves[moves.len() - 1].end
    }

    #[test]
    fn swift_ways_are_the_same_where_nobody_is() {
        let moves = plan(Some(Swift::FOR_BIG_FLEETS), &[]).expect("a way");
        assert_eq!(moves, plan(None, &[]).expect("a way"));
        assert_eq!(end(&moves), 6_333_334);
    }

    #[test]
    fn a_robot_starts_in_time_for_a_goal_that_becomes_free() {
        // the last waypoint is entered at the one before, after 13/3 s of the way
        let moves = plan(Some(Swift::FOR_BIG_FLEETS), &[(5, 0, 60)]).expect("a way");
        assert!(moves[0].start >= 60_000_000 - 6_333_334 - 5_000_000, "{}", moves[0].start);
        assert_eq!(end(&moves), end(&plan(None, &[(5, 0, 60)]).expect("a way")));
    }

    #[test]
    fn where_the_first_search_ends_without_a_way_the_next_departs_later() {
        let swift = Swift { first: (4, 1), ..Swift::FOR_BIG_FLEETS };
        // somebody is planned to be far from the way until 100 s
        let moves = plan(Some(swift), &[(3, 90, 100)]).expect("a way");
        assert_eq!((moves[0].start, end(&moves)), (5_000_000, 11_333_334));
    }

    #[test]
    fn a_way_that_is_closed_for_good_later_is_found_now() {
        // the third waypoint from the goal is held for good from 30 s on, the goal until 60 s
        let others = [(3, 30, FOREVER), (5, 0, 60)];
        let moves = plan(Some(Swift::FOR_BIG_FLEETS), &others).expect("a way");
        assert!(moves[0].start < 30_000_000 && end(&moves) >= 60_000_000);
        assert_eq!(end(&moves), end(&plan(None, &others).expect("a way")));
    }

    #[test]
    fn what_need_not_be_may_not_take_long() {
        let network = row();
        let mut table = Table::new(network.resources);
        table.insert(3, Interval { start: 0, end: 30_000_000, robot: 1 }, -1);
        let kinds = [KIND];
        let costs = Cache::new(&network, &kinds, 1_000_000);
        let query = Query {
            start: 0,
            heading: 0,
            ready: 0,
            goal: 5,
            loaded: false,
            kind: &KIND,
            model: &costs.models[0],
            budget: 300,
            end: End::ForGood,
            detour: FOREVER,
            guide: Guide::Exact,
            times: None,
        };
        let swift = Swift::FOR_BIG_FLEETS;
        let mut pathfinder = Pathfinder::new(&network);
        let mut tried =
            |needed| swift.search(&mut pathfinder, &network, &table, &query, FOREVER, needed);
        assert_eq!(tried(false), Outcome::NoWay);
        assert!(matches!(tried(true), Outcome::Found(_)));
    }
}
