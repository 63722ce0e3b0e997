//! The comparison of the two derivations.

use std::fmt;
use std::sync::Arc;

use pc_mech::{Backend, Expr, Graph, Motion, Table, VectorField};
use pc_model::{Assembly, Flow, Model, Variables};

use crate::derivation::{Completing, Derivation, Derived, Place};
use crate::error::{Disagreement, Irregular, VerifyError};
use crate::linear::pseudo_inverse;
use crate::quantities::{Free, Quantity, REPETITIONS, Sized};
use crate::rounding::{Random, Rounding, UNIT, within};
use crate::structure::Structure;
use crate::text::{Text, Velocities};

/// The largest difference of two values that agree, relative to the size of their terms.
///
/// Both routes sum some hundred terms in different orders and lead them through linear equations: some thousand roundings of
/// the largest term, and how far rounding is amplified is measured at each state. A forgotten or turned term is an error of
/// order one of its own size, which at random states is seldom below 1e-6 of the largest.
pub const TOLERANCE: f64 = 1e-12;

/// A difference that ordinary rounding makes. Where one is larger, it is measured how far rounding is amplified.
const ORDINARY: f64 = 1e-14;

/// How much is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Number of states at which the derivations are compared.
    pub states: usize,
    /// From which the states are drawn: other seeds, other states.
    pub seed: u64,
}

impl Default for Options {
    /// 100 states.
    fn default() -> Options {
        Options { states: 100, seed: 0 }
    }
}

/// That, and how closely, two derivations agree.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// States at which all forms were compared.
    pub states: usize,
    /// States that were passed over since the equations are singular or not defined there.
    pub skipped: usize,
    /// Why the last of these was.
    pub reason: Option<String>,
    /// The largest difference, relative to the size of the terms; at most [`TOLERANCE`].
    pub error: f64,
    /// What differs by it.
    pub quantity: String,
    /// The forms compared: `poincare`, `canonical`, `emit`.
    pub forms: Vec<String>,
    /// What was not compared, each with the reason.
    pub not_compared: Vec<String>,
}

impl fmt::Display for Agreement {
    /// `agrees to 3e-15 at 100 states`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = if self.states == 1 { "" } else { "s" };
        if self.error == 0.0 {
            write!(f, "agrees to the last digit at {} state{plural}", self.states)
        } else {
            write!(f, "agrees to {:.0e} at {} state{plural}", self.error, self.states)
        }
    }
}

/// Derives a model a second time and compares, at random states on the constraints: ẋ, η̇ or ẏ, λ, the energy and its rate,
/// integrals and outputs, of the equations in quasi-velocities and in momenta that are integrated, and of those that are
/// written as source.
///
/// # Errors
/// [`VerifyError::Disagreement`] with the quantity, its two values and the state; [`VerifyError::Model`] if the first
/// derivation refuses the model; [`VerifyError::Unable`] if the second cannot be made;
/// [`VerifyError::NothingCompared`] if no state is regular.
pub fn verify(model: &Model, options: &Options) -> Result<Agreement, VerifyError> {
    let mut observed = model.clone();
    observed.observe_reactions(true);
    let graph = Graph::new();
    let assembly = observed.assemble(&graph)?;
    let second = Second::new(&observed, &assembly)?;
    let mut agreement = second.nothing_yet();
    let mut firsts = Vec::new();
    let flow = Flow::new(&observed, &assembly, Variables::QuasiVelocities)?;
    firsts.push(First::flow("poincare", flow, &second, &assembly, &mut agreement));
    match Flow::new(&observed, &assembly, Variables::Momenta) {
        Ok(flow) => firsts.push(First::flow("canonical", flow, &second, &assembly, &mut agreement)),
        Err(error) => agreement.leave_out("canonical", &error.diagnostic().message),
    }
    let plain_graph = Graph::new();
    let plain = model.assemble(&plain_graph)?;
    match First::emitted(&plain, &second, &mut agreement) {
        Ok(first) => firsts.push(first),
        Err(reason) => agreement.leave_out("emit", &reason),
    }
    agreement.forms = firsts.iter().map(|first| first.form.clone()).collect();
    let mut number = 0;
    while agreement.states < options.states && number < TRIES * options.states {
        let seed = (options.seed << 32) as usize + number;
        number += 1;
        let compared = second.derivation.random(&second.start, seed).map_err(Passed::from);
        match compared.and_then(|place| second.compare(&mut firsts, &place, &mut agreement)) {
            Ok(()) => agreement.states += 1,
            Err(passed) => agreement.pass_over(passed)?,
        }
    }
    agreement.finished(number)
}

/// States that are tried for each that is to be compared.
const TRIES: usize = 3;

/// Why a state gave no comparison.
enum Passed {
    /// It is not regular.
    Irregular(Irregular),
    /// The derivations differ.
    Error(VerifyError),
}

impl From<Irregular> for Passed {
    fn from(irregular: Irregular) -> Passed {
        match irregular {
            Irregular::Unable(unable) => Passed::Error(unable.into()),
            irregular => Passed::Irregular(irregular),
        }
    }
}

impl Agreement {
    fn leave_out(&mut self, what: &str, reason: &str) {
        let line = format!("{what}: {reason}");
        if !self.not_compared.contains(&line) {
            self.not_compared.push(line);
        }
    }

    fn pass_over(&mut self, passed: Passed) -> Result<(), VerifyError> {
        match passed {
            Passed::Error(error) => Err(error),
            Passed::Irregular(irregular) => {
                self.skipped += 1;
                self.reason = Some(irregular.to_string());
                Ok(())
            }
        }
    }

    fn finished(self, tried: usize) -> Result<Agreement, VerifyError> {
        if self.states == 0 {
            let reason = self.reason.unwrap_or_else(|| "none was tried".to_owned());
            return Err(VerifyError::NothingCompared { tried, reason });
        }
        Ok(self)
    }
}

/// The second derivation of a model.
#[derive(Clone, Debug)]
pub struct Second {
    derivation: Derivation,
    /// What the columns of a table are called.
    columns: Vec<String>,
    start: Place,
    external: Vec<String>,
}

/// Points at which ranks are looked at.
const RANK_POINTS: usize = 6;

impl Second {
    /// The second derivation of a model, at the start of the first.
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
            text,
        };
        // Which velocities the energy is one of is the first derivation's choice.
        let all = assembly.system.quasi_velocities().iter().skip(columns.len());
        derivation.completing =
            all.filter_map(|eta| completing(&derivation.text, &eta.to_string())).collect();
        let (x, eta) = assembly.start.split_at(n);
        let stated = Passed::from;
        let refused = |passed: Passed| match passed {
            Passed::Error(error) => error,
            Passed::Irregular(irregular) => {
                VerifyError::NothingCompared { tried: 1, reason: irregular.to_string() }
            }
        };
        let w = derivation.velocities_of(assembly.t_start, x, &eta[..columns.len()]);
        let w = w.map_err(|irregular| refused(stated(irregular)))?;
        let z = eta[eta.len() - derivation.text.state_rates.len()..].to_vec();
        let start = Place { t: assembly.t_start, x: x.to_vec(), w, z };
        if let Velocities::Quasi(_) = derivation.text.velocities {
            derivation.structure = Structure::new(&derivation.text, derivation.rank(&start), start.w.len())?;
        }
        if !derivation.on_positions.is_empty() {
            // Of constraints that follow from each other any may be dropped: the first derivation says which. That they do
            // is looked at here, and that the motion follows them.
            let dropped = |a: &usize| {
                let name = &derivation.text.names.constraints[*a];
                assembly.constraints.redundant().iter().any(|redundant| redundant.constraint == *name)
            };
            let last: Vec<usize> = (0..derivation.on_positions.len()).filter(dropped).collect();
            let mut kept = derivation.independent(&start, &last).unwrap_or_default();
            for number in 0..RANK_POINTS {
                let place = derivation.random(&start, number);
                let found = place.and_then(|place| derivation.independent(&place, &last)).unwrap_or_default();
                if found.len() > kept.len() {
                    kept = found;
                }
            }
            derivation.kept = kept;
        }
        derivation.find_force_functions(&start);
        Ok(Second { derivation, columns, start, external: model.external_forces() })
    }

    /// Compares what is integrated, here called `form`, with the second derivation at one of its states.
    ///
    /// # Errors
    /// As for [`verify`].
    pub fn agrees(
        &self,
        form: &str,
        flow: &Flow,
        assembly: &Assembly<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<Agreement, VerifyError> {
        let mut agreement = self.nothing_yet();
        let mut flow = flow.clone();
        let mut row = flow.row(t, state);
        row.truncate(flow.names.len());
        let mut firsts = [First::flow(form, flow, self, assembly, &mut agreement)];
        agreement.forms.push(form.to_owned());
        let (x, eta) = row.split_at(self.start.x.len());
        let (eta, z) = eta.split_at(eta.len() - self.start.z.len());
        let place = self.derivation.velocities_of(t, x, eta);
        let place = place.map(|w| Place { t, x: x.to_vec(), w, z: z.to_vec() });
        let compared = place.map_err(Passed::from);
        match compared.and_then(|place| self.compare(&mut firsts, &place, &mut agreement)) {
            Ok(()) => agreement.states += 1,
            Err(passed) => agreement.pass_over(passed)?,
        }
        agreement.finished(1)
    }

    #[cfg(test)]
    pub(crate) fn derivation(&self) -> &Derivation {
        &self.derivation
    }

    #[cfg(test)]
    pub(crate) fn start(&self) -> &Place {
        &self.start
    }

    /// No state compared.
    fn nothing_yet(&self) -> Agreement {
        let mut agreement = Agreement {
            states: 0,
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

    /// The column of this name, or what a constraint of this name fixes at 0.
    fn velocity(&self, name: &str) -> Option<Quantity> {
        let column = self.columns.iter().position(|column| column == name).map(Quantity::Column);
        let constraint = || self.derivation.text.names.constraints.iter().any(|c| c == name);
        column.or_else(|| constraint().then_some(Quantity::Zero))
    }

    /// The quasi-velocity of this name.
    fn free(&self, name: &str) -> Option<Free> {
        let column = self.columns.iter().position(|column| column == name).map(Free::Column);
        let constraints = &self.derivation.text.names.constraints;
        column.or_else(|| constraints.iter().position(|c| c == name).map(Free::Constraint))
    }

    /// The rate of a component of the state.
    fn rate(&self, name: &str) -> Option<Quantity> {
        let coordinates = &self.derivation.text.names.coordinates;
        let coordinate = coordinates.iter().position(|x| x == name).map(Quantity::Velocity);
        let states = &self.derivation.text.names.states;
        let state = || states.iter().position(|z| z == name).map(Quantity::StateRate);
        coordinate.or_else(state).or_else(|| {
            self.velocity(name).map(|quantity| match quantity {
                Quantity::Column(s) => Quantity::ColumnRate(s),
                other => other,
            })
        })
    }

    /// An observable.
    fn observable(&self, name: &str) -> Option<Quantity> {
        let text = &self.derivation.text;
        if name == "energy" {
            return Some(Quantity::Energy);
        }
        let observed = text.observed.iter().position(|(known, _)| known == name).map(Quantity::Observed);
        observed.or_else(|| {
            let constraint = name.strip_prefix("λ_")?;
            text.names.constraints.iter().position(|c| c == constraint).map(Quantity::Reaction)
        })
    }

    /// Whether an observable is a component of a reaction on a body, as in `F_CONSTRAINT_BODY_x`.
    fn is_body_reaction(&self, name: &str) -> bool {
        let rest = name.strip_prefix("F_").or_else(|| name.strip_prefix("N_"));
        let constraints = &self.derivation.text.names.constraints;
        rest.is_some_and(|rest| constraints.iter().any(|c| rest.starts_with(&format!("{c}_"))))
    }

    /// How many terms of the text are evaluated for the equations at one state, roughly.
    pub fn cost(&self) -> usize {
        let k = self.start.w.len();
        (k * (k + 1) / 2 + 4 * k + 4).saturating_mul(self.derivation.text.terms())
    }

    /// Compares all that is compiled with the second derivation at a place.
    fn compare(&self, firsts: &mut [First<'_>], at: &Place, agreement: &mut Agreement) -> Result<(), Passed> {
        let columns = self.columns_at(at)?;
        let exact = Rounding::none();
        let derived = self.derivation.at(at, &exact)?;
        let mut scattered = None;
        let mut differences = Vec::new();
        for first in firsts {
            let (wanted, free) = (first.quantities(), first.free.as_deref());
            let mut seconds = self.derivation.quantities(&derived, &wanted, free, &exact)?;
            let values = first.values(at, &columns)?;
            if !values.iter().zip(&seconds).all(|(&one, &two)| error(one, two) <= ORDINARY) {
                if scattered.is_none() {
                    scattered = Some(self.derivation.scattered(&derived)?);
                }
                let scattered = scattered.as_deref().unwrap_or_default();
                self.derivation.scatter(&mut seconds, scattered, &wanted, first.free.as_deref())?;
                if !values.iter().zip(&seconds).all(|(&one, &two)| within(error(one, two), TOLERANCE)) {
                    self.scatter_first(first, &derived, &values, &mut seconds);
                }
            }
            for (place, (label, _)) in first.wanted.iter().enumerate() {
                let (one, two) = (values[place], seconds[place]);
                let error = error(one, two);
                if !within(error, TOLERANCE) {
                    return Err(Passed::Error(VerifyError::Disagreement(Box::new(Disagreement {
                        form: first.form.clone(),
                        quantity: label.clone(),
                        first: one,
                        second: two.value,
                        size: two.size,
                        t: at.t,
                        state: self.named(at, &columns),
                    }))));
                }
                differences.push((error, label.clone()));
            }
        }
        for (error, label) in differences {
            if error > agreement.error || agreement.quantity.is_empty() {
                (agreement.error, agreement.quantity) = (error, label);
            }
        }
        Ok(())
    }

    /// Raises sizes to how far the values of the first derivation scatter, in units of rounding, at states that differ by
    /// rounding: its eliminations amplify it, too, where independent velocities determine the others badly.
    fn scatter_first(&self, first: &mut First<'_>, derived: &Derived, values: &[f64], seconds: &mut [Sized]) {
        for seed in 1..=REPETITIONS {
            let rounding = Rounding::made(seed);
            let near = self.derivation.near(&derived.place, &derived.velocity_sizes, &rounding);
            // Where it has no values there it says nothing of rounding.
            let Ok(moved) = self.columns_at(&near).and_then(|columns| first.values(&near, &columns)) else {
                continue;
            };
            for ((second, value), moved) in seconds.iter_mut().zip(values).zip(moved) {
                let scatter = (moved - value).abs() / UNIT;
                if scatter.is_finite() {
                    second.size = second.size.max(scatter);
                }
            }
        }
    }

    fn columns_at(&self, at: &Place) -> Result<Vec<f64>, Irregular> {
        let exact = Rounding::none();
        self.derivation.columns(&self.derivation.still(at, &exact))
    }

    fn named(&self, at: &Place, columns: &[f64]) -> Vec<(String, f64)> {
        let coordinates = self.derivation.text.names.coordinates.iter().zip(&at.x);
        let states = self.derivation.text.names.states.iter().zip(&at.z);
        let all = coordinates.chain(self.columns.iter().zip(columns)).chain(states);
        all.map(|(name, &value)| (name.clone(), value)).collect()
    }
}

/// A quasi-velocity that is not declared: `x'`, or the name of a constraint, made longer where it is that of something else.
fn completing(text: &Text, name: &str) -> Option<Completing> {
    let place = |names: &[String], name: &str| names.iter().position(|known| known == name);
    let velocity = name.strip_suffix('\'').and_then(|x| place(&text.names.coordinates, x));
    let constraint = || place(&text.names.constraints, name.trim_end_matches('_'));
    velocity.map(Completing::Velocity).or_else(|| constraint().map(Completing::Constraint))
}

/// The difference of two values relative to the size of their terms.
fn error(one: f64, two: Sized) -> f64 {
    let difference = (one - two.value).abs();
    if difference == 0.0 { 0.0 } else { difference / two.size }
}

impl Derivation {
    /// The rank of b, the largest of those at some points near a place.
    fn rank(&self, near: &Place) -> usize {
        let exact = Rounding::none();
        let mut random = Random::new(0);
        let mut largest = 0;
        for number in 0..RANK_POINTS {
            let scale = if number == 0 { 0.0 } else { 0.1 };
            let x = near.x.iter().map(|x| x + scale * (1.0 + x.abs()) * random.signed()).collect();
            let Ok(frame) = self.frame(&Place { x, ..near.clone() }, &exact) else { continue };
            let b = nalgebra::DMatrix::from_fn(near.x.len(), near.w.len(), |i, s| frame[s][i]);
            largest = pseudo_inverse(&b).map_or(largest, |(_, rank)| largest.max(rank));
        }
        largest
    }
}

/// Equations of the first derivation, compiled.
struct First<'g> {
    form: String,
    /// Names of what is compared, with what it is.
    wanted: Vec<(String, Quantity)>,
    /// Places of these among the values of the first derivation.
    places: Vec<usize>,
    /// The columns that are free quasi-velocities, where momenta or energies of these are compared.
    free: Option<Vec<Free>>,
    compiled: Compiled<'g>,
}

enum Compiled<'g> {
    /// What is integrated, with what each quasi-velocity of the system is.
    Flow { flow: Box<Flow>, quasi_velocities: Vec<Quantity> },
    /// What is written as source, in the interpreter, with the columns in its state and the rate of the energy at t and
    /// state.
    Emitted {
        motion: Box<Motion>,
        free: Vec<Free>,
        energy_rate: EnergyRate<'g>,
        /// The inputs that are read from tables, with their places among the parameters.
        tables: Vec<(usize, Arc<Table>)>,
    },
}

/// dH/dt as a function of time, coordinates, quasi-velocities and parameters.
struct EnergyRate<'g> {
    graph: &'g Graph,
    rate: Expr<'g>,
    inputs: Vec<Expr<'g>>,
    parameters: Vec<(Expr<'g>, f64)>,
}

impl EnergyRate<'_> {
    fn at(&self, t: f64, state: &[f64]) -> f64 {
        let values = std::iter::once(t).chain(state.iter().copied());
        let mut place: Vec<_> = self.inputs.iter().copied().zip(values).collect();
        place.extend(&self.parameters);
        self.graph.evaluate(&[self.rate], &place).map_or(f64::NAN, |values| values[0])
    }
}

impl<'g> First<'g> {
    /// What is integrated.
    fn flow(
        form: &str,
        flow: Flow,
        second: &Second,
        assembly: &Assembly<'_>,
        agreement: &mut Agreement,
    ) -> First<'g> {
        let system = &assembly.system;
        let names: Vec<String> = system.quasi_velocities().iter().map(ToString::to_string).collect();
        let of_name = |name: &String| second.velocity(name).unwrap_or(Quantity::Zero);
        let quasi_velocities = names.iter().map(of_name).collect();
        let n = flow.motion.coordinates();
        let state = flow.motion.names();
        let canonical = flow.has_momenta();
        let columns = flow.free_quasi_velocities().iter().map(|&s| second.free(&names[s]));
        let free: Option<Vec<Free>> = if canonical { columns.collect() } else { None };
        let mut candidates: Vec<(String, Option<Quantity>)> = Vec::new();
        let moving = n..state.len() - flow.motion.states();
        for (i, name) in state.iter().enumerate() {
            let momentum = (canonical && moving.contains(&i)).then(|| {
                let known = free.is_some();
                known.then(|| Quantity::Momentum(i - n))
            });
            candidates.push((name.clone(), momentum.unwrap_or(Some(Quantity::Zero))));
        }
        for (i, name) in state.iter().enumerate() {
            let momentum = || free.is_some().then(|| Quantity::MomentumRate(i - n));
            let rate = if canonical && moving.contains(&i) { momentum() } else { second.rate(name) };
            candidates.push((format!("the rate of {name}"), rate));
        }
        let shown = flow.names.len() - flow.motion.states();
        for (i, name) in flow.names.iter().enumerate() {
            let is_velocity = (n..shown).contains(&i);
            candidates
                .push((name.clone(), if is_velocity { second.velocity(name) } else { Some(Quantity::Zero) }));
        }
        candidates.extend(
            flow.motion.observable_names().iter().map(|name| (name.clone(), second.observable(name))),
        );
        // What is given to it: coordinates, first-order states, and the quasi-velocities where these are its state.
        let (dim, columns) = (state.len(), 2 * state.len());
        let inputs = [
            0..if canonical { n } else { dim },
            moving.end..dim,
            columns..columns + n,
            columns + shown..columns + flow.names.len(),
        ];
        let compiled = Compiled::Flow { flow: Box::new(flow), quasi_velocities };
        First::comparing(form, candidates, &inputs, second, free, compiled, agreement)
    }

    /// What is written as source.
    fn emitted(
        assembly: &Assembly<'g>,
        second: &Second,
        agreement: &mut Agreement,
    ) -> Result<First<'g>, String> {
        let equations = assembly.equations().map_err(|error| error.diagnostic().message.clone())?;
        let system = equations.system();
        let motion = equations.compile_for(Backend::Interpreter).map_err(|error| error.to_string())?;
        let column = |eta: &Expr<'_>| {
            let name = eta.to_string();
            second.free(&name).ok_or_else(|| format!("`{name}` is not a column"))
        };
        let free: Vec<Free> = system.quasi_velocities().iter().map(column).collect::<Result<_, _>>()?;
        let rates = motion.names().iter().map(|name| (format!("the rate of {name}"), second.rate(name)));
        let observables = motion.observable_names().iter().map(|name| match second.observable(name) {
            Some(Quantity::Energy) => (name.clone(), Some(Quantity::FreeEnergy)),
            other => (name.clone(), other),
        });
        let mut candidates: Vec<(String, Option<Quantity>)> = rates.chain(observables).collect();
        if second.derivation.text.tables.is_empty() {
            candidates.push(("the rate of energy".to_owned(), Some(Quantity::FreeEnergyRate)));
        } else {
            agreement.leave_out("the rate of energy", "that of an input is not known");
        }
        let system = assembly.constraints.free_system(&assembly.system, &assembly.at_start());
        let system = system.map_err(|error| error.to_string())?;
        if !system.quasi_velocities().iter().map(column).eq(free.iter().map(|&f| Ok(f))) {
            return Err("its quasi-velocities are not those of the free system".to_owned());
        }
        let frame = system.frame();
        let energy_rate = EnergyRate {
            graph: system.graph(),
            rate: system.energy_rate(),
            inputs: std::iter::once(frame.time()).chain(system.state()).collect(),
            parameters: system.parameters().to_vec(),
        };
        let tables = second.derivation.text.tables.clone();
        let compiled =
            Compiled::Emitted { motion: Box::new(motion), free: free.clone(), energy_rate, tables };
        Ok(First::comparing("emit", candidates, &[], second, Some(free), compiled, agreement))
    }

    /// Compares those candidates that the second derivation has, but for what is given to the first.
    fn comparing(
        form: &str,
        candidates: Vec<(String, Option<Quantity>)>,
        inputs: &[std::ops::Range<usize>],
        second: &Second,
        free: Option<Vec<Free>>,
        compiled: Compiled<'g>,
        agreement: &mut Agreement,
    ) -> First<'g> {
        let (mut wanted, mut places) = (Vec::new(), Vec::new());
        for (place, (label, quantity)) in candidates.into_iter().enumerate() {
            match quantity {
                _ if inputs.iter().any(|inputs| inputs.contains(&place)) => {}
                Some(quantity) => {
                    wanted.push((label, quantity));
                    places.push(place);
                }
                None if second.is_body_reaction(&label) => {
                    agreement.leave_out("reactions as forces and torques on bodies", "it does not have them");
                }
                None => agreement.leave_out(&label, "it does not have it"),
            }
        }
        First { form: form.to_owned(), wanted, places, free, compiled }
    }

    fn quantities(&self) -> Vec<Quantity> {
        self.wanted.iter().map(|(_, quantity)| quantity.clone()).collect()
    }

    /// What is compared at a place with these columns.
    fn values(&mut self, at: &Place, columns: &[f64]) -> Result<Vec<f64>, Irregular> {
        let form = &self.form;
        let refused = |message: String| Irregular::Refused { form: form.clone(), message };
        let values = match &mut self.compiled {
            Compiled::Flow { flow, quasi_velocities } => {
                let value = |quantity: &Quantity| match quantity {
                    Quantity::Column(s) => columns[*s],
                    _ => 0.0,
                };
                let mut all = at.x.clone();
                all.extend(quasi_velocities.iter().map(value));
                all.extend(&at.z);
                let state = flow.state_of(at.t, &all).map_err(|error| refused(error.to_string()))?;
                let mut rates = vec![f64::NAN; state.len()];
                let evaluated = flow.motion.rhs(at.t, &state, &mut rates);
                evaluated.map_err(|failure| refused(failure.to_string()))?;
                let row = flow.row(at.t, &state);
                [state, rates, row].concat()
            }
            Compiled::Emitted { motion, free, energy_rate, tables } => {
                for (place, table) in tables {
                    motion.parameters_mut()[*place] = table.at(at.t).unwrap_or(f64::NAN);
                }
                let mut state = at.x.clone();
                state.extend(free.iter().map(|&f| match f {
                    Free::Column(column) => columns[column],
                    Free::Constraint(_) => 0.0,
                }));
                state.extend(&at.z);
                let mut rates = vec![f64::NAN; state.len()];
                let evaluated = motion.rhs(at.t, &state, &mut rates);
                evaluated.map_err(|failure| refused(failure.to_string()))?;
                let observed = motion.observe(at.t, &state);
                let rate = energy_rate.at(at.t, &state);
                [rates, observed, vec![rate]].concat()
            }
        };
        Ok(self.places.iter().map(|&place| values[place]).collect())
    }
}
