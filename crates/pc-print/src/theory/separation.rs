//! Actions by separation: all coordinates but one are cyclic.

use pc_analysis::SeparatedAction;
use pc_mech::{Canonical, Expr, Style};

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Side, Verdict};
use crate::theory::jacobi::{USUAL_TIME, bound, span_in_words};

/// The greatest length of the Hamiltonian, counted in operations of the written-out expression.
const LONGEST: u32 = 400;

/// The entry on S = −E t + Σ p_i x_i + ∫ p dx, if H depends on one coordinate only.
pub(crate) fn entry<'g>(ground: &Basis<'_, 'g>, canonical: &Canonical<'g>) -> Option<Entry<'g>> {
    let (assembly, system) = (ground.assembly, canonical.system());
    if !ground.is_unbound() || ground.has_external_forces() || canonical.hamiltonian().tree_cost() > LONGEST {
        return None;
    }
    let y = canonical.momenta();
    let values = system.graph().evaluate(canonical.momenta_of_velocities(), &ground.near.centre).ok()?;
    let momenta = y.iter().copied().zip(values.iter().copied());
    let at: Vec<(Expr<'g>, f64)> = assembly.at_start().into_iter().chain(momenta).collect();
    let action = SeparatedAction::of(canonical, &at).ok()??;
    let (place, x) = (action.coordinate(), system.frame().coordinates());
    let cyclic: Vec<usize> = (0..y.len()).filter(|&i| i != place).collect();
    let name = |e: Expr<'g>| e.display(Style::Book);
    let [e, p, moving] = [action.energy(), y[place], x[place]].map(name);
    let linear: String = cyclic.iter().map(|&i| format!(" + {} {}", name(y[i]), name(x[i]))).collect();
    let mut entry = Entry::formula(Side::of(y[place]), Side::of(action.momentum()))
        .named("action by separation")
        .with(Verdict::of(action.identity()))
        .say(format!("S = -{e} t{linear} + ∫ {p} d{moving}"));
    let constants = [(action.energy().to_string(), action.value())].into_iter();
    entry.values = constants.chain(cyclic.iter().map(|&i| (y[i].to_string(), values[i]))).collect();
    let of_cyclic = cyclic.iter().map(|&i| format!(", {} + ∫ ∂{p}/∂{} d{moving}", name(x[i]), name(y[i])));
    let conjugates = format!("∫ ∂{p}/∂{e} d{moving} - t{}", of_cyclic.collect::<String>());
    let t_end = ground.t_end.unwrap_or(assembly.t_start + USUAL_TIME);
    let agreement = action.agreement(canonical, t_end).ok()?;
    let kept = agreement.deviation.map_or_else(String::new, |rest| {
        let end = if agreement.end.is_some() { ", a turning point" } else { "" };
        format!(" within {}, {}{end}", bound(rest), span_in_words((assembly.t_start, agreement.until)))
    });
    let stay = if cyclic.is_empty() { "stays" } else { "stay" };
    Some(entry.say(format!("Jacobi's theorem: {conjugates} {stay} constant along the motion{kept}")))
}
