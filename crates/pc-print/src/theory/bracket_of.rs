//! The bracket of two functions of the state.

use pc_analysis::PoissonBracket;
use pc_mech::Expr;
use pc_model::{Assembly, Model, ModelError, Variables};

use crate::theory::basis::{NONLINEAR, placed};

/// The Poisson bracket (12) of two expressions in the coordinates and velocities of a model,
///
///   (f, g) = ∂g/∂y_s X_s f − ∂f/∂y_s X_s g + c_rs^m ∂f/∂y_s ∂g/∂y_r y_m,
///
/// where y_s = ∂L/∂η_s are the momenta. The bracket is returned as a function of time, coordinates and the
/// independent quasi-velocities. Under nonholonomic constraints it is the almost-Poisson bracket of the
/// independent momenta.
///
/// # Errors
/// [`ModelError`], located at the position in `f`, `g` or the model that rules out a bracket: the velocities have to be
/// functions of the momenta in closed form, and the constraints affine in the velocities.
pub fn bracket_of<'g>(
    model: &Model,
    assembly: &Assembly<'g>,
    f: &str,
    g: &str,
) -> Result<Expr<'g>, ModelError> {
    if assembly.constraints.nonlinear().is_some() {
        return Err(assembly.not_derived(NONLINEAR.to_owned()));
    }
    let graph = assembly.system.graph();
    let canonical = assembly.canonical_in(Variables::Momenta)?;
    assembly.placed(canonical.closed_quasi_velocities())?;
    let bracket = match assembly.placed(assembly.constraints.constrained(&assembly.at_start()))? {
        Some(constrained) => placed(assembly, PoissonBracket::almost_poisson(&constrained))?,
        None => PoissonBracket::new(canonical.system()),
    };
    let all = assembly.system.quasi_velocities();
    let of_free = assembly.quasi_velocities_of(canonical.system().quasi_velocities())?;
    let known: Vec<(Expr<'g>, Expr<'g>)> = all.iter().copied().zip(of_free).collect();
    let in_momenta = |text: &str| -> Result<Expr<'g>, ModelError> {
        let function = model.function(assembly, text)?;
        Ok(canonical.in_momenta(graph.substitute(&[function], &known)[0]))
    };
    let value = placed(assembly, bracket.of(in_momenta(f)?, in_momenta(g)?))?;
    let momenta = canonical.momenta().iter().copied().zip(canonical.momenta_of_velocities().iter().copied());
    Ok(graph.substitute(&[value], &momenta.collect::<Vec<_>>())[0])
}
