//! What searches keep in memory from one to the next, and their start.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::backward::Backward;
use crate::costs::{UNREACHABLE, time};
use crate::guidance::Guidance;
use crate::network::{NONE, Network};
use crate::reservations::{Table, Windows};
use crate::units::Us;

use super::{GUIDE_STEP, Guide, Label, Outcome, Query, STAGES, Search};

/// Reusable memory of searches, and their counts of work.
#[derive(Clone, Debug)]
pub struct Pathfinder {
    pub(super) labels: Vec<Label>,
    /// Labels by least total time, then by least time to go.
    pub(super) open: BinaryHeap<Reverse<(Us, Us, u32)>>,
    /// Newest label of each (waypoint, heading), and in which search it was made.
    pub(super) newest: Vec<(u32, u32)>,
    pub(super) stamp: u32,
    pub(super) guide: Backward,
    /// The same with extra costs, once a search has used them.
    pub(super) guided: Option<Box<Backward>>,
    /// Total time up to which the guide knows ways.
    pub(super) guided_to: u32,
    pub(super) stable: Windows,
    pub(super) windows: Windows,
    pub(super) line: Vec<(u32, f64)>,
    /// Labels examined so far, over all searches.
    pub expansions: u64,
}

impl Pathfinder {
    /// Memory for searches on `network`.
    pub fn new(network: &Network) -> Self {
        Self {
            labels: Vec::new(),
            open: BinaryHeap::new(),
            newest: vec![(0, NONE); network.nodes * network.heading_count()],
            stamp: 0,
            guide: Backward::new(network),
            guided: None,
            guided_to: UNREACHABLE,
            stable: Vec::new(),
            windows: Vec::new(),
            line: Vec::new(),
            expansions: 0,
        }
    }

    /// Finds the earliest arrival at the goal that can be held forever; when that takes more than a
    /// few hundred labels, one that is early enough. [`Query::end`] may ask for less.
    ///
    /// The robot's own reservations must not be in `table`.
    pub fn search(&mut self, network: &Network, table: &Table, query: &Query) -> Outcome {
        for (weight, labels) in STAGES {
            let budget = query.budget.min(labels);
            if self.aim(network, query).is_none() {
                return Outcome::NoWay;
            }
            let outcome = self.seek(network, table, query, weight, budget);
            if outcome != Outcome::OutOfBudget || budget == query.budget {
                return outcome;
            }
        }
        Outcome::OutOfBudget
    }

    /// Prepares for searches from the query's start to its goal. Returns the time of the way
    /// without other robots, or `None` if there is no way.
    pub fn aim(&mut self, network: &Network, query: &Query) -> Option<Us> {
        let Query { start, heading, goal, loaded, model, .. } = *query;
        if goal == NONE {
            return Some(0);
        }
        if let Some(times) = query.times {
            return time(times[network.index(start, heading)]);
        }
        let aimed = |guide: &mut Backward| {
            guide.begin(network, model, goal, loaded, Some(start));
            if matches!(query.guide, Guide::Near(_)) {
                guide.count_turns(network, model, heading);
            }
            while !guide.knows(network, start, heading) {
                let reach = guide.reach().saturating_add(GUIDE_STEP);
                guide.advance(network, model, reach);
            }
            let least = guide.to_go(network, start, heading);
            let reach = match query.guide {
                Guide::Near(slack) if guide.bound_to_goal(network, model) => {
                    least.saturating_add(slack as u32)
                }
                _ => UNREACHABLE,
            };
            (least, reach)
        };
        let (unhindered, reach) = aimed(&mut self.guide);
        self.guided_to = match query.guidance {
            Some(guidance) => {
                self.guided.take_if(|guide| !guide.is_guided_by(guidance));
                let with_extra = || Box::new(Backward::guided(network, Guidance::clone(guidance)));
                aimed(self.guided.get_or_insert_with(with_extra)).1
            }
            None => reach,
        };
        time(unhindered)
    }

    /// Searches with one weight (in quarters: 4 finds the earliest arrival) and at most `labels`
    /// labels, after
    /// [`Pathfinder::aim`] with the same start, goal and load.
    pub fn seek(
        &mut self,
        network: &Network,
        table: &Table,
        query: &Query,
        weight: Us,
        labels: u64,
    ) -> Outcome {
        match query.guidance {
            Some(_) => Search::<true>::new(self, network, table, query, weight).run(labels),
            None => Search::<false>::new(self, network, table, query, weight).run(labels),
        }
    }

    /// Time of the quickest way without other robots between the ends of the way just searched for,
    /// if no times were given; guidance is ignored.
    pub fn unhindered(&self, network: &Network, start: u32, heading: u8) -> Us {
        Us::from(self.guide.to_go(network, start, heading))
    }

    /// The least time plus extra cost without other robots of the way just aimed at.
    pub fn least_cost(&self, network: &Network, query: &Query) -> Us {
        let guide = match query.guidance {
            Some(_) => self.guide::<true>(),
            None => &self.guide,
        };
        Us::from(guide.to_go(network, query.start, query.heading))
    }

    /// The search for unhindered times or, if `GUIDED`, for costs with guidance.
    pub(super) fn guide<const GUIDED: bool>(&self) -> &Backward {
        let guided = if GUIDED { self.guided.as_deref() } else { None };
        guided.unwrap_or(&self.guide)
    }

    pub(super) fn guide_mut<const GUIDED: bool>(&mut self) -> &mut Backward {
        let guided = if GUIDED { self.guided.as_deref_mut() } else { None };
        guided.unwrap_or(&mut self.guide)
    }
}
