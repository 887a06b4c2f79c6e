//! CBS: conflict-based search. A conflict of two agents is resolved in two branches; in each, one
//! of them avoids the conflict.
//!
//! Sharon, Stern, Felner, Sturtevant (2015), in the form of Merschformann, Xie, Erdmann (2017):
//! without horizon, a conflict is a waypoint occupied twice, a constraint forbids it to one agent
//! for the time of the overlap, and agents disappear when they have reached their goal.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::rc::Rc;

use serde::{Deserialize, Serialize};

use crate::network::NONE;
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
pub struct Cbs {
    pub rhythm: Rhythm,
    /// Nodes of the constraint tree that may be expanded in a call.
    pub nodes: u64,
    /// Maximum number of labels per agent.
    pub labels: u64,
    pub deadlocks: Deadlocks,
    #[serde(skip)]
    pub table: Table,
}

/// The way of one agent and what it occupies.
struct Plan {
    moves: Vec<Move>,
    occupied: Vec<Held>,
}

/// One constraint, and those before it.
struct Constraint {
    agent: usize,
    held: Held,
    before: Option<Rc<Constraint>>,
}

/// A node of the constraint tree.
struct Node {
    constraints: Option<Rc<Constraint>>,
    plans: Vec<Rc<Plan>>,
    conflict: Option<Conflict>,
}

impl Node {
    fn new(constraints: Option<Rc<Constraint>>, plans: Vec<Rc<Plan>>) -> Self {
        let conflict = conflicts::first(plans.iter().map(|plan| &plan.occupied[..]));
        Self { constraints, plans, conflict }
    }

    /// Sum of the arrival times.
    fn cost(&self) -> Us {
        self.plans.iter().filter_map(|plan| plan.moves.last()).map(|last| last.end).sum()
    }

    fn is_free_until(&self) -> Us {
        self.conflict.as_ref().map_or(FOREVER, |conflict| conflict.start)
    }
}

impl Planner for Cbs {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        let times = rolling::times(scene, agents);
        rolling::block(scene, agents, &mut self.table);
        let mut alone = Vec::new();
        for (agent, times) in agents.iter().zip(&times) {
            alone.push(self.search(scene, agent, times, &[]).map(Rc::new));
        }
        let plans: Option<Vec<Rc<Plan>>> = alone.iter().cloned().collect();
        let ways = match plans {
            Some(plans) => {
                let best = self.best(scene, agents, &times, Node::new(None, plans));
                best.plans.into_iter().map(Some).collect()
            }
            // somebody has no way at all: nothing can be resolved, everybody goes its own
            None => alone,
        };
        let answer = |plan: Option<Rc<Plan>>| Answer::of(plan.map(|plan| plan.moves.clone()));
        let mut answers: Vec<Answer> = ways.into_iter().map(answer).collect();
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

impl Cbs {
    /// Best-first search of the constraint tree; when the nodes are used up, the one whose first
    /// conflict comes last.
    fn best(
        &mut self,
        scene: &mut Scene,
        agents: &[Agent],
        times: &[impl AsRef<[u32]>],
        root: Node,
    ) -> Node {
        let mut tree = vec![Some(root)];
        let mut open = BinaryHeap::new();
        open.push(Reverse((tree[0].as_ref().map_or(0, Node::cost), 0)));
        let mut latest = (0, 0);
        for _ in 0..self.nodes {
            look_up();
            let Some(Reverse((_, index))) = open.pop() else { break };
            let node = tree[index].as_ref().expect("kept");
            let Some(conflict) = node.conflict.clone() else {
                return tree.swap_remove(index).expect("kept");
            };
            latest = latest.max((node.is_free_until(), index));
            let held = Held {
                resource: conflict.resource,
                start: conflict.start,
                end: conflict.end,
                entered_by: NONE,
            };
            let (before, plans) = (node.constraints.clone(), node.plans.clone());
            for agent in conflict.agents {
                let constraint = Rc::new(Constraint { agent, held, before: before.clone() });
                let forbidden = forbidden(&constraint, agent);
                let found = self.search(scene, &agents[agent], times[agent].as_ref(), &forbidden);
                if let Some(plan) = found {
                    let mut plans = plans.clone();
                    plans[agent] = Rc::new(plan);
                    let child = Node::new(Some(constraint), plans);
                    open.push(Reverse((child.cost(), tree.len())));
                    tree.push(Some(child));
                }
            }
        }
        tree.swap_remove(latest.1).expect("kept")
    }

    /// The quickest way of an agent under its constraints.
    fn search(
        &mut self,
        scene: &mut Scene,
        agent: &Agent,
        times: &[u32],
        forbidden: &[Held],
    ) -> Option<Plan> {
        let before = rolling::overlay(&mut self.table, forbidden);
        let (ready, end) = (agent.ready, End::Arrival);
        let found = rolling::search(scene, &self.table, agent, ready, times, end, self.labels);
        rolling::restore(&mut self.table, before);
        let moves = found?;
        let occupied = rolling::occupied(scene, agent, &moves, 0);
        Some(Plan { moves, occupied })
    }
}

/// All that an agent must not occupy.
fn forbidden(newest: &Rc<Constraint>, agent: usize) -> Vec<Held> {
    let chain = std::iter::successors(Some(newest), |constraint| constraint.before.as_ref());
    chain.filter(|constraint| constraint.agent == agent).map(|constraint| constraint.held).collect()
}
