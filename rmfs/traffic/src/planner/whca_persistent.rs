//! WHCA*n: windowed cooperative A* whose reservations survive from call to call.
//!
//! After the non-volatile variant of Merschformann, Xie, Erdmann (2017): only robots that need a
//! plan get one, around the reservations of the others, and each plan ends where the robot can stay
//! indefinitely.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::reservations::{Interval, Table};
use crate::robot::Held;
use crate::search::{End, Move};
use crate::units::{FOREVER, Us};

use super::deadlock::Deadlocks;
use super::{Agent, Answer, Planner, Rhythm, Scene, rolling};

/// The planner and its parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct WhcaPersistent {
    pub rhythm: Rhythm,
    pub window: Us,
    /// Maximum number of labels per agent.
    pub labels: u64,
    pub deadlocks: Deadlocks,
    #[serde(skip)]
    pub table: Table,
    /// What the ways of earlier calls occupy, by robot.
    pub reserved: BTreeMap<u32, Vec<Held>>,
}

impl Planner for WhcaPersistent {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        let times = rolling::times(scene, agents);
        self.restore(scene, agents);
        let mut order: Vec<usize> = (0..agents.len()).filter(|&i| agents[i].needs_plan).collect();
        order.sort_by_key(|&index| {
            let agent = &agents[index];
            (!agent.loaded, rolling::to_go(scene, agent, &times[index]), agent.robot)
        });
        let mut answers = vec![Answer::Keep; agents.len()];
        for index in order {
            answers[index] = Answer::of(self.replan(scene, &agents[index], &times[index]));
        }
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

impl WhcaPersistent {
    /// Fills the table: granted reservations, then the ways that remain valid, then the starts of
    /// agents that need a new way.
    fn restore(&mut self, scene: &Scene, agents: &[Agent]) {
        rolling::block(scene, agents, &mut self.table);
        let mut reserved = std::mem::take(&mut self.reserved);
        for agent in agents.iter().filter(|agent| !agent.needs_plan) {
            if let Some(held) = reserved.remove(&agent.robot) {
                for held in &held {
                    self.add(scene, agent.robot, held);
                }
                self.reserved.insert(agent.robot, held);
            }
        }
        for agent in agents.iter().filter(|agent| agent.needs_plan) {
            self.hold_start(scene, agent);
        }
    }

    /// Reserves an occupation unless it conflicts with others.
    fn add(&mut self, scene: &Scene, robot: u32, held: &Held) {
        let start = held.start.max(scene.now);
        let others = self.table.row(held.resource).iter().filter(|taken| taken.robot != robot);
        let clashes = others.clone().any(|taken| taken.start < held.end && start < taken.end);
        if start < held.end && !clashes {
            self.table.cover(held.resource, Interval { start, end: held.end, robot });
        }
    }

    /// Reserves an agent's start from when it is ready to when somebody else has planned to pass.
    fn hold_start(&mut self, scene: &Scene, agent: &Agent) {
        let resource = scene.network.resource[agent.start as usize];
        let next = self.table.occupant(resource, agent.ready, FOREVER);
        let end = next.map_or(FOREVER, |next| next.start);
        if agent.ready < end {
            let interval = Interval { start: agent.ready, end, robot: agent.robot };
            self.table.cover(resource, interval);
        }
    }

    /// Releases what an agent holds after its committed run.
    fn release_start(&mut self, scene: &Scene, agent: &Agent) {
        let resource = scene.network.resource[agent.start as usize];
        self.table.remove(resource, agent.robot);
        let state = &scene.robots[agent.robot as usize];
        let committed = state.held.iter().filter(|held| held.resource == resource);
        for held in committed {
            let (start, end) = (held.start.max(scene.now), held.end.min(agent.ready));
            if start < end {
                self.table.cover(resource, Interval { start, end, robot: agent.robot });
            }
        }
    }

    fn replan(&mut self, scene: &mut Scene, agent: &Agent, times: &[u32]) -> Option<Vec<Move>> {
        self.release_start(scene, agent);
        let end = End::WindowForGood(scene.now + self.window);
        let found =
            rolling::search(scene, &self.table, agent, agent.ready, times, end, self.labels);
        let Some(moves) = found.filter(|moves| !moves.is_empty()) else {
            // it stays, and whoever wanted to pass will be refused
            let resource = scene.network.resource[agent.start as usize];
            self.table
                .cover(resource, Interval { start: agent.ready, end: FOREVER, robot: agent.robot });
            return None;
        };
        let held = rolling::occupied(scene, agent, &moves, FOREVER);
        for held in &held {
            let interval = Interval { start: held.start, end: held.end, robot: agent.robot };
            self.table.insert(held.resource, interval, scene.now);
        }
        self.reserved.insert(agent.robot, held);
        Some(moves)
    }
}
