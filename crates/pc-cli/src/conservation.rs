//! Whether a function keeps its value along the motion.

use pc_mech::{Equations, Expr, System};

/// What is known of the rate of change of a function along the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It vanishes identically.
    Conserved,
    /// It vanishes identically for these values of the parameters.
    ConservedHere,
    /// It does not vanish identically; its value at the start, if it has one.
    Rate(Option<f64>),
}

/// dI/dt of the functions of (t, x, η, η̇) along the motion.
pub struct Rates<'a, 'g> {
    equations: &'a Equations<'g>,
    accelerations: Vec<(Expr<'g>, Expr<'g>)>,
    rates: Vec<(Expr<'g>, Expr<'g>)>,
    parameters: Vec<(Expr<'g>, Expr<'g>)>,
    start: Vec<(Expr<'g>, f64)>,
}

impl<'a, 'g> Rates<'a, 'g> {
    /// Prepares to differentiate along the motion; `t_start` and `start` say where numbers are wanted.
    pub fn new(equations: &'a Equations<'g>, t_start: f64, start: &[f64]) -> Rates<'a, 'g> {
        let system = equations.system();
        let (x, eta, time) = (system.frame().coordinates(), system.quasi_velocities(), system.frame().time());
        let accelerations = equations.accelerations();
        let velocities = x.iter().copied().zip(equations.velocities().iter().copied());
        let rates = velocities.chain(eta.iter().copied().zip(accelerations.iter().copied()));
        let state = x.iter().chain(eta).copied().zip(start.iter().copied());
        let start = system.parameters().iter().copied().chain([(time, t_start)]).chain(state).collect();
        Rates {
            equations,
            rates: rates.chain([(time, Expr::ONE)]).collect(),
            accelerations: system.accelerations().into_iter().zip(accelerations).collect(),
            parameters: system.parameters().iter().map(|&(symbol, value)| (symbol, value.into())).collect(),
            start,
        }
    }

    /// dI/dt.
    pub fn of(&self, function: Expr<'g>) -> Expr<'g> {
        let graph = self.equations.system().graph();
        let function = graph.substitute(&[function], &self.accelerations);
        graph.directional(&function, &self.rates)[0]
    }

    /// What is known of dI/dt.
    pub fn verdict(&self, function: Expr<'g>) -> Verdict {
        let graph = self.equations.system().graph();
        let rate = self.of(function);
        if rate.is_zero() {
            return Verdict::Conserved;
        }
        if graph.substitute(&[rate], &self.parameters)[0].is_zero() {
            return Verdict::ConservedHere;
        }
        let value = graph.evaluate(&[rate], &self.start).ok();
        Verdict::Rate(value.map(|values| values[0]).filter(|value| value.is_finite()))
    }
}

/// Whether the energy y·η − L is an integral as a matter of form: neither L nor the frame depends on time, the
/// coordinates do not drift, and the forces do no work.
pub fn keeps_energy(system: &System<'_>) -> bool {
    let (frame, time) = (system.frame(), system.frame().time());
    let stationary = frame.b0().iter().all(|b| b.is_zero())
        && system.structure().nonzero().all(|(r, ..)| r != 0)
        && !frame.b().entries().iter().any(|b| b.depends_on(time))
        && !system.lagrangian().depends_on(time);
    let eta = system.quasi_velocities().iter().copied();
    stationary && system.graph().dot(system.forces().iter().copied(), eta).is_zero()
}
