//! Numerical values of expressions at pseudo-random points, for tests that the graph cannot decide exactly.

use pc_expr::{Expr, Function, Graph, Scalar, SymbolPlaces, Weighed, independent_blocks};

use crate::identity::magnitudes::magnitudes;
use crate::linear_algebra::matrix::Matrix;

/// The number of points at which an identity that the graph leaves open is tested.
pub(crate) const TRIALS: usize = 8;

/// The greatest value, as a fraction of its terms, that some thousand roundings leave in a sum that vanishes
/// identically.
pub(crate) const HIDDEN: f64 = 1e-12;

/// Values of symbols near which an expression is regular; symbols that are not listed are taken near 1.
///
/// Nearby points have components of the order of the values and of 1. If expressions have no values there, are too small for
/// floating-point numbers, or seem to vanish, points are added at which the [commensurable](Graph::commensurable) terms of the
/// expressions are of the same order, so that no result about a model depends on its units.
#[derive(Clone, Debug, Default)]
pub struct Neighbourhood<'g> {
    /// Symbols and their values.
    pub centre: Vec<(Expr<'g>, f64)>,
}

impl<'g> Neighbourhood<'g> {
    /// A sum smaller than this fraction of its terms counts as a rounding error, even if its constants have
    /// only ten digits: a sum that does not vanish is of the order of its terms.
    pub const ROUNDING: f64 = 1e-9;

    /// The values of `outputs` at point number `index` of a fixed sequence near the centre (number 0 is the
    /// centre).
    pub(crate) fn sample<S: Scalar>(
        &self,
        graph: &'g Graph,
        outputs: &[Expr<'g>],
        index: u64,
    ) -> Option<Vec<S>> {
        let mut random = Random(index);
        let centre = self.centre_of(&graph.symbols_of(outputs));
        let value = |(symbol, centre): (Expr<'g>, f64)| {
            let reach = 0.1 + 0.2 * centre.abs();
            (symbol, S::from_f64(if index == 0 { centre } else { centre + reach * random.next() }))
        };
        let values: Vec<(Expr<'g>, S)> = centre.into_iter().map(value).collect();
        graph.evaluate(outputs, &values).ok()
    }

    /// The symbols with their values at the centre.
    fn centre_of(&self, symbols: &[Expr<'g>]) -> Vec<(Expr<'g>, f64)> {
        let known = SymbolPlaces::of(&self.centre.iter().map(|&(symbol, _)| symbol).collect::<Vec<_>>());
        let value = |symbol: Expr<'g>| known.get(symbol).map_or(1.0, |place| self.centre[place].1);
        symbols.iter().map(|&symbol| (symbol, value(symbol))).collect()
    }

    /// Points at which the terms of the expressions are of the same order, alternately near the centre and away from it; none if
    /// the points of [`sample`](Self::sample) already are.
    pub(crate) fn points_of_one_order(
        &self,
        graph: &'g Graph,
        expressions: &[Expr<'g>],
        count: usize,
    ) -> Vec<Vec<(Expr<'g>, f64)>> {
        let centre = self.centre_of(&graph.symbols_of(expressions));
        let from: Vec<(Expr<'g>, f64)> =
            centre.iter().map(|&(symbol, c)| (symbol, if c == 0.0 { 1.0 } else { c })).collect();
        let Some(sizes) = magnitudes(graph, expressions, &from, &[]) else { return Vec::new() };
        let point = |index: u64| {
            let mut random = Random(index);
            let value = |(&(symbol, c), size): (&(Expr<'g>, f64), f64)| match index % 2 {
                0 => (symbol, c + 0.3 * size * random.next()),
                _ => (symbol, size * (0.5 + 0.4 * random.next())),
            };
            centre.iter().zip(sizes.iter().copied()).map(value).collect()
        };
        (0..count as u64).map(point).collect()
    }

    /// The largest absolute value of the expressions at the centre and points near it where all are finite; infinity if
    /// there are no such points, 0 if there are no expressions.
    pub fn largest(&self, graph: &'g Graph, expressions: &[Expr<'g>]) -> f64 {
        if expressions.is_empty() {
            return 0.0;
        }
        let samples = self.samples(graph, expressions, TRIALS);
        let largest = samples.iter().flatten().fold(0.0f64, |largest, value| largest.max(value.abs()));
        if samples.is_empty() { f64::INFINITY } else { largest }
    }

    /// The largest |f|/Σ|terms| of sums f of `terms` at the centre and points near it where all are finite: about
    /// 10⁻¹⁶ where f vanishes identically but the graph does not fold it to 0, and never more than 1; infinity if
    /// there are no such points. The result is 0 only if the graph folds f to 0. Σ|terms| includes terms that
    /// have cancelled inside a term.
    ///
    /// The result does not depend on units: 10⁻¹⁰ x is not zero.
    ///
    /// ```
    /// # use pc_algebra::Neighbourhood;
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// let near = Neighbourhood::default();
    /// assert_eq!(near.residual(&graph, &[vec![1e-10 * x]]), 1.0);
    /// // log(xy) = log x + log y is unknown to the graph.
    /// let zero = [(x * y).log(), -x.log(), -y.log()];
    /// assert!(near.residual(&graph, &[zero.to_vec()]) < 1e-15);
    /// ```
    pub fn residual(&self, graph: &'g Graph, sums: &[Vec<Expr<'g>>]) -> f64 {
        let open = |terms: &&Vec<Expr<'g>>| !graph.sum(terms.iter().copied()).is_zero();
        let sums: Vec<&Vec<Expr<'g>>> = sums.iter().filter(open).collect();
        if sums.is_empty() {
            return 0.0;
        }
        let terms: Vec<Expr<'g>> = sums.iter().flat_map(|terms| terms.iter().copied()).collect();
        let samples = self.weighed(graph, &terms, TRIALS);
        if samples.is_empty() {
            return f64::INFINITY;
        }
        let of_sample = |sample: &Vec<Weighed>| {
            let mut values = sample.iter().copied();
            let sum = |terms: &&Vec<Expr<'g>>| {
                let zero = Weighed::from_f64(0.0);
                values.by_ref().take(terms.len()).fold(zero, |sum, term| sum + term).rest()
            };
            sums.iter().map(sum).fold(0.0, f64::max)
        };
        let worst = |samples: &[Vec<Weighed>]| samples.iter().map(of_sample).fold(f64::EPSILON, f64::max);
        match worst(&samples) {
            // Numbers alone prove nothing.
            small if small <= Self::ROUNDING => small.max(worst(&self.of_one_order(graph, &terms, TRIALS))),
            large => large,
        }
    }

    /// A neighbourhood in which the expressions have values, if one can be found without given values for
    /// their symbols.
    pub fn anywhere(graph: &'g Graph, expressions: &[Expr<'g>]) -> Neighbourhood<'g> {
        let symbols = graph.symbols_of(expressions);
        let about =
            |value: f64| Neighbourhood { centre: symbols.iter().map(|&symbol| (symbol, value)).collect() };
        let has = |is: fn(Weighed) -> bool| {
            move |near: &Neighbourhood<'g>| !near.beside(graph, expressions, 1, is).is_empty()
        };
        let usual = || [1.0, 0.0, -1.0, 0.3, 3.0, 10.0, -10.0].into_iter().map(about);
        let of_one_order = || {
            let points = Neighbourhood::default().points_of_one_order(graph, expressions, 4 * TRIALS);
            points.into_iter().map(|centre| Neighbourhood { centre }).find(has(Weighed::is_known))
        };
        let known = usual().find(has(Weighed::is_known)).or_else(of_one_order);
        known.or_else(|| usual().find(has(Weighed::is_finite))).unwrap_or_default()
    }

    /// Whether an expression is zero, or at least no more than a rounding error wherever it has values
    /// nearby, even if the graph does not fold it to zero.
    pub fn vanishes(&self, graph: &'g Graph, expression: Expr<'g>) -> bool {
        if expression.constant().is_some() {
            return expression.is_zero();
        }
        let samples = self.weighed(graph, &[expression], TRIALS);
        // A piecewise function may be 0 on this piece only.
        let is_zero = |value: &Weighed| value.value == 0.0 && in_pieces(graph, &[expression]);
        let is_rounding = |value: &Weighed| value.rest() <= HIDDEN && !is_zero(value);
        let vanish = |samples: &[Vec<Weighed>]| samples.iter().flatten().all(is_rounding);
        !samples.is_empty() && vanish(&samples) && vanish(&self.of_one_order(graph, &[expression], TRIALS))
    }

    /// The greatest numerical rank of a matrix at nearby points; `None` if the matrix has no values there, or
    /// if they may belong to only one piece of a function.
    pub(crate) fn rank(&self, graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Option<usize> {
        let entries = matrix.nonzero_entries();
        if in_pieces(graph, &entries) {
            return None;
        }
        let greatest = |samples: Vec<Vec<Weighed>>| {
            samples.into_iter().map(|sample| rank_of_sample(matrix, &sample)).max()
        };
        let seen = greatest(self.weighed(graph, &entries, TRIALS))?;
        let is_full = seen == matrix.rows().min(matrix.columns());
        Some(if is_full {
            seen
        } else {
            greatest(self.of_one_order(graph, &entries, TRIALS)).map_or(seen, |more| more.max(seen))
        })
    }

    /// The rank of a matrix at the centre; `None` if it has no values there.
    pub fn rank_at_centre(&self, graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Option<usize> {
        let sample = self.sample::<Weighed>(graph, &matrix.nonzero_entries(), 0)?;
        sample.iter().all(|x| x.is_finite()).then(|| rank_of_sample(matrix, &sample))
    }

    /// The values of the outputs at up to `count` points where all are finite.
    pub(crate) fn samples(&self, graph: &'g Graph, outputs: &[Expr<'g>], count: usize) -> Vec<Vec<f64>> {
        let values = |sample: Vec<Weighed>| sample.into_iter().map(|x| x.value).collect();
        self.weighed(graph, outputs, count).into_iter().map(values).collect()
    }

    /// The values of the outputs with their weights; see [`samples`](Self::samples). Points are left out where a value is too small
    /// for a floating-point number, unless no others are found.
    pub(crate) fn weighed(&self, graph: &'g Graph, outputs: &[Expr<'g>], count: usize) -> Vec<Vec<Weighed>> {
        let mut found = self.beside(graph, outputs, count, Weighed::is_known);
        if found.len() < count {
            found.extend(self.of_one_order(graph, outputs, count - found.len()));
        }
        if found.is_empty() {
            found = self.beside(graph, outputs, count, Weighed::is_finite);
        }
        found
    }

    /// The values of the outputs at up to `count` points near the centre at which all outputs have the
    /// required kind of value.
    fn beside(
        &self,
        graph: &'g Graph,
        outputs: &[Expr<'g>],
        count: usize,
        is: fn(Weighed) -> bool,
    ) -> Vec<Vec<Weighed>> {
        let values = (0..4 * count as u64).filter_map(|index| self.sample::<Weighed>(graph, outputs, index));
        values.filter(|values| values.iter().all(|&x| is(x))).take(count).collect()
    }

    /// The values of the outputs at the points at which [terms are of the same
    /// order](Self::points_of_one_order).
    fn of_one_order(&self, graph: &'g Graph, outputs: &[Expr<'g>], count: usize) -> Vec<Vec<Weighed>> {
        let value = |point: Vec<(Expr<'g>, f64)>| {
            let point: Vec<_> = point.into_iter().map(|(x, value)| (x, Weighed::from_f64(value))).collect();
            graph.evaluate(outputs, &point).ok()
        };
        let points = self.points_of_one_order(graph, outputs, 4 * count).into_iter();
        let is_known = |values: &Vec<Weighed>| values.iter().all(|x| x.is_known());
        points.filter_map(value).filter(is_known).take(count).collect()
    }
}

/// Whether expressions contain piecewise functions.
fn in_pieces<'g>(graph: &'g Graph, expressions: &[Expr<'g>]) -> bool {
    let symbols = graph.symbols_of(expressions);
    expressions.iter().any(|&expression| graph.applies(expression, &symbols, Function::is_piecewise))
}

/// The rank of a matrix whose nonzero entries have these values, computed block by block.
fn rank_of_sample(matrix: &Matrix<Expr<'_>>, sample: &[Weighed]) -> usize {
    let mut numbers = sample.iter().copied();
    let row = |i| matrix.nonzero(i).zip(numbers.by_ref()).map(|((j, _), number)| (j, number)).collect();
    let rows: Vec<Vec<(usize, Weighed)>> = (0..matrix.rows()).map(row).collect();
    let columns = |row: &Vec<(usize, Weighed)>| row.iter().map(|&(j, _)| j).collect();
    let blocks = independent_blocks(matrix.columns(), &rows.iter().map(columns).collect::<Vec<_>>());
    let whole = |row: &[(usize, Weighed)], columns: &[usize]| {
        let mut whole = vec![Weighed::from_f64(0.0); columns.len()];
        for (j, number) in row {
            if let Ok(place) = columns.binary_search(j) {
                whole[place] = *number;
            }
        }
        whole
    };
    let of_block =
        |(i, j): &(Vec<usize>, Vec<usize>)| rank(i.iter().map(|&i| whole(&rows[i], j)).collect(), j.len());
    blocks.iter().map(of_block).sum()
}

/// The rank of a matrix with that many columns, by elimination with complete pivoting; rounding errors count as
/// zero.
fn rank(mut rows: Vec<Vec<Weighed>>, columns: usize) -> usize {
    let mut open: Vec<usize> = (0..columns).collect();
    let total = rows.len();
    while !rows.is_empty() {
        let largest = |row: &[Weighed]| open.iter().fold(0.0, |most, &j| f64::max(most, row[j].size()));
        let places = rows.iter().enumerate().flat_map(|(i, row)| open.iter().map(move |&j| (i, j, row)));
        let certain = places.filter(|(_, j, row)| row[*j].rest() > HIDDEN);
        let share = |row: &[Weighed], j: usize| row[j].value.abs() / largest(row);
        let best = certain.max_by(|(_, j, a), (_, l, b)| share(a, *j).total_cmp(&share(b, *l)));
        let Some((i, j, _)) = best else { break };
        let pivot = rows.swap_remove(i);
        let reciprocal = Weighed::powi(pivot[j], -1);
        for row in &mut rows {
            let factor = -(row[j] * reciprocal);
            open.iter().filter(|&&l| l != j).for_each(|&l| row[l] = row[l] + factor * pivot[l]);
        }
        open.retain(|&l| l != j);
    }
    total - rows.len()
}

/// A generator of numbers uniform in (−1, 1) (splitmix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
