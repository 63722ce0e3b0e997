//! What a series does not know: the explicit dependence on time further ahead.
//!
//! The series of exp(−((t − 5)/0.2)²) at t = 0 has coefficients that are no different from 0. Where the dependence of the field on time
//! [shows](TimeDependence) turns or jumps in the next step, the rates there are therefore compared with those of the polynomial.

use pc_expr::{Surprises, TimeDependence};

/// Places at which a field is looked at whose dependence is known by its values alone, over the whole integration.
const SAMPLES: f64 = 64.0;
/// Most places of fast oscillations looked at in one step.
const MOST: usize = 16;
/// Twice as many may lie in a step for each one before it whose places were as foreseen, so many times.
const DOUBLINGS: u32 = 20;

/// What is to be looked out for.
#[derive(Debug, Clone)]
pub(super) struct Foresight {
    pub(super) dependence: TimeDependence,
    /// When the integration began.
    pub(super) begin: f64,
    /// Steps in sequence that were full of places, all as foreseen.
    unsurprising: u32,
}

/// Places to be looked at in order, and a time beyond which nothing is known.
pub(super) struct Places {
    pub(super) places: Vec<f64>,
    pub(super) until: Option<f64>,
    /// Whether what is there cannot be resolved.
    pub(super) noise: bool,
    /// Whether there were many.
    pub(super) crowd: bool,
}

impl Foresight {
    pub(super) fn new(dependence: TimeDependence, begin: f64) -> Foresight {
        Foresight { dependence, begin, unsurprising: 0 }
    }

    pub(super) fn is_needed(&self) -> bool {
        !matches!(self.dependence, TimeDependence::Absent)
    }

    /// The places between `t` and `reach` of an integration to `end`, for a motion that leaves t from this state at these rates.
    pub(super) fn places(&mut self, (t, reach, end): (f64, f64, f64), at: (&[f64], &[f64])) -> Places {
        let mut few = Vec::new();
        let mut seen = Surprises::default();
        let samples = |few: &mut Vec<f64>| {
            let spacing = (end - self.begin) / SAMPLES;
            if spacing.is_finite() && spacing != 0.0 && (t - self.begin) / spacing >= 0.0 {
                let (from, to) = ((t - self.begin) / spacing, (reach - self.begin) / spacing);
                // In the middle between whole multiples, which steps and switches tend to fall on.
                let mut k = (from - 0.5).ceil().max(0.0) + 0.5;
                while k < to.min(2.0 * SAMPLES) {
                    few.push(self.begin + k * spacing);
                    k += 1.0;
                }
            }
        };
        match &mut self.dependence {
            TimeDependence::Absent => {}
            TimeDependence::Unknown => samples(&mut few),
            TimeDependence::Known(profile) => {
                if profile.is_partial() {
                    samples(&mut few);
                }
                seen = profile.surprises((t, reach), at, end, self.unsurprising > DOUBLINGS);
                few.append(&mut seen.few);
            }
        }
        let Surprises { mut many, until, noise, .. } = seen;
        let least = 1e-13 * t.abs().max(reach.abs());
        for places in [&mut few, &mut many] {
            places.retain(|place| (place - t).abs() > least && (reach - place) * (reach - t) > 0.0);
        }
        let crowd = many.len() > MOST;
        let allowed = MOST << self.unsurprising.min(DOUBLINGS);
        let until = many.get(allowed).copied().or(until).filter(|until| (until - t).abs() > least);
        many.truncate(allowed);
        let stride = many.len().div_ceil(MOST).max(1);
        few.extend(many.iter().skip(stride - 1).step_by(stride));
        few.sort_unstable_by(|a, b| ((a - b) * (reach - t)).total_cmp(&0.0));
        Places { places: few, until, noise, crowd }
    }

    /// Takes note of whether the places of a step were as foreseen.
    pub(super) fn note(&mut self, surprise: bool, crowd: bool) {
        self.unsurprising = if crowd && !surprise { self.unsurprising + 1 } else { 0 };
    }
}
