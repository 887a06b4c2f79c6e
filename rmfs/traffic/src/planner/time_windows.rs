//! Prioritised planning over continuous time windows: first come, first served, and complete.

use crate::search::{End, Move, Outcome, Query};

use super::{Agent, Answer, Planner, Rhythm, Scene};

/// Plans each leg once around the windows that others have reserved.
#[derive(Debug)]
pub struct TimeWindows {
    /// Labels a search may look at before the robot waits until all planned motion is over.
    pub budget: u64,
    /// Labels for each robot of a group when plans are to be improved; 0 for never.
    pub improvement: u64,
}

impl TimeWindows {
    fn plan_one(&self, scene: &mut Scene, agent: &Agent) -> Option<Vec<Move>> {
        let Scene { network, kinds, table, pathfinder, costs, .. } = scene;
        let mut query = Query {
            start: agent.start,
            heading: agent.heading,
            ready: agent.ready,
            goal: agent.goal,
            loaded: agent.loaded,
            kind: &kinds[agent.kind as usize],
            model: &costs.models[agent.kind as usize],
            budget: self.budget.min(agent.effort),
            end: End::ForGood,
            times: None,
        };
        let mut outcome = pathfinder.search(network, table, &query);
        if outcome == Outcome::OutOfBudget && agent.effort == u64::MAX {
            // with every planned motion over, the search is an ordinary shortest path
            let stays = table.gap_at(network.resource[agent.start as usize], agent.ready);
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
