//! First-order systems with M⁻¹ written out: every quantity is computed by one straight-line program from
//! (t, y, p).

use std::cell::LazyCell;
use std::sync::Arc;

use pc_expr::{
    Backend, Cost, Evaluator, Expr, ExprError, LaneField, Pattern, Program, SteepFunctions, TaylorSeries,
    TimeDependence, VariedSeries,
};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::columns::{Columns, Storage, derivative};
use crate::compiled::elimination::observed::ObservedSlopes;
use crate::compiled::elimination::pivots::Pivots;
use crate::compiled::elimination::products::Products;
use crate::compiled::elimination::prologue::Prologue;
use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::first_order::{FirstOrder, Linearised};
use crate::compiled::machine_code::MachineCode;
use crate::compiled::options::CompileOptions;
use crate::compiled::point::Point;

/// The compiled ẏ = g(t, y, M⁻¹ r) and its derivatives.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Unrolled {
    /// Outputs: ẏ, which leads, then the pivots and the diagonal entries of M that change with the state.
    rates: Evaluator,
    /// A faster form of the same program, if much of it depends on parameters alone.
    prologue: Option<Box<Prologue>>,
    pivots: Pivots,
    /// An expression for each entry of ∂ẏ/∂y.
    jacobian: Option<Columns>,
    /// ∂ẏ/∂y and (∂ẏ/∂y) v of a large tree, where the entry for each pair of bodies is long.
    products: Option<Box<Products>>,
    /// Computes (∂ẏ/∂y) v from the state (y, v).
    jvp: Option<Evaluator>,
    /// y, v
    known: Vec<f64>,
    parameter_jacobian: Option<Columns>,
    time_derivative: Option<Columns>,
    observables: Evaluator,
    observed_slopes: Option<Box<ObservedSlopes>>,
    backend: Backend,
    /// The Taylor series of the outputs of `rates`, made on first use.
    #[serde(skip)]
    series: Option<TaylorSeries>,
    #[serde(skip)]
    varied: VariedSeries,
}

impl Unrolled {
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new(system: &FirstOrder<'_>, options: &CompileOptions) -> Result<Unrolled, ExprError> {
        let graph = system.graph;
        let inputs = system.inputs(&[]);
        let factors = system.factors();
        let unknowns = system.solve(&factors);
        let values: Vec<_> = system.unknowns.iter().copied().zip(unknowns.iter().copied()).collect();
        let rates = graph.substitute(&system.rates, &values);
        let (pivots, moving) = Pivots::new(system, &factors)?;
        let outputs: Vec<Expr<'_>> = rates.iter().chain(&moving).copied().collect();
        let program = Program::new(graph, &inputs, &outputs)?;

        let linearised = LazyCell::new(|| Linearised::new(system, &factors, &unknowns));
        let rows = system.rates.len();
        let columns = |wanted: bool, symbols: &[Expr<'_>]| {
            wanted
                .then(|| Columns::new(graph, &inputs, (rows, linearised.columns(symbols)), options.backend))
                .transpose()
        };
        let by_products = system.tree.as_ref().is_some_and(|tree| tree.is_large());
        let observed: Vec<Expr<'_>> = system.observables.iter().map(|&(_, value)| value).collect();
        let observed = Program::new(graph, &inputs, &graph.substitute(&observed, &values))?;
        let varies = |&place: &usize| system.varying.contains(&system.parameters[place].0);
        let varying: Vec<usize> = (0..system.parameters.len()).filter(varies).collect();
        Ok(Unrolled {
            prologue: Prologue::of(&program, &varying, options.backend, rates.len()).map(Box::new),
            rates: Evaluator::with_leading(program, options.backend, rates.len()),
            pivots,
            jacobian: columns(options.jacobian && !by_products, &system.state)?,
            products: (by_products && (options.jacobian || options.jvp))
                .then(|| {
                    // The accelerations stay symbols.
                    let (v, product) = product(system, &Linearised::new(system, &factors, &system.unknowns));
                    let unknowns = (&system.unknowns[..], &unknowns[..]);
                    Products::new(graph, &inputs, unknowns, (&v, &product)).map(Box::new)
                })
                .transpose()?,
            jvp: (options.jvp && !by_products)
                .then(|| jvp(system, &linearised, options.backend))
                .transpose()?,
            known: vec![0.0; 2 * system.state.len()],
            parameter_jacobian: columns(options.parameter_jacobian, &system.parameter_symbols())?,
            time_derivative: columns(options.time_derivative, &[system.time])?,
            observables: Evaluator::new(observed, Backend::Interpreter),
            observed_slopes: options
                .observable_jacobian
                .then(|| ObservedSlopes::new(system, &factors, &unknowns, options.backend).map(Box::new))
                .transpose()?,
            backend: options.backend,
            series: None,
            varied: VariedSeries::default(),
        })
    }

    /// Discards what was computed from the parameters, since they may have changed.
    pub(crate) fn forget(&mut self) {
        self.pivots.forget();
        if let Some(prologue) = &mut self.prologue {
            prologue.forget();
        }
    }

    /// Marks further parameters, given by their indices, as able to change at each evaluation.
    pub(crate) fn vary(&mut self, places: &[usize], backend: Backend, dim: usize) {
        if let Some(prologue) = self.prologue.take() {
            let varying = [prologue.varying(), places].concat();
            self.prologue = Prologue::of(self.rates.program(), &varying, backend, dim).map(Box::new);
        }
    }

    /// The numbers that the machine code takes as parameters.
    pub(crate) fn code_parameters<'a>(&'a mut self, p: &'a [f64]) -> &'a [f64] {
        match &mut self.prologue {
            Some(prologue) => prologue.numbers(p),
            None => p,
        }
    }

    /// The number of operations needed to compute ẏ, not counting those for the pivots.
    pub(crate) fn cost(&self, dim: usize) -> Cost {
        self.rates.program().leading(dim).cost()
    }

    /// The programs that compute ẏ.
    pub(crate) fn programs(&self) -> impl Iterator<Item = &Program> {
        std::iter::once(&**self.rates.program())
    }

    pub(crate) fn time_dependence(&self, dim: usize, p: &[f64]) -> TimeDependence {
        TimeDependence::of(&[self.rates.program()], dim, p)
    }

    pub(crate) fn steep_functions(&self, dim: usize, p: &[f64]) -> Option<SteepFunctions> {
        SteepFunctions::of(&[self.rates.program()], dim, p)
    }

    pub(crate) fn observe(&mut self, t: f64, y: &[f64], p: &[f64], values: &mut [f64]) {
        self.observables.eval(t, y, p, values);
    }

    /// The derivatives of the observables, if they were compiled.
    pub(crate) fn observed_slopes(&mut self) -> Option<&mut ObservedSlopes> {
        self.observed_slopes.as_deref_mut()
    }

    #[inline]
    pub(crate) fn rhs(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        ydot: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let (moving, finite) = match &mut self.prologue {
            Some(prologue) => prologue.eval_leading(t, y, p, ydot),
            None => self.rates.eval_leading(t, y, p, ydot),
        };
        self.pivots.check(y, p, moving)?;
        if finite { Ok(()) } else { check_finite(ydot, &self.rates, Point { t, y, p }) }
    }

    /// Compiles the Jacobian, which is otherwise compiled on first use.
    pub(crate) fn prepare_jacobian(&mut self) {
        if let Some(columns) = &mut self.jacobian {
            columns.prepare();
        }
        if let Some(products) = &mut self.products {
            products.prepare();
        }
    }

    /// The Taylor series of the motion.
    pub(crate) fn series(&mut self) -> &TaylorSeries {
        let (program, backend) = (self.rates.program(), self.backend);
        self.series.get_or_insert_with(|| TaylorSeries::new(program, backend))
    }

    /// Expands the motion through y at t.
    pub(crate) fn expand(
        &mut self,
        Point { t, y, p }: Point<'_>,
        sides: &[f64],
        order: usize,
    ) -> Result<&TaylorSeries, EvaluationFailure> {
        let (program, backend) = (self.rates.program(), self.backend);
        let series = self.series.get_or_insert_with(|| TaylorSeries::new(program, backend));
        series.expand(t, y, sides, p, order);
        self.pivots.check(y, p, series.watched())?;
        Ok(series)
    }

    /// The Taylor series of the motion and of its derivatives.
    pub(crate) fn varied_series(&mut self, columns: &[Option<usize>]) -> &TaylorSeries {
        self.varied.of(columns, self.rates.program(), self.backend)
    }

    /// Expands the motion and its derivatives at t, starting from the state and its columns.
    pub(crate) fn expand_varied(
        &mut self,
        columns: &[Option<usize>],
        Point { t, y: all, p }: Point<'_>,
        sides: &[f64],
        order: usize,
    ) -> Result<&TaylorSeries, EvaluationFailure> {
        let series = self.varied.of(columns, self.rates.program(), self.backend);
        series.expand(t, all, sides, p, order);
        let dim = all.len() / (1 + columns.len());
        self.pivots.check(&all[..dim], p, series.watched())?;
        Ok(series)
    }

    /// The field f for many states at once; `None` if it is interpreted.
    pub(crate) fn lanes(&mut self, dim: usize, p: &[f64]) -> Option<LaneField> {
        if self.backend != Backend::Fastest {
            return None;
        }
        let watched = self.pivots.watched(&self.known[..dim], p);
        let (program, parameters) = match &mut self.prologue {
            Some(prologue) => (Arc::clone(prologue.rest()), prologue.numbers(p).to_vec()),
            None => (Arc::clone(self.rates.program()), p.to_vec()),
        };
        Some(LaneField { program, parameters, watched, unit_quaternions: Vec::new() })
    }

    pub(crate) fn machine_code(&mut self, dim: usize) -> Option<MachineCode> {
        let parameters = self.rates.program().parameters_len();
        let (code, parameters) = match &mut self.prologue {
            Some(prologue) => (prologue.machine_code()?, prologue.parameters_len()),
            None => (self.rates.machine_code()?, parameters),
        };
        Some(MachineCode::new(code, (dim, parameters), Arc::clone(self.pivots.partition())))
    }

    pub(crate) fn fixed_pivots(&mut self, dim: usize, p: &[f64]) -> &[f64] {
        // Independent of the state.
        self.pivots.fixed(&self.known[..dim], p)
    }

    pub(crate) fn jacobian(
        &mut self,
        Point { t, y, p }: Point<'_>,
        entries: &mut [f64],
        storage: Storage,
    ) -> Result<(), EvaluationFailure> {
        if let Some(products) = &mut self.products {
            return products.eval(Point { t, y, p }, entries, storage);
        }
        let jacobian = self.jacobian.as_mut().ok_or(EvaluationFailure::NotCompiled { what: "Jacobian" })?;
        jacobian.eval(Point { t, y, p }, entries, storage)
    }

    pub(crate) fn parameter_jacobian(
        &mut self,
        Point { t, y, p }: Point<'_>,
        entries: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let what = "derivative by parameters";
        let jacobian = self.parameter_jacobian.as_mut().ok_or(EvaluationFailure::NotCompiled { what })?;
        jacobian.eval(Point { t, y, p }, entries, Storage::Dense)
    }

    pub(crate) fn time_derivative(
        &mut self,
        Point { t, y, p }: Point<'_>,
        derivative: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let what = "derivative by time";
        let column = self.time_derivative.as_mut().ok_or(EvaluationFailure::NotCompiled { what })?;
        column.eval(Point { t, y, p }, derivative, Storage::Dense)
    }

    pub(crate) fn jvp(
        &mut self,
        Point { t, y, p }: Point<'_>,
        v: &[f64],
        product: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        if let Some(products) = &mut self.products {
            return products.along(Point { t, y, p }, v, product);
        }
        let jvp =
            self.jvp.as_mut().ok_or(EvaluationFailure::NotCompiled { what: "product with its Jacobian" })?;
        let (state, direction) = self.known.split_at_mut(y.len());
        state.copy_from_slice(y);
        direction.copy_from_slice(v);
        jvp.eval(t, &self.known, p, product);
        check_finite(product, jvp, Point { t, y: &self.known, p })
    }

    pub(crate) fn pattern(&self) -> Option<&Pattern> {
        match &self.products {
            Some(products) => Some(products.pattern()),
            None => self.jacobian.as_ref().map(Columns::pattern),
        }
    }
}

/// A direction v and the product (∂ẏ/∂y) v, by forward differentiation along v, without a Jacobian.
fn product<'g>(system: &FirstOrder<'g>, linearised: &Linearised<'_, 'g>) -> (Vec<Expr<'g>>, Vec<Expr<'g>>) {
    linearised.product(system, &system.state)
}

/// A program for (∂ẏ/∂y) v as a function of the state (y, v).
fn jvp<'g>(
    system: &FirstOrder<'g>,
    linearised: &Linearised<'_, 'g>,
    backend: Backend,
) -> Result<Evaluator, ExprError> {
    let (v, product) = product(system, linearised);
    derivative(system.graph, &system.inputs(&v), &product, backend)
}
