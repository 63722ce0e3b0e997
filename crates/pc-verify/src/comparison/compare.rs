//! The comparison of the two derivations.

use pc_mech::{Folding, Graph};
use pc_model::{Assembly, Flow, Model, Variables};
use pc_print::Form;

use crate::comparison::agreement::{Agreement, Passed};
use crate::comparison::first::First;
use crate::comparison::printed::{is_reduced, printed_name};
use crate::comparison::projected::Layout;
use crate::comparison::second::{LONG, Second};
use crate::comparison::tolerance::{ORDINARY, TOLERANCE};
use crate::derivation::equations::Derived;
use crate::derivation::here::Here;
use crate::derivation::place::Place;
use crate::derivation::quantity::Quantity;
use crate::error::{Disagreement, Irregular, VerifyError};
use crate::numbers::rounding::{Rounding, UNIT, within};
use crate::numbers::sized::Sized;

/// Velocities whose difference, relative to the largest, exceeds this value are distinct; momenta whose
/// difference does not exceed it are equal.
const OTHER: f64 = 1e-9;

/// The greatest factor by which rounding errors of the first derivation may exceed those of the second: forms
/// that are not chosen for accuracy lose up to half of the digits. Values that scatter more widely are not
/// compared.
const WORSE: f64 = 1e4;

/// The number of operations of the integrated equations beyond which they are long: each further form takes as long as the
/// equations themselves.
pub const LONG_EQUATIONS: usize = 500;

/// The extent of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// The number of states at which the derivations are compared.
    pub states: usize,
    /// The seed of the random states.
    pub seed: u64,
    /// The number of operations of the integrated equations up to which they are compared in every form. Longer ones are compared
    /// as they are integrated in quasi-velocities, and each other form where it is printed, emitted or integrated.
    pub every_form_up_to: usize,
}

impl Default for Options {
    /// 100 states, and every form.
    fn default() -> Options {
        Options { states: 100, seed: 0, every_form_up_to: usize::MAX }
    }
}

/// Derives an assembled model a second time and compares, at random states that satisfy the constraints, ẋ, η̇ or ẏ, λ,
/// the energy and its rate, integrals and outputs. The comparison covers the equations that are integrated, in
/// quasi-velocities and in momenta, and those that are emitted as source.
///
/// # Errors
/// [`VerifyError::Disagreement`] with the quantity, its two values and the state; [`VerifyError::Model`] if the first
/// derivation refuses the model; [`VerifyError::Unable`] if the second cannot be carried out;
/// [`VerifyError::NothingCompared`] if no state is regular.
pub fn verify(model: &Model, assembly: &Assembly<'_>, options: &Options) -> Result<Agreement, VerifyError> {
    assembly.stage("the second derivation", || {
        if model.document().constraints.is_empty() || only_integrated(model, assembly, options) {
            return compared((model, assembly), assembly, options);
        }
        // Reactions are compared as outputs of what is integrated, and are not among the outputs of what is printed.
        let mut other = model.clone();
        other.observe_reactions(!model.observes_reactions());
        other.derived(|beside| match model.observes_reactions() {
            true => compared((model, assembly), beside, options),
            false => compared((&other, beside), assembly, options),
        })
    })
}

/// Whether nothing is compared but equations that are integrated, with reactions among their outputs.
fn only_integrated(model: &Model, assembly: &Assembly<'_>, options: &Options) -> bool {
    let is_long = |flow: Flow| flow.motion.cost().total() > options.every_form_up_to;
    let flow = || Flow::with_stand_ins(model, assembly, Variables::QuasiVelocities);
    model.observes_reactions() && options.every_form_up_to < usize::MAX && flow().is_ok_and(is_long)
}

/// Compares the equations that are integrated, which have reactions among their outputs, and those that are printed, which do
/// not.
fn compared(
    (observed, assembly): (&Model, &Assembly<'_>),
    plain: &Assembly<'_>,
    options: &Options,
) -> Result<Agreement, VerifyError> {
    let second = Second::new(observed, assembly)?;
    let mut agreement = second.nothing_yet();
    let flow = Flow::with_stand_ins(observed, assembly, Variables::QuasiVelocities)?;
    let mut large = Projection::new(flow.clone(), &second);
    let (wholly, states) = (second.wholly(options.states), second.affordable(options.states));
    let page = plain.system.graph().page(Folding::Structural);
    let mut firsts = match wholly {
        0 => {
            agreement.leave_out("other forms, multipliers, integrals and outputs", "the model is large");
            agreement.forms.push("poincare".to_owned());
            Vec::new()
        }
        _ => {
            let is_long = flow.motion.cost().total() > options.every_form_up_to;
            let mut firsts = vec![First::flow("poincare", flow, &second, assembly, &mut agreement)];
            match is_long {
                true => agreement.leave_out("other forms", "long, each is compared where it is used"),
                false => firsts.extend(others(observed, assembly, (plain, &page), &second, &mut agreement)),
            }
            firsts
        }
    };
    let mut number = 0;
    // A form that is noise where it was evaluated is evaluated elsewhere before it is judged.
    let is_undecided =
        |firsts: &[First<'_>]| firsts.iter().any(|first| first.compared == 0 && first.noise.is_some());
    while (agreement.states < states || is_undecided(&firsts)) && number < TRIES * states.max(FEW) {
        assembly.within_limits()?;
        let seed = (options.seed << 32) as usize + number;
        number += 1;
        let compared = second.derivation.random(&second.start, seed).map_err(Passed::from);
        let outcome = compared.and_then(|place| match agreement.states < wholly || is_undecided(&firsts) {
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

/// All forms except the one in quasi-velocities that is integrated.
fn others<'g>(
    observed: &Model,
    assembly: &Assembly<'_>,
    (plain, page): (&Assembly<'_>, &'g Graph),
    second: &Second,
    agreement: &mut Agreement,
) -> Vec<First<'g>> {
    let mut firsts = Vec::new();
    match Flow::with_stand_ins(observed, assembly, Variables::Momenta) {
        Ok(flow) => firsts.push(First::flow("canonical", flow, second, assembly, agreement)),
        Err(error) => agreement.leave_out("canonical", &error.diagnostic().message),
    }
    let changed = [Variables::Reduced, Variables::ReducedMomenta, Variables::Orthonormal, Variables::Given];
    for variables in changed {
        if assembly.constraints.held().is_some()
            || second.too_large_for(variables.into(), plain).is_some()
            || !has_form(variables, assembly)
        {
            continue;
        }
        match Flow::with_stand_ins(observed, assembly, variables) {
            Ok(flow) => firsts.push(First::flow(variables.name(), flow, second, assembly, agreement)),
            Err(error) => agreement.leave_out(variables.name(), &error.diagnostic().message),
        }
    }
    match First::emitted(plain, second, page, agreement) {
        Ok(first) => firsts.push(first),
        Err(reason) => agreement.leave_out("emit", &reason),
    }
    for form in Form::ALL {
        match second.too_large_for(form, plain) {
            // Forms that are not integrated by default are compared if that takes little time.
            Some(reason)
                if form.variables().is_none_or(Variables::are_own)
                    || matches!(form, Form::Hamel | Form::Voronets) =>
            {
                agreement.leave_out(&printed_name(form), reason);
            }
            Some(_) => {}
            None => firsts.extend(First::printed((form, false), plain, second, page, agreement)),
        }
    }
    firsts
}

/// Whether equations in these variables differ from those already compared.
fn has_form(variables: Variables, assembly: &Assembly<'_>) -> bool {
    match variables {
        Variables::Reduced | Variables::ReducedMomenta => is_reduced(assembly) && assembly.events.is_empty(),
        Variables::Given => !assembly.given.is_empty(),
        Variables::Orthonormal => assembly.free_form(variables).is_ok(),
        Variables::QuasiVelocities | Variables::Momenta => true,
        Variables::IndependentVelocities => assembly.constraints.multipliers().is_some(),
    }
}

/// The equations of a large model in quasi-velocities, to be compared along virtual velocities.
pub(crate) struct Projection {
    flow: Flow,
    layout: Layout,
}

impl Projection {
    pub(crate) fn new(flow: Flow, second: &Second) -> Projection {
        let layout = Layout::of(&flow, second);
        Projection { flow, layout }
    }
}

/// The equations of the first derivation that are to be compared.
pub(crate) enum Compared<'g> {
    /// All equations, in these forms.
    Wholly(Vec<First<'g>>),
    /// The equations of a large model along random virtual velocities.
    Along(Box<Projection>),
}

/// The number of states tried for each comparison required.
const TRIES: usize = 3;

/// A comparison at fewer states tries as many as one at this number before it gives up.
const FEW: usize = 8;

impl Agreement {
    fn finished(mut self, firsts: &[First<'_>], tried: usize) -> Result<Agreement, VerifyError> {
        // A form that is noise wherever it was evaluated is undecided, even if its values are near the right
        // ones.
        let noise = firsts.iter().filter(|first| first.compared == 0).find_map(|first| first.noise.as_ref());
        if let Some(noise) = noise {
            return Err(VerifyError::Disagreement(noise.clone()));
        }
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

impl Second {
    /// Compares the integrated equations, referred to as `form`, with the second derivation at one of their
    /// states.
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
        assembly.stage("the second derivation", || self.agrees_there(form, flow.clone(), assembly, t, state))
    }

    fn agrees_there(
        &self,
        form: &str,
        mut flow: Flow,
        assembly: &Assembly<'_>,
        t: f64,
        state: &[f64],
    ) -> Result<Agreement, VerifyError> {
        let mut agreement = self.nothing_yet();
        if self.cost() > LONG && !self.is_long(&flow) {
            return self.agrees_projected(form, flow, t, state, agreement);
        }
        let row = self.row(&mut flow, t, state);
        let mut firsts = [First::flow(form, flow, self, assembly, &mut agreement)];
        let compared = self.place(t, &row).and_then(|place| self.slipping(place)).map_err(Passed::from);
        match compared.and_then(|place| self.compare(&mut firsts, &place, &mut agreement)) {
            Ok(()) => agreement.states += 1,
            Err(passed) => agreement.pass_over(passed)?,
        }
        agreement.finished(&firsts, 1)
    }

    /// As [`agrees`](Second::agrees), along random virtual velocities.
    fn agrees_projected(
        &self,
        form: &str,
        mut flow: Flow,
        t: f64,
        state: &[f64],
        mut agreement: Agreement,
    ) -> Result<Agreement, VerifyError> {
        let row = self.row(&mut flow, t, state);
        let mut large = Projection::new(flow, self);
        let place = self.place(t, &row).and_then(|place| self.slipping(place)).map_err(Passed::from);
        match place.and_then(|place| self.compare_projected(form, &mut large, &place, &mut agreement)) {
            Ok(()) => agreement.states += 1,
            Err(passed) => agreement.pass_over(passed)?,
        }
        agreement.leave_out("multipliers, integrals and outputs", "the model is large");
        agreement.forms.push(form.to_owned());
        agreement.finished(&[], 1)
    }

    /// Compares at the start and at random states near it, trying up to three times as many as required,
    /// since some may not be regular.
    pub(crate) fn compare_near_start(
        &self,
        mut compared: Compared<'_>,
        near: usize,
        assembly: &Assembly<'_>,
        mut agreement: Agreement,
    ) -> Result<Agreement, VerifyError> {
        let tries = 1 + TRIES * near;
        for number in 0..tries {
            if agreement.states > near {
                break;
            }
            assembly.within_limits()?;
            let place = match number {
                0 => self.slipping(self.start.clone()),
                _ => self.derivation.random(&self.start, number - 1),
            };
            let outcome = place.map_err(Passed::from).and_then(|place| match &mut compared {
                Compared::Wholly(firsts) => self.compare(firsts, &place, &mut agreement),
                Compared::Along(large) => self.compare_projected("poincare", large, &place, &mut agreement),
            });
            match outcome {
                Ok(()) => agreement.states += 1,
                Err(passed) => agreement.pass_over(passed)?,
            }
        }
        match compared {
            Compared::Wholly(firsts) => agreement.finished(&firsts, tries),
            Compared::Along(_) => {
                agreement.leave_out("multipliers, integrals and outputs", "the model is large");
                agreement.forms.push("poincare".to_owned());
                agreement.finished(&[], tries)
            }
        }
    }

    /// Compares the equations with the second derivation at one state, along random virtual velocities.
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
                    quantity: format!("the residual of {label}"),
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

    /// Compares all forms with the second derivation at one state; at least one of them has to be comparable.
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
                Err(Passed::Noise(disagreement)) => {
                    first.reason = Some(Irregular::IllConditioned.to_string());
                    first.noise = Some(disagreement);
                    irregular = Some(Irregular::IllConditioned);
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
        // Where all terms of one quantity vanish, numbers that are on their way to underflow remain of others.
        let least = NOTHING
            * seconds
                .iter()
                .map(|quantity| quantity.size)
                .filter(|size| size.is_finite())
                .fold(0.0, f64::max);
        seconds.iter_mut().for_each(|quantity| quantity.size = quantity.size.max(least));
        let values = first.values(&self.derivation, here, &exact)?;
        let mut noise = vec![0.0; values.len()];
        if !values.iter().zip(&seconds).all(|(&one, &two)| error(one, two) <= ORDINARY) {
            if scattered.is_none() {
                *scattered = Some(self.scattered(&here.derived)?);
            }
            let scattered = scattered.as_deref().unwrap_or_default();
            self.derivation.scatter(&mut seconds, scattered, &wanted, free.as_deref())?;
            if !values.iter().zip(&seconds).all(|(&one, &two)| within(error(one, two), TOLERANCE)) {
                noise = self.scatter_first(first, scattered, &values, &mut seconds);
                self.derivation.lead_reactions(&mut seconds, &wanted, &here.derived)?;
                if self.has_other_velocities(first, &here.derived, &values, &seconds)? {
                    let why = "at some states the momenta are those of other velocities, too";
                    agreement.leave_out(&first.form, why);
                    return Ok(());
                }
            }
        }
        if !values.iter().zip(&seconds).all(|(&one, &two)| within(error(one, two), TOLERANCE)) {
            let aside = self.derivation.aside(first, here, &values, &seconds);
            if let Some(errors) = aside.errors {
                first.wanted.iter().zip(errors).for_each(|((label, _), error)| agreement.note(error, label));
                first.compared += 1;
                return Ok(());
            }
            noise.iter_mut().zip(aside.noise).for_each(|(noise, size)| *noise = noise.max(size));
        }
        let pairs = || first.wanted.iter().zip(values.iter().zip(&seconds));
        for (((label, _), (&one, &two)), noise) in pairs().zip(noise) {
            if !within(error(one, two), TOLERANCE) {
                let disagreement = Box::new(Disagreement {
                    form: first.form.clone(),
                    quantity: label.clone(),
                    first: one,
                    second: two.value,
                    size: two.size,
                    t: here.derived.place.t,
                    state: self.named(&here.derived.place, &here.columns),
                });
                let is_noise = within(error(one, Sized { size: noise, ..two }), TOLERANCE);
                return Err(match is_noise {
                    true => Passed::Noise(disagreement),
                    false => Passed::Error(VerifyError::Disagreement(disagreement)),
                });
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

    /// Raises sizes to the scatter of the values of the first derivation, in units of the rounding error, at
    /// states that differ by rounding errors: its eliminations also amplify rounding errors where the
    /// independent velocities determine the others poorly. The increase is bounded, since a value that is
    /// mere noise scatters by its own size and would agree with any value. Returns the unbounded sizes.
    fn scatter_first(
        &self,
        first: &mut First<'_>,
        scattered: &[(Rounding, Here)],
        values: &[f64],
        seconds: &mut [Sized],
    ) -> Vec<f64> {
        let mut noise = vec![0.0f64; values.len()];
        let most: Vec<f64> = seconds.iter().map(|second| WORSE * second.size).collect();
        for (rounding, near) in scattered {
            // A state without values gives no information on rounding.
            let Ok(moved) = first.values(&self.derivation, near, rounding) else { continue };
            for (i, moved) in moved.into_iter().enumerate() {
                let scatter = (moved - values[i]).abs() / UNIT;
                if scatter.is_finite() {
                    noise[i] = noise[i].max(scatter);
                    seconds[i].size = seconds[i].size.max(scatter.min(most[i]));
                }
            }
        }
        noise
    }

    /// Whether a form in momenta finds velocities that differ from those of a state, but have the same
    /// momenta and satisfy the same constraints: if L is not convex in η, momenta do not determine η.
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
}

/// What is smaller than the largest terms of all quantities by this factor is nothing beside them.
const NOTHING: f64 = 1e-20;

/// The difference of two values relative to the size of their terms; zero if the difference is subnormal.
pub(crate) fn error(one: f64, two: Sized) -> f64 {
    let difference = (one - two.value).abs();
    if difference <= f64::MIN_POSITIVE { 0.0 } else { difference / two.size }
}
