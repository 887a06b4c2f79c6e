//! Prioritised planning over continuous time windows: first come, first served, and complete.

use crate::search::{End, Guide, Move, Outcome, Query};
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
            guide: if self.swift {
                Guide::Near(NEAR)
            } else {
                Guide::Exact
            },
            times: None,
        };
        let Scene { network, table, pathfinder, .. } = scene;
        let needed = agent.effort == u64::MAX;
        let mut outcome = Outcome::OutOfBudget;
        // until when the robot could stay where it is
        let stays = table.gap_at(network.resource[agent.start as usize], agent.ready);
        if self.swift {
            let unhindered = pathfinder.aim(network, &query)?;
            if !needed {
                query.detour = TRY.0;
                outcome = pathfinder.seek(network, table, &query, FIRST.0, TRY.1.min(agent.effort));
            } else {
                let until = stays?.1.min(table.horizon());
                let row = table.row(network.resource[agent.goal as usize]);
                let in_time = row.last().map_or(0, |last| last.end) - unhindered;
                if in_time < until {
                    query.ready = query.ready.max(in_time - FIRST_WAIT);
                }
                let first = query.ready;
                outcome = pathfinder.seek(network, table, &query, FIRST.0, FIRST.1);
                let mut wait = FIRST_WAIT;
                while outcome == Outcome::OutOfBudget && first + wait < until {
                    query.ready = first + wait;
                    outcome = pathfinder.seek(network, table, &query, LATER.0, LATER.1);
                    wait *= 2;
                }
                query.ready = agent.ready;
            }
        }
        if outcome == Outcome::OutOfBudget && (needed || !self.swift) {
            outcome = pathfinder.search(network, table, &query);
        }
        if outcome == Outcome::OutOfBudget && needed {
            // with every planned motion over, the search is an ordinary shortest path
            query.ready = query.ready.max(table.horizon());
            query.budget = u64::MAX;
            outcome = match stays {
                Some((_, until)) if until > query.ready => {
                    pathfinder.search(network, table, &query)
                }
                _ => Outcome::NoWay,
            };
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
