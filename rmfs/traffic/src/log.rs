//! An append-only list, whose copies share old entries.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

/// Number of entries in a chunk, the unit shared by copies.
const CHUNK: usize = 1 << 12;

/// Entries in the order of insertion; copying is cheap, however many there are.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Log<T> {
    /// Full chunks.
    old: Vec<Arc<Vec<T>>>,
    new: Vec<T>,
}

impl<T> Default for Log<T> {
    fn default() -> Self {
        Self { old: Vec::new(), new: Vec::new() }
    }
}

impl<T> Log<T> {
    /// Adds an entry.
    pub fn push(&mut self, entry: T) {
        self.new.push(entry);
        if self.new.len() == CHUNK {
            self.old.push(Arc::new(std::mem::take(&mut self.new)));
        }
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.old.len() * CHUNK + self.new.len()
    }

    /// Whether there are no entries.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Removes all entries.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// The entries from the `first` on, counted from 0.
    pub fn since(&self, first: usize) -> impl Iterator<Item = &T> {
        let (chunk, rest) = ((first / CHUNK).min(self.old.len()), first % CHUNK);
        let skipped = if first >= self.len() { self.len() } else { rest };
        let chunks = self.old[chunk..].iter().flat_map(|old| old.iter());
        chunks.chain(&self.new).skip(skipped)
    }

    /// All entries.
    pub fn iter(&self) -> impl Iterator<Item = &T> {
        self.since(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_come_back_from_any_on() {
        let mut log = Log::default();
        let count = 2 * CHUNK + 5;
        (0..count).for_each(|entry| log.push(entry));
        assert_eq!(log.len(), count);
        for first in [0, 1, CHUNK - 1, CHUNK, CHUNK + 1, 2 * CHUNK, count - 1, count, count + CHUNK]
        {
            assert!(log.since(first).copied().eq(first..count.max(first)), "{first}");
        }
    }

    #[test]
    fn a_copy_goes_its_own_way() {
        let mut log = Log::default();
        (0..CHUNK + 1).for_each(|entry| log.push(entry));
        let mut copy = log.clone();
        copy.push(7);
        log.push(8);
        assert_eq!((log.len(), copy.len()), (CHUNK + 2, CHUNK + 2));
        assert_eq!((log.iter().last(), copy.iter().last()), (Some(&8), Some(&7)));
        log.clear();
        assert!(log.is_empty() && copy.iter().take(CHUNK).copied().eq(0..CHUNK));
    }
}
