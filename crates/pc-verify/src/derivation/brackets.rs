//! The structure coefficients of a frame that does not determine them at each point.

use nalgebra::DMatrix;

use crate::derivation::constants::Constants;
use crate::derivation::derivation::Derivation;
use crate::derivation::place::{Direction, Place};
use crate::derivation::structure::Structure;
use crate::error::{Irregular, Unable};
use crate::numbers::linear::fitting_inverse;
use crate::numbers::rounding::{Random, Rounding, within};
use crate::text::term::Term;

impl Structure {
    /// The coefficients c_rs^m; none if they follow from the frame.
    pub(crate) fn constants(
        &self,
        derivation: &Derivation,
        at: &Place,
    ) -> Result<Option<Constants>, Irregular> {
        match self {
            Structure::Frame => Ok(None),
            Structure::Constant(constants) => Ok(Some(constants.clone())),
            Structure::Table(table) => tabulated(derivation, table, at).map(Some),
            Structure::Fitted => fitted(derivation, at).map(Some),
        }
    }
}

fn tabulated(
    derivation: &Derivation,
    table: &[(usize, usize, Term)],
    at: &Place,
) -> Result<Constants, Irregular> {
    let exact = Rounding::none();
    let mut constants = Constants::zero(at.w.len());
    for m in 0..at.w.len() {
        let point = derivation.once(at, &at.along_velocity(m), &exact);
        for (r, s, value) in table {
            constants.set(*r, *s, m, point.value(value)?.eps);
        }
    }
    Ok(constants)
}

/// The remainder that rounding errors may leave of vanishing combinations of brackets, relative to their
/// terms.
const CLOSED: f64 = 1e-8;

/// The constants for which the brackets close at many points at the time of a place, determined by least
/// squares; an error unless they are unique and leave no residual.
fn fitted(derivation: &Derivation, at: &Place) -> Result<Constants, Irregular> {
    let (n, k) = (at.x.len(), at.w.len());
    let exact = Rounding::none();
    let mut random = Random::new(k as u64);
    let (mut fields, mut brackets): (Vec<f64>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    let mut terms = 0.0f64; // the largest of those of brackets
    let resting = |x: Vec<f64>| Place { x, w: vec![0.0; k], ..at.clone() };
    let points = 4 + 2 * k;
    let mut found = 0;
    for attempt in 0..8 * points {
        let scale = if attempt == 0 { 0.0 } else { 0.5 };
        let place = resting(derivation.units.displaced(at, scale, &mut random));
        let Ok((frame, commutators, size)) = commutators(derivation, &place, &exact) else { continue };
        if frame.iter().chain(&commutators).flatten().any(|value| !value.is_finite()) {
            continue;
        }
        for i in 0..n {
            fields.extend(frame.iter().map(|b| b[i]));
            brackets.push(commutators.iter().map(|bracket| bracket[i]).collect());
        }
        terms = terms.max(size);
        found += 1;
        if found == points {
            break;
        }
    }
    let pairs = (k + 1) * k / 2;
    let b = DMatrix::from_row_slice(brackets.len(), k, &fields);
    let right = DMatrix::from_fn(brackets.len(), pairs, |i, j| brackets[i][j]);
    let (inverse, rank) = fitting_inverse(&b).ok_or(Irregular::NotFinite { what: "the frame" })?;
    let mut solved = &inverse * &right;
    solved -= &inverse * (&b * &solved - &right); // corrects the error of the pseudo-inverse
    let rest = &b * &solved - &right;
    if rank < k || !within(rest.amax(), CLOSED * terms) {
        return Err(Unable::NoBrackets.into());
    }
    let mut constants = Constants::zero(k);
    for (j, (r, s)) in (0..=k).flat_map(|r| (r + 1..=k).map(move |s| (r, s))).enumerate() {
        (0..k).for_each(|m| constants.set(r, s, m, solved[(m, j)]));
    }
    Ok(constants)
}

/// b_s; [X_r, X_s] for r < s in the order of the pairs, with 0 for time; and the size of their largest terms.
#[allow(clippy::type_complexity)] // two lists of vectors
fn commutators(
    derivation: &Derivation,
    at: &Place,
    rounding: &Rounding,
) -> Result<(Vec<Vec<f64>>, Vec<Vec<f64>>, f64), Irregular> {
    let k = at.w.len();
    let drift = derivation.still(at, rounding).velocities()?.to_vec();
    let frame = derivation.frame(at, rounding)?;
    // X_0 = ∂/∂t + b_i0 ∂/∂x_i
    let direction =
        |r: usize| -> Direction { if r == 0 { at.in_time(&drift) } else { at.along(frame[r - 1].clone()) } };
    // X_r of the components of X_s, s > 0, and of b_0
    let moved = |r: usize, s: usize| -> Result<Vec<f64>, Irregular> {
        if s == 0 {
            let point = derivation.once(at, &direction(r), rounding);
            return Ok(point.velocities()?.iter().map(|u| u.eps).collect());
        }
        let point = derivation.twice(at, &at.along_velocity(s - 1), &direction(r), rounding);
        Ok(point.velocities()?.iter().map(|u| u.eps.eps).collect())
    };
    let (mut brackets, mut size) = (Vec::new(), 0.0f64);
    for (r, s) in (0..=k).flat_map(|r| (r + 1..=k).map(move |s| (r, s))) {
        let (left, right) = (moved(r, s)?, moved(s, r)?);
        size = left.iter().chain(&right).fold(size, |size, term| size.max(term.abs()));
        brackets.push(left.iter().zip(right).map(|(a, b)| a - b).collect());
    }
    Ok((frame, brackets, size))
}
