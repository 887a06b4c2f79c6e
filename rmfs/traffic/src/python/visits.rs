//! Plans of pod visits for Python: arrays in, visits and what they serve out.

use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

use super::guard::guarded;
use crate::visits::{Appeal, Draft, Filling, Given, Line, Problem, extended, improved};

/// New visits per station, station of each order, visit of each line, the objective with the other
/// sign, and the work done.
type Plan = (Vec<Vec<u32>>, Vec<i32>, Vec<i32>, f64, u64);

/// The planning problem.
#[pyclass(frozen)]
pub(super) struct Visits {
    problem: Problem,
}

fn told(draft: &Draft, work: u64) -> Plan {
    let (orders, lines) = (draft.order_station.clone(), draft.line_visit.clone());
    (draft.pods(), orders, lines, draft.value(), work)
}

#[pymethods]
impl Visits {
    #[new]
    #[allow(clippy::too_many_arguments)]
    fn new(
        under_way: Vec<Vec<u32>>,
        kept: Vec<usize>,
        order_station: Vec<i32>,
        order_until: Vec<i32>,
        order_worth: Vec<f64>,
        line_order: Vec<u32>,
        line_sku: Vec<u32>,
        line_units: Vec<i64>,
        line_worth: Vec<f64>,
        stock: PyReadonlyArray2<'_, i64>,
        cost: PyReadonlyArray1<'_, f64>,
        visits: usize,
        decay: f64,
    ) -> PyResult<Self> {
        let rows = line_order.into_iter().zip(line_sku).zip(line_units).zip(line_worth);
        let line = |(((order, sku), units), worth)| Line { order, sku, units, worth };
        let given = Given {
            under_way,
            kept,
            order_station,
            order_until,
            order_worth,
            lines: rows.map(line).collect(),
            skus: stock.as_array().ncols(),
            stock: stock.as_array().iter().copied().collect(),
            cost: cost.as_array().iter().copied().collect(),
            visits,
            decay,
        };
        let problem = guarded(|| Problem::new(given))?;
        Ok(Self { problem })
    }

    /// Fills given visits.
    fn filled(&self, pods: Vec<Vec<u32>>) -> PyResult<Plan> {
        self.with(|filling, _| filling.draft(&pods))
    }

    /// Plans by the start rule, from given visits.
    fn by_rule(&self, pods: Vec<Vec<u32>>) -> PyResult<Plan> {
        self.with(|filling, appeal| extended(filling, appeal, &pods))
    }

    /// Plans by the start rule, from given visits, and then searches.
    fn searched(&self, pods: Vec<Vec<u32>>, steps: u64, seed: u64) -> PyResult<Plan> {
        self.with(|filling, appeal| {
            let draft = extended(filling, appeal, &pods);
            improved(filling, draft, steps, seed)
        })
    }
}

impl Visits {
    fn with(&self, work: impl FnOnce(&mut Filling, &mut Appeal) -> Draft) -> PyResult<Plan> {
        let mut filling = Filling::new(&self.problem);
        let mut appeal = Appeal::new(&self.problem);
        let draft = guarded(|| work(&mut filling, &mut appeal))?;
        Ok(told(&draft, filling.work))
    }
}
