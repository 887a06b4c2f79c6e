//! Shared parts of rolling planners: a table of reservations that would result from a plan,
//! searches within a window, and the rest of the way after it.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::costs::Table as Times;
use crate::network::NONE;
use crate::reservations::{Interval, Table};
use crate::robot::{Held, occupation};
use crate::route::{Leg, route};
use crate::search::{End, Guide, Move, Outcome, Query};
use crate::units::{FOREVER, Us};

use super::{Agent, Scene};

/// Unhindered times to the goal of each agent.
pub fn times(scene: &mut Scene, agents: &[Agent]) -> Vec<Arc<[u32]>> {
    let mut towards = |agent: &Agent| -> Times {
        scene.costs.towards(scene.network, agent.goal, agent.kind, agent.loaded)
    };
    agents.iter().map(&mut towards).collect()
}

/// Unhindered remaining time of an agent; [`crate::costs::UNREACHABLE`] without a way.
pub fn to_go(scene: &Scene, agent: &Agent, times: &[u32]) -> u32 {
    times[scene.network.index(agent.start, agent.heading)]
}

/// Fills `table` with what cannot be changed: the motion of agents until they are ready, and all
/// reservations of other robots.
pub fn block(scene: &Scene, agents: &[Agent], table: &mut Table) {
    table.reset(scene.network.resources);
    let mut ready = vec![FOREVER; scene.robots.len()];
    for agent in agents {
        ready[agent.robot as usize] = agent.ready;
    }
    for (robot, state) in scene.robots.iter().enumerate() {
        for held in &state.held {
            let end = if held.end == FOREVER { ready[robot] } else { held.end };
            if end > scene.now && end > held.start {
                let interval = Interval { start: held.start, end, robot: robot as u32 };
                table.insert(held.resource, interval, scene.now);
            }
        }
    }
}

/// Looks for a way of an agent that is free in a table, from `ready` on.
pub fn search(
    scene: &mut Scene,
    table: &Table,
    agent: &Agent,
    ready: Us,
    times: &[u32],
    end: End,
    labels: u64,
) -> Option<Vec<Move>> {
    let query = Query {
        start: agent.start,
        heading: agent.heading,
        ready,
        goal: agent.goal,
        loaded: agent.loaded,
        stored: &[],
        kind: &scene.kinds[agent.kind as usize],
        model: &scene.costs.models[agent.kind as usize],
        budget: labels,
        end,
        detour: FOREVER,
        guide: Guide::Exact,
        times: Some(times),
        guidance: None,
    };
    match scene.pathfinder.search(scene.network, table, &query) {
        Outcome::Found(moves) => Some(moves),
        Outcome::NoWay | Outcome::OutOfBudget => None,
    }
}

/// What an agent occupies from its ready time on; the last waypoint until `until` at least.
pub fn occupied(scene: &Scene, agent: &Agent, moves: &[Move], until: Us) -> Vec<Held> {
    let kind = &scene.kinds[agent.kind as usize];
    let mut held = occupation(scene.network, kind, agent.start, agent.ready, moves);
    let end = moves.last().map_or(agent.ready, |last| last.end);
    held.last_mut().expect("the end of the way").end = until.max(end);
    held.retain(|held| held.end > held.start);
    held
}

/// Reserves what [`occupied`] says; it must be free.
pub fn reserve(scene: &Scene, table: &mut Table, agent: &Agent, moves: &[Move], until: Us) {
    for held in occupied(scene, agent, moves, until) {
        let interval = Interval { start: held.start, end: held.end, robot: agent.robot };
        table.insert(held.resource, interval, scene.now);
    }
}

/// The quickest way from the end of a plan, not before `ready`, to the goal, ignoring other robots
/// but avoiding closed waypoints.
pub fn way(
    scene: &Scene,
    agent: &Agent,
    moves: &[Move],
    ready: Us,
    times: &[u32],
    penalty: impl Fn(u32) -> Option<Us>,
) -> Option<Vec<Move>> {
    let (start, heading, end) =
        moves.last().map_or((agent.start, agent.heading, agent.ready), |last| {
            (last.to, last.heading, last.end)
        });
    let leg = Leg {
        start,
        heading,
        ready: end.max(ready),
        goal: agent.goal,
        loaded: agent.loaded,
        kind: &scene.kinds[agent.kind as usize],
        model: &scene.costs.models[agent.kind as usize],
        times,
    };
    route(scene.network, &leg, penalty)
}

/// Appends the unchecked rest of the way to a plan for a window. The robot does not stop at the
/// joint if the way goes straight on and the plan does not wait there.
pub fn append_rest(
    scene: &Scene,
    agent: &Agent,
    moves: &mut Vec<Move>,
    window_end: Us,
    times: &[u32],
) {
    let ends_early = moves.last().map_or(agent.ready, |last| last.end) < window_end;
    let Some(rest) = way(scene, agent, moves, window_end, times, |_| Some(0)) else { return };
    let mut rest = rest.into_iter();
    if let (false, Some(last), Some(next)) = (ends_early, moves.last_mut(), rest.as_slice().first())
        && !last.ride
        && !next.ride
        && last.heading == next.heading
    {
        let line = scene.network.line(last.from, next.to, last.heading);
        let length = line.last().map_or(0.0, |end| end.1);
        let end = last.start + scene.kinds[agent.kind as usize].run_time(length);
        let earlier = next.end - end;
        (last.to, last.end) = (next.to, end);
        rest.next();
        moves.extend(rest.map(|step| Move {
            start: step.start - earlier,
            end: step.end - earlier,
            ..step
        }));
    } else {
        moves.extend(rest);
    }
}

/// The first conflict of a way with a reservation of another robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Clash {
    /// Index of the move that leads onto, or past, the waypoint.
    pub step: usize,
    pub node: u32,
    pub owner: u32,
}

/// The first waypoint of a way, whose end is held indefinitely, that another robot has reserved in
/// a table.
pub fn clash(scene: &Scene, table: &Table, agent: &Agent, moves: &[Move]) -> Option<Clash> {
    let network = scene.network;
    let kind = &scene.kinds[agent.kind as usize];
    let held = occupation(network, kind, agent.start, agent.ready, moves);
    // the waypoint of each occupation, and the move that leads there
    let mut nodes = vec![(0, agent.start)];
    for (step, run) in moves.iter().enumerate() {
        if run.ride {
            nodes.last_mut().expect("the start").1 = run.to;
        }
        nodes.extend(network.line(run.from, run.to, run.heading).map(|at| (step, at.0)));
    }
    held.iter().zip(nodes).find_map(|(held, (step, node))| {
        let row = table.row(held.resource).iter().filter(|old| old.robot != agent.robot);
        let meets = |old: &&Interval| old.start < held.end && held.start < old.end;
        let owner = row.clone().find(meets)?.robot;
        Some(Clash { step, node, owner })
    })
}

/// Adds the occupations of plans to a table, over those present; returns the previous rows.
pub fn overlay<'a>(
    table: &mut Table,
    occupied: impl IntoIterator<Item = &'a Held>,
) -> BTreeMap<u32, Vec<Interval>> {
    let mut before = BTreeMap::new();
    for held in occupied {
        before.entry(held.resource).or_insert_with(|| table.row(held.resource).to_vec());
        let interval = Interval { start: held.start, end: held.end, robot: NONE };
        table.cover(held.resource, interval);
    }
    before
}

/// Removes an overlay.
pub fn restore(table: &mut Table, before: BTreeMap<u32, Vec<Interval>>) {
    for (resource, row) in before {
        table.replace(resource, row);
    }
}
