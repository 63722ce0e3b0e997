//! How bodies move as functions of a frame, and what they contribute to a system.

use pc_algebra::Frame;
use pc_expr::{Expr, SymbolPlaces};

use crate::error::{BodyError, MechError};
use crate::system::states::check_no_state;

/// The contribution of a body to a system.
#[derive(Clone, Debug)]
pub(crate) struct Share<'g> {
    /// The kinetic energy T in terms of (t, x, η).
    pub(crate) kinetic: Expr<'g>,
    /// The forces Q_1..Q_k, without the forces derived from the force function.
    pub(crate) forces: Vec<Expr<'g>>,
    /// The force function U(t, x), which is a term of L.
    pub(crate) force_function: Expr<'g>,
    /// For each component of the force, whether it is included in U.
    pub(crate) in_lagrangian: Vec<bool>,
    /// The part of T that is due to ω.
    pub(crate) rotational: Expr<'g>,
    /// ṙ
    pub(crate) velocity: Vec<Expr<'g>>,
    /// The angular velocity ω, if the body turns.
    pub(crate) angular_velocity: Option<Vec<Expr<'g>>>,
}

/// A frame with its quasi-velocities and the symbols x' of its velocities.
pub(crate) struct Moving<'a, 'g> {
    pub(crate) frame: &'a Frame<'g>,
    pub(crate) eta: &'a [Expr<'g>],
    states: &'a [(Expr<'g>, Expr<'g>)],
    /// Each x_i' with b_is η_s + b_i0, except for velocities that are themselves quasi-velocities.
    velocities: Vec<(Expr<'g>, Expr<'g>)>,
}

impl<'a, 'g> Moving<'a, 'g> {
    pub(crate) fn new(
        frame: &'a Frame<'g>,
        eta: &'a [Expr<'g>],
        states: &'a [(Expr<'g>, Expr<'g>)],
    ) -> Moving<'a, 'g> {
        let symbols = frame.coordinates().iter().map(|x| frame.graph().symbol(&format!("{x}'")));
        let known = SymbolPlaces::of(eta);
        let velocities = symbols.zip(frame.velocities(eta)).filter(|&(symbol, _)| !known.contains(symbol));
        Moving { frame, eta, states, velocities: velocities.collect() }
    }

    /// Expresses functions of (t, x, η) and ẋ in terms of (t, x, η).
    pub(crate) fn in_quasi_velocities(&self, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        self.frame.graph().substitute(functions, &self.velocities)
    }

    /// The derivatives X_s f of each function f of (t, x), s = 0..k.
    ///
    /// # Errors
    /// [`BodyError::OfVelocities`] if the functions depend on velocities,
    /// [`FrameError::OfState`](crate::FrameError::OfState) if they depend on first-order states; messages call the
    /// functions `what`.
    pub(crate) fn operators(
        &self,
        what: &'static str,
        functions: &[Expr<'g>],
    ) -> Result<Vec<Vec<Expr<'g>>>, MechError> {
        self.check_at_rest(what, functions)?;
        check_no_state(self.states, what, functions)?;
        Ok((0..=self.eta.len()).map(|s| self.frame.apply(s, functions)).collect())
    }

    /// # Errors
    /// [`BodyError::OfVelocities`] if one of the functions depends on velocities.
    pub(crate) fn check_at_rest(&self, what: &'static str, functions: &[Expr<'g>]) -> Result<(), MechError> {
        let known = self.frame.graph().symbols_of(functions);
        let mut velocities = self.velocities.iter().map(|(symbol, _)| symbol).chain(self.eta);
        match velocities.find(|velocity| known.contains(velocity)) {
            Some(velocity) => Err(BodyError::OfVelocities { what, velocity: velocity.to_string() }.into()),
            None => Ok(()),
        }
    }

    /// The vector u_0 + η_s u_s, component by component, for the vectors u_0..u_k.
    pub(crate) fn combine(&self, vectors: &[Vec<Expr<'g>>]) -> Vec<Expr<'g>> {
        let graph = self.frame.graph();
        let weights = || std::iter::once(Expr::ONE).chain(self.eta.iter().copied());
        let components = vectors.first().map_or(0, Vec::len);
        (0..components).map(|i| graph.dot(vectors.iter().map(|u| u[i]), weights())).collect()
    }

    /// The products f · u_s, s = 1..k, for the vectors u_0..u_k.
    pub(crate) fn work(&self, f: &[Expr<'g>], vectors: &[Vec<Expr<'g>>]) -> Vec<Expr<'g>> {
        let graph = self.frame.graph();
        vectors[1..].iter().map(|u| graph.dot(f.iter().copied(), u.iter().copied())).collect()
    }
}
