//! `pc compare`: whether two models, or two forms of one, have the same motion.

use pc_model::{Model, UnknownValue};
use pc_run::Plan;
use pc_run::compare::compared::Compared;
use pc_run::compare::error::CompareError;
use pc_run::table::format::Format;

use crate::args::compare::CompareArguments;
use crate::args::input;
use crate::args::options::Setting;
use crate::error::CliError;
use crate::output::table::TablePlace;
use crate::terminal::observer::Terminal;

/// Integrates both motions, and prints how far they are apart.
///
/// # Errors
/// [`CompareError::Different`] where they are not the same; the failure of a motion, after the
/// times that it reached are compared.
pub fn command(arguments: &CompareArguments) -> Result<(), CliError> {
    let place = TablePlace::of(&arguments.table, Format::OF_COMPARISONS)?;
    let (first, second) = models(arguments)?;
    let output = arguments.table.output.as_deref();
    input::keep_apart(&arguments.model(&arguments.first), &first, [output])?;
    if let Some(name) = &arguments.second {
        input::keep_apart(&arguments.model(name), &second, [output])?;
    }
    let written = |model: &Model| model.document().simulation.t_end.as_ref().map(|t| t.value);
    let t_end = arguments.t_end.or(written(&first)).or(written(&second));
    let wishes = [arguments.wishes(0, t_end), arguments.wishes(1, t_end)];
    let forms = [Plan::form(&first, &wishes[0]), Plan::form(&second, &wishes[1])];
    if arguments.second.is_none() && forms[0] == forms[1] {
        return Err(CompareError::OneMotion.into());
    }
    let question = arguments.question();
    let compared = Compared::of([&first, &second], [&wishes[0], &wishes[1]], &question, &Terminal)?;
    place.write(&compared, "comparison")?;
    Ok(compared.outcome()?)
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
    arguments.outputs.apply([&mut first, &mut second]);
    Ok((first, second))
}
