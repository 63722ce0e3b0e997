//! `pc linearize`: the motions near a state to first order, and their eigenvalues over a parameter.

use pc_analysis::{Linearization, RootLocus, Stability};
use pc_model::{Model, Variables};
use pc_print::{stability_in_words, visible, visible_json};
use pc_verify::Outlet;
use serde_json::{Map, Value, json};

use crate::args::input;
use crate::args::linear::{LinearizeArguments, MatrixFormat};
use crate::args::steady::At;
use crate::args::sweep::Vary;
use crate::error::CliError;
use crate::linear::arrays::{Array, of_linearization};
use crate::linear::error::LinearError;
use crate::linear::file::{Contents, Destination};
use crate::linear::ground::{Ground, placed};
use crate::linear::locus::Locus;
use crate::linear::near::{CyclicChoice, Varied, near};
use crate::linear::{compared, json, text};
use crate::output::csv::field;
use crate::output::destination::Destination as Picture;
use crate::output::standard_output::print;
use crate::report::notes::{say_dropped, say_moved};
use crate::report::text::{say, short};
use crate::report::verification::vouched;

/// Runs `pc linearize`.
///
/// # Errors
/// [`CliError`]
pub fn command(arguments: &LinearizeArguments) -> Result<(), CliError> {
    let destination = arguments.output.as_deref().map(Destination::of_arrays).transpose()?;
    let picture = Picture::plot(arguments.plot.as_deref())?;
    let model = input::open(&arguments.model)?;
    let graph = model.graph();
    let mut ground = Ground::new(&model, &graph)?;
    say_dropped(&ground.assembly);
    say_moved(&ground.assembly);
    vouched(&model, &ground.assembly, Outlet::Equations(Variables::QuasiVelocities), arguments.verify)?;
    if let Some(vary) = &arguments.vary {
        let locus = locus(&model, &ground, vary, arguments)?;
        for (value, reason) in &locus.missing {
            let reason = reason.lines().next().unwrap_or_default();
            say(format_args!("note: nothing at {} = {}: {reason}\n", vary.name, short(*value, 6)));
        }
        if let Some(picture) = picture {
            picture.write_plot(&locus.picture().drawing())?;
        }
        return match (&destination, arguments.format) {
            (Some(destination), _) => locus.write(destination),
            (None, None) if arguments.plot.is_some() => Ok(()),
            (None, Some(MatrixFormat::Text) | None) => print(|out| write!(out, "{}", visible(&locus.text()))),
            (None, Some(MatrixFormat::Csv)) => print(|out| write!(out, "{}", locus.csv())),
            (None, Some(MatrixFormat::Json)) => print(|out| writeln!(out, "{}", visible_json(&locus.json()))),
        };
    }
    let (t, start) = (ground.assembly.t_start, ground.start.clone());
    let linear = near(&mut ground.linearizer, t, &start, &arguments.state, CyclicChoice::OfState)
        .map_err(|error| placed(&ground.assembly, error, true))?;
    compared::compare(&model, &ground.assembly, &linear, arguments.verify)?;
    let stability = ground.stability(&linear);
    ground.assembly.within_limits()?;
    let page = || text::page(model.title(), &linear, stability.as_ref(), arguments.state.at() != At::Start);
    let object = || object(&model, arguments.state.at(), &linear, stability.as_ref());
    match (&destination, arguments.format) {
        (Some(destination), _) => destination.write(&Contents {
            json: &object(),
            csv: &csv(&linear),
            arrays: &of_linearization(&linear),
            texts: &names(&linear),
        }),
        (None, Some(MatrixFormat::Text) | None) => print(|out| write!(out, "{}", visible(&page()))),
        (None, Some(MatrixFormat::Csv)) => print(|out| write!(out, "{}", csv(&linear))),
        (None, Some(MatrixFormat::Json)) => print(|out| writeln!(out, "{}", visible_json(&object()))),
    }
}

/// The eigenvalues for each value of the parameter.
fn locus(
    model: &Model,
    ground: &Ground<'_>,
    vary: &Vary,
    arguments: &LinearizeArguments,
) -> Result<Locus, CliError> {
    let values = vary.values.in_order();
    let is_set = arguments.model.set.iter().any(|set| set.name == vary.name);
    if is_set {
        return Err(LinearError::Twice { name: vary.name.clone() }.into());
    }
    let mut locus = Locus {
        title: model.title().to_owned(),
        name: vary.name.clone(),
        components: Vec::new(),
        locus: RootLocus::default(),
        missing: Vec::new(),
    };
    let linearizations = Varied::of(model, ground, &arguments.state);
    for &value in &values {
        ground.assembly.within_limits()?;
        let found = linearizations.linearization(&varied(model, &vary.name, value)?);
        let eigenvalues = match &found {
            Ok(linear) => {
                locus.components.clone_from(&linear.components);
                Some(linear.spectrum.eigenvalues())
            }
            // A wrong command line is wrong for all values.
            Err(error) if error.exit_code() == CliError::USAGE => return found.map(|_| locus),
            Err(error) => {
                locus.missing.push((value, error.to_string()));
                None
            }
        };
        let pushed = locus.locus.push(value, eigenvalues);
        pushed.map_err(|cause| LinearError::Branches { name: vary.name.clone(), value, cause })?;
    }
    match locus.missing.first() {
        Some((_, first)) if locus.missing.len() == values.len() => {
            Err(LinearError::NoneSteady { values: values.len(), first: first.clone() }.into())
        }
        _ => Ok(locus),
    }
}

/// The model with another value of a parameter or of the start.
fn varied(model: &Model, name: &str, value: f64) -> Result<Model, CliError> {
    let mut varied = model.clone();
    varied.set_value(name, value).map_err(LinearError::Varied)?;
    Ok(varied)
}

/// The linearization as one JSON object.
fn object(model: &Model, at: At, linear: &Linearization, stability: Option<&Stability>) -> Value {
    let mut all = Map::new();
    all.insert("model".to_owned(), json!(model.title()));
    all.insert("parameters".to_owned(), json::map(model.parameters()));
    all.insert("at".to_owned(), json!(at.word()));
    all.extend(json::members(linear));
    all.insert("stability".to_owned(), json!(stability.map(stability_in_words)));
    Value::from(all)
}

/// Names for the rows and columns of the arrays, each list separated by commas.
fn names(linear: &Linearization) -> Vec<(&'static str, String)> {
    let state: Vec<&str> = linear.state.iter().map(|(name, _)| name.as_str()).collect();
    let mut names = vec![
        ("state_names", state.join(",")),
        ("components", linear.components.join(",")),
        ("inputs", linear.inputs.join(",")),
        ("outputs", linear.outputs.join(",")),
    ];
    if let Ok(second) = &linear.second_order {
        names.push(("coordinates", second.coordinates.join(",")));
    }
    names
}

/// A line for each number: its array, the names of its row and column, the number; real and
/// imaginary parts have separate lines.
fn csv(linear: &Linearization) -> String {
    let (y, u, h) = (&linear.components, &linear.inputs, &linear.outputs);
    let numbers = |count: usize| (1..=count).map(|i| i.to_string()).collect::<Vec<_>>();
    let states: Vec<String> = linear.state.iter().map(|(name, _)| name.clone()).collect();
    let q = linear.second_order.as_ref().map(|second| second.coordinates.clone()).unwrap_or_default();
    let of = |array: &Array| match array.name.as_str() {
        "state" => (states.clone(), vec![String::new()]),
        "A" => (y.clone(), y.clone()),
        "B" => (y.clone(), u.clone()),
        "C" => (h.clone(), y.clone()),
        "D" => (h.clone(), u.clone()),
        "modes" => (y.clone(), numbers(array.columns)),
        "F" => (q.clone(), u.clone()),
        "M" | "G" | "K" => (q.clone(), q.clone()),
        _ => (numbers(array.rows), vec![String::new()]),
    };
    let mut text = "array,row,column,value\n".to_owned();
    for array in of_linearization(linear) {
        let (rows, columns) = of(&array);
        let parts = match &array.imaginary {
            None => vec![("", &array.real)],
            Some(imaginary) => vec![".re", ".im"].into_iter().zip([&array.real, imaginary]).collect(),
        };
        for (part, values) in parts {
            for (place, value) in values.iter().enumerate() {
                let (row, column) = (&rows[place / array.columns], &columns[place % array.columns]);
                text += &format!("{}{part},{},{},{value:.16e}\n", array.name, field(row), field(column));
            }
        }
    }
    text
}
