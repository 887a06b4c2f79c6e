//! Ranking of candidates for decisions: the best rows of a table of features, and their features.

use std::cmp::Ordering;

/// Values beyond this count as this: an order without a due time is never due.
const FAR: f64 = 1e9;

/// Orders scores from the greatest to the least; what is not a number comes last.
fn descending(a: f64, b: f64) -> Ordering {
    b.partial_cmp(&a).unwrap_or_else(|| a.is_nan().cmp(&b.is_nan()))
}

/// Returns the `k` candidates with the greatest weighted sums of features, the best first.
///
/// `value(f, c)` is feature `f` of candidate `c`. The terms are added in the order of `weights`,
/// pairs of a feature and its weight. Ties go to the earlier candidate.
pub fn best(
    count: usize,
    value: impl Fn(usize, usize) -> f64,
    weights: &[(usize, f64)],
    k: usize,
) -> Vec<usize> {
    let capped = |value: f64| if value > FAR { FAR } else { value };
    let mut scores = vec![0.0; count];
    for &(feature, weight) in weights {
        for (candidate, score) in scores.iter_mut().enumerate() {
            *score += weight * capped(value(feature, candidate));
        }
    }
    let mut rows: Vec<usize> = (0..count).collect();
    let better = |a: &usize, b: &usize| descending(scores[*a], scores[*b]).then(a.cmp(b));
    if k < count {
        rows.select_nth_unstable_by(k, better);
        rows.truncate(k);
    }
    rows.sort_unstable_by(better);
    rows
}

/// Returns a feature divided by its scale, and clipped to at most `limit` in absolute value.
pub fn scaled(value: f64, scale: f64, limit: f64) -> f32 {
    let share = value / scale;
    let clipped = if share > limit {
        limit
    } else if share < -limit {
        -limit
    } else {
        share
    };
    clipped as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_come_first_and_ties_go_to_the_earlier() {
        let table = [[1.0, 3.0, 3.0, 2.0, f64::NAN], [0.0, 0.5, 0.5, f64::INFINITY, 0.0]];
        let value = |feature: usize, candidate: usize| table[feature][candidate];
        assert_eq!(best(5, value, &[(0, 1.0)], 9), [1, 2, 3, 0, 4]);
        assert_eq!(best(5, value, &[(0, 1.0)], 2), [1, 2]);
        assert_eq!(best(5, value, &[(0, 1.0), (1, -1.0)], 4), [1, 2, 0, 3]);
        assert_eq!(best(5, value, &[], 3), [0, 1, 2]);
        assert_eq!(best(0, value, &[(0, 1.0)], 3), [0; 0]);
    }

    #[test]
    fn features_are_scaled_and_clipped() {
        assert_eq!(scaled(5.0, 2.0, 10.0), 2.5);
        assert_eq!(scaled(f64::INFINITY, 2.0, 10.0), 10.0);
        assert_eq!(scaled(-90.0, 2.0, 10.0), -10.0);
        assert!(scaled(f64::NAN, 2.0, 10.0).is_nan());
    }
}
