//! Robots that are late: the order in which waypoints are used stays, times move.
//!
//! Every plan says when its robot enters and leaves each waypoint; all plans together give each
//! waypoint its users in order. If a robot leaves one later than planned, the next user enters it
//! later, and so on. Whoever keeps the order meets nobody. The order itself has no cycle (it comes
//! from times), but a run is shifted as a whole: four runs around a block may each have to wait for
//! the next one's end. Who would have to wait for himself cannot be late; that is told. As every
//! shift has a chain of others as its cause, in which no move occurs twice, there is an end; it is
//! also counted, as a chain can take many ways.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, HashMap, VecDeque};

use crate::network::NONE;
use crate::patience::look_up;
use crate::robot::{Held, Robot};
use crate::search::Move;
use crate::units::{FOREVER, Us};

use super::disturbed::stretched;
use super::{Due, Fleet};

/// How often the moves of all plans are shifted at most, each on average, because of one delay.
/// Most are shifted once.
const SHIFTS: usize = 100;

/// What may be shifted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shift {
    /// Only moves not begun: what is planned is what is driven.
    Planned,
    /// Also moves in progress: robots outside the simulation stop and slow down in their midst.
    Begun,
}

/// The plans of all robots while one delay makes others.
pub(super) struct Delays<'a> {
    fleet: &'a Fleet,
    shift: Shift,
    /// What kind each robot is of from now on.
    kinds: Vec<u8>,
    /// What each robot occupies by the plan it has.
    held: Vec<Vec<Held>>,
    /// The same of robots whose plans have changed, by the plan they will have.
    shifted: HashMap<u32, Vec<Held>>,
    /// The next user of each of these: robot and index into its `held`.
    next: Vec<Vec<Option<(u32, usize)>>>,
    /// Plans that have changed.
    plans: BTreeMap<u32, VecDeque<Move>>,
    /// What has been shifted, each with what made it necessary.
    causes: Vec<Cause>,
    /// How many there may be.
    most: usize,
    /// The last of them, per robot and move.
    cause_of: HashMap<(u32, usize), usize>,
}

/// A move that was shifted, because of another one.
struct Cause {
    robot: u32,
    step: usize,
    before: Option<usize>,
}

impl Fleet {
    /// Lets a robot do what is left of its plan later by `by`, and others behind it.
    ///
    /// Nothing changes, and the result is false, if a motion had to be shifted that `shift` leaves
    /// alone, or one by its own delay.
    pub fn delay(&mut self, robot: u32, by: Us, shift: Shift) -> bool {
        self.settle_all();
        let state = &self.robots[robot as usize];
        let kind = &self.kinds[state.kind as usize];
        let first = match shift {
            Shift::Planned => state.committed(&self.network, kind, self.now),
            Shift::Begun => 0,
        };
        if first >= state.moves.len() {
            return true;
        }
        let mut delays = Delays::new(self, shift);
        if !(delays.push(robot, first, by, None) && delays.spread(robot)) {
            return false;
        }
        let plans = delays.plans;
        for (&robot, moves) in &plans {
            for step in moves.iter().filter(|step| step.late > 0) {
                self.record.hold_up(robot, step);
            }
        }
        self.follow(plans);
        true
    }

    /// Makes shifted plans the robots' own.
    pub(super) fn follow(&mut self, plans: BTreeMap<u32, VecDeque<Move>>) {
        for &robot in plans.keys() {
            self.forget(robot);
        }
        let robots: Vec<u32> = plans.keys().copied().collect();
        for (robot, moves) in plans {
            let state = &mut self.robots[robot as usize];
            state.moves = moves;
            state.version += 1;
            let (_, _, end) = state.destination();
            let due = end.max(self.now).max(state.busy_until);
            self.agenda.push(Reverse((due, robot, Due::LegEnd, state.version)));
        }
        for robot in robots {
            self.occupy(robot);
            self.expect_motion(robot);
        }
    }

    /// Takes a robot's reservations out of the table.
    pub(super) fn forget(&mut self, robot: u32) {
        for held in &self.robots[robot as usize].held {
            self.table.remove(held.resource, robot);
        }
    }

    /// The waypoints of the robot's present run, or of its next one, that it has not passed and may
    /// drive to at once: whoever was to use them before has left them.
    pub fn clearance(&mut self, robot: u32) -> Vec<u32> {
        self.settle(robot);
        let state = &self.robots[robot as usize];
        let Some(step) = state.moves.front() else { return Vec::new() };
        let own = |node: u32| {
            let row = self.table.row(self.network.resource[node as usize]);
            row.iter().find(|use_| use_.end > self.now).is_some_and(|use_| use_.robot == robot)
        };
        // what it occupies begins with where the run begins
        let uses = state.occupation(&self.network, &self.kinds[state.kind as usize]);
        let line = self.network.line(step.from, step.to, step.heading);
        line.zip(&uses[1..])
            .skip_while(|(_, held)| held.end <= self.now)
            .map(|((node, _), _)| node)
            .take_while(|&node| own(node))
            .collect()
    }
}

impl<'a> Delays<'a> {
    pub(super) fn new(fleet: &'a Fleet, shift: Shift) -> Self {
        let occupation =
            |state: &Robot| state.occupation(&fleet.network, &fleet.kinds[state.kind as usize]);
        let held: Vec<Vec<Held>> = fleet.robots.iter().map(occupation).collect();
        let mut rows: HashMap<u32, Vec<(Us, u32, usize)>> = HashMap::new();
        for (robot, uses) in held.iter().enumerate() {
            for (index, one) in uses.iter().enumerate().filter(|(_, one)| one.end > fleet.now) {
                rows.entry(one.resource).or_default().push((one.start, robot as u32, index));
            }
        }
        let mut next: Vec<Vec<_>> = held.iter().map(|uses| vec![None; uses.len()]).collect();
        for row in rows.values_mut() {
            row.sort_unstable();
            for pair in row.windows(2) {
                let ((_, robot, index), (_, follower, at)) = (pair[0], pair[1]);
                next[robot as usize][index] = Some((follower, at));
            }
        }
        let kinds = fleet.robots.iter().map(|state| state.kind).collect();
        Self {
            fleet,
            shift,
            kinds,
            held,
            shifted: HashMap::new(),
            next,
            plans: BTreeMap::new(),
            causes: Vec::new(),
            most: SHIFTS * fleet.robots.iter().map(|state| state.moves.len() + 1).sum::<usize>(),
            cause_of: HashMap::new(),
        }
    }

    fn plan(&mut self, robot: u32) -> &mut VecDeque<Move> {
        let own = || self.fleet.robots[robot as usize].moves.clone();
        self.plans.entry(robot).or_insert_with(own)
    }

    /// Shifts one move of a robot, and those after it as far as they have to.
    fn push(&mut self, robot: u32, index: usize, by: Us, before: Option<usize>) -> bool {
        let fleet = self.fleet;
        let state = &fleet.robots[robot as usize];
        let kind = &fleet.kinds[self.kinds[robot as usize] as usize];
        let begun = state.committed(&fleet.network, kind, fleet.now);
        if index < begun && self.shift == Shift::Planned {
            return false;
        }
        let Some(cause) = self.cause(robot, index, before) else { return false };
        let uses = &self.held[robot as usize];
        let entered = |held: &&Held| held.entered_by == index as u32 && held.start <= fleet.now;
        let entered = uses.iter().filter(entered).count() as u32;
        let moves = self.plan(robot);
        if index < begun {
            moves[index].begun = moves[index].begun.max(entered);
            moves[index].late += by;
        } else {
            moves[index].start += by;
        }
        moves[index].end += by;
        let mut last = index;
        for later in index + 1..moves.len() {
            let step = &moves[later];
            let turn = kind.turn(
                fleet.network.headings[step.heading_before as usize],
                fleet.network.headings[step.heading as usize],
            );
            let wait = (moves[later - 1].end + turn - step.start).max(0);
            if wait == 0 {
                break;
            }
            moves[later].start += wait;
            moves[later].end += wait;
            last = later;
        }
        self.cause_of.extend((index..=last).map(|step| ((robot, step), cause)));
        self.look_again(robot);
        true
    }

    /// Takes note of why a move is shifted; none if its own shift is the reason, or if shifting
    /// does not come to an end.
    fn cause(&mut self, robot: u32, step: usize, before: Option<usize>) -> Option<usize> {
        if self.causes.len() >= self.most {
            return None;
        }
        let mut earlier = before;
        while let Some(number) = earlier {
            let one = &self.causes[number];
            if one.robot == robot && one.step == step {
                return None;
            }
            earlier = one.before;
        }
        self.causes.push(Cause { robot, step, before });
        Some(self.causes.len() - 1)
    }

    /// Shifts whoever would enter a waypoint before the robot in front of him has left it.
    ///
    /// In the order in which they were to enter, so that most are shifted once.
    fn spread(&mut self, robot: u32) -> bool {
        let mut changed = BinaryHeap::from([Reverse((Us::MIN, robot))]);
        while let Some(Reverse((_, robot))) = changed.pop() {
            look_up();
            for index in 0..self.next[robot as usize].len() {
                let Some((follower, at)) = self.next[robot as usize][index] else { continue };
                let (one, entry) = (self.uses(robot)[index], self.uses(follower)[at]);
                if one.end <= entry.start || one.end == FOREVER {
                    continue;
                }
                let step = entry.entered_by;
                let by = one.end - entry.start;
                let cause = self.cause_of.get(&(robot, self.left_by(robot, index))).copied();
                if step == NONE || !self.push(follower, step as usize, by, cause) {
                    return false;
                }
                changed.push(Reverse((self.held[follower as usize][at].start, follower)));
            }
        }
        true
    }

    /// What a robot occupies by the plan it will have.
    fn uses(&self, robot: u32) -> &[Held] {
        self.shifted.get(&robot).unwrap_or(&self.held[robot as usize])
    }

    /// By which of its moves a robot leaves what it occupies.
    fn left_by(&self, robot: u32, index: usize) -> usize {
        self.held[robot as usize].get(index + 1).map_or(usize::MAX, |held| held.entered_by as usize)
    }

    /// Works out what a robot occupies, after its plan has changed.
    fn look_again(&mut self, robot: u32) {
        let state = &self.fleet.robots[robot as usize];
        let moves = self.plans.get(&robot).unwrap_or(&state.moves).clone();
        let later = Robot { moves, ..state.clone() };
        let kind = self.kinds[robot as usize] as usize;
        let uses = later.occupation(&self.fleet.network, &self.fleet.kinds[kind]);
        self.shifted.insert(robot, uses);
    }

    /// Makes a robot at rest one of another kind. Returns whether everybody else can wait for it.
    pub(super) fn change_kind(&mut self, robot: u32, kind: u8) -> bool {
        self.kinds[robot as usize] = kind;
        let fleet = self.fleet;
        let moves = &fleet.robots[robot as usize].moves;
        if moves.is_empty() {
            return true;
        }
        let longer = stretched(&fleet.network, &fleet.kinds[kind as usize], moves);
        let count = moves.len();
        self.plans.insert(robot, longer.into());
        self.causes.push(Cause { robot, step: usize::MAX, before: None });
        self.cause_of.extend((0..count).map(|step| ((robot, step), 0)));
        self.look_again(robot);
        self.spread(robot)
    }

    pub(super) fn into_plans(self) -> BTreeMap<u32, VecDeque<Move>> {
        self.plans
    }
}
