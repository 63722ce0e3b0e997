//! Equilibria and steady motions: the rates of all but the cyclic coordinates vanish.

use pc_mech::{EvaluationError, Matrix, MechError, Motion, Pattern, VectorField};

use crate::error::{AnalysisError, shape};
use crate::numeric::equilibrated::{aside, larger};
use crate::numeric::{dense::norm, newton};
use crate::stability::spectrum::{Spectrum, Verdict};

/// Options of the search for a steady motion.
///
/// ```
/// use pc_analysis::{SteadyMotion, SteadyOptions};
/// use pc_mech::{Graph, System};
///
/// // A particle on a turntable's radius: r̈ = rφ̇² − r + 1, φ cyclic.
/// let graph = Graph::new();
/// let mut motion = System::builder(&graph)
///     .coordinates(["r", "φ"])
///     .lagrangian(|_, x, v| (v[0].square() + x[0].square() * v[1].square() - (x[0] - 1.0).square()) / 2.0)
///     .build()?
///     .poincare()?
///     .compile()?;
/// let options = SteadyOptions::default().fixed(["φ'"]);
/// let circle = SteadyMotion::near(&mut motion, 0.0, &[1.0, 0.0, 0.1, 0.5], &options)?;
/// assert!((circle.state[0] - 4.0 / 3.0).abs() < 1e-14);
/// assert_eq!(circle.rates, [("φ".to_owned(), 0.5)]);
/// # Ok::<(), pc_analysis::AnalysisError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyOptions {
    cyclic: Option<Vec<String>>,
    fixed: Vec<String>,
    iterations: usize,
    tolerance: f64,
}

impl Default for SteadyOptions {
    /// The default options: the cyclic coordinates of the equations, no fixed components, 100 steps, a
    /// relative residual of 10⁻¹².
    fn default() -> SteadyOptions {
        SteadyOptions { cyclic: None, fixed: Vec::new(), iterations: 100, tolerance: 1e-12 }
    }
}

impl SteadyOptions {
    /// Names the cyclic coordinates, whose rates need not vanish. By default, these are all coordinates on
    /// which no rates depend except those of cyclic ones.
    #[must_use]
    pub fn cyclic<S: Into<String>>(self, names: impl IntoIterator<Item = S>) -> SteadyOptions {
        SteadyOptions { cyclic: Some(names.into_iter().map(Into::into).collect()), ..self }
    }

    /// Names components of the state that keep the value they have in the guess: they select one member of a
    /// family of steady motions. Without them, the member near the guess is found.
    #[must_use]
    pub fn fixed<S: Into<String>>(self, names: impl IntoIterator<Item = S>) -> SteadyOptions {
        SteadyOptions { fixed: names.into_iter().map(Into::into).collect(), ..self }
    }

    /// The largest number of steps.
    pub(crate) fn most_iterations(&self) -> usize {
        self.iterations
    }

    /// The residual that counts as zero.
    pub(crate) fn residual(&self) -> f64 {
        self.tolerance
    }

    /// The indices of the components that keep their values among the components with these names.
    pub(crate) fn fixed_among(&self, names: &[String]) -> Result<Vec<usize>, AnalysisError> {
        indices(names, &self.fixed)
    }

    /// Whether the component keeps its value.
    pub(crate) fn holds(&self, name: &str) -> bool {
        self.fixed.iter().any(|fixed| fixed == name)
    }

    /// The largest number of steps.
    #[must_use]
    pub fn iterations(self, iterations: usize) -> SteadyOptions {
        SteadyOptions { iterations, ..self }
    }

    /// The residual |f| that counts as zero, in units of |∂f/∂y| (1 + |y|). The iteration continues as long
    /// as the residual falls, so that it usually reaches the level of rounding errors, whatever this value
    /// is.
    #[must_use]
    pub fn tolerance(self, tolerance: f64) -> SteadyOptions {
        SteadyOptions { tolerance, ..self }
    }
}

/// An equilibrium or a steady motion (Routh): f_i(t, y) = 0 for all components i but the cyclic coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyMotion {
    /// y, one number for each component of the state; cyclic coordinates have the values of the guess.
    pub state: Vec<f64>,
    /// √Σ f_i² over the components that are not cyclic.
    pub residual: f64,
    /// The cyclic coordinates with their rates, which are constant.
    pub rates: Vec<(String, f64)>,
    /// The names of the other components, r of them, in the order of the state.
    pub components: Vec<String>,
    /// ∂f_i/∂y_j for these components, r × r: the first approximation δẏ = A δy in the reduced variables.
    pub first_approximation: Matrix<f64>,
    /// Its spectrum.
    pub spectrum: Spectrum,
    /// The uncertainty of the state, relative to 1 + |y|.
    pub(crate) uncertainty: f64,
}

impl SteadyMotion {
    /// The equilibrium or steady motion near `guess` at time t: f_i(t, y) = 0 for all components i but the
    /// cyclic coordinates.
    ///
    /// Steady motions come in families, so that these equations do not determine y: the iteration converges
    /// to a solution near the guess, and components can be [fixed](SteadyOptions::fixed). For a
    /// time-dependent system the result is an equilibrium of the rates at that time.
    ///
    /// # Errors
    /// [`AnalysisError::NoSteadyMotion`] with the best state found; [`AnalysisError::NotSmooth`] if the
    /// rates have no derivatives; [`AnalysisError::UnknownComponent`], [`AnalysisError::NotCyclic`] for
    /// unsuitable names; otherwise as [`first_approximation`].
    pub fn near(
        motion: &mut Motion,
        t: f64,
        guess: &[f64],
        options: &SteadyOptions,
    ) -> Result<SteadyMotion, AnalysisError> {
        let size = motion.dim();
        SteadyMotion::on_surface(motion, t, guess, options, |_| {
            Ok((Vec::new(), Matrix::from_fn(0, size, |_, _| 0.0)))
        })
    }

    /// The steady motion among the states with g(y) = 0, for coordinates that are not independent, such as
    /// those with γ² = 1.
    ///
    /// `surface` returns g(y), m numbers, and ∂g/∂y, m × n, for a state y of n components. Steady motions
    /// remain steady only if the functions g are constant along the motion.
    ///
    /// # Errors
    /// As [`near`](SteadyMotion::near), and the errors of `surface`.
    pub fn on_surface(
        motion: &mut Motion,
        t: f64,
        guess: &[f64],
        options: &SteadyOptions,
        mut surface: impl FnMut(&[f64]) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError>,
    ) -> Result<SteadyMotion, AnalysisError> {
        shape("the guess", guess.len(), motion.dim())?;
        let cyclic = cyclic_among(motion, options.cyclic.as_deref())?;
        let fixed = options.fixed_among(motion.names())?;
        let kept: Vec<usize> = (0..motion.dim()).filter(|i| !cyclic.contains(i)).collect();
        let free: Vec<usize> = kept.iter().copied().filter(|i| !fixed.contains(i)).collect();

        let mut state = guess.to_vec();
        let start = free.iter().map(|&j| guess[j]).collect();
        let end = newton::solve(start, options.iterations, |z| {
            for (&j, &value) in free.iter().zip(z) {
                state[j] = value;
            }
            let rates = motion.rates(t, &state)?;
            let slopes = part(&first_approximation(motion, t, &state)?, &kept, &free);
            let (distances, normals) = surface(&state)?;
            let values = kept.iter().map(|&i| rates[i]).chain(distances).collect();
            let on_surface = |i: usize, j: usize| normals[(i - kept.len(), free[j])];
            let rows = kept.len() + normals.rows();
            let entry = |i, j| if i < kept.len() { slopes[(i, j)] } else { on_surface(i, j) };
            Ok((values, Matrix::from_fn(rows, free.len(), entry)))
        })?;
        for (&j, &value) in free.iter().zip(&end.point) {
            state[j] = value;
        }
        if !end.is_solution(options.tolerance) || end.error > NEAR {
            let residual = norm(&end.values[..kept.len()]);
            let state = motion.names().iter().cloned().zip(state).collect();
            return Err(AnalysisError::NoSteadyMotion { residual, iterations: end.iterations, t, state });
        }
        let uncertainty = end.relative_residual().max(end.error);
        let units = vec![1.0; state.len()];
        SteadyMotion::at(motion, (t, state), &units, (&cyclic, &[]), uncertainty)
    }

    /// The steady motion at a state, except that the `moving` coordinates have constant rates and the `varying`
    /// components follow from the others. The conditions of steady motion hold up to `uncertainty`, relative to the effect
    /// of a change of the state by its own size and its `units`.
    ///
    /// # Errors
    /// [`AnalysisError::NotSmooth`]; otherwise as [`first_approximation`].
    pub(crate) fn at(
        motion: &mut Motion,
        (t, state): (f64, Vec<f64>),
        units: &[f64],
        (moving, varying): (&[usize], &[usize]),
        uncertainty: f64,
    ) -> Result<SteadyMotion, AnalysisError> {
        let kept: Vec<usize> = (0..motion.dim()).filter(|i| !moving.contains(i)).collect();
        let rates = motion.rates(t, &state)?;
        let whole = first_approximation(motion, t, &state)?;
        let matrix = part(&whole, &kept, &kept);
        check_smooth(motion, t, (&state, units), &kept, &matrix)?;
        let noise = part(&errors(motion, (t, &state), units, &whole, uncertainty), &kept, &kept);
        let is_constant = |i: &&usize| !varying.contains(i);
        Ok(SteadyMotion {
            residual: norm(&kept.iter().filter(is_constant).map(|&i| rates[i]).collect::<Vec<_>>()),
            rates: moving.iter().map(|&i| (motion.names()[i].clone(), rates[i])).collect(),
            components: kept.iter().map(|&i| motion.names()[i].clone()).collect(),
            spectrum: Spectrum::with_noise(&matrix, &noise)?,
            first_approximation: matrix,
            state,
            uncertainty,
        })
    }

    /// The verdict of the first approximation on stability with respect to the components that are not cyclic.
    pub fn verdict(&self) -> Verdict {
        self.spectrum.verdict()
    }
}

/// The matrix A = ∂f/∂y of the first approximation δẏ = A δy at (t, y), n × n for a state of n
/// components.
///
/// Its [`Spectrum`] is that of all components, including cyclic coordinates.
///
/// # Errors
/// [`ShapeError`](pc_mech::ShapeError); [`EvaluationError::NotCompiled`] without the Jacobian; the errors of
/// [`rhs`](VectorField::rhs) if f is not defined.
pub fn first_approximation(motion: &mut Motion, t: f64, y: &[f64]) -> Result<Matrix<f64>, AnalysisError> {
    let n = motion.dim();
    shape("the state", y.len(), n)?;
    let mut entries = vec![0.0; n * n];
    motion.jacobian(t, y, &mut entries)?;
    Ok(Matrix::from_fn(n, n, |i, j| entries[i + j * n]))
}

/// The next step of Newton's method at a solution, relative to 1 + |y|, is at most this: forces that decay with distance
/// fall below any residual on the way to infinity, in steps as long as the way.
pub(crate) const NEAR: f64 = 1e-2;

/// A change of the state by a few rounding errors, and the margin by which the changes it causes are exceeded.
const ROUNDING: f64 = 4.0 * f64::EPSILON;
const SAFETY: f64 = 8.0;

/// The errors of the first approximation at (t, y): its changes as the state changes by rounding, or by its `uncertainty`
/// relative to the unit and |y| together. They exceed the rounding of single numbers where large forces cancel.
pub(crate) fn errors(
    motion: &mut Motion,
    (t, state): (f64, &[f64]),
    units: &[f64],
    approximation: &Matrix<f64>,
    uncertainty: f64,
) -> Matrix<f64> {
    let mut errors = approximation.map(|_| 0.0);
    for side in [1.0, -1.0] {
        let beside = aside(state, units, side * uncertainty.max(ROUNDING));
        let Ok(there) = first_approximation(motion, t, &beside) else { continue };
        let change = |i: usize, j: usize| SAFETY * (there[(i, j)] - approximation[(i, j)]);
        errors = larger(&errors, &Matrix::from_fn(errors.rows(), errors.columns(), change));
    }
    errors
}

/// At the distance `BESIDE`, relative to 1 + |y|, derivatives differ from those at the state by at most
/// `AS_THERE` of their size there or at the distance `FARTHER`, unless rates have no derivatives at the
/// state: Newton's method may end some rounding errors away from a pole of the coordinates.
const BESIDE: f64 = 1e-7;
const FARTHER: f64 = 1e-2;
const AS_THERE: f64 = 1e-3;

/// Checks that the slopes of the rates are continuous at the state.
pub(crate) fn check_smooth(
    motion: &mut Motion,
    t: f64,
    (state, units): (&[f64], &[f64]),
    kept: &[usize],
    slopes: &Matrix<f64>,
) -> Result<(), AnalysisError> {
    // All components shifted to one side, each by a different amount.
    let size = 1.0 + norm(&state.iter().zip(units).map(|(y, unit)| y / unit).collect::<Vec<_>>());
    let mut at = |distance: f64| {
        let step = |i: usize| distance * size * units[i] * (1.0 + 0.3 * (1.0 + i as f64).sqrt().fract());
        let there: Vec<f64> = state.iter().enumerate().map(|(i, y)| y + step(i)).collect();
        Ok::<_, AnalysisError>(part(&first_approximation(motion, t, &there)?, kept, kept))
    };
    let largest = |a: &Matrix<f64>| a.entries().iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
    // Where rates are products of velocities, all slopes vanish at rest.
    let scale = at(FARTHER).map_or(0.0, |farther| largest(&farther)).max(largest(slopes));
    let is_near = |there: &Matrix<f64>| {
        let (there, here) = (there.entries(), slopes.entries());
        there.iter().zip(here.iter()).all(|(a, b)| (a - b).abs() <= AS_THERE * scale)
    };
    let beside = [BESIDE, -BESIDE].map(&mut at);
    if beside.iter().all(|there| there.as_ref().is_ok_and(is_near)) {
        return Ok(());
    }
    let state = motion.names().iter().cloned().zip(state.iter().copied()).collect();
    Err(AnalysisError::NotSmooth { state })
}

/// The indices of the components with these names.
fn indices(known: &[String], names: &[String]) -> Result<Vec<usize>, AnalysisError> {
    let place = |name: &String| {
        let place = known.iter().position(|known| known == name);
        place.ok_or_else(|| AnalysisError::UnknownComponent { name: name.clone(), known: known.to_vec() })
    };
    names.iter().map(place).collect()
}

/// The indices of the cyclic coordinates: of the named ones, or of all.
fn cyclic_among(motion: &Motion, named: Option<&[String]>) -> Result<Vec<usize>, AnalysisError> {
    let pattern =
        motion.sparsity().ok_or(MechError::Evaluation(EvaluationError::NotCompiled { what: "Jacobian" }))?;
    let all: Vec<usize> = (0..motion.coordinates()).collect();
    let Some(named) = named else { return Ok(cyclic_coordinates(pattern, &all)) };
    let cyclic = indices(motion.names(), named)?;
    for &j in &cyclic {
        let other = pattern.column(j).iter().find(|i| !cyclic.contains(i));
        if let Some(&i) = other {
            let [coordinate, component] = [j, i].map(|i| motion.names()[i].clone());
            return Err(AnalysisError::NotCyclic { coordinate, component });
        }
    }
    Ok(cyclic)
}

/// The largest set of `candidates` among the coordinates on which no rates depend except those of the set itself.
pub(crate) fn cyclic_coordinates(pattern: &Pattern, candidates: &[usize]) -> Vec<usize> {
    let mut cyclic = candidates.to_vec();
    loop {
        let ends_in = |j: &usize| pattern.column(*j).iter().all(|i| cyclic.contains(i));
        let rest: Vec<usize> = cyclic.iter().copied().filter(ends_in).collect();
        if rest.len() == cyclic.len() {
            return rest;
        }
        cyclic = rest;
    }
}

fn part(matrix: &Matrix<f64>, rows: &[usize], columns: &[usize]) -> Matrix<f64> {
    Matrix::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])])
}
