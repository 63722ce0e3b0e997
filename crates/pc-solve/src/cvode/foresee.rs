//! The explicit dependence on time, examined up to the end of the next step.
//!
//! A multistep method sees f at the ends of its steps only. Before a step is tried, f is therefore evaluated where its
//! explicit dependence on time may hide something, at the state that the step would predict there: with p the
//! polynomial through the last steps, the defect
//! ```text
//! δ = p′(t) − f(t, p(t))
//! ```
//! would change the state by about h δ over a step of length h. If that is large compared with the tolerance, the step
//! ends no later than there, and the method meets it.
//!
//! Where the field shows its [profile](TimeDependence::Known), these places are the turns, jumps and corners of what
//! contains t, however close they are; a step in which nothing turns twice needs none. Where only evaluations can tell, they
//! are places evenly spaced over the whole integration. A function that turns faster than floating-point times can
//! resolve cannot be followed: it is an error, unless it is below the tolerances.

use pc_expr::{Surprises, TimeDependence, TimeProfile, VectorField};
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::cvode::foresight::Foresight;
use crate::error::{Reason, SolveError};

/// Places at which a field that is known by its values alone is looked at, from the start to where it is to be integrated.
const SAMPLES: f64 = 64.0;
/// Most places of fast oscillations looked at in one step.
const MOST: usize = 16;
/// Twice as many may lie in a step for each one before it whose places were as foreseen, so many times.
const DOUBLINGS: u32 = 20;
/// After so many such steps an oscillation is taken to be too small to matter.
const ENOUGH: u32 = 200;
/// A defect matters if over the step it changes the state by more than this times the tolerance. The correction of a step
/// that passes its error test may come to some ten times the tolerance, at the orders from 1 to 12.
const SURPRISE: f64 = 100.0;
/// The first step is at most this part of the way, as CVODE estimates it.
const FIRST_STEP: f64 = 0.1;

impl<F: VectorField> Cvode<F> {
    /// A time in the next step, tried in the direction of `towards`, at which the step is to end; none if nothing is
    /// foreseen that it would not see.
    pub(super) fn foresee(&mut self, towards: f64) -> Result<Option<f64>, SolveError> {
        if matches!(self.foresight.dependence, TimeDependence::Absent) {
            return Ok(None);
        }
        let t = self.step_time;
        let end = self.stop_time.unwrap_or(towards);
        let reach = self.planned_end(towards);
        // CVODE cannot go to where rounding is felt.
        let least = (1e-13 * t.abs().max(reach.abs())).max(self.foresight.min_step);
        if (reach - t).abs() <= least {
            return Ok(None);
        }
        let mut dependence = std::mem::replace(&mut self.foresight.dependence, TimeDependence::Absent);
        let mut few = std::mem::take(&mut self.foresight.few);
        few.clear();
        let landing = self.foresee_in(&mut dependence, &mut few, (t, reach, end), least);
        (self.foresight.dependence, self.foresight.few) = (dependence, few);
        landing
    }

    fn foresee_in(
        &mut self,
        dependence: &mut TimeDependence,
        few: &mut Vec<f64>,
        (t, reach, end): (f64, f64, f64),
        least: f64,
    ) -> Result<Option<f64>, SolveError> {
        let Surprises { mut many, mut until, noise, .. } = match dependence {
            TimeDependence::Absent => Surprises::default(),
            // A first step whose length is given is taken at the word.
            TimeDependence::Unknown if self.direction.is_none() && self.initial_step.is_some() => {
                Surprises::default()
            }
            TimeDependence::Unknown => {
                few.extend(self.samples(t, reach, end));
                Surprises::default()
            }
            TimeDependence::Known(profile) => {
                let places = self.surprises(profile, (t, reach, end))?;
                few.extend_from_slice(&places.few);
                if profile.is_partial() {
                    few.extend(self.samples(t, reach, end));
                }
                places
            }
        };
        if noise && let Some(near) = until.take() {
            many.clear();
            self.read_polynomial()?;
            if self.scatters(near, (reach - t).abs()) {
                return Err(self.failed(Reason::Unresolved { t }, None));
            }
        }
        for places in [&mut *few, &mut many] {
            places.retain(|place| (place - t).abs() > least);
        }
        let crowd = many.len();
        // Of fast oscillations not all are looked at, and a step holds no more than those before it let expect.
        let allowed = MOST << self.foresight.unsurprising.min(DOUBLINGS);
        let crowded = many.get(allowed).copied().or(until.filter(|until| (until - t).abs() > least));
        many.truncate(allowed);
        let stride = many.len().div_ceil(MOST).max(1);
        few.extend(many.iter().skip(stride - 1).step_by(stride));
        few.sort_unstable_by(|a, b| ((a - b) * (reach - t)).total_cmp(&0.0));
        if few.is_empty() && crowded.is_none() {
            self.foresight.unsurprising = 0;
            return Ok(None);
        }
        if self.direction.is_none() {
            return Ok(few.first().copied().or(crowded)); // nothing is known yet, and the first step is short
        }
        self.read_polynomial()?;
        for &place in &*few {
            if crowded.is_some_and(|crowded| (place - crowded) * (reach - t) > 0.0) {
                break;
            }
            if self.surprises_at(place, (reach - t).abs()) {
                self.foresight.unsurprising = 0;
                self.foresight.limited += 1;
                return Ok(Some(place));
            }
        }
        self.foresight.unsurprising =
            if crowd > MOST || until.is_some() { self.foresight.unsurprising + 1 } else { 0 };
        self.foresight.limited += u64::from(crowded.is_some());
        Ok(crowded)
    }

    /// Where the next step would end.
    fn planned_end(&self, towards: f64) -> f64 {
        let t = self.step_time;
        let end = self.stop_time.unwrap_or(towards);
        let direction = 1.0_f64.copysign(end - t);
        let length = if self.direction.is_some() {
            let mut length = 0.0;
            // SAFETY: the memory is live and initialised; `length` is a place for the result.
            unsafe { sys::CVodeGetCurrentStep(self.memory.raw(), &raw mut length) };
            length.abs()
        } else {
            self.initial_step.unwrap_or(FIRST_STEP * (end - t).abs())
        };
        let reach = t + length.copysign(direction);
        match self.stop_time {
            Some(stop) if (reach - stop) * direction > 0.0 => stop,
            _ => reach,
        }
    }

    /// Places evenly spaced over the integration from its start to `end`, those of the next step.
    fn samples(&self, t: f64, reach: f64, end: f64) -> impl Iterator<Item = f64> + use<F> {
        let begin = self.foresight.begin;
        let spacing = (end - begin).abs().max((reach - begin).abs()) / SAMPLES;
        let (from, to) = ((t - begin).abs() / spacing, (reach - begin).abs() / spacing);
        let direction = 1.0_f64.copysign(reach - t);
        let place = move |k: f64| begin + (k * spacing).copysign(direction);
        // None of an integration that has turned round.
        let is_ahead = (t - begin) * direction >= 0.0 && spacing.is_normal();
        // In the middle between whole multiples, which steps and switches tend to fall on.
        let first = (from - 0.5).ceil().max(0.0);
        let count = if is_ahead { (to - 0.5 - first).ceil().clamp(0.0, 2.0 * SAMPLES) } else { 0.0 };
        (0..count as u32)
            .map(move |k| place(first + f64::from(k) + 0.5))
            .filter(move |s| (s - reach) * direction < 0.0)
    }

    /// What the profile shows in the next step.
    fn surprises(
        &mut self,
        profile: &mut TimeProfile,
        (t, reach, end): (f64, f64, f64),
    ) -> Result<Surprises, SolveError> {
        if profile.follows_states() {
            self.read_polynomial()?;
            self.foresight.predict(0.0);
        }
        let Foresight { state, slope, .. } = &self.foresight;
        Ok(profile.surprises((t, reach), (state, slope), end, self.foresight.unsurprising > ENOUGH))
    }

    /// Takes the polynomial of the last step; before the first, the tangent.
    fn read_polynomial(&mut self) -> Result<(), SolveError> {
        let t = self.step_time;
        if self.direction.is_none() {
            let foresight = &mut self.foresight;
            if let [y, rates, ..] = &mut foresight.polynomial[..] {
                y.copy_from_slice(self.step_state.as_slice());
                foresight.evaluations += 1;
                if !self.callbacks.look(t, y, rates) {
                    rates.fill(0.0); // CVODE will say so
                }
                foresight.terms = 2;
            }
            return Ok(());
        }
        let mut order = 0;
        // SAFETY: the memory is live and initialised; `order` is a place for the result.
        unsafe { sys::CVodeGetLastOrder(self.memory.raw(), &raw mut order) };
        self.foresight.terms = 0;
        let mut factorial = 1.0;
        for (k, terms) in (0..=order).zip(&mut self.foresight.polynomial) {
            factorial *= f64::from(k.max(1));
            // SAFETY: memory and vector are live and of one context; a step has been taken.
            let code = unsafe { sys::CVodeGetDky(self.memory.raw(), t, k, self.work.raw()) };
            self.context.check("CVodeGetDky", code)?;
            for (place, term) in terms.iter_mut().zip(self.work.as_slice()) {
                *place = term / factorial;
            }
            self.foresight.terms += 1;
        }
        // SAFETY: memory and vector are live and of one context; CVODES copies to the vector.
        let code = unsafe { sys::CVodeGetEstLocalErrors(self.memory.raw(), self.work.raw()) };
        self.context.check("CVodeGetEstLocalErrors", code)?;
        self.foresight.errors.copy_from_slice(self.work.as_slice());
        self.foresight.order = order;
        // SAFETY: the memory is live and initialised; the last step is a place for the result.
        unsafe { sys::CVodeGetLastStep(self.memory.raw(), &raw mut self.foresight.last_step) };
        Ok(())
    }

    /// Whether f scatters between here and a place near by, by what a step of this length would feel: its second differences are
    /// large, of which what is smooth has none so near.
    fn scatters(&mut self, near: f64, length: f64) -> bool {
        let mut before: Option<[Vec<f64>; 2]> = None;
        let mut largest = 0.0f64;
        for i in 0..=MOST {
            let since = (near - self.step_time) * (i as f64 / MOST as f64);
            self.foresight.predict(since);
            self.foresight.evaluations += 1;
            let Foresight { state, rates, .. } = &mut self.foresight;
            if !self.callbacks.look(self.step_time + since, state, rates) {
                return false; // the method will meet it
            }
            let rates = rates.clone();
            if let Some([first, second]) = &before {
                for i in 0..rates.len() {
                    let difference = rates[i] - 2.0 * second[i] + first[i];
                    let tolerance = self.foresight.tolerance(i, self.foresight.state[i]);
                    largest = largest.max((0.25 * difference / tolerance).abs());
                }
            }
            before = Some(match before {
                Some([_, second]) => [second, rates],
                None => [rates.clone(), rates],
            });
        }
        length * largest > SURPRISE
    }

    /// Whether f does there what the polynomial does not let expect, for a step of this length.
    fn surprises_at(&mut self, place: f64, length: f64) -> bool {
        let since = place - self.step_time;
        self.foresight.predict(since);
        self.foresight.evaluations += 1;
        let Foresight { state, rates, .. } = &mut self.foresight;
        self.callbacks.look(place, state, rates) && length * self.foresight.defect(since) > SURPRISE
    }
}
