//! The input, indexed by what is looked up.

/// Nobody, nowhere, never.
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

/// What is given: see `rmfs.solvers.models.planning.Planning`, where all of it has been checked.
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

/// The input with what is looked up again and again.
#[derive(Clone, Debug)]
pub struct Problem {
    pub given: Given,
    pub stations: usize,
    pub pods: usize,
    /// Most visits of a station, those under way included.
    pub longest: usize,
    /// Worth of a visit, by its number, as a share of the first.
    pub decay: Vec<f64>,
    pub lines_of: Vec<Vec<u32>>,
    /// Open orders per station, in their order.
    pub open_at: Vec<Vec<u32>>,
    /// Lines of waiting orders per SKU.
    pub waiting_for: Vec<Vec<u32>>,
    pub on_pod: Vec<Vec<Stocked>>,
    pub with_sku: Vec<Vec<Stocked>>,
}

impl Problem {
    pub fn new(given: Given) -> Self {
        let (stations, skus) = (given.under_way.len(), given.skus);
        let pods = given.cost.len() / stations.max(1);
        let longest = given.under_way.iter().map(Vec::len).max().unwrap_or(0) + given.visits;
        let mut lines_of = vec![Vec::new(); given.order_station.len()];
        let mut waiting_for = vec![Vec::new(); skus];
        for (number, line) in given.lines.iter().enumerate() {
            lines_of[line.order as usize].push(number as u32);
            if given.order_station[line.order as usize] < 0 {
                waiting_for[line.sku as usize].push(number as u32);
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
        let decay = (0..=longest).map(|visit| given.decay.powi(visit as i32)).collect();
        Self {
            stations,
            pods,
            longest,
            decay,
            lines_of,
            open_at,
            waiting_for,
            on_pod,
            with_sku,
            given,
        }
    }

    /// The lines of an order.
    pub fn lines(&self, order: u32) -> impl Iterator<Item = (u32, &Line)> {
        self.lines_of[order as usize].iter().map(|&line| (line, &self.given.lines[line as usize]))
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
