//! Actions by separation: all coordinates but one are cyclic.

use pc_algebra::quadratic;
use pc_expr::{Evaluator, Inputs, Program};
use pc_mech::{Backend, Canonical, Expr, Identity};

use crate::error::AnalysisError;
use crate::hamilton_jacobi::jacobi_motion::{BranchEnd, MotionAgreement};
use crate::hamilton_jacobi::quadrature::integral;
use crate::hamilton_jacobi::roots::vanishes;
use crate::hamilton_jacobi::series::SeriesMotion;

/// The number of times at which the constants are compared.
const COMPARED: u32 = 16;
/// The comparison ends at this fraction of the time until a turning point, where ∂p/∂E is infinite.
const BEFORE_END: f64 = 0.9;
/// A turning point is sought in this many rounds, each within the last step of the round before.
const ROUNDS: usize = 8;

/// The complete integral of a conservative system in which H depends on one coordinate x only:
///
///   S = −E t + Σ p_i x_i + ∫ p dx,   H(x, p, p_i) = E,
///
/// with the energy E and the momenta p_i of the cyclic coordinates x_i as constants α. By Jacobi's theorem
///
///   ∫ ∂p/∂E dx − t,   x_i + ∫ ∂p/∂p_i dx
///
/// are constant along every motion, as long as p keeps its sign.
///
/// ```
/// use pc_analysis::SeparatedAction;
/// use pc_mech::{Graph, Identity, System};
///
/// // A planet: p_r = √(2E + 2/r − p_φ²/r²).
/// let graph = Graph::new();
/// let [t, r, phi, p, l] = graph.symbols(["t", "r", "φ", "p_r", "p_φ"]);
/// let planet = System::builder(&graph)
///     .coordinates(["r", "φ"])
///     .lagrangian(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0 + 1.0 / x[0])
///     .build()?;
/// let canonical = planet.canonical()?;
/// let at = [(t, 0.0), (r, 1.0), (phi, 0.0), (p, 0.2), (l, 1.1)];
/// let action = SeparatedAction::of(&canonical, &at)?.expect("φ is cyclic");
/// assert_eq!((action.coordinate(), action.identity()), (0, Identity::Proved));
/// let squared = action.momentum().square();
/// assert!((squared - (2.0 * action.energy() + 2.0 / r - (l / r).square())).is_zero());
/// let agreement = action.agreement(&canonical, 10.0)?;
/// assert!(agreement.end.is_some() && agreement.deviation.unwrap() < 1e-12);
/// # Ok::<(), pc_analysis::AnalysisError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SeparatedAction<'g> {
    energy: Expr<'g>,
    value: f64,
    coordinate: usize,
    momentum: Expr<'g>,
    identity: Identity,
    /// The sign of ẋ at the start.
    direction: f64,
    /// Time, then (x, y), at the start.
    start: (f64, Vec<f64>),
}

impl<'g> SeparatedAction<'g> {
    /// The action for the motion that starts at these values of time, coordinates and momenta; `None` if H depends on time or
    /// on more coordinates than one or none, is not quadratic in the momentum of that one, or if that momentum vanishes at the start.
    ///
    /// # Errors
    /// [`AnalysisError::Forced`] with generalised forces; [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic)
    /// if H is not [closed](Canonical::is_closed).
    pub fn of(
        canonical: &Canonical<'g>,
        at: &[(Expr<'g>, f64)],
    ) -> Result<Option<SeparatedAction<'g>>, AnalysisError> {
        canonical.closed_quasi_velocities()?;
        let (system, graph) = (canonical.system(), canonical.system().graph());
        if let Some(s) = system.forces().iter().position(|force| !force.is_zero()) {
            return Err(AnalysisError::Forced { quasi_velocity: system.quasi_velocities()[s].to_string() });
        }
        let (frame, h, y) = (system.frame(), canonical.hamiltonian(), canonical.momenta());
        let x = frame.coordinates();
        let is_lagrange = frame.velocities(system.quasi_velocities()) == system.quasi_velocities();
        let moving: Vec<usize> = (0..x.len()).filter(|&i| h.depends_on(x[i])).collect();
        let ([place], true, false) = (moving.as_slice(), is_lagrange, h.depends_on(frame.time())) else {
            return Ok(None);
        };
        let Some(parts) = quadratic(graph, h, &[y[*place]]) else { return Ok(None) };
        let energy = unused(canonical);
        let (half, linear) = (parts.matrix[(0, 0)], parts.linear[0]);
        let root = (linear.square() - 2.0 * half * (parts.constant - energy)).sqrt();
        let parameters = system.parameters().iter().copied();
        let places: Vec<(Expr<'g>, f64)> = at.iter().copied().chain(parameters).collect();
        let variables: Vec<Expr<'g>> = x.iter().chain(y).copied().collect();
        let ask = [vec![frame.time(), h, half * y[*place] + linear], variables].concat();
        let Ok(values) = graph.evaluate(&ask, &places) else { return Ok(None) };
        let (t, value, rate) = (values[0], values[1], values[2]);
        if rate == 0.0 || !values.iter().all(|value| value.is_finite()) {
            return Ok(None);
        }
        let momentum = (root * rate.signum() - linear) / half;
        let rest = graph.substitute(&[h], &[(y[*place], momentum)])[0] - energy;
        let near = pc_mech::Neighbourhood { centre: [places, vec![(energy, value)]].concat() };
        let identity = match vanishes(graph, rest) {
            true => Identity::Proved,
            false => Identity::of(near.residual(graph, &[vec![rest + energy, -energy]])),
        };
        let start = (t, values[3..].to_vec());
        Ok(Some(SeparatedAction {
            energy,
            value,
            coordinate: *place,
            momentum,
            identity,
            direction: rate.signum(),
            start,
        }))
    }

    /// The symbol of the energy E.
    pub fn energy(&self) -> Expr<'g> {
        self.energy
    }

    /// The energy at the start.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// The index of the coordinate x on which H depends.
    pub fn coordinate(&self) -> usize {
        self.coordinate
    }

    /// p in terms of x, E and the p_i.
    pub fn momentum(&self) -> Expr<'g> {
        self.momentum
    }

    /// Whether H(x, p, p_i) = E.
    pub fn identity(&self) -> Identity {
        self.identity
    }

    /// How constant the functions of Jacobi's theorem are along the motion of (10), (11) by power series, with the integrals by
    /// quadrature, until `t_end` or a turning point.
    ///
    /// # Errors
    /// [`AnalysisError`] if the equations contain a symbol without a value.
    pub fn agreement(&self, canonical: &Canonical<'g>, t_end: f64) -> Result<MotionAgreement, AnalysisError> {
        let (start, state) = (self.start.0, &self.start.1);
        let n = canonical.momenta().len();
        let end = |ends: bool| ends.then_some(BranchEnd::TurningPoint);
        let without = |until, ends| MotionAgreement { until, end: end(ends), deviation: None };
        let Some((until, ends)) = self.turning(canonical, t_end)? else { return Ok(without(start, false)) };
        let Some(mut motion) = SeriesMotion::new(canonical, start, state)? else {
            return Ok(without(until, ends));
        };
        let mut rates = self.rates(canonical)?;
        let span = (until - start) * if ends { BEFORE_END } else { 1.0 };
        let (mut sums, mut from) = (vec![0.0; n], state[self.coordinate]);
        let mut worst = 0.0f64;
        for i in 1..=COMPARED {
            let t = start + span * f64::from(i) / f64::from(COMPARED);
            let Some(there) = motion.at(t) else { return Ok(without(until, ends)) };
            let to = there[self.coordinate];
            let part = integral((from, to), n, |x, values| rates(x, values));
            sums.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
            from = to;
            for (place, sum) in sums.iter().enumerate() {
                let way = if place == self.coordinate { start - t } else { there[place] - state[place] };
                worst = worst.max((way + sum).abs() / (1.0 + way.abs()));
            }
        }
        Ok(MotionAgreement { until, end: end(ends), deviation: Some(worst) })
    }

    /// ∂p/∂p_i at x, with ∂p/∂E in the place of the coordinate.
    fn rates(
        &self,
        canonical: &Canonical<'g>,
    ) -> Result<impl FnMut(f64, &mut [f64]) + use<'g>, AnalysisError> {
        let (system, y) = (canonical.system(), canonical.momenta());
        let (graph, n, place) = (system.graph(), y.len(), self.coordinate);
        let mut constants = y.to_vec();
        constants[place] = self.energy;
        let mut values = self.start.1[n..].to_vec();
        values[place] = self.value;
        let inputs = Inputs {
            time: None,
            state: vec![system.frame().coordinates()[place]],
            parameters: system
                .parameters()
                .iter()
                .map(|&(symbol, _)| symbol)
                .chain(constants.clone())
                .collect(),
        };
        let program = Program::new(graph, &inputs, &graph.gradient(self.momentum, &constants))?;
        let mut evaluator = Evaluator::new(program, Backend::Interpreter);
        let parameters: Vec<f64> =
            system.parameters().iter().map(|&(_, value)| value).chain(values).collect();
        Ok(move |x: f64, values: &mut [f64]| evaluator.eval(0.0, &[x], &parameters, values))
    }

    /// The time until which x moves in its direction at the start, and whether it turns then; `None` if the motion has no
    /// power series.
    fn turning(&self, canonical: &Canonical<'g>, t_end: f64) -> Result<Option<(f64, bool)>, AnalysisError> {
        let (start, state) = (self.start.0, &self.start.1);
        let Some(mut motion) = SeriesMotion::new(canonical, start, state)? else { return Ok(None) };
        let (mut from, mut to, mut ends) = (start, t_end, false);
        for _ in 0..ROUNDS {
            let step = (to - from) / f64::from(COMPARED);
            let Some(mut before) = motion.at(from).map(|there| there[self.coordinate]) else {
                return Ok(None);
            };
            let mut turned = None;
            for i in 1..=COMPARED {
                let Some(after) = motion.at(from + step * f64::from(i)) else { return Ok(None) };
                let after = after[self.coordinate];
                if (after - before) * self.direction <= 0.0 {
                    turned = Some(i);
                    break;
                }
                before = after;
            }
            let Some(i) = turned else { break };
            (from, to) = (from + step * f64::from(i.max(2) - 2), from + step * f64::from(i));
            ends = true;
        }
        Ok(Some((if ends { from } else { t_end }, ends)))
    }
}

/// E, or another name for it if the system has a symbol of that name.
fn unused<'g>(canonical: &Canonical<'g>) -> Expr<'g> {
    let (system, mut name) = (canonical.system(), "E".to_owned());
    let taken = [system.symbols(), canonical.momenta().to_vec()].concat();
    while taken.contains(&system.graph().symbol(&name)) {
        name.push('0');
    }
    system.graph().symbol(&name)
}
