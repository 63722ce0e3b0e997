//! Motions along surfaces to which a vector field leads back from both sides.

use crate::ode::failure::Failure;
use crate::ode::switching::Switching;

/// Up to this number of surfaces, f is evaluated on each combination of their sides.
const MOST_COMBINED: usize = 3;
/// A pivot below this fraction of the largest entry of its row counts as zero.
const SINGULAR: f64 = 1e-12;
/// Linearly dependent equations contradict each other if they differ by more than this.
const CONTRADICTS: f64 = 1e-7;
/// f does not count as a sum of the changes at single surfaces if its relative difference from such a sum is
/// larger than this.
const ADDS_UP: f64 = 1e-9;
/// Maximum number of steps of Newton's method.
const MOST_STEPS: usize = 50;

/// The motion that slides along some surfaces, given by Filippov's combination [Filippov 1988, § 4]: with f± on the
/// two sides of g = 0,
/// ```text
/// ẏ = (1 + σ)/2 f⁺ + (1 − σ)/2 f⁻,   g_t + g_y ẏ = 0,   |σ| ≤ 1.
/// ```
/// Along several surfaces f is the product of such combinations,
/// ```text
/// ẏ = Σ_s Π_i (1 + s_i σ_i)/2 f(s),   s_i = ±1
/// ```
/// [Alexander, Seidman, Houston J. Math. 24 (1998) 545], for more than three of them only if it is a sum of the changes
/// at each surface. If dg/dt is the same on all sides, as for a force that jumps with a position, and vanishes, d²g/dt² =
/// 0 takes its place: a body rests at the bottom of a groove. If several σ give the same ẏ, the smallest are taken.
#[derive(Clone, Debug)]
pub struct Sliding {
    /// The surfaces, in ascending order.
    pub surfaces: Vec<usize>,
    /// σ of each.
    pub weights: Vec<f64>,
    /// For each surface, the change of dg/dt with its σ: negative where f leads back to the surface.
    pub slopes: Vec<f64>,
    /// For each surface whose slope is the change of d²g/dt² instead, the value of dg/dt on it.
    pub resting: Vec<Option<f64>>,
    /// ẏ
    pub rates: Vec<f64>,
}

/// Surfaces whose sides do not determine how a motion slides along them.
#[derive(Debug, thiserror::Error)]
pub enum SlidingError {
    /// dg/dt does not depend on the sides.
    #[error("the sides of {} do not determine how the motion slides along them", surfaces.join(", "))]
    Undetermined {
        /// Their functions.
        surfaces: Vec<String>,
    },
    /// f has no series along the surfaces.
    #[error("the motion slides along {}, where it has no series: choose another method", surfaces.join(", "))]
    NoSeries {
        /// Their functions.
        surfaces: Vec<String>,
    },
    /// f is not a sum of the changes at single surfaces.
    #[error(
        "the motion slides along more than {MOST_COMBINED} surfaces at once, {}, whose effects do not add up",
        surfaces.join(", ")
    )]
    Entangled {
        /// Their functions.
        surfaces: Vec<String>,
    },
}

impl Sliding {
    /// The motion at (t, y) along the surfaces whose sides are 0.
    ///
    /// # Errors
    /// [`Failure`] where f has no value, or with a [`SlidingError`].
    pub fn of(
        field: &mut (impl Switching + ?Sized),
        sides: &[f64],
        t: f64,
        y: &[f64],
    ) -> Result<Sliding, Failure> {
        let surfaces: Vec<usize> = (0..sides.len()).filter(|&k| sides[k] == 0.0).collect();
        let named = |all: &[String]| surfaces.iter().map(|&surface| all[surface].clone()).collect();
        let Some(combination) = Combination::of(field, (sides, &surfaces), (t, y))? else {
            let surfaces = named(field.surfaces());
            return Err(Failure::fatal(SlidingError::Entangled { surfaces }));
        };
        let changes = combination.changes(&vec![0.0; surfaces.len()]);
        let (mut normals, mut resting) = (Vec::with_capacity(surfaces.len()), Vec::new());
        for &surface in &surfaces {
            let mut normal = vec![0.0; y.len()];
            let by_time = field.gradient(surface, t, y, &mut normal);
            let is_moved = changes.iter().any(|change| {
                let terms = normal.iter().zip(change).map(|(slope, change)| slope * change);
                let (sum, size) =
                    terms.fold((0.0, 0.0), |(sum, size): (f64, f64), term| (sum + term, size + term.abs()));
                sum.abs() > SINGULAR * size
            });
            resting.push(if is_moved {
                None
            } else {
                let above: Vec<f64> = sides.iter().map(|side| if *side < 0.0 { -1.0 } else { 1.0 }).collect();
                Some(rate(field, surface, (&above, t, y))?)
            });
            normals.push(if is_moved {
                (by_time, normal)
            } else {
                second_normal(field, surface, sides, (t, y))?
            });
        }
        match combination.solve(&normals) {
            Some((weights, slopes)) => {
                let rates = combination.value(&weights);
                Ok(Sliding { surfaces, weights, slopes, resting, rates })
            }
            None => {
                let surfaces = named(field.surfaces());
                Err(Failure::recoverable(SlidingError::Undetermined { surfaces }))
            }
        }
    }
}

/// dg/dt on these sides, none of them 0.
fn rate(
    field: &mut (impl Switching + ?Sized),
    surface: usize,
    (sides, t, y): (&[f64], f64, &[f64]),
) -> Result<f64, Failure> {
    let (mut rates, mut normal) = (vec![f64::NAN; y.len()], vec![0.0; y.len()]);
    field.rates(sides, t, y, &mut rates)?;
    let by_time = field.gradient(surface, t, y, &mut normal);
    Ok(normal.iter().zip(&rates).fold(by_time, |sum, (slope, rate)| sum + slope * rate))
}

/// The derivatives of dg/dt with respect to time and state, as difference quotients, on the positive side of
/// the surfaces whose sides are 0.
fn second_normal(
    field: &mut (impl Switching + ?Sized),
    surface: usize,
    sides: &[f64],
    (t, y): (f64, &[f64]),
) -> Result<(f64, Vec<f64>), Failure> {
    let above: Vec<f64> = sides.iter().map(|side| if *side < 0.0 { -1.0 } else { 1.0 }).collect();
    let mut quotient = |at: &mut dyn FnMut(f64) -> (f64, Vec<f64>), size: f64| -> Result<f64, Failure> {
        let step = f64::EPSILON.cbrt() * size.abs().max(1.0);
        let mut values = [0.0; 2];
        for (value, step) in values.iter_mut().zip([step, -step]) {
            let (t, y) = at(step);
            *value = rate(field, surface, (&above, t, &y))?;
        }
        Ok((values[0] - values[1]) / (2.0 * step))
    };
    let by_time = quotient(&mut |step| (t + step, y.to_vec()), t)?;
    let mut normal = Vec::with_capacity(y.len());
    for i in 0..y.len() {
        let mut at = |step: f64| {
            let mut moved = y.to_vec();
            moved[i] += step;
            (t, moved)
        };
        normal.push(quotient(&mut at, y[i])?);
    }
    Ok((by_time, normal))
}

/// f as a function of the σ.
enum Combination {
    /// f on each combination of sides; bit i of the index is set if surface i has side 1.
    Products(Vec<Vec<f64>>),
    /// f at σ = 0, then the change of f with each σ.
    Sum(Vec<f64>, Vec<Vec<f64>>),
}

impl Combination {
    /// `None` if f has neither form.
    fn of(
        field: &mut (impl Switching + ?Sized),
        (sides, surfaces): (&[f64], &[usize]),
        (t, y): (f64, &[f64]),
    ) -> Result<Option<Combination>, Failure> {
        let m = surfaces.len();
        let mut all = sides.to_vec();
        let mut at = |is_above: &dyn Fn(usize) -> bool| -> Result<Vec<f64>, Failure> {
            for (i, &surface) in surfaces.iter().enumerate() {
                all[surface] = if is_above(i) { 1.0 } else { -1.0 };
            }
            let mut rates = vec![f64::NAN; y.len()];
            field.rates(&all, t, y, &mut rates)?;
            Ok(rates)
        };
        if m <= MOST_COMBINED {
            let corners = (0..1usize << m).map(|corner| at(&|i| corner >> i & 1 == 1));
            return Ok(Some(Combination::Products(corners.collect::<Result<_, _>>()?)));
        }
        let above = at(&|_| true)?;
        let mut changes = Vec::with_capacity(m);
        for other in 0..m {
            let below = at(&|i| i != other)?;
            changes.push(above.iter().zip(&below).map(|(a, b)| 0.5 * (a - b)).collect::<Vec<f64>>());
        }
        let below = at(&|_| false)?;
        let mut middle = above.clone();
        let mut adds_up = true;
        for i in 0..y.len() {
            let (sum, size) = changes
                .iter()
                .fold((0.0, above[i].abs()), |(sum, size), change| (sum + change[i], size + change[i].abs()));
            middle[i] -= sum;
            let difference = (above[i] - 2.0 * sum - below[i]).abs();
            adds_up &= difference <= ADDS_UP * size;
        }
        Ok(adds_up.then_some(Combination::Sum(middle, changes)))
    }

    fn value(&self, weights: &[f64]) -> Vec<f64> {
        match self {
            Combination::Products(corners) => {
                let part = |corner: usize| -> f64 {
                    let factor = |(i, weight): (usize, &f64)| {
                        0.5 * (1.0 + if corner >> i & 1 == 1 { *weight } else { -weight })
                    };
                    weights.iter().enumerate().map(factor).product()
                };
                let mut value = vec![0.0; corners[0].len()];
                for (corner, rates) in corners.iter().enumerate() {
                    let part = part(corner);
                    value.iter_mut().zip(rates).for_each(|(value, rate)| *value += part * rate);
                }
                value
            }
            Combination::Sum(middle, changes) => {
                let mut value = middle.clone();
                for (change, weight) in changes.iter().zip(weights) {
                    value.iter_mut().zip(change).for_each(|(value, change)| *value += weight * change);
                }
                value
            }
        }
    }

    /// The change of f with each σ.
    fn changes(&self, weights: &[f64]) -> Vec<Vec<f64>> {
        match self {
            Combination::Sum(_, changes) => changes.clone(),
            Combination::Products(_) => (0..weights.len())
                .map(|i| {
                    let at = |weight: f64| {
                        let mut moved = weights.to_vec();
                        moved[i] = weight;
                        self.value(&moved)
                    };
                    at(1.0).iter().zip(at(-1.0)).map(|(above, below)| 0.5 * (above - below)).collect()
                })
                .collect(),
        }
    }

    /// The σ for which all g stay zero, by Newton's method, and the change of each dg/dt with its σ; `None` if the σ
    /// are not determined.
    fn solve(&self, normals: &[(f64, Vec<f64>)]) -> Option<(Vec<f64>, Vec<f64>)> {
        let along = |i: usize, rates: &[f64]| -> f64 {
            normals[i].1.iter().zip(rates).map(|(slope, rate)| slope * rate).sum()
        };
        let m = normals.len();
        let mut weights = vec![0.0; m];
        let mut last = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let rates = self.value(&weights);
            let changes = self.changes(&weights);
            let rows: Vec<Vec<f64>> = (0..m)
                .map(|i| {
                    let slopes = changes.iter().map(|change| along(i, change));
                    slopes.chain([-(normals[i].0 + along(i, &rates))]).collect()
                })
                .collect();
            let slopes = (0..m).map(|i| rows[i][i]).collect();
            let step = smallest(&rows)?;
            weights.iter_mut().zip(&step).for_each(|(weight, step)| *weight += step);
            let size = step.iter().fold(0.0, |size: f64, step| size.max(step.abs()));
            let is_linear = m == 1 || matches!(self, Combination::Sum(..));
            if is_linear || size <= 1e-15 || size < 1e-10 && size >= last {
                return weights.iter().all(|weight| weight.is_finite()).then_some((weights, slopes));
            }
            last = size;
        }
        None
    }
}

/// The smallest solution of linear equations, each row ending with its right-hand side; `None` if they contradict
/// each other.
fn smallest(rows: &[Vec<f64>]) -> Option<Vec<f64>> {
    let m = rows.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut solution = vec![0.0; m];
    let mut directions: Vec<Vec<f64>> = Vec::with_capacity(m);
    for row in rows {
        let (slopes, right) = (&row[..m], row[m]);
        let mut rest = slopes.to_vec();
        // Twice is enough [Giraud et al. 2005].
        for _ in 0..2 {
            for direction in &directions {
                let along = dot(direction, &rest);
                rest.iter_mut().zip(direction).for_each(|(rest, q)| *rest -= along * q);
            }
        }
        let size = dot(slopes, slopes).sqrt();
        let length = dot(&rest, &rest).sqrt();
        let left = right - dot(slopes, &solution);
        if length > SINGULAR * size && length > 0.0 {
            rest.iter_mut().for_each(|rest| *rest /= length);
            solution.iter_mut().zip(&rest).for_each(|(solution, q)| *solution += left / length * q);
            directions.push(rest);
            continue;
        }
        let contradicts = left.abs() > CONTRADICTS * (right.abs() + size);
        if contradicts || left.is_nan() {
            return None;
        }
    }
    Some(solution)
}
