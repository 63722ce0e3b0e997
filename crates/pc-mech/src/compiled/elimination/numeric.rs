//! First-order systems whose M is factorised numerically: programs for the equations of w, and programs that
//! use its solution.

use pc_algebra::Matrix;
use pc_expr::{Backend, Cost, Evaluator, Expr, ExprError, Pattern, Program, SteepFunctions, TimeDependence};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::columns::{SparseColumn, Storage, derivative, nonzeros, sparse};
use crate::compiled::elimination::observed::By;
use crate::compiled::elimination::schur::Schur;
use crate::compiled::elimination::solver::Solver;
use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::first_order::FirstOrder;
use crate::compiled::implicit::Newton;
use crate::compiled::options::CompileOptions;
use crate::compiled::point::Point;

/// The compiled ẏ = g(t, y, w) and its derivatives, with w from M w = r or p(t, y, w) = r.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Staged {
    dim: usize,
    /// The number of multipliers, which are the last unknowns.
    multipliers: usize,
    unknowns: Unknowns,
    solver: Solver,
    /// An alternative way to find w alone, for a tree with loops; it reports when it is inaccurate.
    schur: Option<Box<Schur>>,
    /// y, then w.
    known: Vec<f64>,
    /// ẏ from (t, (y, w)).
    rates: Evaluator,
    cost: Cost,
    jacobian: Option<Stage>,
    jvp: Option<Product>,
    parameter_jacobian: Option<Stage>,
    time_derivative: Option<Stage>,
    /// The observables as functions of (t, (y, w)).
    observables: Evaluator,
    /// Their derivatives by the state and by the parameters.
    observed_slopes: Option<Box<[Stage; 2]>>,
}

/// The number of operations in straight-line code that take about as long as one operation of a factorisation
/// in loops.
pub(crate) const OF_A_LOOP: usize = 4;

/// The equations that determine w.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum Unknowns {
    /// M w = r: a program that computes, from (t, y), the nonzero entries of the lower triangle of M, then r.
    Linear { equations: Evaluator, lower: Pattern, values: Vec<f64> },
    /// p(t, y, w) = r
    Implicit(Box<Newton>),
}

impl Staged {
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new(system: &FirstOrder<'_>, options: &CompileOptions) -> Result<Staged, ExprError> {
        let graph = system.graph;
        let k = system.unknowns.len();
        let (lower, mut equations) = system.lower_triangle();
        equations.extend(&system.right);
        equations.extend(system.implicit.iter().flat_map(|implicit| &implicit.left));
        let (inputs, known) = (system.inputs(&[]), system.inputs(&system.unknowns));
        let all: Vec<Expr<'_>> = equations.iter().chain(&system.rates).copied().collect();
        let observed: Vec<Expr<'_>> = system.observables.iter().map(|&(_, value)| value).collect();
        let compiled = |inputs, outputs: &[Expr<'_>], backend| -> Result<Evaluator, ExprError> {
            Ok(Evaluator::new(Program::new(graph, inputs, outputs)?, backend))
        };
        let stage = |wanted: bool, symbols: &[Expr<'_>]| {
            wanted.then(|| Stage::new(system, symbols, options.backend)).transpose()
        };
        let unknowns = match &system.implicit {
            Some(implicit) => Unknowns::Implicit(Box::new(Newton::new(system, implicit, options.backend)?)),
            None => Unknowns::Linear {
                values: vec![0.0; equations.len()],
                equations: compiled(&inputs, &equations, options.backend)?,
                lower,
            },
        };
        Ok(Staged {
            dim: system.state.len(),
            multipliers: system.multipliers,
            unknowns,
            schur: None,
            solver: Solver::of_rank(k, system.multipliers, system.rank),
            known: vec![0.0; known.state.len()],
            rates: compiled(&known, &system.rates, options.backend)?,
            cost: Program::new(graph, &known, &all)?.cost(),
            jacobian: stage(options.jacobian, &system.state)?,
            jvp: options.jvp.then(|| Product::new(system, options.backend)).transpose()?,
            parameter_jacobian: stage(options.parameter_jacobian, &system.parameter_symbols())?,
            time_derivative: stage(options.time_derivative, &[system.time])?,
            observables: compiled(&known, &observed, Backend::Interpreter)?,
            observed_slopes: options
                .observable_jacobian
                .then(|| -> Result<_, ExprError> {
                    let (observing, backend) = (system.with_observables_as_rates(), options.backend);
                    let by_state = Stage::new(&observing, &system.state, backend)?;
                    let by_parameters = Stage::new(&observing, &system.parameter_symbols(), backend)?;
                    Ok(Box::new([by_state, by_parameters]))
                })
                .transpose()?,
        })
    }

    pub(crate) fn cost(&self) -> &Cost {
        &self.cost
    }

    /// The same system, with w computed by `schur` where only w is needed.
    pub(crate) fn by_joints(self, schur: Schur) -> Staged {
        Staged { schur: Some(Box::new(schur)), ..self }
    }

    /// The number of operations needed to compute w; each operation of a factorisation is counted as
    /// the number of straight-line operations that take the same time.
    pub(crate) fn operations(&self) -> usize {
        let size = self.known.len() - self.dim;
        self.equations().cost().total() + OF_A_LOOP * self.solver.operations(size, self.multipliers)
    }

    /// The program for the equations of w.
    fn equations(&self) -> &Program {
        match &self.unknowns {
            Unknowns::Linear { equations, .. } => equations.program(),
            Unknowns::Implicit(newton) => newton.program(),
        }
    }

    /// The programs that compute ẏ.
    pub(crate) fn programs(&self) -> impl Iterator<Item = &Program> {
        [self.equations(), self.rates.program()].into_iter()
    }

    pub(crate) fn time_dependence(&self, p: &[f64]) -> TimeDependence {
        TimeDependence::of(&[self.equations(), self.rates.program()], self.dim, p)
    }

    pub(crate) fn steep_functions(&self, p: &[f64]) -> Option<SteepFunctions> {
        SteepFunctions::of(&[self.equations(), self.rates.program()], self.dim, p)
    }

    pub(crate) fn pattern(&self) -> Option<&Pattern> {
        self.jacobian.as_ref().map(|stage| &stage.pattern)
    }

    /// Solves for w and factorises M.
    fn solve(&mut self, t: f64, y: &[f64], p: &[f64]) -> Result<(), EvaluationFailure> {
        self.known[..self.dim].copy_from_slice(y);
        match &mut self.unknowns {
            Unknowns::Linear { equations, lower, values } => {
                equations.eval(t, y, p, values);
                check_finite(values, equations, Point { t, y, p })?;
                let (mass, right) = values.split_at(lower.len());
                self.solver.factorise(lower, mass)?;
                let unknowns = &mut self.known[self.dim..];
                unknowns.copy_from_slice(right);
                self.solver.solve(unknowns);
                Ok(())
            }
            Unknowns::Implicit(newton) => newton.solve(t, &mut self.known, p, &mut self.solver),
        }
    }

    pub(crate) fn rhs(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        ydot: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        self.known[..self.dim].copy_from_slice(y);
        let unknowns = &mut self.known[self.dim..];
        if !self.schur.as_mut().is_some_and(|schur| schur.solve(Point { t, y, p }, unknowns)) {
            self.solve(t, y, p)?;
        }
        self.rates.eval(t, &self.known, p, ydot);
        check_finite(ydot, &self.rates, Point { t, y: &self.known, p })
    }

    /// Computes ẏ with each number in M w = r multiplied by the next value of `factor`.
    pub(crate) fn perturbed_rhs(
        &mut self,
        Point { t, y, p }: Point<'_>,
        ydot: &mut [f64],
        mut factor: impl FnMut() -> f64,
    ) -> Result<(), EvaluationFailure> {
        self.solve(t, y, p)?;
        if let Unknowns::Linear { lower, values, .. } = &mut self.unknowns {
            values.iter_mut().for_each(|value| *value *= factor());
            let (mass, right) = values.split_at(lower.len());
            self.solver.factorise(lower, mass)?;
            self.known[self.dim..].copy_from_slice(right);
            self.solver.solve(&mut self.known[self.dim..]);
        }
        self.rates.eval(t, &self.known, p, ydot);
        check_finite(ydot, &self.rates, Point { t, y: &self.known, p })
    }

    /// Writes the observables; those that contain w are not finite if there is no solution for w, or if
    /// `solved` is false.
    pub(crate) fn observe(&mut self, (t, y, p): (f64, &[f64], &[f64]), values: &mut [f64], solved: bool) {
        if !solved || self.solve(t, y, p).is_err() {
            let (state, unknowns) = self.known.split_at_mut(self.dim);
            state.copy_from_slice(y);
            unknowns.fill(f64::NAN);
        } else if self.solver.takes_spare() {
            // The reactions of spare constraints and of those that they replace are not determined
            // separately.
            let multipliers = self.known.len() - self.multipliers;
            self.known[multipliers..].fill(f64::NAN);
        }
        self.observables.eval(t, &self.known, p, values);
    }

    /// Writes the derivatives of the observables column by column; they are not finite where an observable has none, or
    /// contains w and there is no solution for w. Returns false if they were not compiled.
    pub(crate) fn observed_slopes(
        &mut self,
        by: By,
        Point { t, y, p }: Point<'_>,
        entries: &mut [f64],
    ) -> bool {
        let solved = self.solve(t, y, p).is_ok();
        let Some(stages) = &mut self.observed_slopes else { return false };
        let [by_state, by_parameters] = &mut **stages;
        let stage = match by {
            By::State => by_state,
            By::Parameters => by_parameters,
        };
        // Those w that are not determined: all, or the reactions of spare constraints.
        let determined = match (solved, self.solver.takes_spare()) {
            (false, _) => self.dim,
            (true, true) => self.known.len() - self.multipliers,
            (true, false) => self.known.len(),
        };
        self.known[determined..].fill(f64::NAN);
        stage.parts.eval(t, &self.known, p, &mut stage.values);
        if solved {
            stage.solve(&mut self.solver);
        }
        let k = self.known.len() - self.dim;
        for column in stage.unknowns.chunks_exact_mut(k.max(1)) {
            column[determined - self.dim..].fill(f64::NAN);
        }
        stage.write(entries, Storage::Dense);
        true
    }

    pub(crate) fn jacobian(
        &mut self,
        Point { t, y, p }: Point<'_>,
        entries: &mut [f64],
        storage: Storage,
    ) -> Result<(), EvaluationFailure> {
        self.solve(t, y, p)?;
        let stage = self.jacobian.as_mut().ok_or(EvaluationFailure::NotCompiled { what: "Jacobian" })?;
        stage.eval(t, &self.known, p, &mut self.solver, entries, storage)
    }

    pub(crate) fn parameter_jacobian(
        &mut self,
        Point { t, y, p }: Point<'_>,
        entries: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        self.solve(t, y, p)?;
        let what = "derivative by parameters";
        let stage = self.parameter_jacobian.as_mut().ok_or(EvaluationFailure::NotCompiled { what })?;
        stage.eval(t, &self.known, p, &mut self.solver, entries, Storage::Dense)
    }

    pub(crate) fn time_derivative(
        &mut self,
        Point { t, y, p }: Point<'_>,
        derivative: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        self.solve(t, y, p)?;
        let what = "derivative by time";
        let stage = self.time_derivative.as_mut().ok_or(EvaluationFailure::NotCompiled { what })?;
        stage.eval(t, &self.known, p, &mut self.solver, derivative, Storage::Dense)
    }

    pub(crate) fn jvp(
        &mut self,
        Point { t, y, p }: Point<'_>,
        v: &[f64],
        product: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        self.solve(t, y, p)?;
        let jvp =
            self.jvp.as_mut().ok_or(EvaluationFailure::NotCompiled { what: "product with its Jacobian" })?;
        jvp.eval(t, &self.known, p, v, &mut self.solver, product)
    }
}

/// The derivatives ∂ẏ/∂q = ∂g/∂q + ∂g/∂w M⁻¹ ∂F/∂q with F = r − M w or r − p, for symbols q.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Stage {
    /// Computes, from (t, (y, w)), the nonzero entries of ∂F/∂q, of ∂g/∂q, and of ∂g/∂w.
    parts: Evaluator,
    values: Vec<f64>,
    balance: Pattern,
    rates: Pattern,
    coupling: Pattern,
    /// The pattern of ∂ẏ/∂q.
    pattern: Pattern,
    /// M⁻¹ ∂F/∂q
    unknowns: Vec<f64>,
    column: Vec<f64>,
}

impl Stage {
    fn new<'g>(system: &FirstOrder<'g>, symbols: &[Expr<'g>], backend: Backend) -> Result<Stage, ExprError> {
        let graph = system.graph;
        let (dim, k) = (system.rates.len(), system.unknowns.len());
        let columns = |rows: &[Expr<'g>]| -> Vec<SparseColumn<'g>> {
            symbols.iter().map(|&symbol| sparse(&graph.directional(rows, &[(symbol, Expr::ONE)]))).collect()
        };
        let mut coupling = vec![Vec::new(); k];
        for (i, row) in system.coupling().into_iter().enumerate() {
            row.into_iter().for_each(|(s, entry)| coupling[s].push((i, entry)));
        }
        let (balance, mut parts) = nonzeros(k, columns(&system.balance()));
        let (rates, rates_parts) = nonzeros(dim, columns(&system.rates));
        let (coupling, coupling_parts) = nonzeros(dim, coupling);
        parts.extend(rates_parts);
        parts.extend(coupling_parts);
        Ok(Stage {
            values: vec![0.0; parts.len()],
            parts: derivative(graph, &system.inputs(&system.unknowns), &parts, backend)?,
            pattern: whole(&blocks(&system.mass), &balance, &rates, &coupling),
            unknowns: vec![0.0; k * symbols.len()],
            column: vec![0.0; dim],
            balance,
            rates,
            coupling,
        })
    }

    fn eval(
        &mut self,
        t: f64,
        known: &[f64],
        p: &[f64],
        solver: &mut Solver,
        entries: &mut [f64],
        storage: Storage,
    ) -> Result<(), EvaluationFailure> {
        self.parts.eval(t, known, p, &mut self.values);
        check_finite(&self.values, &self.parts, Point { t, y: known, p })?;
        self.solve(solver);
        self.write(entries, storage);
        Ok(())
    }

    /// Computes M⁻¹ ∂F/∂q from the values of the parts.
    fn solve(&mut self, solver: &mut Solver) {
        self.balance.scatter(&self.values[..self.balance.len()], &mut self.unknowns);
        solver.solve(&mut self.unknowns);
    }

    /// Writes ∂ẏ/∂q.
    fn write(&mut self, entries: &mut [f64], storage: Storage) {
        let (rates, coupling) = self.values[self.balance.len()..].split_at(self.rates.len());
        let (dim, k) = (self.pattern.rows(), self.balance.rows());
        for j in 0..self.pattern.columns() {
            let starts = self.rates.column_starts();
            self.column.fill(0.0);
            for (&i, rate) in self.rates.column(j).iter().zip(&rates[starts[j]..]) {
                self.column[i] = *rate;
            }
            for ((i, s), coupling) in self.coupling.entries().zip(coupling) {
                self.column[i] += coupling * self.unknowns[s + j * k];
            }
            match storage {
                Storage::Dense => entries[j * dim..(j + 1) * dim].copy_from_slice(&self.column),
                Storage::Sparse => {
                    let start = self.pattern.column_starts()[j];
                    for (&i, entry) in self.pattern.column(j).iter().zip(&mut entries[start..]) {
                        *entry = self.column[i];
                    }
                }
            }
        }
    }
}

/// The index of the irreducible block of M to which each row belongs; the inverse of a block is full.
fn blocks(m: &Matrix<Expr<'_>>) -> Vec<usize> {
    let k = m.rows();
    let mut block: Vec<usize> = (0..k).collect();
    for i in 0..k {
        for j in m.nonzero(i).map(|(j, _)| j).filter(|&j| j < i) {
            let (joined, into) = (block[i], block[j]);
            block.iter_mut().filter(|b| **b == joined).for_each(|b| *b = into);
        }
    }
    block
}

/// The pattern of ∂g/∂q + ∂g/∂w M⁻¹ ∂F/∂q.
fn whole(blocks: &[usize], balance: &Pattern, rates: &Pattern, coupling: &Pattern) -> Pattern {
    let column = |j: usize| {
        let moved: Vec<usize> = balance.column(j).iter().map(|&s| blocks[s]).collect();
        let through = (0..blocks.len()).filter(|&s| moved.contains(&blocks[s]));
        let rows = through.flat_map(|s| coupling.column(s)).chain(rates.column(j));
        rows.copied().collect::<Vec<_>>()
    };
    Pattern::from_columns(rates.rows(), (0..rates.columns()).map(column))
}

/// The product (∂ẏ/∂y) v = g′ + ∂g/∂w w′ with w′ = M⁻¹ F′, where ′ is the derivative along v.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Product {
    /// F′ from (t, (y, w, v)).
    balance: Evaluator,
    /// ẏ′ from (t, (y, w, v, w′)).
    rates: Evaluator,
    /// y, w, v, w′
    known: Vec<f64>,
}

impl Product {
    fn new(system: &FirstOrder<'_>, backend: Backend) -> Result<Product, ExprError> {
        let graph = system.graph;
        let (v, changes) = (system.fresh("δ", &system.state), system.fresh("δ", &system.unknowns));
        let mut along: Vec<_> = system.state.iter().copied().zip(v.iter().copied()).collect();
        let balance = graph.directional(&system.balance(), &along);
        along.extend(system.unknowns.iter().copied().zip(changes.iter().copied()));
        let rates = graph.directional(&system.rates, &along);
        let more: Vec<Expr<'_>> = system.unknowns.iter().chain(&v).copied().collect();
        let all: Vec<Expr<'_>> = more.iter().chain(&changes).copied().collect();
        let inputs = system.inputs(&all);
        Ok(Product {
            balance: derivative(graph, &system.inputs(&more), &balance, backend)?,
            known: vec![0.0; inputs.state.len()],
            rates: derivative(graph, &inputs, &rates, backend)?,
        })
    }

    fn eval(
        &mut self,
        t: f64,
        known: &[f64],
        p: &[f64],
        v: &[f64],
        solver: &mut Solver,
        product: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let given = known.len() + v.len();
        self.known[..known.len()].copy_from_slice(known);
        self.known[known.len()..given].copy_from_slice(v);
        let (inputs, changes) = self.known.split_at_mut(given);
        self.balance.eval(t, inputs, p, changes);
        check_finite(changes, &self.balance, Point { t, y: inputs, p })?;
        solver.solve(changes);
        self.rates.eval(t, &self.known, p, product);
        check_finite(product, &self.rates, Point { t, y: &self.known, p })
    }
}

#[cfg(test)]
mod tests;
