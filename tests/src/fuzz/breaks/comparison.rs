//! What the product makes of a specimen, against the integration here.

use pc_model::Variables;
use pc_solve::Method;

use super::product::{Product, Rows};
use super::reference::Reference;
use super::specimen::{ATOL, RTOL, Specimen};
use crate::fuzz::comparison::{Finding, exceeds};
use crate::fuzz::execution::Refusal;

/// Errors add up over the steps from one passage to the next, some ten of one-step methods, each of about the tolerance; a passage
/// is located on a polynomial of a lower order than the step.
const OF_ONE_STEP: f64 = 500.0;
/// Over hundreds of multistep methods, which begin at order 1 after each passage.
const OF_MULTISTEP: f64 = 2000.0;
/// Over thousands where the order is at most 5, with errors of one sign.
const OF_LOW_ORDER: f64 = 20_000.0;
/// Derivatives are not among what the steps are chosen by, or less so, and have the differences of second derivatives.
const OF_DERIVATIVES: f64 = 10.0;

/// The ways in which a motion is followed.
const WAYS: [(&str, Method, Variables); 6] = [
    ("auto", Method::Auto, Variables::QuasiVelocities),
    ("dop853", Method::Dop853, Variables::QuasiVelocities),
    ("adams", Method::Adams, Variables::QuasiVelocities),
    ("bdf", Method::Bdf, Variables::QuasiVelocities),
    ("taylor", Method::Taylor, Variables::QuasiVelocities),
    ("dop853, in momenta", Method::Dop853, Variables::Momenta),
];

/// What differs, and what is refused.
#[derive(Debug, Default)]
pub(super) struct Compared {
    pub(super) findings: Vec<Finding>,
    pub(super) refusals: Vec<Refusal>,
}

/// The tolerance of a method, in those of its steps.
fn factor(method: Method) -> f64 {
    match method {
        Method::Dop853 | Method::Taylor => OF_ONE_STEP,
        Method::Adams => OF_MULTISTEP,
        // Auto may change to BDF.
        Method::Bdf | Method::Auto => OF_LOW_ORDER,
    }
}

/// Compares all ways with a motion that is known.
pub(super) fn compare(specimen: &Specimen, text: &str, reference: &Reference) -> Compared {
    let mut compared = Compared::default();
    let product = match Product::of(specimen, text) {
        Ok(product) => product,
        Err(message) => {
            compared.refusals.push(Refusal { stage: "text", message });
            return compared;
        }
    };
    for (way, method, variables) in WAYS {
        // The format says that tables have no series.
        if method == Method::Taylor && !specimen.tables.is_empty() {
            continue;
        }
        match product.rows(method, variables) {
            Ok(rows) => compared.findings.extend(of_motion(specimen, way, method, &rows, reference)),
            Err(message) => compared.refused(way, "pc refuses a motion that is determined", &message),
        }
    }
    for (way, method) in [("adams", Method::Adams), ("dop853", Method::Dop853)] {
        match product.derivatives(method) {
            Ok(all) => {
                for (number, rows) in all.iter().enumerate() {
                    let found = of_derivatives(specimen, way, method, number, rows, reference);
                    compared.findings.extend(found);
                }
            }
            Err(message) => {
                compared.refused(way, "pc refuses derivatives of a motion that is determined", &message);
            }
        }
    }
    compared
}

impl Compared {
    fn refused(&mut self, way: &str, kind: &'static str, message: &str) {
        self.findings.push(Finding { kind, detail: format!("by {way}: {message}") });
    }
}

fn of_motion(
    specimen: &Specimen,
    way: &str,
    method: Method,
    rows: &Rows,
    reference: &Reference,
) -> Option<Finding> {
    let (names, times) = (specimen.variables(), specimen.times());
    let Reference { motion, sizes, .. } = reference;
    for (row, values) in motion.rows.iter().enumerate() {
        let errors = reference.errors(row);
        for (i, expected) in values.iter().enumerate() {
            let (found, size) = (rows[row][i], sizes[i]);
            let allowed = factor(method) * errors * (RTOL * size + ATOL);
            if exceeds(found - expected, allowed) {
                let detail = format!(
                    "{} at t = {} is {found:?} by {way}, not {expected:?} (allowed: {allowed:.1e})\n{}",
                    names[i],
                    times[row],
                    passages(motion)
                );
                return Some(Finding { kind: "motion over breaks differs", detail });
            }
        }
    }
    None
}

fn of_derivatives(
    specimen: &Specimen,
    way: &str,
    method: Method,
    number: usize,
    rows: &Rows,
    reference: &Reference,
) -> Option<Finding> {
    let (names, times) = (specimen.variables(), specimen.times());
    let parameter = &specimen.parameters[specimen.asked[number]].0;
    let mut largest = 1e-3;
    for (row, slope) in reference.derivatives[number].iter().enumerate() {
        let Some(slope) = slope else { continue };
        largest = slope.values.iter().fold(largest, |largest: f64, value| largest.max(value.abs()));
        for (i, expected) in slope.values.iter().enumerate() {
            let found = rows[row][i];
            let unit = reference.errors(row) * RTOL * largest;
            let allowed = OF_DERIVATIVES * factor(method) * unit + slope.doubt[i];
            if exceeds(found - expected, allowed) {
                let detail = format!(
                    "∂{}/∂{parameter} at t = {} is {found:?} by {way}, not {expected:?} (allowed: {allowed:.1e})\n{}",
                    names[i],
                    times[row],
                    passages(&reference.motion)
                );
                return Some(Finding { kind: "derivatives over breaks differ", detail });
            }
        }
    }
    None
}

/// When the motion passes which surfaces, or is kept by them.
fn passages(motion: &super::motion::Motion) -> String {
    let one = |passage: &super::motion::Passage| {
        let sides = passage.sides.iter().map(|side| match side {
            0.0 => '0',
            side if *side > 0.0 => '+',
            _ => '-',
        });
        format!("{:.6} {}", passage.time, sides.collect::<String>())
    };
    let all: Vec<String> = motion.passages.iter().map(one).collect();
    format!("passages: {}", all.join(", "))
}
