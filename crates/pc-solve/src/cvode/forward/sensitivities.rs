//! Derivatives of a motion that are integrated along with it.

use pc_expr::VectorField;

use crate::cvode::forward::linearisation::Linearisation;
use crate::error::InputError;
use crate::integration::checks::{check_length, finite, positive};

/// Derivatives of a motion to be integrated along with it: the columns of S(t) = ∂y(t)/∂(p, y₀).
///
/// Each column s satisfies the equation of variation, with one more term if it is a derivative with
/// respect to a parameter pⱼ,
/// ```text
/// ṡ = (∂f/∂y) s + ∂f/∂pⱼ,    s(t₀) = ∂y₀/∂pⱼ.
/// ```
/// Columns are in the order in which they are added. Products with ∂f/∂y are [computed by the
/// field](VectorField::jvp) if it can do so, else with its [Jacobian](VectorField::jacobian), else
/// as difference quotients, accurate to about ten digits. Derivatives with respect to parameters
/// need the field's [`parameter_jacobian`](VectorField::parameter_jacobian).
///
/// If the states lie on a surface that depends on the parameters, so does y₀: its derivatives are
/// given by [`by_parameter_from`](Sensitivities::by_parameter_from). Columns that begin tangent to
/// the surface stay tangent to it within the tolerances; these columns are integrated along the
/// [projected](VectorField::project) states, but are not projected themselves.
///
/// ```
/// use pc_solve::{Sensitivities, Solve, from_fn};
///
/// // ẏ = −y²: y = y₀/(1 + y₀ t), so ∂y/∂y₀ = 1/(1 + y₀ t)².
/// let decay = from_fn(1, |_t, y, ydot| {
///     ydot[0] = -y[0] * y[0];
///     Ok(())
/// });
/// let sensitivities = Sensitivities::new().by_start(0);
/// let solution = Solve::new(decay, 0.0, &[2.0]).sensitivities(&sensitivities).run(&[1.5])?;
/// assert!((solution.trajectory.matrix(0)[0] - 1.0 / 16.0).abs() < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivities {
    columns: Vec<Column>,
    pub(crate) correction: Correction,
    pub(crate) error_control: bool,
    pub(crate) tolerances: Option<(f64, f64)>,
    scales: Option<Vec<f64>>,
}

/// One column of S.
#[derive(Debug, Clone, PartialEq)]
struct Column {
    parameter: Option<usize>,
    start: Start,
}

/// The value of a column at the start.
#[derive(Debug, Clone, PartialEq)]
enum Start {
    Zero,
    Unit(usize),
    Along(Vec<f64>),
}

/// When the implicit equations of the columns are solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Correction {
    /// After the equations of the state, once the state has passed its error test.
    Staggered,
    /// Together with the equations of the state.
    Simultaneous,
}

impl Default for Sensitivities {
    fn default() -> Self {
        Sensitivities::new()
    }
}

impl Sensitivities {
    /// An empty list of columns, with staggered correction and an error test of the columns with
    /// the tolerances of the state.
    pub fn new() -> Self {
        Sensitivities {
            columns: Vec::new(),
            correction: Correction::Staggered,
            error_control: true,
            tolerances: None,
            scales: None,
        }
    }

    fn with(mut self, parameter: Option<usize>, start: Start) -> Self {
        self.columns.push(Column { parameter, start });
        self
    }

    /// Adds a column ∂y/∂pⱼ, for an initial state that does not depend on pⱼ.
    pub fn by_parameter(self, j: usize) -> Self {
        self.with(Some(j), Start::Zero)
    }

    /// Adds a column ∂y/∂pⱼ for each j, for an initial state that depends on none of these
    /// parameters.
    pub fn by_parameters(self, parameters: impl IntoIterator<Item = usize>) -> Self {
        parameters.into_iter().fold(self, Sensitivities::by_parameter)
    }

    /// Adds a column ∂y/∂pⱼ, for an initial state with the derivative ∂y₀/∂pⱼ.
    pub fn by_parameter_from(self, j: usize, start: impl Into<Vec<f64>>) -> Self {
        self.with(Some(j), Start::Along(start.into()))
    }

    /// Adds a column ∂y/∂y₀ᵢ.
    pub fn by_start(self, i: usize) -> Self {
        self.with(None, Start::Unit(i))
    }

    /// Adds a column ∂y/∂y₀ᵢ for each i.
    pub fn by_starts(self, components: impl IntoIterator<Item = usize>) -> Self {
        components.into_iter().fold(self, Sensitivities::by_start)
    }

    /// Adds a column (∂y/∂y₀) v, the derivative of the motion as its initial state moves along v.
    pub fn along(self, direction: impl Into<Vec<f64>>) -> Self {
        self.with(None, Start::Along(direction.into()))
    }

    /// When the implicit equations of the columns are solved.
    pub fn correction(self, correction: Correction) -> Self {
        Sensitivities { correction, ..self }
    }

    /// Whether steps also have to pass the error test of the columns.
    ///
    /// If they do not, and the correction is staggered, the steps are the same as without
    /// sensitivities, unless the iteration for a column does not converge.
    pub fn error_control(self, error_control: bool) -> Self {
        Sensitivities { error_control, ..self }
    }

    /// Sets the scales p̄ of the parameters or initial values to which the columns refer, one
    /// positive number for each column: p̄ s has the unit of the state, and the absolute tolerance
    /// of the column s is that of the state divided by p̄.
    ///
    /// By default, p̄ is the [size of a parameter](VectorField::parameter_size), or if that is
    /// unknown, the value for which p̄ ∂f/∂p at the start is as large as f; for a component of the
    /// initial state it is the magnitude of the component; each scale is at least 1.
    pub fn scales(self, scales: impl Into<Vec<f64>>) -> Self {
        Sensitivities { scales: Some(scales.into()), ..self }
    }

    /// Sets the relative and absolute tolerance of the columns, both positive; by default, they are
    /// those of the state, [scaled](Sensitivities::scales).
    pub fn tolerances(self, relative: f64, absolute: f64) -> Self {
        Sensitivities { tolerances: Some((relative, absolute)), ..self }
    }

    /// The number of columns.
    pub fn len(&self) -> usize {
        self.columns.len()
    }

    /// Whether there are no columns.
    pub fn is_empty(&self) -> bool {
        self.columns.is_empty()
    }

    /// The parameter of each column.
    pub(crate) fn parameters(&self) -> Vec<Option<usize>> {
        self.columns.iter().map(|column| column.parameter).collect()
    }

    /// p̄ of each column, for a start at y(t) = y.
    pub(crate) fn sizes(
        &self,
        field: &mut impl VectorField,
        linearisation: &mut Linearisation,
        t: f64,
        y: &[f64],
    ) -> Vec<f64> {
        if let Some(scales) = &self.scales {
            return scales.clone();
        }
        let is_unknown =
            |column: &Column| column.parameter.is_some_and(|j| field.parameter_size(j).is_none());
        let mut rates = vec![f64::NAN; y.len()];
        // A missing derivative is reported by the integration.
        let known = !self.columns.iter().any(is_unknown)
            || field.rhs(t, y, &mut rates).is_ok() && linearisation.parameter_jacobian(field, t, y).is_ok();
        let size = |column: &Column| match (column.parameter, &column.start) {
            (Some(j), _) => match field.parameter_size(j) {
                Some(size) => size,
                None if known => {
                    let by_parameter = linearisation.by_parameter(j).iter();
                    let ratios = rates.iter().zip(by_parameter).map(|(f, by)| (f / by).abs());
                    ratios.filter(|ratio| ratio.is_finite()).fold(1.0, f64::max)
                }
                None => 1.0,
            },
            (None, Start::Unit(i)) => y[*i].abs(),
            (None, _) => 1.0,
        };
        // At least 1, so that the columns are at least as accurate as the state.
        self.columns
            .iter()
            .map(|column| {
                Some(size(column)).filter(|size| size.is_finite()).map_or(1.0, |size| size.max(1.0))
            })
            .collect()
    }

    /// S(t₀), column-major.
    pub(crate) fn start(&self, dim: usize) -> Vec<f64> {
        let mut start = vec![0.0; dim * self.len()];
        for (values, column) in start.chunks_exact_mut(dim).zip(&self.columns) {
            match &column.start {
                Start::Zero => {}
                Start::Unit(i) => values[*i] = 1.0,
                Start::Along(direction) => values.copy_from_slice(direction),
            }
        }
        start
    }

    pub(crate) fn validate(&self, field: &impl VectorField) -> Result<(), InputError> {
        let dim = field.dim();
        for column in &self.columns {
            check_passages(field, column.parameter)?;
            if let Some(index) = column.parameter {
                if !field.has_parameter_jacobian() {
                    return Err(InputError::NoParameterJacobian);
                }
                let len = field.parameters_len();
                if index >= len {
                    return Err(InputError::NoParameter { index, len });
                }
            }
            match &column.start {
                Start::Zero => {}
                Start::Unit(index) => {
                    if *index >= dim {
                        return Err(InputError::NoComponent { index: *index, dim });
                    }
                }
                Start::Along(direction) => {
                    check_length("the start of a sensitivity", direction.len(), dim)?;
                    for (i, &value) in direction.iter().enumerate() {
                        finite(&format!("a sensitivity of {} at the start", field.component_name(i)), value)?;
                    }
                }
            }
        }
        if let Some(scales) = &self.scales {
            check_length("the scales of the sensitivities", scales.len(), self.len())?;
            for &scale in scales {
                positive("the scale of a sensitivity", scale)?;
            }
        }
        if let Some((relative, absolute)) = self.tolerances {
            positive("the relative tolerance of the sensitivities", relative)?;
            positive("the absolute tolerance of the sensitivities", absolute)?;
        }
        Ok(())
    }
}

/// Checks that the rates do not jump at any time that depends on the parameter or, if no parameter
/// is given, on the initial state.
///
/// # Errors
/// [`InputError::RateJump`]
pub(crate) fn check_passages(field: &impl VectorField, parameter: Option<usize>) -> Result<(), InputError> {
    let moved = field.jumps().iter().find(|jump| jump.moves_with(parameter));
    moved.map_or(Ok(()), |jump| Err(InputError::RateJump(jump.clone())))
}

/// The work for the columns, beyond that for the state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct SensitivityStatistics {
    /// The number of evaluations of the equations of variation, each for all columns at once.
    pub evaluations: u64,
    /// The number of steps repeated because the estimated error of a column was too large.
    pub error_test_failures: u64,
    /// The number of iterations of the nonlinear solver for the columns alone; 0 if the correction
    /// is simultaneous.
    pub nonlinear_iterations: u64,
    /// The number of times the nonlinear solver for the columns failed to converge, including
    /// failures remedied by a new Jacobian.
    pub nonlinear_failures: u64,
}
