//! Stability as shown by the second variation of the energy under constant integrals (Routh; Chetaev's bundle
//! of integrals; energy and Casimirs).

use pc_mech::{Equations, Expr, Graph, Matrix, MechError, SingularValues};

use crate::error::{AnalysisError, shape};
use crate::numeric::dense::{norm, product, symmetric_eigenvalues};
use crate::stability::definite::{combination, definite_combination};
use crate::stability::spectrum::Verdict;

/// The second variation of F = H + λ_j I_j at a steady motion where dF = 0, restricted to the deviations with
/// dI_j = 0.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondVariation {
    /// The components of the state on which H or an integral depends; the others are ignored.
    pub variables: Vec<String>,
    /// The names of the integrals with the multipliers λ_j.
    pub multipliers: Vec<(String, f64)>,
    /// |dH + λ_j dI_j| relative to the largest of |dH|, |dI_j| and |d²H| (1 + |y|): zero up to rounding at a steady motion.
    pub residual: f64,
    /// The eigenvalues of the second variation on the kernel of the dI_j, in ascending order.
    pub eigenvalues: Vec<f64>,
    /// The absolute value up to which an eigenvalue counts as zero.
    pub tolerance: f64,
    /// [`Stable`](Verdict::Stable) if it is definite, otherwise [`Undecided`](Verdict::Undecided).
    pub verdict: Verdict,
}

impl SecondVariation {
    /// The numbers of positive, negative and zero eigenvalues.
    pub fn signature(&self) -> (usize, usize, usize) {
        let positive = self.eigenvalues.iter().filter(|&&value| value > self.tolerance).count();
        let negative = self.eigenvalues.iter().filter(|&&value| value < -self.tolerance).count();
        (positive, negative, self.eigenvalues.len() - positive - negative)
    }
}

/// The slopes and curvatures of one function at the state.
struct Expansion {
    gradient: Vec<f64>,
    hessian: Matrix<f64>,
}

impl SecondVariation {
    /// The second variation of the energy at the steady motion `state`, (x, η), under the
    /// [integrals](pc_mech::System::integrals) of the system.
    ///
    /// With d(H + λ_j I_j) = 0 there, where λ is found by least squares, a second variation that is definite
    /// on the common kernel of the dI_j proves that the steady motion is stable: H + λ_j I_j ± κ (I_j −
    /// I_j(y))² has a strict extremum at y for large κ. This does not require the dI_j to be independent. If
    /// the dI_j are linearly dependent, the λ_j are not determined, and values are sought for which the form
    /// is definite.
    ///
    /// Stability means stability with respect to the [variables](SecondVariation::variables). Redundant
    /// coordinates are variables: their constraints, such as γ² = 1, must be among the integrals.
    ///
    /// # Errors
    /// [`AnalysisError::NotConserved`] if H or an integral changes along motions or depends on time;
    /// [`ShapeError`](pc_mech::ShapeError); [`ExprError::UnboundSymbol`](pc_mech::ExprError::UnboundSymbol).
    pub fn at(equations: &Equations<'_>, state: &[f64]) -> Result<SecondVariation, AnalysisError> {
        SecondVariation::under(equations, equations.system().integrals(), state)
    }

    /// The second variation under the given integrals, which are functions of (x, η) and parameters, with
    /// their names.
    ///
    /// # Errors
    /// As [`at`](SecondVariation::at).
    pub fn under<'g>(
        equations: &Equations<'g>,
        integrals: &[(String, Expr<'g>)],
        state: &[f64],
    ) -> Result<SecondVariation, AnalysisError> {
        let system = equations.system();
        let symbols = system.state();
        shape("the state", state.len(), symbols.len())?;
        check_conserved(equations, integrals, &symbols)?;

        let values = symbols.iter().copied().zip(state.iter().copied());
        let values: Vec<(Expr<'g>, f64)> = values.chain(system.parameters().iter().copied()).collect();
        SecondVariation::among((system.graph(), equations.energy(), integrals), (&symbols, &values), None)
    }

    /// The second variation of the energy under conserved functions, given with their names, at the `values` of the `state`
    /// and of parameters; `directions` are the deviations of the state that are possible, as columns, all of them unless
    /// they are given.
    ///
    /// A function may be any that is constant on the motions considered: an integral, a constraint on positions, or a
    /// condition on velocities.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`](pc_mech::ExprError::UnboundSymbol).
    pub(crate) fn among<'g>(
        (graph, energy, conserved): (&'g Graph, Expr<'g>, &[(String, Expr<'g>)]),
        (state, values): (&[Expr<'g>], &[(Expr<'g>, f64)]),
        directions: Option<&Matrix<f64>>,
    ) -> Result<SecondVariation, AnalysisError> {
        let functions: Vec<Expr<'g>> =
            [energy].into_iter().chain(conserved.iter().map(|&(_, f)| f)).collect();
        let places: Vec<usize> =
            (0..state.len()).filter(|&i| functions.iter().any(|f| f.depends_on(state[i]))).collect();
        let variables: Vec<Expr<'g>> = places.iter().map(|&i| state[i]).collect();
        let expansions: Vec<Expansion> =
            functions.iter().map(|&f| expand(graph, f, &variables, values)).collect::<Result<_, _>>()?;
        let directions =
            directions.map(|all| Matrix::from_fn(places.len(), all.columns(), |i, j| all[(places[i], j)]));
        let size = 1.0 + norm(&values.iter().take(state.len()).map(|&(_, y)| y).collect::<Vec<_>>());
        let names = conserved.iter().map(|(name, _)| name.clone());
        // In units of their own no function hides another.
        let units: Vec<f64> = expansions.iter().map(|expansion| expansion.unit(size)).collect();
        let scaled: Vec<Expansion> =
            expansions.iter().zip(&units).map(|(expansion, unit)| expansion.divided_by(*unit)).collect();
        let mut result = decide(&scaled, size, directions.as_ref())?;
        result.variables = variables.iter().map(Expr::to_string).collect();
        let multipliers = names.zip(result.multipliers).zip(&units[1..]);
        result.multipliers =
            multipliers.map(|((name, (_, value)), unit)| (name, value * units[0] / unit)).collect();
        result.eigenvalues.iter_mut().for_each(|value| *value *= units[0]);
        result.tolerance *= units[0];
        Ok(result)
    }
}

impl Expansion {
    /// About the size of the function near a state of this `size`: a power of two, so that nothing is rounded.
    fn unit(&self, size: f64) -> f64 {
        let largest = norm(&self.gradient).max(norm(&self.hessian.entries()) * size);
        if largest > 0.0 && largest.is_finite() { largest.log2().round().exp2() } else { 1.0 }
    }

    fn divided_by(&self, unit: f64) -> Expansion {
        let gradient = self.gradient.iter().map(|slope| slope / unit).collect();
        Expansion { gradient, hessian: self.hessian.map(|entry| entry / unit) }
    }
}

/// Checks that H and the integrals are conserved and independent of time.
fn check_conserved<'g>(
    equations: &Equations<'g>,
    integrals: &[(String, Expr<'g>)],
    symbols: &[Expr<'g>],
) -> Result<(), AnalysisError> {
    let (system, graph) = (equations.system(), equations.system().graph());
    let accelerations = equations.accelerations();
    let of_states = system.states().iter().map(|(_, rate)| rate);
    let rates = equations.velocities().iter().chain(&accelerations).chain(of_states).copied();
    let along: Vec<_> = symbols.iter().copied().zip(rates).chain(system.signal_rates()).collect();
    let energy = ("energy".to_owned(), equations.energy());
    for (name, function) in [&energy].into_iter().chain(integrals) {
        let rate = graph.directional(&[*function], &along)[0];
        let drift = function.derivative(system.frame().time());
        if graph.generic_rank(&[vec![rate], vec![drift]]) > 0 {
            return Err(AnalysisError::NotConserved { name: name.clone() });
        }
    }
    Ok(())
}

fn expand<'g>(
    graph: &'g Graph,
    function: Expr<'g>,
    variables: &[Expr<'g>],
    values: &[(Expr<'g>, f64)],
) -> Result<Expansion, MechError> {
    let n = variables.len();
    let slopes = graph.gradient(function, variables);
    let curvatures: Vec<Expr<'g>> = slopes.iter().flat_map(|&f| graph.gradient(f, variables)).collect();
    let numbers = graph.evaluate(&curvatures, values)?;
    let hessian = Matrix::from_fn(n, n, |i, j| numbers[i.max(j) * n + i.min(j)]);
    Ok(Expansion { gradient: graph.evaluate(&slopes, values)?, hessian })
}

/// The solutions λ + μ of d(H + λ_j I_j) = 0, and the deviations on which the second variation is tested.
struct Multipliers {
    /// λ, found by least squares.
    lambda: Vec<f64>,
    /// The μ with μ_j dI_j = 0, as columns.
    free: Matrix<f64>,
    /// |dH + λ_j dI_j|, relative.
    residual: f64,
    /// The common kernel of the dI_j, as columns.
    kernel: Matrix<f64>,
    /// The relative size that counts as zero.
    rounding: f64,
}

impl Multipliers {
    /// The multipliers for these expansions. `size` is the size of the state; a rounding error of the state
    /// changes dH by d²H times that error.
    fn of(
        energy: &Expansion,
        integrals: &[Expansion],
        size: f64,
        directions: Option<&Matrix<f64>>,
    ) -> Result<Multipliers, MechError> {
        let (n, count) = (energy.gradient.len(), integrals.len());
        let factors = SingularValues::of(&Matrix::from_fn(n, count, |i, j| integrals[j].gradient[i]))?;
        let largest = factors.values.first().copied().unwrap_or(0.0);
        let rounding = 64.0 * (n + count) as f64 * f64::EPSILON;
        let rank = factors.rank(rounding * largest);

        let along = |l: usize| factors.left.column(l).zip(&energy.gradient).map(|(u, h)| u * h).sum::<f64>();
        let weights: Vec<f64> = (0..rank).map(|l| -along(l) / factors.values[l]).collect();
        let lambda = |j: usize| (0..rank).map(|l| factors.right[(j, l)] * weights[l]).sum();
        let left_over: Vec<f64> = (rank..n).map(along).collect();
        let kernel = match directions {
            None => Matrix::from_fn(n, n - rank, |i, j| factors.left[(i, rank + j)]),
            Some(directions) => kept_along(integrals, directions, rounding)?,
        };
        let scale = norm(&energy.gradient).max(largest).max(norm(&energy.hessian.entries()) * size);
        Ok(Multipliers {
            lambda: (0..count).map(lambda).collect(),
            free: factors.kernel(rank),
            residual: if scale == 0.0 { 0.0 } else { norm(&left_over) / scale },
            kernel,
            rounding,
        })
    }
}

/// An orthonormal basis of the deviations among `directions` with dI_j = 0.
fn kept_along(
    integrals: &[Expansion],
    directions: &Matrix<f64>,
    rounding: f64,
) -> Result<Matrix<f64>, MechError> {
    let factors = SingularValues::of(directions)?;
    let rank = factors.rank(rounding * factors.values.first().copied().unwrap_or(0.0));
    let basis = Matrix::from_fn(directions.rows(), rank, |i, j| factors.left[(i, j)]);
    let slope = |j: usize, l: usize| {
        let along: f64 = integrals[j].gradient.iter().zip(basis.column(l)).map(|(g, d)| g * d).sum();
        let size = norm(&integrals[j].gradient);
        // What a function has along the directions is rounding, if it is constant on them.
        if along.abs() <= ALONG * size { 0.0 } else { along / size }
    };
    let factors = SingularValues::of(&Matrix::from_fn(integrals.len(), rank, slope))?;
    Ok(product(&basis, &factors.kernel(factors.rank(rounding))))
}

/// A slope below this fraction of the gradient is rounding.
const ALONG: f64 = 1e-10;

/// The second variation from the expansions of H, I_1, I_2, …, without names.
fn decide(
    expansions: &[Expansion],
    size: f64,
    directions: Option<&Matrix<f64>>,
) -> Result<SecondVariation, MechError> {
    let critical = Multipliers::of(&expansions[0], &expansions[1..], size, directions)?;
    let rounding = critical.rounding;
    let hessians: Vec<Matrix<f64>> =
        expansions.iter().map(|expansion| restricted(&expansion.hessian, &critical.kernel)).collect();
    // Relative to the full forms: their restriction to the kernel may be rounding.
    let whole = expansions.iter().map(|expansion| norm(&expansion.hessian.entries()));
    let largest = whole.fold(0.0, f64::max);

    // The form of λ, and the forms by which free multipliers change it.
    let mut forms = vec![combination(&hessians, &with_energy(1.0, &critical.lambda))];
    let mut multipliers = vec![critical.lambda];
    for l in 0..critical.free.columns() {
        let mu: Vec<f64> = critical.free.column(l).collect();
        let form = combination(&hessians, &with_energy(0.0, &mu));
        if norm(&form.entries()) > rounding * largest {
            forms.push(form);
            multipliers.push(mu);
        }
    }
    let certain = rounding + critical.residual;
    // What is left of forms that cancel is rounding.
    let clean = |entry: f64| if entry.abs() <= certain * largest { 0.0 } else { entry };
    let forms: Vec<Matrix<f64>> = forms.iter().map(|form| form.map(clean)).collect();
    let weights =
        if critical.residual <= rounding.sqrt() { definite(&forms, largest, certain)? } else { None };
    let verdict = if weights.is_some() { Verdict::Stable } else { Verdict::Undecided };
    let weights = weights.unwrap_or_else(|| with_energy(1.0, &vec![0.0; forms.len() - 1]));
    let multiplier = |j: usize| multipliers.iter().zip(&weights).map(|(part, w)| w * part[j]).sum();
    let form = combination(&forms, &weights);
    Ok(SecondVariation {
        variables: Vec::new(),
        multipliers: (0..multipliers[0].len()).map(|j| (String::new(), multiplier(j))).collect(),
        residual: critical.residual,
        tolerance: certain * norm(&form.entries()),
        eigenvalues: symmetric_eigenvalues(&form)?.0,
        verdict,
    })
}

/// Numbers 1, c_1, c_2, … for which the combination of `forms` is definite, if there are any.
fn definite(forms: &[Matrix<f64>], largest: f64, tolerance: f64) -> Result<Option<Vec<f64>>, MechError> {
    let least_size = if largest > 0.0 { tolerance * largest } else { 1.0 };
    let sizes: Vec<f64> = forms.iter().map(|form| norm(&form.entries()).max(least_size)).collect();
    let scaled: Vec<Matrix<f64>> =
        forms.iter().zip(&sizes).map(|(form, size)| form.map(|entry| entry / size)).collect();
    let found = definite_combination(&scaled, tolerance)?;
    Ok(found.map(|c| {
        // A small multiple of the first form keeps the combination definite.
        let first = if c[0] == 0.0 { tolerance / 2.0 * norm(&c) } else { c[0] };
        c.iter()
            .zip(&sizes)
            .enumerate()
            .map(|(i, (c, size))| match i {
                0 => 1.0,
                _ => c / size * sizes[0] / first,
            })
            .collect()
    }))
}

fn with_energy(weight: f64, multipliers: &[f64]) -> Vec<f64> {
    [weight].into_iter().chain(multipliers.iter().copied()).collect()
}

/// Nᵀ W N
fn restricted(form: &Matrix<f64>, kernel: &Matrix<f64>) -> Matrix<f64> {
    product(&kernel.transpose(), &product(form, kernel))
}
