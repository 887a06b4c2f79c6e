//! Prioritised planning over continuous time windows: first come, first served, and complete.

use serde::{Deserialize, Serialize};

use crate::network::Network;
use crate::search::{End, Guide, Move, Outcome, Query};
use crate::units::FOREVER;

use super::swift::{Load, Swift, Urgency, Waiting};
use super::{Agent, Answer, Planner, Rhythm, Scene};

/// On floors with more waypoints, unhindered times are computed only on the best ways. On the others
/// this saves nothing: the search around reservations examines more labels, and the floor is soon
/// known.
const LARGE_FLOOR: usize = 4_000;

/// Plans each trip once around the windows that others have reserved.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct TimeWindows {
    /// Maximum number of labels of a search before the robot waits until all planned motion is
    /// over.
    pub budget: u64,
    /// Labels for each robot of a group when plans are improved; 0 for never.
    pub improvement: u64,
    /// Faster searches, whose ways may be slightly later than the earliest, if they are in use.
    pub swift: Option<Swift>,
    /// Mean number of labels per plan from which faster searches are used; 0 for never.
    pub swift_from: u64,
    pub load: Load,
    pub waiting: Waiting,
}

/// Returns which unhindered times are computed for the usual search. Both give the earliest arrival;
/// of several ways that arrive then, they may choose different ones.
fn guide_on(network: &Network) -> Guide {
    if network.largest_island > LARGE_FLOOR { Guide::Near(0) } else { Guide::Exact }
}

/// Whether a trip needs a ride. Such trips are left to the usual search: they wait for their elevator
/// for minutes, longer than the swift search looks ahead.
fn needs_ride(network: &Network, agent: &Agent) -> bool {
    network.island[agent.start as usize] != network.island[agent.goal as usize]
}

impl TimeWindows {
    fn plan_one(&mut self, scene: &mut Scene, agent: &Agent) -> Option<Vec<Move>> {
        let mut query = Query {
            start: agent.start,
            heading: agent.heading,
            ready: agent.ready,
            goal: agent.goal,
            loaded: agent.loaded,
            stored: &[],
            kind: &scene.kinds[agent.kind as usize],
            model: &scene.costs.models[agent.kind as usize],
            budget: self.budget.min(agent.effort),
            end: End::ForGood,
            detour: FOREVER,
            guide: guide_on(scene.network),
            times: None,
            guidance: scene.guidance,
        };
        let before = scene.pathfinder.expansions;
        let Scene { network, table, pathfinder, .. } = scene;
        let needed = agent.effort == u64::MAX;
        let rides = needs_ride(network, agent);
        let swift = self.swift.as_ref().filter(|_| !rides);
        let patient = needed && swift.is_some();
        let urgency = match (needed, patient) {
            (false, _) => Urgency::Try,
            (true, false) => Urgency::Whatever,
            (true, true) => self.waiting.urgency(agent.robot, agent.goal, scene.now)?,
        };
        let (_, until) = table.gap_at(network.resource[agent.start as usize], agent.ready)?;
        let mut outcome = match swift {
            Some(swift) => swift.search(pathfinder, network, table, &query, until, urgency),
            None => pathfinder.search(network, table, &query),
        };
        if outcome == Outcome::OutOfBudget && urgency == Urgency::Whatever {
            // with every planned motion over, the search is an ordinary shortest path
            query.ready = query.ready.max(table.horizon());
            query.budget = u64::MAX;
            if until > query.ready {
                outcome = pathfinder.search(network, table, &query);
            }
        }
        if needed && !rides && self.swift.is_none() && self.swift_from > 0 {
            let mean = self.load.count(pathfinder.expansions - before);
            self.swift = (mean >= self.swift_from).then_some(Swift::FOR_BIG_FLEETS);
        }
        if patient && outcome == Outcome::OutOfBudget {
            self.waiting.wait(agent.robot, agent.goal, scene.now);
        } else if patient {
            self.waiting.end(agent.robot);
        }
        match outcome {
            Outcome::Found(moves) => Some(moves),
            Outcome::NoWay | Outcome::OutOfBudget => None,
        }
    }
}

impl Planner for TimeWindows {
    fn rhythm(&self) -> Rhythm {
        Rhythm::PerTrip
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
    use crate::kinematics::tests::KIND;
    use crate::network::{Network, Plan};
    use crate::reservations::{Interval, Table};
    use crate::search::Pathfinder;
    use crate::units::Us;

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
        plan_by(&mut TimeWindows { budget: 50_000, swift, ..TimeWindows::default() }, others)
    }

    fn plan_by(planner: &mut TimeWindows, others: &[(u32, Us, Us)]) -> Option<Vec<Move>> {
        let network = row();
        let mut table = Table::new(network.resources);
        for &(node, from, until) in others {
            let end = if until == FOREVER { FOREVER } else { until * 1_000_000 };
            table.insert(node, Interval { start: from * 1_000_000, end, robot: 1 }, -1);
        }
        let kinds = [KIND];
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
            guidance: None,
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
        let swift = Swift { first: (4, 1), per_second: 0, ..Swift::FOR_BIG_FLEETS };
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
    fn plans_that_take_many_labels_make_it_swift() {
        let others = [(3, 0, 30)];
        let of = |swift_from| TimeWindows { budget: 50_000, swift_from, ..TimeWindows::default() };
        for (swift_from, is_swift) in [(0, false), (1, true), (300, false)] {
            let mut planner = of(swift_from);
            (0..300).for_each(|_| assert!(plan_by(&mut planner, &others).is_some()));
            assert_eq!(planner.swift.is_some(), is_swift, "from {swift_from} labels");
        }
    }

    /// From end to end of the row, with few labels.
    fn query(costs: &Cache) -> Query<'_> {
        Query {
            start: 0,
            heading: 0,
            ready: 0,
            goal: 5,
            loaded: false,
            stored: &[],
            kind: &KIND,
            model: &costs.models[0],
            budget: 300,
            end: End::ForGood,
            detour: FOREVER,
            guide: Guide::Exact,
            times: None,
            guidance: None,
        }
    }

    #[test]
    fn what_need_not_be_may_not_take_long() {
        let network = row();
        let mut table = Table::new(network.resources);
        table.insert(3, Interval { start: 0, end: 30_000_000, robot: 1 }, -1);
        let kinds = [KIND];
        let costs = Cache::new(&network, &kinds, 1_000_000);
        let query = query(&costs);
        let swift = Swift::FOR_BIG_FLEETS;
        let mut pathfinder = Pathfinder::new(&network);
        let mut tried =
            |urgency| swift.search(&mut pathfinder, &network, &table, &query, FOREVER, urgency);
        assert_eq!(tried(Urgency::Try), Outcome::NoWay);
        assert!(matches!(tried(Urgency::Soon), Outcome::Found(_)));
    }

    #[test]
    fn an_optional_way_to_a_goal_that_is_free_too_late_is_not_searched_for() {
        let network = row();
        let tried = |free_s: Us| {
            let mut table = Table::new(network.resources);
            table.insert(5, Interval { start: 0, end: free_s * 1_000_000, robot: 1 }, -1);
            let kinds = [KIND];
            let costs = Cache::new(&network, &kinds, 1_000_000);
            let query = query(&costs);
            let mut finder = Pathfinder::new(&network);
            let swift = Swift::FOR_BIG_FLEETS;
            let tried = swift.search(&mut finder, &network, &table, &query, FOREVER, Urgency::Try);
            (matches!(tried, Outcome::Found(_)), finder.expansions > 0)
        };
        // unhindered, the way takes 6.3 s; 20 s more are accepted
        assert_eq!(tried(20), (true, true));
        assert_eq!(tried(27), (false, false));
    }
}
