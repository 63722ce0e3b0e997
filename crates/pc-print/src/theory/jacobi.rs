//! Jacobi's theorem: the motion of the model from a complete integral.

use pc_analysis::{BranchEnd, CompleteIntegral, JacobiMotion, MotionAgreement, ProposedAction};
use pc_mech::{Canonical, Expr, Style};

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Side};
use crate::words::words::{short, small};

/// Constants that differ by this fraction are the same.
const SAME: f64 = 1e-9;
/// The time for which a motion is compared if the model does not say how long it runs.
pub(crate) const USUAL_TIME: f64 = 10.0;
/// Smaller differences, and smaller values of constants, are rounding errors.
const ROUNDING: f64 = 1e-14;
/// The largest difference that rounding errors of a motion leave.
const AGREES: f64 = 1e-6;

/// The entries on ∂S/∂α_s = β_s, with the constants of the start and a comparison of the motion; none if S is no complete integral.
pub(crate) fn entries<'g>(
    ground: &Basis<'_, 'g>,
    canonical: &Canonical<'g>,
    checked: &ProposedAction<'g>,
    constants: &[(Expr<'g>, f64)],
) -> Vec<Entry<'g>> {
    let Ok(integral) = checked.integral(canonical) else { return Vec::new() };
    let conjugate =
        |(&(alpha, _), &value): (&(Expr<'g>, f64), &Expr<'g>)| (Side::slope("S", alpha), Side::of(value));
    let formulas = constants.iter().zip(integral.conjugates()).map(conjugate);
    let theorem = Entry { formulas: formulas.collect(), ..Entry::default() }
        .named("Jacobi's theorem")
        .say("each of these is a constant β of the motion");
    let theorem = with_motion(ground, canonical, &integral, constants, theorem);
    [theorem].into_iter().chain(explicit(canonical, &integral, constants)).collect()
}

/// The entry with the constants of the motion through the start, and how it agrees with that of the equations.
fn with_motion<'g>(
    ground: &Basis<'_, 'g>,
    canonical: &Canonical<'g>,
    integral: &CompleteIntegral<'g>,
    constants: &[(Expr<'g>, f64)],
    mut entry: Entry<'g>,
) -> Entry<'g> {
    let (assembly, system) = (ground.assembly, canonical.system());
    let (t, t_end) = (assembly.t_start, ground.t_end.unwrap_or(assembly.t_start + USUAL_TIME));
    let x = assembly.start_of(system.frame().coordinates());
    let momenta = system.graph().evaluate(canonical.momenta_of_velocities(), &ground.near.centre);
    let Ok(y) = momenta else { return entry };
    let given: Vec<f64> = constants.iter().map(|&(_, value)| value).collect();
    let of_text = || {
        let given = constants
            .iter()
            .map(|&(alpha, value)| format!("{} = {}", alpha.display(Style::Book), short(value, 6)));
        given.collect::<Vec<_>>().join(", ")
    };
    let through = integral.motion_after(canonical, (t, t_end), (&x, &y), &given);
    let (mut motion, whose) = match through {
        Ok(motion) if are_same(motion.alpha(), &given) => {
            (motion, "the constants are those of the start".to_owned())
        }
        Ok(motion) => {
            let whose = format!("the constants are those of the start, not {} as in the text", of_text());
            (motion, whose)
        }
        Err(error) => {
            entry = entry.say(format!("no constants of the start are found: {error}"));
            match integral.motion_from(t, &x, &given) {
                Ok(motion) => (
                    motion,
                    "the motion is that of the text's constants from the position of the start".to_owned(),
                ),
                Err(_) => return entry,
            }
        }
    };
    let clean = |value: f64| if value.abs() <= ROUNDING { 0.0 } else { value };
    let alpha =
        constants.iter().zip(motion.alpha()).map(|(&(alpha, _), &value)| (alpha.to_string(), clean(value)));
    let beta =
        constants.iter().zip(motion.beta()).map(|(&(alpha, _), &value)| (beta_of(alpha), clean(value)));
    entry.values = alpha.chain(beta).collect();
    entry = entry.say(whose);
    match motion.agreement(canonical, t_end) {
        Ok(agreement) => entry.say(in_words(&motion, &agreement)),
        Err(_) => entry,
    }
}

/// The agreement of the two motions in words.
fn in_words(motion: &JacobiMotion<'_>, agreement: &MotionAgreement) -> String {
    let end = match agreement.end {
        None => "",
        Some(BranchEnd::TurningPoint) => ", a turning point, where the branch of S ends",
        Some(BranchEnd::Cut) => ", where the branch of S ends",
    };
    let span = span_in_words((motion.start_time(), agreement.until)) + end;
    match agreement.deviation {
        Some(rest) if rest <= AGREES => {
            format!("agrees with the motion of (10), (11) within {}, {span}", bound(rest))
        }
        Some(rest) => format!("differs from the motion of (10), (11) by {}, {span}", small(rest)),
        None => format!("not compared with the motion of (10), (11); followed {span}"),
    }
}

/// The power of ten above a difference, and above rounding errors, which are not the same on all machines.
pub(crate) fn bound(difference: f64) -> String {
    format!("1e{}", difference.max(ROUNDING).log10().ceil())
}

/// A span of time in words.
pub(crate) fn span_in_words((from, to): (f64, f64)) -> String {
    format!("from t = {} to {}", short(from, 4), short(to, 4))
}

/// x as a function of t, α and β, where it is found in closed form.
fn explicit<'g>(
    canonical: &Canonical<'g>,
    integral: &CompleteIntegral<'g>,
    constants: &[(Expr<'g>, f64)],
) -> Option<Entry<'g>> {
    let system = canonical.system();
    let (graph, taken) = (system.graph(), system.symbols());
    let betas: Vec<Expr<'g>> = constants.iter().map(|&(alpha, _)| graph.symbol(&beta_of(alpha))).collect();
    if betas.iter().any(|beta| taken.contains(beta)) {
        return None;
    }
    let positions = integral.positions(canonical, &betas)?;
    let x = system.frame().coordinates().iter().copied().map(Side::of);
    let formulas = x.zip(positions.into_iter().map(Side::of)).collect();
    Some(Entry { formulas, ..Entry::default() }.named("the motion"))
}

fn are_same(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * (a.abs() + b.abs()))
}

/// The name of the constant β that belongs to α.
fn beta_of(alpha: Expr<'_>) -> String {
    format!("β_{alpha}")
}
