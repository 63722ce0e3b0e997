//! Steady motions found from many starts.

use std::f64::consts::TAU;

use pc_mech::{Equations, Expr, Matrix, Motion, SingularValues};

use crate::integrals::integral::Integral;
use crate::numeric::newton;
use crate::stability::steady_motion::{SteadyMotion, SteadyOptions};
use crate::stability::steady_search::{Known, NearbySteadyMotion, Seeker, Surface, is_autonomous};

/// The largest number of starts of each kind, for systems of few components.
const STARTS: usize = 64;

/// The greatest product of the number of starts and the square of the number of components, unless less is asked for.
const MOST_WORK: usize = 20_000;

/// The largest number of steps in which Newton's method reaches the values that the integrals have at the
/// start.
const MOST_STEPS: usize = 50;

/// The residual at which the integrals count as having their values at the start; the search that follows is
/// exact.
const ON_SURFACE: f64 = 1e-6;

/// The largest number of components of a state: beyond it, each step of Newton's method takes some tenths of
/// a second.
const MOST_COMPONENTS: usize = 150;

/// The relative difference up to which steady motions count as the same.
pub(crate) const SAME: f64 = 1e-6;

/// Singular values below this fraction of the largest count as zero.
const ZERO: f64 = 1e-8;

/// The equilibria and steady motions of an autonomous system that are found from many starts.
#[derive(Clone, Debug)]
pub struct SteadyMotions {
    /// The motions, in order of their distance from the start of the model, no two with the same state.
    pub list: Vec<FoundSteadyMotion>,
    /// The number of starts.
    pub starts: usize,
}

/// A steady motion, with the dimension of the family to which it belongs.
#[derive(Clone, Debug)]
pub struct FoundSteadyMotion {
    /// The motion.
    pub motion: NearbySteadyMotion,
    /// The dimension of the family of steady motions with the same integrals, of which this is the nearest to the
    /// start; 0 if the motion is isolated.
    pub family: usize,
}

/// Reasons for not searching.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoSteadyMotions {
    /// The equations depend on time.
    NotAutonomous,
    /// Fewer functions of the coordinates are known than are constant along motions in the frame: a solution
    /// might be unreachable.
    SurfaceUnknown,
    /// The motion has no derivatives at its start.
    NoApproximation,
    /// The state has so many components that the search would take too long.
    TooLarge {
        /// Their number.
        components: usize,
    },
}

impl SteadyMotions {
    /// The steady motions found from the start (t, y), and from starts spread evenly about it: equilibria, and the
    /// steady motions that have as many integrals as possible in common with the start (Routh). Coordinates in which
    /// rates and integrals are periodic are searched over one period, others up to about three times their value at
    /// the start. If there are families with these integrals, one member of each dimension is kept.
    ///
    /// `motion` is compiled from the `equations`, `positions` are the relations between coordinates that constraints
    /// imply, `integrals` are the known integrals, and there are at most `most_starts` starts of each kind.
    ///
    /// # Errors
    /// [`NoSteadyMotions`] with the reason.
    pub fn search<'g>(
        equations: &Equations<'g>,
        motion: &mut Motion,
        (t, start): (f64, &[f64]),
        integrals: &[Integral<'g>],
        positions: &[(String, Expr<'g>)],
        most_starts: usize,
    ) -> Result<SteadyMotions, NoSteadyMotions> {
        if start.len() > MOST_COMPONENTS {
            return Err(NoSteadyMotions::TooLarge { components: start.len() });
        }
        if !is_autonomous(equations) {
            return Err(NoSteadyMotions::NotAutonomous);
        }
        let known = Known::of(equations, integrals);
        let seeker = Seeker::new(equations, motion, (t, start), &known, positions)
            .ok_or(NoSteadyMotions::NoApproximation)?;
        let choices: Vec<_> =
            known.choices().into_iter().map(|same| seeker.with_positions(same, positions)).collect();
        let of_place = choices.last().cloned().unwrap_or_default();
        let velocities: Vec<String> =
            equations.system().quasi_velocities().iter().map(Expr::to_string).collect();
        let mut found = Found { list: Vec::new(), starts: 0, periods: periods(motion, t, start) };

        let surface = Surface::new(equations, &of_place, start).ok_or(NoSteadyMotions::SurfaceUnknown)?;
        let places = equations.system().frame().coordinates().len();
        let still = |mut guess: Vec<f64>| {
            guess.iter_mut().skip(places).take(velocities.len()).for_each(|eta| *eta = 0.0);
            guess
        };
        let at_rest = SteadyOptions::default().fixed(velocities.clone());
        let guesses = guesses(start, &found.periods, most_starts);
        for guess in guesses.iter().cloned().map(still) {
            found.look(&seeker, motion, start, (&guess, &at_rest), (&surface, &of_place));
        }
        for same in &choices {
            let Some(surface) = Surface::new(equations, same, start) else { continue };
            let before = found.list.len();
            let options = SteadyOptions::default();
            for guess in &guesses {
                found.look(&seeker, motion, start, (guess, &options), (&surface, same));
                // From far away it is better to attain the integrals first, and rest after that.
                if let Some(guess) = onto(&surface, guess) {
                    found.look(&seeker, motion, start, (&guess, &options), (&surface, same));
                }
            }
            if found.list.len() > before {
                break;
            }
        }
        let starts = found.starts;
        Ok(SteadyMotions { list: found.without_families(), starts })
    }
}

/// The motions found so far.
struct Found {
    /// The motions, each with its full state.
    list: Vec<(Vec<f64>, FoundSteadyMotion)>,
    starts: usize,
    /// The period of each component that has one.
    periods: Vec<Option<f64>>,
}

impl Found {
    /// Searches from one guess, and adds the motion that is found if it is new.
    fn look<'g>(
        &mut self,
        seeker: &Seeker<'_, 'g>,
        motion: &mut Motion,
        start: &[f64],
        (guess, options): (&[f64], &SteadyOptions),
        (surface, same): (&Surface<'g>, &[(String, Expr<'g>)]),
    ) {
        self.starts += 1;
        let Some(mut steady) = seeker.steady_motion(motion, guess, options, surface) else { return };
        for (i, period) in self.periods.iter().enumerate() {
            if let Some(period) = period {
                let turns = ((steady.state[i] - start[i]) / period).round();
                steady.state[i] -= turns * period;
            }
        }
        let is_kept = |i: &usize| steady.components.contains(&motion.names()[*i]);
        let kept: Vec<usize> = (0..steady.state.len()).filter(is_kept).collect();
        let is_same = |(known, _): &(Vec<f64>, FoundSteadyMotion)| {
            kept.iter().all(|&i| {
                let distance = (known[i] - steady.state[i]).abs();
                let around = self.periods[i].map_or(distance, |period| (period - distance).abs());
                distance.min(around) <= SAME * (1.0 + known[i].abs())
            })
        };
        if self.list.iter().any(is_same) {
            return;
        }
        let Some(family) = family(&steady, surface, &kept) else { return };
        let names = same.iter().map(|(name, _)| name.clone()).collect();
        let Ok(described) = seeker.described(&steady, start, names) else { return };
        self.list.push((steady.state, FoundSteadyMotion { motion: described, family }));
    }

    /// The motions sorted by distance; of the families of each dimension and kind of stability, only the
    /// nearest member is kept.
    fn without_families(mut self) -> Vec<FoundSteadyMotion> {
        self.list.sort_by(|(_, a), (_, b)| a.motion.distance.total_cmp(&b.motion.distance));
        let mut list: Vec<FoundSteadyMotion> = Vec::new();
        for (_, found) in self.list {
            let is_member = |known: &FoundSteadyMotion| {
                known.family == found.family && known.motion.stability() == found.motion.stability()
            };
            if found.family == 0 || !list.iter().any(is_member) {
                list.push(found);
            }
        }
        list
    }
}

/// A state near the guess at which the integrals have the same values as at the start.
fn onto(surface: &Surface<'_>, guess: &[f64]) -> Option<Vec<f64>> {
    let end = newton::solve(guess.to_vec(), MOST_STEPS, |y| Ok(surface.at(y)?)).ok()?;
    (end.iterations > 0 && end.is_solution(ON_SURFACE)).then_some(end.point)
}

/// The dimension of the kernel of the first approximation on the surface: the number of directions that lead
/// to other steady motions, to first order.
fn family(steady: &SteadyMotion, surface: &Surface<'_>, kept: &[usize]) -> Option<usize> {
    let (_, normals) = surface.at(&steady.state).ok()?;
    let a = &steady.first_approximation;
    let (rows, columns) = (a.rows() + normals.rows(), a.columns());
    let entry = |i: usize, j: usize| if i < a.rows() { a[(i, j)] } else { normals[(i - a.rows(), kept[j])] };
    let values = SingularValues::of(&Matrix::from_fn(rows, columns, entry)).ok()?;
    let largest = values.values.first().copied().unwrap_or(0.0);
    Some(columns - values.rank(ZERO * largest))
}

/// The periods of the components: 2π for coordinates in which the rates have this period, at the start and
/// near it; none for others.
pub(crate) fn periods(motion: &mut Motion, t: f64, start: &[f64]) -> Vec<Option<f64>> {
    let beside: Vec<f64> = start.iter().map(|z| z + 0.37 + 0.11 * z.abs()).collect();
    let coordinates = motion.coordinates();
    let mut is_periodic = |i: usize| {
        let mut changes = false;
        for state in [start, &beside] {
            let (mut turned, mut half) = (state.to_vec(), state.to_vec());
            turned[i] += TAU;
            half[i] += 1.0;
            let rates = [state, &turned, &half].map(|state| motion.rates(t, state).ok());
            let [Some(here), Some(there), Some(between)] = rates else { return false };
            let apart =
                |a: &[f64], b: &[f64]| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-9 * (1.0 + a.abs()));
            if apart(&here, &there) {
                return false;
            }
            changes |= apart(&here, &between);
        }
        changes
    };
    (0..start.len()).map(|i| (i < coordinates && is_periodic(i)).then_some(TAU)).collect()
}

/// The start, and at most as many other guesses, spread evenly about it using multiples of roots of primes.
fn guesses(start: &[f64], periods: &[Option<f64>], most: usize) -> Vec<Vec<f64>> {
    let size = start.len().max(1);
    let count = (MOST_WORK / (size * size)).clamp(4, STARTS).min(most.max(1));
    let roots: Vec<f64> = primes().take(start.len()).map(|p| f64::from(p).sqrt().fract()).collect();
    let guess = |number: usize| -> Vec<f64> {
        let place = |i: usize| {
            let u = 2.0 * (number as f64 * roots[i]).fract() - 1.0;
            let reach = periods[i].map_or(2.0 * (1.0 + start[i].abs()), |period| period / 2.0);
            start[i] + reach * u
        };
        if number == 0 { start.to_vec() } else { (0..start.len()).map(place).collect() }
    };
    (0..count).map(guess).collect()
}

pub(crate) fn primes() -> impl Iterator<Item = u32> {
    (2..).filter(|n: &u32| (2..*n).take_while(|d| d * d <= *n).all(|d| !n.is_multiple_of(d)))
}
