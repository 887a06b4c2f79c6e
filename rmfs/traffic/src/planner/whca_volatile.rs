//! WHCA*v: windowed hierarchical cooperative A*, everything planned anew in every call.
//!
//! Silver (2005), in the kinematic form of Merschformann, Xie, Erdmann (2017). All agents are
//! planned one after another within a window, each around those before it. An agent that finds no
//! way gets a higher priority, and the round restarts.

use std::cmp::Reverse;

use serde::{Deserialize, Serialize};

use crate::reservations::Table;
use crate::search::{End, Move};
use crate::units::Us;

use super::deadlock::Deadlocks;
use super::{Agent, Answer, Planner, Rhythm, Scene, rolling};

/// The planner and its parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct WhcaVolatile {
    pub rhythm: Rhythm,
    pub window: Us,
    /// Unit of the time for which an agent of higher priority waits until others have left its way.
    pub wait: Us,
    /// Rounds per call; in the last one, agents without a way keep what they have.
    pub rounds: u32,
    /// Whether a round ends as soon as one agent finds no way.
    pub restart_at_once: bool,
    /// Maximum number of labels per agent.
    pub labels: u64,
    pub deadlocks: Deadlocks,
    #[serde(skip)]
    pub table: Table,
}

impl Planner for WhcaVolatile {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        let end = scene.now + self.window;
        let times = rolling::times(scene, agents);
        let mut priorities = vec![0; agents.len()];
        let mut plans = Vec::new();
        for round in 1..=self.rounds {
            let order = order(scene, agents, &times, &priorities);
            let gives_up = self.restart_at_once && round < self.rounds;
            let failed;
            (plans, failed) = self.round(scene, agents, &times, &priorities, &order, gives_up);
            if failed.is_empty() {
                break;
            }
            failed.iter().for_each(|&index| priorities[index] += 1);
        }
        for ((agent, plan), times) in agents.iter().zip(&mut plans).zip(&times) {
            if let Some(moves) = plan {
                rolling::append_rest(scene, agent, moves, end, times);
            }
        }
        let mut answers: Vec<Answer> = plans.into_iter().map(Answer::of).collect();
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

/// Ways of all agents, and the agents without one.
type Round = (Vec<Option<Vec<Move>>>, Vec<usize>);

impl WhcaVolatile {
    fn round(
        &mut self,
        scene: &mut Scene,
        agents: &[Agent],
        times: &[impl AsRef<[u32]>],
        priorities: &[u32],
        order: &[usize],
        gives_up: bool,
    ) -> Round {
        let end = scene.now + self.window;
        let mut plans = vec![None; agents.len()];
        let mut failed = Vec::new();
        rolling::block(scene, agents, &mut self.table);
        for &index in order {
            let (agent, times) = (&agents[index], times[index].as_ref());
            let steps = (1_i64 << priorities[index].min(10)) / 2;
            let ready = agent.ready + steps * self.wait;
            let start = scene.network.resource[agent.start as usize];
            let stays = self.table.occupant(start, agent.ready, ready).is_none();
            let found = stays.then(|| {
                let end = End::Window(end);
                rolling::search(scene, &self.table, agent, ready, times, end, self.labels)
            });
            if let Some(moves) = found.flatten() {
                rolling::reserve(scene, &mut self.table, agent, &moves, end);
                plans[index] = Some(moves);
            } else {
                failed.push(index);
                if gives_up {
                    break;
                }
            }
        }
        (plans, failed)
    }
}

/// Higher priority first, then loaded robots, then those with the shorter way.
fn order(
    scene: &Scene,
    agents: &[Agent],
    times: &[impl AsRef<[u32]>],
    priorities: &[u32],
) -> Vec<usize> {
    let mut order: Vec<usize> = (0..agents.len()).collect();
    order.sort_by_key(|&index| {
        let agent = &agents[index];
        let to_go = rolling::to_go(scene, agent, times[index].as_ref());
        (Reverse(priorities[index]), !agent.loaded, to_go, agent.robot)
    });
    order
}
