//! The second derivation of a model, with the names used by the first.

use pc_mech::Expr;
use pc_model::{Assembly, Flow, Model};
use pc_print::Form;

use crate::comparison::agreement::{Agreement, Passed};
use crate::derivation::derivation::{Completing, Derivation};
use crate::derivation::place::Place;
use crate::derivation::quantity::{Free, Quantity};
use crate::derivation::structure::Structure;
use crate::error::{Irregular, VerifyError};
use crate::numbers::linear::fitting_inverse;
use crate::numbers::rounding::{Random, Rounding};
use crate::numbers::units::Units;
use crate::text::couplings::Couplings;
use crate::text::resultant::Resultant;
use crate::text::text::{Text, Velocities};

/// The number of terms that can be evaluated in some milliseconds.
pub(crate) const LONG: usize = 100_000;

/// The number of terms to evaluate for all states together, which takes about a second.
const ALL_STATES: usize = 5_000_000;

/// The number of terms up to which all equations are evaluated at a single state: this takes some seconds.
const ONE_STATE: usize = 5 * ALL_STATES;

/// The number of terms to evaluate along virtual velocities for all states together.
const ALL_ALONG: usize = 4 * ALL_STATES;

/// The number of operations of a matrix product that take as long as one term.
const PRODUCTS: usize = 50;

/// The number of states at which a model is always compared along virtual velocities.
const FEWEST: usize = 3;

/// The largest number of velocities for which the canonical equations are derived only to be compared: the
/// inverse of a full mass matrix then takes a second, and ten times as long for every two velocities more.
const MOST_INVERTED: usize = 9;

/// The largest number of velocities for which an orthonormal frame is derived merely for the comparison: its nested roots make it
/// expensive.
const MOST_ORTHONORMAL: usize = 3;

/// The second derivation of a model.
#[derive(Clone, Debug)]
pub struct Second {
    pub(crate) derivation: Derivation,
    /// The names of the columns in which a table shows the velocities: quasi-velocities, or ẋ where none is
    /// declared.
    pub(crate) columns: Vec<String>,
    pub(crate) start: Place,
    /// Whether the energy of the first derivation is y·η − L of the independent velocities, and not of all
    /// velocities.
    pub(crate) has_free_energy: bool,
    external: Vec<String>,
    /// The indices, among the coordinates, of the quaternions of joints.
    quaternions: Vec<[usize; 4]>,
}

/// What Newton's method may leave in place of a zero, in the unit of the component.
const LEFT: f64 = 1e-9;

/// The number of points at which ranks are evaluated.
const RANK_POINTS: usize = 6;

impl Second {
    /// The second derivation of a model, which starts where the first does.
    ///
    /// # Errors
    /// [`VerifyError::Unable`].
    pub fn new(model: &Model, assembly: &Assembly<'_>) -> Result<Second, VerifyError> {
        let text = Text::new(model)?;
        let n = text.coordinates();
        let columns = match text.names.quasi_velocities.as_slice() {
            [] => text.names.coordinates.iter().map(|x| format!("{x}'")).collect(),
            declared => declared.to_vec(),
        };
        let mut derivation = Derivation {
            on_positions: text.on_positions()?,
            kept: Vec::new(),
            completing: Vec::new(),
            structure: Structure::Frame,
            couplings: Couplings::of(&text),
            units: Units::default(),
            text,
        };
        // The velocities of the energy are chosen by the first derivation.
        let all = assembly.system.quasi_velocities().iter().skip(columns.len());
        derivation.completing =
            all.filter_map(|eta| completing(&derivation.text, &eta.to_string())).collect();
        // Of constraints that follow from each other any may be dropped: the first derivation chooses. That they
        // follow, and that the motion satisfies them, is verified at each state.
        let follows = |a: &usize| {
            let name = &derivation.text.names.constraints[*a];
            assembly.constraints.redundant().iter().any(|redundant| redundant.constraint == *name)
        };
        let binding: Vec<usize> = (0..derivation.on_positions.len()).filter(|a| !follows(a)).collect();
        derivation.kept.clone_from(&binding);
        let (x, eta) = assembly.start.split_at(n);
        let stated = Passed::from;
        let refused = |passed: Passed| match passed {
            Passed::Error(error) => error,
            Passed::Noise(disagreement) => VerifyError::Disagreement(disagreement),
            Passed::Irregular(irregular) => {
                VerifyError::NothingCompared { tried: 1, reason: irregular.to_string() }
            }
        };
        let w = derivation.velocities_of(assembly.t_start, x, &eta[..columns.len()]);
        let w = w.map_err(|irregular| refused(stated(irregular)))?;
        let z = eta[eta.len() - derivation.text.state_rates.len()..].to_vec();
        let start = Place { t: assembly.t_start, x: x.to_vec(), w, z };
        derivation.units = derivation.units_at(&start);
        if let Velocities::Quasi(_) = derivation.text.velocities {
            derivation.structure = Structure::new(&derivation.text, derivation.rank(&start), start.w.len())?;
        }
        if !binding.is_empty() {
            let mut kept = derivation.independent(&start, &binding).unwrap_or_default();
            for number in 0..RANK_POINTS {
                if kept.len() == binding.len() {
                    break;
                }
                let place = derivation.random(&start, number);
                let found =
                    place.and_then(|place| derivation.independent(&place, &binding)).unwrap_or_default();
                if found.len() > kept.len() {
                    kept = found;
                }
            }
            derivation.kept = kept;
        }
        let bodies = assembly.system.bodies();
        derivation.find_force_functions(&start, |body, component| {
            let known = bodies.iter().find(|known| known.name() == body);
            known.is_some_and(|known| known.force_in_lagrangian().get(component) == Some(&true))
        });
        let is_free = assembly.constraints.held().is_none();
        let has_free_energy = is_free && pc_print::energy_remark(assembly).is_some();
        let coordinates = assembly.system.frame().coordinates();
        let place = |q: &Expr<'_>| coordinates.iter().position(|x| x == q).unwrap_or_default(); // is among them
        let quaternions =
            assembly.system.unit_quaternions().iter().map(|q| q.each_ref().map(place)).collect();
        Ok(Second {
            derivation,
            columns,
            start,
            has_free_energy,
            external: model.external_forces(),
            quaternions,
        })
    }

    /// The state with these coordinates, columns and first-order states. Quaternions are divided by their lengths: both
    /// derivations hold for rotations, and differ in how they extend to other quaternions.
    pub(crate) fn place(&self, t: f64, row: &[f64]) -> Result<Place, Irregular> {
        let (x, eta) = row.split_at(self.start.x.len());
        let (eta, z) = eta.split_at(eta.len() - self.start.z.len());
        let mut x = x.to_vec();
        for places in &self.quaternions {
            let length = places.iter().fold(0.0f64, |length, &i| length.hypot(x[i]));
            places.iter().for_each(|&i| x[i] /= length);
        }
        let w = self.derivation.velocities_of(t, &x, eta)?;
        Ok(Place { t, x, w, z: z.to_vec() })
    }

    #[cfg(test)]
    pub(crate) fn derivation(&self) -> &Derivation {
        &self.derivation
    }

    #[cfg(test)]
    pub(crate) fn start(&self) -> &Place {
        &self.start
    }

    /// An agreement in which no states have been compared yet.
    pub(crate) fn nothing_yet(&self) -> Agreement {
        let mut agreement = Agreement {
            states: 0,
            projected: 0,
            skipped: 0,
            reason: None,
            error: 0.0,
            quantity: String::new(),
            forms: Vec::new(),
            not_compared: Vec::new(),
        };
        for force in &self.external {
            agreement.leave_out(&format!("the force on {force} computed outside"), "taken for 0");
        }
        agreement
    }

    /// The quasi-velocity of this name: a column, the left-hand side of a constraint, or a velocity.
    pub(crate) fn free(&self, name: &str) -> Option<Free> {
        let column = self.columns.iter().position(|column| column == name).map(Free::Column);
        column.or_else(|| {
            completing(&self.derivation.text, name).map(|completing| match completing {
                Completing::Velocity(i) => Free::Velocity(i),
                Completing::Constraint(a) => Free::Constraint(a),
            })
        })
    }

    /// Its value.
    pub(crate) fn velocity(&self, name: &str) -> Option<Quantity> {
        self.free(name).map(|free| match free {
            Free::Column(s) => Quantity::Column(s),
            Free::Velocity(i) => Quantity::Velocity(i),
            Free::Constraint(_) => Quantity::Zero,
        })
    }

    /// The rate of a component of the state.
    pub(crate) fn rate(&self, name: &str) -> Option<Quantity> {
        let coordinates = &self.derivation.text.names.coordinates;
        let coordinate = coordinates.iter().position(|x| x == name).map(Quantity::Velocity);
        let states = &self.derivation.text.names.states;
        let state = || states.iter().position(|z| z == name).map(Quantity::StateRate);
        coordinate.or_else(state).or_else(|| {
            self.velocity(name).map(|quantity| match quantity {
                Quantity::Column(s) => Quantity::ColumnRate(s),
                Quantity::Velocity(i) => Quantity::Acceleration(i),
                other => other,
            })
        })
    }

    /// An observable.
    pub(crate) fn observable(&self, name: &str) -> Option<Quantity> {
        let text = &self.derivation.text;
        if name == "energy" {
            return Some(if self.has_free_energy { Quantity::FreeEnergy } else { Quantity::Energy });
        }
        let observed = text.observed.iter().position(|(known, _)| known == name).map(Quantity::Observed);
        let names = &text.names;
        let reaction = || {
            let constraint = name.strip_prefix("λ_")?;
            names.constraints.iter().position(|c| c == constraint).map(Quantity::Reaction)
        };
        let resultant = || Resultant::named(name, &names.constraints, &names.bodies).map(Quantity::Resultant);
        observed.or_else(reaction).or_else(resultant)
    }

    /// The size of a component of the state with this name and value: that of its value, or its unit where the value is what
    /// Newton's method leaves in place of a zero. The unit is 1, unless the start has small values.
    pub fn size(&self, name: &str, value: f64) -> f64 {
        let unit = self.unit(name);
        if value.abs() > LEFT * unit { value.abs() } else { unit }
    }

    fn unit(&self, name: &str) -> f64 {
        let (names, Units { x, w, z }) = (&self.derivation.text.names, &self.derivation.units);
        let among = |names: &[String], units: &[f64]| {
            names.iter().position(|known| known == name).and_then(|place| units.get(place).copied())
        };
        let is_own = matches!(self.derivation.text.velocities, Velocities::Quasi(_))
            || names.quasi_velocities.is_empty();
        let velocity = || among(&self.columns, w).filter(|_| is_own);
        let known = among(&names.coordinates, x).or_else(|| among(&names.states, z)).or_else(velocity);
        known.unwrap_or(1.0)
    }

    /// The approximate number of terms of the text that have to be evaluated to compare the equations at one
    /// state.
    pub fn cost(&self) -> usize {
        let k = self.start.w.len();
        let evaluations = self.derivation.couplings.pairs() + 4 * k + 4;
        evaluations
            .saturating_mul(self.derivation.text.terms())
            .saturating_add(k.saturating_pow(3) / PRODUCTS)
    }

    /// The cost of a comparison along a few virtual velocities.
    fn projected_cost(&self) -> usize {
        let k = self.start.w.len();
        // The frame, the definitions of quasi-velocities and the constraints are linearised several times.
        let is_linearised = matches!(self.derivation.text.velocities, Velocities::Quasi(_))
            || self.derivation.has_definitions()
            || !self.derivation.on_positions.is_empty();
        let evaluations = if is_linearised { 200 + 8 * k } else { 30 };
        evaluations.saturating_mul(self.derivation.text.terms())
    }

    /// Whether one comparison takes more than some milliseconds, because the equations are long and are in momenta
    /// or other variables, so that they cannot be compared along virtual velocities instead.
    pub fn is_long(&self, flow: &Flow) -> bool {
        let is_own = flow.has_own_variables() && flow.motion.coordinates() == self.start.x.len();
        self.cost() > LONG && (flow.has_momenta() || !is_own)
    }

    /// The reason why a printed form is too expensive to derive just for a comparison, if it is.
    pub(crate) fn too_large_for(&self, form: Form, assembly: &Assembly<'_>) -> Option<&'static str> {
        if form == Form::Voronets && assembly.constraints.multipliers().is_none() {
            return None; // equal to Lagrange's, and not derived
        }
        let quasi_velocities = assembly.system.quasi_velocities().len();
        if form == Form::Hamel && assembly.given.is_empty() {
            return None; // not derived
        }
        let inverted = matches!(form, Form::Canonical | Form::LiePoisson | Form::Hamel);
        if inverted && quasi_velocities > MOST_INVERTED {
            return Some("a matrix would be inverted in symbols");
        }
        if form == Form::Orthonormal && quasi_velocities > MOST_ORTHONORMAL {
            return Some("the mass matrix would be factorised in symbols");
        }
        (form != Form::Poincare && self.cost() > LONG).then_some("the model is large")
    }

    /// The coordinates, columns and first-order states that belong to the state of a flow; coordinates that
    /// the flow leaves out have their start values.
    pub(crate) fn row(&self, flow: &mut Flow, t: f64, state: &[f64]) -> Vec<f64> {
        let shown = flow.row_beside(t, state);
        let names = &self.derivation.text.names;
        let known = |name: &String| Some(shown[flow.names.iter().position(|shown| shown == name)?]);
        let coordinates = names.coordinates.iter().zip(&self.start.x);
        let coordinates = coordinates.map(|(name, &start)| known(name).unwrap_or(start));
        let others = self.columns.iter().chain(&names.states).map(|name| known(name).unwrap_or(f64::NAN));
        coordinates.chain(others).collect()
    }

    /// The number of states, out of this many, at which all equations are compared.
    pub(crate) fn wholly(&self, states: usize) -> usize {
        let least = usize::from(self.cost() <= ONE_STATE);
        states.min(ALL_STATES / self.cost().max(1)).max(least)
    }

    /// The number of states, out of this many, at which any equations are compared.
    pub(crate) fn affordable(&self, states: usize) -> usize {
        let affordable = self.wholly(states) + ALL_ALONG / self.projected_cost().max(1);
        states.min(affordable.max(FEWEST))
    }

    pub(crate) fn named(&self, at: &Place, columns: &[f64]) -> Vec<(String, f64)> {
        let coordinates = self.derivation.text.names.coordinates.iter().zip(&at.x);
        let states = self.derivation.text.names.states.iter().zip(&at.z);
        let all = coordinates.chain(self.columns.iter().zip(columns)).chain(states);
        all.map(|(name, &value)| (name.clone(), value)).collect()
    }
}

/// The undeclared quasi-velocity of this name: `x'`, or the name of a constraint, extended by `_` if
/// something else has that name.
fn completing(text: &Text, name: &str) -> Option<Completing> {
    let place = |names: &[String], name: &str| names.iter().position(|known| known == name);
    let velocity = name.strip_suffix('\'').and_then(|x| place(&text.names.coordinates, x));
    let constraint = || place(&text.names.constraints, name.trim_end_matches('_'));
    velocity.map(Completing::Velocity).or_else(|| constraint().map(Completing::Constraint))
}

impl Derivation {
    /// The sizes of the components of states near a start.
    fn units_at(&self, start: &Place) -> Units {
        match self.text.velocities {
            Velocities::Ordinary(_) => Units::of(start, None),
            Velocities::Quasi(_) => {
                let frame = self.frame(start, &Rounding::none());
                Units::of(start, Some(&frame.unwrap_or_else(|_| vec![Vec::new(); start.w.len()])))
            }
        }
    }

    /// The rank of b: the largest that it has at some points near a state.
    fn rank(&self, near: &Place) -> usize {
        let exact = Rounding::none();
        let mut random = Random::new(0);
        let mut largest = 0;
        for number in 0..RANK_POINTS {
            let scale = if number == 0 { 0.0 } else { 0.1 };
            let x = self.units.displaced(near, scale, &mut random);
            let Ok(frame) = self.frame(&Place { x, ..near.clone() }, &exact) else { continue };
            let b = nalgebra::DMatrix::from_fn(near.x.len(), near.w.len(), |i, s| frame[s][i]);
            largest = fitting_inverse(&b).map_or(largest, |(_, rank)| largest.max(rank));
        }
        largest
    }
}
