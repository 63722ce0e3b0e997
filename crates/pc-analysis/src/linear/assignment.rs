//! Pairing of rows and columns at the least cost.

/// The column with which each row of a square matrix of costs is paired, such that the sum of the costs is
/// least: the method of H. W. Kuhn and J. Munkres with potentials, O(n³).
pub(super) fn cheapest(costs: &[Vec<f64>]) -> Vec<usize> {
    let n = costs.len();
    // Row and column 0 are placeholders; each column stores its row.
    let (mut of_row, mut of_column) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    let (mut row_of, mut from) = (vec![0; n + 1], vec![0; n + 1]);
    for row in 1..=n {
        row_of[0] = row;
        let (mut least, mut used) = (vec![f64::INFINITY; n + 1], vec![false; n + 1]);
        let mut here = 0;
        loop {
            used[here] = true;
            let (mut step, mut next) = (f64::INFINITY, 0);
            for column in (1..=n).filter(|&column| !used[column]) {
                let at = row_of[here];
                let reduced = costs[at - 1][column - 1] - of_row[at] - of_column[column];
                if reduced < least[column] {
                    (least[column], from[column]) = (reduced, here);
                }
                if least[column] < step {
                    (step, next) = (least[column], column);
                }
            }
            for column in 0..=n {
                if used[column] {
                    of_row[row_of[column]] += step;
                    of_column[column] -= step;
                } else {
                    least[column] -= step;
                }
            }
            here = next;
            if row_of[here] == 0 {
                break;
            }
        }
        while here != 0 {
            row_of[here] = row_of[from[here]];
            here = from[here];
        }
    }
    let mut columns = vec![0; n];
    (1..=n).for_each(|column| columns[row_of[column] - 1] = column - 1);
    columns
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The result is compared with the costs of all pairings.
    #[test]
    fn no_pairing_is_cheaper() {
        fn least(costs: &[Vec<f64>], row: usize, used: &mut Vec<usize>) -> f64 {
            let Some(line) = costs.get(row) else { return 0.0 };
            let mut best = f64::INFINITY;
            for column in 0..costs.len() {
                if !used.contains(&column) {
                    used.push(column);
                    best = best.min(line[column] + least(costs, row + 1, used));
                    used.pop();
                }
            }
            best
        }
        for seed in 0..40u32 {
            let cost = |i: u32, j: u32| f64::from((seed * 31 + i * 17 + j * 53 + i * j * 29) % 23);
            let costs: Vec<Vec<f64>> = (0..5).map(|i| (0..5).map(|j| cost(i, j)).collect()).collect();
            let columns = cheapest(&costs);
            let sum: f64 = columns.iter().enumerate().map(|(row, &column)| costs[row][column]).sum();
            assert_eq!(sum, least(&costs, 0, &mut Vec::new()), "{costs:?} {columns:?}");
        }
        assert!(cheapest(&[]).is_empty());
    }
}
