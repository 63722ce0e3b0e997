//! States where velocities and the quasi-velocities defined by them no longer determine each other.

use pc_algebra::Matrix;
use pc_expr::{Backend, Evaluator, Expr, Graph, Inputs, Program};
use serde::{Deserialize, Serialize};

use crate::error::MechError;
use crate::numeric::singular_values::SingularValues;
use crate::system::system::System;

/// A velocity this small relative to the others is treated as rounding error: the motion is the same without
/// it.
const AT_REST: f64 = 1e-9;

/// The distance from either end of a step, as a fraction of its length, at which the slope of a determinant
/// without derivatives is estimated.
const SLOPE: f64 = 1e-4;

/// A determinant that falls to this fraction of its values at both ends of a step is taken to vanish between
/// the ends: otherwise a step that resolves the motion contains no such dip.
const VANISHES: f64 = 1e-6;

/// The number of halvings or golden-section steps within a step: they end at about 1e-9 of its length.
const SECTIONS: usize = 45;

/// The matrix a of η = a ẋ + a_0 along a motion.
///  Where det a = 0 the state (x, η) leaves ẋ undetermined along ker a: motions with different ẋ share that
/// state, and rounding errors decide how they continue. Where det a is infinite, η is undetermined in the
/// same way. Between the ends of a step, states are taken on the straight line between them, which crosses
/// each surface that separates them.
///
/// Only ratios of determinants count, so that constant factors are left out; of a disk that rolls cos θ remains. Quasi-velocities
/// defined by b are not watched: the determinant of b would cost as much as a step of a small system.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Chart {
    coordinates: usize,
    parameters: usize,
    entries: Evaluator,
    short: Option<Short>,
    /// The number of rows of the matrix, and whether its columns belong to ẋ.
    size: usize,
    of_velocities: bool,
    room: Vec<f64>,
    /// A state between the ends of a step, and the determinant there.
    between: End,
    /// The start of the step, and its end: the start of the next one.
    start: End,
    end: End,
}

/// A determinant that is a short expression, without constant factors.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Short {
    /// The determinant, then its derivatives.
    program: Evaluator,
    /// The coordinates on which it depends; `None` is time.
    arguments: Vec<Option<usize>>,
}

/// The determinant at one end of a step.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct End {
    t: f64,
    x: Vec<f64>,
    parameters: Vec<f64>,
    /// The determinant, then its derivatives if it is short.
    values: Vec<f64>,
}

impl End {
    fn is_at(&self, t: f64, x: &[f64], parameters: &[f64]) -> bool {
        self.t == t && self.x == x && self.parameters == parameters
    }
}

/// How a determinant behaves between the ends of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Passage {
    /// The determinant vanishes, with or without a change of sign.
    Zero,
    /// The determinant becomes infinite, with or without a change of sign.
    Pole,
}

impl Chart {
    /// The chart of a system; `None` if its quasi-velocities are not defined by velocities, or det a is constant.
    ///
    /// # Errors
    /// [`MechError`] for a symbol without a value.
    pub(crate) fn of(system: &System<'_>) -> Result<Option<Chart>, MechError> {
        match system.frame().definition_matrix() {
            Some(a) => Chart::new(system, a, true),
            None => Ok(None),
        }
    }

    /// The chart of a system all of whose quasi-velocities, in order, are transformed by the matrix A: it
    /// watches det A a if the quasi-velocities are defined in terms of ẋ, and det A otherwise.
    ///
    /// # Errors
    /// [`MechError`] for a symbol without a value.
    pub(crate) fn of_change<'g>(
        system: &System<'g>,
        change: &Matrix<Expr<'g>>,
    ) -> Result<Option<Chart>, MechError> {
        let (graph, frame) = (system.graph(), system.frame());
        let Some(a) = frame.definition_matrix() else {
            let of_velocities = frame.velocities(system.quasi_velocities()) == system.quasi_velocities();
            return Chart::new(system, change, of_velocities);
        };
        let product = Matrix::from_fn(change.rows(), a.columns(), |u, i| {
            graph.dot(change.row(u).iter().copied(), a.column(i))
        });
        Chart::new(system, &product, true)
    }

    /// The chart that watches a square matrix through which some quasi-velocities determine others; `None` if
    /// its determinant is constant.
    pub(crate) fn watching<'g>(
        system: &System<'g>,
        a: &Matrix<Expr<'g>>,
    ) -> Result<Option<Chart>, MechError> {
        Chart::new(system, a, false)
    }

    fn new<'g>(
        system: &System<'g>,
        a: &Matrix<Expr<'g>>,
        of_velocities: bool,
    ) -> Result<Option<Chart>, MechError> {
        let frame = system.frame();
        let moving = || frame.coordinates().iter().copied().chain([frame.time()]);
        let short = short_determinant(system.graph(), a);
        let written = short.map_or_else(|| a.nonzero_entries(), |determinant| vec![determinant]);
        if !moving().any(|symbol| written.iter().any(|entry| entry.depends_on(symbol))) {
            return Ok(None);
        }
        let inputs = Inputs {
            time: Some(frame.time()),
            state: frame.coordinates().to_vec(),
            parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
        };
        let evaluator = |outputs: &[Expr<'g>], backend| -> Result<Evaluator, MechError> {
            Ok(Evaluator::new(Program::new(system.graph(), &inputs, outputs)?, backend))
        };
        let entries = evaluator(&a.entries(), Backend::Interpreter)?;
        let (coordinates, parameters) = (inputs.state.len(), inputs.parameters.len());
        let short = short.map(|determinant| {
            let time = [(None, frame.time())].into_iter();
            let symbols = time.chain((0..coordinates).map(|i| (Some(i), inputs.state[i])));
            let (arguments, symbols): (Vec<_>, Vec<_>) =
                symbols.filter(|&(_, symbol)| determinant.depends_on(symbol)).unzip();
            let slopes = system.graph().gradient(determinant, &symbols);
            let outputs = [&[determinant], &slopes[..]].concat();
            Ok::<_, MechError>(Short { program: evaluator(&outputs, Backend::Fastest)?, arguments })
        });
        let short = short.transpose()?;
        let size = a.rows();
        let room = vec![0.0; size * size];
        let end = End {
            t: f64::NAN,
            x: vec![f64::NAN; coordinates],
            parameters: vec![f64::NAN; parameters],
            values: vec![f64::NAN; short.as_ref().map_or(1, |short| 1 + short.arguments.len())],
        };
        let (start, between) = (end.clone(), end.clone());
        Ok(Some(Chart {
            coordinates,
            parameters,
            entries,
            short,
            size,
            of_velocities,
            room,
            between,
            start,
            end,
        }))
    }

    /// Compiles what each step evaluates, so that clones share it.
    pub(crate) fn prepare(&mut self) {
        if let Some(short) = &mut self.short {
            short.program.prepare();
        }
    }

    /// The matrix at (t, x), row by row.
    fn matrix(&mut self, t: f64, x: &[f64], parameters: &[f64]) -> &mut [f64] {
        self.entries.eval(t, &x[..self.coordinates], &parameters[..self.parameters], &mut self.room);
        &mut self.room
    }

    /// Writes the determinant, then its derivatives if it is short.
    fn write(&mut self, t: f64, x: &[f64], parameters: &[f64], values: &mut [f64]) {
        if let Some(short) = &mut self.short {
            return short.program.eval(t, &x[..self.coordinates], &parameters[..self.parameters], values);
        }
        let n = self.size;
        values[0] = determinant(self.matrix(t, x, parameters), n);
    }

    /// Measures the determinant at the end of the step.
    fn measure(&mut self, (t, y): (f64, &[f64]), parameters: &[f64]) {
        let mut end = std::mem::take(&mut self.end);
        end.t = t;
        end.x.copy_from_slice(&y[..self.coordinates]);
        end.parameters.copy_from_slice(&parameters[..self.parameters]);
        self.write(t, y, parameters, &mut end.values);
        self.end = end;
    }

    /// The determinant on the line from one end of a step to the other, at the fraction `s` of the way.
    fn along(&mut self, s: f64, from: (f64, &[f64]), to: (f64, &[f64]), parameters: &[f64]) -> f64 {
        let mut between = std::mem::take(&mut self.between);
        for (x, (a, b)) in between.x.iter_mut().zip(from.1.iter().zip(to.1)) {
            *x = a + s * (b - a);
        }
        self.write(from.0 + s * (to.0 - from.0), &between.x, parameters, &mut between.values);
        let value = between.values[0];
        self.between = between;
        value
    }

    /// The slopes of the determinant at both ends of a step on this line, or numbers of the same signs.
    fn slopes(&mut self, from: (f64, &[f64]), to: (f64, &[f64]), parameters: &[f64]) -> [f64; 2] {
        let Some(Short { arguments, .. }) = &self.short else {
            let start = self.along(SLOPE, from, to, parameters) - self.start.values[0];
            return [start, self.end.values[0] - self.along(1.0 - SLOPE, from, to, parameters)];
        };
        let way = |argument: &Option<usize>| argument.map_or(to.0 - from.0, |i| to.1[i] - from.1[i]);
        [&self.start, &self.end]
            .map(|end| arguments.iter().zip(&end.values[1..]).map(|(at, slope)| slope * way(at)).sum())
    }

    /// The zero or pole of the determinant between the ends of a step, if there is one.
    pub(crate) fn passage(
        &mut self,
        from: (f64, &[f64]),
        to: (f64, &[f64]),
        parameters: &[f64],
    ) -> Option<Passage> {
        // A step starts where the last one has ended unless the state has jumped.
        if !self.end.is_at(from.0, &from.1[..self.coordinates], &parameters[..self.parameters]) {
            self.measure(from, parameters);
        }
        std::mem::swap(&mut self.start, &mut self.end);
        self.measure(to, parameters);
        let (start, end) = (self.start.values[0], self.end.values[0]);
        let (least, most) = (start.abs().min(end.abs()), start.abs().max(end.abs()));
        if start * end < 0.0 {
            let mut along = |s: f64| self.along(s, from, to, parameters);
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..SECTIONS {
                let middle = 0.5 * (low + high);
                if along(middle) * start > 0.0 { low = middle } else { high = middle }
            }
            let there = along(low).abs().max(along(high).abs());
            return Some(if there < most { Passage::Zero } else { Passage::Pole });
        }
        // With the same sign at both ends, the question is whether it approaches zero, or infinity, and
        // returns.
        let [leaves, returns] = self.slopes(from, to, parameters).map(|slope| slope * (start + end).signum());
        let comes_back = leaves * returns < 0.0;
        if !comes_back {
            return None;
        }
        let mut along = |s: f64| self.along(s, from, to, parameters).abs();
        if leaves < 0.0 {
            let there = smallest(along);
            (there <= VANISHES * least).then_some(Passage::Zero)
        } else {
            let there = smallest(|s| along(s).recip());
            (there * most <= VANISHES).then_some(Passage::Pole)
        }
    }

    /// Whether a motion with these velocities, past such a zero or pole, is at rest in the undetermined
    /// direction: it then continues uniquely. False if the columns of the matrix do not belong to ẋ.
    pub(crate) fn rests(
        &mut self,
        passage: Passage,
        (t, y): (f64, &[f64]),
        velocities: &[f64],
        parameters: &[f64],
    ) -> bool {
        let n = self.size;
        if !self.of_velocities {
            return false;
        }
        let entries = self.matrix(t, y, parameters);
        let a = Matrix::from_fn(n, n, |i, j| entries[i * n + j]);
        let Ok(SingularValues { values, right, .. }) = SingularValues::of(&a) else {
            return false;
        };
        let part =
            |k: usize| velocities.iter().enumerate().map(|(i, v)| right[(i, k)] * v).sum::<f64>().abs();
        match passage {
            Passage::Zero => {
                part(n - 1) <= AT_REST * velocities.iter().fold(0.0f64, |largest, v| largest.max(v.abs()))
            }
            Passage::Pole => {
                values[0] * part(0) <= AT_REST * (0..n).map(|k| values[k] * part(k)).fold(0.0, f64::max)
            }
        }
    }
}

/// The determinant of a square matrix without constant factors; `None` if it is a long expression. Rows and columns with a single
/// entry are expanded along it.
fn short_determinant<'g>(graph: &'g Graph, a: &Matrix<Expr<'g>>) -> Option<Expr<'g>> {
    let (mut rows, mut columns): (Vec<usize>, Vec<usize>) =
        ((0..a.rows()).collect(), (0..a.rows()).collect());
    let mut factors = Vec::new();
    while let Some((i, j)) = lone_entry(a, &rows, &columns) {
        factors.push(a[(i, j)]);
        rows.retain(|&row| row != i);
        columns.retain(|&column| column != j);
    }
    factors.push(pc_algebra::determinant(
        graph,
        &Matrix::from_fn(rows.len(), rows.len(), |i, j| a[(rows[i], columns[j])]),
    )?);
    let varying = factors.into_iter().filter(|factor| factor.constant().is_none());
    let product = varying.fold(Expr::ONE, |product, factor| product * factor);
    Some(graph.merged_angles(&[product])[0])
}

/// The place of an entry that is the only one of its row or column.
fn lone_entry(a: &Matrix<Expr<'_>>, rows: &[usize], columns: &[usize]) -> Option<(usize, usize)> {
    let is_entry = |i: usize, j: usize| !a[(i, j)].is_zero();
    let only = |mut places: Vec<(usize, usize)>| if places.len() == 1 { places.pop() } else { None };
    let of_row = |&i: &usize| only(columns.iter().filter(|&&j| is_entry(i, j)).map(|&j| (i, j)).collect());
    let of_column = |&j: &usize| only(rows.iter().filter(|&&i| is_entry(i, j)).map(|&i| (i, j)).collect());
    rows.iter().find_map(of_row).or_else(|| columns.iter().find_map(of_column))
}

/// The minimum of a function that falls and then rises between 0 and 1, by golden sections.
fn smallest(mut f: impl FnMut(f64) -> f64) -> f64 {
    let part = 0.5 * (5.0f64.sqrt() - 1.0);
    let (mut low, mut high) = (0.0, 1.0);
    let (mut left, mut right) = (1.0 - part, part);
    let (mut at_left, mut at_right) = (f(left), f(right));
    for _ in 0..SECTIONS {
        if at_left < at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - part * (high - low);
            at_left = f(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + part * (high - low);
            at_right = f(right);
        }
    }
    at_left.min(at_right)
}

/// The determinant of A, n × n and stored row by row, by elimination with row pivoting.
pub(crate) fn determinant(a: &mut [f64], n: usize) -> f64 {
    let at = |i: usize, j: usize| i * n + j;
    let mut product = 1.0;
    for k in 0..n {
        let Some(best) = (k..n).max_by(|&i, &j| a[at(i, k)].abs().total_cmp(&a[at(j, k)].abs())) else {
            break;
        };
        let pivot = a[at(best, k)];
        product *= if best == k { pivot } else { -pivot };
        if pivot == 0.0 {
            return 0.0;
        }
        for j in k..n {
            a.swap(at(k, j), at(best, j));
        }
        for i in k + 1..n {
            let factor = a[at(i, k)] / pivot;
            for j in k..n {
                a[at(i, j)] -= factor * a[at(k, j)];
            }
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn determinants_are_those_of_the_permuted_rows() {
        let of = |rows: [[f64; 3]; 3]| determinant(&mut rows.concat(), 3);
        assert_eq!(of([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), 1.0);
        assert_eq!(of([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0]]), -2.0);
        // 1 (4·1 − 1·2) − 2 (3·1 − 1·1) + 0 = −2, by three roundings of numbers below 4
        assert!((of([[1.0, 2.0, 0.0], [3.0, 4.0, 1.0], [1.0, 2.0, 1.0]]) + 2.0).abs() < 1e-14);
        assert_eq!(of([[1.0, 2.0, 0.0], [2.0, 4.0, 0.0], [1.0, 2.0, 1.0]]), 0.0);
    }

    #[test]
    fn the_determinant_of_definitions_by_angles_is_short() {
        // A disk on its contact: ω1 = θ', ω2 = φ' cos θ, ω3 = φ' sin θ + ψ', and 2 ẋ = 0.
        let graph = Graph::new();
        let theta = graph.symbol("θ");
        let (zero, one) = (Expr::ZERO, Expr::ONE);
        let rows = [
            [one, zero, zero, zero],
            [zero, theta.cos(), zero, zero],
            [zero, theta.sin(), one, zero],
            [zero, zero, zero, Expr::from(2.0)],
        ];
        let a = Matrix::from_fn(4, 4, |i, j| rows[i][j]);
        assert_eq!(short_determinant(&graph, &a), Some(theta.cos()));
        // Axes that turn have a constant one.
        let turned = [[theta.cos(), theta.sin()], [-theta.sin(), theta.cos()]];
        let turned = short_determinant(&graph, &Matrix::from_fn(2, 2, |i, j| turned[i][j]));
        assert!(turned.is_some_and(|determinant| !determinant.depends_on(theta)));
    }

    #[test]
    fn the_least_value_is_found_wherever_it_is() {
        // Golden sections leave 0.618⁴⁵ = 4e-10 of the interval: squares are below its square.
        for place in [1e-3, 0.2, 0.5, 0.999] {
            assert!(smallest(|s| (s - place).powi(2)) < 1e-18, "{place}");
            assert!((smallest(|s| (s - place).powi(2) + 0.5) - 0.5).abs() < 1e-15, "{place}");
        }
    }
}
