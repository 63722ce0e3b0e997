//! Builds a system from its description.

use pc_algebra::{AlgebraError, Frame, Matrix, StructureCoefficients};
use pc_expr::{Expr, SymbolPlaces};

use crate::error::{FrameError, LagrangianError, MechError, TreeError, shape};
use crate::system::bodies::moving::Moving;
use crate::system::bodies::velocity::{Bodies, BodyVelocity};
use crate::system::builder::{Kinematics, SystemBuilder};
use crate::system::external_force;
use crate::system::states::check_no_state;
use crate::system::system::System;
use crate::tree::system::TreeSystem;
use crate::tree::tree::Tree;

/// The sum of the parts of a description.
struct Sums<'g> {
    /// The terms of L(t, x, η).
    lagrangian: Vec<Expr<'g>>,
    /// The terms of Q.
    forces: Vec<Vec<Expr<'g>>>,
    bodies: Bodies<'g>,
    tree: Option<Box<TreeSystem<'g>>>,
}

impl<'g> SystemBuilder<'g> {
    /// Builds the system: checks that its frame is closed and determines its structure coefficients.
    ///
    /// # Errors
    /// [`LagrangianError::Missing`]; [`ShapeError`](crate::ShapeError) for parts whose lengths do not fit together;
    /// [`MechError::Algebra`] for velocities that are not affine in η, a frame that is not closed, or brackets that are
    /// missing, contradict the frame, or violate Jacobi's identity; [`FrameError::OfVelocities`] for a frame that contains
    /// velocities; [`LagrangianError::SignalInMomentum`]; [`LagrangianError::Jumps`], [`LagrangianError::MomentumJumps`] and
    /// [`FrameError::Jumps`] for anything that would cause an impulse; [`FrameError::OfState`] for a frame that depends on
    /// first-order states, or a body whose position depends on them;
    /// [`BodyError::OfVelocities`](crate::BodyError::OfVelocities) and
    /// [`BodyError::AngularVelocityNotAffine`](crate::BodyError::AngularVelocityNotAffine) of bodies;
    /// [`MatrixError::NotSkew`](crate::MatrixError::NotSkew) and
    /// [`ForceError::NotAQuasiVelocity`](crate::ForceError::NotAQuasiVelocity) of forces; [`MechError::Expr`] for an
    /// expression that divides by zero everywhere.
    pub fn build(self) -> Result<System<'g>, MechError> {
        let (graph, eta) = (self.graph, self.eta());
        let frame = self.frame_of(&eta)?;
        let structure = self.structure_of(&frame)?;
        let Sums { lagrangian, mut forces, bodies, tree } = self.sums(&frame, &eta)?;
        if lagrangian.is_empty() {
            return Err(LagrangianError::Missing.into());
        }
        for force in &self.forces {
            forces.push(force.components(&frame, &eta)?);
        }
        let external = external_force::symbols(&self.external, &frame, &eta, &self.parameters, &self.states)?;
        for (name, symbol) in &external {
            let acts = |eta: &Expr<'g>| if eta.to_string() == *name { *symbol } else { Expr::ZERO };
            forces.push(eta.iter().map(acts).collect());
        }
        let lagrangian = graph.sum(lagrangian);
        let forces: Vec<Expr<'g>> =
            (0..eta.len()).map(|s| graph.sum(forces.iter().map(|force| force[s]))).collect();
        graph.check(&[lagrangian])?;
        self.check_signals(&frame, &eta, lagrangian)?;
        self.check_continuous(&frame, &eta, lagrangian)?;
        graph.check(&forces)?;
        graph.check(&self.states.iter().map(|&(_, rate)| rate).collect::<Vec<_>>())?;
        graph.check(&frame.b().nonzero_entries())?;
        graph.check(frame.b0())?;
        let holds = self.tree.as_ref().map(Tree::holds).unwrap_or_default();
        let unit_quaternions = self.tree.as_ref().map(Tree::quaternions).unwrap_or_default();
        let acceleration = self.gravity.unwrap_or_default();
        let gravity = std::array::from_fn(|i| acceleration.get(i).copied().unwrap_or(Expr::ZERO));
        Ok(System {
            frame,
            structure,
            quasi_velocities: eta,
            states: self.states,
            parameters: self.parameters,
            signals: self.signals,
            lagrangian,
            forces,
            external,
            integrals: self.integrals,
            outputs: self.outputs,
            bodies,
            gravity,
            unit_quaternions,
            holds,
            tree,
        })
    }

    /// The frame of ẋ = b η + b_0 (3), where b and b_0 are functions of time and coordinates.
    fn frame_of(&self, eta: &[Expr<'g>]) -> Result<Frame<'g>, MechError> {
        let velocities = [eta, &self.velocity_symbols()].concat();
        let (graph, time, x) = (self.graph, self.time, self.coordinates.clone());
        let frame = match &self.kinematics {
            Kinematics::Coordinate if x.is_empty() => {
                let b = Matrix::from_fn(0, eta.len(), |_, _| Expr::ZERO); // equations on an algebra alone
                Frame::new(graph, time, x, b, Vec::new())?
            }
            Kinematics::Coordinate => Frame::coordinate(graph, time, x),
            Kinematics::Velocities(velocities) => Frame::from_velocities(graph, time, x, eta, velocities)?,
            Kinematics::Frame(frame) => (**frame).clone(),
        };
        shape("the list of quasi-velocities", eta.len(), frame.operators())?;
        of_position(&frame, &velocities)?;
        check_no_state(&self.states, "the frame", &[&frame.b().nonzero_entries(), frame.b0()].concat())?;
        Ok(frame)
    }

    /// The structure coefficients c_rs^m (5), as given or as derived from the frame.
    fn structure_of(&self, frame: &Frame<'g>) -> Result<StructureCoefficients<'g>, MechError> {
        let near = self.near_parameters();
        match &self.structure {
            None if frame.coordinates().is_empty() && frame.operators() > 0 => {
                Err(AlgebraError::AlgebraNeeded.into())
            }
            None => Ok(frame.structure_coefficients(&near)?),
            Some(given) => {
                frame.check_jacobi(given, &near)?;
                frame.check(given, &near)?;
                Ok(given.clone())
            }
        }
    }

    /// The terms of L and of the forces, including those of the bodies and of gravity.
    fn sums(&self, frame: &Frame<'g>, eta: &[Expr<'g>]) -> Result<Sums<'g>, MechError> {
        let moving = Moving::new(frame, eta, &self.states);
        let velocities: Vec<_> = self.velocity_symbols().into_iter().zip(frame.velocities(eta)).collect();
        let mut lagrangian = self.lagrangian.clone();
        lagrangian.extend(self.graph.substitute(&self.in_velocities, &velocities));
        let rest = self.graph.sum(lagrangian.iter().copied());
        let bodies = Bodies { list: Vec::new(), rest, others: Some(rest) };
        let mut sums = Sums { lagrangian, forces: vec![vec![Expr::ZERO; eta.len()]], bodies, tree: None };
        self.add_bodies(&moving, &mut sums)?;
        if let Some(tree) = &self.tree {
            self.add_tree(tree.clone(), (frame, eta), &moving, &mut sums)?;
        }
        Ok(sums)
    }

    /// Adds the bodies whose positions are given by expressions.
    fn add_bodies(&self, moving: &Moving<'_, 'g>, sums: &mut Sums<'g>) -> Result<(), MechError> {
        for (number, body) in (1..).zip(&self.bodies) {
            let share = body.share(moving)?;
            let mut others = vec![share.rotational, share.force_function];
            if let Some(acceleration) = &self.gravity {
                moving.check_at_rest("the acceleration of gravity", acceleration)?;
                others.push(body.weight(self.graph, acceleration)?);
            }
            sums.lagrangian.push(share.kinetic);
            sums.lagrangian.extend(&others[1..]);
            sums.bodies.others =
                sums.bodies.others.map(|sum| self.graph.sum(others.into_iter().chain([sum])));
            sums.forces.push(share.forces);
            let name = body.name().map_or_else(|| format!("body {number}"), str::to_owned);
            let (velocity, angular_velocity) = (share.velocity, share.angular_velocity);
            let in_lagrangian = share.in_lagrangian;
            let (mass, _) = body.mass_and_position();
            sums.bodies.list.push(BodyVelocity { name, mass, velocity, angular_velocity, in_lagrangian });
        }
        Ok(())
    }

    /// Adds the bodies whose positions are given by joints.
    fn add_tree(
        &self,
        tree: Tree<'g>,
        (frame, eta): (&Frame<'g>, &[Expr<'g>]),
        moving: &Moving<'_, 'g>,
        sums: &mut Sums<'g>,
    ) -> Result<(), MechError> {
        let gravity = self.gravity.as_deref().map(three_components).transpose()?.unwrap_or([Expr::ZERO; 3]);
        check_named(&tree, frame, eta)?;
        moving.check_at_rest("the acceleration of gravity", &gravity)?;
        let states = self.states.iter().map(|(z, _)| z);
        let variables = frame.coordinates().iter().chain(eta).chain([&self.time]).chain(states);
        tree.check_constant(&variables.chain(&self.signals).copied().collect::<Vec<_>>())?;
        let share = tree.motions().share(&gravity, eta);
        sums.lagrangian.extend(tree.springs());
        sums.forces.push(tree.dampers(eta));
        let others = self.graph.sum(sums.lagrangian.iter().copied());
        sums.lagrangian.extend(share.kinetic.into_iter().chain(share.weight));
        sums.forces.push(share.forces);
        sums.bodies.list.extend(share.velocities);
        sums.tree = TreeSystem::of(tree, gravity, others, frame, eta).map(Box::new);
        Ok(())
    }

    /// Checks that neither the momenta nor the frame depend on a function of time of unknown
    /// [rate](Graph::declare_rate), since that would be needed.
    fn check_signals(
        &self,
        frame: &Frame<'g>,
        eta: &[Expr<'g>],
        lagrangian: Expr<'g>,
    ) -> Result<(), MechError> {
        if self.signals.is_empty() {
            return Ok(());
        }
        let momenta = self.graph.gradient(lagrangian, eta);
        let entries = frame.b().nonzero_entries();
        let parts = || momenta.iter().chain(&entries).chain(frame.b0());
        let unknown = |u: &&Expr<'g>| self.graph.rate_of(**u).is_none();
        match self.signals.iter().filter(unknown).find(|&&u| parts().any(|part| part.depends_on(u))) {
            Some(u) => Err(LagrangianError::SignalInMomentum { input: u.to_string() }.into()),
            None => Ok(()),
        }
    }
}

/// # Errors
/// [`ShapeError`](crate::ShapeError) if there are not three components.
fn three_components<'g>(acceleration: &[Expr<'g>]) -> Result<[Expr<'g>; 3], MechError> {
    shape("the acceleration of gravity", acceleration.len(), 3)?;
    Ok(std::array::from_fn(|i| acceleration[i]))
}

/// Checks that a system has the coordinates and quasi-velocities of the joints of a tree.
///
/// # Errors
/// [`TreeError::NotOfTheSystem`]
fn check_named<'g>(tree: &Tree<'g>, frame: &Frame<'g>, eta: &[Expr<'g>]) -> Result<(), MechError> {
    let lists = [
        ("coordinates", tree.coordinates(), frame.coordinates()),
        ("quasi-velocities", tree.quasi_velocities(), eta),
    ];
    for (what, moving, known) in lists {
        if let Some(name) = moving.iter().find(|symbol| !known.contains(symbol)) {
            return Err(TreeError::NotOfTheSystem { name: name.to_string(), what }.into());
        }
    }
    Ok(())
}

/// Checks that b and b_0 are functions of time and coordinates: a quasi-velocity or velocity in b or b_0
/// would be treated as a constant.
///
/// # Errors
/// [`FrameError::OfVelocities`] with the first velocity that occurs.
fn of_position<'g>(frame: &Frame<'g>, velocities: &[Expr<'g>]) -> Result<(), MechError> {
    let entries = [&frame.b().nonzero_entries(), frame.b0()].concat();
    let velocities = SymbolPlaces::of(velocities);
    let found = frame.graph().symbols_of(&entries).into_iter().find(|&symbol| velocities.contains(symbol));
    found.map_or(Ok(()), |symbol| Err(FrameError::OfVelocities { velocity: symbol.to_string() }.into()))
}
