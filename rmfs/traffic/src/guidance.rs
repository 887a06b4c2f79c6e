//! Guidance: extra costs of edges, by which planners prefer some ways to others.
//!
//! The extra cost of a way, in microseconds, is added to its time when ways are compared. It changes
//! neither the motion nor the reservations of a way.

use std::sync::Arc;

use crate::network::{NONE, Network};

/// Extra cost in microseconds of the edge that leaves each (waypoint, heading), indexed as in
/// [`Network`].
pub type Guidance = Arc<[u32]>;

/// Guidance from edges (from, to, microseconds); `None` if nothing costs extra.
///
/// # Errors
/// If there is no such edge.
pub fn guidance(network: &Network, edges: &[(u32, u32, u32)]) -> Result<Option<Guidance>, String> {
    let mut extra = vec![0; network.nodes * network.heading_count()];
    for &(from, to, cost) in edges {
        let leads = |&heading: &u8| network.ahead(from, heading).is_some_and(|next| next.0 == to);
        let mut headings = 0..network.heading_count() as u8;
        let known = (from as usize) < network.nodes && to != NONE;
        let heading = if known { headings.find(leads) } else { None };
        let heading = heading.ok_or_else(|| format!("no edge leads from {from} to {to}"))?;
        extra[network.index(from, heading)] = cost;
    }
    Ok(extra.iter().any(|&cost| cost > 0).then(|| extra.into()))
}
