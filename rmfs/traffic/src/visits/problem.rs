//! The input, with indices for fast look-ups.

/// Marks a missing order, station or visit.
pub const NONE: i32 = -1;

/// A line as it is given.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    pub order: u32,
    pub sku: u32,
    pub units: i64,
    pub worth: f64,
}

/// A SKU on a pod, or a pod with a SKU, and the units.
#[derive(Clone, Copy, Debug)]
pub struct Stocked {
    pub of: u32,
    pub units: i64,
}

/// The input; see `rmfs.solvers.models.planning.Planning`, which validates it.
///
/// SKUs are numbered among those of the lines.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// Pods under way per station, in their order.
    pub under_way: Vec<Vec<u32>>,
    /// Orders that a station may keep from one visit to the next.
    pub kept: Vec<usize>,
    pub order_station: Vec<i32>,
    pub order_until: Vec<i32>,
    pub order_worth: Vec<f64>,
    pub lines: Vec<Line>,
    pub skus: usize,
    /// Units per pod and SKU, row by row.
    pub stock: Vec<i64>,
    /// Cost per pod and station, row by row.
    pub cost: Vec<f64>,
    pub visits: usize,
    pub decay: f64,
}

/// The input with tables for frequent look-ups.
#[derive(Clone, Debug)]
pub struct Problem {
    pub given: Given,
    pub stations: usize,
    pub pods: usize,
    /// Maximum number of visits of a station, including those under way.
    pub longest: usize,
    /// Worth of a visit, by its number, as a share of the first.
    pub decay: Vec<f64>,
    pub lines_of: Vec<Vec<u32>>,
    /// Open orders per station, in their order.
    pub open_at: Vec<Vec<u32>>,
    pub on_pod: Vec<Vec<Stocked>>,
    pub with_sku: Vec<Vec<Stocked>>,
    /// Number of words of a set of lines.
    pub words: usize,
    /// Lines of which each pod has the units, as sets, row by row.
    serves: Vec<u64>,
    /// Lines of waiting orders, as a set.
    pub waiting: Vec<u64>,
}

impl Problem {
    pub fn new(given: Given) -> Self {
        let (stations, skus) = (given.under_way.len(), given.skus);
        let pods = given.cost.len() / stations.max(1);
        let longest = given.under_way.iter().map(Vec::len).max().unwrap_or(0) + given.visits;
        let mut lines_of = vec![Vec::new(); given.order_station.len()];
        let words = given.lines.len().div_ceil(64);
        let mut waiting = vec![0; words];
        for (number, line) in given.lines.iter().enumerate() {
            lines_of[line.order as usize].push(number as u32);
            if given.order_station[line.order as usize] < 0 {
                put(&mut waiting, number as u32);
            }
        }
        let mut open_at = vec![Vec::new(); stations];
        for (order, &station) in given.order_station.iter().enumerate() {
            if station >= 0 {
                open_at[station as usize].push(order as u32);
            }
        }
        let mut on_pod = vec![Vec::new(); pods];
        let mut with_sku = vec![Vec::new(); skus];
        for (pod, row) in on_pod.iter_mut().enumerate() {
            let stock = &given.stock[pod * skus..(pod + 1) * skus];
            for (sku, &units) in stock.iter().enumerate().filter(|(_, units)| **units > 0) {
                row.push(Stocked { of: sku as u32, units });
                with_sku[sku].push(Stocked { of: pod as u32, units });
            }
        }
        let mut serves = vec![0; pods * words];
        for (number, line) in given.lines.iter().enumerate() {
            let enough = |stocked: &&Stocked| stocked.units >= line.units;
            for stocked in with_sku[line.sku as usize].iter().filter(enough) {
                let row = stocked.of as usize * words;
                put(&mut serves[row..row + words], number as u32);
            }
        }
        let decay = (0..=longest).map(|visit| given.decay.powi(visit as i32)).collect();
        Self {
            stations,
            pods,
            longest,
            decay,
            lines_of,
            open_at,
            on_pod,
            with_sku,
            words,
            serves,
            waiting,
            given,
        }
    }

    /// The lines of an order.
    pub fn lines(&self, order: u32) -> impl Iterator<Item = (u32, &Line)> {
        self.lines_of[order as usize].iter().map(|&line| (line, &self.given.lines[line as usize]))
    }

    /// Lines of which a pod has the units, as a set.
    pub fn serves(&self, pod: u32) -> &[u64] {
        &self.serves[pod as usize * self.words..][..self.words]
    }

    pub fn cost(&self, pod: u32, station: usize) -> f64 {
        self.given.cost[pod as usize * self.stations + station]
    }

    pub fn units(&self, pod: u32, sku: u32) -> i64 {
        self.given.stock[pod as usize * self.given.skus + sku as usize]
    }

    /// The number of the first new visit of a station.
    pub fn first(&self, station: usize) -> usize {
        self.given.under_way[station].len()
    }
}

/// Puts a line into a set.
pub fn put(set: &mut [u64], line: u32) {
    set[line as usize / 64] |= 1 << (line % 64);
}

/// Takes a line out of a set.
pub fn take_out(set: &mut [u64], line: u32) {
    set[line as usize / 64] &= !(1 << (line % 64));
}

/// Whether a line is in a set.
pub fn has(set: &[u64], line: u32) -> bool {
    set[line as usize / 64] >> (line % 64) & 1 == 1
}

/// The lines of a set, given by its words, in order.
pub fn lines_in(words: impl Iterator<Item = u64>) -> impl Iterator<Item = u32> {
    words.enumerate().flat_map(|(word, bits)| {
        let mut left = bits;
        std::iter::from_fn(move || {
            let bit = (left != 0).then(|| left.trailing_zeros())?;
            left &= left - 1;
            Some(word as u32 * 64 + bit)
        })
    })
}
