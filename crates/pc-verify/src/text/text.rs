//! The text of a model, as terms in time, coordinates and velocities.

use std::sync::Arc;

use pc_expr::Deadline;
use pc_mech::Table;
use pc_model::Model;
use pc_model::document::{AlgebraDefinition, Contact, Document, Expression, NamedExpression, Orientation};

use crate::error::Unable;
use crate::text::body::{Body, Turning, matrix};
use crate::text::contacts_by_name;
use crate::text::friction::{Friction, Frictions};
use crate::text::names::{Declared, Names};
use crate::text::term::Term;
use crate::text::tree::{Stop, Tree};

/// Everything in a model that determines its motion.
#[derive(Clone, Debug)]
pub(crate) struct Text {
    pub(crate) names: Names,
    /// The values of the parameters and inputs; for a table, its value at the start.
    pub(crate) parameters: Vec<f64>,
    /// The tables among the inputs, with their indices.
    pub(crate) tables: Vec<(usize, Arc<Table>)>,
    /// The numbers that are added to the values of tables, with the indices of the tables.
    pub(crate) shifts: Vec<(usize, f64)>,
    /// The rates ż of the first-order states.
    pub(crate) state_rates: Vec<Term>,
    /// The acceleration of gravity.
    pub(crate) gravity: Vec<Term>,
    /// The definitions: constant ones of the text, those of bodies on joints and of points, then the others
    /// of the text.
    pub(crate) definitions: Vec<Term>,
    pub(crate) velocities: Velocities,
    pub(crate) brackets: Option<Brackets>,
    pub(crate) constraints: Vec<Term>,
    /// Whether the model has energy in addition to the energy of bodies and joints.
    pub(crate) has_own_energy: bool,
    pub(crate) kinetic: Option<Term>,
    pub(crate) potential: Option<Term>,
    /// The Lagrangian, if it is given as a whole.
    pub(crate) lagrangian: Option<Term>,
    pub(crate) dissipation: Option<Term>,
    pub(crate) bodies: Vec<Body>,
    pub(crate) forces: Vec<(Forced, Term)>,
    /// The dry friction of contacts.
    pub(crate) frictions: Vec<Friction>,
    /// The rigid stops of joints.
    pub(crate) stops: Vec<Stop>,
    /// `[integrals]` and `[outputs]`, as far as they can be resolved.
    pub(crate) observed: Vec<(String, Term)>,
    /// The time at which work on the model must end.
    pub(crate) deadline: Deadline,
}

/// The velocities w of the equations, of which ẋ and η are functions.
#[derive(Clone, Debug)]
pub(crate) enum Velocities {
    /// w = ẋ; quasi-velocities, if there are any, are defined in terms of ẋ: η_s = a_s(t, x, ẋ).
    Ordinary(Vec<Term>),
    /// w = η, with ẋ_i = u_i(t, x, η) given.
    Quasi(Vec<Term>),
}

/// The target of a force.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Forced {
    Coordinate(usize),
    QuasiVelocity(usize),
}

/// Brackets as they are given: [X_r, X_s] = Σ value X_m, with 0 for time.
#[derive(Clone, Debug)]
pub(crate) enum Brackets {
    Catalogue(String),
    /// r, s, and the right-hand side, which is linear in the quasi-velocities; each quasi-velocity represents
    /// its field.
    Table(Vec<(usize, usize, Term)>),
}

impl Text {
    /// The text of the document of a model, with the present values of its parameters.
    pub(crate) fn new(model: &Model) -> Result<Text, Unable> {
        let document = model.document();
        let named = |list: &[NamedExpression]| -> Vec<String> {
            list.iter().map(|entry| entry.name.text.clone()).collect()
        };
        let tree = Tree::of(document);
        let labels = document.bodies.iter().map(|body| &body.name);
        let labels = labels.chain(document.tree.iter().map(|body| &body.name));
        let mut names = Names {
            coordinates: named(&document.coordinates),
            quasi_velocities: document.quasi_velocities.iter().map(|eta| eta.name.text.clone()).collect(),
            parameters: model.parameters().map(|(name, _)| name.to_owned()).collect(),
            states: document.states.iter().map(|state| state.name.text.clone()).collect(),
            definitions: tree.names(),
            constraints: document.constraints.iter().map(|c| c.name.text.clone()).collect(),
            bodies: labels.map(|name| name.text.clone()).collect(),
            functions: document.functions.iter().map(Declared::of).collect(),
            points: tree.points(),
            forces: document.contacts.iter().flat_map(Contact::reactions).collect(),
            ..Names::default()
        };
        let gravity = document.gravity.iter().flat_map(|gravity| &gravity.acceleration);
        names.gravity = gravity.map(|part| names.resolve(&part.ast)).collect::<Result<_, _>>()?;
        names.contacts = contacts_by_name::components(document, &tree, &names)?;
        let frictions = Frictions::of(document, &names)?;
        names.contacts.extend(frictions.forces);
        let term = |expression: &Expression| names.resolve(&expression.ast);
        let terms = |list: &[Expression]| list.iter().map(term).collect::<Result<Vec<Term>, Unable>>();
        let energy = document.lagrangian.as_ref();
        let part = |part: Option<&Expression>| part.map(term).transpose();
        let drives = tree.drives(&names)?;
        let with = |own: Option<&Expression>, more: Vec<Term>| -> Result<Option<Term>, Unable> {
            let all: Vec<(bool, Term)> =
                part(own)?.into_iter().chain(more).map(|term| (false, term)).collect();
            Ok((!all.is_empty()).then_some(Term::Sum(all)))
        };
        let tables = model.parameter_values().tables();
        let observed = document.integrals.iter().chain(&document.outputs);
        let observed = observed.map(|observed| (observed.name.text.clone(), &observed.expression));
        let given = model.given_quasi_velocities().iter();
        let given = given.map(|given| (given.name().to_owned(), given.expression()));
        let observed =
            observed.chain(given).filter_map(|(name, value)| Some((name, term(value).ok()?))).collect();
        let bodies = document.bodies.iter().map(|body| {
            Ok(Body {
                mass: term(&body.mass)?,
                position: terms(&body.position)?,
                inertia: body.inertia.as_ref().map(|inertia| matrix(inertia, term)).transpose()?,
                turning: match &body.orientation {
                    Some(Orientation::Rotation(r)) => Some(Turning::Rotation(terms(&r[..])?)),
                    Some(Orientation::AngularVelocity(w)) => Some(Turning::AngularVelocity(terms(&w[..])?)),
                    None => None,
                },
                force: body.force.as_ref().map_or(Ok(Vec::new()), |force| terms(force))?,
                force_functions: vec![0.0; body.force.as_ref().map_or(0, |force| force.len())],
                may_have_force_functions: true,
                torque: body.torque.as_ref().map_or(Ok(Vec::new()), |torque| terms(torque))?,
            })
        });
        Ok(Text {
            parameters: model.parameters().map(|(_, value)| value).collect(),
            tables: tables.into_iter().map(|(place, table)| (place, Arc::clone(table))).collect(),
            shifts: Vec::new(),
            state_rates: document.states.iter().map(|z| term(&z.rate)).collect::<Result<_, _>>()?,
            gravity: names.gravity.clone(),
            definitions: tree.definitions(&names)?,
            velocities: velocities(document, &tree, &names)?,
            brackets: brackets(document, &names)?,
            constraints: document
                .constraints
                .iter()
                .map(|c| term(&c.expression))
                .collect::<Result<_, _>>()?,
            has_own_energy: energy.is_some_and(|l| l.kinetic.is_some() || l.lagrangian.is_some()),
            kinetic: with(energy.and_then(|l| l.kinetic.as_ref()), drives.kinetic)?,
            potential: with(energy.and_then(|l| l.potential.as_ref()), drives.potential)?,
            lagrangian: part(energy.and_then(|l| l.lagrangian.as_ref()))?,
            dissipation: with(energy.and_then(|l| l.dissipation.as_ref()), drives.dissipation)?,
            bodies: bodies.chain(tree.bodies(&names)?.into_iter().map(Ok)).collect::<Result<_, Unable>>()?,
            frictions: frictions.all,
            stops: drives.stops,
            forces: document
                .forces
                .iter()
                .map(|force| Ok((force.name.text.clone(), term(&force.expression)?)))
                .chain(drives.friction.into_iter().map(Ok))
                .map(|force| force.and_then(|(name, force)| Ok((forced(&names, &name)?, force))))
                .collect::<Result<_, Unable>>()?,
            observed,
            deadline: model.budget().deadline().clone(),
            names,
        })
    }

    /// Whether each constraint is free of velocities, including those in the definitions that it uses.
    pub(crate) fn on_positions(&self) -> Result<Vec<bool>, Unable> {
        let mut moving: Vec<bool> = Vec::with_capacity(self.definitions.len());
        for term in &self.definitions {
            let has = term
                .has_velocities(&moving)
                .ok_or_else(|| Unable::Circular { name: self.names.definitions[moving.len()].clone() })?;
            moving.push(has);
        }
        // The contents of all definitions are known.
        Ok(self.constraints.iter().map(|term| term.has_velocities(&moving) == Some(false)).collect())
    }

    /// The number of terms in the energy, the constraints and all that these use.
    pub(crate) fn terms(&self) -> usize {
        let velocities = match &self.velocities {
            Velocities::Ordinary(terms) | Velocities::Quasi(terms) => terms,
        };
        let energy = [&self.kinetic, &self.potential, &self.lagrangian].into_iter().flatten();
        let of_body = |body: &Body| -> usize {
            let turning = match &body.turning {
                Some(Turning::Rotation(terms) | Turning::AngularVelocity(terms)) => terms.as_slice(),
                None => &[],
            };
            body.position.iter().chain(turning).map(Term::size).sum()
        };
        let all = velocities.iter().chain(&self.definitions).chain(&self.constraints).chain(energy);
        all.map(Term::size).sum::<usize>() + self.bodies.iter().map(of_body).sum::<usize>()
    }

    /// n
    pub(crate) fn coordinates(&self) -> usize {
        self.names.coordinates.len()
    }
}

fn velocities(document: &Document, tree: &Tree<'_>, names: &Names) -> Result<Velocities, Unable> {
    let declared = &document.quasi_velocities;
    let by_joints =
        !document.tree.is_empty() && !declared.is_empty() && declared.iter().all(|eta| eta.is.is_none());
    if document.kinematics.is_empty() && !document.coordinates.is_empty() && !by_joints {
        let definition = |eta: &pc_model::document::QuasiVelocity| {
            let undefined = || Unable::Undefined { name: eta.name.text.clone() };
            names.resolve(&eta.is.as_ref().ok_or_else(undefined)?.ast)
        };
        return Ok(Velocities::Ordinary(declared.iter().map(definition).collect::<Result<_, _>>()?));
    }
    let of_joints = if by_joints { tree.rates(names)? } else { Vec::new() };
    let rate = |name: &String| {
        if let Some((_, rate)) = of_joints.iter().find(|(x, _)| x == name) {
            return Ok(rate.clone());
        }
        match document.kinematics.iter().find(|entry| entry.name.text == *name) {
            Some(entry) => names.resolve(&entry.expression.ast),
            None => names.quasi_velocity(&format!("{name}'")),
        }
    };
    Ok(Velocities::Quasi(names.coordinates.iter().map(rate).collect::<Result<_, _>>()?))
}

fn brackets(document: &Document, names: &Names) -> Result<Option<Brackets>, Unable> {
    let Some(algebra) = &document.algebra else { return Ok(None) };
    Ok(Some(match &algebra.definition {
        AlgebraDefinition::Catalogue(name) => Brackets::Catalogue(name.value.clone()),
        AlgebraDefinition::Brackets(list) => {
            let field = |name: &str| match name {
                "t" => Ok(0),
                name => match names.quasi_velocities.iter().position(|eta| eta == name) {
                    Some(s) => Ok(s + 1),
                    None => Err(Unable::UnknownName { name: name.to_owned() }),
                },
            };
            let entry = |bracket: &pc_model::document::Bracket| {
                let value = names.resolve(&bracket.value.ast)?;
                Ok((field(&bracket.left.text)?, field(&bracket.right.text)?, value))
            };
            Brackets::Table(list.iter().map(entry).collect::<Result<_, Unable>>()?)
        }
    }))
}

fn forced(names: &Names, name: &str) -> Result<Forced, Unable> {
    let place = |list: &[String]| list.iter().position(|known| known == name);
    None.or_else(|| place(&names.quasi_velocities).map(Forced::QuasiVelocity))
        .or_else(|| place(&names.coordinates).map(Forced::Coordinate))
        .ok_or_else(|| Unable::UnknownName { name: name.to_owned() })
}
