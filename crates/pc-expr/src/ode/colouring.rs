//! Columns of a matrix that can be found from one product.

use crate::ode::pattern::Pattern;

/// A colour for each column of a [`Pattern`], such that columns of one colour share no row.
///
/// The product of the matrix and the sum of the unit vectors of one colour then holds every entry of these
/// columns, so that as many products, or difference quotients, as there are colours give the whole matrix. A.
/// R. Curtis, M. J. D. Powell, J. K. Reid, *On the estimation of sparse Jacobian matrices* (1974).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Colouring {
    colours: Vec<usize>,
    count: usize,
}

impl Colouring {
    /// Gives each column the first colour that none of its rivals, the columns that share a row with it,
    /// has; columns with the most rivals come first, and columns with equally many rivals keep the order of
    /// the matrix.
    pub(crate) fn of(pattern: &Pattern) -> Colouring {
        let rivals = rivals(pattern);
        let mut order: Vec<usize> = (0..pattern.columns()).collect();
        order.sort_by_key(|&j| std::cmp::Reverse(rivals[j].len()));
        let mut colours: Vec<Option<usize>> = vec![None; pattern.columns()];
        let mut count = 0;
        for j in order {
            let mut taken = vec![false; count + 1];
            for colour in rivals[j].iter().filter_map(|&rival| colours[rival]) {
                taken[colour] = true;
            }
            let colour = taken.iter().take_while(|&&taken| taken).count(); // the last is free
            colours[j] = Some(colour);
            count = count.max(colour + 1);
        }
        Colouring { colours: colours.into_iter().flatten().collect(), count }
    }

    /// Number of colours.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are no columns.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The colour, below [`len`](Colouring::len), of each column.
    pub fn colours(&self) -> &[usize] {
        &self.colours
    }

    /// The columns of a colour, in ascending order.
    pub fn columns(&self, colour: usize) -> impl Iterator<Item = usize> + '_ {
        self.colours.iter().enumerate().filter(move |&(_, &of)| of == colour).map(|(j, _)| j)
    }
}

impl Pattern {
    /// Colours of the columns such that columns of one colour share no row.
    pub fn colouring(&self) -> Colouring {
        Colouring::of(self)
    }
}

/// For each column, the other columns that share a row with it.
fn rivals(pattern: &Pattern) -> Vec<Vec<usize>> {
    let mut columns_of_row: Vec<Vec<usize>> = vec![Vec::new(); pattern.rows()];
    for (i, j) in pattern.entries() {
        columns_of_row[i].push(j);
    }
    let of = |j: usize| {
        let mut rivals: Vec<usize> =
            pattern.column(j).iter().flat_map(|&i| &columns_of_row[i]).copied().filter(|&r| r != j).collect();
        rivals.sort_unstable();
        rivals.dedup();
        rivals
    };
    (0..pattern.columns()).map(of).collect()
}
