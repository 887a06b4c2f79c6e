//! Delays: the order in which robots use waypoints is kept, and times are shifted.
//!
//! Every plan states when its robot enters and leaves each waypoint; together, the plans give each
//! waypoint a sequence of users. If a robot leaves a waypoint later than planned, the next user
//! enters it later, and so on. As long as robots keep the sequence, they do not meet. The sequence
//! has no cycle, since it comes from times, but runs are shifted as a whole: each of four runs
//! around a block may have to wait for the end of the next. A delay for which a move would have to
//! wait for itself is refused, and the caller is informed. Every shift is caused by a chain of
//! others in which no move occurs twice, so the procedure ends. The number of shifts is also
//! limited, because there can be many chains.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, HashMap, VecDeque};

use crate::network::NONE;
use crate::patience::look_up;
use crate::robot::{Held, Robot};
use crate::search::Move;
use crate::units::{FOREVER, Us};

use super::disturbed::stretched;
use super::{Due, Fleet};

/// Maximum number of shifts per move of all plans, on average, because of one delay. Most moves are
/// shifted once.
const SHIFTS: usize = 100;

/// Which moves may be shifted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shift {
    /// Only moves that have not begun, since motion follows the plan.
    Planned,
    /// Also moves in progress, during which robots outside the simulation may stop or slow down.
    Begun,
}

/// The plans of all robots while one delay causes others.
pub(super) struct Delays<'a> {
    fleet: &'a Fleet,
    shift: Shift,
    /// Kind of each robot from now on.
    kinds: Vec<u8>,
    /// What each robot occupies according to its present plan.
    held: Vec<Vec<Held>>,
    /// The same for robots whose plans have changed, according to their new plans.
    shifted: HashMap<u32, Vec<Held>>,
    /// The next user of each of these: robot and index into its `held`.
    next: Vec<Vec<Option<(u32, usize)>>>,
    /// Plans that have changed.
    plans: BTreeMap<u32, VecDeque<Move>>,
    /// The shifts made so far, each with its cause.
    causes: Vec<Cause>,
    /// Maximum number of shifts.
    most: usize,
    /// Last shift of each robot and move.
    cause_of: HashMap<(u32, usize), usize>,
}

/// A shift of a move, caused by another shift.
struct Cause {
    robot: u32,
    step: usize,
    before: Option<usize>,
}

impl Fleet {
    /// Delays the rest of a robot's plan by `by`, and those of robots behind it.
    ///
    /// Returns false and changes nothing if a move had to be shifted that `shift` excludes, or if a
    /// move had to wait for itself.
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

    /// Adopts the shifted plans.
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

    /// Removes a robot's reservations from the table.
    pub(super) fn forget(&mut self, robot: u32) {
        for held in &self.robots[robot as usize].held {
            self.table.remove(held.resource, robot);
        }
    }

    /// The waypoints of the robot's present run, or of its next one, that it has not passed and may
    /// drive to at once: all robots that were to use them before have left them.
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

    /// Shifts one move of a robot, and the moves after it as far as necessary.
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

    /// Records the cause of a shift; `None` if the move itself is the cause, or if the limit is
    /// reached.
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

    /// Shifts robots that would enter a waypoint before the robot in front has left it.
    ///
    /// They are processed in the order in which they were to enter, so that most are shifted once.
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

    /// What a robot occupies according to its new plan.
    fn uses(&self, robot: u32) -> &[Held] {
        self.shifted.get(&robot).unwrap_or(&self.held[robot as usize])
    }

    /// The move by which a robot leaves what it occupies.
    fn left_by(&self, robot: u32, index: usize) -> usize {
        self.held[robot as usize].get(index + 1).map_or(usize::MAX, |held| held.entered_by as usize)
    }

    /// Recomputes what a robot occupies after a change of its plan.
    fn look_again(&mut self, robot: u32) {
        let state = &self.fleet.robots[robot as usize];
        let moves = self.plans.get(&robot).unwrap_or(&state.moves).clone();
        let later = Robot { moves, ..state.clone() };
        let kind = self.kinds[robot as usize] as usize;
        let uses = later.occupation(&self.fleet.network, &self.fleet.kinds[kind]);
        self.shifted.insert(robot, uses);
    }

    /// Changes the kind of a robot at rest. Returns whether all others can wait for it.
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
