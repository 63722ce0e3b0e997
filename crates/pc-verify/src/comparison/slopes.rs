//! The comparison of derivatives of the equations with differences of the rates in the second derivation.

use pc_mech::VectorField;
use pc_model::{Assembly, Flow, Model};

use crate::comparison::agreement::Agreement;
use crate::comparison::second::{LONG, Second};
use crate::derivation::here::Here;
use crate::derivation::quantity::Quantity;
use crate::error::{Disagreement, Irregular, VerifyError};
use crate::numbers::rounding::{Rounding, within};
use crate::numbers::sized::Sized;

/// A direction in which the state and parameters of a flow change, with the derivatives along it that are to
/// be returned.
#[derive(Clone, Debug, Default)]
pub struct Slope {
    /// The name of the direction in messages, such as `∂/∂p`.
    pub name: String,
    /// The change of each component of the state.
    pub state: Vec<f64>,
    /// The changes of parameters and inputs, by name.
    pub parameters: Vec<(String, f64)>,
    /// The derivatives of the rates of these components of the state.
    pub rates: Vec<(String, f64)>,
    /// The derivatives of these outputs and integrals.
    pub observed: Vec<(String, f64)>,
}

/// The steps that are tried, as fractions of the state: which one is best depends on the curvature of the
/// rates.
const STEPS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];
/// The steps on which a disagreement is looked at again: where a state is zero nothing tells its size, and the rates of a small
/// system are far from linear over all steps above.
const SHORT: [f64; 5] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

/// A derivative is compared only if the differences determine it to within this relative error.
const KNOWN: f64 = 1e-3;
/// Derivatives count as different if they differ by more than this fraction: an error of derivation is as
/// large as a term.
const APART: f64 = 1e-5;
/// The rounding error of a difference of rates, relative to the terms of the rates: the error accumulates
/// over many terms.
const ROUNDINGS: f64 = 1e3 * f64::EPSILON;
/// Unless there is a corner, the gap between the differences on either side shrinks by at least this factor when the step
/// is halved; the factor is 2 for smooth rates.
const SMOOTH: f64 = 1.5;
/// The factor by which the uncertainty of a difference may exceed its estimate.
const DOUBT: f64 = 10.0;

impl Second {
    /// Compares derivatives along a direction, at a state of a flow of the model, with differences of the rates in the
    /// second derivation.
    ///
    /// Derivatives that differences do not determine, at corners and where rounding errors are large, are not
    /// compared; neither are derivatives of a large model.
    ///
    /// # Errors
    /// As for [`verify`](crate::verify).
    pub fn slope_agrees(
        &self,
        (model, assembly): (&Model, &Assembly<'_>),
        flow: &Flow,
        (t, state): (f64, &[f64]),
        slope: &Slope,
    ) -> Result<Agreement, VerifyError> {
        let mut agreement = self.nothing_yet();
        if self.cost() > LONG {
            return Err(nothing("the model is large"));
        }
        if flow.motion.breaks().contains(&t) {
            return Err(nothing("a table has a break there"));
        }
        let rates =
            slope.rates.iter().map(|(name, value)| (format!("the rate of {name}"), self.rate(name), *value));
        let observed =
            slope.observed.iter().map(|(name, value)| (name.clone(), self.observable(name), *value));
        let known =
            |(label, quantity, value): (String, Option<Quantity>, f64)| Some((label, quantity?, value));
        let wanted: Vec<(String, Quantity, f64)> = rates.chain(observed).filter_map(known).collect();
        let quantities: Vec<Quantity> = wanted.iter().map(|(_, quantity, _)| quantity.clone()).collect();
        let moved = Moved { second: self, model, flow, t, state, slope, quantities };
        let differences = assembly.stage("the second derivation", || match moved.differences(&STEPS) {
            Ok(differences) => Ok(differences),
            Err(Irregular::Unable(unable)) => Err(unable.into()),
            Err(irregular) => Err(nothing(&irregular.to_string())),
        })?;
        let mut closer: Option<Vec<Option<Sized>>> = None;
        for (place, ((label, _, value), difference)) in wanted.iter().zip(differences).enumerate() {
            let label = format!("{} of {label}", slope.name);
            let Some(Sized { value: other, size: doubt }) = difference else {
                agreement.leave_out(&label, "differences do not tell it");
                continue;
            };
            let agrees = |other: f64, doubt: f64| {
                within((value - other).abs(), APART * value.abs().max(other.abs()) + DOUBT * doubt)
            };
            let (scale, apart) = (value.abs().max(other.abs()), (value - other).abs());
            if !agrees(other, doubt) {
                let closer = closer.get_or_insert_with(|| moved.differences(&SHORT).unwrap_or_default());
                // A derivative is the limit of differences: those of short steps are nearer to it, if they tell one.
                if closer.get(place).copied().flatten().is_some_and(|found| agrees(found.value, found.size)) {
                    agreement.note(0.0, &label);
                    continue;
                }
                let mut flow = flow.clone();
                let row = self.row(&mut flow, t, state);
                let state = self.place(t, &row).and_then(|place| {
                    let here = Here::new(&self.derivation, self.derivation.at(&place, &Rounding::none())?)?;
                    Ok(self.named(&place, &here.columns))
                });
                return Err(VerifyError::Disagreement(Box::new(Disagreement {
                    form: "of the derivatives".to_owned(),
                    quantity: label,
                    first: *value,
                    second: other,
                    size: scale,
                    t,
                    state: state.unwrap_or_default(),
                })));
            }
            agreement.note(if scale > 0.0 { apart / scale } else { 0.0 }, &label);
        }
        if agreement.quantity.is_empty() {
            return Err(nothing("differences tell no derivative"));
        }
        agreement.states = 1;
        Ok(agreement)
    }
}

fn nothing(reason: &str) -> VerifyError {
    VerifyError::NothingCompared { tried: 1, reason: reason.to_owned() }
}

/// A state of a flow that can be moved along a direction.
struct Moved<'a> {
    second: &'a Second,
    model: &'a Model,
    flow: &'a Flow,
    t: f64,
    state: &'a [f64],
    slope: &'a Slope,
    quantities: Vec<Quantity>,
}

impl Moved<'_> {
    /// The derivative of each quantity by central differences, with its uncertainty; none if differences do not
    /// determine it.
    fn differences(&self, steps: &[f64]) -> Result<Vec<Option<Sized>>, Irregular> {
        let here = self.at(0.0)?;
        let mut best: Vec<Option<Sized>> = vec![None; here.len()];
        for step in steps.iter().map(|part| part * self.unit()) {
            // Beyond a pole or off the constraints there is nothing.
            let (Ok(far), Ok(near)) = (self.sides(&here, step), self.sides(&here, step / 2.0)) else {
                continue;
            };
            for (best, (far, near)) in best.iter_mut().zip(far.iter().zip(&near)) {
                let found = told(far, near);
                let is_better = |found: &Sized| best.is_none_or(|best| found.size < best.size);
                if let Some(found) = found.filter(is_better) {
                    *best = Some(found);
                }
            }
        }
        Ok(best)
    }

    /// The distance along the direction over which some component of the state or some parameter changes by
    /// its own size.
    fn unit(&self) -> f64 {
        let parameter =
            |name: &str| self.model.parameters().find(|(known, _)| *known == name).map(|(_, value)| value);
        let parameters =
            self.slope.parameters.iter().map(|(name, by)| (parameter(name).unwrap_or_default(), *by));
        let names = self.flow.motion.names().iter();
        let components = names.zip(self.state).zip(&self.slope.state);
        // What is zero, if only up to rounding, has no size of its own.
        let components = components
            .filter(|((name, value), _)| self.second.size(name, **value) == value.abs())
            .map(|((_, &value), &by)| (value, by));
        let sizes = components
            .chain(parameters)
            .filter(|(value, by)| *value != 0.0 && *by != 0.0)
            .map(|(value, by)| (value / by).abs());
        let least = sizes.fold(f64::INFINITY, f64::min);
        if least.is_finite() { least } else { 1.0 }
    }

    /// The differences on both sides.
    fn sides(&self, here: &[Sized], h: f64) -> Result<Vec<Sides>, Irregular> {
        let (after, before) = (self.at(h)?, self.at(-h)?);
        let sides = after.iter().zip(&before).zip(here).map(|((after, before), here)| Sides {
            central: (after.value - before.value) / (2.0 * h),
            apart: (after.value + before.value - 2.0 * here.value) / h,
            // Below the smallest normal number every operation loses digits.
            rounding: (ROUNDINGS * after.size.max(before.size).max(here.size)).max(f64::MIN_POSITIVE) / h,
        });
        Ok(sides.collect())
    }

    /// The quantities at this distance along the direction.
    fn at(&self, along: f64) -> Result<Vec<Sized>, Irregular> {
        let state: Vec<f64> =
            self.state.iter().zip(&self.slope.state).map(|(y, by)| y + along * by).collect();
        let mut second = self.second.clone();
        let mut values: Vec<f64> = self.model.parameters().map(|(_, value)| value).collect();
        let text = &mut second.derivation.text;
        for (name, by) in &self.slope.parameters {
            // A name that the caller has from the model.
            let Some(place) = self.model.parameters().position(|(known, _)| known == name) else { continue };
            values[place] += along * by;
            text.shifts.push((place, along * by));
        }
        text.parameters.clone_from(&values);
        let flow = self.flow.clone();
        let mut flow =
            if self.slope.parameters.is_empty() { flow } else { flow.with_values(&values, state.clone()) };
        let row = second.row(&mut flow, self.t, &state);
        let place = second.place(self.t, &row)?;
        let here = Here::new(&second.derivation, second.derivation.at(&place, &Rounding::none())?)?;
        second.derivation.quantities(&here.derived, &self.quantities, None, &Rounding::none())
    }
}

/// The differences of a quantity over a step to either side.
#[derive(Clone, Copy, Debug)]
struct Sides {
    central: f64,
    /// The difference between the slopes on the two sides.
    apart: f64,
    rounding: f64,
}

/// The derivative from the differences over a step and over half of it, if they determine it.
fn told(far: &Sides, near: &Sides) -> Option<Sized> {
    let value = (4.0 * near.central - far.central) / 3.0;
    let doubt = (near.central - far.central).abs() + near.rounding;
    let is_corner = near.apart.abs() > KNOWN * near.central.abs() + near.rounding
        && SMOOTH * near.apart.abs() > far.apart.abs();
    let is_known = value.is_finite() && doubt <= KNOWN * value.abs().max(near.rounding / KNOWN);
    (is_known && !is_corner).then_some(Sized { value, size: doubt })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sides(f: impl Fn(f64) -> f64, h: f64) -> Sides {
        let (after, before, here) = (f(h), f(-h), f(0.0));
        Sides {
            central: (after - before) / (2.0 * h),
            apart: (after + before - 2.0 * here) / h,
            rounding: ROUNDINGS * here.abs().max(after.abs()) / h,
        }
    }

    fn at_best(f: impl Fn(f64) -> f64) -> Option<f64> {
        let found = STEPS.iter().filter_map(|&h| told(&sides(&f, h), &sides(&f, h / 2.0)));
        found.min_by(|a, b| a.size.total_cmp(&b.size)).map(|found| found.value)
    }

    #[test]
    fn smooth_functions_tell_their_derivatives() {
        assert!(at_best(|x| (3.0 * x + 0.2).sin()).is_some_and(|d| (d - 3.0 * 0.2f64.cos()).abs() < 1e-9));
        assert!(at_best(|x| (30.0 * x).exp()).is_some_and(|d| (d - 30.0).abs() < 1e-6));
        assert!(at_best(|x| x * x + 5.0).is_some_and(|d| d.abs() < 1e-6));
        assert!(at_best(|_| 2.0).is_some_and(|d| d == 0.0));
    }

    #[test]
    fn corners_and_jumps_tell_none() {
        assert_eq!(at_best(f64::abs), None);
        assert_eq!(at_best(|x| if x > 0.0 { 1.0 } else { -1.0 }), None);
        assert_eq!(at_best(|x| if x >= 0.0 { x } else { 0.0 }), None);
    }
}
