//! Linear relations with rational coefficients between expressions.
//!
//! A relation Σ a_j f_j = 0 holds at every point, so each random point of GF(2⁶¹ − 1) gives an equation for
//! the a_j. Points are added until two in a row add no equation; the null space is then read back as fractions. The
//! result is a proposal: only relations that the graph itself folds to zero are returned.

use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::number::Number;
use crate::identity::echelon::ResidueEchelon;
use crate::identity::prime_field::Residue;
use crate::identity::sampler::Sampler;

/// This many points in a row without a new equation end the search.
const IDLE_POINTS: usize = 2;

impl Graph {
    /// A basis of the rational relations Σ_j a_j f_j = 0 between the columns f_1..f_N, each of them m
    /// expressions.
    ///
    /// The result is a list of vectors (a_1, …, a_N) with coprime integer entries, the first nonzero one
    /// positive. The last nonzero entry of each is in a column where all other vectors have zero, in
    /// ascending order: simple columns should come first.
    ///
    /// Every relation is certified: Σ_j a_j f_ji folds to zero for each i, so that few are found with
    /// [`Folding::Structural`](crate::Folding::Structural). Some relations are missed: those whose coefficients, divided by the last,
    /// are not rational or are p/q with p·q beyond about 2⁵⁰; those blurred by constants beyond the range of
    /// exact [`Number`]s; and those that fingerprints cannot see, such as relations between logarithms.
    ///
    /// # Panics
    /// If the columns have different lengths.
    ///
    /// ```
    /// use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let x = graph.symbol("x");
    /// let columns = [1.into(), x.cos().powi(2), x.sin() * x.cos(), (2.0 * x).cos()].map(|f| vec![f]);
    /// let relations = graph.linear_relations(&columns); // cos 2x = 2 cos²x − 1
    /// assert_eq!(relations, [[1, -2, 0, 1].map(Into::into)]);
    /// ```
    pub fn linear_relations<'g>(&'g self, columns: &[Vec<Expr<'g>>]) -> Vec<Vec<Number>> {
        let components = columns.first().map_or(0, Vec::len);
        let holds = |a: &Vec<Number>| {
            let coefficients = || a.iter().map(|&a| Expr::from(a));
            (0..components).all(|i| self.dot(coefficients(), columns.iter().map(|f| f[i])).is_zero())
        };
        let proposal = |vector: Vec<Residue>| whole(&vector.into_iter().map(fraction).collect::<Vec<_>>());
        self.echelon(columns, &[]).null_space().into_iter().map(proposal).filter(holds).collect()
    }

    /// The columns that are combinations of the preceding ones with coefficients a that depend only on the
    /// `constants` among the symbols of the columns: f_j = Σ_{i<j} a_ji f_i at almost all values, where the
    /// a_ji are functions of the `constants`.
    ///
    /// Each of these columns comes with a_j1..a_j,j−1 as fractions, which are 0 for columns that are combinations
    /// themselves. These combinations are a proposal, which is right only if the coefficients are rational
    /// numbers.
    ///
    /// The other columns are certainly independent over the functions of the `constants`; a combination may
    /// be missed if a column contains rounded constants, or functions for which fingerprints know no
    /// identities.
    ///
    /// # Panics
    /// If the columns have different lengths.
    ///
    /// ```
    /// use pc_expr::{Graph, Number};
    /// let graph = Graph::new();
    /// let [x, p] = graph.symbols(["x", "p"]);
    /// let columns = [x, p * x, p.square(), 0.37 * x].map(|f| vec![f]);
    /// let dependent = |constants: &[_]| -> Vec<usize> {
    ///     graph.dependent_columns(&columns, constants).into_iter().map(|(j, _)| j).collect()
    /// };
    /// assert_eq!((dependent(&[p]), dependent(&[])), (vec![1, 3], vec![3]));
    /// assert_eq!(graph.dependent_columns(&columns, &[])[0].1[0], Number::ratio(37, 100));
    /// ```
    pub fn dependent_columns<'g>(
        &'g self,
        columns: &[Vec<Expr<'g>>],
        constants: &[Expr<'g>],
    ) -> Vec<(usize, Vec<Number>)> {
        let vectors = self.echelon(columns, constants).null_space().into_iter();
        let last = |vector: &[Residue]| vector.iter().rposition(|&x| x != Residue::ZERO).unwrap_or(0);
        vectors.map(|v| (last(&v), v[..last(&v)].iter().map(|&x| fraction(-x)).collect())).collect()
    }

    /// The values of the columns at random points, until further points add no equation.
    pub(super) fn echelon<'g>(&'g self, columns: &[Vec<Expr<'g>>], constants: &[Expr<'g>]) -> ResidueEchelon {
        let components = columns.first().map_or(0, Vec::len);
        assert!(columns.iter().all(|column| column.len() == components), "columns of one length");
        let sampler = Sampler::new(self, &columns.concat(), constants);
        equations(&sampler, columns.len(), components, &[])
    }
}

/// The equations for the coefficients of `columns` columns at these places of the constants: points are added until
/// two in a row add none.
pub(super) fn equations(
    sampler: &Sampler<'_>,
    columns: usize,
    components: usize,
    places: &[usize],
) -> ResidueEchelon {
    let mut echelon = ResidueEchelon::new(columns);
    let mut idle = 0;
    for point in 0.. {
        let values = sampler.at(point, places);
        let rank = echelon.rank();
        for i in 0..components {
            echelon.insert((0..columns).map(|j| values[j * components + i]).collect());
        }
        idle = if echelon.rank() > rank { 0 } else { idle + 1 };
        if idle == IDLE_POINTS {
            break;
        }
    }
    echelon
}

/// The fraction p/q = x with the smallest p·q, by maximal quotient rational reconstruction (M. Monagan,
/// ISSAC 2004): in Euclid's algorithm for 2⁶¹ − 1 and x, p and q precede the largest quotient.
pub(super) fn fraction(x: Residue) -> Number {
    let (mut r0, mut r1) = ((-Residue::<1>::ONE).to_bits() + 1, x.to_bits());
    let (mut s0, mut s1) = (0i64, 1i64);
    let (mut largest, mut found) = (0, Number::ZERO);
    while r1 != 0 {
        let quotient = r0 / r1;
        if quotient > largest {
            (largest, found) = (quotient, Number::ratio(r1 as i64, s1));
        }
        (r0, r1) = (r1, r0 - quotient * r1);
        (s0, s1) = (s1, s0 - quotient as i64 * s1);
    }
    found
}

/// The vector with denominators and common factors removed, as far as its entries stay exact; the first entry
/// is positive.
pub(super) fn whole(vector: &[Number]) -> Vec<Number> {
    let mut entries = vector.iter().copied().filter(|a| !a.is_zero());
    let Some(first) = entries.next() else { return vector.to_vec() };
    let common = entries.try_fold(first.abs(), Number::content).unwrap_or(Number::ONE);
    let scale = if first.is_negative() { -common.recip() } else { common.recip() };
    vector.iter().map(|&a| a * scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_read_back() {
        for (p, q) in [(1, 3), (-7, 12), (0, 1), (-1, 1), (866_124_913, 1_000_000), (-1, 1_073_741_789)] {
            let x = Residue::integer(p) * Residue::integer(q).inverse();
            assert_eq!(fraction(x), Number::ratio(p, q));
        }
    }

    #[test]
    fn relations_end_in_their_own_column() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let half = Expr::ratio(1, 2);
        let columns = [x, y, x + half * y, x * y, 3.0 * (x - y)].map(|f| vec![f]);
        let expected = [[2, 1, -2, 0, 0], [3, -3, 0, 0, -1]].map(|row| row.map(Number::integer).to_vec());
        assert_eq!(graph.linear_relations(&columns), expected);
    }

    #[test]
    fn all_components_count() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let columns = [vec![x, y], vec![y, x], vec![x + y, x + y], vec![2.0 * x, 3.0 * y]];
        assert_eq!(graph.linear_relations(&columns), [[1, 1, -1, 0].map(Number::integer)]);
        assert!(graph.linear_relations(&[]).is_empty());
        assert!(graph.linear_relations(&[vec![x], vec![x.sqrt()], vec![x.log()]]).is_empty());
    }

    /// The laws of the circle and of the exponential hold at every point.
    #[test]
    fn addition_theorems_are_relations() {
        let graph = Graph::new();
        let [a, b] = graph.symbols(["a", "b"]);
        let columns = [a.sin() * b.cos(), a.cos() * b.sin(), (a + b).sin(), a.exp(), (-a).exp(), a.cosh()];
        let relations = graph.linear_relations(&columns.map(|f| vec![f]));
        let expected = [[1, 1, -1, 0, 0, 0], [0, 0, 0, 1, 1, -2]];
        assert_eq!(relations, expected.map(|row| row.map(Number::integer).to_vec()));
    }
}
