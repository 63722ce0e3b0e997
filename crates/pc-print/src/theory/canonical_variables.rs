//! Whether given functions are canonical variables.

use pc_analysis::{BracketViolation, PoissonBracket};
use pc_mech::{Canonical, Expr, Graph, Identity, Style};
use pc_model::{Model, ModelError};

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side, Verdict};
use crate::theory::options::TheoryOptions;

/// The section on the functions that are proposed as new coordinates and momenta.
///
/// # Errors
/// [`ModelError`] if a function cannot be read, or if the model has no Poisson bracket to compare with.
pub(crate) fn section<'g>(
    ground: &Basis<'_, 'g>,
    bracket: Option<&PoissonBracket<'g>>,
    model: &Model,
    options: &TheoryOptions,
) -> Result<Section<'g>, ModelError> {
    let section = |entries| Section {
        key: "canonical_variables",
        title: "Canonical variables",
        names: Vec::new(),
        entries,
    };
    let proposed = &options.canonical;
    if proposed.is_empty() {
        return Ok(section(Vec::new()));
    }
    let assembly = ground.assembly;
    let refused = |why: &str| assembly.not_derived(why.to_owned());
    if !proposed.len().is_multiple_of(2) {
        return Err(refused(ODD));
    }
    let canonical = ground.canonical.as_ref().map_err(|why| refused(why))?;
    let Some(bracket) = bracket.filter(|_| ground.constrained.is_none()) else {
        return Err(refused(NONHOLONOMIC));
    };
    let mut new = Vec::new();
    for (name, text) in proposed {
        let value = model.function_in(assembly, text, canonical.momenta())?;
        new.push((
            ground.free.graph().symbol(name),
            canonical.in_momenta(in_free(ground, canonical, value)?),
        ));
    }
    let values: Vec<Expr<'g>> = new.iter().map(|&(_, value)| value).collect();
    let (coordinates, momenta) = values.split_at(values.len() / 2);
    let found = ground.placed(bracket.canonical_variables(coordinates, momenta))?;
    let mut entries: Vec<Entry<'g>> =
        new.iter().map(|&(symbol, value)| Entry::formula(Side::of(symbol), Side::of(value))).collect();
    let violation = |violation: &BracketViolation<'g>| {
        let [f, g] = violation.pair.map(|place| new[place].0);
        let margin = ground.near.residual(bracket.graph(), &[vec![violation.value - violation.expected]]);
        let verdict = match Identity::of(margin) {
            Identity::Disproved { rest } => Verdict::Disproved { margin: rest },
            _ => Verdict::Open,
        };
        Entry::formula(Side::bracket(f, g), Side::of(violation.value))
            .with_on("canonical", verdict)
            .say(format!("should be {}", violation.expected.display(Style::Book)))
    };
    entries.extend(found.violations.iter().map(violation));
    if found.are_canonical() {
        let time = canonical.system().frame().time();
        let moves = values.iter().any(|f| f.depends_on(time));
        let rest = match found.are_complete {
            true => hamiltonian_in_words(bracket.graph(), found.multiplier, moves),
            false => format!("{} of {} pairs", values.len() / 2, bracket.rank() / 2),
        };
        let words = format!("{}; {rest}", brackets_in_words(found.multiplier));
        entries.push(Entry::words(words).with_on("canonical", Verdict::Proved));
    }
    Ok(section(entries))
}

/// The brackets of canonical variables.
fn brackets_in_words(multiplier: Expr<'_>) -> String {
    let factor = match multiplier == Expr::ONE {
        true => String::new(),
        false => format!("{} ", multiplier.display(Style::Book)),
    };
    format!("(X_i, Y_j) = {factor}δ_ij, all others zero")
}

/// The Hamiltonian c H of the new variables, with ∂F/∂t of a generating function F where they depend on time.
fn hamiltonian_in_words<'g>(graph: &'g Graph, multiplier: Expr<'g>, moves: bool) -> String {
    let of_time = if moves { " + ∂F/∂t" } else { "" };
    format!("the new Hamiltonian is K = {}{of_time}", (multiplier * graph.symbol("H")).display(Style::Book))
}

/// The function with dependent quasi-velocities replaced by the independent ones.
fn in_free<'g>(
    ground: &Basis<'_, 'g>,
    canonical: &Canonical<'g>,
    value: Expr<'g>,
) -> Result<Expr<'g>, ModelError> {
    let all = ground.assembly.system.quasi_velocities();
    let of_free = ground.assembly.quasi_velocities_of(canonical.system().quasi_velocities())?;
    let known: Vec<(Expr<'g>, Expr<'g>)> = all.iter().copied().zip(of_free).collect();
    Ok(ground.free.graph().substitute(&[value], &known)[0])
}

const ODD: &str = "new canonical variables are as many coordinates as momenta, the coordinates first";
const NONHOLONOMIC: &str =
    "under nonholonomic constraints the bracket is no Poisson bracket: there are no canonical variables";
