//! A mechanical system: frame, Lagrangian, forces, and what is watched of its motion.

use pc_algebra::{AlgebraError, Frame, LieAlgebra, Matrix, Neighbourhood, StructureCoefficients};
use pc_expr::{Expr, Graph};

use crate::error::MechError;

/// A holonomic system in quasi-velocities: ẋ = b η + b_0 (3), L(t, x, η) and generalised forces Q_s (8).
///
/// Built with [`System::builder`]. The library is unit-agnostic: any consistent units will do.
#[derive(Clone, Debug)]
pub struct System<'g> {
    pub(crate) frame: Frame<'g>,
    pub(crate) structure: StructureCoefficients<'g>,
    pub(crate) quasi_velocities: Vec<Expr<'g>>,
    pub(crate) parameters: Vec<(Expr<'g>, f64)>,
    pub(crate) lagrangian: Expr<'g>,
    pub(crate) forces: Vec<Expr<'g>>,
    pub(crate) integrals: Vec<(String, Expr<'g>)>,
    pub(crate) outputs: Vec<(String, Expr<'g>)>,
}

impl<'g> System<'g> {
    /// Starts the description of a system whose expressions live in `graph`.
    pub fn builder(graph: &'g Graph) -> SystemBuilder<'g> {
        SystemBuilder::new(graph)
    }

    /// The graph of all its expressions.
    pub fn graph(&self) -> &'g Graph {
        self.frame.graph()
    }

    /// The frame X_0..X_k.
    pub fn frame(&self) -> &Frame<'g> {
        &self.frame
    }

    /// The structure coefficients c_rs^m.
    pub fn structure(&self) -> &StructureCoefficients<'g> {
        &self.structure
    }

    /// The symbols η_1..η_k.
    pub fn quasi_velocities(&self) -> &[Expr<'g>] {
        &self.quasi_velocities
    }

    /// The parameters with their values.
    pub fn parameters(&self) -> &[(Expr<'g>, f64)] {
        &self.parameters
    }

    /// L(t, x, η) = T + U.
    pub fn lagrangian(&self) -> Expr<'g> {
        self.lagrangian
    }

    /// The generalised forces Q_1..Q_k.
    pub fn forces(&self) -> &[Expr<'g>] {
        &self.forces
    }

    /// The functions of (t, x, η) that a motion should keep constant, with their names.
    pub fn integrals(&self) -> &[(String, Expr<'g>)] {
        &self.integrals
    }

    /// The functions of (t, x, η) that are watched along a motion, with their names.
    pub fn outputs(&self) -> &[(String, Expr<'g>)] {
        &self.outputs
    }

    /// The symbols of η̇: integrals and outputs may contain them.
    pub fn accelerations(&self) -> Vec<Expr<'g>> {
        self.quasi_velocities.iter().map(|eta| self.graph().symbol(&format!("{eta}'"))).collect()
    }

    /// Quasi-velocities, then parameters: equations are collected by powers of these, in this order.
    pub(crate) fn collecting_order(&self) -> Vec<Expr<'g>> {
        let parameters = self.parameters.iter().map(|&(symbol, _)| symbol);
        self.quasi_velocities.iter().copied().chain(parameters).collect()
    }

    /// The symbol of that name, with `mark` before it as often as it takes to be none of the system's.
    pub(crate) fn unused(&self, name: String, mark: &str) -> Expr<'g> {
        let parameters = self.parameters.iter().map(|(symbol, _)| symbol);
        let taken: Vec<&Expr<'g>> =
            self.frame.coordinates().iter().chain(&self.quasi_velocities).chain(parameters).collect();
        let mut name = name;
        while taken.contains(&&self.graph().symbol(&name)) {
            name.insert_str(0, mark);
        }
        self.graph().symbol(&name)
    }

    /// The same system with its quasi-velocities in another order, a permutation of 0..k.
    ///
    /// # Panics
    /// If `order` is not one.
    #[must_use]
    pub fn permuted(&self, order: &[usize]) -> System<'g> {
        assert_eq!(order.len(), self.quasi_velocities.len(), "a permutation of the quasi-velocities");
        System {
            frame: self.frame.permuted(order),
            structure: self.structure.permuted(order),
            quasi_velocities: order.iter().map(|&s| self.quasi_velocities[s]).collect(),
            forces: order.iter().map(|&s| self.forces[s]).collect(),
            ..self.clone()
        }
    }

    /// The same system with the parameters replaced by their numbers.
    #[must_use]
    pub fn with_parameters_bound(&self) -> System<'g> {
        let graph = self.graph();
        let numbers: Vec<(Expr<'g>, Expr<'g>)> =
            self.parameters.iter().map(|&(symbol, value)| (symbol, value.into())).collect();
        let bind = |x: Expr<'g>| graph.substitute(&[x], &numbers)[0];
        let named =
            |list: &[(String, Expr<'g>)]| list.iter().map(|(name, x)| (name.clone(), bind(*x))).collect();
        System {
            frame: self.frame.map(bind),
            structure: self.structure.map(bind),
            quasi_velocities: self.quasi_velocities.clone(),
            parameters: Vec::new(),
            lagrangian: bind(self.lagrangian),
            forces: self.forces.iter().map(|&x| bind(x)).collect(),
            integrals: named(&self.integrals),
            outputs: named(&self.outputs),
        }
    }

    /// The same system with more generalised forces, one a quasi-velocity.
    ///
    /// # Errors
    /// [`MechError::Shape`] if there are more or fewer.
    pub fn with_added_forces(&self, more: &[Expr<'g>]) -> Result<System<'g>, MechError> {
        let expected = self.forces.len();
        if more.len() != expected {
            return Err(MechError::Shape { what: "the list of forces", found: more.len(), expected });
        }
        Ok(System {
            forces: self.forces.iter().zip(more).map(|(&q, &more)| q + more).collect(),
            ..self.clone()
        })
    }

    /// The momenta ∂L/∂η_s.
    pub fn momenta(&self) -> Vec<Expr<'g>> {
        self.graph().gradient(self.lagrangian, &self.quasi_velocities)
    }

    /// The energy η_s ∂L/∂η_s − L.
    pub fn energy(&self) -> Expr<'g> {
        self.graph().dot(self.momenta(), self.quasi_velocities.iter().copied()) - self.lagrangian
    }
}

/// How a system is described; every closure receives (t, x, η).
///
/// Coordinates and quasi-velocities are named before the closures that use them.
#[derive(Clone, Debug)]
pub struct SystemBuilder<'g> {
    graph: &'g Graph,
    time: Expr<'g>,
    coordinates: Vec<Expr<'g>>,
    quasi_velocities: Option<Vec<Expr<'g>>>,
    kinematics: Kinematics<'g>,
    structure: Option<StructureCoefficients<'g>>,
    near: Neighbourhood<'g>,
    parameters: Vec<(Expr<'g>, f64)>,
    lagrangian: Option<Expr<'g>>,
    forces: Option<Vec<Expr<'g>>>,
    integrals: Vec<(String, Expr<'g>)>,
    outputs: Vec<(String, Expr<'g>)>,
}

#[derive(Clone, Debug)]
enum Kinematics<'g> {
    /// η = ẋ
    Coordinate,
    /// ẋ, affine in η (3)
    Velocities(Vec<Expr<'g>>),
    /// A frame made elsewhere.
    Frame(Frame<'g>),
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
            lagrangian: None,
            forces: None,
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

    /// Names the coordinates x_1..x_n; none for equations on an algebra alone.
    #[must_use]
    pub fn coordinates<S: AsRef<str>>(mut self, names: impl IntoIterator<Item = S>) -> Self {
        self.coordinates = names.into_iter().map(|name| self.graph.symbol(name.as_ref())).collect();
        self
    }

    /// Names the quasi-velocities η_1..η_k; without it they are the velocities, `x'` for the coordinate `x`.
    #[must_use]
    pub fn quasi_velocities<S: AsRef<str>>(mut self, names: impl IntoIterator<Item = S>) -> Self {
        self.quasi_velocities =
            Some(names.into_iter().map(|name| self.graph.symbol(name.as_ref())).collect());
        self
    }

    /// Gives the velocities ẋ_1..ẋ_n, affine in η (3); without it ẋ = η.
    #[must_use]
    pub fn kinematics<I: IntoIterator<Item = Expr<'g>>>(
        mut self,
        velocities: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> I,
    ) -> Self {
        let velocities = velocities(self.time, &self.coordinates, &self.eta()).into_iter().collect();
        self.kinematics = Kinematics::Velocities(velocities);
        self
    }

    /// Gives the frame itself, of the coordinates named and the time symbol `t` of the graph.
    #[must_use]
    pub fn frame(mut self, frame: Frame<'g>) -> Self {
        self.kinematics = Kinematics::Frame(frame);
        self
    }

    /// Gives the brackets [X_r, X_s] = c_rs^m X_m of a stationary frame: needed where b does not determine them
    /// (rank b < k, or no coordinates), checked against the frame everywhere else.
    #[must_use]
    pub fn algebra(self, algebra: &LieAlgebra) -> Self {
        self.structure(algebra.structure_coefficients())
    }

    /// Gives all structure coefficients, c_0s^m included.
    #[must_use]
    pub fn structure(mut self, structure: StructureCoefficients<'g>) -> Self {
        self.structure = Some(structure);
        self
    }

    /// Gives values of symbols near which the system is regular, such as the start of a motion; used where an
    /// identity can only be tried numerically.
    #[must_use]
    pub fn near(mut self, values: impl IntoIterator<Item = (Expr<'g>, f64)>) -> Self {
        self.near.centre.extend(values);
        self
    }

    /// Gives L(t, x, η) = T + U, with U minus the potential energy.
    #[must_use]
    pub fn lagrangian(mut self, l: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>) -> Self {
        self.lagrangian = Some(l(self.time, &self.coordinates, &self.eta()));
        self
    }

    /// Gives the generalised forces Q_1..Q_k (8): the power of the forces is Q_s η_s.
    #[must_use]
    pub fn forces<I: IntoIterator<Item = Expr<'g>>>(
        mut self,
        q: impl FnOnce(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> I,
    ) -> Self {
        self.forces = Some(q(self.time, &self.coordinates, &self.eta()).into_iter().collect());
        self
    }

    /// Adds a function of (t, x, η) that the motion should keep constant: its drift is worth knowing.
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

    fn eta(&self) -> Vec<Expr<'g>> {
        self.quasi_velocities
            .clone()
            .unwrap_or_else(|| self.coordinates.iter().map(|x| self.graph.symbol(&format!("{x}'"))).collect())
    }

    /// The system, its frame closed and its structure coefficients known.
    ///
    /// # Errors
    /// Any [`MechError`]; of the frame above all [`AlgebraError`].
    pub fn build(self) -> Result<System<'g>, MechError> {
        let eta = self.eta();
        let k = eta.len();
        let frame = match self.kinematics {
            Kinematics::Coordinate if self.coordinates.is_empty() => {
                let b = Matrix::from_fn(0, k, |_, _| Expr::ZERO); // equations on an algebra alone
                Frame::new(self.graph, self.time, Vec::new(), b, Vec::new())?
            }
            Kinematics::Coordinate => Frame::coordinate(self.graph, self.time, self.coordinates),
            Kinematics::Velocities(velocities) => {
                Frame::from_velocities(self.graph, self.time, self.coordinates, &eta, &velocities)?
            }
            Kinematics::Frame(frame) => frame,
        };
        if frame.operators() != k {
            return Err(MechError::Shape {
                what: "the list of quasi-velocities",
                found: k,
                expected: frame.operators(),
            });
        }
        let mut near = self.near;
        near.centre.extend(self.parameters.iter().copied());
        let structure = match self.structure {
            None if frame.coordinates().is_empty() && k > 0 => return Err(AlgebraError::AlgebraNeeded.into()),
            None => frame.structure_coefficients(&near)?,
            Some(given) => {
                frame.check(&given, &near)?;
                given
            }
        };
        let lagrangian = self.lagrangian.ok_or(MechError::NoLagrangian)?;
        let forces = self.forces.unwrap_or_else(|| vec![Expr::ZERO; k]);
        if forces.len() != k {
            return Err(MechError::Shape { what: "the list of forces", found: forces.len(), expected: k });
        }
        self.graph.check(&[lagrangian])?;
        self.graph.check(&forces)?;
        self.graph.check(frame.b().entries())?;
        self.graph.check(frame.b0())?;
        Ok(System {
            frame,
            structure,
            quasi_velocities: eta,
            parameters: self.parameters,
            lagrangian,
            forces,
            integrals: self.integrals,
            outputs: self.outputs,
        })
    }
}
