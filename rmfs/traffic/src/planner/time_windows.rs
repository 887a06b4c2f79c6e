//! Prioritised planning over continuous time windows: first come, first served, and complete.

use crate::network::Network;
use crate::reservations::Table;
use crate::search::{End, Guide, Move, Outcome, Pathfinder, Query};
use crate::units::{FOREVER, Us};

use super::{Agent, Answer, Planner, Rhythm, Scene};

/// Plans each leg once around the windows that others have reserved.
#[derive(Debug)]
pub struct TimeWindows {
    /// Labels a search may look at before the robot waits until all planned motion is over.
    pub budget: u64,
    /// Labels for each robot of a group when plans are to be improved; 0 for never.
    pub improvement: u64,
    /// For big fleets: ways a little later than the earliest, found sooner.
    pub swift: bool,
}

/// Swift: weight of the time to go (in quarters), and labels for the first search.
const FIRST: (Us, u64) = (5, 400);

/// Swift: the same for searches from a later departure.
const LATER: (Us, u64) = (6, 200);

/// Swift: by how much the first of them is later; each further one by twice as much.
const FIRST_WAIT: Us = 5_000_000;

/// Swift: of ways so much longer than the best the unhindered times are not searched for.
const NEAR: Us = 3_000_000;

/// Swift: how late a plan may be that need not be, and labels for it.
const TRY: (Us, u64) = (20_000_000, 100);

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
            guide: if self.swift { Guide::Near(NEAR) } else { Guide::Exact },
            times: None,
        };
        let Scene { network, table, pathfinder, .. } = scene;
        let needed = agent.effort == u64::MAX;
        // until when the robot can stay where it is
        let (_, until) = table.gap_at(network.resource[agent.start as usize], agent.ready)?;
        let mut outcome = Outcome::OutOfBudget;
        if self.swift {
            outcome = swiftly(pathfinder, network, table, &mut query, needed, until);
        }
        if outcome == Outcome::OutOfBudget && (needed || !self.swift) {
            outcome = pathfinder.search(network, table, &query);
        }
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

/// Looks for a way with few labels: at once; then, if the robot needs one, from later and later
/// departures, since waiting at the start is always free and traffic ahead passes.
fn swiftly(
    pathfinder: &mut Pathfinder,
    network: &Network,
    table: &Table,
    query: &mut Query,
    needed: bool,
    until: Us,
) -> Outcome {
    let Some(unhindered) = pathfinder.aim(network, query) else { return Outcome::NoWay };
    if !needed {
        query.detour = TRY.0;
        return pathfinder.seek(network, table, query, FIRST.0, TRY.1.min(query.budget));
    }
    let earliest = query.ready;
    // who would have to wait for the goal to be free starts in time for that
    let row = table.row(network.resource[query.goal as usize]);
    let goal_free = row.last().map_or(0, |last| last.end);
    let in_time = earliest.max(goal_free - unhindered - FIRST_WAIT);
    query.ready = if in_time < until { in_time } else { earliest };
    let mut outcome = pathfinder.seek(network, table, query, FIRST.0, FIRST.1);
    if outcome == Outcome::OutOfBudget {
        let last = until.min(table.horizon());
        let mut departure = query.ready + FIRST_WAIT;
        let mut step = FIRST_WAIT;
        while outcome == Outcome::OutOfBudget && departure < last {
            query.ready = departure;
            outcome = pathfinder.seek(network, table, query, LATER.0, LATER.1);
            departure += step;
            step *= 2;
        }
    }
    // that no way leaves later does not say that none leaves now
    let starved = outcome == Outcome::NoWay && query.ready > earliest;
    query.ready = earliest;
    if starved { Outcome::OutOfBudget } else { outcome }
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
