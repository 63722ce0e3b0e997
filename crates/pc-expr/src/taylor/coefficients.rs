//! Coefficients, order by order.

use std::fmt;
use std::sync::Arc;

use super::recurrences::{EXTRA, Recurrences};
use super::sums::{LANES, Rows, sums};
use crate::kernel::evaluator::{Backend, compile};
use crate::kernel::kernel::{Interpreter, Kernel};
use crate::program::program::Program;

/// The Taylor coefficients of solutions of ẏ = f(t, y), where f is given by the first outputs of a program.
///
/// ```
/// use pc_expr::{Backend, Graph, Inputs, Program, TaylorSeries};
///
/// // ẏ = y², y(0) = 1: y = 1/(1 − t) = 1 + t + t² + …
/// let graph = Graph::new();
/// let y = graph.symbol("y");
/// let inputs = Inputs { time: None, state: vec![y], parameters: vec![] };
/// let program = Program::new(&graph, &inputs, &[y * y])?;
/// let mut series = TaylorSeries::new(&program, Backend::Fastest);
/// series.expand(0.0, &[1.0], &[], &[], 20);
/// assert!((1..=20).all(|k| series.coefficients(k) == [1.0]));
/// # Ok::<(), pc_expr::ExprError>(())
/// ```
///
/// Where f contains |x|, sign, min, max or step, the series is that of one branch, given by the sign of each of
/// the [branch functions](TaylorSeries::branches). The series is that of the motion until one of these
/// functions changes sign.
pub struct TaylorSeries {
    recurrences: Arc<Recurrences>,
    zeroth: Box<dyn Kernel>,
    next: Box<dyn Kernel>,
    sum: Summation,
    /// The results of order 0, then a row for each order, starting at an offset aligned for vectors.
    memory: Vec<f64>,
    begin: usize,
    /// The length of the results of order 0, and that of a row.
    head: usize,
    stride: usize,
    order: usize,
    /// y, then the sides.
    state: Vec<f64>,
}

impl fmt::Debug for TaylorSeries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TaylorSeries")
            .field("dim", &self.recurrences.dim)
            .field("sums", &self.recurrences.sums)
            .field("branches", &self.recurrences.branches)
            .finish_non_exhaustive()
    }
}

impl Clone for TaylorSeries {
    /// An independent copy with the same code, for another thread.
    fn clone(&self) -> TaylorSeries {
        TaylorSeries::of(Arc::clone(&self.recurrences), self.zeroth.fork(), self.next.fork(), self.sum)
    }
}

impl TaylorSeries {
    /// The series of the solutions of a program whose first outputs are ẏ, one for each component of its
    /// state; the others are [watched](TaylorSeries::watched).
    ///
    /// # Panics
    /// If there are fewer outputs than components.
    pub fn new(program: &Program, backend: Backend) -> TaylorSeries {
        assert!(program.outputs_len() >= program.state_len(), "a rate for each component");
        let recurrences = Recurrences::new(program, program.state_len());
        let [zeroth, next] = [&recurrences.zeroth, &recurrences.next].map(Arc::clone);
        let kernel = |program: Arc<Program>| -> Box<dyn Kernel> {
            match backend {
                Backend::Fastest => compile(program),
                Backend::Interpreter => Box::new(Interpreter::new(program)),
            }
        };
        let sum = match backend {
            #[cfg(feature = "jit")]
            Backend::Fastest => Summation::Vectors(crate::kernel::jit::sums::fastest()),
            _ => Summation::OneByOne,
        };
        TaylorSeries::of(Arc::new(recurrences), kernel(zeroth), kernel(next), sum)
    }

    fn of(
        recurrences: Arc<Recurrences>,
        zeroth: Box<dyn Kernel>,
        next: Box<dyn Kernel>,
        sum: Summation,
    ) -> TaylorSeries {
        let Recurrences { dim, watched, factors, sums, ref branches, .. } = *recurrences;
        let input = dim + EXTRA + sums;
        let head = (watched + factors + branches.len() + input).next_multiple_of(LANES);
        let stride = (2 * sums + dim + branches.len() + input).next_multiple_of(LANES);
        let state = vec![0.0; dim + branches.len()];
        let (memory, begin, order) = (Vec::new(), 0, 0);
        TaylorSeries { recurrences, zeroth, next, sum, memory, begin, head, stride, order, state }
    }

    /// Number of components.
    pub fn dim(&self) -> usize {
        self.recurrences.dim
    }

    /// The functions that keep their sign along the series, as text.
    pub fn branches(&self) -> &[String] {
        &self.recurrences.branches
    }

    /// Computes the coefficients of orders 1 to `order` of the solution through y at time t, on the branch on which the
    /// [branch functions](TaylorSeries::branches) have the signs `sides`, each 1, −1 or 0.
    ///
    /// # Panics
    /// If the order is 0, or if a slice does not have the required length.
    pub fn expand(&mut self, t: f64, y: &[f64], sides: &[f64], parameters: &[f64], order: usize) {
        assert!(order >= 1, "an order above 0");
        if self.order < order {
            self.make_room(order);
        }
        let Layout { watched, branches, dim, width, .. } = self.layout();
        self.state[..dim].copy_from_slice(y);
        self.state[dim..].copy_from_slice(sides);
        let (stride, written) = (self.stride, 2 * width + dim + branches + dim);
        let input = written - dim..written + EXTRA + width;
        let outputs = self.recurrences.zeroth.outputs_len();
        let (head, rows) = self.memory[self.begin..].split_at_mut(self.head);
        self.zeroth.eval(t, &self.state, parameters, &mut head[..outputs]);
        let factors = &head[watched..][..self.recurrences.factors];
        for k in 1..order {
            let (known, row) = rows.split_at_mut((k - 1) * stride);
            let input = if k == 1 {
                &head[outputs - dim..][..input.len()] // order 1 has no sums
            } else {
                let last = (k - 2) * stride;
                let (factors, sums) = known.split_at_mut(last + written + EXTRA);
                self.sum.write(Rows { numbers: factors, stride, sums: width }, k, &mut sums[..width]);
                &known[last..][input.clone()]
            };
            self.next.eval(1.0 / k as f64, input, factors, &mut row[..written]);
        }
        let (known, row) = rows.split_at_mut((order - 1) * stride);
        let rates = if order == 1 {
            &head[outputs - dim..outputs]
        } else {
            &known[(order - 2) * stride..][written - dim..written]
        };
        let last = &mut row[2 * width..][..dim];
        last.iter_mut().zip(rates).for_each(|(y, rate)| *y = rate / order as f64);
    }

    /// y⁽ᵏ⁾/k! of the last [expansion](TaylorSeries::expand), k ≥ 1.
    ///
    /// # Panics
    /// If k is 0 or above the order of that expansion.
    pub fn coefficients(&self, k: usize) -> &[f64] {
        let Layout { width, dim, .. } = self.layout();
        &self.row(k)[2 * width..][..dim]
    }

    /// Writes the coefficients of orders 1 to `order`, one after the other.
    ///
    /// # Panics
    /// If `order` is above the order of the last expansion.
    pub fn copy_coefficients(&self, order: usize, coefficients: &mut [f64]) {
        assert!(order <= self.order, "an order of the expansion");
        let Layout { width, dim, .. } = self.layout();
        let rows = self.memory[self.begin + self.head..].chunks_exact(self.stride);
        for (coefficients, row) in coefficients.chunks_exact_mut(dim).zip(rows).take(order) {
            // Number by number: states are short.
            for (c, row) in coefficients.iter_mut().zip(&row[2 * width..][..dim]) {
                *c = *row;
            }
        }
    }

    /// The coefficients of the [branch functions](TaylorSeries::branches), of order k, below that of the last
    /// expansion.
    ///
    /// # Panics
    /// If k is not below the order of the last expansion.
    pub fn branch_coefficients(&self, k: usize) -> &[f64] {
        let Layout { watched, branches, dim, width } = self.layout();
        match k {
            0 => &self.memory[self.begin + watched + self.recurrences.factors..][..branches],
            _ => &self.row(k)[2 * width + dim..][..branches],
        }
    }

    /// The outputs of the program after ẏ, at the time and state of the last expansion.
    pub fn watched(&self) -> &[f64] {
        &self.memory[self.begin..][..self.recurrences.watched]
    }

    /// The coefficients (a, b, c) of a + b p + c p², roughly the time in nanoseconds of an expansion to
    /// order p by machine code.
    pub fn cost(&self) -> [f64; 3] {
        let Recurrences { ref zeroth, ref next, sums, .. } = *self.recurrences;
        let vectors = (sums / LANES) as f64;
        // Measured for tops and disks; only ratios matter.
        [150.0 + 2.0 * zeroth.code().len() as f64, 10.0 + 0.3 * next.code().len() as f64, 0.4 * vectors]
    }

    fn row(&self, k: usize) -> &[f64] {
        assert!(k >= 1 && k <= self.order, "an order of the expansion");
        &self.memory[self.begin + self.head + (k - 1) * self.stride..][..self.stride]
    }

    fn layout(&self) -> Layout {
        let Recurrences { dim, watched, sums: width, ref branches, .. } = *self.recurrences;
        Layout { watched, branches: branches.len(), dim, width }
    }

    /// Makes room for this order and fills in its constants.
    fn make_room(&mut self, order: usize) {
        let Layout { branches, dim, width, .. } = self.layout();
        let length = self.head + order * self.stride;
        self.memory = vec![0.0; length + LANES];
        // Vectors within one cache line each are read twice as fast.
        self.begin = self.memory.as_ptr().align_offset(size_of::<f64>() * LANES).min(LANES);
        self.order = order;
        let numbers = &mut self.memory[self.begin..];
        let first = self.recurrences.zeroth.outputs_len();
        numbers[first..first + EXTRA].copy_from_slice(&[1.0, 1.0, 0.0]); // order 1: k, t, error of 1/k
        let place = 2 * width + dim + branches + dim;
        for k in 1..order {
            let row = &mut numbers[self.head + (k - 1) * self.stride..];
            let next = (k + 1) as f64;
            row[place..place + EXTRA].copy_from_slice(&[next, 0.0, (-next).mul_add(1.0 / next, 1.0) / next]);
        }
    }
}

/// How the sums of products are computed.
#[derive(Clone, Copy)]
enum Summation {
    /// As in the interpreter.
    OneByOne,
    /// As in compiled code.
    #[cfg(feature = "jit")]
    Vectors(crate::kernel::jit::sums::Sums),
}

impl Summation {
    #[inline]
    fn write(self, rows: Rows<'_>, k: usize, out: &mut [f64]) {
        match self {
            Summation::OneByOne => sums(rows, k, out),
            #[cfg(feature = "jit")]
            Summation::Vectors(by_vectors) => by_vectors.write(rows, k, out),
        }
    }
}

/// The number of values of each kind.
struct Layout {
    watched: usize,
    branches: usize,
    dim: usize,
    /// Number of sums.
    width: usize,
}
