//! Reservations of resources by robots: sorted, disjoint time intervals per resource.

use serde::{Deserialize, Serialize};

use crate::units::{FOREVER, Us};

/// A half-open occupation `[start, end)` by one robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Interval {
    pub start: Us,
    pub end: Us,
    pub robot: u32,
}

/// Possible departure times: disjoint closed intervals, ascending.
pub type Windows = Vec<(Us, Us)>;

/// The reservation table.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Table {
    rows: Vec<Vec<Interval>>,
}

impl Table {
    /// A table of `resources` empty rows.
    pub fn new(resources: usize) -> Self {
        Self { rows: vec![Vec::new(); resources] }
    }

    /// The occupations of a resource, ascending.
    pub fn row(&self, resource: u32) -> &[Interval] {
        &self.rows[resource as usize]
    }

    /// The end of the last reservation that has one.
    pub fn horizon(&self) -> Us {
        let ends = self.rows.iter().flatten().map(|interval| interval.end);
        ends.filter(|&end| end < FOREVER).max().unwrap_or(0)
    }

    /// Adds an occupation and removes those that ended before `now`.
    ///
    /// # Panics
    /// If it overlaps another: plans are checked before they are inserted, so this is a defect.
    pub fn insert(&mut self, resource: u32, new: Interval, now: Us) {
        let row = &mut self.rows[resource as usize];
        row.retain(|old| old.end > now);
        let at = row.partition_point(|old| old.start < new.start);
        let clear_before = at == 0 || row[at - 1].end <= new.start;
        let clear_after = at == row.len() || new.end <= row[at].start;
        assert!(clear_before && clear_after, "reservation {new:?} on {resource} overlaps {row:?}");
        row.insert(at, new);
    }

    /// The first robot that occupies the resource during `[start, end)`, if any.
    pub fn occupant(&self, resource: u32, start: Us, end: Us) -> Option<Interval> {
        let row = &self.rows[resource as usize];
        let at = row.partition_point(|old| old.end <= start);
        row.get(at).filter(|old| old.start < end).copied()
    }

    /// Adds an occupation together with whatever it overlaps: one interval, of the new robot.
    pub fn cover(&mut self, resource: u32, mut new: Interval) {
        let row = &mut self.rows[resource as usize];
        row.retain(|old| {
            let touches = old.start < new.end && new.start < old.end;
            if touches {
                new.start = new.start.min(old.start);
                new.end = new.end.max(old.end);
            }
            !touches
        });
        let at = row.partition_point(|old| old.start < new.start);
        row.insert(at, new);
    }

    /// Replaces the row of a resource.
    pub fn replace(&mut self, resource: u32, row: Vec<Interval>) {
        self.rows[resource as usize] = row;
    }

    /// Empties the table and sets its number of rows.
    pub fn reset(&mut self, resources: usize) {
        self.rows.iter_mut().for_each(Vec::clear);
        self.rows.resize_with(resources, Vec::new);
    }

    /// Removes every occupation of a resource by a robot.
    pub fn remove(&mut self, resource: u32, robot: u32) {
        self.rows[resource as usize].retain(|old| old.robot != robot);
    }

    /// The robot that holds the resource without a planned end, if any.
    pub fn final_holder(&self, resource: u32) -> Option<u32> {
        self.rows[resource as usize]
            .last()
            .filter(|last| last.end == FOREVER)
            .map(|last| last.robot)
    }

    /// The free interval around `time`, or `None` if the resource is occupied then.
    pub fn gap_at(&self, resource: u32, time: Us) -> Option<(Us, Us)> {
        let row = &self.rows[resource as usize];
        let at = row.partition_point(|old| old.start <= time);
        let start = if at == 0 { -FOREVER } else { row[at - 1].end };
        let end = row.get(at).map_or(FOREVER, |next| next.start);
        (start <= time).then_some((start, end))
    }

    /// All free intervals, ascending.
    pub fn gaps(&self, resource: u32) -> impl Iterator<Item = (Us, Us)> + '_ {
        let row = &self.rows[resource as usize];
        (0..=row.len()).map(move |i| {
            let start = if i == 0 { -FOREVER } else { row[i - 1].end };
            let end = row.get(i).map_or(FOREVER, |next| next.start);
            (start, end)
        })
    }

    /// Removes from `windows` the departures `s` for which a robot that occupies the resource
    /// during `[s + enter, s + leave)` would meet another.
    pub fn restrict(&self, resource: u32, enter: Us, leave: Us, windows: &mut Windows) {
        let Some(&(first, _)) = windows.first() else { return };
        for occupied in &self.rows[resource as usize] {
            if occupied.end - enter <= first {
                continue;
            }
            exclude(windows, occupied.start - leave, occupied.end - enter);
            if windows.is_empty() {
                return;
            }
        }
    }
}

/// Cuts the open interval `(from, to)` out of the windows.
fn exclude(windows: &mut Windows, from: Us, to: Us) {
    let mut i = 0;
    while i < windows.len() {
        let (low, high) = windows[i];
        if low >= to {
            break;
        }
        if high <= from {
            i += 1;
            continue;
        }
        match (low <= from, high >= to) {
            (true, true) => {
                windows[i].1 = from;
                windows.insert(i + 1, (to, high));
                i += 2;
            }
            (true, false) => {
                windows[i].1 = from;
                i += 1;
            }
            (false, true) => {
                windows[i].0 = to;
                i += 1;
            }
            (false, false) => {
                windows.remove(i);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excluding_splits_cuts_and_removes() {
        let mut windows = vec![(0, 10), (20, 30)];
        exclude(&mut windows, 3, 5);
        assert_eq!(windows, [(0, 3), (5, 10), (20, 30)]);
        exclude(&mut windows, 8, 25);
        assert_eq!(windows, [(0, 3), (5, 8), (25, 30)]);
        exclude(&mut windows, -1, 4);
        assert_eq!(windows, [(5, 8), (25, 30)]);
        exclude(&mut windows, 25, 30);
        assert_eq!(windows, [(5, 8), (25, 25), (30, 30)]);
    }

    #[test]
    fn gaps_are_the_complement() {
        let mut table = Table::new(1);
        table.insert(0, Interval { start: 10, end: 20, robot: 1 }, 0);
        table.insert(0, Interval { start: 20, end: 25, robot: 2 }, 0);
        table.insert(0, Interval { start: 2, end: 4, robot: 3 }, 0);
        assert_eq!(
            table.gaps(0).collect::<Vec<_>>(),
            [(-FOREVER, 2), (4, 10), (20, 20), (25, FOREVER)]
        );
        assert_eq!(table.gap_at(0, 5), Some((4, 10)));
        assert_eq!(table.gap_at(0, 12), None);
        table.remove(0, 1);
        assert_eq!(table.gap_at(0, 12), Some((4, 20)));
    }

    #[test]
    fn occupants_are_found_and_covered() {
        let mut table = Table::new(1);
        table.insert(0, Interval { start: 10, end: 20, robot: 1 }, 0);
        table.insert(0, Interval { start: 30, end: 40, robot: 2 }, 0);
        assert_eq!(table.occupant(0, 0, 10), None);
        assert_eq!(table.occupant(0, 20, 30), None);
        assert_eq!(table.occupant(0, 19, 35).map(|found| found.robot), Some(1));
        assert_eq!(table.occupant(0, 20, 31).map(|found| found.robot), Some(2));
        table.cover(0, Interval { start: 15, end: 25, robot: 3 });
        table.cover(0, Interval { start: 24, end: 26, robot: 4 });
        assert_eq!(
            table.row(0),
            [Interval { start: 10, end: 26, robot: 4 }, Interval { start: 30, end: 40, robot: 2 }]
        );
    }

    #[test]
    #[should_panic(expected = "overlaps")]
    fn overlapping_reservations_are_defects() {
        let mut table = Table::new(1);
        table.insert(0, Interval { start: 10, end: 20, robot: 1 }, 0);
        table.insert(0, Interval { start: 19, end: 25, robot: 2 }, 0);
    }

    #[test]
    fn restricting_agrees_with_trying_every_departure() {
        let mut state = 7_u64;
        let mut random = |limit: u64| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % limit) as Us
        };
        for _ in 0..500 {
            let mut table = Table::new(1);
            let mut at = 0;
            for robot in 0..4 {
                let start = at + random(6);
                at = start + 1 + random(6);
                table.insert(0, Interval { start, end: at, robot }, -1);
            }
            let enter = random(5);
            let leave = enter + 1 + random(5);
            let mut windows = vec![(-12, 45)];
            table.restrict(0, enter, leave, &mut windows);
            for s in -12..=45 {
                let free = table.row(0).iter().all(|r| s + leave <= r.start || s + enter >= r.end);
                let allowed = windows.iter().any(|&(low, high)| low <= s && s <= high);
                assert_eq!(free, allowed, "{s} {enter} {leave} {:?} {windows:?}", table.row(0));
            }
        }
    }
}
