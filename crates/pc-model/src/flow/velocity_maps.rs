//! Jacobians of points of bodies and of momenta, in the variables of a state.

use pc_expr::Evaluator;
use pc_mech::{Equations, Expr, Graph, VelocityMap};
use serde::{Deserialize, Serialize};

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::source::{Place, Source};
use crate::document::Orientation;
use crate::model::model::Model;
use crate::names::body_motion::{BodyMotion, turned};
use crate::names::momenta::cross;
use crate::names::moving::Moving;
use crate::names::scope::Scope;
use crate::variables::Variables;

/// The common mass centre of the bodies of a model as a function of the state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CentreOfMass {
    /// Its position along fixed axes, from t, (x, η, z) and the parameters.
    pub position: Evaluator,
    /// Its velocity.
    pub velocity: VelocityMap,
}

impl Model {
    /// The momentum P of all bodies together and their angular momentum L about their common mass centre, along fixed axes:
    /// six functions (P, L) = A η + a_0 of the state in these variables, where momenta stand for the quasi-velocities to
    /// which they belong. A is the centroidal momentum matrix.
    ///
    /// # Errors
    /// [`MeaningError::NoBodies`]; [`MeaningError::NoFixedAxes`] for a body whose angular velocity is given without its
    /// rotation; [`ModelError`] if there are no equations in these variables, or if they lack a coordinate.
    pub fn centroidal_map(
        &self,
        assembly: &Assembly<'_>,
        variables: Variables,
    ) -> Result<VelocityMap, ModelError> {
        let graph = assembly.system.graph();
        let mut scope = Scope::new(graph, self.document());
        let bodies = self.bodies_of(&mut scope, "the momentum of all bodies")?;
        let centre = mass_centre(assembly, bodies);
        let mut functions = [const { Vec::new() }; 6];
        for body in bodies {
            let arm = [0, 1, 2].map(|i| body.centre[i] - centre[i]);
            let (turning, spin) = (cross(&arm, &body.momentum), self.spin_of(body)?);
            for i in 0..3 {
                functions[i].push(body.momentum[i]);
                functions[3 + i].extend([turning[i], spin[i]]);
            }
        }
        let functions = functions.map(|terms| graph.sum(terms));
        let functions = assembly.without_velocities(&scope, &functions);
        assembly.velocity_map(variables, &functions, &[])
    }

    /// The common mass centre of all bodies, as a function of the state in these variables.
    ///
    /// # Errors
    /// As for [`centroidal_map`](Model::centroidal_map), except for bodies without a rotation.
    pub fn centre_of_mass(
        &self,
        assembly: &Assembly<'_>,
        variables: Variables,
    ) -> Result<CentreOfMass, ModelError> {
        let (system, graph) = (&assembly.system, assembly.system.graph());
        let mut scope = Scope::new(graph, self.document());
        let centre = mass_centre(assembly, self.bodies_of(&mut scope, "the mass centre of all bodies")?);
        let frame = system.frame();
        let moving = frame.coordinates().iter().copied().zip(frame.velocities(system.quasi_velocities()));
        let along: Vec<_> =
            moving.chain(graph.in_time(frame.time())).chain(system.states().iter().copied()).collect();
        let velocity = graph.directional(&centre, &along);
        let equations = assembly.equations_in(variables)?;
        let position = assembly.placed(equations.functions(&centre, &[]))?;
        Ok(CentreOfMass { position, velocity: assembly.velocity_map(variables, &velocity, &[])? })
    }

    /// The velocity v of a point of a body and the angular velocity ω of this body, along fixed axes: six functions
    /// (v, ω) = J η + J_0 of the state in these variables. The [arguments](VelocityMap::arguments_mut) are the position of
    /// the point along the axes of the body, from its origin (on a joint) or its position; where `name` is that of a point of
    /// `[points]`, from there. A particle does not turn.
    ///
    /// # Errors
    /// [`MeaningError::UnknownBody`]; [`MeaningError::NoFixedAxes`] for a body whose angular velocity is given without its
    /// rotation; [`ModelError`] if there are no equations in these variables, or if they lack a coordinate.
    pub fn body_map<'g>(
        &self,
        assembly: &Assembly<'g>,
        variables: Variables,
        name: &str,
    ) -> Result<VelocityMap, ModelError> {
        let graph = assembly.system.graph();
        let mut scope = Scope::new(graph, self.document());
        let arguments = arguments(graph);
        let OnBody { motion, from } = self.on_body(&mut scope, name, "ω")?;
        let to_fixed = |v: &[Expr<'g>; 3]| turned(&motion.rotation, v, |r, i, j| r[(i, j)], graph);
        let arm = [0, 1, 2].map(|i| from[i] + arguments[i]);
        let carried = to_fixed(&cross(&motion.turning, &arm));
        let velocity = [0, 1, 2].map(|i| motion.velocity[i] + carried[i]);
        let functions = [velocity, to_fixed(&motion.turning)].concat();
        let functions = assembly.without_velocities(&scope, &functions);
        assembly.velocity_map(variables, &functions, &arguments)
    }

    /// The position r of a point of a body along fixed axes, followed by the rotation R of this body, column by column: twelve
    /// functions of t, (x, η, z), the parameters and, after these, the position of the point as in
    /// [`body_map`](Model::body_map). R takes components along the axes of the body to those along fixed axes; it is the unit
    /// matrix for a particle, and for a point of the world.
    ///
    /// # Errors
    /// As for [`body_map`](Model::body_map).
    pub fn body_pose(
        &self,
        assembly: &Assembly<'_>,
        variables: Variables,
        name: &str,
    ) -> Result<Evaluator, ModelError> {
        let graph = assembly.system.graph();
        let mut scope = Scope::new(graph, self.document());
        let arguments = arguments(graph);
        let OnBody { motion: BodyMotion { place, rotation, .. }, from } =
            self.on_body(&mut scope, name, "R")?;
        let arm = [0, 1, 2].map(|i| from[i] + arguments[i]);
        let carried = turned(&rotation, &arm, |r, i, j| r[(i, j)], graph);
        let columns = (0..9).map(|ij| rotation[(ij % 3, ij / 3)]);
        let values: Vec<_> = (0..3).map(|i| place[i] + carried[i]).chain(columns).collect();
        let equations = assembly.equations_in(variables)?;
        assembly.placed(equations.functions(&values, &arguments))
    }

    /// The motion of the body with this name, or of that which carries the point with this name; the world, at rest,
    /// carries a point without a body. `wanted` is what a body without a rotation lacks.
    fn on_body<'g>(
        &self,
        scope: &mut Scope<'g, '_>,
        name: &str,
        wanted: &str,
    ) -> Result<OnBody<'g>, ModelError> {
        let document = self.document();
        let point = document.points.iter().find(|point| point.name.text == name);
        let mut from = [Expr::ZERO; 3];
        if let Some(at) = point.and_then(|point| point.at.as_ref()) {
            from = scope.constants(at)?;
        }
        let body = match point {
            None => name,
            Some(point) => match point.body() {
                Some(body) => body,
                None => return Ok(OnBody { motion: BodyMotion::at_rest(), from }),
            },
        };
        let placed = document.bodies.iter().find(|known| known.name.text == body);
        if placed.is_none() && document.tree.iter().all(|known| known.name.text != body) {
            return Err(self.unknown_body(name));
        }
        let touching = document.contacts.iter().find(|contact| contact.body.value == body);
        let attitude = touching.and_then(|contact| contact.attitude.as_ref());
        if let Some(Orientation::AngularVelocity(_)) = placed.and_then(|placed| placed.orientation.as_ref())
            && attitude.is_none()
        {
            return Err(self.no_fixed_axes(wanted, body));
        }
        let motion = scope.body_motion(body, attitude.map(|attitude| &*attitude.value))?;
        Ok(OnBody { motion, from })
    }

    /// The names that [`body_map`](Model::body_map) takes: those of bodies, then those of points.
    pub fn body_names(&self) -> Vec<String> {
        let document = self.document();
        let bodies = document.bodies.iter().map(|body| &body.name.text);
        let on_joints = document.tree.iter().map(|body| &body.name.text);
        bodies.chain(on_joints).chain(document.points.iter().map(|point| &point.name.text)).cloned().collect()
    }

    fn bodies_of<'s, 'g>(
        &self,
        scope: &'s mut Scope<'g, '_>,
        what: &'static str,
    ) -> Result<&'s [Moving<'g>], ModelError> {
        let document = self.document();
        if document.bodies.is_empty() && document.tree.is_empty() {
            return Err(document.error(&document.energy_place(), MeaningError::NoBodies { what }));
        }
        scope.bodies_in_motion()
    }

    fn spin_of<'g>(&self, body: &Moving<'g>) -> Result<[Expr<'g>; 3], ModelError> {
        body.spin.ok_or_else(|| self.no_fixed_axes("L", &body.name))
    }

    fn no_fixed_axes(&self, what: &str, body: &str) -> ModelError {
        let document = self.document();
        let place = document.bodies.iter().find(|known| known.name.text == body).map(|body| &body.place);
        let fault = MeaningError::NoFixedAxes { name: what.to_owned(), body: body.to_owned() };
        document.error(place.unwrap_or(&document.energy_place()), fault)
    }

    fn unknown_body(&self, name: &str) -> ModelError {
        let fault = MeaningError::UnknownBody { name: name.to_owned(), known: self.body_names() };
        let place = Place { entry: String::new(), span: 0..name.len() };
        Source::new("body", name).error(&place, ErrorKind::Meaning(fault))
    }
}

/// A point of a body, or of the world.
struct OnBody<'g> {
    motion: BodyMotion<'g>,
    /// The place of `[points]` from which the point is measured, along the axes of the body.
    from: [Expr<'g>; 3],
}

/// The position of a point along the axes of its body.
fn arguments<'g>(graph: &'g Graph) -> [Expr<'g>; 3] {
    // No name of a text has a blank.
    ["1", "2", "3"].map(|i| graph.symbol(&format!("place {i}")))
}

/// Σ m r/Σ m
fn mass_centre<'g>(assembly: &Assembly<'g>, bodies: &[Moving<'g>]) -> [Expr<'g>; 3] {
    let graph = assembly.system.graph();
    let mass = graph.sum(bodies.iter().map(|body| body.mass));
    [0, 1, 2].map(|i| graph.sum(bodies.iter().map(|body| body.mass * body.centre[i])) / mass)
}

impl<'g> Assembly<'g> {
    /// Functions with the velocities x' as functions of (t, x, η).
    fn without_velocities(&self, scope: &Scope<'g, '_>, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let velocities = self.system.frame().velocities(self.system.quasi_velocities());
        let known: Vec<_> = scope
            .velocities()
            .into_iter()
            .zip(velocities)
            .filter(|(symbol, value)| symbol != value)
            .collect();
        self.system.graph().substitute(functions, &known)
    }

    /// Functions of (t, x, η), affine in the quasi-velocities of the [system](Assembly::system), compiled for the state in
    /// these variables.
    fn velocity_map(
        &self,
        variables: Variables,
        functions: &[Expr<'g>],
        arguments: &[Expr<'g>],
    ) -> Result<VelocityMap, ModelError> {
        let equations = self.equations_in(variables)?;
        let functions = self.in_variables(variables, &equations, functions)?;
        self.placed(equations.velocity_map(&functions, arguments))
    }

    /// Functions of (t, x, η) in the quasi-velocities of the equations in these variables.
    fn in_variables(
        &self,
        variables: Variables,
        equations: &Equations<'g>,
        functions: &[Expr<'g>],
    ) -> Result<Vec<Expr<'g>>, ModelError> {
        let (graph, all) = (self.system.graph(), self.system.quasi_velocities());
        if self.constraints.held().is_some() {
            return Ok(functions.to_vec());
        }
        let put = |functions: &[Expr<'g>], symbols: &[Expr<'g>], values: &[Expr<'g>]| {
            let known = symbols.iter().copied().zip(values.iter().copied());
            graph.substitute(functions, &known.filter(|(symbol, value)| symbol != value).collect::<Vec<_>>())
        };
        if variables.are_own() {
            let follow = self.quasi_velocities_of(equations.system().quasi_velocities())?;
            return Ok(put(functions, all, &follow));
        }
        let form = self.free_form(variables)?;
        let follow = self.quasi_velocities_of(&form.independent)?;
        Ok(put(&put(functions, all, &follow), &form.independent, &form.values))
    }
}
