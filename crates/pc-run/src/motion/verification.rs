//! Comparisons with a second derivation.

use pc_mech::Equations;
use pc_model::{Assembly, Flow, Model, Variables};
use pc_report::Check;
use pc_solve::Occurrence;
use pc_verify::{
    Agreement, Jump, LONG_EQUATIONS, Options, Outlet, Second, Slope, VerifyError, verify, vouch,
};

use crate::error::RunError;
use crate::linear::compared::steady_agrees;
use crate::observer::Observer;

/// Finds the properties of a model and compares them with a second derivation: the equations in all forms, and the linear theory
/// of the steady motion near the start.
///
/// # Errors
/// [`RunError::Verify`] if the second derivation disagrees; [`RunError::Model`] if something about the model
/// cannot be derived.
pub fn checked<'g>(
    model: &Model,
    assembly: &Assembly<'g>,
    equations: &Equations<'g>,
) -> Result<Check<'g>, RunError> {
    let check = Check::new(model, assembly, equations)?;
    let mut second =
        match verify(model, assembly, &Options { every_form_up_to: LONG_EQUATIONS, ..Options::default() }) {
            Err(error @ VerifyError::Disagreement(_)) => return Err(RunError::Verify(Box::new(error))),
            outcome => outcome,
        };
    assembly.within_limits()?;
    if let (Ok(agreement), Some(steady)) = (&mut second, check.steady_motion()) {
        match steady_agrees(model, assembly, steady) {
            Ok(()) => {}
            Err(error @ VerifyError::Disagreement(_)) => return Err(RunError::Verify(Box::new(error))),
            Err(error) => agreement.not_compared.push(format!("the steady motion: {error}")),
        }
        assembly.within_limits()?;
    }
    Ok(check.compared(second))
}

/// Compares equations with a second derivation before they are returned in some form, and tells the observer
/// if this is not possible.
///
/// # Errors
/// [`RunError::Verify`] if the derivations disagree: nothing is returned then.
pub fn vouched(
    model: &Model,
    assembly: &Assembly<'_>,
    outlet: Outlet,
    observer: &dyn Observer,
) -> Result<(), RunError> {
    if let Some(why) = compared(model, assembly, outlet)? {
        assembly.within_limits()?;
        observer.remark(&format!("not compared with a second derivation: {why}"));
    }
    Ok(())
}

/// Does the same as [`vouched`], but returns the reason if the equations could not be compared.
///
/// # Errors
/// [`RunError::Verify`] if the derivations disagree.
pub fn compared(
    model: &Model,
    assembly: &Assembly<'_>,
    outlet: Outlet,
) -> Result<Option<VerifyError>, RunError> {
    match vouch(model, assembly, outlet) {
        Ok(_) => Ok(None),
        Err(error @ VerifyError::Disagreement(_)) => Err(RunError::Verify(Box::new(error))),
        Err(error) => Ok(Some(error)),
    }
}

/// The comparison of a motion with a second derivation, at some of its states.
#[derive(Debug)]
pub struct Verification {
    second: Result<Second, VerifyError>,
    form: &'static str,
    /// The points of the motion at which it was compared, with the results.
    outcomes: Vec<(&'static str, Result<Agreement, VerifyError>)>,
    /// The comparison of derivatives with differences.
    derivatives: Vec<Result<Agreement, VerifyError>>,
    /// The comparison of states after events, with the names of the events.
    resets: Vec<(String, Result<Agreement, VerifyError>)>,
}

impl Verification {
    /// The second derivation of a model in a form, before any comparison.
    pub fn new(model: &Model, assembly: &Assembly<'_>, form: Variables) -> Verification {
        Verification {
            second: Second::new(model, assembly),
            form: form.name(),
            outcomes: Vec::new(),
            derivatives: Vec::new(),
            resets: Vec::new(),
        }
    }

    /// Whether one comparison takes too long, that is, more than a few milliseconds.
    pub fn is_long(&self, flow: &Flow) -> bool {
        self.second.as_ref().is_ok_and(|second| second.is_long(flow))
    }

    /// Whether the equations were compared at some state, where they agree.
    pub(crate) fn agrees(&self) -> bool {
        self.outcomes.iter().any(|(_, outcome)| outcome.is_ok())
    }

    /// Compares the equations at one state.
    ///
    /// # Errors
    /// [`RunError::Verify`] if the derivations disagree. It is not an error if there can be no second
    /// derivation, or if the state is singular.
    pub fn compare(
        &mut self,
        flow: &Flow,
        assembly: &Assembly<'_>,
        place: &'static str,
        t: f64,
        state: &[f64],
    ) -> Result<(), RunError> {
        let Ok(second) = &self.second else { return Ok(()) };
        let outcome = second.agrees(self.form, flow, assembly, t, state);
        if let Err(error @ VerifyError::Disagreement(_)) = outcome {
            return Err(RunError::Verify(Box::new(error)));
        }
        self.outcomes.push((place, outcome));
        Ok(())
    }

    /// Compares derivatives of rates at one state with differences of the rates from the second derivation.
    ///
    /// # Errors
    /// [`RunError::Verify`] if they disagree.
    pub fn compare_derivatives(
        &mut self,
        model: &Model,
        assembly: &Assembly<'_>,
        flow: &Flow,
        (t, state): (f64, &[f64]),
        slopes: &[Slope],
    ) -> Result<(), RunError> {
        let Ok(second) = &self.second else { return Ok(()) };
        for slope in slopes {
            let outcome = second.slope_agrees((model, assembly), flow, (t, state), slope);
            if let Err(error @ VerifyError::Disagreement(_)) = outcome {
                return Err(RunError::Verify(Box::new(error)));
            }
            self.derivatives.push(outcome);
        }
        Ok(())
    }

    /// Compares the state after an event with the definitions of its reset.
    ///
    /// # Errors
    /// [`RunError::Verify`] if they disagree.
    pub fn compare_reset(&mut self, model: &Model, flow: &Flow, jump: &Jump<'_>) -> Result<(), RunError> {
        let Ok(second) = &self.second else { return Ok(()) };
        let outcome = second.reset_agrees(model, flow, jump);
        if let Err(error @ VerifyError::Disagreement(_)) = outcome {
            return Err(RunError::Verify(Box::new(error)));
        }
        self.resets.push((jump.event.to_owned(), outcome));
        Ok(())
    }

    /// Compares the state after the first occurrence of each event that has a reset.
    ///
    /// # Errors
    /// [`RunError::Verify`] if they disagree.
    pub(crate) fn compare_resets(
        &mut self,
        model: &Model,
        assembly: &Assembly<'_>,
        flow: &Flow,
        occurrences: &[Occurrence],
    ) -> Result<(), RunError> {
        let with_resets = assembly.events.iter().enumerate().filter(|(_, event)| !event.resets.is_empty());
        for (place, event) in with_resets {
            let first = occurrences.iter().find(|occurrence| occurrence.event == place);
            if let Some(Occurrence { time, state_before, state_after, .. }) = first {
                let name = event.name.as_str();
                let jump = Jump { event: name, t: *time, before: state_before, after: state_after };
                self.compare_reset(model, flow, &jump)?;
            }
        }
        Ok(())
    }

    /// A description of the comparison of states after events.
    fn of_resets(&self) -> Vec<String> {
        let is_known = self.resets.iter().any(|(_, outcome)| outcome.is_ok());
        let unknown =
            self.resets.iter().filter_map(|(event, outcome)| Some((event, outcome.as_ref().err()?)));
        let unknown = unknown.map(|(event, error)| format!("not the state after {event}: {error}"));
        is_known
            .then(|| "the first state after each reset, by its definition".to_owned())
            .into_iter()
            .chain(unknown)
            .collect()
    }

    /// A description of the comparison of derivatives.
    fn of_derivatives(&self) -> Option<String> {
        let known: Vec<&Agreement> =
            self.derivatives.iter().filter_map(|outcome| outcome.as_ref().ok()).collect();
        match (known.is_empty(), self.derivatives.first()) {
            (_, None) => None,
            (false, _) => {
                let worst = known.iter().fold(0.0f64, |worst, agreement| worst.max(agreement.error));
                Some(format!("the rates of the derivatives at the end, by its differences, to {worst:.0e}"))
            }
            (true, Some(first)) => first.as_ref().err().map(|error| format!("not the derivatives: {error}")),
        }
    }

    /// A description of the comparison.
    pub fn lines(&self) -> Vec<String> {
        if let Err(error) = &self.second {
            return vec![error.to_string()];
        }
        let (mut places, mut worst, mut lines, mut along) = (Vec::new(), 0.0f64, Vec::new(), "");
        for (place, outcome) in &self.outcomes {
            match outcome {
                Ok(agreement) => {
                    places.push(*place);
                    worst = worst.max(agreement.error);
                    if agreement.projected > 0 {
                        along = " along random virtual velocities";
                    }
                    lines.extend(agreement.not_compared.iter().map(|what| format!("but for {what}")));
                }
                Err(error) => lines.push(format!("not at {place}: {error}")),
            }
        }
        if !places.is_empty() {
            let places = places.join(" and at ");
            let closely = if worst == 0.0 { "the last digit".to_owned() } else { format!("{worst:.0e}") };
            lines.insert(0, format!("by a second derivation, which agrees to {closely} at {places}{along}"));
        }
        lines.extend(self.of_resets());
        lines.extend(self.of_derivatives());
        lines.dedup();
        lines
    }
}
