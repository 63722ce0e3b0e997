//! Independent blocks of a matrix.

/// The rows and columns of each block of a matrix that is block diagonal up to the order of its rows and
/// columns; the blocks are in the order of their first rows. `entries` holds the columns of the nonzero
/// entries of each row; rows and columns without entries are in no block. The blocks of large matrices are
/// often small, which shortens the work on them.
///
/// ```
/// let blocks = pc_expr::independent_blocks(3, &[vec![2], vec![0], vec![], vec![2, 1]]);
/// assert_eq!(blocks, [(vec![0, 3], vec![1, 2]), (vec![1], vec![0])]);
/// ```
pub fn independent_blocks(columns: usize, entries: &[Vec<usize>]) -> Vec<(Vec<usize>, Vec<usize>)> {
    let mut rows_of = vec![Vec::new(); columns];
    for (row, columns) in entries.iter().enumerate() {
        columns.iter().for_each(|&column| rows_of[column].push(row));
    }
    let (mut row_seen, mut column_seen) = (vec![false; entries.len()], vec![false; columns]);
    let mut blocks = Vec::new();
    for first in (0..entries.len()).filter(|&row| !entries[row].is_empty()) {
        if row_seen[first] {
            continue;
        }
        row_seen[first] = true;
        let (mut block_rows, mut block_columns) = (vec![first], Vec::new());
        let mut next = 0;
        while let Some(&row) = block_rows.get(next) {
            next += 1;
            for &column in &entries[row] {
                if std::mem::replace(&mut column_seen[column], true) {
                    continue;
                }
                block_columns.push(column);
                let met = rows_of[column].iter().filter(|&&row| !std::mem::replace(&mut row_seen[row], true));
                block_rows.extend(met);
            }
        }
        block_rows.sort_unstable();
        block_columns.sort_unstable();
        blocks.push((block_rows, block_columns));
    }
    blocks
}
