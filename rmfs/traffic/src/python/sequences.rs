//! Task sequences of robots for Python: arrays in, routes out.

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use super::guard::guarded;
use crate::sequences::{Found, Given, NEVER, NONE, Plan, Problem, improved};

/// Tasks of each robot, and place of each owner's pod.
type Start = (Vec<Vec<u32>>, Vec<i64>);

/// The same, and the work done.
type Routes = (Vec<Vec<u32>>, Vec<i64>, u64);

/// Robots, tasks and free places.
#[pyclass(frozen)]
pub(super) struct Sequences {
    problem: Problem,
}

#[pymethods]
impl Sequences {
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        ready: Vec<i64>,
        carrying: Vec<bool>,
        reach: PyReadonlyArray1<'_, i64>,
        store: PyReadonlyArray1<'_, i64>,
        fetch: PyReadonlyArray1<'_, i64>,
        bring: Vec<i64>,
        service: Vec<i64>,
        earliest: Vec<i64>,
        latest: Vec<i64>,
        due: Vec<i64>,
        skip: Vec<i64>,
        weight: i64,
    ) -> PyResult<Self> {
        let given = Given {
            ready,
            carrying,
            reach: reach.as_array().to_vec(),
            store: store.as_array().to_vec(),
            fetch: fetch.as_array().to_vec(),
            bring,
            service,
            earliest,
            latest,
            due,
            skip,
            weight,
        };
        let problem = guarded(|| Problem::new(given))?;
        Ok(Self { problem })
    }

    /// Inserts the tasks that each start leaves, and searches from the better plan; a start has the
    /// tasks of each robot and the place of each owner's pod.
    fn searched(&self, starts: Vec<Start>, steps: u64, seed: u64) -> PyResult<Option<Routes>> {
        let found = guarded(|| {
            let starts = starts.into_iter().map(|(tasks, place)| {
                let place = place.into_iter().map(|place| u32::try_from(place).unwrap_or(NONE));
                Plan::new(&self.problem, tasks, place.collect())
            });
            improved(&self.problem, starts.collect(), steps, seed)
        })?;
        Ok(found.filter(|found| found.plan.total < NEVER).map(told))
    }
}

fn told(found: Found) -> Routes {
    let Plan { tasks, place, .. } = found.plan;
    let place = place.into_iter().map(|place| if place == NONE { -1 } else { i64::from(place) });
    (tasks, place.collect(), found.work)
}
