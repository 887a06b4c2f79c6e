//! BCP: biased cost pathfinding. Ways in space, whose conflicts make waypoints more expensive.
//!
//! Geramifard, Chubak, Bulitko (2006), in the form of Merschformann, Xie, Erdmann (2017): each agent
//! takes its quickest way; where it conflicts with one planned before, the waypoint becomes more
//! expensive for this agent alone, the agent stops before it, and the next round begins.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::reservations::{Interval, Table};
use crate::search::Move;
use crate::units::{FOREVER, Us};

use super::deadlock::{Deadlocks, run};
use super::rolling::Clash;
use super::{Agent, Answer, Planner, Rhythm, Scene, rolling};

/// The planner and its parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Bcp {
    pub rhythm: Rhythm,
    /// Cost in metres, at top speed, that a conflict adds to a waypoint.
    pub bias: f64,
    /// Rounds per call.
    pub rounds: u32,
    pub deadlocks: Deadlocks,
    #[serde(skip)]
    pub table: Table,
}

impl Planner for Bcp {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        let times = rolling::times(scene, agents);
        let mut dearer = vec![BTreeMap::new(); agents.len()];
        let mut ways: Vec<Option<Vec<Move>>> = Vec::new();
        for (agent, times) in agents.iter().zip(&times) {
            ways.push(quickest(scene, agent, times, &BTreeMap::new()));
        }
        let mut clashes = self.clashes(scene, agents, &ways);
        for _ in 1..self.rounds {
            if clashes.is_empty() {
                break;
            }
            // the ways of all others are as they were
            for (index, clash) in clashes {
                let agent = &agents[index];
                self.make_dearer(scene, agent, &clash, &mut dearer[index]);
                ways[index] = quickest(scene, agent, &times[index], &dearer[index]);
            }
            clashes = self.clashes(scene, agents, &ways);
        }
        for (index, clash) in clashes {
            let Some(way) = &ways[index] else { continue };
            if let Some(stopping) = stop_before(scene, &agents[index], way, &clash, &times[index]) {
                ways[index] = Some(stopping);
            }
        }
        let mut answers: Vec<Answer> = ways.into_iter().map(Answer::of).collect();
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

impl Bcp {
    /// Plans in which every agent stays where it stops next, in case no way is free.
    fn hold_start(&mut self, scene: &Scene, agent: &Agent) {
        let resource = scene.network.resource[agent.start as usize];
        let next = self.table.occupant(resource, agent.ready, FOREVER);
        let end = next.map_or(FOREVER, |next| next.start);
        if agent.ready < end {
            let interval = Interval { start: agent.ready, end, robot: agent.robot };
            self.table.insert(resource, interval, scene.now);
        }
    }

    /// Reserves ways one after another if they are free; returns the agents whose ways are not, and
    /// where these conflict.
    fn clashes(
        &mut self,
        scene: &mut Scene,
        agents: &[Agent],
        ways: &[Option<Vec<Move>>],
    ) -> Vec<(usize, Clash)> {
        rolling::block(scene, agents, &mut self.table);
        agents.iter().for_each(|agent| self.hold_start(scene, agent));
        let mut found = Vec::new();
        for (index, (agent, way)) in agents.iter().zip(ways).enumerate() {
            let Some(moves) = way else { continue };
            if let Some(clash) = rolling::clash(scene, &self.table, agent, moves) {
                found.push((index, clash));
                continue;
            }
            for held in rolling::occupied(scene, agent, moves, FOREVER) {
                let interval = Interval { start: held.start, end: held.end, robot: agent.robot };
                self.table.cover(held.resource, interval);
            }
        }
        found
    }

    /// Makes the waypoint of an agent's conflict more expensive for this agent.
    fn make_dearer(
        &self,
        scene: &Scene,
        agent: &Agent,
        clash: &Clash,
        dearer: &mut BTreeMap<u32, Us>,
    ) {
        let pace = scene.costs.models[agent.kind as usize].pace;
        *dearer.entry(clash.node).or_insert(0) += (self.bias * pace) as Us;
    }
}

/// The quickest way of an agent, including the costs of conflicts.
fn quickest(
    scene: &Scene,
    agent: &Agent,
    times: &[u32],
    dearer: &BTreeMap<u32, Us>,
) -> Option<Vec<Move>> {
    let penalty = |node: u32| Some(dearer.get(&node).copied().unwrap_or(0));
    rolling::way(scene, agent, &[], agent.ready, times, penalty)
}

/// The way with a stop before the waypoint of the conflict; `None` if that is its next one.
fn stop_before(
    scene: &Scene,
    agent: &Agent,
    moves: &[Move],
    clash: &Clash,
    times: &[u32],
) -> Option<Vec<Move>> {
    let step = &moves[clash.step];
    let mut way = moves[..clash.step].to_vec();
    let line = scene.network.line(step.from, step.to, step.heading);
    if let Some((to, length)) = line.take_while(|at| at.0 != clash.node).last() {
        let from = Agent {
            start: step.from,
            heading: step.heading_before,
            ready: way.last().map_or(agent.ready, |last: &Move| last.end),
            ..agent.clone()
        };
        way.push(run(scene, &from, step.heading, to, length));
    }
    if way.is_empty() {
        return None;
    }
    let rest = rolling::way(scene, agent, &way, 0, times, |_| Some(0))?;
    way.extend(rest);
    Some(way)
}
