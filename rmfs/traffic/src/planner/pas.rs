//! PAS: parallel agent search. All ways grow together, the one furthest behind in time next.
//!
//! Erdmann (2015), as in RAWSim-O. An agent reserves the best next step to its goal around the
//! steps of others. If it has no option left, not even to wait, its priority rises, and agents of
//! lower priority retract the steps in its way and continue from before.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::reservations::{Interval, Table};
use crate::robot::Held;
use crate::search::Move;
use crate::units::Us;

use super::deadlock::Deadlocks;
use super::partial::Partial;
use super::{Agent, Answer, Planner, Rhythm, Scene, rolling};

/// The planner and its parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Pas {
    pub rhythm: Rhythm,
    pub window: Us,
    /// Duration of a wait.
    pub wait: Us,
    /// Highest priority of an agent; if it has no way even then, it waits although others need to
    /// pass.
    pub priorities: u32,
    /// Maximum number of decisions per agent in a call, on average.
    pub steps_per_agent: u64,
    pub deadlocks: Deadlocks,
    #[serde(skip)]
    pub table: Table,
}

/// The growing way of an agent.
struct Track {
    part: Partial,
    priority: u32,
    is_home: bool,
    held: Vec<Held>,
}

/// The growing ways of all agents.
struct Tracks<'s, 'n> {
    scene: &'s mut Scene<'n>,
    agents: &'s [Agent],
    times: &'s [Arc<[u32]>],
    table: &'s mut Table,
    tracks: Vec<Option<Track>>,
    end: Us,
}

impl Planner for Pas {
    fn rhythm(&self) -> Rhythm {
        self.rhythm
    }

    fn plan(&mut self, scene: &mut Scene, agents: &[Agent]) -> Vec<Answer> {
        let times = rolling::times(scene, agents);
        rolling::block(scene, agents, &mut self.table);
        let end = scene.now + self.window;
        let begin = |(agent, times): (&Agent, &Arc<[u32]>)| {
            let part = Partial::begin(scene, agent, times)?;
            Some(Track { part, priority: 0, is_home: false, held: Vec::new() })
        };
        let tracks = agents.iter().zip(&times).map(begin).collect();
        let table = &mut self.table;
        let mut all = Tracks { scene, agents, times: &times, table, tracks, end };
        for _ in 0..self.steps_per_agent * agents.len() as u64 {
            let Some(index) = all.furthest_behind() else { break };
            all.advance(index, self.wait, self.priorities);
        }
        let tracks = all.tracks;
        let mut answers = Vec::new();
        for ((agent, track), times) in agents.iter().zip(tracks).zip(&times) {
            let way = track.map(|Track { mut part, .. }| {
                rolling::append_rest(scene, agent, &mut part.moves, part.time, times);
                part.moves
            });
            answers.push(Answer::of(way));
        }
        self.deadlocks.resolve(scene, agents, &mut answers);
        answers
    }
}

impl Tracks<'_, '_> {
    /// The agent whose decided way ends first, of those not done.
    fn furthest_behind(&self) -> Option<usize> {
        let network = self.scene.network;
        let open = |track: &Track| {
            let rests = track.part.time >= self.end && !network.is_elevator(track.part.node);
            !track.is_home && !rests
        };
        let times = self.tracks.iter().enumerate().filter_map(|(index, track)| {
            track.as_ref().filter(|track| open(track)).map(|track| (track.part.time, index))
        });
        times.min().map(|(_, index)| index)
    }

    /// One decision of an agent.
    fn advance(&mut self, index: usize, wait: Us, priorities: u32) {
        let Some(mut track) = self.tracks[index].take() else { return };
        self.release(index, &track.held);
        if !self.takes_best(index, &mut track, wait) {
            track.priority += 1;
            let moved = track.priority <= priorities && self.pushes(index, &mut track, wait);
            if !moved {
                // it stays, whoever wants to pass
                track.part.time += wait;
            }
            if track.priority > priorities {
                track.priority = 0;
            }
        }
        track.held = self.reserve(index, &track);
        self.tracks[index] = Some(track);
    }

    /// Takes the best free option: a run, a ride or a wait. Returns whether there is one.
    fn takes_best(&mut self, index: usize, track: &mut Track, wait: Us) -> bool {
        let (agent, times) = (&self.agents[index], &self.times[index]);
        let slack = self.end - self.scene.now;
        let stops = track.part.next(self.scene, self.table, agent, times, slack);
        let waits_until = track.part.time + wait;
        let waits = track.part.can_wait(self.scene, self.table, waits_until);
        let arrival = |step: &Move| {
            step.end + Us::from(times[self.scene.network.index(step.to, step.heading)])
        };
        match stops.into_iter().next() {
            Some(stop) if !waits || arrival(&stop.step) <= waits_until + track.part.to_go => {
                track.is_home = stop.step.to == agent.goal;
                track.part = track.part.with(self.scene, stop.step, times);
            }
            _ if waits => track.part.time = waits_until,
            _ => return false,
        }
        true
    }

    /// The same, ignoring agents of lower priority; those in the way retract their decisions.
    fn pushes(&mut self, index: usize, track: &mut Track, wait: Us) -> bool {
        let is_lower = |other: &Track| other.priority < track.priority && !other.is_home;
        let lower: Vec<usize> = (0..self.tracks.len())
            .filter(|&other| self.tracks[other].as_ref().is_some_and(is_lower))
            .collect();
        for &other in &lower {
            let held = self.tracks[other].as_ref().map(|track| track.held.clone());
            self.release(other, &held.unwrap_or_default());
        }
        let takes = self.takes_best(index, track, wait);
        let taken = self.reserve(index, track);
        for other in lower {
            self.go_back(other, &taken);
        }
        self.release(index, &taken);
        takes
    }

    /// Retracts the decisions of an agent that conflict with what is taken, and reserves the rest.
    fn go_back(&mut self, index: usize, taken: &[Held]) {
        let Some(mut track) = self.tracks[index].take() else { return };
        let meets = |held: &[Held]| {
            let one = |held: &Held| {
                let same = taken.iter().filter(|other| other.resource == held.resource);
                same.clone().any(|other| other.start < held.end && held.start < other.end)
            };
            held.iter().any(one)
        };
        let (agent, times) = (&self.agents[index], &self.times[index]);
        let mut kept = track.part.moves.len();
        while meets(&track.held) {
            if kept == 0 {
                track.part = track.part.back_to(self.scene, agent, 0, times);
                break;
            }
            kept -= 1;
            track.part = track.part.back_to(self.scene, agent, kept, times);
            track.held = track.part.occupied(self.scene, agent, 0);
        }
        track.held = self.reserve(index, &track);
        self.tracks[index] = Some(track);
    }

    /// The name under which an agent's decided way is in the table, apart from what is granted.
    fn name(&self, index: usize) -> u32 {
        (self.scene.robots.len() + index) as u32
    }

    fn release(&mut self, index: usize, held: &[Held]) {
        let name = self.name(index);
        held.iter().for_each(|held| self.table.remove(held.resource, name));
    }

    /// Reserves the free part of an agent's way; an agent at its goal stays there to the end.
    fn reserve(&mut self, index: usize, track: &Track) -> Vec<Held> {
        let until = if track.is_home { self.end } else { 0 };
        let held = track.part.occupied(self.scene, &self.agents[index], until);
        let robot = self.name(index);
        for held in &held {
            if self.table.occupant(held.resource, held.start, held.end).is_none() {
                let interval = Interval { start: held.start, end: held.end, robot };
                self.table.insert(held.resource, interval, self.scene.now);
            }
        }
        held
    }
}
