//! How orders match stock: which orders stock can serve, how many of their units pods can supply,
//! and which orders pods complete.

/// Returns whether `stock`, in units by SKU, has the units of all lines of an order.
///
/// Lines are pairs of a SKU and units; lines without units are ignored.
pub fn is_servable(lines: impl Iterator<Item = (usize, i32)>, stock: &[i64]) -> bool {
    let mut lines = lines;
    lines.all(|(sku, units)| units <= 0 || stock[sku] >= i64::from(units))
}

/// Returns how many units of an order pods can supply beyond what a station still needs from them.
///
/// `inbound` and `need` are units by SKU.
pub fn match_of(lines: impl Iterator<Item = (usize, i32)>, inbound: &[i32], need: &[i32]) -> i32 {
    let wanted = lines.filter(|&(_, units)| units > 0);
    wanted.map(|(sku, units)| (inbound[sku] - need[sku]).clamp(0, units)).sum()
}

/// Finds which orders a pod completes, one after another.
///
/// An order takes its units from the pod only if the pod has all of them left. `left` is what the
/// pod has, in units by row, and is changed; an order consists of pairs of a row and units.
pub fn completed(orders: &[Vec<(usize, i32)>], left: &mut [i32]) -> Vec<bool> {
    let serve = |order: &Vec<(usize, i32)>| {
        let covered = order.iter().all(|&(row, units)| left[row] >= units);
        if covered {
            for &(row, units) in order {
                left[row] -= units;
            }
        }
        covered
    };
    orders.iter().map(serve).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_is_servable_if_stock_has_all_its_units() {
        let stock = [2, 0, 5];
        let servable = |lines: &[(usize, i32)]| is_servable(lines.iter().copied(), &stock);
        assert!(servable(&[(0, 2), (2, 5)]));
        assert!(!servable(&[(0, 2), (1, 1)]));
        assert!(servable(&[(0, 2), (1, 0)]));
        assert!(servable(&[]));
    }

    #[test]
    fn a_match_counts_what_is_spare() {
        let (inbound, need) = ([4, 1, 9], [1, 3, 0]);
        let lines = [(0, 5), (1, 2), (2, 2), (0, 0)];
        assert_eq!(match_of(lines.into_iter(), &inbound, &need), 3 + 2);
    }

    #[test]
    fn an_order_takes_units_only_if_the_pod_has_all_of_them() {
        let orders = [vec![(0, 2), (1, 1)], vec![(0, 1)], vec![(0, 1)], vec![]];
        let mut left = [2, 0];
        assert_eq!(completed(&orders, &mut left), [false, true, true, true]);
        assert_eq!(left, [0, 0]);
    }
}
