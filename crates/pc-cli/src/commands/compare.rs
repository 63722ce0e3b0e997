//! `pc compare`: whether two models, or two forms of one, have the same motion.

use pc_model::{Model, UnknownValue, Variables};
use pc_print::{visible, visible_json};

use crate::args::compare::CompareArguments;
use crate::args::input;
use crate::args::options::{Format, Setting};
use crate::commands::run::{integrate, integrate_again};
use crate::compare::comparison::Comparison;
use crate::compare::error::CompareError;
use crate::compare::page::{Pair, differences};
use crate::error::CliError;
use crate::motion::plan::Plan;
use crate::motion::run::{Ending, Run};
use crate::output::standard_output::print;

/// Integrates both motions, and prints how far they are apart.
///
/// # Errors
/// [`CompareError::Different`] where they are not the same; the failure of a motion, after the
/// times that it reached are compared.
pub fn command(arguments: &CompareArguments) -> Result<(), CliError> {
    let (first, second) = models(arguments)?;
    let written = |model: &Model| model.document().simulation.t_end.as_ref().map(|t| t.value);
    let t_end = arguments.t_end.or(written(&first)).or(written(&second));
    let run_of_a = arguments.as_run(0, t_end);
    let plan = Plan::new(&first, &run_of_a)?;
    let mut run_of_b = arguments.as_run(1, t_end);
    run_of_b.samples = Some(plan.samples);
    let other = Plan::new(&second, &run_of_b)?;
    if plan.t_start != other.t_start {
        return Err(CompareError::Starts { first: plan.t_start, second: other.t_start }.into());
    }
    let forms = [Plan::form(&first, &run_of_a), Plan::form(&second, &run_of_b)];
    if arguments.second.is_none() && forms[0] == forms[1] {
        return Err(CompareError::OneMotion.into());
    }
    let a = integrate(&first, forms[0], || Ok(plan.clone()))?;
    if is_stopped(&a) {
        return a.outcome();
    }
    let b = integrate(&second, forms[1], || Ok(other.clone()))?;
    if is_stopped(&b) {
        return b.outcome();
    }
    let mut comparison = Comparison::new(&a, &b, None, arguments)?;
    if !comparison.is_same() {
        // Two motions, or errors of integration.
        let finer = |model: &Model, form: Variables, (plan, run): (&Plan, &Run)| {
            integrate_again(model, form, || Ok(plan.finer(&run.tolerances)))
        };
        let again = finer(&first, forms[0], (&plan, &a))
            .and_then(|c| Ok((c, finer(&second, forms[1], (&other, &b))?)));
        // Where smaller tolerances cannot be met, there is nothing to tell errors by.
        if let Ok((c, d)) = &again
            && !is_stopped(c)
            && !is_stopped(d)
        {
            comparison = Comparison::new(&a, &b, Some((c, d)), arguments)?;
        }
    }
    let pair = Pair { first: (&a, forms[0].name()), second: (&b, forms[1].name()) };
    print(|out| match arguments.format {
        Format::Text => write!(out, "{}", visible(&pair.text(&comparison))),
        Format::Json => writeln!(out, "{}", visible_json(&pair.json(&comparison))),
    })?;
    let differences = differences(&comparison);
    a.outcome()?;
    b.outcome()?;
    if differences.is_empty() { Ok(()) } else { Err(CompareError::Different { differences }.into()) }
}

/// Whether Ctrl-C or a limit ended a run.
fn is_stopped(run: &Run) -> bool {
    matches!(run.ending, Ending::Interrupted | Ending::Ended(_))
}

/// The two models, with their parameters and starts set.
fn models(arguments: &CompareArguments) -> Result<(Model, Model), CliError> {
    if arguments.form.len() > 2 {
        return Err(CompareError::Forms { count: arguments.form.len() }.into());
    }
    let mut first = input::open(&arguments.model(&arguments.first))?;
    let mut second = match arguments.second.as_deref() {
        None => first.clone(),
        Some("-") if arguments.first == "-" => return Err(CompareError::StandardInput.into()),
        Some(name) => input::open(&arguments.model(name))?,
    };
    let names = |model: &Model| [model.parameter_names(), model.start_names()].concat();
    let (of_first, of_second) = (names(&first), names(&second));
    let both = |first: Vec<String>, second: Vec<String>| -> Vec<String> {
        let more: Vec<String> = second.into_iter().filter(|name| !first.contains(name)).collect();
        [first, more].concat()
    };
    for Setting { name, .. } in &arguments.set {
        if !of_first.contains(name) && !of_second.contains(name) {
            let parameters = both(first.parameter_names(), second.parameter_names());
            let starts = both(first.start_names(), second.start_names());
            return Err(UnknownValue { name: name.clone(), parameters, starts }.into());
        }
    }
    let known = |names: &[String]| -> Vec<Setting> {
        arguments.set.iter().filter(|setting| names.contains(&setting.name)).cloned().collect()
    };
    input::set(&mut first, &known(&of_first))?;
    input::set(&mut second, &known(&of_second))?;
    Ok((first, second))
}
