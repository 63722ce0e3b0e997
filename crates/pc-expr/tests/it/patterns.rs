//! Zero patterns and the colouring of their columns.

use pc_expr::Pattern;
use proptest::prelude::*;

#[test]
fn dense_and_compressed_entries_are_the_same() {
    let pattern = Pattern::from_columns(3, [vec![2, 0, 2], vec![], vec![1]]);
    assert_eq!((pattern.rows(), pattern.columns(), pattern.len()), (3, 3, 3));
    assert_eq!(pattern.entries().collect::<Vec<_>>(), [(0, 0), (2, 0), (1, 2)]);
    let mut dense = [f64::NAN; 9];
    pattern.scatter(&[1.0, 2.0, 3.0], &mut dense);
    assert_eq!(dense, [1.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0]);
    let mut values = [0.0; 3];
    pattern.gather(&dense, &mut values);
    assert_eq!(values, [1.0, 2.0, 3.0]);
    assert!(Pattern::full(3, 2).is_full() && !pattern.is_full());
}

#[test]
fn known_patterns_get_their_least_number_of_colours() {
    let n = 12;
    let colours = |columns: Vec<Vec<usize>>| Pattern::from_columns(n, columns).colouring().len();
    assert_eq!(colours((0..n).map(|j| vec![j]).collect()), 1, "diagonal");
    let band = |j: usize| (j.saturating_sub(1)..(j + 2).min(n)).collect();
    assert_eq!(colours((0..n).map(band).collect()), 3, "tridiagonal");
    let head = |j: usize| if j == 0 { (0..n).collect() } else { vec![j] };
    assert_eq!(colours((0..n).map(head).collect()), 2, "a full column and the diagonal");
    let arrow = |j: usize| if j == 0 { (0..n).collect() } else { vec![0, j] };
    assert_eq!(colours((0..n).map(arrow).collect()), n, "an arrow: all columns meet in its row");
    assert_eq!(colours(vec![Vec::new(); n]), 1, "nothing");
    assert!(Pattern::from_columns(0, Vec::<Vec<usize>>::new()).colouring().is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 200,
        rng_seed: prop::test_runner::RngSeed::Fixed(7),
        ..ProptestConfig::default()
    })]

    /// One product for each colour recovers every entry.
    #[test]
    fn products_with_the_colours_give_the_matrix(
        columns in prop::collection::vec(prop::collection::vec(0usize..15, 0..6), 0..25),
    ) {
        let pattern = Pattern::from_columns(15, columns);
        let colouring = pattern.colouring();
        prop_assert_eq!(colouring.colours().len(), pattern.columns());
        let most = (0..15).map(|row| pattern.row_indices().iter().filter(|&&i| i == row).count()).max();
        prop_assert!(colouring.len() >= most.unwrap_or(0), "a row meets as many colours as it has entries");
        let value = |i: usize, j: usize| (1 + i + 100 * j) as f64;
        let mut found = 0;
        for colour in 0..colouring.len() {
            let mut product = [0.0; 15];
            for j in colouring.columns(colour) {
                pattern.column(j).iter().for_each(|&i| product[i] += value(i, j));
            }
            for j in colouring.columns(colour) {
                for &i in pattern.column(j) {
                    prop_assert_eq!(product[i], value(i, j));
                    found += 1;
                }
            }
        }
        prop_assert_eq!(found, pattern.len());
        prop_assert_eq!(pattern.colouring(), colouring);
    }
}
