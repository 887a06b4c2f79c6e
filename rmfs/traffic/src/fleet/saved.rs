//! A fleet as bytes, at any moment between two calls.
//!
//! The network, the kinds and the settings of the planner are not included: they come from the
//! layout and the settings with which the fleet is built before its state is restored.

use std::borrow::Cow;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::costs::Known;
use crate::record::Record;
use crate::reservations::Table;
use crate::robot::Robot;
use crate::units::Us;

use super::rolling::Wishes;
use super::{Counters, Due, Event, Fleet, Lateness, Leg, Pace};

/// First bytes of a saved fleet.
const MAGIC: &[u8] = b"rmfs-traffic";

/// Version of the format.
const VERSION: u8 = 8;

type Agenda = BinaryHeap<Reverse<(Us, u32, Due, u32)>>;

#[derive(Serialize, Deserialize)]
struct Saved<'a> {
    /// Hash of network and kinds.
    fingerprint: u32,
    closed: Vec<u32>,
    stored: Cow<'a, [bool]>,
    now: Us,
    robots: Cow<'a, [Robot]>,
    table: Cow<'a, Table>,
    queues: Cow<'a, [Vec<u32>]>,
    legs: Cow<'a, [Option<Leg>]>,
    blocked: Cow<'a, [u32]>,
    stalled: Cow<'a, [u32]>,
    released: Cow<'a, [u32]>,
    fresh: Cow<'a, [u32]>,
    retry_due: bool,
    agenda: Cow<'a, Agenda>,
    outbox: Cow<'a, [Event]>,
    trip_planner: Vec<u8>,
    rolling: Option<(Cow<'a, Wishes>, Vec<u8>)>,
    lateness: Cow<'a, Option<Lateness>>,
    pace: Cow<'a, Option<Pace>>,
    costs: Known,
    expansions: u64,
    counters: Cow<'a, Counters>,
    record: Cow<'a, Record>,
}

impl Fleet {
    /// The fleet as bytes.
    ///
    /// # Errors
    /// If the planner cannot be serialised.
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let rolling = self.rolling.as_ref();
        let remembered = |planner: &super::Rolling| planner.planner.remembered();
        let saved = Saved {
            fingerprint: self.network.fingerprint(&self.kinds),
            closed: self.network.closed(),
            stored: Cow::Borrowed(&self.stored),
            now: self.now,
            robots: Cow::Borrowed(&self.robots),
            table: Cow::Borrowed(&self.table),
            queues: Cow::Borrowed(&self.queues),
            legs: Cow::Borrowed(&self.legs),
            blocked: Cow::Borrowed(&self.blocked),
            stalled: Cow::Borrowed(&self.stalled),
            released: Cow::Borrowed(&self.released),
            fresh: Cow::Borrowed(&self.fresh),
            retry_due: self.retry_due,
            agenda: Cow::Borrowed(&self.agenda),
            outbox: Cow::Borrowed(&self.outbox),
            trip_planner: self.trip_planner.remembered()?,
            rolling: rolling
                .map(|own| remembered(own).map(|bytes| (Cow::Borrowed(&own.wishes), bytes)))
                .transpose()?,
            lateness: Cow::Borrowed(&self.lateness),
            pace: Cow::Borrowed(&self.pace),
            costs: self.costs.known(),
            expansions: self.pathfinder.expansions,
            counters: Cow::Borrowed(&self.counters),
            record: Cow::Borrowed(&self.record),
        };
        let mut bytes = MAGIC.to_vec();
        bytes.push(VERSION);
        let body = postcard::to_stdvec(&saved).map_err(|error| error.to_string())?;
        bytes.extend(crc32fast::hash(&body).to_le_bytes());
        bytes.extend(body);
        Ok(bytes)
    }

    /// Restores the state of a fleet that was built in the same way.
    ///
    /// # Errors
    /// If the bytes are damaged, or belong to another version, layout, fleet or planner; nothing
    /// has changed then.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), String> {
        let saved: Saved = postcard::from_bytes(body(bytes)?)
            .map_err(|error| format!("the saved traffic cannot be read: {error}"))?;
        if saved.fingerprint != self.network.fingerprint(&self.kinds) {
            return Err("the saved traffic is that of another layout".into());
        }
        if saved.robots.len() != self.robots.len()
            || saved.rolling.is_some() != self.rolling.is_some()
        {
            return Err("the saved traffic is that of other robots or another planner".into());
        }
        let mut trip_planner = self.trip_planner.clone();
        trip_planner.remember(&saved.trip_planner)?;
        let mut rolling = self.rolling.clone();
        if let (Some(own), Some((wishes, remembered))) = (&mut rolling, saved.rolling) {
            own.planner.remember(&remembered)?;
            own.wishes = wishes.into_owned();
        }
        (self.trip_planner, self.rolling) = (trip_planner, rolling);
        let network = Arc::make_mut(&mut self.network);
        for node in 0..network.nodes as u32 {
            network.set_closed(node, false);
        }
        saved.closed.iter().for_each(|&node| network.set_closed(node, true));
        self.stored = saved.stored.into_owned();
        self.now = saved.now;
        self.robots = saved.robots.into_owned();
        self.table = saved.table.into_owned();
        self.queues = saved.queues.into_owned();
        self.legs = saved.legs.into_owned();
        self.blocked = saved.blocked.into_owned();
        self.stalled = saved.stalled.into_owned();
        self.released = saved.released.into_owned();
        self.fresh = saved.fresh.into_owned();
        self.retry_due = saved.retry_due;
        self.agenda = saved.agenda.into_owned();
        self.outbox = saved.outbox.into_owned();
        self.lateness = saved.lateness.into_owned();
        self.pace = saved.pace.into_owned();
        self.costs.remember(saved.costs);
        self.pathfinder.expansions = saved.expansions;
        self.counters = saved.counters.into_owned();
        self.record = saved.record.into_owned();
        Ok(())
    }
}

/// The bytes after the header, if it is valid.
fn body(bytes: &[u8]) -> Result<&[u8], String> {
    let rest = bytes.strip_prefix(MAGIC).ok_or("these are not the bytes of saved traffic")?;
    let (&version, rest) = rest.split_first().ok_or("the saved traffic is not whole")?;
    if version != VERSION {
        return Err(format!("the saved traffic has version {version}; this is version {VERSION}"));
    }
    let (sum, body) = rest.split_at_checked(4).ok_or("the saved traffic is not whole")?;
    if sum != crc32fast::hash(body).to_le_bytes() {
        return Err("the saved traffic is damaged".into());
    }
    Ok(body)
}
