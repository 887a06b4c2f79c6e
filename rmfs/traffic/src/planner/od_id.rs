//! OD&ID: operator decomposition with independence detection.
//!
//! Standley (2010), in the form of Merschformann, Xie, Erdmann (2017). Agents are planned alone;
//! two groups whose ways conflict become one, which is planned jointly by an A* over the decisions
//! of all members, in which the member furthest behind in time decides next.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use serde::{Deserialize, Serialize};

use crate::patience::look_up;
use crate::reservations::Table;
use crate::robot::Held;
use crate::search::End;
use crate::units::Us;

use super::deadlock::Deadlocks;
use super::partial::Partial;
use super::{Agent, Answer, Planner, Rhythm, Scene, conflicts, rolling};

/// The planner and its parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct OdId {
    pub rhythm: Rhythm,
    pub window: Us,
    /// Duration of a wait.
    pub wait: Us,
    /// Maximum number of joint states per member of a group, and per call.
    pub nodes_per_agent: u64,
    pub nodes: u64,
    /// Number of runs among which a member chooses, the most promising ones.
    pub choices: usize,
    /// Maximum number of labels for a single agent.
    pub labels: u64,
    pub deadlocks: Deadlocks,
    #[serde(skip)]
    pub table: Table,
}

/// Decisions of the members of a group.
struct Joint {
    parts: Vec<Partial>,
}

impl Joint {
    /// Sum of the times at which members would arrive.
    fn cost(&self) -> Us {
        self.parts.iter().map(|part| part.time + part.to_go).sum()
    }

    fn to_go(&self) -> Us {
        self.parts.iter().map(|part| part.to_go).sum()
    }

    fn key(&self) -> Vec<(u32, u8, Us)> {
        self.parts.iter().map(|part| (part.node, part.heading, part.time)).collect()
    }
}

/// Times to the goals of all agents.
type Times = [std::sync::Arc<[u32]>];

impl Planner for OdId {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        let times = rolling::times(scene, agents);
        rolling::block(scene, agents, &mut self.table);
        let mut parts: Vec<Option<Partial>> = agents
            .iter()
            .zip(&times)
            .map(|(agent, times)| self.plan_alone(scene, agent, times))
            .collect();
        self.detect_dependence(scene, agents, &times, &mut parts);
        let mut answers = Vec::new();
        for ((agent, part), times) in agents.iter().zip(parts).zip(&times) {
            let way = part.map(|mut part| {
                rolling::append_rest(scene, agent, &mut part.moves, part.time, times);
                part.moves
            });
            answers.push(Answer::of(way));
        }
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

impl OdId {
    fn plan_alone(&self, scene: &mut Scene, agent: &Agent, times: &[u32]) -> Option<Partial> {
        let until = scene.now + self.window;
        let (ready, end) = (agent.ready, End::Window(until));
        let moves = rolling::search(scene, &self.table, agent, ready, times, end, self.labels)?;
        let mut part = Partial::begin(scene, agent, times)?;
        for step in moves {
            part = part.with(scene, step, times);
        }
        if part.node != agent.goal {
            part.time = part.time.max(until);
        }
        Some(part)
    }

    /// Joins groups whose ways conflict and plans them jointly, the first conflict first, until
    /// there is none or the limit of work is reached.
    fn detect_dependence(
        &mut self,
        scene: &mut Scene,
        agents: &[Agent],
        times: &Times,
        parts: &mut [Option<Partial>],
    ) {
        let until = scene.now + self.window;
        let occupied = |scene: &Scene, members: &[usize], parts: &[Option<Partial>]| {
            let of = |&index: &usize| match &parts[index] {
                Some(part) => part.occupied(scene, &agents[index], until),
                None => Vec::new(),
            };
            members.iter().flat_map(of).collect::<Vec<Held>>()
        };
        let mut groups: Vec<Vec<usize>> = (0..agents.len()).map(|index| vec![index]).collect();
        let mut held: Vec<Vec<Held>> =
            groups.iter().map(|members| occupied(scene, members, parts)).collect();
        let mut left = self.nodes;
        while left > 0 {
            let Some(conflict) = conflicts::first(held.iter().map(Vec::as_slice)) else { break };
            let [one, other] = conflict.agents;
            let joining = std::mem::take(&mut groups[other]);
            held[other].clear();
            groups[one].extend(joining);
            groups[one].sort_unstable();
            let members = groups[one].clone();
            let budget = left.min(self.nodes_per_agent * members.len() as u64);
            let (joint, used) = self.plan_jointly(scene, agents, times, &members, budget);
            left -= used.min(left);
            for (index, part) in members.iter().zip(joint.parts) {
                parts[*index] = Some(part);
            }
            held[one] = occupied(scene, &members, parts);
        }
    }

    /// The best joint state in which all members are done, or the one with the least remaining time
    /// when the limit of work is reached; and the number of states expanded.
    fn plan_jointly(
        &mut self,
        scene: &mut Scene,
        agents: &[Agent],
        times: &Times,
        members: &[usize],
        budget: u64,
    ) -> (Joint, u64) {
        let begin = |&index: &usize| {
            Partial::begin(scene, &agents[index], &times[index]).expect("it has been planned alone")
        };
        let root = Joint { parts: members.iter().map(begin).collect() };
        let mut known = BTreeSet::from([root.key()]);
        let mut open = BinaryHeap::from([Reverse((root.cost(), root.to_go(), 0))]);
        let mut states = vec![root];
        let mut nearest = (Us::MAX, 0);
        let mut used = 0;
        while let Some(Reverse((_, to_go, index))) = open.pop() {
            look_up();
            used += 1;
            nearest = nearest.min((to_go, index));
            let next = self.next_member(scene, agents, members, &states[index]);
            let Some(next) = next else { return (states.swap_remove(index), used) };
            if used >= budget {
                break;
            }
            for part in self.decide(scene, agents, times, members, &states[index], next) {
                let mut parts = states[index].parts.clone();
                parts[next] = part;
                let state = Joint { parts };
                if known.insert(state.key()) {
                    open.push(Reverse((state.cost(), state.to_go(), states.len())));
                    states.push(state);
                }
            }
        }
        (states.swap_remove(nearest.1), used)
    }

    /// The member that decides next: the one furthest behind of those not done.
    fn next_member(
        &self,
        scene: &Scene,
        agents: &[Agent],
        members: &[usize],
        state: &Joint,
    ) -> Option<usize> {
        let end = scene.now + self.window;
        let is_done = |at: &usize| {
            let part = &state.parts[*at];
            let rests = part.time >= end && !scene.network.is_elevator(part.node);
            rests || part.node == agents[members[*at]].goal
        };
        (0..members.len()).filter(|at| !is_done(at)).min_by_key(|&at| (state.parts[at].time, at))
    }

    /// The options of one member, given the decisions of the others.
    fn decide(
        &mut self,
        scene: &mut Scene,
        agents: &[Agent],
        times: &Times,
        members: &[usize],
        state: &Joint,
        member: usize,
    ) -> Vec<Partial> {
        let end = scene.now + self.window;
        let mut held = Vec::new();
        for (at, (index, part)) in members.iter().zip(&state.parts).enumerate() {
            if at != member {
                let agent = &agents[*index];
                let until = if part.node == agent.goal { end } else { part.time };
                held.extend(part.occupied(scene, agent, until));
            }
        }
        let before = rolling::overlay(&mut self.table, &held);
        let (agent, times) = (&agents[members[member]], &times[members[member]]);
        let part = &state.parts[member];
        let mut stops = part.next(scene, &self.table, agent, times, self.window);
        stops.retain(|stop| stop.step.to != agent.goal || stop.until >= end);
        stops.truncate(self.choices);
        let waits_until = part.time + self.wait;
        let waits = part.can_wait(scene, &self.table, waits_until);
        rolling::restore(&mut self.table, before);
        let waiting = waits.then(|| Partial { time: waits_until, ..part.clone() });
        let driving = stops.into_iter().map(|stop| part.with(scene, stop.step, times));
        driving.chain(waiting).collect()
    }
}
