//! The description of a mechanical system.

use pc_algebra::{Frame, LieAlgebra, Matrix, Neighbourhood, StructureCoefficients};
use pc_expr::{Expr, Graph};

use crate::system::bodies::body::Body;
use crate::system::bodies::particle::Particle;
use crate::system::bodies::rigid_body::RigidBody;
use crate::system::forces::Force;
use crate::system::system::System;
use crate::tree::tree::Tree;

/// A builder for the description of a system; every closure receives (t, x, η).
///
/// Coordinates and quasi-velocities are named before the closures that use them; apart from that the order is free.
/// L is the sum of all its parts, given by [`lagrangian`](SystemBuilder::lagrangian),
/// [`kinetic`](SystemBuilder::kinetic), [`potential`](SystemBuilder::potential),
/// [`lagrangian_in_velocities`](SystemBuilder::lagrangian_in_velocities) and the bodies; in the same way, Q is the
/// sum of all its parts.
#[derive(Clone, Debug)]
pub struct SystemBuilder<'g> {
    pub(super) graph: &'g Graph,
    pub(super) time: Expr<'g>,
    pub(super) coordinates: Vec<Expr<'g>>,
    pub(super) quasi_velocities: Option<Vec<Expr<'g>>>,
    pub(super) kinematics: Kinematics<'g>,
    pub(super) structure: Option<StructureCoefficients<'g>>,
    pub(super) near: Neighbourhood<'g>,
    pub(super) parameters: Vec<(Expr<'g>, f64)>,
    pub(super) signals: Vec<Expr<'g>>,
    /// Each z with ż.
    pub(super) states: Vec<(Expr<'g>, Expr<'g>)>,
    /// Terms of L(t, x, η).
    pub(super) lagrangian: Vec<Expr<'g>>,
    /// Terms of L(t, x, ẋ), with the symbols x'.
    pub(super) in_velocities: Vec<Expr<'g>>,
    pub(super) bodies: Vec<Body<'g>>,
    pub(super) tree: Option<Tree<'g>>,
    /// The acceleration of gravity.
    pub(super) gravity: Option<Vec<Expr<'g>>>,
    pub(super) forces: Vec<Force<'g>>,
    /// Names of quasi-velocities.
    pub(super) external: Vec<String>,
    pub(super) integrals: Vec<(String, Expr<'g>)>,
    pub(super) outputs: Vec<(String, Expr<'g>)>,
}

#[derive(Clone, Debug)]
pub(super) enum Kinematics<'g> {
    /// η = ẋ
    Coordinate,
    /// ẋ, affine in η (3)
    Velocities(Vec<Expr<'g>>),
    /// A frame made elsewhere.
    Frame(Box<Frame<'g>>),
}

impl<'g> System<'g> {
    /// Starts the description of a system whose expressions live in `graph`.
    pub fn builder(graph: &'g Graph) -> SystemBuilder<'g> {
        SystemBuilder::new(graph)
    }
}

impl<'g> SystemBuilder<'g> {
    fn new(graph: &'g Graph) -> SystemBuilder<'g> {
        SystemBuilder {
            graph,
            time: graph.symbol("t"),
            coordinates: Vec::new(),
            quasi_velocities: None,
            kinematics: Kinematics::Coordinate,
            structure: None,
            near: Neighbourhood::default(),
            parameters: Vec::new(),
            signals: Vec::new(),
            states: Vec::new(),
            lagrangian: Vec::new(),
            in_velocities: Vec::new(),
            bodies: Vec::new(),
            tree: None,
            gravity: None,
            forces: Vec::new(),
            external: Vec::new(),
            integrals: Vec::new(),
            outputs: Vec::new(),
        }
    }

    /// Declares a symbol to be a parameter, with its value: a run-time input of everything compiled.
    #[must_use]
    pub fn parameter(mut self, symbol: Expr<'g>, value: f64) -> Self {
        self.parameters.push((symbol, value));
        self
    }

    /// Declares a symbol to be a parameter whose value is a function of time, with its initial value. A function that
    /// depends on this parameter does not count as an integral. The function itself is given to a
    /// [`Motion`](crate::Motion::driven_by) as a [table](crate::Signals).
    #[must_use]
    pub fn signal(mut self, symbol: Expr<'g>, value: f64) -> Self {
        self.signals.push(symbol);
        self.parameter(symbol, value)
    }

    /// Names the coordinates x_1..x_n; equations on an algebra alone have no coordinates.
    #[must_use]
    pub fn coordinates<S: AsRef<str>>(mut self, names: impl IntoIterator<Item = S>) -> Self {
        self.coordinates = names.into_iter().map(|name| self.graph.symbol(name.as_ref())).collect();
        self
    }

    /// Names the quasi-velocities η_1..η_k; without this call they are the velocities of the coordinates, `x'`
    /// for the coordinate `x`.
    #[must_use]
    pub fn quasi_velocities<S: AsRef<str>>(mut self, names: impl IntoIterator<Item = S>) -> Self {
        self.quasi_velocities =
            Some(names.into_iter().map(|name| self.graph.symbol(name.as_ref())).collect());
        self
    }

    /// Declares a symbol to be a first-order state z with the rate ż(t, x, η, z), such as the current in a motor or the
    /// integral of a controller's error. The state z is integrated with the motion and comes after the
    /// quasi-velocities; L, forces, integrals and outputs may depend on it, but the frame may not. With p_s = ∂L/∂η_s,
    /// dp_s/dt then has the term ż ∂p_s/∂z.
    ///
    /// ```
    /// # use pc_mech::{Graph, System, VectorField};
    /// let graph = Graph::new();
    /// let [x, v, i] = graph.symbols(["x", "x'", "i"]);
    /// // A coil in a field, i' = −i − v, and the force that it feels.
    /// let coil = System::builder(&graph)
    ///     .coordinates(["x"])
    ///     .kinetic(|_, _, v| v[0].square() / 2.0)
    ///     .state(i, |_, _, v| -i - v[0])
    ///     .forces(|_, _, _| [i])
    ///     .build()?;
    /// assert_eq!(coil.state(), [x, v, i]);
    /// let mut rates = [0.0; 3];
    /// coil.poincare()?.compile()?.rhs(0.0, &[0.0, 2.0, 3.0], &mut rates)?;
    /// assert_eq!(rates, [2.0, 3.0, -5.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn state(
        mut self,
        symbol: Expr<'g>,
        rate: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>,
    ) -> Self {
        let rate = rate(self.time, &self.coordinates, &self.eta());
        self.states.push((symbol, rate));
        self
    }

    /// Gives the velocities ẋ_1..ẋ_n, affine in η: b and b_0 of (3). Without it ẋ = η.
    #[must_use]
    pub fn kinematics<I: IntoIterator<Item = Expr<'g>>>(
        mut self,
        velocities: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> I,
    ) -> Self {
        let velocities = velocities(self.time, &self.coordinates, &self.eta()).into_iter().collect();
        self.kinematics = Kinematics::Velocities(velocities);
        self
    }

    /// Gives the frame itself, in the named coordinates and the time symbol `t` of the graph: for example one
    /// made from [definitions](Frame::from_definitions) η = a ẋ + a_0 (2), or that of a
    /// [group](crate::LieGroup::left_frame).
    #[must_use]
    pub fn frame(mut self, frame: Frame<'g>) -> Self {
        self.kinematics = Kinematics::Frame(Box::new(frame));
        self
    }

    /// Gives the brackets \[X_r, X_s\] = c_rs^m X_m (5) of a stationary frame. The brackets are needed where b
    /// does not determine them (rank b < k, or no coordinates); otherwise they are checked against the frame.
    #[must_use]
    pub fn algebra(self, algebra: &LieAlgebra) -> Self {
        self.structure(algebra.structure_coefficients())
    }

    /// Gives all structure coefficients (5), c_0s^m included. The coefficients are needed and checked in the
    /// same cases as those of an [algebra](SystemBuilder::algebra), and may contain parameters, time and
    /// coordinates.
    #[must_use]
    pub fn structure(mut self, structure: StructureCoefficients<'g>) -> Self {
        self.structure = Some(structure);
        self
    }

    /// Gives values of symbols near which the system is regular, such as the initial values of a motion; these values
    /// are used where an identity can only be tested numerically.
    #[must_use]
    pub fn near(mut self, values: impl IntoIterator<Item = (Expr<'g>, f64)>) -> Self {
        self.near.centre.extend(values);
        self
    }

    /// Adds a term to L(t, x, η) = T + U, where U is minus the potential energy.
    #[must_use]
    pub fn lagrangian(mut self, l: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>) -> Self {
        self.lagrangian.push(l(self.time, &self.coordinates, &self.eta()));
        self
    }

    /// Adds a term to the kinetic energy T(t, x, η).
    #[must_use]
    pub fn kinetic(self, t: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>) -> Self {
        self.lagrangian(t)
    }

    /// Adds a term to the potential energy −U, which enters L with the opposite sign.
    #[must_use]
    pub fn potential(self, v: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>) -> Self {
        self.lagrangian(|t, x, eta| -v(t, x, eta))
    }

    /// Adds a term to the Lagrangian in velocities L(t, x, ẋ): the closure receives the velocities ẋ instead of η,
    /// and ẋ = b η + b_0 (3) is substituted for them. The coordinates may be redundant.
    ///
    /// ```
    /// # use pc_mech::{Graph, System};
    /// let graph = Graph::new();
    /// let [x, y, w] = graph.symbols(["x", "y", "ω"]);
    /// let circle = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .quasi_velocities(["ω"])
    ///     .lagrangian_in_velocities(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
    ///     .kinematics(|_, x, eta| [-x[1] * eta[0], x[0] * eta[0]])
    ///     .build()?;
    /// assert_eq!(circle.lagrangian(), (x.square() + y.square()) * w.square() / 2.0);
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    #[must_use]
    pub fn lagrangian_in_velocities(
        mut self,
        l: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>,
    ) -> Self {
        self.in_velocities.push(l(self.time, &self.coordinates, &self.velocity_symbols()));
        self
    }

    /// Adds a point mass, with its kinetic energy and the force on it.
    #[must_use]
    pub fn particle(
        mut self,
        particle: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Particle<'g>,
    ) -> Self {
        self.bodies.push(Body::Particle(particle(self.time, &self.coordinates, &self.eta())));
        self
    }

    /// Adds a rigid body, with its kinetic energy and the force and torque on it.
    #[must_use]
    pub fn rigid_body(
        mut self,
        body: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> RigidBody<'g>,
    ) -> Self {
        let body = body(self.time, &self.coordinates, &self.eta());
        self.bodies.push(Body::Rigid(Box::new(body)));
        self
    }

    /// Adds bodies joined by joints, with their kinetic energy, their weight, and the forces on them. The
    /// coordinates and quasi-velocities of the [`Tree`] are among those of the system, and the velocities of
    /// these coordinates belong to its [kinematics](SystemBuilder::kinematics).
    #[must_use]
    pub fn tree(mut self, tree: Tree<'g>) -> Self {
        self.tree = Some(tree);
        self
    }

    /// Lets gravity act on all bodies, with the acceleration g(t) along the axes of their positions: each adds
    /// m g · r to L, where r is the position of its mass centre.
    ///
    /// ```
    /// # use pc_mech::{Graph, Particle, System};
    /// let graph = Graph::new();
    /// let [m, l, g] = graph.symbols(["m", "l", "g"]);
    /// let pendulum = System::builder(&graph)
    ///     .coordinates(["φ"])
    ///     .particle(|_, x, _| Particle::new(m, [l * x[0].sin(), -l * x[0].cos()]))
    ///     .gravity(|_| [0.into(), -g])
    ///     .build()?;
    /// let [phi, rate] = graph.symbols(["φ", "φ'"]);
    /// assert_eq!(pendulum.lagrangian(), m * l.square() * rate.square() / 2.0 + m * g * l * phi.cos());
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    #[must_use]
    pub fn gravity<I: IntoIterator<Item = Expr<'g>>>(
        mut self,
        acceleration: impl FnOnce(Expr<'g>) -> I,
    ) -> Self {
        self.gravity = Some(acceleration(self.time).into_iter().collect());
        self
    }

    /// Adds generalised forces Q_1..Q_k (8), whose power is Q_s η_s.
    #[must_use]
    pub fn forces<I: IntoIterator<Item = Expr<'g>>>(
        mut self,
        q: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> I,
    ) -> Self {
        let forces = q(self.time, &self.coordinates, &self.eta()).into_iter().collect();
        self.forces.push(Force::OnQuasiVelocities(forces));
        self
    }

    /// Adds forces F_1..F_n on the coordinates, whose virtual work is F_i δx_i: Q_s = b_is F_i (8).
    #[must_use]
    pub fn force_on_coordinates<I: IntoIterator<Item = Expr<'g>>>(
        mut self,
        f: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> I,
    ) -> Self {
        let forces = f(self.time, &self.coordinates, &self.eta()).into_iter().collect();
        self.forces.push(Force::OnCoordinates(forces));
        self
    }

    /// Adds the forces of a dissipation function R(t, x, η) (Rayleigh): Q_s = −∂R/∂η_s. Their power is −2R where R is
    /// quadratic in η.
    #[must_use]
    pub fn dissipation(mut self, r: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>) -> Self {
        self.forces.push(Force::Dissipation(r(self.time, &self.coordinates, &self.eta())));
        self
    }

    /// Adds gyroscopic forces Q_s = Γ_sr η_r with Γ antisymmetric, k × k; they do no work.
    #[must_use]
    pub fn gyroscopic(
        mut self,
        gamma: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Matrix<Expr<'g>>,
    ) -> Self {
        self.forces.push(Force::Gyroscopic(gamma(self.time, &self.coordinates, &self.eta())));
        self
    }

    /// Declares that forces that the caller computes, such as those of a controller, act on the quasi-velocities
    /// with these names. Each such Q_s gets a further term, a symbol; an [`ExternalForce`](crate::ExternalForce)
    /// with which the equations are [compiled](crate::Equations::compile_forced) gives the values of the symbols,
    /// in the order of declaration.
    #[must_use]
    pub fn external_force<S: Into<String>>(mut self, quasi_velocities: impl IntoIterator<Item = S>) -> Self {
        for name in quasi_velocities.into_iter().map(Into::into) {
            if !self.external.contains(&name) {
                self.external.push(name);
            }
        }
        self
    }

    /// Adds a function of (t, x, η) that the motion should keep constant; its drift can be observed.
    #[must_use]
    pub fn integral(
        mut self,
        name: impl Into<String>,
        f: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>,
    ) -> Self {
        let value = f(self.time, &self.coordinates, &self.eta());
        self.integrals.push((name.into(), value));
        self
    }

    /// Adds a function of (t, x, η) to be computed along the motion.
    #[must_use]
    pub fn output(
        mut self,
        name: impl Into<String>,
        f: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>,
    ) -> Self {
        let value = f(self.time, &self.coordinates, &self.eta());
        self.outputs.push((name.into(), value));
        self
    }

    pub(super) fn eta(&self) -> Vec<Expr<'g>> {
        self.quasi_velocities.clone().unwrap_or_else(|| self.velocity_symbols())
    }

    /// x_1'..x_n'
    pub(super) fn velocity_symbols(&self) -> Vec<Expr<'g>> {
        self.coordinates.iter().map(|x| self.graph.symbol(&format!("{x}'"))).collect()
    }
}
