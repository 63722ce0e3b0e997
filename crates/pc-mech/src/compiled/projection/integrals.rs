//! First integrals that a motion is brought back to.

use pc_expr::{Backend, Evaluator, Expr, Program, VectorField};

use crate::compiled::failure::{Fault, check_finite};
use crate::compiled::first_order::FirstOrder;
use crate::compiled::motion::Motion;
use crate::compiled::running_error::Measured;
use crate::constraints::multipliers::Multipliers;
use crate::equations::canonical::Canonical;
use crate::equations::poincare::Equations;
use crate::error::MechError;

/// Newton's method comes near by the square of the distance; from where it does not in so many steps, it does not.
const MOST_STEPS: usize = 50;

/// After a step so short against the state the next one would be rounding.
const SHORT: f64 = 1e-8;

/// Roundings in the value of an integral, in units of what its gradient and its value are.
const ROUNDINGS: f64 = 4.0;

/// A gradient of which less than this is left beside those before it adds nothing to them.
const DEPENDENT: f64 = 1e-10;

/// A rate of change that is larger than rounding of its terms by this is one.
const RATE: f64 = 1e-9;

/// A rate that changes by more than this part of it where digits that are rounding change is rounding itself.
const UNCERTAIN: f64 = 1.0 / 64.0;

/// How often such digits are changed, and by how much.
const PROBES: u64 = 8;
const LAST_DIGITS: f64 = 8.0 * f64::EPSILON;

/// An integral is tried along so many steps, each twice the one before; the first changes the state by about this part
/// of it, with an error far below [`RATE`].
const STEPS: usize = 8;
const FIRST_STEP: f64 = 1e-4;

/// First integrals I_j(t, y) of a motion, compiled with their gradients, to keep it at their values: see
/// [`Motion::keep`].
#[derive(Clone, Debug)]
pub struct KeptIntegrals {
    /// Of the integrals.
    names: Vec<String>,
    /// The constraints, if there are any, which are not to be left on the way, then the integrals.
    values: Measured,
    /// ∂I_j/∂t, then ∂I_j/∂y_i for each i, one after the other.
    gradients: Evaluator,
    /// Zeros of the constraints, then the values of the integrals at the start.
    levels: Vec<f64>,
    /// Number of first-order states, which a projection leaves alone.
    states: usize,
}

impl<'g> Equations<'g> {
    /// The integrals of these names, or `energy`, to be [kept](Motion::keep).
    ///
    /// # Errors
    /// [`MechError::UnknownIntegral`].
    pub fn kept<S: AsRef<str>>(&self, names: &[S]) -> Result<KeptIntegrals, MechError> {
        self.first_order().kept(names, &[])
    }
}

impl<'g> Canonical<'g> {
    /// The integrals of these names, or `energy`, as functions of (t, x, y), to be [kept](Motion::keep).
    ///
    /// # Errors
    /// [`MechError::UnknownIntegral`]; [`MechError::NotQuadratic`] where η is no expression in the momenta.
    pub fn kept<S: AsRef<str>>(&self, names: &[S]) -> Result<KeptIntegrals, MechError> {
        let mut equations = self.observed_first_order()?;
        let closed = self.closed_quasi_velocities()?.iter().copied();
        let solved: Vec<_> = equations.unknowns.iter().copied().zip(closed).collect();
        for (_, observable) in &mut equations.observables {
            *observable = equations.graph.substitute(&[*observable], &solved)[0];
        }
        equations.kept(names, &[])
    }
}

impl<'g> Multipliers<'g> {
    /// The integrals of these names, or `energy`, to be [kept](Motion::keep) beside the constraints.
    ///
    /// # Errors
    /// [`MechError::UnknownIntegral`].
    pub fn kept<S: AsRef<str>>(&self, names: &[S]) -> Result<KeptIntegrals, MechError> {
        self.first_order().kept(names, &self.conditions())
    }
}

impl<'g> FirstOrder<'g> {
    /// The integrals of these names, kept where `held` vanish.
    fn kept<S: AsRef<str>>(&self, names: &[S], held: &[Expr<'g>]) -> Result<KeptIntegrals, MechError> {
        let known = &self.observables[..self.conserved];
        let mut functions = held.to_vec();
        for name in names.iter().map(AsRef::as_ref) {
            let Some((_, integral)) = known.iter().find(|(known, _)| known == name) else {
                let known = known.iter().map(|(name, _)| name.clone()).collect();
                return Err(MechError::UnknownIntegral { name: name.to_owned(), known });
            };
            functions.push(*integral);
        }
        let variables: Vec<Expr<'g>> = [self.time].iter().chain(&self.state).copied().collect();
        let gradients: Vec<Expr<'g>> =
            functions.iter().flat_map(|&function| self.graph.gradient(function, &variables)).collect();
        let inputs = self.inputs(&[]);
        Ok(KeptIntegrals {
            names: names.iter().map(|name| name.as_ref().to_owned()).collect(),
            values: Measured::new(self.graph, &inputs, &functions, Backend::Fastest)?,
            gradients: Evaluator::new(Program::new(self.graph, &inputs, &gradients)?, Backend::Fastest),
            levels: vec![0.0; functions.len()],
            states: self.states,
        })
    }
}

impl Motion {
    /// The same motion with a [projection](pc_expr::VectorField::project) to the values that these integrals have at (t, y), beside
    /// that to its constraints: the shortest way in the components of the state as they are. Asked for after each
    /// step, it changes the state by no more than the error of the step.
    ///
    /// An integral whose gradient depends on those before it, such as the energy at rest, is left to itself there. One that
    /// jumps on the way, as energy does where a potential is a step, is none there, and to keep it changes the motion.
    ///
    /// # Errors
    /// [`MechError::NotAnIntegral`] if one of them changes along the motion at (t, y) or a little later; what the
    /// equations of motion report at (t, y).
    ///
    /// ```
    /// use pc_mech::{Graph, System, VectorField};
    ///
    /// // A point that circles with ω; |x| keeps its value.
    /// let graph = Graph::new();
    /// let equations = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .quasi_velocities(["ω"])
    ///     .kinematics(|_, x, eta| [-x[1] * eta[0], x[0] * eta[0]])
    ///     .lagrangian(|_, _, eta| eta[0].square() / 2.0)
    ///     .integral("norm", |_, x, _| x[0].square() + x[1].square())
    ///     .build()?
    ///     .poincare()?;
    /// let kept = equations.kept(&["norm"])?;
    /// let mut motion = equations.compile()?.keep(kept, 0.0, &[1.0, 0.0, 2.0])?;
    /// let mut state = [0.6003, 0.8004, 2.0];
    /// motion.project(1.0, &mut state)?;
    /// assert!((state[0] - 0.6).abs() < 1e-15 && (state[1] - 0.8).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn keep(mut self, integrals: KeptIntegrals, t: f64, y: &[f64]) -> Result<Motion, MechError> {
        self.set_kept(Some(integrals));
        self.keep_from(t, y)?;
        Ok(self)
    }

    /// Takes the values at (t, y) for those to be [kept](Motion::keep) from now on: at another start, or with other
    /// parameters.
    ///
    /// # Errors
    /// As for [`keep`](Motion::keep).
    pub fn keep_from(&mut self, t: f64, y: &[f64]) -> Result<(), MechError> {
        if let Some(motion) = self.in_momenta() {
            let state = motion.read(t, y)?;
            return motion.inner_mut().keep_from(t, &state);
        }
        let Some(mut integrals) = self.set_kept(None) else { return Ok(()) };
        let kept = self.try_to_keep(&mut integrals, t, y);
        integrals.set_levels((t, y, self.parameters()));
        self.set_kept(Some(integrals));
        kept
    }

    fn try_to_keep(&mut self, integrals: &mut KeptIntegrals, t: f64, y: &[f64]) -> Result<(), MechError> {
        let rates = self.rates(t, y)?;
        self.check(integrals, t, y, &rates)?;
        // At rest much that changes has no rate: a few short steps show it.
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
        let (mut now, mut state) = (t, y.to_vec());
        let mut step = FIRST_STEP * largest(y).max(1.0) / largest(&rates).max(1.0);
        for _ in 0..STEPS {
            let Ok(next) = self.runge_kutta(now, &state, step) else { break };
            (now, state) = (now + step, next);
            // Off the constraints reactions do work.
            if self.project(now, &mut state).is_err() {
                break;
            }
            let Ok(rates) = self.rates(now, &state) else { break };
            self.check(integrals, now, &state, &rates)?;
            step *= 2.0;
        }
        Ok(())
    }

    /// # Errors
    /// [`MechError::NotAnIntegral`] if one of them changes at (t, y), where ẏ = `rates`.
    fn check(
        &mut self,
        integrals: &mut KeptIntegrals,
        t: f64,
        y: &[f64],
        rates: &[f64],
    ) -> Result<(), MechError> {
        let found = integrals.rates_of_change((t, y, self.parameters()), rates);
        for (place, &(rate, size)) in found.iter().enumerate() {
            if rate.is_nan() || rate.abs() > RATE * size && !self.is_uncertain(integrals, place, rate, t, y) {
                let name = integrals.names[place].clone();
                return Err(MechError::NotAnIntegral { name, t, rate });
            }
        }
        Ok(())
    }

    /// Whether the rate of change of an integral at (t, y) is rounding of ẏ: it is another where the last digits of the state
    /// and of the equations are. Which of them change, and how, is the same on every run.
    fn is_uncertain(
        &mut self,
        integrals: &mut KeptIntegrals,
        place: usize,
        rate: f64,
        t: f64,
        y: &[f64],
    ) -> bool {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        (0..PROBES).any(|_| {
            let factor = || {
                bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let part = (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
                1.0 + LAST_DIGITS * part
            };
            let Ok((probe, rates)) = self.perturbed_rates(t, y, factor) else { return false };
            let (there, _) = integrals.rates_of_change((t, &probe, self.parameters()), &rates)[place];
            (there - rate).abs() > UNCERTAIN * rate.abs()
        })
    }

    /// The same motion, projected to its constraints alone.
    pub fn without_kept(mut self) -> Motion {
        self.set_kept(None);
        self
    }

    /// The state a step of the classical method later.
    fn runge_kutta(&mut self, t: f64, y: &[f64], step: f64) -> Result<Vec<f64>, MechError> {
        let along =
            |rates: &[f64], h: f64| y.iter().zip(rates).map(|(y, rate)| y + h * rate).collect::<Vec<_>>();
        let a = self.rates(t, y)?;
        let b = self.rates(t + step / 2.0, &along(&a, step / 2.0))?;
        let c = self.rates(t + step / 2.0, &along(&b, step / 2.0))?;
        let d = self.rates(t + step, &along(&c, step))?;
        let mean: Vec<f64> = (0..y.len()).map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0).collect();
        Ok(along(&mean, step))
    }
}

impl KeptIntegrals {
    /// The rates of change of the integrals at (t, y), where ẏ = `rates`, each with the sum of the absolute values of its
    /// terms.
    fn rates_of_change(&mut self, at: (f64, &[f64], &[f64]), rates: &[f64]) -> Vec<(f64, f64)> {
        let gradients = self.gradients_at(at);
        let along = |gradient: &Vec<f64>| {
            let terms = || gradient.iter().zip(std::iter::once(&1.0).chain(rates)).map(|(g, rate)| g * rate);
            (terms().sum(), terms().map(f64::abs).sum())
        };
        gradients[self.held()..].iter().map(along).collect()
    }

    /// Takes the values at (t, y) for those to be kept.
    pub(crate) fn set_levels(&mut self, at: (f64, &[f64], &[f64])) {
        let held = self.held();
        self.levels.copy_from_slice(self.values.eval(at));
        self.levels[..held].fill(0.0);
    }

    /// The number of constraints.
    fn held(&self) -> usize {
        self.levels.len() - self.names.len()
    }

    /// (∂I_j/∂t, ∂I_j/∂y), one row for each.
    fn gradients_at(&mut self, (t, y, p): (f64, &[f64], &[f64])) -> Vec<Vec<f64>> {
        let mut entries = vec![0.0; self.levels.len() * (y.len() + 1)];
        self.gradients.eval(t, y, p, &mut entries);
        entries.chunks_exact(y.len() + 1).map(<[f64]>::to_vec).collect()
    }

    /// Newton's method for I(t, y) = I_0, each step the shortest.
    ///
    /// # Errors
    /// [`Fault::NotKept`] if the steps do not become shorter, [`Fault::Expr`] for values that are not finite.
    pub(crate) fn project(&mut self, t: f64, y: &mut [f64], p: &[f64]) -> Result<(), Fault> {
        let (mut first, mut before) = (None, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            self.values.try_eval((t, y, p))?;
            let change = self.shortest((t, y, p))?;
            let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
            let length = largest(&change);
            let first = *first.get_or_insert(length);
            let is_short = length <= SHORT * largest(y);
            if length >= before / 2.0 && (is_short || length <= SHORT * first) {
                return Ok(());
            }
            if length >= before {
                return Err(Fault::NotKept);
            }
            y.iter_mut().zip(&change).for_each(|(y, change)| *y -= change);
            if is_short {
                return Ok(());
            }
            before = length;
        }
        Err(Fault::NotKept)
    }

    /// The shortest δ with ∂I_j/∂y · δ = I_j − I_j0, by orthogonalising the gradients one after the other. A difference
    /// that is rounding of the terms of I_j moves nothing: near an equilibrium it would far.
    fn shortest(&mut self, at: (f64, &[f64], &[f64])) -> Result<Vec<f64>, Fault> {
        let gradients = self.gradients_at(at);
        let mut change = vec![0.0; at.1.len()];
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for (place, row) in gradients.iter().enumerate() {
            check_finite(row, &self.gradients, at)?;
            let mut gradient = row[1..].to_vec();
            let moving = gradient.len() - self.states;
            gradient[moving..].fill(0.0);
            let gradient = &gradient[..];
            let difference = self.values.values()[place] - self.levels[place];
            // At the edge of the domain of a function that is part of it an integral may have no bound.
            let error =
                Some(self.values.error(place)).filter(|error| error.is_finite()).unwrap_or_else(|| {
                    let terms: f64 = gradient.iter().zip(at.1).map(|(g, y)| (g * y).abs()).sum();
                    ROUNDINGS * f64::EPSILON * (terms + self.levels[place].abs())
                });
            let residual = if difference.abs() <= error { 0.0 } else { difference };
            let mut direction = gradient.to_vec();
            for known in &basis {
                let along = dot(known, &direction);
                direction.iter_mut().zip(known).for_each(|(d, known)| *d -= along * known);
            }
            let (left, size) = (dot(&direction, &direction).sqrt(), dot(gradient, gradient).sqrt());
            if left <= DEPENDENT * size {
                continue;
            }
            direction.iter_mut().for_each(|d| *d /= left);
            let missing = (residual - dot(gradient, &change)) / left;
            change.iter_mut().zip(&direction).for_each(|(change, d)| *change += missing * d);
            basis.push(direction);
        }
        Ok(change)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
