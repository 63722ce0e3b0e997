//! The Hamilton–Jacobi equation, and what is found about an action that the text gives.

use pc_analysis::{AnalysisError, Orbit, PoissonBracket, ProposedAction};
use pc_mech::{Canonical, Expr, Identity};

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side, Verdict};
use crate::theory::{jacobi, separation};
use crate::words::words::{short, small};

/// A relation holds at the start if no more than this is left of it.
const NO_MORE_THAN_ROUNDING: f64 = 1e-12;

/// The section on X_0 S + H(t, x, X_s S) = 0 and the action of the model.
pub(crate) fn section<'g>(ground: &Basis<'_, 'g>) -> Section<'g> {
    let section =
        |entries| Section { key: "hamilton_jacobi", title: "Hamilton–Jacobi", names: Vec::new(), entries };
    let action = ground.assembly.action.as_ref();
    let refused = |why: String| match action {
        Some(_) => section(vec![Entry::words(why).with_on("the action", Verdict::Open)]),
        None => section(Vec::new()),
    };
    if !ground.is_holonomic() {
        return refused("the theorem requires holonomic constraints".to_owned());
    }
    let canonical = match &ground.canonical {
        Ok(canonical) => canonical,
        Err(why) => return refused(why.clone()),
    };
    if ground.free.frame().coordinates().is_empty() {
        return refused("there are no coordinates on which an action could depend".to_owned());
    }
    // With multipliers, H of the independent momenta is seldom short enough to be read.
    let mut entries = if ground.is_unbound() || action.is_some() { equation(ground) } else { Vec::new() };
    entries.extend(separation::entry(ground, canonical));
    let Some(action) = action else { return section(entries) };
    let constants: Vec<Expr<'_>> = action.constants.iter().map(|&(constant, _)| constant).collect();
    let mut near = ground.near.clone();
    near.centre.extend(action.constants.iter().copied());
    let said = Entry::formula(Side::letter("S"), Side::of(action.value)).named("action");
    let orbit = orbit(ground);
    let checked = orbit.as_ref().map_err(ToString::to_string).and_then(|orbit| {
        ProposedAction::check_on(canonical, action.value, &constants, (orbit, &near))
            .map_err(|error| error.to_string())
    });
    let (orbit, checked) = match (orbit, checked) {
        (Ok(orbit), Ok(checked)) => (orbit, checked),
        (_, checked) => {
            let why = checked.err().unwrap_or_default();
            entries.push(said.with(Verdict::Open).say(why));
            return section(entries);
        }
    };
    let size = orbit.dimension();
    let complete = match checked.rank {
        rank if rank == size => format!("complete: ∂(X_s S)/∂α has rank {rank} of {size}"),
        rank => format!("not complete: ∂(X_s S)/∂α has rank {rank} of {size}"),
    };
    let mut said = said.with(Verdict::of(checked.identity));
    said.words = residual(&checked);
    if !matches!(checked.identity, Identity::Proved) {
        let left = Side::symbol(
            "X_0 S + H",
            "X_0 S + H",
            "<msub><mi>X</mi><mn>0</mn></msub><mspace width=\"0.17em\"/><mi>S</mi><mo>+</mo><mi>H</mi>",
        );
        said.formulas.push((left, Side::of(checked.remainder)));
    }
    entries.push(said.say(complete));
    entries.extend(on_orbit(ground, canonical, &orbit));
    entries.extend(jacobi::entries(ground, canonical, &checked, &action.constants));
    section(entries)
}

/// The orbit of the frame through the start, given by conditions on positions, integrals of the text or Casimirs.
fn orbit<'g>(ground: &Basis<'_, 'g>) -> Result<Orbit<'g>, AnalysisError> {
    let system = &ground.free;
    let of_text = ground.assembly.held_positions().into_iter().chain(system.integrals().iter().cloned());
    let mut functions: Vec<Expr<'g>> = of_text.map(|(_, f)| f).collect();
    if let Ok(orbit) = Orbit::through(system, &functions, &ground.near.centre) {
        return Ok(orbit);
    }
    functions.extend(PoissonBracket::new(system).casimirs(2));
    Orbit::through(system, &functions, &ground.near.centre)
}

/// The orbit to which the action is restricted, and the relations of the momenta y_s = X_s S on it.
fn on_orbit<'g>(ground: &Basis<'_, 'g>, canonical: &Canonical<'g>, orbit: &Orbit<'g>) -> Vec<Entry<'g>> {
    let of_invariant = |&(f, c): &(Expr<'g>, f64)| (Side::of(f), Side::of(Expr::from(c)));
    let mut entries = Vec::new();
    if !orbit.invariants().is_empty() {
        let formulas = orbit.invariants().iter().map(of_invariant).collect();
        entries.push(Entry { formulas, ..Entry::default() }.named("on the orbit"));
    }
    let graph = ground.free.graph();
    let known: Vec<_> =
        canonical.momenta().iter().copied().zip(canonical.momenta_of_velocities().iter().copied()).collect();
    for relation in Orbit::relations(&ground.free) {
        let at_start = graph.evaluate(&graph.substitute(&[relation], &known), &ground.near.centre);
        let value = at_start.map_or(f64::NAN, |values| values[0]);
        let zero = Side::symbol("0", "0", "<mn>0</mn>");
        let start = match value.abs() <= NO_MORE_THAN_ROUNDING {
            true => "as at the start".to_owned(),
            false => format!("at the start it is {}", short(value, 6)),
        };
        let entry = Entry::formula(Side::of(relation), zero).named("the motions of S");
        entries.push(entry.say(format!("for y_s = X_s S, since X_1, …, X_k are dependent; {start}")));
    }
    entries
}

/// The residual in words, if the action is not proved.
fn residual(checked: &ProposedAction<'_>) -> Vec<String> {
    match (checked.identity, &checked.refuted) {
        (Identity::Proved, _) => Vec::new(),
        (Identity::Open { rest }, _) if rest.is_finite() => {
            vec![format!("agrees in numbers to {}, not proved", small(rest))]
        }
        (Identity::Open { .. }, _) => vec!["it has no values near the start and the constants".to_owned()],
        (Identity::Disproved { .. }, None) => vec!["refuted by numbers".to_owned()],
        (Identity::Disproved { .. }, Some(residual)) => {
            let at = residual.at.iter().map(|(name, value)| format!("{name} = {}", short(*value, 6)));
            let at: Vec<String> = at.collect();
            vec![format!("refuted: X_0 S + H is {} at {}", short(residual.value, 6), at.join(", "))]
        }
    }
}

/// The equation, in which X_s S is written as a symbol: `S_` followed by the name of the coordinate or
/// quasi-velocity.
fn equation<'g>(ground: &Basis<'_, 'g>) -> Vec<Entry<'g>> {
    let (Ok(canonical), system) = (&ground.canonical, &ground.free) else { return Vec::new() };
    if system.forces().iter().any(|q| !q.is_zero()) {
        return Vec::new();
    }
    let (graph, frame) = (system.graph(), system.frame());
    let slope = |name: String| graph.symbol(&format!("S_{}", name.trim_end_matches('\'')));
    let slopes: Vec<_> = canonical
        .momenta()
        .iter()
        .zip(system.quasi_velocities())
        .map(|(&y, eta)| (y, slope(eta.to_string())))
        .collect();
    let of_time = slope(frame.time().to_string());
    let known = system.symbols();
    if slopes.iter().any(|(_, s)| known.contains(s)) || known.contains(&of_time) {
        return Vec::new();
    }
    let left = of_time + graph.substitute(&[canonical.hamiltonian()], &slopes)[0];
    let is_lagrange = frame.velocities(system.quasi_velocities()) == system.quasi_velocities();
    let words = if is_lagrange { "S_x is ∂S/∂x" } else { "S_η is X_η S, S_t is X_0 S" };
    vec![Entry::formula(Side::of(left), Side::symbol("0", "0", "<mn>0</mn>")).say(words)]
}
