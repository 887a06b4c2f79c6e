//! Resolution of deadlocks as in RAWSim-O: a robot that has stood still for too long hops to a
//! random neighbour.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::random::Random;
use crate::search::Move;
use crate::units::Us;

use super::{Agent, Answer, Scene};

/// Position and goal of each agent, and the time since which it has been standing there.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Deadlocks {
    /// Time for which a robot stands still before it hops.
    pub patience: Us,
    standing: BTreeMap<u32, (u32, Us)>,
    random: Random,
}

impl Deadlocks {
    /// Initial state, in which no agent stands.
    pub fn new(patience: Us, seed: u64) -> Self {
        Self { patience, standing: BTreeMap::new(), random: Random::new(seed) }
    }

    /// Records the positions of agents, and replaces the ways of those that have stood still for
    /// too long.
    pub fn resolve(&mut self, scene: &Scene, agents: &[Agent], answers: &mut [Answer]) {
        let mut standing = BTreeMap::new();
        for (agent, answer) in agents.iter().zip(answers) {
            if agent.ready > scene.now {
                continue;
            }
            let known = self.standing.get(&agent.robot).filter(|known| known.0 == agent.start);
            let mut since = known.map_or(scene.now, |known| known.1);
            if scene.now - since > self.patience
                && let Some(hop) = self.hop(scene, agent, |_| true)
            {
                *answer = Answer::Way(vec![hop]);
                since = scene.now;
            }
            standing.insert(agent.robot, (agent.start, since));
        }
        self.standing = standing;
    }

    /// A run to a random free neighbour.
    pub fn hop(
        &mut self,
        scene: &Scene,
        agent: &Agent,
        allowed: impl Fn(u32) -> bool,
    ) -> Option<Move> {
        let network = scene.network;
        let headings = 0..network.heading_count() as u8;
        let neighbours: Vec<(u8, u32, f64)> = headings
            .filter_map(|heading| {
                let (next, length) = network.ahead(agent.start, heading)?;
                let enters = network.may_enter(agent.start, next, agent.goal, agent.loaded);
                let held = scene.table.final_holder(network.resource[next as usize]);
                (enters && held.is_none() && !network.is_elevator(next) && allowed(next))
                    .then_some((heading, next, length))
            })
            .collect();
        let &(heading, next, length) = self.random.choose(&neighbours)?;
        Some(run(scene, agent, heading, next, length))
    }
}

/// A run that an agent starts as soon as it is ready.
pub fn run(scene: &Scene, agent: &Agent, heading: u8, to: u32, length: f64) -> Move {
    let kind = &scene.kinds[agent.kind as usize];
    let model = &scene.costs.models[agent.kind as usize];
    let start = agent.ready + Us::from(model.turning(agent.heading, heading));
    Move {
        from: agent.start,
        to,
        heading,
        heading_before: agent.heading,
        start,
        end: start + kind.run_time(length),
        ride: false,
        late: 0,
        begun: 0,
    }
}
