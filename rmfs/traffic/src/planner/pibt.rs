//! PIBT, as far as straight runs allow: priority inheritance with backtracking, one run at a time.
//!
//! After Okumura, Machida, Defago, Tamura (2019, 2022). The robot that has been under way longest
//! chooses first. If a robot at rest stands in the way of the best run, it inherits the priority
//! and
//! has to leave first; if it cannot, the next best run is tried. The guarantee of PIBT that all
//! robots arrive does not hold: it requires that all robots move one edge at the same time. Here,
//! runs take different times, a place can be entered only after it has been left, and robots in
//! motion or
//! at work cannot be pushed.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::reservations::{Interval, Table};
use crate::units::{FOREVER, Us};

use super::deadlock::Deadlocks;
use super::partial::Partial;
use super::{Agent, Answer, Planner, Rhythm, Scene, rolling};

/// The planner and its parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Pibt {
    pub rhythm: Rhythm,
    /// Maximum additional time of the way over a run, compared with the best way.
    pub detour: Us,
    /// Maximum number of runs that a robot tries, the best first.
    pub choices: usize,
    pub deadlocks: Deadlocks,
    #[serde(skip)]
    pub table: Table,
    /// Goal of each robot, and the time since which it has had it.
    pub since: BTreeMap<u32, (u32, Us)>,
}

/// One call.
struct Round<'s, 'n> {
    scene: &'s mut Scene<'n>,
    agents: &'s [Agent],
    times: &'s [Arc<[u32]>],
    table: &'s mut Table,
    /// Agents at rest that have not chosen yet, by the resource they occupy.
    waiting: BTreeMap<u32, usize>,
    answers: Vec<Answer>,
    detour: Us,
    choices: usize,
}

impl Planner for Pibt {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        self.note_goals(scene, agents);
        let times = rolling::times(scene, agents);
        rolling::block(scene, agents, &mut self.table);
        let (detour, choices) = (self.detour, self.choices);
        let answers = vec![Answer::Keep; agents.len()];
        let (table, waiting) = (&mut self.table, BTreeMap::new());
        let times = &times[..];
        let mut round = Round { scene, agents, times, table, waiting, answers, detour, choices };
        round.sort_out();
        let mut order: Vec<usize> = round.waiting.values().copied().collect();
        order.sort_by_key(|&index| (self.since[&agents[index].robot].1, agents[index].robot));
        for index in order {
            if round.waiting.values().any(|&waiting| waiting == index) {
                round.choose(index, &BTreeSet::new());
            }
        }
        let mut answers = round.answers;
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

impl Pibt {
    fn note_goals(&mut self, scene: &Scene, agents: &[Agent]) {
        let known = std::mem::take(&mut self.since);
        for agent in agents {
            let before = known.get(&agent.robot).filter(|before| before.0 == agent.goal);
            let since = before.map_or(scene.now, |before| before.1);
            self.since.insert(agent.robot, (agent.goal, since));
        }
    }
}

impl Round<'_, '_> {
    /// Agents in motion keep their ways; the others may choose.
    fn sort_out(&mut self) {
        for (index, agent) in self.agents.iter().enumerate() {
            if agent.ready > self.scene.now {
                self.hold(index);
            } else {
                let resource = self.scene.network.resource[agent.start as usize];
                self.waiting.insert(resource, index);
            }
        }
    }

    /// Reserves the place of an agent indefinitely; no other agent has been allowed to pass there.
    fn hold(&mut self, index: usize) {
        let agent = &self.agents[index];
        let resource = self.scene.network.resource[agent.start as usize];
        let end = self.table.occupant(resource, agent.ready, FOREVER).map_or(FOREVER, |o| o.start);
        if agent.ready < end {
            let held = Interval { start: agent.ready, end, robot: agent.robot };
            self.table.insert(resource, held, self.scene.now);
        }
    }

    fn release(&mut self, index: usize, before: Vec<Interval>) {
        let start = self.agents[index].start;
        self.table.replace(self.scene.network.resource[start as usize], before);
    }

    /// Lets an agent choose a run that ends outside the forbidden resources, after agents in its
    /// way have chosen. Returns whether it moves.
    fn choose(&mut self, index: usize, forbidden: &BTreeSet<u32>) -> bool {
        let own = self.scene.network.resource[self.agents[index].start as usize];
        self.waiting.remove(&own);
        // what others have chosen meanwhile may be in the way of a run that was free before
        let mut others_moved = false;
        for run in self.runs(index, forbidden).into_iter().take(self.choices) {
            let needed: Vec<u32> = run
                .occupied(self.scene, &self.agents[index], FOREVER)
                .iter()
                .map(|held| held.resource)
                .collect();
            let is_clear = needed.iter().all(|resource| !self.waiting.contains_key(resource));
            if is_clear && !others_moved {
                return self.take(index, run);
            }
            others_moved = true;
            let mut avoid = forbidden.clone();
            avoid.extend(&needed);
            let before = self.table.row(own).to_vec();
            self.hold(index);
            let leave = needed.iter().all(|resource| match self.waiting.get(resource) {
                Some(&other) => self.choose(other, &avoid),
                None => true,
            });
            self.release(index, before);
            if leave && let Some(run) = self.again(index, forbidden, &run) {
                return self.take(index, run);
            }
        }
        self.hold(index);
        false
    }

    fn take(&mut self, index: usize, run: Partial) -> bool {
        rolling::reserve(self.scene, self.table, &self.agents[index], &run.moves, FOREVER);
        self.answers[index] = Answer::Way(run.moves);
        true
    }

    /// The same run as before, now that others have made room for it.
    fn again(&mut self, index: usize, forbidden: &BTreeSet<u32>, run: &Partial) -> Option<Partial> {
        let runs = self.runs(index, forbidden);
        let mut same = runs.into_iter().filter(|other| other.node == run.node);
        let is_clear = |run: &Partial| {
            let held = run.occupied(self.scene, &self.agents[index], FOREVER);
            held.iter().all(|held| !self.waiting.contains_key(&held.resource))
        };
        same.find(is_clear)
    }

    /// Runs to places where the agent can stay indefinitely, the best first; a run onto an elevator
    /// with the ride and the run off it.
    fn runs(&mut self, index: usize, forbidden: &BTreeSet<u32>) -> Vec<Partial> {
        let (agent, times) = (&self.agents[index], &self.times[index]);
        let Some(here) = Partial::begin(self.scene, agent, times) else { return Vec::new() };
        let mut runs = Vec::new();
        for stop in here.next(self.scene, self.table, agent, times, self.detour) {
            let is_elevator = self.scene.network.is_elevator(stop.step.to);
            let stays = stop.until == FOREVER;
            let run = here.with(self.scene, stop.step, times);
            if is_elevator {
                runs.extend(self.off_the_elevator(index, run));
            } else if stays {
                runs.push(run);
            }
        }
        let network = self.scene.network;
        runs.retain(|run| !forbidden.contains(&network.resource[run.node as usize]));
        runs
    }

    /// A way that ends in an elevator, with the best ride and run off it.
    fn off_the_elevator(&mut self, index: usize, mut run: Partial) -> Option<Partial> {
        let (agent, times) = (&self.agents[index], &self.times[index]);
        while self.scene.network.is_elevator(run.node) {
            let stops = run.next(self.scene, self.table, agent, times, self.detour);
            let network = self.scene.network;
            let next = stops.into_iter().find(|stop| {
                stop.step.ride || (stop.until == FOREVER && !network.is_elevator(stop.step.to))
            })?;
            if next.step.ride && run.moves.last().is_some_and(|last| last.ride) {
                return None;
            }
            run = run.with(self.scene, next.step, times);
        }
        Some(run)
    }
}
