//! Parts of the equations as functions of the state.

use pc_analysis::{AnalysisError, PoissonBracket};
use pc_expr::{Evaluator, Inputs, Program};
use pc_mech::{Backend, Equations, Expr, LegendreTransform, MechError};
use pc_model::{Assembly, Model, ModelError, Variables};

use crate::error::Error;

/// M of a system, which is derived when it is first asked for.
pub(crate) struct MassMatrix {
    /// M of (t, x, η), row after row.
    pub(crate) entries: Evaluator,
    /// From momenta to quasi-velocities, where the state has momenta.
    pub(crate) transform: Option<LegendreTransform>,
    /// Number of quasi-velocities of the state.
    pub(crate) size: usize,
}

impl MassMatrix {
    pub(crate) fn of(model: &Model, variables: Variables) -> Result<MassMatrix, Error> {
        let graph = model.graph();
        let assembly = model.assemble(&graph)?;
        let equations = assembly.equations_in(variables)?;
        let entries = assembly.placed(compiled(&equations, &equations.mass_matrix().entries()))?;
        let transform = match variables.has_momenta() {
            true => Some(assembly.legendre_transform(variables)?),
            false => None,
        };
        Ok(MassMatrix { entries, transform, size: equations.mass_matrix().rows() })
    }
}

/// `values` as functions of t, (x, η) and the parameters.
fn compiled<'g>(equations: &Equations<'g>, values: &[Expr<'g>]) -> Result<Evaluator, MechError> {
    let system = equations.system();
    let inputs = Inputs {
        time: Some(system.frame().time()),
        state: system.state(),
        parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
    };
    Ok(Evaluator::new(Program::new(system.graph(), &inputs, values)?, Backend::Interpreter))
}

/// The values at (t, state), which have to be numbers.
pub(crate) fn evaluate(
    program: &mut Evaluator,
    (t, state, parameters): (f64, &[f64], &[f64]),
    values: &mut [f64],
) -> Result<(), Error> {
    program.eval(t, state, parameters, values);
    if values.iter().all(|value| value.is_finite()) {
        return Ok(());
    }
    Err(MechError::from(program.blame(t, state, parameters)).into())
}

/// (x, η) of a state that may have momenta.
pub(crate) fn read(
    transform: Option<&mut LegendreTransform>,
    t: f64,
    y: &[f64],
    parameters: &[f64],
) -> Result<Vec<f64>, Error> {
    let Some(transform) = transform else { return Ok(y.to_vec()) };
    transform.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
    let mut state = vec![0.0; y.len()];
    transform.to_quasi_velocities_in(t, y, &mut state)?;
    Ok(state)
}

/// (f, g) as a function of t and (x, η), η those of the state.
pub(crate) fn bracket(model: &Model, variables: Variables, f: &str, g: &str) -> Result<Evaluator, Error> {
    let unsupported = |why| Error::Unsupported { what: "a bracket", why };
    if !variables.are_own() {
        return Err(unsupported(
            "the state has other variables than the model; use the form poincare or canonical",
        ));
    }
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    if assembly.constraints.nonlinear().is_some() {
        return Err(unsupported("a constraint is not affine in the velocities"));
    }
    let canonical = assembly.canonical_in(Variables::Momenta)?;
    assembly.placed(canonical.closed_quasi_velocities())?;
    let bracket = match assembly.placed(assembly.constraints.constrained(&assembly.at_start()))? {
        Some(constrained) => placed(&assembly, PoissonBracket::almost_poisson(&constrained))?,
        None => PoissonBracket::new(canonical.system()),
    };
    let free = assembly.quasi_velocities_of(canonical.system().quasi_velocities())?;
    let known: Vec<(Expr<'_>, Expr<'_>)> =
        assembly.system.quasi_velocities().iter().copied().zip(free).collect();
    let in_momenta = |text: &str| -> Result<Expr<'_>, Error> {
        let function = model.function(&assembly, text)?;
        Ok(canonical.in_momenta(graph.substitute(&[function], &known)[0]))
    };
    let value = placed(&assembly, bracket.of(in_momenta(f)?, in_momenta(g)?))?;
    let momenta = canonical.momenta().iter().copied().zip(canonical.momenta_of_velocities().iter().copied());
    let value = graph.substitute(&[value], &momenta.collect::<Vec<_>>())[0];
    let equations = assembly.equations_in(Variables::QuasiVelocities)?;
    Ok(assembly.placed(compiled(&equations, &[value]))?)
}

/// What came of an analysis, an error put at the place in the model that is to blame.
fn placed<T>(assembly: &Assembly<'_>, found: Result<T, AnalysisError>) -> Result<T, ModelError> {
    found.or_else(|error| match error {
        AnalysisError::Nonholo(error) => assembly.placed(Err(error)),
        AnalysisError::Mech(error) => assembly.placed(Err(error)),
        AnalysisError::Expr(error) => assembly.placed(Err(MechError::from(error))),
        other => Err(assembly.not_derived(other.to_string())),
    })
}
