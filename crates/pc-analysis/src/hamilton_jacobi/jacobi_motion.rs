//! A motion that Jacobi's theorem gives, followed in time.

use pc_mech::Canonical;

use crate::error::AnalysisError;
use crate::hamilton_jacobi::complete_integral::{CompleteIntegral, Values};
use crate::hamilton_jacobi::series::SeriesMotion;
use crate::numeric::dense::norm;

/// A step is taken if the position differs from x + h ẋ by at most this fraction of the way.
const STRAIGHT: f64 = 0.6;
/// The branch of the action ends where steps below this fraction of the whole time do not lead on.
const SHORTEST: f64 = 1e-9;
/// The first step, as a fraction of the whole time.
const FIRST: f64 = 0.125;
/// At a turning point ∂²S/∂α∂x grows beyond bounds: beyond this multiple of what it is at the start.
const STEEP: f64 = 1e3;
/// When a motion is taken up where the action has no values at the start, as fractions of the whole time.
const LATER: [f64; 4] = [1.0 / 16.0, 0.25, 0.5, 0.75];
/// The number of times at which the motion is compared with that of the equations.
const COMPARED: u32 = 16;
/// Where the branch of the action ends, the comparison ends at this fraction of the time until then: momenta lose half of their
/// digits at the end.
const BEFORE_END: f64 = 0.99;

/// The motion ∂S/∂α_s = β_s, y_s = X_s S of a [complete integral](CompleteIntegral).
///
/// S has branches, by its roots and arc functions; a motion is followed on the branch of its start, until this branch ends, as
/// that of √(2(E − U)) does where the velocity changes its sign.
///
/// ```
/// use pc_analysis::{AnalysisError, BranchEnd, CompleteIntegral};
/// use pc_mech::{Graph, System};
///
/// // Thrown upwards, g = 1: x = 2 t − t²/2 until t = 2.
/// let graph = Graph::new();
/// let [t, x, e] = graph.symbols(["t", "x", "E"]);
/// let body =
///     System::builder(&graph).coordinates(["x"]).lagrangian(|_, x, v| v[0].square() / 2.0 - x[0]).build()?;
/// let canonical = body.canonical()?;
/// let integral = CompleteIntegral::new(&canonical, -(2.0 * (e - x)).sqrt().powi(3) / 3.0 - e * t, &["E"])?;
/// let mut motion = integral.motion_through(0.0, (&[0.0], &[2.0]), &[5.0])?;
/// assert!((motion.alpha()[0] - 2.0).abs() < 1e-14);
/// assert!((motion.state(1.0)?[0] - 1.5).abs() < 1e-14);
/// assert!(matches!(motion.state(3.0), Err(AnalysisError::BranchEnds { .. })));
/// let agreement = motion.agreement(&canonical, 3.0)?;
/// assert!((agreement.until - 2.0).abs() < 1e-6 && agreement.end == Some(BranchEnd::TurningPoint));
/// assert!(agreement.deviation.unwrap() < 1e-12);
/// # Ok::<(), AnalysisError>(())
/// ```
#[derive(Clone, Debug)]
pub struct JacobiMotion<'g> {
    integral: CompleteIntegral<'g>,
    alpha: Vec<f64>,
    beta: Vec<f64>,
    start: (f64, Vec<f64>),
}

/// How a branch of an action ends along a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BranchEnd {
    /// A momentum ∂S/∂x vanishes like a root, so that ∂²S/∂α∂x grows beyond bounds.
    TurningPoint,
    /// An arc function jumps, or the action has no values further on.
    Cut,
}

/// How closely the motion of Jacobi's theorem agrees with that of the equations (10), (11).
#[derive(Clone, Debug, PartialEq)]
pub struct MotionAgreement {
    /// The time until which the motion was followed.
    pub until: f64,
    /// Whether the branch of the action ends there, and how.
    pub end: Option<BranchEnd>,
    /// The largest difference of the states (x, y) at several times until then, each component relative to 1 + its largest
    /// size; `None` if the equations are piecewise, or have no power series along the motion.
    pub deviation: Option<f64>,
}

impl<'g> CompleteIntegral<'g> {
    /// The motion through the state (x, y) at time t, whose constants α are sought from `guess`.
    ///
    /// # Errors
    /// As for [`alphas`](CompleteIntegral::alphas) and [`betas`](CompleteIntegral::betas).
    pub fn motion_through(
        &self,
        t: f64,
        (x, y): (&[f64], &[f64]),
        guess: &[f64],
    ) -> Result<JacobiMotion<'g>, AnalysisError> {
        let alpha = self.clone().alphas(t, (x, y), guess)?;
        self.motion_from(t, x, &alpha)
    }

    /// The motion through the state (x, y) at the first of two times, as [`motion_through`](CompleteIntegral::motion_through):
    /// where S has no values then, as (x − α)²/(2t) has none at t = 0, the motion is taken up some time later, before the second.
    ///
    /// # Errors
    /// As for [`motion_through`](CompleteIntegral::motion_through) at the last of these times.
    pub fn motion_after(
        &self,
        canonical: &Canonical<'g>,
        (t, t_end): (f64, f64),
        (x, y): (&[f64], &[f64]),
        guess: &[f64],
    ) -> Result<JacobiMotion<'g>, AnalysisError> {
        let at_once = self.motion_through(t, (x, y), guess);
        if at_once.is_ok() || self.clone().evaluate(t, x, guess).is_ok() {
            return at_once;
        }
        let Ok(Some(mut series)) = SeriesMotion::new(canonical, t, &[x, y].concat()) else { return at_once };
        let mut found = at_once;
        for share in LATER {
            let t = t + share * (t_end - t);
            let Some(state) = series.at(t) else { break };
            let (x, y) = state.split_at(x.len());
            found = self.motion_through(t, (x, y), guess);
            if found.is_ok() {
                break;
            }
        }
        found
    }

    /// The motion with the constants `alpha` that is at x at time t.
    ///
    /// # Errors
    /// As for [`betas`](CompleteIntegral::betas).
    pub fn motion_from(&self, t: f64, x: &[f64], alpha: &[f64]) -> Result<JacobiMotion<'g>, AnalysisError> {
        let mut integral = self.clone();
        let beta = integral.betas(t, x, alpha)?;
        Ok(JacobiMotion { integral, alpha: alpha.to_vec(), beta, start: (t, x.to_vec()) })
    }
}

impl JacobiMotion<'_> {
    /// The time at which the motion is taken up.
    pub fn start_time(&self) -> f64 {
        self.start.0
    }

    /// The constants α_s.
    pub fn alpha(&self) -> &[f64] {
        &self.alpha
    }

    /// The constants β_s.
    pub fn beta(&self) -> &[f64] {
        &self.beta
    }

    /// The state (x, y) at time t.
    ///
    /// # Errors
    /// [`AnalysisError::BranchEnds`] if the branch of the action ends before t.
    pub fn state(&mut self, t: f64) -> Result<Vec<f64>, AnalysisError> {
        let (start, x) = self.start.clone();
        Ok(self.followed((start, x), t)?.state())
    }

    /// Compares the motion with that of the equations (10), (11), as power series in time, until `t_end` or until the branch of
    /// the action ends.
    ///
    /// # Errors
    /// [`AnalysisError`] if the equations contain a symbol without a value.
    pub fn agreement(
        &mut self,
        canonical: &Canonical<'_>,
        t_end: f64,
    ) -> Result<MotionAgreement, AnalysisError> {
        let (start, x) = self.start.clone();
        let (until, last) = match self.state(t_end) {
            Ok(_) => (t_end, None),
            Err(AnalysisError::BranchEnds { t, coordinates }) => {
                (t, Some(coordinates.into_iter().map(|(_, x)| x).collect::<Vec<f64>>()))
            }
            Err(error) => return Err(error),
        };
        let ends = last.is_some();
        let first = self.here(start, x)?;
        let mut agreement = MotionAgreement { until, end: ends.then_some(BranchEnd::Cut), deviation: None };
        if let Some(x) = last
            && let Ok(last) = self.here(until, x)
            && last.steepness() > STEEP * first.steepness()
        {
            agreement.end = Some(BranchEnd::TurningPoint);
        }
        let Some(mut other) = SeriesMotion::new(canonical, start, &first.state())? else {
            return Ok(agreement);
        };
        let span = (until - start) * if ends { BEFORE_END } else { 1.0 };
        let (mut here, mut pairs) = ((start, first.x), Vec::new());
        for i in 1..=COMPARED {
            let t = if !ends && i == COMPARED {
                t_end
            } else {
                start + span * f64::from(i) / f64::from(COMPARED)
            };
            let found = self.followed(here, t)?;
            let Some(expected) = other.at(t) else { return Ok(agreement) };
            pairs.push((found.state(), expected.to_vec()));
            here = (t, found.x);
        }
        agreement.deviation = Some(largest(&pairs));
        Ok(agreement)
    }

    /// The position at time t, reached from one at another time by steps along the motion.
    fn followed(&mut self, (from, x): (f64, Vec<f64>), t: f64) -> Result<Place, AnalysisError> {
        let mut here = self.here(from, x)?;
        let (mut now, mut step) = (from, FIRST * (t - from));
        let shortest = SHORTEST * (t - self.start.0).abs();
        while now != t {
            let is_last = step.abs() >= (t - now).abs();
            let next = if is_last { t } else { now + step };
            if let Some(there) = self.after(&here, now, next) {
                (here, now) = (there, next);
                step *= 2.0;
                continue;
            }
            step = (next - now) / 2.0;
            if step.abs() < shortest {
                let coordinates = self.integral.named(&here.x);
                return Err(AnalysisError::BranchEnds { t: now, coordinates });
            }
        }
        Ok(here)
    }

    fn here(&mut self, t: f64, x: Vec<f64>) -> Result<Place, AnalysisError> {
        let values = self.integral.evaluate(t, &x, &self.alpha)?;
        Ok(Place { x, values })
    }

    /// The next position, if the way there is nearly straight.
    fn after(&mut self, here: &Place, now: f64, next: f64) -> Option<Place> {
        let step = next - now;
        let guess: Vec<f64> =
            here.x.iter().zip(&here.values.velocities).map(|(x, rate)| x + step * rate).collect();
        let constants = (self.alpha.clone(), self.beta.clone());
        let (x, values) = self.integral.position(next, (&constants.0, &constants.1), &guess).ok()?;
        let bent = norm(&x.iter().zip(&guess).map(|(x, guess)| x - guess).collect::<Vec<_>>());
        let way = step.abs() * norm(&here.values.velocities).max(norm(&values.velocities));
        let rounding = f64::EPSILON * 16.0 * (1.0 + norm(&x));
        (bent <= STRAIGHT * way + rounding).then_some(Place { x, values })
    }
}

/// A position of the motion, with the values of the integral there.
struct Place {
    x: Vec<f64>,
    values: Values,
}

impl Place {
    /// The largest |∂²S/∂α∂x|.
    fn steepness(&self) -> f64 {
        self.values.slopes.entries().iter().fold(0.0, |largest, slope| largest.max(slope.abs()))
    }

    /// (x, y)
    fn state(&self) -> Vec<f64> {
        self.x.iter().chain(&self.values.momenta).copied().collect()
    }
}

/// The largest difference of a component of two states in pairs, relative to 1 + its largest size.
fn largest(pairs: &[(Vec<f64>, Vec<f64>)]) -> f64 {
    let components = pairs.first().map_or(0, |(state, _)| state.len());
    let of_component = |i: usize| {
        let size = pairs.iter().fold(0.0f64, |size, (_, b)| size.max(b[i].abs()));
        let difference = pairs.iter().fold(0.0f64, |rest, (a, b)| rest.max((a[i] - b[i]).abs()));
        difference / (1.0 + size)
    };
    (0..components).map(of_component).fold(0.0, f64::max)
}
