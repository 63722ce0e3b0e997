//! Rest or steady motion obtained by choosing some inputs and components of the state.

use pc_mech::{Matrix, SingularValues, VectorField};

use crate::error::{AnalysisError, shape};
use crate::linear::linearizer::Linearizer;
use crate::numeric::dense::norm;
use crate::numeric::newton;
use crate::stability::steady_motion::{check_smooth, first_approximation};

/// The largest number of steps of Newton's method, and the relative residual that counts as zero.
const ITERATIONS: usize = 100;
const ZERO: f64 = 1e-12;
/// Singular values below this fraction of the largest count as zero, once the columns of the slopes are scaled to the
/// same length; a quantity takes part in the changes along which the rates vanish if the square of its component in the
/// kernel exceeds this value.
const SINGULAR: f64 = 1e-8;

/// A state and inputs at which the rates of all but the cyclic coordinates vanish.
#[derive(Clone, Debug, PartialEq)]
pub struct Trim {
    /// The components of the state, with their names.
    pub state: Vec<(String, f64)>,
    /// The inputs.
    pub inputs: Vec<(String, f64)>,
    /// The cyclic coordinates with their rates, which are constant.
    pub rates: Vec<(String, f64)>,
    /// The norm of the rates that should vanish.
    pub residual: f64,
}

impl Linearizer {
    /// Finds an equilibrium or steady motion by choosing the components of the state and the inputs with the names
    /// `free`. Newton's method starts from their values in `guess` and in the parameters; all other components and
    /// inputs keep these values.
    ///
    /// ```
    /// use pc_analysis::{Leaf, Linearizer};
    /// use pc_mech::{Graph, System};
    ///
    /// // A pendulum held aside by a torque: θ̈ = −g sin θ + u.
    /// let graph = Graph::new();
    /// let [g, u] = graph.symbols(["g", "u"]);
    /// let pendulum = System::builder(&graph)
    ///     .parameter(g, 9.0)
    ///     .parameter(u, 0.0)
    ///     .coordinates(["θ"])
    ///     .lagrangian(|_, x, v| v[0].square() / 2.0 + g * x[0].cos())
    ///     .forces(|_, _, _| [u])
    ///     .build()?;
    /// let mut linearizer = Linearizer::new(&pendulum.poincare()?, &Leaf::of(&pendulum), &["u"])?;
    /// let held = linearizer.trim(0.0, &[0.5, 0.0], &["u".to_owned()])?;
    /// assert!((held.inputs[0].1 - 9.0 * 0.5f64.sin()).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`AnalysisError::DependsOnTime`]; [`AnalysisError::UnknownComponent`]; [`AnalysisError::LeafUnknown`] if
    /// coordinates are free and the functions of them that the frame keeps constant are not known;
    /// [`AnalysisError::NoSteadyMotion`] with the best values found; [`AnalysisError::Undetermined`] if other values
    /// nearby are solutions too; [`AnalysisError::NotSmooth`].
    pub fn trim(&mut self, t: f64, guess: &[f64], free: &[String]) -> Result<Trim, AnalysisError> {
        shape("the guess", guess.len(), self.motion.dim())?;
        if self.depends_on_time() {
            return Err(AnalysisError::DependsOnTime);
        }
        let unknowns = self.unknowns(free)?;
        if unknowns
            .iter()
            .any(|unknown| matches!(unknown, Unknown::Component(i) if *i < self.sizes.coordinates))
        {
            self.check_searchable(t, guess)?;
        }
        let levels = self.levels(t, guess)?;
        let kept: Vec<usize> = (0..guess.len()).filter(|i| !self.cyclic.contains(i)).collect();
        let mut state = guess.to_vec();
        let start = unknowns.iter().map(|unknown| match *unknown {
            Unknown::Component(i) => guess[i],
            Unknown::Input(place) => self.motion.parameters()[place],
        });
        let end = newton::solve(start.collect(), ITERATIONS, |z| {
            self.give(&unknowns, z, &mut state);
            self.balance(t, &state, (&kept, &unknowns), &levels)
        })?;
        self.give(&unknowns, &end.point, &mut state);
        let residual = norm(&end.values[..kept.len()]);
        let named =
            |linearizer: &Linearizer| linearizer.names().iter().cloned().zip(state.iter().copied()).collect();
        if !end.is_solution(ZERO) {
            let (state, iterations) = (named(self), end.iterations);
            return Err(AnalysisError::NoSteadyMotion { residual, iterations, t, state });
        }
        let undetermined = undetermined(&end.slopes, free)?;
        if !undetermined.is_empty() {
            return Err(AnalysisError::Undetermined { names: undetermined });
        }
        let slopes = first_approximation(&mut self.motion, t, &state)?;
        let slopes = Matrix::from_fn(kept.len(), kept.len(), |i, j| slopes[(kept[i], kept[j])]);
        check_smooth(&mut self.motion, t, &state, &kept, &slopes)?;
        let (rates, parameters) = (self.motion.rates(t, &state)?, self.motion.parameters());
        Ok(Trim {
            inputs: self.inputs.iter().map(|(name, place)| (name.clone(), parameters[*place])).collect(),
            rates: self.cyclic.iter().map(|&i| (self.names()[i].clone(), rates[i])).collect(),
            state: named(self),
            residual,
        })
    }

    fn unknowns(&self, free: &[String]) -> Result<Vec<Unknown>, AnalysisError> {
        let find = |name: &String| {
            let component = self.names().iter().position(|known| known == name).map(Unknown::Component);
            let input = || {
                self.inputs.iter().find(|(known, _)| known == name).map(|&(_, place)| Unknown::Input(place))
            };
            component.or_else(input).ok_or_else(|| AnalysisError::UnknownComponent {
                name: name.clone(),
                known: [self.names(), &Linearizer::inputs(self)].concat(),
            })
        };
        free.iter().map(find).collect()
    }

    /// Writes the values of the unknowns into the state and the parameters.
    fn give(&mut self, unknowns: &[Unknown], values: &[f64], state: &mut [f64]) {
        for (unknown, &value) in unknowns.iter().zip(values) {
            match *unknown {
                Unknown::Component(i) => state[i] = value,
                Unknown::Input(place) => self.motion.parameters_mut()[place] = value,
            }
        }
    }

    /// The rates that should vanish and the distances from the surface, with their slopes with respect to the
    /// unknowns.
    fn balance(
        &mut self,
        t: f64,
        state: &[f64],
        (kept, unknowns): (&[usize], &[Unknown]),
        levels: &[f64],
    ) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError> {
        let rates = self.motion.rates(t, state)?;
        let by_state = first_approximation(&mut self.motion, t, state)?;
        let size = state.len();
        let mut by_parameters = vec![0.0; size * self.motion.parameters().len()];
        if !self.inputs.is_empty() {
            self.motion.parameter_jacobian(t, state, &mut by_parameters)?;
        }
        let (distances, normals) = self.surface_at(t, state, Some(levels))?;
        let rows = kept.len() + distances.len();
        let values = kept.iter().map(|&i| rates[i]).chain(distances).collect();
        let slope = |i: usize, j: usize| match (i.checked_sub(kept.len()), unknowns[j]) {
            (None, Unknown::Component(component)) => by_state[(kept[i], component)],
            (None, Unknown::Input(place)) => by_parameters[kept[i] + place * size],
            (Some(a), Unknown::Component(component)) => normals[(a, component)],
            (Some(_), Unknown::Input(_)) => 0.0, // constraints contain no inputs
        };
        Ok((values, Matrix::from_fn(rows, unknowns.len(), slope)))
    }
}

/// An unknown: a component of the state, or an input, given by its index among the parameters.
#[derive(Clone, Copy, Debug)]
enum Unknown {
    Component(usize),
    Input(usize),
}

/// The names of the quantities that may change while the rates still vanish; `names` has one name for each
/// column of `slopes`.
fn undetermined(slopes: &Matrix<f64>, names: &[String]) -> Result<Vec<String>, AnalysisError> {
    let (rows, columns) = (slopes.rows(), slopes.columns());
    let size = |j: usize| norm(&(0..rows).map(|i| slopes[(i, j)]).collect::<Vec<_>>());
    let scales: Vec<f64> = (0..columns).map(size).map(|size| if size > 0.0 { size } else { 1.0 }).collect();
    let factors = SingularValues::of(&Matrix::from_fn(rows, columns, |i, j| slopes[(i, j)] / scales[j]))?;
    let rank = factors.rank(SINGULAR * factors.values.first().copied().unwrap_or(0.0));
    let along = |j: &usize| (rank..columns).map(|l| factors.right[(*j, l)].powi(2)).sum::<f64>() > SINGULAR;
    Ok((0..columns).filter(along).map(|j| names[j].clone()).collect())
}
