//! A mechanical system: frame, Lagrangian, forces, and the observables of its motion.

use std::collections::HashSet;

use pc_algebra::{Frame, StructureCoefficients};
use pc_expr::{Expr, Graph, SymbolPlaces};

use crate::error::{MechError, shape};
use crate::system::bodies::velocity::Bodies;
use crate::system::holds::Hold;
use crate::system::states::check_no_state;
use crate::tree::system::TreeSystem;
use crate::tree::tree::Tree;

/// A holonomic system in quasi-velocities: ẋ = b η + b_0 (3), L(t, x, η) and generalised forces Q_s (8).
///
/// Built with [`System::builder`]. The library is unit-agnostic: any consistent units will do.
#[derive(Clone, Debug)]
pub struct System<'g> {
    pub(crate) frame: Frame<'g>,
    pub(crate) structure: StructureCoefficients<'g>,
    pub(crate) quasi_velocities: Vec<Expr<'g>>,
    /// Each z with ż.
    pub(crate) states: Vec<(Expr<'g>, Expr<'g>)>,
    pub(crate) parameters: Vec<(Expr<'g>, f64)>,
    /// The parameters that are functions of time.
    pub(crate) signals: Vec<Expr<'g>>,
    pub(crate) lagrangian: Expr<'g>,
    pub(crate) forces: Vec<Expr<'g>>,
    pub(crate) external: Vec<(String, Expr<'g>)>,
    pub(crate) integrals: Vec<(String, Expr<'g>)>,
    pub(crate) outputs: Vec<(String, Expr<'g>)>,
    pub(crate) bodies: Bodies<'g>,
    /// The acceleration of gravity, padded with zeros.
    pub(crate) gravity: [Expr<'g>; 3],
    /// The quaternions of joints, each of four coordinates.
    pub(crate) unit_quaternions: Vec<[Expr<'g>; 4]>,
    /// The holds of its joints.
    pub(crate) holds: Vec<Hold<'g>>,
    /// The bodies joined by joints, if nothing else in the system has inertia.
    pub(crate) tree: Option<Box<TreeSystem<'g>>>,
}

impl<'g> System<'g> {
    /// The graph of all its expressions.
    pub fn graph(&self) -> &'g Graph {
        self.frame.graph()
    }

    /// The frame: the operators X_0..X_k (4), with b (n × k) and b_0 (n) of (3).
    pub fn frame(&self) -> &Frame<'g> {
        &self.frame
    }

    /// The structure coefficients c_rs^m (5), r, s = 0..k, m = 1..k.
    pub fn structure(&self) -> &StructureCoefficients<'g> {
        &self.structure
    }

    /// The symbols η_1..η_k of the quasi-velocities (2).
    pub fn quasi_velocities(&self) -> &[Expr<'g>] {
        &self.quasi_velocities
    }

    /// The symbols of the first-order states z, which are not part of the frame, each with its rate ż(t, x, η, z).
    pub fn states(&self) -> &[(Expr<'g>, Expr<'g>)] {
        &self.states
    }

    /// The symbols of the whole state: x, η, z.
    pub fn state(&self) -> Vec<Expr<'g>> {
        self.state_with(&self.quasi_velocities)
    }

    /// The symbols of the state with other symbols, such as momenta, in place of η: x, then the other
    /// symbols, then z.
    pub fn state_with(&self, moving: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let states = self.states.iter().map(|(symbol, _)| symbol);
        self.frame.coordinates().iter().chain(moving).chain(states).copied().collect()
    }

    /// Checks that parts of the frame, called `what`, contain no first-order state.
    ///
    /// # Errors
    /// [`FrameError::OfState`]
    pub(crate) fn check_no_state(&self, what: &'static str, parts: &[Expr<'g>]) -> Result<(), MechError> {
        check_no_state(&self.states, what, parts)
    }

    /// The parameters with their values, in the order of declaration.
    pub fn parameters(&self) -> &[(Expr<'g>, f64)] {
        &self.parameters
    }

    /// The bodies joined by joints, for a system that has no other inertia.
    pub fn tree(&self) -> Option<&Tree<'g>> {
        self.tree.as_ref().map(|tree| &tree.tree)
    }

    /// The quaternions of its joints, each of four coordinates with |q| = 1. The equations keep |q| constant, and
    /// motions are [projected](pc_expr::VectorField::project) onto |q| = 1.
    pub fn unit_quaternions(&self) -> &[[Expr<'g>; 4]] {
        &self.unit_quaternions
    }

    /// Whether joints are [held at rest](crate::Joint::ends) by stops, or by [stiction](crate::Joint::stiction): forces that
    /// act at rest only, so that they are no part of Q.
    pub fn is_held_at_rest(&self) -> bool {
        !self.holds.is_empty()
    }

    /// The [tree](System::tree), if its equations are too long to be written out as a whole; they are then derived,
    /// compiled and printed body by body.
    pub fn large_tree(&self) -> Option<&Tree<'g>> {
        self.tree().filter(|tree| tree.is_large())
    }

    /// The [acceleration of gravity](crate::SystemBuilder::gravity) of its bodies, along the axes of the world; in a
    /// plane the last component is zero, and without gravity all components are.
    pub fn gravity(&self) -> [Expr<'g>; 3] {
        self.gravity
    }

    /// The parameters that are [functions of time](crate::SystemBuilder::signal).
    pub fn signals(&self) -> &[Expr<'g>] {
        &self.signals
    }

    /// The signals u with their rates u̇: those that are declared, or symbols for unknown ones.
    pub fn signal_rates(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let unknown = |u: Expr<'g>| self.unused(format!("{u}'"), "_");
        let rate = |&u: &Expr<'g>| (u, self.graph().rate_of(u).unwrap_or_else(|| unknown(u)));
        self.signals.iter().map(rate).collect()
    }

    /// The parameters that are not signals, with their values.
    pub fn numbers(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let numbers = self.parameters.iter().filter(|(symbol, _)| !self.signals.contains(symbol));
        numbers.map(|&(symbol, value)| (symbol, value.into())).collect()
    }

    /// L(t, x, η) = T + U.
    pub fn lagrangian(&self) -> Expr<'g> {
        self.lagrangian
    }

    /// The generalised forces Q_1..Q_k (8), without the forces derived from L.
    pub fn forces(&self) -> &[Expr<'g>] {
        &self.forces
    }

    /// The symbols in Q that represent [external forces](crate::SystemBuilder::external_force), each with the
    /// name of the quasi-velocity on which it acts, in the order of declaration.
    pub fn external_forces(&self) -> &[(String, Expr<'g>)] {
        &self.external
    }

    /// The functions of (t, x, η) that a motion should keep constant, with their names.
    pub fn integrals(&self) -> &[(String, Expr<'g>)] {
        &self.integrals
    }

    /// The functions of (t, x, η) that are observed along a motion, with their names.
    pub fn outputs(&self) -> &[(String, Expr<'g>)] {
        &self.outputs
    }

    /// The k symbols of η̇, which integrals and outputs may contain.
    pub fn accelerations(&self) -> Vec<Expr<'g>> {
        self.quasi_velocities.iter().map(|eta| self.graph().symbol(&format!("{eta}'"))).collect()
    }

    /// The run-time inputs of compiled programs: the parameters, then the external forces, which are zero until they
    /// are set.
    pub(crate) fn run_time_inputs(&self) -> Vec<(Expr<'g>, f64)> {
        let external = self.external.iter().map(|&(_, symbol)| (symbol, 0.0));
        self.parameters.iter().copied().chain(external).collect()
    }

    /// The inputs that may change at each evaluation: signals and external forces.
    pub(crate) fn varying_inputs(&self) -> Vec<Expr<'g>> {
        self.signals.iter().copied().chain(self.external.iter().map(|&(_, symbol)| symbol)).collect()
    }

    /// The symbols of the system: time, state, parameters, external forces, and any others in its frame,
    /// brackets, Lagrangian or forces.
    pub fn symbols(&self) -> Vec<Expr<'g>> {
        let inputs = self.run_time_inputs();
        let mut symbols: Vec<Expr<'g>> = [self.frame.time()]
            .iter()
            .chain(self.frame.coordinates())
            .chain(&self.quasi_velocities)
            .chain(inputs.iter().map(|(symbol, _)| symbol))
            .copied()
            .collect();
        let frame = self.frame.b().nonzero_entries();
        let entries = frame.iter().chain(self.frame.b0()).chain(&self.forces);
        let brackets = self.structure.nonzero().map(|(.., c)| c);
        let written: Vec<Expr<'g>> = entries.copied().chain(brackets).chain([self.lagrangian]).collect();
        let known = SymbolPlaces::of(&symbols);
        let written = self.graph().symbols_of(&written);
        symbols.extend(written.into_iter().filter(|&symbol| !known.contains(symbol)));
        symbols
    }

    /// Quasi-velocities, then parameters: equations are collected by powers of these, in this order.
    pub(crate) fn collecting_order(&self) -> Vec<Expr<'g>> {
        let parameters = self.parameters.iter().map(|&(symbol, _)| symbol);
        self.quasi_velocities.iter().copied().chain(parameters).collect()
    }

    /// The symbol with that name, preceded by `mark` as many times as it takes to distinguish it from the
    /// symbols of the system.
    pub(crate) fn unused(&self, name: String, mark: &str) -> Expr<'g> {
        self.all_unused([name], mark)[0]
    }

    /// The symbols with these names, each preceded by `mark` as many times as it takes to distinguish it from the
    /// symbols of the system.
    pub(crate) fn all_unused(&self, names: impl IntoIterator<Item = String>, mark: &str) -> Vec<Expr<'g>> {
        let parameters = self.parameters.iter().map(|&(symbol, _)| symbol);
        let taken: HashSet<String> =
            self.state().into_iter().chain(parameters).filter_map(Expr::symbol_name).collect();
        let free = |mut name: String| {
            while taken.contains(&name) {
                name.insert_str(0, mark);
            }
            self.graph().symbol(&name)
        };
        names.into_iter().map(free).collect()
    }

    /// The same system with its quasi-velocities in another order, a permutation of 0..k.
    ///
    /// # Panics
    /// If `order` is not a permutation.
    #[must_use]
    pub fn permuted(&self, order: &[usize]) -> System<'g> {
        assert_eq!(order.len(), self.quasi_velocities.len(), "a permutation of the quasi-velocities");
        System {
            frame: self.frame.permuted(order),
            structure: self.structure.permuted(order),
            quasi_velocities: order.iter().map(|&s| self.quasi_velocities[s]).collect(),
            forces: order.iter().map(|&s| self.forces[s]).collect(),
            tree: None,
            ..self.clone()
        }
    }

    /// The same system with `put` applied to the expressions outside the frame: Lagrangian, forces,
    /// integrals, outputs, rates of the states, velocities of bodies, gravity.
    #[must_use]
    pub(crate) fn map_expressions(self, put: impl Fn(&[Expr<'g>]) -> Vec<Expr<'g>>) -> System<'g> {
        let one = |x: Expr<'g>| put(&[x])[0];
        let named =
            |list: Vec<(String, Expr<'g>)>| list.into_iter().map(|(name, x)| (name, one(x))).collect();
        System {
            lagrangian: one(self.lagrangian),
            forces: self.forces.into_iter().map(one).collect(),
            integrals: named(self.integrals),
            outputs: named(self.outputs),
            states: self.states.into_iter().map(|(z, rate)| (z, one(rate))).collect(),
            bodies: self.bodies.map(&put),
            gravity: self.gravity.map(one),
            holds: self.holds.iter().map(|hold| hold.map(one)).collect(),
            tree: None,
            ..self
        }
    }

    /// The same system with the parameters replaced by their values: only signals can still change at run time.
    #[must_use]
    pub fn with_parameters_bound(&self) -> System<'g> {
        let graph = self.graph();
        let numbers = self.numbers();
        let numbers = graph.substitution(&numbers);
        let bind = |x: Expr<'g>| numbers.apply(&[x])[0];
        System {
            frame: self.frame.map(bind),
            structure: self.structure.map(bind),
            // Before L: operands are summed in the order of creation.
            states: self.states.iter().map(|&(z, rate)| (z, bind(rate))).collect(),
            parameters: self.parameters.iter().filter(|(p, _)| self.signals.contains(p)).copied().collect(),
            tree: self.tree.as_ref().map(|tree| Box::new(tree.map(graph, bind))),
            ..self.clone().map_expressions(|list| numbers.apply(list))
        }
    }

    /// The same system with other values for its parameters, in the order of declaration.
    ///
    /// # Panics
    /// If the number of values is not the number of parameters.
    #[must_use]
    pub fn with_parameter_values(&self, values: &[f64]) -> System<'g> {
        assert_eq!(values.len(), self.parameters.len(), "values of the parameters");
        let symbols = self.parameters.iter().map(|&(symbol, _)| symbol);
        System { parameters: symbols.zip(values.iter().copied()).collect(), ..self.clone() }
    }

    /// The same system without integrals and outputs.
    #[must_use]
    pub fn without_observed(&self) -> System<'g> {
        System { integrals: Vec::new(), outputs: Vec::new(), ..self.clone() }
    }

    /// The same system with the integrals and outputs of another system that has the same state.
    #[must_use]
    pub fn observing(&self, other: &System<'g>) -> System<'g> {
        System { integrals: other.integrals.clone(), outputs: other.outputs.clone(), ..self.clone() }
    }

    /// The same system with some symbols in its integrals and outputs replaced, such as the symbols of
    /// reactions.
    #[must_use]
    pub fn with_observed(&self, known: &[(Expr<'g>, Expr<'g>)]) -> System<'g> {
        let known = self.graph().substitution(known);
        let put = |list: &[(String, Expr<'g>)]| {
            let value = |f: Expr<'g>| known.apply(&[f])[0];
            list.iter().map(|(name, f)| (name.clone(), value(*f))).collect()
        };
        System { integrals: put(&self.integrals), outputs: put(&self.outputs), ..self.clone() }
    }

    /// The same system with further outputs appended to its own.
    #[must_use]
    pub fn with_more_outputs(&self, more: impl IntoIterator<Item = (String, Expr<'g>)>) -> System<'g> {
        System { outputs: self.outputs.iter().cloned().chain(more).collect(), ..self.clone() }
    }

    /// The same system with further generalised forces, one for each quasi-velocity.
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError) if the number of forces differs from that of the quasi-velocities.
    pub fn with_added_forces(&self, more: &[Expr<'g>]) -> Result<System<'g>, MechError> {
        shape("the list of forces", more.len(), self.forces.len())?;
        Ok(System {
            forces: self.forces.iter().zip(more).map(|(&q, &more)| q + more).collect(),
            ..self.clone()
        })
    }

    /// The states with `put` applied to their rates.
    pub(crate) fn states_in(&self, put: impl Fn(&[Expr<'g>]) -> Vec<Expr<'g>>) -> Vec<(Expr<'g>, Expr<'g>)> {
        self.states.iter().map(|&(z, rate)| (z, put(&[rate])[0])).collect()
    }

    /// The k momenta ∂L/∂η_s in terms of (t, x, η).
    pub fn momenta(&self) -> Vec<Expr<'g>> {
        self.graph().gradient(self.lagrangian, &self.quasi_velocities)
    }

    /// The energy η_s ∂L/∂η_s − L in terms of (t, x, η): T − U where T is a quadratic form in η.
    pub fn energy(&self) -> Expr<'g> {
        self.graph().dot(self.momenta(), self.quasi_velocities.iter().copied()) - self.lagrangian
    }
}
