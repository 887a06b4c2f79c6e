//! FAR: flow annotation replanning. One straight hop at a time along the way in space.
//!
//! Wang, Botea (2008), in the form of Merschformann, Xie, Erdmann (2017): the one-way aisles of the
//! layout replace the flow annotation. A robot that is blocked for too long, or in a cycle of
//! robots that wait for each other, evades by another way or to a neighbouring waypoint.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::network::NONE;
use crate::search::Move;
use crate::units::Us;

use super::deadlock::{Deadlocks, run};
use super::rolling::Clash;
use super::{Agent, Answer, Planner, Rhythm, Scene, rolling};

/// How a robot gets out of the way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Evasion {
    /// By a way around the waypoint that blocks it.
    Reroute,
    /// To a random free neighbour, and on from there.
    NextNode,
}

/// The planner and its parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Far {
    pub rhythm: Rhythm,
    pub evasion: Evasion,
    /// Time for which a robot waits before it evades in any case.
    pub patience: Us,
    /// Time for which an evading robot stays where it evaded to, and a blocked one where it is.
    pub wait: Us,
    /// Whether a robot evades to each waypoint at most once before it makes progress.
    pub avoids_evading_back: bool,
    pub deadlocks: Deadlocks,
    pub memory: BTreeMap<u32, Memory>,
}

/// State of a robot between calls.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Memory {
    goal: u32,
    waits_for: u32,
    waits_until: Us,
    moved: Us,
    evaded_to: Vec<u32>,
}

impl Planner for Far {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        let times = rolling::times(scene, agents);
        let standing: Vec<u32> = agents.iter().map(|agent| agent.robot).collect();
        self.memory.retain(|robot, _| standing.contains(robot));
        let mut answers = vec![Answer::Keep; agents.len()];
        for (index, agent) in agents.iter().enumerate() {
            if agent.needs_plan && agent.ready <= scene.now {
                answers[index] = self.hop(scene, agent, &times[index]);
            }
        }
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

impl Far {
    /// The next hop of an agent at rest.
    fn hop(&mut self, scene: &Scene, agent: &Agent, times: &[u32]) -> Answer {
        let fresh = Memory {
            goal: agent.goal,
            waits_for: NONE,
            waits_until: 0,
            moved: scene.now,
            evaded_to: Vec::new(),
        };
        let known = self.memory.remove(&agent.robot).filter(|known| known.goal == agent.goal);
        let mut memory = known.unwrap_or(fresh);
        if memory.waits_until > scene.now {
            self.memory.insert(agent.robot, memory);
            return Answer::Keep;
        }
        let way = rolling::way(scene, agent, &[], agent.ready, times, |_| Some(0));
        let tried = way.as_ref().map(|way| first_hop(scene, agent, way));
        let answer = match tried {
            Some(Ok(moves)) if !memory.evaded_to.contains(&moves[0].to) => {
                memory.moved = scene.now;
                memory.evaded_to.clear();
                memory.waits_for = NONE;
                Answer::Way(moves)
            }
            other => {
                let obstacle = other.and_then(Result::err);
                memory.waits_for = obstacle.as_ref().map_or(NONE, |obstacle| obstacle.owner);
                let evades = way.is_none()
                    || obstacle.is_none()
                    || scene.now - memory.moved > self.patience
                    || self.waits_in_a_circle(agent.robot, memory.waits_for);
                let evasive = if evades {
                    self.evade(scene, agent, times, obstacle, &mut memory)
                } else {
                    None
                };
                match evasive {
                    Some(moves) => Answer::Way(moves),
                    None => {
                        memory.waits_until = scene.now + self.wait;
                        if way.is_some() { Answer::Keep } else { Answer::NoWay }
                    }
                }
            }
        };
        self.memory.insert(agent.robot, memory);
        answer
    }

    /// Whether the robots that wait for each other lead from `owner` back to `robot`.
    fn waits_in_a_circle(&self, robot: u32, owner: u32) -> bool {
        let mut at = owner;
        for _ in 0..=self.memory.len() {
            if at == robot {
                return true;
            }
            match self.memory.get(&at) {
                Some(memory) => at = memory.waits_for,
                None => return false,
            }
        }
        false
    }

    fn evade(
        &mut self,
        scene: &Scene,
        agent: &Agent,
        times: &[u32],
        obstacle: Option<Clash>,
        memory: &mut Memory,
    ) -> Option<Vec<Move>> {
        match self.evasion {
            Evasion::Reroute => {
                let closed = obstacle?.node;
                let open = |node: u32| (node != closed).then_some(0);
                let way = rolling::way(scene, agent, &[], agent.ready, times, open)?;
                let hop = first_hop(scene, agent, &way).ok()?;
                memory.moved = scene.now;
                Some(hop)
            }
            Evasion::NextNode => {
                let avoided = if self.avoids_evading_back { &memory.evaded_to[..] } else { &[] };
                let allowed = |node: u32| !avoided.contains(&node);
                let Some(hop) = self.deadlocks.hop(scene, agent, allowed) else {
                    memory.evaded_to.clear();
                    return None;
                };
                memory.evaded_to.push(hop.to);
                memory.moved = scene.now;
                memory.waits_until = hop.end + self.wait;
                Some(vec![hop])
            }
        }
    }
}

/// The part of the first straight run of a way that is free at once, to a place where the robot can
/// stay (a run onto an elevator with the ride and the run off it); or what blocks its first edge.
fn first_hop(scene: &Scene, agent: &Agent, way: &[Move]) -> Result<Vec<Move>, Clash> {
    let network = scene.network;
    let outside = way.iter().position(|step| !network.is_elevator(step.to));
    let whole = &way[..=outside.unwrap_or(0)];
    let line: Vec<(u32, f64)> = network.line(way[0].from, way[0].to, way[0].heading).collect();
    let Some(blocked) = rolling::clash(scene, scene.table, agent, whole) else {
        return Ok(whole.to_vec());
    };
    let mut stops = if whole.len() > 1 { line.len() - 1 } else { line.len() };
    let mut obstacle = blocked;
    loop {
        stops = stops.min(line.iter().position(|at| at.0 == obstacle.node).unwrap_or(stops));
        let Some(&(to, length)) = stops.checked_sub(1).map(|last| &line[last]) else {
            return Err(obstacle);
        };
        let hop = vec![run(scene, agent, way[0].heading, to, length)];
        match rolling::clash(scene, scene.table, agent, &hop) {
            None => return Ok(hop),
            // what no shorter run would keep clear of
            Some(clash) if line[..stops].iter().all(|at| at.0 != clash.node) => return Err(clash),
            Some(clash) => obstacle = clash,
        }
    }
}
