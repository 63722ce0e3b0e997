//! What must agree: forms of one model, a model and its motion in ordinary velocities, claims and numbers.

use std::fmt;

use num_dual::Dual64;
use pc_verify::{Unable, VerifyError};

use super::execution::{Execution, Happening, Motion, Refusal};
use super::expression::Expression;
use super::specimen::{Constraint, Frame, Restricts, Specimen};
use super::start::Start;
use super::text::SHOWN;

/// Relative to a number or to 1: some hundred times the tolerance of the integration, which has a few dozen steps.
const TOLERANCE: f64 = 1e-9;

/// How much larger the error of a motion may be than what tolerances a hundred times as large change in it: over a corner, the
/// error of a step of high order depends on where in it the corner falls, more than on the tolerance.
const GROWTH: f64 = 10.0;

/// A column that looser tolerances change by so much, relative to its size or to 1, is not resolved and judges nothing.
const RESOLVED: f64 = 1e-5;

/// A column that looser tolerances change by so much, though not that of the same motion in another form, is noise.
const NOISE: f64 = 1e-3;

/// An event is located on the computed motion, which passes its zero at an angle of some hundredths at least.
const SAME_TIME: f64 = 1e-8;

/// An integral, or the energy.
const NOT_KEPT: &str = "claimed to be kept, but changes";

/// A finding: something that must agree does not, or a panic.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What is wrong, the same for all instances.
    pub kind: &'static str,
    /// Where, and both values.
    pub detail: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.kind, self.detail)
    }
}

/// Whether a difference is larger than it may be, or no number.
pub(super) fn exceeds(difference: f64, allowed: f64) -> bool {
    difference.is_nan() || difference.abs() > allowed
}

fn finding(kind: &'static str, detail: String) -> Finding {
    Finding { kind, detail }
}

/// What does not agree between the forms of one model, nor with what is claimed of it.
pub fn of_forms(execution: &Execution) -> Vec<Finding> {
    let mut findings = Vec::new();
    let motion = &execution.motion;
    findings.extend(second(execution));
    let forms = [
        ("canonical form differs", &execution.canonical, None),
        ("projected motion differs", &execution.projected, Some("energy")),
    ];
    for (kind, other, held) in forms {
        if let Some(Ok(other)) = other {
            let same = |name: &str| Some(name.to_owned());
            findings.extend(compare(kind, motion, other, same, held));
        }
    }
    if execution.keeps_energy {
        findings.extend(drift(NOT_KEPT, "energy", motion));
    }
    if let Some((name, residual)) = &motion.residual
        && exceeds(*residual, TOLERANCE)
    {
        findings.push(finding("constraint violated", format!("{name} by {residual:e}")));
    }
    findings
}

/// Everything that does not agree within one model.
pub fn within(specimen: &Specimen, start: &Start, execution: &Execution) -> Vec<Finding> {
    let mut findings = of_forms(execution);
    let motion = &execution.motion;
    let integrals = execution.conserved.iter().flatten();
    let jumps = specimen.events.iter().any(|event| !event.reset.is_empty());
    for name in integrals.filter(|_| !jumps) {
        findings.extend(drift(NOT_KEPT, name, motion));
    }
    if is_conservative(specimen) && !jumps {
        findings.extend(drift("energy must be kept, but changes", "energy", motion));
    }
    for happening in &motion.happenings {
        findings.extend(is_crossing(specimen, happening));
        if specimen.constraints.is_empty() {
            findings.extend(is_reset(specimen, start, motion, happening));
        }
    }
    findings
}

/// What a second derivation does not agree with.
pub fn second(execution: &Execution) -> Option<Finding> {
    match &execution.second {
        Some(Err(VerifyError::Disagreement(disagreement))) => {
            Some(finding("second derivation disagrees", disagreement.to_string()))
        }
        Some(Err(VerifyError::Unable(Unable::NoBrackets))) => {
            Some(finding("second derivation has no brackets", "the first takes some".to_owned()))
        }
        Some(_) | None => None,
    }
}

/// What does not agree between a model and its twin in ordinary velocities.
pub fn between(specimen: &Specimen, start: &Start, model: &Execution, twin: &Execution) -> Option<Finding> {
    let eta = specimen.quasi_velocities();
    let carried: Vec<&str> = specimen.carried.iter().map(|carried| carried.name.as_str()).collect();
    // y·η − L and p·ẋ − L are the same where ẋ is linear in η. A constraint beside definitions is one more of these.
    // Nor is it the same where a force has a force function only on the surface that carried coordinates keep.
    let is_forced = specimen.bodies.iter().any(|body| body.force.is_some());
    let drifts = specimen.has_drift()
        || is_forced && !specimen.carried.is_empty()
        || is_defined(specimen)
            && specimen.constraints.iter().any(|constraint| {
                constraint.restricts == Restricts::Velocities && !is_homogeneous(specimen, constraint)
            });
    let name_in_twin = |name: &str| match name {
        "energy" => (!drifts).then(|| name.to_owned()),
        // Which of several that follow from each other is dropped is a choice.
        reaction if ["λ_", "F_", "N_"].iter().any(|of| reaction.starts_with(of)) => {
            (!start.redundant).then(|| name.to_owned())
        }
        integral if integral.starts_with("i_") => None,
        name if carried.contains(&name) || eta.iter().any(|eta| eta == name) => {
            Some(format!("{SHOWN}{name}"))
        }
        name => Some(name.to_owned()),
    };
    compare("motion in ordinary velocities differs", &model.motion, &twin.motion, name_in_twin, None)
}

/// Whether brackets that the frame of a specimen does not determine must be given, and are not.
pub fn is_undetermined(specimen: &Specimen) -> bool {
    specimen.algebra.is_none() && super::determined::dependent_over_constants(specimen)
}

fn same_events(a: &Motion, b: &Motion) -> bool {
    a.happenings.len() == b.happenings.len()
        && a.times.len() == b.times.len()
        && a.happenings.iter().zip(&b.happenings).all(|(a, b)| a.event == b.event)
}

/// The size of a column, at least 1.
pub(super) fn size(motion: &Motion, column: usize) -> f64 {
    motion.rows.iter().fold(1.0, |size, row| f64::max(size, row[column].abs()))
}

/// How far looser tolerances move a number: none where it is so far that it judges nothing.
pub(super) fn resolved(motion: &Motion, row: usize, column: usize) -> Option<f64> {
    let moved = motion.moved.as_ref()?.rows[row][column];
    (moved <= RESOLVED * size(motion, column)).then_some(moved)
}

/// How far a number may be off: none where it is not resolved.
fn allowance(motion: &Motion, row: usize, column: usize) -> Option<f64> {
    resolved(motion, row, column).map(|moved| TOLERANCE * size(motion, column) + GROWTH * moved)
}

/// Whether looser tolerances move the last row of a column beyond use, though not that of the other motion.
fn is_noise(motion: &Motion, column: usize, other: &Motion, other_column: usize) -> Option<f64> {
    let last = |motion: &Motion, column: usize| {
        motion.moved.as_ref()?.rows.last().map(|row| row[column] / size(motion, column))
    };
    let (here, there) = (last(motion, column)?, last(other, other_column)?);
    (exceeds(here, NOISE) && there <= TOLERANCE).then_some(here)
}

/// `held` is the column that the other motion has at its start value whatever its tolerances are: that it is not moved there
/// does not say that it is resolved, nor that it is noise here.
pub(super) fn compare(
    kind: &'static str,
    motion: &Motion,
    other: &Motion,
    name_in_other: impl Fn(&str) -> Option<String>,
    held: Option<&str>,
) -> Option<Finding> {
    let said = |motion: &Motion| -> String {
        let said = motion.happenings.iter().map(|h| format!("{} at {}", h.event, h.time));
        said.collect::<Vec<_>>().join(", ")
    };
    let (Some(moved), Some(moved_other)) = (&motion.moved, &other.moved) else { return None };
    if !same_events(motion, other) {
        return Some(finding(kind, format!("events: {}; not: {}", said(other), said(motion))));
    }
    for (i, (a, b)) in motion.happenings.iter().zip(&other.happenings).enumerate() {
        let moved = moved.happenings[i] + moved_other.happenings[i];
        let allowed = SAME_TIME * a.time.abs().max(1.0) + GROWTH * moved;
        if exceeds(a.time - b.time, allowed) {
            return Some(finding(kind, format!("{} occurs at {}, not at {}", a.event, b.time, a.time)));
        }
    }
    for (j, name) in motion.columns.iter().enumerate() {
        let Some(wanted) = name_in_other(name) else { continue };
        let Some(k) = other.columns.iter().position(|name| *name == wanted) else {
            return Some(finding(kind, format!("there is no column {wanted}")));
        };
        if held != Some(name.as_str())
            && let Some(noise) = is_noise(motion, j, other, k)
        {
            return Some(finding(
                kind,
                format!("tolerances move {name} by {noise:.0e} of its size, but not there"),
            ));
        }
        let rows = motion.times.iter().zip(&motion.rows).zip(&other.rows).enumerate();
        for (i, ((t, row), other_row)) in rows {
            let (a, b) = (row[j], other_row[k]);
            let (Some(here), Some(there)) = (allowance(motion, i, j), allowance(other, i, k)) else { break };
            let allowed = here + there;
            if exceeds(a - b, allowed) && !(a.is_nan() && b.is_nan()) {
                let t = t - motion.times[0];
                return Some(finding(
                    kind,
                    format!("{name} is {b:?}, not {a:?}, {t} after the start; {allowed:.0e} allowed"),
                ));
            }
        }
    }
    None
}

fn drift(kind: &'static str, name: &str, motion: &Motion) -> Option<Finding> {
    let column = motion.columns.iter().position(|column| column == name)?;
    let allowed = allowance(motion, motion.rows.len().checked_sub(1)?, column)?;
    let first = motion.rows.first()?[column];
    let last = motion.rows.iter().map(|row| row[column]).find(|value| exceeds(value - first, allowed))?;
    Some(finding(kind, format!("{name} from {first:?} to {last:?}; {allowed:.0e} allowed")))
}

/// Whether the motion keeps its energy by construction: nothing depends on time, constraints are homogeneous, and there are
/// only potential forces.
fn is_conservative(specimen: &Specimen) -> bool {
    let mut specimen = specimen.clone();
    let acts = !specimen.forces.is_empty()
        || !specimen.states.is_empty()
        || !specimen.inputs.is_empty()
        || !specimen.dissipation.is_empty()
        || specimen.bodies.iter().any(|body| body.force.is_some());
    let drifts = specimen.has_drift();
    let restricts = specimen.constraints.iter().all(|constraint| match constraint.restricts {
        Restricts::Positions => true,
        Restricts::Velocities | Restricts::Nonlinearly => is_homogeneous(&specimen, constraint),
    });
    let moving = specimen.expressions_mut().iter().any(|expression| expression.mentions("t"));
    let group_moves = match &specimen.frame {
        Frame::Group { velocities, .. } => velocities.iter().any(|row| row.mentions("t")),
        _ => false,
    };
    !acts && !drifts && restricts && !moving && !group_moves
}

/// Whether quasi-velocities are defined by `is`.
fn is_defined(specimen: &Specimen) -> bool {
    match &specimen.frame {
        Frame::Velocities | Frame::Group { .. } => false,
        Frame::Triangular(frame) => frame.by_definitions,
        Frame::Definitions(_) => true,
    }
}

/// Whether a constraint of velocities is linear in them.
fn is_homogeneous(specimen: &Specimen, constraint: &Constraint) -> bool {
    let zero = |name: String| (name, Expression::Number(0.0));
    let mut rest: Vec<_> = specimen.chart.iter().map(super::specimen::at_rest).collect();
    rest.extend(specimen.quasi_velocities().into_iter().map(zero));
    constraint.restricts == Restricts::Velocities && constraint.expression.substitute(&rest).is_zero()
}

/// Whether the function of an event passes through zero in its direction where the event occurs.
fn is_crossing(specimen: &Specimen, happening: &Happening) -> Option<Finding> {
    let [before, after] = happening.sides;
    let steep = (after - before).abs() > 1e-9;
    let event = specimen.events.iter().find(|event| event.name == happening.event)?;
    let right = match event.direction {
        "rising" => before < 0.0 && after > 0.0,
        "falling" => before > 0.0 && after < 0.0,
        _ => before * after < 0.0,
    };
    (steep && !right).then(|| {
        let (name, t) = (&happening.event, happening.time);
        finding("event without a zero", format!("{name} at {t}: {before:e} before, {after:e} after"))
    })
}

/// Whether the state after an event is that of the formulas of its reset.
fn is_reset(specimen: &Specimen, start: &Start, motion: &Motion, happening: &Happening) -> Option<Finding> {
    let event = specimen.events.iter().find(|event| event.name == happening.event)?;
    let mut values = start.values.clone();
    for (name, &value) in motion.columns.iter().zip(&happening.before) {
        values.insert(name.clone(), Dual64::from(value));
    }
    values.insert("t".to_owned(), Dual64::from(happening.time));
    for (name, formula) in &event.reset {
        let expected = formula.value(&values).re;
        let column = motion.columns.iter().position(|column| column == name)?;
        let found = happening.after[column];
        if exceeds(found - expected, 1e-12 * expected.abs().max(1.0)) && expected.is_finite() {
            let t = happening.time;
            return Some(finding(
                "reset by another formula",
                format!("{name} is {found:?}, not {expected:?}, after {} at {t}", event.name),
            ));
        }
    }
    None
}

/// The refusals of an execution in forms that may be refused alone.
pub fn refusals(execution: &Execution) -> Vec<Refusal> {
    let motions = [&execution.canonical, &execution.projected];
    let mut refusals: Vec<Refusal> =
        motions.into_iter().flatten().filter_map(|motion| motion.as_ref().err()).cloned().collect();
    refusals.extend(execution.conserved.as_ref().err().cloned());
    if let Some(Err(refusal)) = &execution.emitted {
        refusals.push(refusal.clone());
    }
    if let (Some(Err(error)), None) = (&execution.second, second(execution)) {
        refusals.push(Refusal { stage: "second derivation", message: error.to_string() });
    }
    refusals
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::execution::Moved;

    /// Two rows of x and the energy that looser tolerances move by so much at the end.
    fn motion(moved: [f64; 2], end: [f64; 2]) -> Motion {
        Motion {
            columns: vec!["x".to_owned(), "energy".to_owned()],
            times: vec![0.0, 1.0],
            rows: vec![vec![0.5, 0.9], end.to_vec()],
            happenings: Vec::new(),
            moved: Some(Moved { rows: vec![vec![0.0; 2], moved.to_vec()], happenings: Vec::new() }),
            residual: None,
        }
    }

    /// Near a singular place energies are lost, which a projection keeps, whatever it makes of the rest.
    #[test]
    fn projected_components_do_not_measure_noise() {
        let (free, held) = (motion([1e-9, 0.3], [0.7, 1.2]), motion([1e-9, 0.0], [0.7, 0.9]));
        let compared = |held_name| compare("differs", &free, &held, |name| Some(name.to_owned()), held_name);
        assert_eq!(compared(Some("energy")), None);
        assert!(compared(None).is_some_and(|finding| finding.detail.contains("tolerances move energy")));
    }

    /// Of a column that is resolved in both the values are compared, held or not; noise in any other column is one.
    #[test]
    fn a_projection_to_a_wrong_state_is_found() {
        let (free, held) = (motion([1e-12, 1e-12], [0.7, 0.9]), motion([1e-12, 0.0], [0.7, 0.91]));
        let compared = |a, b| compare("differs", a, b, |name| Some(name.to_owned()), Some("energy"));
        assert!(compared(&free, &held).is_some_and(|finding| finding.detail.contains("energy is 0.91")));
        let (noisy, held) = (motion([0.3, 1e-12], [0.7, 0.9]), motion([0.0, 0.0], [0.7, 0.9]));
        assert!(compared(&noisy, &held).is_some_and(|finding| finding.detail.contains("tolerances move x")));
    }
}
