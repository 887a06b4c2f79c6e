//! How orders match stock, for Python.

use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::matching;

/// Returns what is found for the lines of each order: their SKUs and units, one order per row.
///
/// # Errors
/// If the arrays have different shapes, or a SKU is not below `skus`.
fn each<T>(
    sku: &PyReadonlyArray2<'_, i64>,
    units: &PyReadonlyArray2<'_, i32>,
    skus: usize,
    find: impl Fn(&[i64], &[i32]) -> T,
) -> PyResult<Vec<T>> {
    let (width, alike) = (sku.as_array().ncols(), sku.as_array().dim() == units.as_array().dim());
    let (sku, units) = (sku.as_slice()?, units.as_slice()?);
    if !alike || width == 0 || sku.iter().any(|&sku| sku as usize >= skus) {
        return Err(PyValueError::new_err("a line needs a known SKU and a number of units"));
    }
    let rows = sku.chunks(width).zip(units.chunks(width));
    Ok(rows.map(|(sku, units)| find(sku, units)).collect())
}

/// Pairs of SKU and units.
fn lines<'a>(sku: &'a [i64], units: &'a [i32]) -> impl Iterator<Item = (usize, i32)> + 'a {
    sku.iter().zip(units).map(|(&sku, &units)| (sku as usize, units))
}

/// Returns whether stock can serve each order, if it were the only one.
#[pyfunction]
pub(super) fn servable<'py>(
    py: Python<'py>,
    sku: PyReadonlyArray2<'py, i64>,
    units: PyReadonlyArray2<'py, i32>,
    stock: PyReadonlyArray1<'py, i64>,
) -> PyResult<Bound<'py, PyArray1<bool>>> {
    let stock = stock.as_slice()?;
    let of_order = |sku: &_, units: &_| matching::is_servable(lines(sku, units), stock);
    let found = each(&sku, &units, stock.len(), of_order)?;
    Ok(found.into_pyarray(py))
}

/// Returns how many units of each order pods can supply beyond what a station still needs.
#[pyfunction]
pub(super) fn matches<'py>(
    py: Python<'py>,
    sku: PyReadonlyArray2<'py, i64>,
    units: PyReadonlyArray2<'py, i32>,
    inbound: PyReadonlyArray1<'py, i32>,
    need: PyReadonlyArray1<'py, i32>,
) -> PyResult<Bound<'py, PyArray1<i32>>> {
    let (inbound, need) = (inbound.as_slice()?, need.as_slice()?);
    let skus = inbound.len().min(need.len());
    let of_order = |sku: &_, units: &_| matching::match_of(lines(sku, units), inbound, need);
    let found = each(&sku, &units, skus, of_order)?;
    Ok(found.into_pyarray(py))
}

/// Returns which orders each pod completes, one row per order.
///
/// `have` has the units by row and pod; an order consists of pairs of a row and units.
#[pyfunction]
pub(super) fn completed<'py>(
    py: Python<'py>,
    have: PyReadonlyArray2<'py, i32>,
    orders: Vec<Vec<(usize, i32)>>,
) -> PyResult<Bound<'py, PyArray2<bool>>> {
    let have = have.as_array();
    if orders.iter().flatten().any(|&(row, _)| row >= have.nrows()) {
        return Err(PyValueError::new_err("an order needs a row that does not exist"));
    }
    let mut found = Array2::from_elem((orders.len(), have.ncols()), false);
    for (pod, mut column) in have.columns().into_iter().zip(found.columns_mut()) {
        let mut left = pod.to_vec();
        for (flag, covered) in column.iter_mut().zip(matching::completed(&orders, &mut left)) {
            *flag = covered;
        }
    }
    Ok(found.into_pyarray(py))
}
