//! Ways that planners assemble piece by piece: the part decided so far, and the next options.

use crate::reservations::Table;
use crate::robot::Held;
use crate::search::{End, Guide, Move, Query, Stop};
use crate::units::{FOREVER, Us};

use super::{Agent, Scene, rolling};

/// The part of a way that is decided.
#[derive(Clone, Debug)]
pub struct Partial {
    pub moves: Vec<Move>,
    /// Where it ends, and the time until which the agent stays there at least.
    pub node: u32,
    pub heading: u8,
    pub time: Us,
    /// Unhindered time from there to the goal.
    pub to_go: Us,
}

impl Partial {
    /// A way without decisions; `None` if there is no way at all.
    pub fn begin(scene: &Scene, agent: &Agent, times: &[u32]) -> Option<Self> {
        let to_go = rolling::to_go(scene, agent, times);
        Some(Self {
            moves: Vec::new(),
            node: agent.start,
            heading: agent.heading,
            time: agent.ready,
            to_go: crate::costs::time(to_go)?,
        })
    }

    /// The way with one more move.
    pub fn with(&self, scene: &Scene, step: Move, times: &[u32]) -> Self {
        let (node, heading, time) = (step.to, step.heading, step.end);
        let to_go = Us::from(times[scene.network.index(node, heading)]);
        let moves = self.moves.iter().cloned().chain(std::iter::once(step)).collect();
        Self { moves, node, heading, time, to_go }
    }

    /// The way with only its first `kept` moves.
    pub fn back_to(&self, scene: &Scene, agent: &Agent, kept: usize, times: &[u32]) -> Self {
        let (node, heading, time) = match kept.checked_sub(1) {
            Some(last) => (self.moves[last].to, self.moves[last].heading, self.moves[last].end),
            None => (agent.start, agent.heading, agent.ready),
        };
        let to_go = Us::from(times[scene.network.index(node, heading)]);
        Self { moves: self.moves[..kept].to_vec(), node, heading, time, to_go }
    }

    /// The agent's next options, given the reservations of a table, the best first.
    pub fn next(
        &self,
        scene: &mut Scene,
        table: &Table,
        agent: &Agent,
        times: &[u32],
        slack: Us,
    ) -> Vec<Stop> {
        let query = Query {
            start: self.node,
            heading: self.heading,
            ready: self.time,
            goal: agent.goal,
            loaded: agent.loaded,
            stored: &[],
            kind: &scene.kinds[agent.kind as usize],
            model: &scene.costs.models[agent.kind as usize],
            budget: 1,
            end: End::Arrival,
            detour: FOREVER,
            guide: Guide::Exact,
            times: Some(times),
            guidance: None,
        };
        let mut stops = scene.pathfinder.next_stops(scene.network, table, &query, slack);
        let network = scene.network;
        // of two stops on the best way the farther one
        stops.sort_by_key(|stop| {
            let to_go = times[network.index(stop.step.to, stop.step.heading)];
            (stop.step.end + Us::from(to_go), to_go, stop.step.heading)
        });
        stops
    }

    /// Whether the agent can stay where it is until a time.
    pub fn can_wait(&self, scene: &Scene, table: &Table, until: Us) -> bool {
        let resource = scene.network.resource[self.node as usize];
        !scene.network.is_elevator(self.node)
            && table.occupant(resource, self.time, until).is_none()
    }

    /// What the way occupies, its end until the agent may go on, or `until`.
    pub fn occupied(&self, scene: &Scene, agent: &Agent, until: Us) -> Vec<Held> {
        rolling::occupied(scene, agent, &self.moves, self.time.max(until))
    }
}
