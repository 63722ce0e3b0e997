//! The Hamilton–Jacobi equation, and what is found about an action that the text gives.

use pc_analysis::ProposedAction;
use pc_mech::{Expr, Identity};

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side, Verdict};
use crate::words::words::{short, small};

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
    let frame = ground.free.frame();
    let is_square = !frame.coordinates().is_empty() && frame.rank() == frame.operators();
    if !is_square {
        return refused("as many coordinates are needed as quasi-velocities".to_owned());
    }
    let mut entries = equation(ground);
    let Some(action) = action else { return section(entries) };
    let constants: Vec<Expr<'_>> = action.constants.iter().map(|&(constant, _)| constant).collect();
    let mut near = ground.near.clone();
    near.centre.extend(action.constants.iter().copied());
    let said = Entry::formula(Side::letter("S"), Side::of(action.value)).named("action");
    let checked = match ProposedAction::check(canonical, action.value, &constants, &near) {
        Ok(checked) => checked,
        Err(error) => {
            entries.push(said.with(Verdict::Open).say(error.to_string()));
            return section(entries);
        }
    };
    let size = canonical.momenta().len();
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
    section(entries)
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
