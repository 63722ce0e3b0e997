//! Newton's method for F(z) = 0 where solutions may come in families, so that ∂F/∂z need not be regular.

use pc_mech::{Matrix, SingularValues};

use crate::error::AnalysisError;
use crate::numeric::dense::norm;
use crate::numeric::equilibrated::{Equilibrated, aside, larger};

/// Newton's step is taken as it is if it leaves at most this fraction of the residual; otherwise it is damped.
const ENOUGH: f64 = 0.5;

/// A step is long if it exceeds this multiple of 1 + |z|; it may leave at most this fraction of the residual.
const LONG: f64 = 5.0;
const NEARLY_LINEAR: f64 = 1e-3;

/// The largest number of times that a damped step is halved before the iteration ends.
const HALVINGS: usize = 10;

/// The iteration ends if this many steps together do not halve the residual.
const PATIENCE: usize = 10;

/// The ranks that the slopes are given: singular values below these fractions of the largest count as zero. The first is
/// at the rounding errors of stiff but regular systems, the second at those of slopes that have lost digits.
const RANKS: [f64; 2] = [1e-14, 1e-9];

/// A linear equation is solved if at most this fraction of its value is left.
const SOLVED: f64 = 1e-9;

/// The greatest change of the ratio of successive steps near a multiple solution, and the range of such ratios, (m − 1)/m
/// for a solution of multiplicity m.
const STEADY_RATIO: f64 = 0.05;
const MULTIPLE: std::ops::RangeInclusive<f64> = 0.4..=0.95;

/// The largest number of moves along a family, and the gain in distance, as a fraction of the distance, below which they
/// end.
const MOST_MOVES: usize = 30;
const NEAREST: f64 = 1e-13;
const MOST_HALVED: i32 = 6;

/// How far from the start typical slopes are taken.
const ASIDE: f64 = 0.05;

/// Directions of the kernel that are dependent up to this fraction count as one.
const ZERO: f64 = 1e-10;

/// A residual at which only steps are tried that do not follow the rounding errors of nearly singular slopes.
pub(crate) const SMALL: f64 = 1e-12;

/// A residual that rounding errors may leave.
const ROUNDING: f64 = 1e-14;

/// The point at which an iteration ends, with the values there.
#[derive(Clone, Debug)]
pub(crate) struct Iterate {
    /// z
    pub(crate) point: Vec<f64>,
    /// F(z)
    pub(crate) values: Vec<f64>,
    /// ∂F/∂z
    pub(crate) slopes: Matrix<f64>,
    /// The number of steps taken.
    pub(crate) iterations: usize,
    /// The next step, or the last where there is no more, relative to 1 + |z|: about the error of z.
    pub(crate) error: f64,
    /// The largest |∂F/∂z| seen so far, entry by entry.
    typical: Matrix<f64>,
    /// For each component of F, the largest |∂F/∂z| (1 + |z|) seen so far, which the rounding error of F follows. The sizes of
    /// auxiliary components are as the other ones make them.
    sizes: Vec<f64>,
    /// The number of components of z that are not auxiliary.
    measured: usize,
    /// Whether all entries of the slopes take part in their scaling, not only the largest of rows and columns.
    by_all_entries: bool,
}

/// A step to try.
struct Step {
    change: Vec<f64>,
    /// The fraction of the residual that may remain after it.
    rest: f64,
    /// Whether the residual may also be measured by the step that it asks for with the same slopes.
    by_next: bool,
}

/// The slopes at a point, factored.
struct Factored {
    scaled: Equilibrated,
    factors: SingularValues,
    measured: usize,
}

impl Factored {
    fn largest(&self) -> f64 {
        self.factors.values.first().copied().unwrap_or(0.0)
    }

    /// Whether the step to F + (∂F/∂z) δ = 0 leaves little of each component of F, besides its rounding errors.
    fn solves(&self, values: &[f64], sizes: &[f64]) -> bool {
        let scaled =
            |all: &[f64]| -> Vec<f64> { all.iter().zip(&self.scaled.rows).map(|(f, d)| f * d).collect() };
        let (residual, sizes) = (scaled(values), scaled(sizes));
        let rest = self.rest(&residual, &self.refined_step(&residual, RANKS[0]));
        let is_left = |i: usize| rest[i].abs() > (SOLVED * residual[i].abs()).max(SMALL * sizes[i]);
        !(0..rest.len()).any(is_left)
    }

    /// F + (∂F/∂z) δ, all scaled.
    fn rest(&self, residual: &[f64], step: &[f64]) -> Vec<f64> {
        let along = |i: usize| (0..step.len()).map(|j| self.scaled.matrix[(i, j)] * step[j]).sum::<f64>();
        residual.iter().enumerate().map(|(i, f)| f + along(i)).collect()
    }

    /// The step of least squares along singular values above a fraction of the largest.
    fn step(&self, values: &[f64], fraction: f64) -> Vec<f64> {
        let residual: Vec<f64> = values.iter().zip(&self.scaled.rows).map(|(f, d)| f * d).collect();
        self.in_units(self.refined_step(&residual, fraction))
    }

    /// The step of Levenberg and Marquardt with the damping μ.
    fn damped_step(&self, residual: &[f64], damping: f64) -> Vec<f64> {
        self.in_units(self.scaled_step(residual, RANKS[0], damping))
    }

    fn in_units(&self, mut step: Vec<f64>) -> Vec<f64> {
        step.iter_mut().zip(&self.scaled.columns).for_each(|(change, e)| *change *= e);
        step
    }

    /// In two passes, so that each row has rounding errors of its own size (R. D. Skeel, Math. Comp. 35, 1980, 817–832).
    fn refined_step(&self, residual: &[f64], fraction: f64) -> Vec<f64> {
        let mut step = self.scaled_step(residual, fraction, 0.0);
        let more = self.scaled_step(&self.rest(residual, &step), fraction, 0.0);
        step.iter_mut().zip(more).for_each(|(change, more)| *change += more);
        step
    }

    /// −Σ σ/(σ² + μ) (u·F) v over singular values above a fraction of the largest.
    fn scaled_step(&self, residual: &[f64], fraction: f64, damping: f64) -> Vec<f64> {
        let mut step = vec![0.0; self.scaled.columns.len()];
        for l in 0..self.factors.rank(fraction * self.largest()) {
            let sigma = self.factors.values[l];
            let along: f64 = residual.iter().zip(self.factors.left.column(l)).map(|(f, u)| f * u).sum();
            let factor = -sigma * along / (sigma * sigma + damping);
            for (change, v) in step.iter_mut().zip(self.factors.right.column(l)) {
                *change += factor * v;
            }
        }
        step
    }

    /// The shortest step to F + (∂F/∂z) δ = 0.
    fn shortest(&self, values: &[f64], fraction: f64) -> Result<Vec<f64>, AnalysisError> {
        let kernel = self.factors.kernel(self.factors.rank(fraction * self.largest()));
        let scaled = |i: usize, l: usize| self.scaled.columns[i] * kernel[(i, l)];
        let kernel = Matrix::from_fn(kernel.rows(), kernel.columns(), scaled);
        shortened(self.step(values, fraction), &kernel, self.measured)
    }
}

impl Iterate {
    fn at((point, measured): (Vec<f64>, usize), (values, slopes): (Vec<f64>, Matrix<f64>)) -> Iterate {
        let (typical, sizes) = (slopes.clone(), vec![0.0; values.len()]);
        let (iterations, error, by_all_entries) = (0, 0.0, false);
        let mut iterate =
            Iterate { point, values, slopes, iterations, error, typical, sizes, measured, by_all_entries };
        iterate.measure();
        iterate
    }

    /// Takes the slopes here into account in the sizes.
    fn measure(&mut self) {
        self.typical = larger(&self.typical, &self.slopes);
        let units = Equilibrated::by_all_entries(&self.typical, &self.typical).columns;
        let largest = self.point.iter().zip(&units).map(|(z, e)| z.abs() / e).fold(0.0, f64::max);
        let size_of = |(j, z): (usize, &f64)| match j < self.measured {
            true => 1.0 + z.abs(),
            false => units[j] * largest,
        };
        let known: Vec<f64> = self.point.iter().enumerate().map(size_of).collect();
        for (i, size) in self.sizes.iter_mut().enumerate() {
            let terms = known.iter().enumerate().map(|(j, z)| self.slopes[(i, j)].abs() * z);
            *size = size.max(terms.sum());
        }
    }

    /// The size of a step relative to 1 + |z|.
    fn moved_by(&self, step: &[f64]) -> f64 {
        norm(step) / (1.0 + norm(&self.point))
    }

    /// The largest |F_i| relative to the effect of changes of z by its own size.
    pub(crate) fn relative_residual(&self) -> f64 {
        let relative = |(f, size): (&f64, &f64)| if *f == 0.0 { 0.0 } else { f.abs() / size };
        self.values.iter().zip(&self.sizes).map(relative).fold(0.0, f64::max)
    }

    /// The directions of the kernel of the slopes, as columns.
    ///
    /// # Errors
    /// [`AnalysisError`] for slopes that are not finite.
    pub(crate) fn kernel(&self) -> Result<Matrix<f64>, AnalysisError> {
        let Factored { scaled, factors, .. } = self.factored(self.point.len())?;
        let kernel = factors.kernel(factors.rank(RANKS[1] * factors.values.first().copied().unwrap_or(0.0)));
        Ok(Matrix::from_fn(kernel.rows(), kernel.columns(), |i, l| scaled.columns[i] * kernel[(i, l)]))
    }

    /// Whether the relative residual is at most `tolerance`.
    pub(crate) fn is_solution(&self, tolerance: f64) -> bool {
        self.relative_residual() <= tolerance
    }

    fn factored(&self, measured: usize) -> Result<Factored, AnalysisError> {
        let scaled = match self.by_all_entries {
            true => Equilibrated::by_all_entries(&self.slopes, &self.typical),
            false => Equilibrated::by(&self.slopes, &self.typical),
        };
        let factors = SingularValues::of(&scaled.matrix)?;
        Ok(Factored { scaled, factors, measured })
    }

    /// The slopes here, factored. Where equations seem to contradict each other, the scales of all entries are tried.
    fn newly_factored(&mut self, measured: usize) -> Result<Factored, AnalysisError> {
        let factored = self.factored(measured)?;
        if self.by_all_entries || factored.solves(&self.values, &self.sizes) {
            return Ok(factored);
        }
        self.by_all_entries = true;
        let other = self.factored(measured)?;
        self.by_all_entries = other.solves(&self.values, &self.sizes);
        Ok(if self.by_all_entries { other } else { factored })
    }

    /// The steps to try, those of Newton first; `last` is the step before.
    fn steps(&self, factored: &Factored, last: Option<&[f64]>, way: Way) -> Result<Vec<Step>, AnalysisError> {
        let is_small = self.is_solution(SMALL);
        let full = factored.shortest(&self.values, RANKS[0])?;
        let truncated = factored.shortest(&self.values, RANKS[1])?;
        if is_small {
            let mut steps: Vec<Step> = farther(last, &truncated).into_iter().collect();
            if !self.is_solution(ROUNDING) {
                // Where stiff and weak forces act together, the weak ones leave a small residual too.
                steps.push(Step { change: full, rest: NEARLY_LINEAR, by_next: false });
            }
            steps.push(self.undamped(truncated, factored.measured));
            return Ok(steps);
        }
        let mut steps = Vec::new();
        if way == Way::Shortened {
            let shortened = |halvings: usize| {
                let fraction = 0.5f64.powi(halvings as i32);
                Step { change: scaled_by(&full, fraction), rest: 1.0 - fraction / 4.0, by_next: true }
            };
            return Ok((0..HALVINGS).map(shortened).collect());
        }
        if way == Way::Newton {
            steps.extend(farther(last, &full));
            let is_truncated = full == truncated;
            steps.push(self.undamped(full, factored.measured));
            if !is_truncated {
                steps.push(self.undamped(truncated, factored.measured));
            }
        }
        // The steps of Levenberg and Marquardt with μ proportional to |F|: near a family of solutions, they
        // converge quadratically to the nearest one (J. Fan, Y. Yuan, Computing 74, 2005, 23–39).
        let scales = &factored.scaled;
        let point: Vec<f64> = self.point.iter().zip(&scales.columns).map(|(z, e)| z / e).collect();
        let residual: Vec<f64> = self.values.iter().zip(&scales.rows).map(|(f, d)| f * d).collect();
        let largest = factored.largest();
        let share = norm(&residual) / (norm(&residual) + largest * norm(&point));
        let damped = factored.damped_step(&residual, largest * largest * share);
        let halved = |halvings: usize| {
            let fraction = 0.5f64.powi(halvings as i32);
            Step { change: scaled_by(&damped, fraction), rest: 1.0 - 1e-4 * fraction, by_next: false }
        };
        steps.extend((0..HALVINGS).map(halved));
        Ok(steps)
    }

    /// The length of the next step. Above the level of rounding errors, the step takes account of all slopes: of forces that
    /// decay with distance, the residual and the slopes become small together, and the step does not.
    fn distance_left(&self, factored: &Factored) -> Result<f64, AnalysisError> {
        let rank = if self.is_solution(ROUNDING) { RANKS[1] } else { RANKS[0] };
        Ok(self.moved_by(&factored.shortest(&self.values, rank)?[..factored.measured]))
    }

    /// A step as it is. A long one is taken only where F is nearly linear.
    fn undamped(&self, change: Vec<f64>, measured: usize) -> Step {
        let is_long =
            self.point.iter().zip(&change).take(measured).any(|(z, d)| d.abs() > LONG * (1.0 + z.abs()));
        Step { change, rest: if is_long { NEARLY_LINEAR } else { ENOUGH }, by_next: true }
    }

    /// The point after a step, if it leaves little enough of the residual.
    fn after(
        &self,
        (step, factored): (&Step, &Factored),
        f: &mut impl FnMut(&[f64]) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError>,
    ) -> Option<Iterate> {
        let point: Vec<f64> = self.point.iter().zip(&step.change).map(|(z, d)| z + d).collect();
        let (values, slopes) = f(&point).ok()?;
        let relative = |values: &[f64]| {
            let scaled =
                values.iter().zip(&self.sizes).map(|(f, size)| if *size > 0.0 { f / size } else { *f });
            norm(&scaled.collect::<Vec<_>>())
        };
        // The second measure does not depend on the units of F (P. Deuflhard's natural level function).
        let asks = |values: &[f64]| {
            let next = factored.shortest(values, RANKS[0]).ok()?;
            Some(self.moved_by(&next[..factored.measured]))
        };
        let halves = || {
            step.by_next
                && asks(&values).zip(asks(&self.values)).is_some_and(|(next, now)| next < step.rest * now)
        };
        (relative(&values) < step.rest * relative(&self.values) || halves()).then(|| {
            let (typical, sizes) = (self.typical.clone(), self.sizes.clone());
            let (iterations, error) = (self.iterations + 1, self.moved_by(&step.change));
            let (measured, by_all_entries) = (self.measured, self.by_all_entries);
            let mut next = Iterate {
                point,
                values,
                slopes,
                iterations,
                error,
                typical,
                sizes,
                measured,
                by_all_entries,
            };
            next.measure();
            next
        })
    }
}

/// The shortest step of this one and those that differ from it by directions in the kernel of the slopes, which the
/// columns of `kernel` span: of a family of solutions, a near member is sought. Lengths are those of the first `measured`
/// components.
fn shortened(mut step: Vec<f64>, kernel: &Matrix<f64>, measured: usize) -> Result<Vec<f64>, AnalysisError> {
    let length = |l: usize| norm(&kernel.column(l).take(measured).collect::<Vec<_>>());
    let lengths: Vec<f64> = (0..kernel.columns()).map(length).collect();
    let seen: Vec<usize> = (0..kernel.columns()).filter(|&l| lengths[l].is_normal()).collect();
    let direction = |i: usize, l: usize| kernel[(i, seen[l])] / lengths[seen[l]];
    let factors = SingularValues::of(&Matrix::from_fn(measured, seen.len(), direction))?;
    for l in 0..factors.rank(ZERO) {
        let along: f64 =
            factors.left.column(l).zip(&step).map(|(u, change)| u * change).sum::<f64>() / factors.values[l];
        let combination: Vec<f64> = factors.right.column(l).collect();
        for (i, change) in step.iter_mut().enumerate() {
            *change -= along * (0..seen.len()).map(|l| direction(i, l) * combination[l]).sum::<f64>();
        }
    }
    Ok(step)
}

/// The step to a multiple solution, if one is approached.
fn farther(last: Option<&[f64]>, newton: &[f64]) -> Option<Step> {
    let multiplicity = multiplicity(last?, newton)?;
    Some(Step { change: scaled_by(newton, multiplicity), rest: ENOUGH * ENOUGH, by_next: false })
}

/// The multiplicity of the solution that is approached, if two successive steps are those near a multiple one: parallel,
/// with the ratio (m − 1)/m.
fn multiplicity(last: &[f64], step: &[f64]) -> Option<f64> {
    let (along, size) = (dot(last, step), dot(last, last));
    let ratio = along / size;
    let across = (dot(step, step) - along * along / size).max(0.0).sqrt();
    let is_steady = across <= STEADY_RATIO * ratio * size.sqrt();
    (MULTIPLE.contains(&ratio) && is_steady).then(|| 1.0 / (1.0 - ratio))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn scaled_by(step: &[f64], factor: f64) -> Vec<f64> {
    step.iter().map(|change| factor * change).collect()
}

/// Solves F(z) = 0 from `start`, until |F| no longer decreases or `most` steps have been taken. The caller decides whether
/// the residual counts as zero.
///
/// Rows and columns of ∂F/∂z are scaled, so that a linear F takes one step, whatever the units of its components and of z.
/// Steps are damped only where Newton's own does not halve the residual.
///
/// `f` returns F(z) and ∂F/∂z; if it fails after a step, a shorter step is tried.
///
/// # Errors
/// The error of `f` at `start`.
pub(crate) fn solve(
    start: Vec<f64>,
    most: usize,
    f: impl FnMut(&[f64]) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError>,
) -> Result<Iterate, AnalysisError> {
    let measured = start.len();
    solve_near(start, (most, measured), f)
}

/// Moves a solution along its family to the member nearest to `start` in the first `measured` components: the difference
/// from it is projected onto the kernel of the slopes, and the equations are solved again. The solution stays as it is
/// where this does not lead nearer.
///
/// # Errors
/// [`AnalysisError`] for slopes that are not finite.
pub(crate) fn nearest(
    solution: Iterate,
    start: &[f64],
    measured: usize,
    mut f: impl FnMut(&[f64]) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError>,
) -> Result<Iterate, AnalysisError> {
    let distance = |z: &[f64]| norm(&(0..measured).map(|i| z[i] - start[i]).collect::<Vec<_>>());
    let mut here = solution;
    for _ in 0..MOST_MOVES {
        let away: Vec<f64> = here.point.iter().zip(start).map(|(z, start)| start - z).collect();
        // What remains of the difference is orthogonal to the family.
        let across = shortened(away.clone(), &here.kernel()?, measured)?;
        let along = |share: f64| -> Vec<f64> {
            (0..away.len()).map(|i| here.point[i] + share * (away[i] - across[i])).collect()
        };
        // A way that is too long to be followed at once is halved.
        let next = (0..MOST_HALVED).find_map(|halvings| {
            let next = solve_near(along(0.5f64.powi(halvings)), (MOST_MOVES, measured), &mut f).ok()?;
            let gain = distance(&here.point) - distance(&next.point);
            (next.is_solution(SMALL) && gain > NEAREST * distance(&here.point)).then_some(next)
        });
        let Some(next) = next else { break };
        here = next;
    }
    Ok(here)
}

/// As [`solve`], where of a family of solutions a member is sought that is near the start in the first `measured`
/// components; the others are auxiliary, such as multipliers.
///
/// # Errors
/// As there.
pub(crate) fn solve_near(
    start: Vec<f64>,
    bounds: (usize, usize),
    f: impl FnMut(&[f64]) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError>,
) -> Result<Iterate, AnalysisError> {
    solve_by(Way::Newton, start, bounds, f)
}

/// Which steps are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// Those of Newton first, then those of Levenberg and Marquardt.
    Newton,
    /// Those of Newton, shortened until the step that follows is shorter (P. Deuflhard, Numer. Math. 22, 1974, 289–315).
    Shortened,
    /// Those of Levenberg and Marquardt alone, which stay near where the solutions of a family meet others, and lead straight
    /// to the family.
    Damped,
}

/// As [`solve_near`], by steps of one kind.
///
/// # Errors
/// As there.
pub(crate) fn solve_by(
    way: Way,
    start: Vec<f64>,
    (most, measured): (usize, usize),
    mut f: impl FnMut(&[f64]) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError>,
) -> Result<Iterate, AnalysisError> {
    let first = f(&start)?;
    let beside = f(&aside(&start, &vec![1.0; start.len()], ASIDE)).ok();
    let mut here = Iterate::at((start, measured), first);
    if let Some((_, slopes)) = beside {
        here.typical = larger(&here.typical, &slopes);
    }
    let mut last: Option<Vec<f64>> = None;
    let mut residuals = vec![here.relative_residual()];
    loop {
        if here.values.iter().all(|f| *f == 0.0) {
            here.error = 0.0;
            break;
        }
        let steps = here.newly_factored(measured).and_then(|factored| {
            let steps = here.steps(&factored, last.as_deref(), way)?;
            Ok((here.distance_left(&factored)?, factored, steps))
        });
        // Beyond the range of numbers there is no further step.
        let Ok((error, factored, steps)) = steps else {
            here.error = f64::INFINITY;
            break;
        };
        here.error = error;
        if here.iterations >= most {
            break;
        }
        let Some((next, step)) =
            steps.into_iter().find_map(|step| Some((here.after((&step, &factored), &mut f)?, step.change)))
        else {
            break;
        };
        (here, last) = (next, Some(step));
        residuals.push(here.relative_residual());
        let before = residuals.len().checked_sub(PATIENCE + 1).map(|place| residuals[place]);
        if before.is_some_and(|before| here.relative_residual() > ENOUGH * before) {
            break;
        }
    }
    Ok(here)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses, the first tied to the ground, in units in which forces and lengths differ by many orders.
    #[test]
    fn a_linear_system_takes_one_step_whatever_its_scales() {
        for (stiff, force, length) in [(1.0, 1.0, 1.0), (1e6, 1.0, 1.0), (1e6, 1e8, 1e-8), (1e9, 1e-7, 1e5)] {
            let k = [[stiff + 1.0, -stiff], [-stiff, stiff]];
            let slopes = Matrix::from_fn(2, 2, |i, j| k[i][j] * [1.0, force][i] * [length, 1.0][j]);
            let end = solve(vec![0.1 / length, 0.2], 1, |z| {
                let value = |i: usize| (0..2).map(|j| slopes[(i, j)] * z[j]).sum::<f64>() - [1.0, 0.0][i];
                Ok::<_, AnalysisError>(((0..2).map(value).collect(), slopes.clone()))
            });
            let end = end.unwrap_or_else(|error| panic!("{error}"));
            // x = y = 1, by a system of condition `stiff`.
            let error = (end.point[0] * length - 1.0).abs().max((end.point[1] - 1.0).abs());
            assert!(error <= 1e-15 * stiff.max(10.0), "{stiff} {force} {length}: {error:e}");
        }
    }

    /// x⁵ = 0 takes Newton's method ln(10)/ln(5/4) steps for each digit.
    #[test]
    fn a_multiple_solution_is_reached_in_a_few_steps() {
        let end = solve(vec![0.7], 30, |z| {
            Ok::<_, AnalysisError>((vec![z[0].powi(5)], Matrix::from_fn(1, 1, |_, _| 5.0 * z[0].powi(4))))
        });
        let end = end.unwrap_or_else(|error| panic!("{error}"));
        assert!(end.point[0].abs() < 1e-3 && end.iterations < 12, "{end:?}");
    }

    /// Every point of the circle solves the equation, and the second repeats the first.
    #[test]
    fn a_family_is_reached_at_a_near_point() {
        let end = solve(vec![3.0, 4.0], 20, |z| {
            let distance = z[0] * z[0] + z[1] * z[1] - 1.0;
            let slopes = Matrix::from_fn(2, 2, |i, j| [1.0, -7.0][i] * 2.0 * z[j]);
            Ok::<_, AnalysisError>((vec![distance, -7.0 * distance], slopes))
        });
        let end = end.unwrap_or_else(|error| panic!("{error}"));
        assert!((end.point[0] - 0.6).abs() < 1e-14 && (end.point[1] - 0.8).abs() < 1e-14, "{end:?}");
    }
}
