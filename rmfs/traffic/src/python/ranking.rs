//! Ranking of candidates for Python: a table of features in, the best rows out.

use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::ranking;

/// Rows of the best candidates, and their features.
type Offered<'py> = (Bound<'py, PyArray1<i64>>, Bound<'py, PyArray2<f32>>);

fn best(
    values: &PyReadonlyArray2<'_, f64>,
    weights: &[(usize, f64)],
    k: usize,
) -> PyResult<Vec<usize>> {
    let values = values.as_array();
    if weights.iter().any(|&(feature, _)| feature >= values.nrows()) {
        return Err(PyValueError::new_err("a weight is for a feature that does not exist"));
    }
    let value = |feature, candidate| values[[feature, candidate]];
    Ok(ranking::best(values.ncols(), value, weights, k))
}

fn numbered<'py>(py: Python<'py>, rows: &[usize]) -> Bound<'py, PyArray1<i64>> {
    rows.iter().map(|&row| row as i64).collect::<Vec<_>>().into_pyarray(py)
}

/// Returns the rows of the best candidates; see `ranking::best`.
#[pyfunction]
pub(super) fn best_rows<'py>(
    py: Python<'py>,
    values: PyReadonlyArray2<'py, f64>,
    weights: Vec<(usize, f64)>,
    k: usize,
) -> PyResult<Bound<'py, PyArray1<i64>>> {
    Ok(numbered(py, &best(&values, &weights, k)?))
}

/// Returns the rows of the best candidates, and their scaled features in rows of `width`.
///
/// Feature f is divided by `scales[f]` and written to column `columns[f]`; all else is 0.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(super) fn offered<'py>(
    py: Python<'py>,
    values: PyReadonlyArray2<'py, f64>,
    weights: Vec<(usize, f64)>,
    k: usize,
    scales: PyReadonlyArray1<'py, f64>,
    columns: PyReadonlyArray1<'py, i64>,
    width: usize,
    limit: f64,
) -> PyResult<Offered<'py>> {
    let rows = best(&values, &weights, k)?;
    let (values, scales, columns) = (values.as_array(), scales.as_array(), columns.as_array());
    let features = values.nrows();
    let fits = |&column: &i64| (0..width as i64).contains(&column);
    if scales.len() != features || columns.len() != features || !columns.iter().all(fits) {
        return Err(PyValueError::new_err("every feature needs a scale and a column"));
    }
    let mut found = numpy::ndarray::Array2::<f32>::zeros((k, width));
    for (at, &row) in rows.iter().enumerate() {
        for feature in 0..features {
            let scaled = ranking::scaled(values[[feature, row]], scales[feature], limit);
            found[[at, columns[feature] as usize]] = scaled;
        }
    }
    Ok((numbered(py, &rows), found.into_pyarray(py)))
}
