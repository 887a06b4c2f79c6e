//! Assignment of orders to given visits.
//!
//! Open orders come first, each line in the first visit that has its units. A waiting order takes
//! the visits closest together that have its lines: first the orders of one visit, which keep no
//! slot, then those of visits next to each other, and so on; among them those that begin first.

use super::draft::Draft;
use super::problem::{Problem, has, lines_in};

/// An order that a station could serve: the fewer visits it spans and the sooner it begins, the
/// earlier it is considered. It is encoded as one number, as these are sorted very often.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Chance(u64);

impl Chance {
    fn new((begin, end): (u32, u32), order: u32, number: usize) -> Self {
        let (length, begin) = (u64::from(end - begin), u64::from(begin));
        Self(length << 56 | begin << 48 | u64::from(order) << 16 | number as u64)
    }

    fn order(self) -> u32 {
        (self.0 >> 16) as u32
    }

    /// The number of the station among those that are filled.
    fn number(self) -> usize {
        self.0 as usize & 0xFFFF
    }
}

/// Fills visits with orders; keeps the tables it needs for that.
pub struct Filling<'a> {
    pub problem: &'a Problem,
    /// Entries of stock and lines examined so far.
    pub work: u64,
    /// Pods, per filled station and visit.
    pods: Vec<u32>,
    /// Units taken, per filled station, visit and SKU, and where there are any.
    taken: Vec<i64>,
    touched: Vec<usize>,
    /// Orders kept, per filled station and visit.
    kept: Vec<u32>,
    /// Visits that have enough for a waiting line, as bits, per filled station and line, and where
    /// there are any.
    enough: Vec<u64>,
    found: Vec<usize>,
    /// Visits with enough for each line of an order, as bits.
    masks: Vec<u64>,
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
            pods: vec![0; rows],
            taken: vec![0; rows * problem.given.skus],
            touched: Vec::new(),
            kept: vec![0; rows],
            enough: vec![0; problem.stations * problem.given.lines.len()],
            found: Vec::new(),
            masks: Vec::new(),
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
                draft.release(self.problem, station);
            }
            self.chances.clear();
            for (number, &station) in stations.iter().enumerate() {
                self.begin(draft, number, station);
            }
            self.serve_waiting(draft, stations);
            let mut done = true;
            for cell in self.touched.drain(..) {
                self.taken[cell] = 0;
            }
            for found in self.found.drain(..) {
                self.enough[found] = 0;
            }
            for (number, &station) in stations.iter().enumerate() {
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

    fn visits(&self, draft: &Draft, station: usize) -> usize {
        self.problem.first(station) + draft.at[station].pods.len()
    }

    /// Prepares a station's visits, serves its open orders, and collects waiting orders that could
    /// be served.
    fn begin(&mut self, draft: &mut Draft, number: usize, station: usize) {
        let problem = self.problem;
        let visits = self.visits(draft, station);
        let first = problem.first(station);
        let row = self.row(number, 0);
        self.kept[row..row + visits].fill(0);
        self.pods[row..row + first].copy_from_slice(&problem.given.under_way[station]);
        self.pods[row + first..row + visits].copy_from_slice(&draft.at[station].pods);
        let mut cost = 0.0;
        for (new, &pod) in draft.at[station].pods.iter().enumerate() {
            cost += problem.cost(pod, station) * problem.decay[first + new];
        }
        self.used[number] = 0;
        draft.at[station].value = -cost;
        draft.at[station].units = 0;
        self.serve_open(draft, number, station, visits);
        self.look(draft, number, visits);
    }

    /// Serves a line of a station in a visit.
    fn serve(&mut self, draft: &mut Draft, number: usize, station: usize, line: u32, visit: usize) {
        let given = &self.problem.given.lines[line as usize];
        let cell = self.cell(number, visit, given.sku);
        if self.taken[cell] == 0 {
            self.touched.push(cell);
        }
        self.taken[cell] += given.units;
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
            for &line in &problem.lines_of[order as usize] {
                let Some(visit) = self.first_visit(number, visits, line) else {
                    missing = true;
                    continue;
                };
                self.serve(draft, number, station, line, visit);
                last = last.max(visit as i32);
            }
            self.work += (visits * problem.lines_of[order as usize].len()) as u64;
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
    fn look(&mut self, draft: &Draft, number: usize, visits: usize) {
        let problem = self.problem;
        let (base, begin) = (number * problem.given.lines.len(), self.found.len());
        for visit in 0..visits {
            let pod = self.pods[self.row(number, visit)];
            for line in lines_in(problem.serves(pod).iter().zip(&draft.free).map(|(s, f)| s & f)) {
                if self.has_left(number, visit, line) {
                    let enough = &mut self.enough[base + line as usize];
                    if *enough == 0 {
                        self.found.push(base + line as usize);
                    }
                    *enough |= 1 << visit;
                }
            }
        }
        self.work += (visits * problem.words + 2 * (self.found.len() - begin)) as u64;
        for found in begin..self.found.len() {
            let line = (self.found[found] - base) as u32;
            let order = problem.given.lines[line as usize].order;
            let lines = &problem.lines_of[order as usize];
            if lines[0] != line {
                continue; // once is enough
            }
            self.masks.clear();
            self.masks.extend(lines.iter().map(|&line| self.enough[base + line as usize]));
            if let Some(span) = closest(&self.masks) {
                self.chances.push(Chance::new(span, order, number));
            }
        }
    }

    /// Whether a visit whose pod serves a line still has the units.
    fn has_left(&self, number: usize, visit: usize, line: u32) -> bool {
        let given = &self.problem.given.lines[line as usize];
        let taken = self.taken[self.cell(number, visit, given.sku)];
        let pod = self.pods[self.row(number, visit)];
        taken == 0 || self.problem.units(pod, given.sku) - taken >= given.units
    }

    /// The first visit with enough units left for a line.
    fn first_visit(&self, number: usize, visits: usize, line: u32) -> Option<usize> {
        let serves =
            |visit: usize| has(self.problem.serves(self.pods[self.row(number, visit)]), line);
        (0..visits).find(|&visit| serves(visit) && self.has_left(number, visit, line))
    }

    /// Finds the visits with enough units left for each line of a waiting order.
    fn find_visits(&mut self, number: usize, order: u32) {
        let problem = self.problem;
        self.masks.clear();
        for &line in &problem.lines_of[order as usize] {
            let mut left = self.enough[number * problem.given.lines.len() + line as usize];
            let mut mask = 0;
            while left != 0 {
                let visit = left.trailing_zeros();
                left &= left - 1;
                mask |= u64::from(self.has_left(number, visit as usize, line)) << visit;
            }
            self.masks.push(mask);
        }
    }

    /// Gives waiting orders a station and visits.
    fn serve_waiting(&mut self, draft: &mut Draft, stations: &[usize]) {
        let problem = self.problem;
        let mut chances = std::mem::take(&mut self.chances);
        chances.sort_unstable();
        self.work += 24 * chances.len() as u64; // sorting, and serving in between
        for chance in &chances {
            let (order, number) = (chance.order(), chance.number());
            if draft.order_station[order as usize] >= 0 {
                continue;
            }
            let station = stations[number];
            self.find_visits(number, order);
            // where others have not taken the units meanwhile, these are the visits found before
            let Some((begin, end)) = closest(&self.masks) else { continue };
            if !self.keep(number, station, begin as usize, end as usize) {
                continue;
            }
            for (which, &line) in problem.lines_of[order as usize].iter().enumerate() {
                let visit = begin + (self.masks[which] >> begin).trailing_zeros();
                self.serve(draft, number, station, line, visit as usize);
            }
            let at = &mut draft.at[station];
            at.orders.push(order);
            at.value += problem.given.order_worth[order as usize] * problem.decay[end as usize];
            draft.place(problem, order, station);
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

    /// Removes new visits that serve nothing; returns whether there were none.
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

/// The shortest range of visits with a bit of every mask, the first of several: its first and last
/// visit.
fn closest(masks: &[u64]) -> Option<(u32, u32)> {
    let mut begins = masks.iter().fold(0, |bits, mask| bits | mask);
    let mut best: Option<(u32, u32)> = None;
    while begins != 0 {
        let begin = begins.trailing_zeros();
        begins &= begins - 1;
        let mut end = begin;
        for mask in masks {
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
        assert_eq!(closest(&[0b1000, 0b0110]), Some((2, 3)));
        assert_eq!(closest(&[0b1001, 0b1010]), Some((3, 3)));
        assert_eq!(closest(&[0b10001, 0b100010]), Some((0, 1)));
        assert_eq!(closest(&[0b1, 0]), None);
    }
}
