//! Plans against plans made anew, and places against all places.

use super::problem::{Given, NEVER, NONE, Problem};
use super::{Plan, improved};
use crate::random::Random;

/// Robots, tasks and places with ways drawn at random, one in eight of them not allowed.
fn drawn(seed: u64, robots: usize, tasks: usize, places: usize) -> Problem {
    let mut random = Random::new(seed);
    let mut ways = |count: usize, forbidden: u64| -> Vec<i64> {
        let mut way =
            || if random.below(8) < forbidden { NEVER } else { random.below(40_000) as i64 };
        (0..count).map(|_| way()).collect()
    };
    let owners = robots + tasks;
    let (reach, store) = (ways(robots * tasks, 1), ways(owners * places, 1));
    let (fetch, skip) = (ways(places * tasks, 1), ways(tasks, 1));
    Problem::new(Given {
        ready: ways(robots, 0),
        carrying: (0..robots).map(|robot| robot % 2 == 0).collect(),
        reach,
        store,
        fetch,
        bring: ways(tasks, 0),
        service: ways(tasks, 0),
        earliest: ways(tasks, 0),
        latest: ways(tasks, 4).iter().map(|latest| latest + 60_000).collect(),
        due: ways(tasks, 2),
        skip,
        weight: 3,
    })
}

/// Robots that carry pods store them at the first places that are allowed.
fn stored(problem: &Problem) -> Plan {
    let mut place = vec![NONE; problem.robots + problem.tasks];
    for robot in (0..problem.robots).filter(|&robot| problem.given.carrying[robot]) {
        let taken = place.clone();
        place[robot] = problem.best_place(robot, NONE, |place| !taken.contains(&place));
    }
    Plan::new(problem, vec![Vec::new(); problem.robots], place)
}

#[test]
fn a_plan_changed_step_by_step_is_like_one_made_anew() {
    for seed in 0..40 {
        let problem = drawn(seed, 4, 7, 14);
        let start = stored(&problem);
        let found = improved(&problem, vec![start.clone()], 200, seed).expect("there is a start");
        let plan = found.plan;
        let anew = Plan::new(&problem, plan.tasks.clone(), plan.place.clone());
        assert_eq!((plan.total, &plan.cost), (anew.total, &anew.cost));
        assert_eq!((&plan.free, &plan.doer), (&anew.free, &anew.doer));
        assert_eq!(plan.stops, anew.stops);
        assert!(plan.total <= start.total);
        let done = plan.tasks.iter().map(Vec::len).sum::<usize>();
        assert_eq!(done + plan.left().count(), problem.tasks);
        let used = plan.place.iter().filter(|&&place| place != NONE).count();
        assert_eq!(used, problem.places - plan.free.iter().filter(|&&free| free).count());
        assert_eq!(used, 2 + done);
    }
}

#[test]
fn the_best_place_is_the_best_of_all_that_are_allowed() {
    let mut random = Random::new(1);
    for seed in 0..40 {
        let problem = drawn(seed, 3, 5, 20);
        for owner in 0..8 {
            for next in (0..5).chain([NONE]) {
                // few places are allowed, so that the nearest ones are mostly taken
                let allowed: Vec<bool> = (0..20).map(|_| random.below(6) == 0).collect();
                let may = |place: u32| allowed[place as usize];
                let way = |place: u32| problem.via(owner, place, next);
                let least = (0..20).filter(|&place| may(place)).map(way).min().unwrap_or(NEVER);
                let found = problem.best_place(owner, next, may);
                if found == NONE {
                    assert!(least >= NEVER);
                } else {
                    assert!(may(found));
                    assert_eq!(way(found), least);
                }
            }
        }
    }
}

#[test]
fn nothing_to_do_is_done_at_once() {
    let problem = drawn(1, 2, 0, 3);
    let found = improved(&problem, vec![stored(&problem)], 50, 1).expect("there is a start");
    assert_eq!(found.work, 0);
    assert!(improved(&problem, Vec::new(), 50, 1).is_none());
}
