//! The adjoint equations of a motion as a vector field.

use std::cell::RefCell;
use std::rc::Rc;

use pc_expr::{Failure, Pattern, VectorField};

use crate::cvode::forward::linearisation::Linearisation;
use crate::cvode::quadrature::Quadratures;
use crate::error::{NonFinite, SolveError};
use crate::sensitivity::functional::Functional;
use crate::sensitivity::motion_record::MotionRecord;
use crate::sensitivity::transpose::Transpose;
use crate::settings::options::Options;

/// The data shared by the adjoint equations of all functionals of a motion.
pub(crate) struct Path<F> {
    pub(crate) field: F,
    /// Computes ∂f/∂p, for the derivatives of the functional with respect to the parameters.
    linearisation: Linearisation,
    transpose: Transpose,
    motion: MotionRecord,
}

impl<F: VectorField> Path<F> {
    pub(crate) fn new(field: F, options: &Options) -> Path<F> {
        let linearisation = Linearisation::new(&field, options);
        let transpose = Transpose::new(&field, options);
        Path { field, linearisation, transpose, motion: MotionRecord::default() }
    }

    /// Whether the field provides products with (∂f/∂y)ᵀ, but no entries of ∂f/∂y.
    pub(crate) fn has_products_only(&self) -> bool {
        !self.transpose.has_entries(&self.field)
    }

    /// Records the motion from y(t0) = y0 to `t1`, while the field is held on these sides of its
    /// surfaces.
    pub(crate) fn record(
        &mut self,
        t0: f64,
        y0: &[f64],
        t1: f64,
        sides: &[f64],
        options: &Options,
    ) -> Result<(), SolveError> {
        self.motion = MotionRecord::of(&mut self.field, t0, y0, t1, sides, options)?;
        Ok(())
    }
}

/// The field λ̇ = −(∂f/∂y)ᵀ λ − ∂g/∂y along the recorded piece of a motion, together with the
/// integrals in the gradient.
pub(crate) struct AdjointField<F, G> {
    path: Rc<RefCell<Path<F>>>,
    functional: G,
    /// y(t)
    state: Vec<f64>,
    by_state: Vec<f64>,
    by_parameters: Vec<f64>,
    // Properties of the field, copied since references cannot be taken through the `RefCell`.
    pattern: Option<Pattern>,
    breaks: Vec<f64>,
    has_entries: bool,
}

/// The two terms of a functional.
#[derive(Clone, Copy)]
enum Term {
    Density,
    End,
}

impl<F: VectorField, G: Functional> AdjointField<F, G> {
    pub(crate) fn new(path: Rc<RefCell<Path<F>>>, functional: G) -> Self {
        let of = path.borrow();
        let field = &of.field;
        let parameters = if field.has_parameter_jacobian() { field.parameters_len() } else { 0 };
        let dim = field.dim();
        let (pattern, breaks) = (of.transpose.pattern().cloned(), field.breaks().to_vec());
        let has_entries = !of.has_products_only();
        drop(of);
        AdjointField {
            path,
            functional,
            state: vec![0.0; dim],
            by_state: vec![0.0; dim],
            by_parameters: vec![0.0; parameters],
            pattern,
            breaks,
            has_entries,
        }
    }

    /// The state y(t) of the recorded motion.
    pub(crate) fn motion(&mut self, t: f64) -> &[f64] {
        self.path.borrow().motion.state(t, &mut self.state);
        &self.state
    }

    /// The end term h(t, y), and its derivatives with respect to the state and the parameters.
    pub(crate) fn end(&mut self, t: f64, y: &[f64]) -> Result<(f64, Vec<f64>, Vec<f64>), Failure> {
        self.state.copy_from_slice(y);
        let value = self.term(Term::End, t)?;
        Ok((value, self.by_state.clone(), self.by_parameters.clone()))
    }

    /// g(t, y)
    pub(crate) fn density(&mut self, t: f64, y: &[f64]) -> Result<f64, Failure> {
        self.state.copy_from_slice(y);
        self.term(Term::Density, t)
    }

    /// A term of the functional at (t, `state`) and, in `by_state` and `by_parameters`, its
    /// derivatives.
    fn term(&mut self, term: Term, t: f64) -> Result<f64, Failure> {
        let AdjointField { path, functional, state, by_state, by_parameters, .. } = self;
        by_state.fill(f64::NAN);
        by_parameters.fill(f64::NAN);
        let (value, name) = match term {
            Term::Density => (functional.density(t, state, by_state, by_parameters)?, "density"),
            Term::End => (functional.end(t, state, by_state, by_parameters)?, "end term"),
        };
        let (what, value) = if !value.is_finite() {
            (format!("the {name} of the functional"), value)
        } else if let Some(i) = not_finite(by_state) {
            let component = path.borrow().field.component_name(i);
            (format!("the derivative by {component} of the {name} of the functional"), by_state[i])
        } else if let Some(j) = not_finite(by_parameters) {
            let what = format!("the derivative by parameter {j} (from 0) of the {name} of the functional");
            (what, by_parameters[j])
        } else {
            return Ok(value);
        };
        Err(Failure::recoverable(NonFinite::Functional { what, value, t }))
    }
}

impl<F: VectorField, G: Functional> VectorField for AdjointField<F, G> {
    fn dim(&self) -> usize {
        self.state.len()
    }

    fn rhs(&mut self, t: f64, adjoint: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
        self.motion(t);
        self.term(Term::Density, t)?;
        let Path { field, transpose, .. } = &mut *self.path.borrow_mut();
        transpose.product(field, (t, &self.state), adjoint, rate)?;
        for (rate, by_state) in rate.iter_mut().zip(&self.by_state) {
            *rate = -*rate - by_state;
        }
        Ok(())
    }

    fn has_jacobian(&self) -> bool {
        self.has_entries
    }

    /// −(∂f/∂y)ᵀ
    fn jacobian(&mut self, t: f64, _adjoint: &[f64], matrix: &mut [f64]) -> Result<(), Failure> {
        self.motion(t);
        let Path { field, transpose, .. } = &mut *self.path.borrow_mut();
        transpose.negative(field, (t, &self.state), matrix)
    }

    fn sparsity(&self) -> Option<&Pattern> {
        self.pattern.as_ref()
    }

    fn sparse_jacobian(&mut self, t: f64, _adjoint: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.motion(t);
        let Path { field, transpose, .. } = &mut *self.path.borrow_mut();
        transpose.negative_entries(field, (t, &self.state), values)
    }

    fn has_jvp(&self) -> bool {
        true
    }

    /// −(∂f/∂y)ᵀ v
    fn jvp(&mut self, t: f64, _adjoint: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        self.motion(t);
        let Path { field, transpose, .. } = &mut *self.path.borrow_mut();
        transpose.product(field, (t, &self.state), v, product)?;
        product.iter_mut().for_each(|product| *product = -*product);
        Ok(())
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        self.path.borrow_mut().field.enter(t, end)
    }

    fn component_name(&self, i: usize) -> String {
        format!("the adjoint of {}", self.path.borrow().field.component_name(i))
    }
}

/// The integrals, which are zero at the end of the motion and reach ∫ (∂g/∂p + (∂f/∂p)ᵀ λ) dt and ∫
/// g dt at its start.
impl<F: VectorField, G: Functional> Quadratures for AdjointField<F, G> {
    fn count(&self) -> usize {
        self.by_parameters.len() + 1
    }

    fn integrands(&mut self, t: f64, adjoint: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        self.motion(t);
        let density = self.term(Term::Density, t)?;
        let parameters = self.by_parameters.len();
        rates[parameters] = -density;
        if parameters == 0 {
            return Ok(());
        }
        let Path { field, linearisation, .. } = &mut *self.path.borrow_mut();
        let by_parameters = linearisation.parameter_jacobian(field, t, &self.state)?;
        for ((rate, column), of_density) in
            rates.iter_mut().zip(by_parameters.chunks_exact(adjoint.len())).zip(&self.by_parameters)
        {
            *rate = -of_density - dot(column, adjoint);
        }
        match not_finite(rates) {
            None => Ok(()),
            Some(j) => {
                let what = format!("the rate of the gradient by parameter {j} (from 0)");
                Err(Failure::recoverable(NonFinite::Functional { what, value: rates[j], t }))
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(crate) fn not_finite(values: &[f64]) -> Option<usize> {
    values.iter().position(|value| !value.is_finite())
}
