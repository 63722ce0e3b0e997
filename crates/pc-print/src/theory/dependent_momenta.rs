//! The Hamiltonian of all momenta under nonholonomic constraints, equation (31).

use pc_analysis::{AnalysisError, DependentMomenta};
use pc_mech::Style;

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side, Verdict};

/// The largest number of momenta.
const MOST_MOMENTA: usize = 8;
/// The greatest length of the Hamiltonian, counted in operations of the written-out expression.
const LONGEST: u32 = 400;

/// The section on ∂H/∂y_α = 0 and ẋ_i = b_is ∂H/∂y_s + b_i0.
pub(crate) fn section<'g>(ground: &Basis<'_, 'g>) -> Result<Section<'g>, AnalysisError> {
    let section = |entries| Section {
        key: "dependent_momenta",
        title: "Dependent momenta",
        names: Vec::new(),
        entries,
    };
    let small = ground.constrained.as_ref().filter(|constrained| {
        let system = constrained.system();
        system.quasi_velocities().len() <= MOST_MOMENTA && system.lagrangian().tree_cost() <= LONGEST
    });
    let Some(constrained) = small else { return Ok(section(Vec::new())) };
    let found = DependentMomenta::of(constrained)?;
    let Some(found) = found.filter(|found| found.hamiltonian.tree_cost() <= LONGEST) else {
        return Ok(section(Vec::new()));
    };
    let mut entries = vec![Entry::formula(Side::letter("H"), Side::of(found.hamiltonian))];
    let verdict = if found.are_proved { Verdict::Proved } else { Verdict::Open };
    for (&(y, slope), &(_, value)) in found.conditions.iter().zip(&found.values) {
        entries.push(Entry::formula(Side::slope("H", y), Side::of(slope)));
        entries.push(
            Entry::formula(Side::of(y), Side::of(value))
                .with(verdict)
                .say(format!("from ∂H/∂{} = 0, the constraint", y.display(Style::Book))),
        );
    }
    if !constrained.system().frame().coordinates().is_empty() {
        let rates = Entry::words("x' = b ∂H/∂y + b_0 over the independent y, with these values (31)");
        entries.push(rates.with(verdict));
    }
    Ok(section(entries))
}
