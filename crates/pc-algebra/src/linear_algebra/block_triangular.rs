//! The block triangular form of a square matrix, found from its zeros alone.
//!
//! Rows are matched with columns; the strongly connected components of the resulting dependency graph are the blocks
//! (I. S. Duff, A. M. Erisman, J. K. Reid, *Direct Methods for Sparse Matrices*, 2017, ch. 6). The determinant is the
//! product of the determinants of the blocks, so each block is regular wherever the matrix is.

/// The rows and columns of the diagonal blocks, such that the rows of each block have entries only in its own
/// columns and in those of earlier blocks; `entries` lists, for each row, the columns of its entries. `None` if
/// rows and columns cannot be matched.
pub(crate) fn block_triangular(entries: &[Vec<usize>]) -> Option<Vec<(Vec<usize>, Vec<usize>)>> {
    let n = entries.len();
    let mut row_of = vec![None; n];
    for row in 0..n {
        if !is_matched(row, entries, &mut vec![false; n], &mut row_of) {
            return None;
        }
    }
    let mut column_of = vec![0; n];
    for (column, row) in row_of.iter().enumerate() {
        column_of[(*row)?] = column;
    }
    let next = |row: usize| entries[row].iter().filter_map(|&column| row_of[column]).collect::<Vec<usize>>();
    let components = components(&(0..n).map(next).collect::<Vec<_>>());
    let block = |mut rows: Vec<usize>| {
        rows.sort_unstable();
        let mut columns: Vec<usize> = rows.iter().map(|&row| column_of[row]).collect();
        columns.sort_unstable();
        (rows, columns)
    };
    Some(components.into_iter().map(block).collect())
}

/// Finds a column for the row, if necessary by reassigning other rows to other columns.
fn is_matched(row: usize, entries: &[Vec<usize>], tried: &mut [bool], row_of: &mut [Option<usize>]) -> bool {
    for &column in &entries[row] {
        if tried[column] {
            continue;
        }
        tried[column] = true;
        if row_of[column].is_none_or(|other| is_matched(other, entries, tried, row_of)) {
            row_of[column] = Some(row);
            return true;
        }
    }
    false
}

/// The strongly connected components, each after all others that can be reached from it (R. Tarjan, 1972).
fn components(next: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut search = Search {
        next,
        number: vec![None; next.len()],
        low: vec![0; next.len()],
        path: Vec::new(),
        found: Vec::new(),
    };
    let mut count = 0;
    for node in 0..next.len() {
        if search.number[node].is_none() {
            search.visit(node, &mut count);
        }
    }
    search.found
}

struct Search<'a> {
    next: &'a [Vec<usize>],
    /// The number of each node in the order in which nodes are reached.
    number: Vec<Option<usize>>,
    /// The lowest number of a node on the path that can be reached from each node.
    low: Vec<usize>,
    path: Vec<usize>,
    found: Vec<Vec<usize>>,
}

impl Search<'_> {
    fn visit(&mut self, node: usize, count: &mut usize) {
        let number = *count;
        *count += 1;
        (self.number[node], self.low[node]) = (Some(number), number);
        self.path.push(node);
        for &other in &self.next[node] {
            match self.number[other] {
                None => {
                    self.visit(other, count);
                    self.low[node] = self.low[node].min(self.low[other]);
                }
                Some(met) if self.path.contains(&other) => self.low[node] = self.low[node].min(met),
                Some(_) => {}
            }
        }
        if self.low[node] == number {
            let start = self.path.iter().rposition(|&other| other == node).unwrap_or(0); // the node is on the path
            self.found.push(self.path.split_off(start));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_and_cycles_are_distinguished() {
        let triangle = [vec![0, 1, 2], vec![1, 2], vec![2]];
        let blocks =
            block_triangular(&triangle).map(|blocks| blocks.into_iter().map(|(rows, _)| rows).collect());
        assert_eq!(blocks, Some(vec![vec![2], vec![1], vec![0]]));
        let cycle = [vec![0, 1], vec![1, 2], vec![2, 0]];
        assert_eq!(block_triangular(&cycle), Some(vec![(vec![0, 1, 2], vec![0, 1, 2])]));
        assert_eq!(block_triangular(&[vec![1], vec![0]]), Some(vec![(vec![0], vec![1]), (vec![1], vec![0])]));
        assert_eq!(block_triangular(&[vec![0], vec![0]]), None);
    }
}
