//! Which orders go with given visits.
//!
//! Open orders come first, each line in the first visit that has its units. A waiting order takes
//! the visits closest together that have its lines: first the orders of one visit, which keep no
//! slot, then those of visits next to each other, and so on; among them those that begin first.

use super::problem::{NONE, Problem};

/// Visits and what they serve.
#[derive(Clone, Debug)]
pub struct Draft {
    pub at: Vec<Station>,
    /// Station of each order; open orders have theirs from the start.
    pub order_station: Vec<i32>,
    /// Visit of each line.
    pub line_visit: Vec<i32>,
}

/// What a station does.
#[derive(Clone, Debug, Default)]
pub struct Station {
    /// Pods of new visits.
    pub pods: Vec<u32>,
    /// Worth of what is served and closed less the cost of the visits.
    pub value: f64,
    /// Units served.
    pub units: i64,
    /// Lines served, and waiting orders taken.
    lines: Vec<u32>,
    orders: Vec<u32>,
}

impl Draft {
    /// Given visits, nothing served yet.
    pub fn new(problem: &Problem, pods: &[Vec<u32>]) -> Self {
        let at = pods.iter().map(|pods| Station { pods: pods.clone(), ..Station::default() });
        Self {
            at: at.collect(),
            order_station: problem.given.order_station.clone(),
            line_visit: vec![NONE; problem.given.lines.len()],
        }
    }

    /// The objective with the other sign.
    pub fn value(&self) -> f64 {
        self.at.iter().map(|station| station.value).sum()
    }

    pub fn pods(&self) -> Vec<Vec<u32>> {
        self.at.iter().map(|station| station.pods.clone()).collect()
    }

    /// Lets go what a station serves.
    fn release(&mut self, station: usize) {
        let at = &mut self.at[station];
        for line in at.lines.drain(..) {
            self.line_visit[line as usize] = NONE;
        }
        for order in at.orders.drain(..) {
            self.order_station[order as usize] = NONE;
        }
    }

    /// What some stations do, to be put back.
    pub fn saved(&self, stations: &[usize]) -> Vec<(usize, Station, Vec<i32>)> {
        let visits = |at: &Station| at.lines.iter().map(|&l| self.line_visit[l as usize]).collect();
        stations.iter().map(|&s| (s, self.at[s].clone(), visits(&self.at[s]))).collect()
    }

    /// Puts back what some stations did.
    pub fn restore(&mut self, saved: Vec<(usize, Station, Vec<i32>)>) {
        for (station, _, _) in &saved {
            self.release(*station);
        }
        for (station, at, visits) in saved {
            for (&line, visit) in at.lines.iter().zip(visits) {
                self.line_visit[line as usize] = visit;
            }
            for &order in &at.orders {
                self.order_station[order as usize] = station as i32;
            }
            self.at[station] = at;
        }
    }
}

/// Which order could go where: the fewer visits it spans and the sooner it begins, the sooner it is
/// served.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Chance {
    length: u8,
    begin: u8,
    order: u32,
    /// The number of the station among those that are filled.
    number: u32,
}

/// Fills visits with orders; keeps the tables it needs for that.
pub struct Filling<'a> {
    pub problem: &'a Problem,
    /// Entries of stock and lines looked at so far.
    pub work: u64,
    /// Units left, per filled station, visit and SKU.
    left: Vec<i64>,
    /// Orders kept, per filled station and visit.
    kept: Vec<u32>,
    /// Visits that have enough for a line, as bits, and the lines that have such visits.
    enough: Vec<u64>,
    touched: Vec<u32>,
    /// Lines of an order with such visits.
    covered: Vec<u32>,
    chances: Vec<Chance>,
    /// Visits that serve something, as bits, per filled station.
    used: Vec<u64>,
}

impl<'a> Filling<'a> {
    pub fn new(problem: &'a Problem) -> Self {
        let rows = problem.stations * problem.longest;
        Self {
            problem,
            work: 0,
            left: vec![0; rows * problem.given.skus],
            kept: vec![0; rows],
            enough: vec![0; problem.given.lines.len()],
            touched: Vec::new(),
            covered: vec![0; problem.lines_of.len()],
            chances: Vec::new(),
            used: vec![0; problem.stations],
        }
    }

    /// Fills given visits of all stations; new ones that would serve nothing are left out.
    pub fn draft(&mut self, pods: &[Vec<u32>]) -> Draft {
        let mut draft = Draft::new(self.problem, pods);
        let all: Vec<usize> = (0..self.problem.stations).collect();
        self.fill(&mut draft, &all);
        draft
    }

    /// Fills the visits of some stations anew, with what the others leave; new visits that would
    /// serve nothing are left out.
    pub fn fill(&mut self, draft: &mut Draft, stations: &[usize]) {
        loop {
            for &station in stations {
                draft.release(station);
            }
            self.chances.clear();
            for (number, &station) in stations.iter().enumerate() {
                self.begin(draft, number, station);
            }
            self.serve_waiting(draft, stations);
            let mut done = true;
            for (number, &station) in stations.iter().enumerate() {
                self.clear(draft, number, station);
                done &= self.leave_out(draft, number, station);
            }
            if done {
                return;
            }
        }
    }

    fn row(&self, number: usize, visit: usize) -> usize {
        number * self.problem.longest + visit
    }

    fn cell(&self, number: usize, visit: usize, sku: u32) -> usize {
        self.row(number, visit) * self.problem.given.skus + sku as usize
    }

    fn pod(&self, draft: &Draft, station: usize, visit: usize) -> u32 {
        let before = &self.problem.given.under_way[station];
        before.get(visit).copied().unwrap_or_else(|| draft.at[station].pods[visit - before.len()])
    }

    fn visits(&self, draft: &Draft, station: usize) -> usize {
        self.problem.first(station) + draft.at[station].pods.len()
    }

    /// Lays out the stock of a station's visits, serves its open orders, and looks for chances.
    fn begin(&mut self, draft: &mut Draft, number: usize, station: usize) {
        let problem = self.problem;
        let visits = self.visits(draft, station);
        let mut cost = 0.0;
        for visit in 0..visits {
            let pod = self.pod(draft, station, visit);
            let row = self.row(number, visit);
            self.kept[row] = 0;
            for stocked in &problem.on_pod[pod as usize] {
                self.left[row * problem.given.skus + stocked.of as usize] = stocked.units;
            }
            self.work += 2 * problem.on_pod[pod as usize].len() as u64; // laid out, and cleared
            if visit >= problem.first(station) {
                cost += problem.cost(pod, station) * problem.decay[visit];
            }
        }
        self.used[number] = 0;
        draft.at[station].value = -cost;
        draft.at[station].units = 0;
        self.serve_open(draft, number, station, visits);
        self.look(draft, number, station, visits);
    }

    /// Serves a line of a station in a visit.
    fn serve(&mut self, draft: &mut Draft, number: usize, station: usize, line: u32, visit: usize) {
        let given = &self.problem.given.lines[line as usize];
        let cell = self.cell(number, visit, given.sku);
        self.left[cell] -= given.units;
        self.used[number] |= 1 << visit;
        draft.line_visit[line as usize] = visit as i32;
        let at = &mut draft.at[station];
        at.lines.push(line);
        at.units += given.units;
        at.value += given.worth * self.problem.decay[visit];
    }

    /// Serves open orders as soon as possible.
    fn serve_open(&mut self, draft: &mut Draft, number: usize, station: usize, visits: usize) {
        let problem = self.problem;
        for &order in &problem.open_at[station] {
            let mut last = problem.given.order_until[order as usize];
            let mut missing = false;
            for (line, given) in problem.lines(order) {
                let has = |&v: &usize| self.left[self.cell(number, v, given.sku)] >= given.units;
                let Some(visit) = (0..visits).find(has) else {
                    missing = true;
                    continue;
                };
                self.serve(draft, number, station, line, visit);
                last = last.max(visit as i32);
            }
            self.work += problem.lines_of[order as usize].len() as u64;
            if missing {
                last = visits as i32;
            } else if last >= 0 {
                let worth = problem.given.order_worth[order as usize];
                draft.at[station].value += worth * problem.decay[last as usize];
            }
            for visit in 0..last.max(0) as usize {
                let row = self.row(number, visit);
                self.kept[row] += 1;
            }
        }
    }

    /// Collects the waiting orders all of whose lines some visits of a station have.
    fn look(&mut self, draft: &Draft, number: usize, station: usize, visits: usize) {
        let problem = self.problem;
        self.touched.clear();
        for visit in 0..visits {
            let pod = self.pod(draft, station, visit);
            for stocked in &problem.on_pod[pod as usize] {
                let left = self.left[self.cell(number, visit, stocked.of)];
                let lines = &problem.waiting_for[stocked.of as usize];
                self.work += lines.len() as u64;
                for &line in lines {
                    let given = &problem.given.lines[line as usize];
                    if left < given.units || draft.order_station[given.order as usize] >= 0 {
                        continue;
                    }
                    let enough = &mut self.enough[line as usize];
                    if *enough == 0 {
                        self.touched.push(line);
                        self.covered[given.order as usize] += 1;
                    }
                    *enough |= 1 << visit;
                }
            }
        }
        self.work += 8 * self.touched.len() as u64;
        for touched in 0..self.touched.len() {
            let order = problem.given.lines[self.touched[touched] as usize].order;
            let lines = &problem.lines_of[order as usize];
            if self.covered[order as usize] as usize == lines.len() {
                self.covered[order as usize] = 0; // once is enough
                let masks = lines.iter().map(|&line| self.enough[line as usize]);
                if let Some((begin, end)) = closest(masks) {
                    let (length, begin) = ((end - begin) as u8, begin as u8);
                    self.chances.push(Chance { length, begin, order, number: number as u32 });
                }
            }
        }
        for &line in &self.touched {
            self.enough[line as usize] = 0;
            self.covered[problem.given.lines[line as usize].order as usize] = 0;
        }
    }

    /// Visits with enough units left for a line, as bits.
    fn having(&self, number: usize, visits: usize, line: u32) -> u64 {
        let given = &self.problem.given.lines[line as usize];
        let has = |v: usize| u64::from(self.left[self.cell(number, v, given.sku)] >= given.units);
        (0..visits).fold(0, |bits, visit| bits | has(visit) << visit)
    }

    /// Gives waiting orders a station and visits.
    fn serve_waiting(&mut self, draft: &mut Draft, stations: &[usize]) {
        let problem = self.problem;
        let mut chances = std::mem::take(&mut self.chances);
        chances.sort_unstable();
        self.work += 24 * chances.len() as u64; // sorting, and serving in between
        let mut masks = Vec::new();
        for chance in &chances {
            let (order, number) = (chance.order, chance.number as usize);
            if draft.order_station[order as usize] >= 0 {
                continue;
            }
            let station = stations[number];
            let visits = self.visits(draft, station);
            masks.clear();
            for &line in &problem.lines_of[order as usize] {
                masks.push(self.having(number, visits, line));
                self.work += visits as u64;
            }
            // where others have not taken the units meanwhile, these are the visits found before
            let Some((begin, end)) = closest(masks.iter().copied()) else { continue };
            if !self.keep(number, station, begin as usize, end as usize) {
                continue;
            }
            for (&line, &mask) in problem.lines_of[order as usize].iter().zip(&masks) {
                let visit = begin + (mask >> begin).trailing_zeros();
                self.serve(draft, number, station, line, visit as usize);
            }
            let at = &mut draft.at[station];
            at.orders.push(order);
            at.value += problem.given.order_worth[order as usize] * problem.decay[end as usize];
            draft.order_station[order as usize] = station as i32;
        }
        self.chances = chances;
    }

    /// Keeps a slot from the first to the last visit of an order, if there is one.
    fn keep(&mut self, number: usize, station: usize, begin: usize, end: usize) -> bool {
        let rows = self.row(number, begin)..self.row(number, end);
        let most = self.problem.given.kept[station];
        if self.kept[rows.clone()].iter().any(|&kept| kept as usize >= most) {
            return false;
        }
        for kept in &mut self.kept[rows] {
            *kept += 1;
        }
        true
    }

    /// Empties the table of a station's stock again.
    fn clear(&mut self, draft: &Draft, number: usize, station: usize) {
        let problem = self.problem;
        for visit in 0..self.visits(draft, station) {
            let row = self.row(number, visit);
            let pod = self.pod(draft, station, visit);
            for stocked in &problem.on_pod[pod as usize] {
                self.left[row * problem.given.skus + stocked.of as usize] = 0;
            }
        }
    }

    /// Takes out new visits that serve nothing; whether there were none.
    fn leave_out(&self, draft: &mut Draft, number: usize, station: usize) -> bool {
        let (first, used) = (self.problem.first(station), self.used[number]);
        let pods = &mut draft.at[station].pods;
        let before = pods.len();
        let mut visit = first;
        pods.retain(|_| {
            visit += 1;
            used >> (visit - 1) & 1 == 1
        });
        pods.len() == before
    }
}

/// The visits closest together, the first if there are more, that have a bit of every mask: the
/// first and the last of them.
fn closest(masks: impl Iterator<Item = u64> + Clone) -> Option<(u32, u32)> {
    let mut begins = masks.clone().fold(0, |bits, mask| bits | mask);
    let mut best: Option<(u32, u32)> = None;
    while begins != 0 {
        let begin = begins.trailing_zeros();
        begins &= begins - 1;
        let mut end = begin;
        for mask in masks.clone() {
            let later = mask >> begin;
            if later == 0 {
                return best;
            }
            end = end.max(begin + later.trailing_zeros());
        }
        if best.is_none_or(|(first, last)| end - begin < last - first) {
            best = Some((begin, end));
            if begin == end {
                return best;
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::closest;

    #[test]
    fn the_shortest_window_and_of_those_the_first() {
        assert_eq!(closest([0b1000, 0b0110].into_iter()), Some((2, 3)));
        assert_eq!(closest([0b1001, 0b1010].into_iter()), Some((3, 3)));
        assert_eq!(closest([0b10001, 0b100010].into_iter()), Some((0, 1)));
        assert_eq!(closest([0b1, 0].into_iter()), None);
    }
}
