//! The comparison of the two derivations.

use std::fmt;

use pc_mech::{Folding, Graph};
use pc_model::{Assembly, Flow, Model, Variables};
use pc_print::Form;

use crate::derivation::{Completing, Derivation, Derived, Place};
use crate::error::{Disagreement, Irregular, VerifyError};
use crate::first::First;
use crate::linear::pseudo_inverse;
use crate::printed::{FORMS, printed_name};
use crate::projected::{DIRECTIONS, Layout};
use crate::quantities::{Free, Quantity, Sized};
use crate::resultants::Resultant;
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
pub(crate) const ORDINARY: f64 = 1e-14;

/// Velocities that differ by more of the largest are others; momenta that differ by less are the same.
const OTHER: f64 = 1e-9;

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
    /// The number of these at which equations were only compared along random virtual velocities, the model being large.
    pub projected: usize,
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
    /// `agrees to 3e-15 at 97 states, 3 not comparable: the equations for the accelerations are singular`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let plural = if self.states == 1 { "" } else { "s" };
        if self.error == 0.0 {
            write!(f, "agrees to the last digit at {} state{plural}", self.states)?;
        } else {
            write!(f, "agrees to {:.0e} at {} state{plural}", self.error, self.states)?;
        }
        match self.projected {
            0 => {}
            all if all == self.states => write!(f, " along {DIRECTIONS} random virtual velocities")?,
            some => write!(f, ", at {some} of them along {DIRECTIONS} random virtual velocities")?,
        }
        match (self.skipped, &self.reason) {
            (0, _) => Ok(()),
            (skipped, reason) => {
                write!(f, ", {skipped} not comparable: {}", reason.as_deref().unwrap_or("not regular"))
            }
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
    let mut large = Projection { flow: flow.clone(), layout: Layout::of(&flow, &second.columns) };
    let wholly = second.wholly(options.states);
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
    let page = Graph::with_folding(Folding::Structural);
    let printable = FORMS.into_iter().filter(|&form| match second.too_large_for(form, &plain) {
        Some(reason) => {
            agreement.leave_out(&printed_name(form), reason);
            false
        }
        None => true,
    });
    for form in printable.collect::<Vec<_>>() {
        firsts.extend(First::printed(form, &plain, &second, &page, &mut agreement));
    }
    let mut number = 0;
    while agreement.states < options.states && number < TRIES * options.states {
        let seed = (options.seed << 32) as usize + number;
        number += 1;
        let compared = second.derivation.random(&second.start, seed).map_err(Passed::from);
        let outcome = compared.and_then(|place| match agreement.states < wholly {
            true => second.compare(&mut firsts, &place, &mut agreement),
            false => second.compare_projected("poincare", &mut large, &place, &mut agreement),
        });
        match outcome {
            Ok(()) => agreement.states += 1,
            Err(passed) => agreement.pass_over(passed)?,
        }
    }
    agreement.finished(&firsts, number)
}

/// Terms that are evaluated in some milliseconds.
const LONG: usize = 100_000;

/// Terms that are evaluated for all states together, in a second or so.
const ALL_STATES: usize = 5_000_000;

/// Velocities up to which the canonical equations are derived to be compared: by then their inverse of a full mass matrix takes
/// a second, and ten times that with each two more.
const MOST_INVERTED: usize = 9;

/// A large model in quasi-velocities.
struct Projection {
    flow: Flow,
    layout: Layout,
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
    /// A difference, relative to the size of its terms.
    fn note(&mut self, error: f64, label: &str) {
        if error > self.error || self.quantity.is_empty() {
            (self.error, self.quantity) = (error, label.to_owned());
        }
    }

    pub(crate) fn leave_out(&mut self, what: &str, reason: &str) {
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

    fn finished(mut self, firsts: &[First<'_>], tried: usize) -> Result<Agreement, VerifyError> {
        if self.states == 0 {
            let reason = self.reason.unwrap_or_else(|| "none was tried".to_owned());
            return Err(VerifyError::NothingCompared { tried, reason });
        }
        let wholly = self.states - self.projected;
        let missing = |first: &First<'_>| wholly - first.compared;
        let partly: Vec<&First<'_>> = firsts.iter().filter(|first| missing(first) > 0).collect();
        let lines: Vec<String> = partly
            .iter()
            .map(|first| format!("{} at {} of {} states", first.form, missing(first), wholly))
            .collect();
        for (line, first) in lines.iter().zip(partly) {
            self.leave_out(line, first.reason.as_deref().unwrap_or("not tried"));
        }
        let compared = firsts.iter().filter(|first| first.compared > 0);
        self.forms.extend(compared.map(|first| first.form.clone()));
        Ok(self)
    }
}

/// The second derivation of a model.
#[derive(Clone, Debug)]
pub struct Second {
    pub(crate) derivation: Derivation,
    /// What the columns of a table are called.
    columns: Vec<String>,
    pub(crate) start: Place,
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
        if self.cost() > LONG && !flow.has_momenta() {
            return self.agrees_projected(form, flow, t, state, agreement);
        }
        let mut row = flow.row(t, state);
        row.truncate(flow.names.len());
        let mut firsts = [First::flow(form, flow, self, assembly, &mut agreement)];
        let compared = self.place(t, &row).map_err(Passed::from);
        match compared.and_then(|place| self.compare(&mut firsts, &place, &mut agreement)) {
            Ok(()) => agreement.states += 1,
            Err(passed) => agreement.pass_over(passed)?,
        }
        agreement.finished(&firsts, 1)
    }

    /// The place of coordinates, columns and first-order states.
    fn place(&self, t: f64, row: &[f64]) -> Result<Place, Irregular> {
        let (x, eta) = row.split_at(self.start.x.len());
        let (eta, z) = eta.split_at(eta.len() - self.start.z.len());
        let w = self.derivation.velocities_of(t, x, eta)?;
        Ok(Place { t, x: x.to_vec(), w, z: z.to_vec() })
    }

    /// The same as [`agrees`](Second::agrees) along random virtual velocities.
    fn agrees_projected(
        &self,
        form: &str,
        mut flow: Flow,
        t: f64,
        state: &[f64],
        mut agreement: Agreement,
    ) -> Result<Agreement, VerifyError> {
        let mut row = flow.row(t, state);
        row.truncate(flow.names.len());
        let layout = Layout::of(&flow, &self.columns);
        let mut large = Projection { flow, layout };
        let place = self.place(t, &row).map_err(Passed::from);
        match place.and_then(|place| self.compare_projected(form, &mut large, &place, &mut agreement)) {
            Ok(()) => agreement.states += 1,
            Err(passed) => agreement.pass_over(passed)?,
        }
        agreement.leave_out("multipliers, integrals and outputs", "the model is large");
        agreement.forms.push(form.to_owned());
        agreement.finished(&[], 1)
    }

    /// Compares the equations with the second derivation at a place along random virtual velocities.
    fn compare_projected(
        &self,
        form: &str,
        large: &mut Projection,
        at: &Place,
        agreement: &mut Agreement,
    ) -> Result<(), Passed> {
        let columns = |at: &Place| self.derivation.columns(&self.derivation.still(at, &Rounding::none()));
        let residuals = self.derivation.projected(&mut large.flow, &large.layout, at, &columns)?;
        for (label, residual) in residuals {
            let error = error(residual.value, Sized { value: 0.0, ..residual });
            if !within(error, TOLERANCE) {
                return Err(Passed::Error(VerifyError::Disagreement(Box::new(Disagreement {
                    form: form.to_owned(),
                    quantity: format!("what should vanish of {label}"),
                    first: residual.value,
                    second: 0.0,
                    size: residual.size,
                    t: at.t,
                    state: self.named(at, &columns(at)?),
                }))));
            }
            agreement.note(error, &label);
        }
        agreement.projected += 1;
        Ok(())
    }

    /// Whether one comparison is as much as there is time for: a tenth of the derivation or so.
    pub fn is_long(&self, flow: &Flow) -> bool {
        self.cost() > LONG && flow.has_momenta()
    }

    /// Why a printed form is not derived only to be compared.
    fn too_large_for(&self, form: Form, assembly: &Assembly<'_>) -> Option<&'static str> {
        if form == Form::Voronets && assembly.constraints.multipliers().is_none() {
            return None; // the same as Lagrange's, and not derived
        }
        if form == Form::Canonical && assembly.system.quasi_velocities().len() > MOST_INVERTED {
            return Some("the mass matrix would be inverted in symbols");
        }
        (form != Form::Poincare && self.cost() > LONG).then_some("the model is large")
    }

    /// At how many of so many states all equations are compared.
    fn wholly(&self, states: usize) -> usize {
        let affordable = ALL_STATES / self.cost().max(1);
        states.min(affordable.max(1))
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

    /// The quasi-velocity of this name: a column, what a constraint fixes at 0, or a velocity.
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
            return Some(Quantity::Energy);
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

    /// How many terms of the text are evaluated for the equations at one state, roughly.
    pub fn cost(&self) -> usize {
        let k = self.start.w.len();
        (k * (k + 1) / 2 + 4 * k + 4).saturating_mul(self.derivation.text.terms())
    }

    /// Compares all forms with the second derivation at a place: at least one of them.
    fn compare(&self, firsts: &mut [First<'_>], at: &Place, agreement: &mut Agreement) -> Result<(), Passed> {
        let here = Here::new(&self.derivation, self.derivation.at(at, &Rounding::none())?)?;
        let mut scattered = None;
        let (mut compared, mut irregular) = (0, None);
        for first in firsts {
            match self.compare_form(first, &here, &mut scattered, agreement) {
                Ok(()) => compared += 1,
                Err(Passed::Irregular(reason)) => {
                    first.reason = Some(reason.to_string());
                    irregular = Some(reason);
                }
                Err(error) => return Err(error),
            }
        }
        match irregular {
            Some(reason) if compared == 0 => Err(Passed::Irregular(reason)),
            _ => Ok(()),
        }
    }

    fn compare_form(
        &self,
        first: &mut First<'_>,
        here: &Here,
        scattered: &mut Option<Vec<(Rounding, Here)>>,
        agreement: &mut Agreement,
    ) -> Result<(), Passed> {
        let (wanted, exact) = (first.quantities(), Rounding::none());
        let free = first.free.clone();
        let mut seconds = self.derivation.quantities(&here.derived, &wanted, free.as_deref(), &exact)?;
        let values = first.values(&self.derivation, here)?;
        if !values.iter().zip(&seconds).all(|(&one, &two)| error(one, two) <= ORDINARY) {
            if scattered.is_none() {
                *scattered = Some(self.scattered(&here.derived)?);
            }
            let scattered = scattered.as_deref().unwrap_or_default();
            self.derivation.scatter(&mut seconds, scattered, &wanted, free.as_deref())?;
            if !values.iter().zip(&seconds).all(|(&one, &two)| within(error(one, two), TOLERANCE)) {
                self.scatter_first(first, scattered, &values, &mut seconds);
                if self.has_other_velocities(first, &here.derived, &values, &seconds)? {
                    let why = "at some states the momenta are those of other velocities, too";
                    agreement.leave_out(&first.form, why);
                    return Ok(());
                }
            }
        }
        let pairs = || first.wanted.iter().zip(values.iter().zip(&seconds));
        for ((label, _), (&one, &two)) in pairs() {
            if !within(error(one, two), TOLERANCE) {
                return Err(Passed::Error(VerifyError::Disagreement(Box::new(Disagreement {
                    form: first.form.clone(),
                    quantity: label.clone(),
                    first: one,
                    second: two.value,
                    size: two.size,
                    t: here.derived.place.t,
                    state: self.named(&here.derived.place, &here.columns),
                }))));
            }
        }
        for ((label, _), (&one, &two)) in pairs() {
            agreement.note(error(one, two), label);
        }
        first.compared += 1;
        Ok(())
    }

    fn scattered(&self, derived: &Derived) -> Result<Vec<(Rounding, Here)>, Irregular> {
        let all = self.derivation.scattered(derived)?.into_iter();
        all.map(|(rounding, derived)| Ok((rounding, Here::new(&self.derivation, derived)?))).collect()
    }

    /// Raises sizes to how far the values of the first derivation scatter, in units of rounding, at states that differ by
    /// rounding: its eliminations amplify it, too, where independent velocities determine the others badly.
    fn scatter_first(
        &self,
        first: &mut First<'_>,
        scattered: &[(Rounding, Here)],
        values: &[f64],
        seconds: &mut [Sized],
    ) {
        for (_, near) in scattered {
            // Where it has no values there it says nothing of rounding.
            let Ok(moved) = first.values(&self.derivation, near) else { continue };
            for ((second, value), moved) in seconds.iter_mut().zip(values).zip(moved) {
                let scatter = (moved - value).abs() / UNIT;
                if scatter.is_finite() {
                    second.size = second.size.max(scatter);
                }
            }
        }
    }

    /// Whether a form in momenta reads other velocities from those of a place, which satisfy the constraints, too, and have the
    /// same momenta: where L is not convex in η, these do not determine η.
    fn has_other_velocities(
        &self,
        first: &First<'_>,
        derived: &Derived,
        values: &[f64],
        seconds: &[Sized],
    ) -> Result<bool, Passed> {
        let (Some(free), wanted) = (&first.free, first.quantities()) else { return Ok(false) };
        let exact = Rounding::none();
        let at = &derived.place;
        let column = |s: usize| wanted.iter().position(|wanted| *wanted == Quantity::Column(s));
        let eta: Option<Vec<f64>> = (0..self.columns.len()).map(|s| Some(values[column(s)?])).collect();
        let Some(eta) = eta else { return Ok(false) };
        let Ok(w) = self.derivation.velocities_of(at.t, &at.x, &eta) else { return Ok(false) };
        let other = Place { w, ..at.clone() };
        let fastest = other.w.iter().chain(&at.w).fold(0.0f64, |fastest, w| fastest.max(w.abs()));
        let moved = other.w.iter().zip(&at.w).any(|(a, b)| (a - b).abs() > OTHER * fastest);
        let violated = self.derivation.constraints(&self.derivation.kept, &other, &exact)?;
        if !moved || violated.iter().any(|phi| !within(phi.abs(), OTHER * fastest.max(1.0))) {
            return Ok(false);
        }
        let Ok(there) = self.derivation.at(&other, &exact) else { return Ok(false) };
        let there = self.derivation.quantities(&there, &wanted, Some(free), &exact)?;
        let mut momenta = wanted.iter().zip(seconds.iter().zip(&there));
        Ok(momenta.all(|(wanted, (here, there))| {
            let is_momentum = matches!(wanted, Quantity::Momentum(_));
            !is_momentum || within((here.value - there.value).abs(), OTHER * here.size)
        }))
    }

    fn named(&self, at: &Place, columns: &[f64]) -> Vec<(String, f64)> {
        let coordinates = self.derivation.text.names.coordinates.iter().zip(&at.x);
        let states = self.derivation.text.names.states.iter().zip(&at.z);
        let all = coordinates.chain(self.columns.iter().zip(columns)).chain(states);
        all.map(|(name, &value)| (name.clone(), value)).collect()
    }
}

/// The second derivation at a place.
#[derive(Clone, Debug)]
pub(crate) struct Here {
    pub(crate) derived: Derived,
    /// The columns there.
    pub(crate) columns: Vec<f64>,
}

impl Here {
    fn new(derivation: &Derivation, derived: Derived) -> Result<Here, Irregular> {
        let exact = Rounding::none();
        let columns = derivation.columns(&derivation.still(&derived.place, &exact))?;
        Ok(Here { derived, columns })
    }

    /// The value of a quasi-velocity.
    pub(crate) fn velocity(&self, velocity: Free) -> f64 {
        match velocity {
            Free::Column(s) => self.columns[s],
            Free::Velocity(i) => self.derived.velocities[i],
            Free::Constraint(_) => 0.0,
        }
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
