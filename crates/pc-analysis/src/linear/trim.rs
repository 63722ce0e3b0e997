//! Rest or steady motion obtained by choosing some inputs and components of the state.

use pc_mech::{Matrix, VectorField};

use crate::error::{AnalysisError, shape};
use crate::linear::linearizer::Linearizer;
use crate::linear::search::Balanced;
use crate::linear::statics::Unknowns;
use crate::numeric::dense::norm;
use crate::numeric::newton::Iterate;
use crate::stability::steady_motion::{check_smooth, first_approximation};

/// The largest number of steps of Newton's method, and the relative residual that counts as zero.
const ITERATIONS: usize = 100;
const ZERO: f64 = 1e-12;
/// A quantity takes part in the changes along which the rates vanish if its component in a direction of the kernel exceeds this
/// fraction of it.
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
        if unknowns.components.iter().any(|&i| i < self.sizes.coordinates) {
            self.check_searchable(t, guess)?;
        }
        let levels = self.levels(t, guess)?;
        let Balanced { end, point } = self.balanced(t, guess, &levels, (ITERATIONS, false), &unknowns)?;
        let state = point.state;
        let varying: Vec<usize> = unknowns.varying.iter().map(|s| self.sizes.coordinates + s).collect();
        let named =
            |linearizer: &Linearizer| linearizer.names().iter().cloned().zip(state.iter().copied()).collect();
        let residual = self.residual(t, &state, &unknowns.moving, &varying);
        if !end.is_solution(ZERO) {
            let (state, iterations) = (named(self), end.iterations);
            return Err(AnalysisError::NoSteadyMotion { residual, iterations, t, state });
        }
        let components = unknowns.components.iter().map(|&i| self.names()[i].clone());
        let names: Vec<String> =
            components.chain(unknowns.inputs.iter().map(|&j| self.inputs[j].0.clone())).collect();
        let undetermined = undetermined(&end, &names)?;
        if !undetermined.is_empty() {
            return Err(AnalysisError::Undetermined { names: undetermined });
        }
        let kept: Vec<usize> = (0..state.len()).filter(|i| !self.cyclic.contains(i)).collect();
        let slopes = first_approximation(&mut self.motion, t, &state)?;
        let slopes = Matrix::from_fn(kept.len(), kept.len(), |i, j| slopes[(kept[i], kept[j])]);
        check_smooth(&mut self.motion, t, (&state, &self.units), &kept, &slopes)?;
        let (rates, parameters) = (self.motion.rates(t, &state)?, self.motion.parameters());
        Ok(Trim {
            inputs: self.inputs.iter().map(|(name, place)| (name.clone(), parameters[*place])).collect(),
            rates: self.cyclic.iter().map(|&i| (self.names()[i].clone(), rates[i])).collect(),
            state: named(self),
            residual,
        })
    }

    /// The components and inputs with these names. The velocities that constraints make depend on others may vary.
    fn unknowns(&self, free: &[String]) -> Result<Unknowns, AnalysisError> {
        let (mut components, mut inputs) = (Vec::new(), Vec::new());
        for name in free {
            let input = self.inputs.iter().position(|(known, _)| known == name);
            match (self.names().iter().position(|known| known == name), input) {
                (Some(i), _) => components.push(i),
                (None, Some(j)) => inputs.push(j),
                (None, None) => {
                    let known = [self.names(), &Linearizer::inputs(self)].concat();
                    return Err(AnalysisError::UnknownComponent { name: name.clone(), known });
                }
            }
        }
        let (moving, varying) = (self.cyclic.clone(), self.dependent.clone());
        Ok(Unknowns { components, inputs, moving, varying })
    }
}

/// The names of the quantities that may change while the rates still vanish; the first unknowns are the quantities with these
/// `names`.
fn undetermined(end: &Iterate, names: &[String]) -> Result<Vec<String>, AnalysisError> {
    let kernel = end.kernel()?;
    let sizes: Vec<f64> =
        (0..kernel.columns()).map(|l| norm(&kernel.column(l).collect::<Vec<_>>())).collect();
    let along = |j: &usize| (0..kernel.columns()).any(|l| kernel[(*j, l)].abs() > SINGULAR * sizes[l]);
    Ok((0..names.len()).filter(along).map(|j| names[j].clone()).collect())
}
