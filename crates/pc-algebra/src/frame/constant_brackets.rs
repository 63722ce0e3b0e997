//! Constant structure coefficients of frames whose operators are dependent at each point.
//!
//! If rank b < k, b c_rs = [X_r, X_s] has many solutions c_rs at each point, and therefore many solutions that
//! change from point to point. Solutions that are the same at all points, functions of parameters and time
//! only, are unique if no combination of the operators with such coefficients vanishes; otherwise none of them
//! can be singled out as the bracket.

use nalgebra::{DMatrix, DVector};
use pc_expr::{Expr, Graph, Number};

use crate::error::AlgebraError;
use crate::frame::frame::Frame;
use crate::frame::structure::StructureCoefficients;
use crate::identity::sample::Neighbourhood;
use crate::linear_algebra::inverse::inverse;
use crate::linear_algebra::matrix::Matrix;

/// If the ratio of the smallest to the largest singular value of several operators is below this, the numbers
/// suggest that they may be dependent.
const DEPENDENT: f64 = 1e-9;
/// The size, relative to a vector, that rounding errors may give to a component that is zero.
const ROUNDED: f64 = 1e-11;
/// The maximum number of points tried per operator to find as many equations as unknowns.
const POINTS: usize = 8;

impl<'g> Frame<'g> {
    /// The c_rs^m with b c_rs = [X_r, X_s] that do not depend on the coordinates.
    ///
    /// # Errors
    /// [`AlgebraError::Undetermined`] if there may be several solutions; [`AlgebraError::RankDeficient`] with
    /// the first pair for which there is none.
    pub(crate) fn constant_coefficients(
        &self,
        rank: usize,
        near: &Neighbourhood<'g>,
    ) -> Result<StructureCoefficients<'g>, AlgebraError> {
        let k = self.operators();
        let operators: Vec<Vec<Expr<'g>>> = (1..=k).map(|s| self.operator(s)).collect();
        self.check_independent(rank, &operators, near)?;
        let pairs = self.coupled_pairs();
        let commutators: Vec<Vec<Expr<'g>>> = pairs.iter().map(|&(r, s)| self.commutator(r, s)).collect();
        let mut found = self.combinations(&operators, &commutators, near).into_iter();
        StructureCoefficients::from_pairs(k, pairs, |r, s| {
            let refusal = AlgebraError::RankDeficient { rank, operators: k, pair: (r, s) };
            found.next().flatten().ok_or(refusal)
        })
    }

    /// Returns an error if a combination of the operators with coefficients independent of the coordinates
    /// vanishes.
    ///
    /// # Errors
    /// [`AlgebraError::Undetermined`]
    fn check_independent(
        &self,
        rank: usize,
        operators: &[Vec<Expr<'g>>],
        near: &Neighbourhood<'g>,
    ) -> Result<(), AlgebraError> {
        let undetermined = |combination: Vec<(usize, String)>| {
            let operators = operators.len();
            Err(AlgebraError::Undetermined { rank, operators, combination })
        };
        let constants = self.constants(operators);
        if let Some((last, _)) = self.graph().dependent_columns(operators, &constants).into_iter().next() {
            let target = std::slice::from_ref(&operators[last]);
            let known = self.combinations(&operators[..last], target, near).remove(0);
            return undetermined(known.map_or_else(Vec::new, |a| vanishing(&a, last)));
        }
        if self.graph().is_decidable(&operators.concat()) {
            return Ok(());
        }
        match self.vanishing_in_numbers(operators, near) {
            Some(combination) => undetermined(combination),
            None => Ok(()),
        }
    }

    /// The symbols other than coordinates.
    fn constants(&self, columns: &[Vec<Expr<'g>>]) -> Vec<Expr<'g>> {
        let mut symbols = self.graph().symbols_of(&columns.concat());
        symbols.retain(|symbol| !self.coordinates().contains(symbol));
        symbols
    }

    /// The coefficients a with Y = Σ a_s X_s for each Y of the `targets`, if such coefficients exist; the X_s
    /// are the first operators, which are independent. The coefficients are sought as fractions, as
    /// expressions in parameters and time, and as rounded numbers; each result is verified.
    fn combinations(
        &self,
        operators: &[Vec<Expr<'g>>],
        targets: &[Vec<Expr<'g>>],
        near: &Neighbourhood<'g>,
    ) -> Vec<Option<Vec<Expr<'g>>>> {
        let holds = |target: &[Expr<'g>], a: &[Expr<'g>]| {
            let components: Vec<[Expr<'g>; 1]> = target.iter().map(|&y| [y]).collect();
            self.residual(&components, a, near) <= Neighbourhood::ROUNDING
        };
        let is_zero = |target: &Vec<Expr<'g>>| target.iter().all(|y| y.is_zero());
        let mut found: Vec<Option<Vec<Expr<'g>>>> =
            targets.iter().map(|y| is_zero(y).then(|| vec![Expr::ZERO; operators.len()])).collect();
        for way in [Frame::fractions, Frame::solved, Frame::fitted] {
            let open: Vec<usize> = (0..targets.len()).filter(|&y| found[y].is_none()).collect();
            if open.is_empty() {
                break;
            }
            let rest: Vec<Vec<Expr<'g>>> = open.iter().map(|&y| targets[y].clone()).collect();
            for (&y, a) in open.iter().zip(way(self, operators, &rest, near).unwrap_or_default()) {
                found[y] = Some(a).filter(|a| holds(&targets[y], a));
            }
        }
        found
    }

    /// The coefficients as fractions.
    fn fractions(
        &self,
        operators: &[Vec<Expr<'g>>],
        targets: &[Vec<Expr<'g>>],
        _: &Neighbourhood<'g>,
    ) -> Option<Vec<Vec<Expr<'g>>>> {
        let k = operators.len();
        let columns = [operators, targets].concat();
        let dependent = self.graph().dependent_columns(&columns, &self.constants(&columns));
        let fraction = |target: usize| {
            let known = dependent.iter().find(|(column, _)| *column == k + target);
            known.map_or_else(|| vec![Expr::ZERO; k], |(_, a)| a[..k].iter().map(|&a| a.into()).collect())
        };
        Some((0..targets.len()).map(fraction).collect())
    }

    /// The coefficients, computed from as many of the equations Σ a_s X_s = Y, taken at simple points, as there
    /// are unknowns.
    fn solved(
        &self,
        operators: &[Vec<Expr<'g>>],
        targets: &[Vec<Expr<'g>>],
        _: &Neighbourhood<'g>,
    ) -> Option<Vec<Vec<Expr<'g>>>> {
        let (k, n) = (operators.len(), self.coordinates().len());
        let page = self.graph().page(self.graph().folding());
        let columns = [operators, targets].concat();
        let entries: Vec<Expr<'g>> =
            (0..n).flat_map(|i| columns.iter().map(move |column| column[i])).collect();
        let mut equations: Vec<Vec<Expr<'_>>> = Vec::new();
        for point in 0..POINTS * (k + n) {
            let values = self.at_simple_point(&entries, point, &page);
            for equation in values.chunks(columns.len()) {
                let known: Vec<Vec<Expr<'_>>> = equations.iter().map(|row| row[..k].to_vec()).collect();
                let regular = equation.iter().all(|x| !x.is_undefined());
                let more = [known, vec![equation[..k].to_vec()]].concat();
                if regular && page.generic_rank(&more) == more.len() {
                    equations.push(equation.to_vec());
                }
                if equations.len() == k {
                    return self.solution(&equations, k, targets.len(), &page);
                }
            }
        }
        None
    }

    /// The solutions a of the k equations Σ a_s X_s = Y, one solution for each of the right-hand sides.
    fn solution<'h>(
        &self,
        equations: &[Vec<Expr<'h>>],
        k: usize,
        targets: usize,
        page: &'h Graph,
    ) -> Option<Vec<Vec<Expr<'g>>>> {
        let inverse = inverse(page, &Matrix::from_fn(k, k, |row, s| equations[row][s]))?;
        let solve = |target: usize| -> Option<Vec<Expr<'g>>> {
            let right = |row: &Vec<Expr<'h>>| row[k + target];
            let a: Vec<Expr<'h>> = (0..k)
                .map(|s| page.dot(inverse.row(s).iter().copied(), equations.iter().map(right)))
                .collect();
            let a = page.shorten(&a, &[]);
            let moves = |symbol: &Expr<'h>| symbol.to_string().contains('@');
            let still = !page.symbols_of(&a).iter().any(moves);
            still.then(|| page.transcribe(&a, self.graph()))
        };
        (0..targets).map(solve).collect()
    }

    /// The expressions with small numbers substituted for coordinates that are not arguments of functions, and
    /// new symbols for the other coordinates; these symbols cancel from results that do not depend on them.
    fn at_simple_point<'h>(&self, entries: &[Expr<'g>], point: usize, page: &'h Graph) -> Vec<Expr<'h>> {
        let graph = self.graph();
        let value =
            |(i, symbol): (usize, &Expr<'g>)| match self.coordinates().iter().position(|x| x == symbol) {
                None => (*symbol, page.symbol(&symbol.to_string())),
                Some(place) if entries.iter().any(|&entry| graph.applies(entry, &[*symbol], |_| true)) => {
                    (*symbol, page.symbol(&format!("{}@{point}", self.coordinates()[place])))
                }
                Some(place) => (*symbol, Expr::from(simple(place, i, point, self.coordinates().len()))),
            };
        let values: Vec<(Expr<'g>, Expr<'h>)> =
            graph.symbols_of(entries).iter().enumerate().map(value).collect();
        graph.evaluate(entries, &values).unwrap_or_default() // every symbol has a value
    }

    /// The coefficients as numbers, at the values that parameters and time have in the neighbourhood.
    fn fitted(
        &self,
        operators: &[Vec<Expr<'g>>],
        targets: &[Vec<Expr<'g>>],
        near: &Neighbourhood<'g>,
    ) -> Option<Vec<Vec<Expr<'g>>>> {
        let k = operators.len();
        let (stacked, sizes) = normalised(self.stacked(&[operators, targets].concat(), near));
        let svd = stacked.columns(0, k).clone_owned().svd(true, true);
        (0..targets.len())
            .map(|target| {
                let right: DVector<f64> = stacked.column(k + target).clone_owned();
                let solution = svd.solve(&right, 0.0).ok()?;
                // The columns have length 1 now, so where a coefficient is 0 its share is small compared with 1, in any
                // units.
                let coefficient = |(&share, size): (&f64, &f64)| match share.abs() < ROUNDED {
                    true => Expr::ZERO,
                    false => nearest_fraction(share * sizes[k + target] / size).into(),
                };
                Some(solution.iter().zip(&sizes).map(coefficient).collect())
            })
            .collect()
    }

    /// A combination of the operators that vanishes up to rounding errors, if there is one.
    fn vanishing_in_numbers(
        &self,
        operators: &[Vec<Expr<'g>>],
        near: &Neighbourhood<'g>,
    ) -> Option<Vec<(usize, String)>> {
        let (stacked, sizes) = normalised(self.stacked(operators, near));
        if stacked.nrows() < operators.len() {
            return Some(Vec::new()); // no values to decide by
        }
        let svd = stacked.svd(false, true);
        let (least, &smallest) = (0..).zip(svd.singular_values.iter()).min_by(|a, b| a.1.total_cmp(b.1))?;
        let largest = svd.singular_values.max();
        let vector = svd.v_t?.row(least).into_owned();
        let scaled: Vec<f64> = vector.iter().zip(&sizes).map(|(v, size)| v / size).collect();
        let present: Vec<usize> = (0..scaled.len()).filter(|&s| vector[s].abs() > DEPENDENT).collect();
        let last = scaled[*present.last()?];
        let unit = if present.len() == 1 { last } else { -last };
        let term = |s: usize| (s + 1, nearest_fraction(scaled[s] / unit).to_string());
        (smallest <= DEPENDENT * largest).then(|| present.into_iter().map(term).collect())
    }

    /// The columns at several points near the centre, one below the other, with each coordinate in units in which its
    /// largest entry is 1; parameters and time have their values at the centre.
    fn stacked(&self, columns: &[Vec<Expr<'g>>], near: &Neighbourhood<'g>) -> DMatrix<f64> {
        let (graph, n) = (self.graph(), self.coordinates().len());
        let centre =
            |symbol: &Expr<'g>| near.centre.iter().find(|(known, _)| known == symbol).map_or(1.0, |c| c.1);
        let values: Vec<(Expr<'g>, Expr<'g>)> =
            self.constants(columns).iter().map(|symbol| (*symbol, centre(symbol).into())).collect();
        let entries = graph.substitute(&columns.concat(), &values);
        let samples = near.samples(graph, &entries, 4 * (columns.len() + 1));
        let entry = |row: usize, s: usize| samples[row / n][s * n + row % n];
        let unit = |i: usize| {
            let of_coordinate =
                (0..samples.len()).flat_map(|sample| (0..columns.len()).map(move |s| (sample, s)));
            of_coordinate.fold(0.0f64, |most, (sample, s)| most.max(entry(sample * n + i, s).abs()))
        };
        let units: Vec<f64> = (0..n).map(unit).map(|most| if most > 0.0 { most } else { 1.0 }).collect();
        DMatrix::from_fn(samples.len() * n, columns.len(), |row, s| entry(row, s) / units[row % n])
    }
}

/// The vanishing combination Σ a_s X_s − X_last as pairs (s, coefficient), s counted from 1.
fn vanishing(a: &[Expr<'_>], last: usize) -> Vec<(usize, String)> {
    let known = (1..).zip(a).filter(|(_, a)| !a.is_zero()).map(|(s, a)| (s, a.to_string()));
    let mut terms: Vec<(usize, String)> = known.collect();
    terms.push((last + 1, if terms.is_empty() { "1" } else { "-1" }.to_owned()));
    terms
}

/// The value of a coordinate at a point: at the first points each coordinate in turn is 1 and the others are 0;
/// at later points all are small pseudo-random numbers.
fn simple(place: usize, salt: usize, point: usize, coordinates: usize) -> Number {
    if point < coordinates {
        return Number::integer(i32::from(point == place));
    }
    let mixed = (point * 31 + salt * 17 + place * 7 + 3) * 2_654_435_761 % 4_294_967_291;
    Number::integer((mixed >> 7) as i32 % 7 + 1)
}

/// The columns divided by their lengths, and the lengths; a column of zeros has length 1.
fn normalised(mut columns: DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    let length = |length: f64| if length > 0.0 { length } else { 1.0 };
    let lengths: Vec<f64> = columns.column_iter().map(|column| length(column.norm())).collect();
    columns.column_iter_mut().zip(&lengths).for_each(|(mut column, &length)| column /= length);
    (columns, lengths)
}

/// A fraction with a denominator up to 1000 that equals `value` to eleven digits, or else the value itself.
fn nearest_fraction(value: f64) -> Number {
    let near = |den: i64| {
        let num = (value * den as f64).round();
        ((num / den as f64 - value).abs() < ROUNDED * value.abs()).then(|| Number::ratio(num as i64, den))
    };
    (1..=1000).find_map(near).unwrap_or_else(|| Number::from(value))
}
