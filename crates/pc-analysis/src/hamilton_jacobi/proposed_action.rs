//! Verdicts on a function proposed as a solution of Hamilton–Jacobi's equation.

use pc_mech::{Canonical, Expr, Graph, Identity, Neighbourhood};

use crate::error::AnalysisError;
use crate::hamilton_jacobi::complete_integral::CompleteIntegral;
use crate::hamilton_jacobi::orbit::Orbit;
use crate::hamilton_jacobi::{remainder_on, slopes};

/// The number of points at which the residual is evaluated in order to show the largest.
const POINTS: u64 = 16;

/// The verdict on an action S(t, x, α).
#[derive(Clone, Debug)]
pub struct ProposedAction<'g> {
    /// The remainder X_0 S + H(t, x, X_s S), simplified to zero if it is proved to vanish.
    pub remainder: Expr<'g>,
    /// Whether the remainder vanishes, relative to its two terms.
    pub identity: Identity,
    /// A point where the remainder does not vanish, if one was found.
    pub refuted: Option<Residual>,
    /// The rank of ∂(X_s S)/∂α at almost all points, which is rank b if the integral is complete.
    pub rank: usize,
    action: Expr<'g>,
    constants: Vec<Expr<'g>>,
    orbit: Orbit<'g>,
}

/// The value of a remainder at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// The names and values of the symbols in the remainder.
    pub at: Vec<(String, f64)>,
    /// The value of the remainder there.
    pub value: f64,
}

impl<'g> ProposedAction<'g> {
    /// The verdict on S = `action`, a function of (t, x) and of `constants`, based on the cancellation of
    /// terms and on numerical values `near` a point where S is defined.
    ///
    /// # Errors
    /// As for [`hamilton_jacobi`](crate::hamilton_jacobi), and [`AnalysisError::OrbitUnknown`] if rank b < n.
    ///
    /// ```
    /// use pc_analysis::ProposedAction;
    /// use pc_mech::{Graph, Identity, Neighbourhood, System};
    ///
    /// let graph = Graph::new();
    /// let particle =
    ///     System::builder(&graph).coordinates(["x"]).lagrangian(|_, _, v| v[0].square() / 2.0).build()?;
    /// let [t, x, a] = graph.symbols(["t", "x", "a"]);
    /// let near = Neighbourhood { centre: vec![(t, 2.0), (x, 1.0), (a, 3.0)] };
    /// let verdict = |action| ProposedAction::check(&particle.canonical()?, action, &[a], &near);
    /// assert_eq!(verdict((x - a).square() / (2.0 * t))?.identity, Identity::Proved);
    /// assert!(verdict((x - a).square() / (3.0 * t))?.refuted.is_some());
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn check(
        canonical: &Canonical<'g>,
        action: Expr<'g>,
        constants: &[Expr<'g>],
        near: &Neighbourhood<'g>,
    ) -> Result<ProposedAction<'g>, AnalysisError> {
        let whole = Orbit::through(canonical.system(), &[], &near.centre)?;
        ProposedAction::check_on(canonical, action, constants, (&whole, near))
    }

    /// The verdict on S = `action` where the positions are on an orbit.
    ///
    /// # Errors
    /// As for [`hamilton_jacobi`](crate::hamilton_jacobi).
    pub fn check_on(
        canonical: &Canonical<'g>,
        action: Expr<'g>,
        constants: &[Expr<'g>],
        (orbit, near): (&Orbit<'g>, &Neighbourhood<'g>),
    ) -> Result<ProposedAction<'g>, AnalysisError> {
        let (system, graph) = (canonical.system(), canonical.system().graph());
        let remainder = remainder_on(canonical, action, orbit)?;
        let momenta = slopes(canonical, action);
        let known: Vec<_> = canonical.momenta().iter().copied().zip(momenta.iter().copied()).collect();
        let rate = system.frame().apply(0, &[action])[0];
        let terms = [rate, graph.substitute(&[canonical.hamiltonian()], &known)[0]];
        let terms = [0, 1].map(|term| orbit.restricted(graph, &terms)[term]);
        let identity = match remainder.is_zero() {
            true => Identity::Proved,
            false => Identity::of(near.residual(graph, &[terms.to_vec()])),
        };
        let is_refuted = matches!(identity, Identity::Disproved { .. });
        let rows: Vec<Vec<Expr<'g>>> =
            momenta.iter().map(|&y| orbit.restricted(graph, &graph.gradient(y, constants))).collect();
        Ok(ProposedAction {
            refuted: if is_refuted { largest(graph, terms, near) } else { None },
            rank: graph.generic_rank(&rows),
            remainder,
            identity,
            action,
            constants: constants.to_vec(),
            orbit: orbit.clone(),
        })
    }

    /// The complete integral S, if the verdict allows it: proved, or without contradiction in numbers.
    ///
    /// # Errors
    /// [`AnalysisError::NotAnAction`] for an action that is refuted, or has no values; [`AnalysisError::IncompleteIntegral`] if
    /// there are fewer than rank b constants, or more, or if they are not independent.
    pub fn integral(&self, canonical: &Canonical<'g>) -> Result<CompleteIntegral<'g>, AnalysisError> {
        let agrees = match self.identity {
            Identity::Proved => true,
            Identity::Open { rest } => rest <= Neighbourhood::ROUNDING,
            Identity::Disproved { .. } => false,
        };
        if !agrees {
            return Err(AnalysisError::NotAnAction { remainder: self.remainder.to_string() });
        }
        let size = self.orbit.dimension();
        if self.rank != size || self.constants.len() != size {
            return Err(AnalysisError::IncompleteIntegral { rank: self.rank, size });
        }
        CompleteIntegral::of_known(canonical, self.action, &self.constants, &self.orbit)
    }
}

/// The residual at the point, the centre or one near it, where the sum of two terms is largest relative to
/// their sizes.
fn largest<'g>(graph: &'g Graph, terms: [Expr<'g>; 2], near: &Neighbourhood<'g>) -> Option<Residual> {
    let symbols = graph.symbols_of(&terms);
    let centre =
        |z: &Expr<'g>| near.centre.iter().find(|(known, _)| known == z).map_or(1.0, |&(_, value)| value);
    let at = |point: u64| -> Vec<(Expr<'g>, f64)> {
        let place = |(i, z): (usize, &Expr<'g>)| {
            // Multiples of the golden section are spread evenly over 0..1.
            let u = (point as f64 * (i as f64 + 1.0) * 0.618_033_988_749_894_9).fract();
            let reach = if point == 0 { 0.0 } else { (0.1 + 0.2 * centre(z).abs()) * (2.0 * u - 1.0) };
            (*z, centre(z) + reach)
        };
        symbols.iter().enumerate().map(place).collect()
    };
    let mut worst: Option<(f64, Residual)> = None;
    for at in (0..POINTS).map(at) {
        let Ok(values) = graph.evaluate(&terms, &at) else { continue };
        let (value, size) = (values[0] + values[1], values[0].abs() + values[1].abs());
        let part = value.abs() / size;
        if part.is_finite() && worst.as_ref().is_none_or(|&(most, _)| part > most) {
            let at = at.into_iter().map(|(z, value)| (z.to_string(), value)).collect();
            worst = Some((part, Residual { at, value }));
        }
    }
    worst.map(|(_, residual)| residual)
}
