//! Lower bounds of the time between a waypoint and others without other robots: straight lines along
//! both axes and, on request, turns.

use std::cmp::Ordering;

use crate::costs::Model;
use crate::network::Network;
use crate::units::{MicroTurn, TURN};

/// Keeps the bound from the start below the sum of rounded edge times.
const SAFETY: f64 = 0.999_99;

/// Least times to cover an extent along one axis: as whole runs, or as part of a run already
/// counted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bound {
    pub at_rest: u32,
    pub rolling: u32,
}

impl Bound {
    fn of(model: &Model, metres: f64) -> Self {
        let safe = |time: u32| (f64::from(time) * SAFETY) as u32;
        Self { at_rest: safe(model.run(metres)), rolling: safe(model.roll(metres)) }
    }
}

/// Prepares bounds of the times from a waypoint: a way covers its extent in x and in y by at least
/// one run each. Without a waypoint they are 0.
pub(super) fn bounds(
    network: &Network,
    model: &Model,
    from: Option<u32>,
    columns: &mut Vec<Bound>,
    rows: &mut Vec<Bound>,
) {
    let position = from.map(|node| network.position(node));
    let along = |places: &[f64], at: Option<f64>, into: &mut Vec<Bound>| {
        into.clear();
        into.extend(places.iter().map(|place| match at {
            Some(at) => Bound::of(model, (place - at).abs()),
            None => Bound::default(),
        }));
    };
    along(&network.columns, position.map(|p| p.0), columns);
    along(&network.rows, position.map(|p| p.1), rows);
}

/// On which side of the start a waypoint lies along an axis.
#[derive(Clone, Copy, Debug)]
enum Side {
    Neither,
    Greater,
    Smaller,
}

impl Side {
    const COUNT: usize = 3;

    fn of(offset: f64) -> Self {
        match offset.total_cmp(&0.0) {
            Ordering::Equal => Self::Neither,
            Ordering::Greater => Self::Greater,
            Ordering::Less => Self::Smaller,
        }
    }
}

/// Lower bounds of the turning time from a heading at the start to another at a waypoint. A way to a
/// waypoint faces each direction in which the waypoint lies.
#[derive(Clone, Debug, Default)]
pub(super) struct Turns {
    columns: Vec<Side>,
    rows: Vec<Side>,
    headings: usize,
    /// Bounds by side in x, side in y, and heading.
    bounds: Vec<u32>,
}

impl Turns {
    /// Prepares the bounds from a heading at a start.
    pub fn prepare(&mut self, network: &Network, model: &Model, start: u32, from: u8) {
        let (x, y) = network.position(start);
        self.columns.clear();
        self.columns.extend(network.columns.iter().map(|column| Side::of(column - x)));
        self.rows.clear();
        self.rows.extend(network.rows.iter().map(|row| Side::of(row - y)));
        self.headings = network.heading_count();
        self.bounds.clear();
        let heading = |angle| network.headings.binary_search(&angle).ok().map(|index| index as u8);
        let along = |greater: MicroTurn| [None, heading(greater), heading(greater + TURN / 2)];
        for x in along(0) {
            for y in along(TURN / 4) {
                let over = |through: [Option<u8>; 2], to: u8| {
                    let mut at = from;
                    let stops = through.into_iter().flatten().chain([to]);
                    stops.map(|next| model.turning(std::mem::replace(&mut at, next), next)).sum()
                };
                let least = |to: u8| u32::min(over([x, y], to), over([y, x], to));
                self.bounds.extend((0..self.headings as u8).map(least));
            }
        }
    }

    /// A lower bound of the turning time to (waypoint, heading).
    #[inline]
    pub fn bound(&self, network: &Network, node: u32, heading: u8) -> u32 {
        let (column, row) = network.cells[node as usize];
        let sides = (self.columns[column as usize], self.rows[row as usize]);
        let case = sides.0 as usize * Side::COUNT + sides.1 as usize;
        self.bounds[case * self.headings + usize::from(heading)]
    }
}
