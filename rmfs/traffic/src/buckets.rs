//! A priority queue for searches whose costs are times.

use crate::costs::UNREACHABLE;

/// Width of a bucket in microseconds: about a third of an edge.
const BUCKET: u32 = 1 << 18;

/// A queue of states in buckets of their total time; improving a state again is allowed.
#[derive(Clone, Debug)]
pub struct Buckets {
    /// Least cost of each state, and the number of the search that found it.
    best: Vec<(u32, u32)>,
    /// Number of the current search.
    stamp: u32,
    buckets: Vec<Vec<(u32, u32)>>,
    at: usize,
    waiting: usize,
}

impl Buckets {
    /// A queue for states `0..states`.
    pub fn new(states: usize) -> Self {
        Self {
            best: vec![(0, UNREACHABLE); states],
            stamp: 0,
            buckets: Vec::new(),
            at: 0,
            waiting: 0,
        }
    }

    /// Clears the queue.
    pub fn clear(&mut self) {
        self.stamp += 1;
        let first = self.at.min(self.buckets.len());
        for bucket in &mut self.buckets[first..] {
            bucket.clear();
        }
        self.at = 0;
        self.waiting = 0;
    }

    /// The least cost offered for a state, or `UNREACHABLE`.
    #[inline]
    pub fn best(&self, state: usize) -> u32 {
        let (stamp, cost) = self.best[state];
        if stamp == self.stamp { cost } else { UNREACHABLE }
    }

    /// Stores a cost for a state if it is less than the known one, without queueing the state.
    #[inline]
    pub fn note(&mut self, state: usize, cost: u32) {
        if cost < self.best(state) {
            self.best[state] = (self.stamp, cost);
        }
    }

    /// Offers a cost for a state; `total` (cost plus bound of the rest) determines its place in the
    /// queue.
    #[inline]
    pub fn improve(&mut self, state: usize, cost: u32, total: u32) {
        if cost >= self.best(state) {
            return;
        }
        self.best[state] = (self.stamp, cost);
        let bucket = ((total / BUCKET) as usize).max(self.at);
        if bucket >= self.buckets.len() {
            self.buckets.resize_with(bucket + 1, Vec::new);
        }
        self.buckets[bucket].push((cost, state as u32));
        self.waiting += 1;
    }

    /// The next state whose bucket ends at or before `limit`.
    pub fn pop(&mut self, limit: u32) -> Option<(u32, usize)> {
        while self.waiting > 0 && (self.at as u32).saturating_mul(BUCKET) < limit {
            while let Some((cost, state)) = self.buckets[self.at].pop() {
                self.waiting -= 1;
                if self.best(state as usize) == cost {
                    return Some((cost, state as usize));
                }
            }
            self.at += 1;
        }
        None
    }

    /// All states with a total time below this are final.
    pub fn settled(&self) -> u32 {
        if self.waiting == 0 { UNREACHABLE } else { (self.at as u32).saturating_mul(BUCKET) }
    }

    /// Whether the queue is empty.
    pub fn exhausted(&self) -> bool {
        self.waiting == 0
    }
}
