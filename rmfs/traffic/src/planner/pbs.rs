//! PBS in a rolling horizon: repeated priority-based search for the next window.
//!
//! Ma, Harabor, Stuckey, Li, Koenig (2019); rolling horizon after RHCR (Li et al. 2021). A conflict
//! of two agents is resolved in two branches; in each, one has to plan around the other. The search
//! is depth-first, the cheaper branch first.

use std::rc::Rc;

use serde::{Deserialize, Serialize};

use crate::patience::look_up;
use crate::reservations::Table;
use crate::robot::Held;
use crate::search::{End, Move};
use crate::units::{FOREVER, Us};

use super::conflicts::{self, Conflict};
use super::deadlock::Deadlocks;
use super::{Agent, Answer, Planner, Rhythm, Scene, rolling};

/// The planner and its parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Pbs {
    pub rhythm: Rhythm,
    pub window: Us,
    /// Nodes of the priority tree that may be expanded in a call.
    pub nodes: u64,
    /// Maximum number of labels per agent.
    pub labels: u64,
    pub deadlocks: Deadlocks,
    #[serde(skip)]
    pub table: Table,
}

/// The way of one agent and what it occupies within the window.
struct Plan {
    moves: Vec<Move>,
    occupied: Vec<Held>,
    /// Unhindered time that remains at its end.
    arrival: Us,
}

/// A node of the priority tree.
#[derive(Clone)]
struct Node {
    /// Agents around which each agent has to plan directly.
    above: Vec<Vec<usize>>,
    plans: Vec<Option<Rc<Plan>>>,
    conflict: Option<Conflict>,
}

impl Node {
    fn find_conflict(&mut self) {
        let occupied = self.plans.iter().map(|plan| plan.as_ref().map_or(&[][..], |p| &p.occupied));
        self.conflict = conflicts::first(occupied);
    }

    fn cost(&self) -> Us {
        self.plans.iter().flatten().map(|plan| plan.arrival).sum()
    }

    fn is_free_until(&self) -> Us {
        self.conflict.as_ref().map_or(FOREVER, |conflict| conflict.start)
    }

    /// All agents around which an agent has to plan, directly or indirectly.
    fn all_above(&self, agent: usize) -> Vec<bool> {
        let mut found = vec![false; self.above.len()];
        let mut open = self.above[agent].clone();
        while let Some(other) = open.pop() {
            if !std::mem::replace(&mut found[other], true) {
                open.extend_from_slice(&self.above[other]);
            }
        }
        found
    }

    /// An agent and those that have to plan around it, each after all of higher priority.
    fn self_and_below(&self, agent: usize) -> Vec<usize> {
        let mut order: Vec<(usize, usize)> = Vec::new();
        for other in 0..self.above.len() {
            let above = self.all_above(other);
            if other == agent || above[agent] {
                order.push((above.iter().filter(|&&is_above| is_above).count(), other));
            }
        }
        order.sort_unstable();
        order.into_iter().map(|(_, other)| other).collect()
    }
}

impl Planner for Pbs {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        let times = rolling::times(scene, agents);
        rolling::block(scene, agents, &mut self.table);
        let plans = agents
            .iter()
            .zip(&times)
            .map(|(agent, times)| self.search(scene, agent, times, &[]).map(Rc::new))
            .collect();
        let mut root = Node { above: vec![Vec::new(); agents.len()], plans, conflict: None };
        root.find_conflict();
        let best = self.best(scene, agents, &times, root);
        let end = scene.now + self.window;
        let mut answers = Vec::new();
        for ((agent, plan), times) in agents.iter().zip(best.plans).zip(&times) {
            let mut moves = plan.map(|plan| plan.moves.clone());
            if let Some(moves) = &mut moves {
                rolling::append_rest(scene, agent, moves, end, times);
            }
            answers.push(Answer::of(moves));
        }
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

impl Pbs {
    /// Depth-first search of the priority tree; when the nodes are used up or all orders fail, the
    /// node whose first conflict comes last.
    fn best(
        &mut self,
        scene: &mut Scene,
        agents: &[Agent],
        times: &[impl AsRef<[u32]>],
        root: Node,
    ) -> Node {
        let mut latest = root.clone();
        let mut stack = vec![root];
        for _ in 0..self.nodes {
            look_up();
            let Some(node) = stack.pop() else { break };
            if node.is_free_until() > latest.is_free_until() {
                latest = node.clone();
            }
            let Some(conflict) = node.conflict.clone() else { break };
            let [one, other] = conflict.agents;
            let mut children = Vec::new();
            for (lower, higher) in [(one, other), (other, one)] {
                children.extend(self.child(scene, agents, times, &node, lower, higher));
            }
            children.sort_by_key(|child| std::cmp::Reverse(child.cost()));
            stack.append(&mut children);
        }
        latest
    }

    /// The node in which `lower` plans around `higher`, and agents below `lower` are replanned as
    /// far as necessary.
    fn child(
        &mut self,
        scene: &mut Scene,
        agents: &[Agent],
        times: &[impl AsRef<[u32]>],
        parent: &Node,
        lower: usize,
        higher: usize,
    ) -> Option<Node> {
        if parent.all_above(higher)[lower] {
            return None;
        }
        let mut node = parent.clone();
        node.above[lower].push(higher);
        for agent in node.self_and_below(lower) {
            let above = node.all_above(agent);
            let occupied: Vec<Held> = (0..agents.len())
                .filter(|&other| above[other])
                .filter_map(|other| node.plans[other].as_ref())
                .flat_map(|plan| plan.occupied.iter().copied())
                .collect();
            let own = node.plans[agent].as_ref().map_or(&[][..], |plan| &plan.occupied);
            if agent != lower && conflicts::first([own, &occupied[..]]).is_none() {
                continue;
            }
            let plan = self.search(scene, &agents[agent], times[agent].as_ref(), &occupied)?;
            node.plans[agent] = Some(Rc::new(plan));
        }
        node.find_conflict();
        Some(node)
    }

    /// The best way of an agent within the window around what others occupy.
    fn search(
        &mut self,
        scene: &mut Scene,
        agent: &Agent,
        times: &[u32],
        occupied: &[Held],
    ) -> Option<Plan> {
        let until = scene.now + self.window;
        let before = rolling::overlay(&mut self.table, occupied);
        let (ready, end) = (agent.ready, End::Window(until));
        let found = rolling::search(scene, &self.table, agent, ready, times, end, self.labels);
        rolling::restore(&mut self.table, before);
        let moves = found?;
        let occupied = rolling::occupied(scene, agent, &moves, until);
        let (node, heading, end) = moves
            .last()
            .map_or((agent.start, agent.heading, agent.ready), |l| (l.to, l.heading, l.end));
        let at_goal = node == agent.goal;
        let arrival = if at_goal { end } else { end.max(until) }
            + Us::from(times[scene.network.index(node, heading)]);
        Some(Plan { moves, occupied, arrival })
    }
}
