//! The Jacobian of a large tree, and its mass matrix: their products with unit vectors, eight at a time.
//!
//! With the whole mass matrix, the entry ∂η̇_r/∂y_j of each pair is a long expression. The product (∂ẏ/∂y) v is
//! short: forward sweeps of the velocities, accelerations and forces that v changes at fixed η̇, and one solution
//! with the articulated inertias of ẏ itself,
//!
//!   M δη̇ = δτ − δ(M η̇ + h)|_η̇
//!
//! (Carpentier & Mansard 2018). It is linear in v. What does not depend on v, such as the motion of the links and
//! their inertias, is computed once for all columns; the rest runs for eight directions at once, each the sum of the
//! unit vectors of columns that share no row.

use std::sync::{Arc, OnceLock};

use pc_expr::{
    Backend, Evaluator, Expr, ExprError, Graph, Inputs, LANES, LaneKernel, LaneTape, Lanes, Pattern, Program,
};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::columns::Storage;
use crate::compiled::failure::EvaluationFailure;
use crate::compiled::point::Point;

/// The columns of ∂ẏ/∂y, or of another matrix, as products.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Products {
    pattern: Pattern,
    /// The columns of each direction.
    directions: Vec<Vec<usize>>,
    parts: Parts,
    #[serde(skip)]
    kernels: Arc<OnceLock<Kernels>>,
    #[serde(skip)]
    frames: [Vec<Lanes>; 2],
}

/// The program of a product, in three parts.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Parts {
    /// From (t, y, p), the accelerations w.
    unknowns: Arc<Program>,
    /// From (t, y, p, w), the values that the last part reads besides these.
    known: Option<Arc<Program>>,
    /// From v and (t, y, p, w) with those values, (∂ẏ/∂y) v.
    product: Arc<Program>,
}

/// The parts for eight lanes, compiled on first use.
#[derive(Debug)]
struct Kernels {
    /// From (t, y, p), w and the values of the second part.
    known: LaneKernel,
    product: LaneKernel,
}

impl Products {
    /// The matrix with the products `values`, which are linear functions of `v`, and functions of the `inputs` and of
    /// the symbols of accelerations, given with their values.
    ///
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        graph: &'g Graph,
        inputs: &Inputs<'g>,
        (symbols, unknowns): (&[Expr<'g>], &[Expr<'g>]),
        (v, values): (&[Expr<'g>], &[Expr<'g>]),
    ) -> Result<Products, ExprError> {
        let known = inputs.time.iter().chain(&inputs.state).chain(&inputs.parameters).chain(symbols);
        let known = Inputs { time: None, state: v.to_vec(), parameters: known.copied().collect() };
        let program = Program::new(graph, &known, values)?;
        let (known, product) = match program.hoisted(&vec![true; program.parameters_len()]) {
            Some((known, product)) => (Some(Arc::new(known)), product),
            None => (None, program),
        };
        let unknowns = Arc::new(Program::new(graph, inputs, unknowns)?);
        let pattern = dependence(&product);
        let directions = directions(&pattern);
        let parts = Parts { unknowns, known, product: Arc::new(product) };
        Ok(Products { pattern, directions, parts, kernels: Arc::default(), frames: [Vec::new(), Vec::new()] })
    }

    pub(crate) fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Compiles the products, which are otherwise compiled on first use.
    pub(crate) fn prepare(&mut self) {
        let kernels = self.kernels.get_or_init(|| self.parts.kernels());
        if self.frames[1].is_empty() {
            self.frames = [kernels.known.frame(), kernels.product.frame()];
        }
    }

    /// Evaluates the Jacobian and writes its entries.
    ///
    /// # Errors
    /// [`EvaluationFailure::Expr`] for the first intermediate value that is not finite.
    pub(crate) fn eval(
        &mut self,
        at: Point<'_>,
        entries: &mut [f64],
        storage: Storage,
    ) -> Result<(), EvaluationFailure> {
        self.approach(at);
        let Some(kernels) = self.kernels.get() else { return Err(self.parts.blame(at)) };
        let (width, height) = (self.parts.product.state_len(), self.parts.product.outputs_len());
        let frame = &mut self.frames[1];
        let is_dense = storage == Storage::Dense;
        if is_dense {
            entries.fill(0.0);
        }
        let mut is_finite = true;
        for directions in self.directions.chunks(LANES) {
            frame[..width].fill(Lanes::splat(0.0));
            for (lane, columns) in directions.iter().enumerate() {
                columns.iter().for_each(|&column| frame[column].0[lane] = 1.0);
            }
            kernels.product.run(frame);
            let products = &frame[kernels.product.first_output()..][..height];
            for (lane, columns) in directions.iter().enumerate() {
                for &column in columns {
                    let rows = self.pattern.column(column);
                    let start = if is_dense { column * height } else { self.pattern.column_starts()[column] };
                    for (place, &row) in rows.iter().enumerate() {
                        let value = products[row].0[lane];
                        is_finite &= value.is_finite();
                        entries[start + if is_dense { row } else { place }] = value;
                    }
                }
            }
        }
        if is_finite { Ok(()) } else { Err(self.parts.blame(at)) }
    }

    /// Evaluates (∂ẏ/∂y) v.
    ///
    /// # Errors
    /// As for [`eval`](Products::eval).
    pub(crate) fn along(
        &mut self,
        at: Point<'_>,
        v: &[f64],
        product: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        self.approach(at);
        let Some(kernels) = self.kernels.get() else { return Err(self.parts.blame(at)) };
        let frame = &mut self.frames[1];
        frame.iter_mut().zip(v).for_each(|(row, &component)| *row = Lanes::splat(component));
        kernels.product.run(frame);
        let products = &frame[kernels.product.first_output()..];
        product.iter_mut().zip(products).for_each(|(value, row)| *value = row.0[0]);
        match product.iter().all(|value| value.is_finite()) {
            true => Ok(()),
            false => Err(self.parts.blame(at)),
        }
    }

    /// Computes what all products at a point share.
    fn approach(&mut self, at: Point<'_>) {
        self.prepare();
        let Some(kernels) = self.kernels.get() else { return };
        let [known, frame] = &mut self.frames;
        let (width, given) = (self.parts.product.state_len(), 1 + at.y.len() + at.p.len());
        let time = [at.t];
        let values = [&time, at.y, at.p].into_iter().flatten();
        known.iter_mut().zip(values).for_each(|(row, &value)| *row = Lanes::splat(value));
        kernels.known.run(known);
        let (of_point, of_known) =
            frame[width..width + self.parts.product.parameters_len()].split_at_mut(given);
        of_point.copy_from_slice(&known[..given]);
        of_known.copy_from_slice(&known[kernels.known.first_output()..][..of_known.len()]);
    }
}

impl Parts {
    fn kernels(&self) -> Kernels {
        let Parts { unknowns, known, product } = self;
        let mut tape = LaneTape::new();
        let t = tape.input();
        let (y, p) = (tape.inputs(unknowns.state_len()), tape.inputs(unknowns.parameters_len()));
        let accelerations = tape.inline(unknowns, t, &y, &p);
        let mut outputs = accelerations.clone();
        if let Some(known) = known {
            let parameters = [&[t], &y[..], &p, &accelerations].concat();
            outputs.extend(tape.inline(known, t, &[], &parameters));
        }
        for value in outputs {
            tape.output(value);
        }
        let known = LaneKernel::new(tape);
        let mut tape = LaneTape::new();
        let (v, parameters) = (tape.inputs(product.state_len()), tape.inputs(product.parameters_len()));
        let t = tape.constant(0.0); // it is among the parameters
        for value in tape.inline(product, t, &v, &parameters) {
            tape.output(value);
        }
        Kernels { known, product: LaneKernel::new(tape) }
    }

    /// The failure that names the first intermediate value that is not finite.
    #[cold]
    fn blame(&self, Point { t, y, p }: Point<'_>) -> EvaluationFailure {
        let interpreted = |program: &Program| Evaluator::new(program.clone(), Backend::Interpreter);
        let mut unknowns = interpreted(&self.unknowns);
        if let Some(error) = unknowns.diagnose(t, y, p) {
            return EvaluationFailure::Expr(error);
        }
        let mut values = vec![f64::NAN; self.unknowns.outputs_len()];
        unknowns.eval(t, y, p, &mut values);
        let mut parameters = [&[t], y, p, &values].concat();
        if let Some(known) = &self.known {
            let mut known = interpreted(known);
            if let Some(error) = known.diagnose(0.0, &[], &parameters) {
                return EvaluationFailure::Expr(error);
            }
            let mut computed = vec![f64::NAN; known.program().outputs_len()];
            known.eval(0.0, &[], &parameters, &mut computed);
            parameters.extend(computed);
        }
        let product = interpreted(&self.product);
        let mut v = vec![0.0; self.product.state_len()];
        for column in 0..v.len() {
            v[column] = 1.0;
            if let Some(error) = product.diagnose(0.0, &v, &parameters) {
                return EvaluationFailure::Expr(error);
            }
            v[column] = 0.0;
        }
        EvaluationFailure::Expr(product.blame(0.0, &v, &parameters))
    }
}

/// The columns of the sums of unit vectors that find the whole matrix.
fn directions(pattern: &Pattern) -> Vec<Vec<usize>> {
    let used: Vec<usize> = (0..pattern.columns()).filter(|&j| !pattern.column(j).is_empty()).collect();
    let mut entries = vec![0; pattern.rows()];
    pattern.entries().for_each(|(i, _)| entries[i] += 1);
    let longest = entries.into_iter().max().unwrap_or(0);
    // As many directions as a row has entries are needed at least.
    if SHARED * longest >= used.len() {
        return used.into_iter().map(|column| vec![column]).collect();
    }
    let colouring = pattern.colouring();
    (0..colouring.len()).map(|colour| colouring.columns(colour).collect()).collect()
}

/// Directions are shared by at least so many columns where it is worth finding out how.
const SHARED: usize = 2;

/// Which outputs of a program depend on which components of its state.
fn dependence(program: &Program) -> Pattern {
    let dim = program.state_len();
    let mut rows: Vec<Vec<usize>> = vec![Vec::new(); dim];
    // As many components at once as a word has bits.
    for first in (0..dim).step_by(64) {
        let mut read: Vec<u64> = vec![0; program.first_result()];
        let state = program.first_input() + 1;
        for component in first..dim.min(first + 64) {
            read[state + component] = 1 << (component - first);
        }
        for instruction in program.code() {
            let all = instruction.operands().fold(0, |all, operand| all | read[operand.index()]);
            read.push(all);
        }
        for (row, output) in program.outputs().iter().enumerate() {
            for component in first..dim.min(first + 64) {
                if read[output.index()] >> (component - first) & 1 == 1 {
                    rows[component].push(row);
                }
            }
        }
    }
    Pattern::from_columns(program.outputs_len(), rows)
}
