//! Everything on which the numbers of a motion, or of other work on a model, depend. This identity is stored with interrupted
//! work, so that only the same command can continue it.

use pc_model::Model;
use pc_model::document::AbsoluteTolerance;
use pc_solve::Accumulation;

use crate::plan::Plan;

/// Names and values, in order of importance.
pub(crate) type Identity = Vec<(String, String)>;

/// The identity of the motion of a model.
pub(crate) fn of_motion(model: &Model, plan: &Plan) -> Identity {
    let most = plan.max_steps.map(|most| ("--max-steps", most.to_string()));
    let parameters: Vec<&str> = model.parameters().map(|(name, _)| name).collect();
    let by: Vec<&str> = plan.sensitivities.iter().map(|&j| parameters[j]).collect();
    let by = (!by.is_empty()).then(|| ("--sensitivities", by.join(",")));
    let plan = [
        ("--project", model.kept().join(", ")),
        ("--t-end", plan.t_end.to_string()),
        ("--rtol", format!("{:e}", plan.rtol)),
        ("--atol", given(&plan.atol)),
        ("--max-step", plan.max_step.map_or("none".to_owned(), |length| format!("{length:e}"))),
        ("--samples-per-step", plan.samples_per_step.map_or("4".to_owned(), |parts| parts.to_string())),
        ("--accumulation", format!("{:e}", plan.accumulation.unwrap_or(Accumulation::default().within))),
        ("--method", plan.method.to_string().to_lowercase()),
        ("--form", plan.form.name().to_owned()),
    ];
    of_work(model, plan.into_iter().chain(most).chain(by))
}

/// Absolute tolerances as they are given.
fn given(atol: &AbsoluteTolerance) -> String {
    let all = atol.all.map(|value| format!("{value:e}"));
    let each = atol.each.iter().map(|(name, value)| format!("{name}={value:e}"));
    let given: Vec<String> = all.into_iter().chain(each).collect();
    if given.is_empty() { "by scale".to_owned() } else { given.join(",") }
}

/// The identity of other work on a model: version, parameters, start, everything on which the work itself
/// depends, and the text of the model.
pub(crate) fn of_work(model: &Model, own: impl IntoIterator<Item = (&'static str, String)>) -> Identity {
    let entry = |name: &str, value: String| (name.to_owned(), value);
    let mut identity = vec![entry("pc", env!("CARGO_PKG_VERSION").to_owned())];
    identity.extend(
        model.parameters().map(|(name, value)| entry(&format!("the parameter {name} ="), value.to_string())),
    );
    let starts = model.replaced_starts().into_iter();
    identity.extend(starts.map(|(name, value)| entry(&format!("the start {name} ="), value.to_string())));
    let tables = model.parameter_values().tables().into_iter();
    identity.extend(tables.map(|(place, table)| {
        let numbers = table.times().iter().chain(table.values()).flat_map(|number| number.to_le_bytes());
        let sum = crc32fast::hash(&numbers.collect::<Vec<u8>>());
        entry(&format!("the table of input {}:", place + 1), format!("{sum:08x}"))
    }));
    identity.push(entry("--project-start", model.projects_start().to_string()));
    identity.extend(own.into_iter().map(|(name, value)| entry(name, value)));
    identity.push(entry("text of the model", format!("{}\n", model.document().source.text())));
    let given = model.given_quasi_velocities().iter();
    identity
        .extend(given.map(|given| entry(&format!("{} =", given.name()), given.expression().text.clone())));
    let independent = model.independent();
    identity.extend((!independent.is_empty()).then(|| entry("--independent", independent.join(","))));
    let held = model.held_start_names();
    identity.extend((!held.is_empty()).then(|| entry("--keep", held.join(","))));
    identity
}

/// A phrase that describes the first difference.
pub(crate) fn difference(then: &Identity, now: &Identity) -> Option<String> {
    let value = |identity: &Identity, name: &str| {
        identity.iter().find(|(known, _)| known == name).map_or("(not there)", |(_, value)| value).to_owned()
    };
    let name =
        now.iter().chain(then).map(|(name, _)| name).find(|name| value(then, name) != value(now, name))?;
    let (then, now) = (value(then, name), value(now, name));
    Some(if then.contains('\n') || now.contains('\n') {
        format!("another {name}")
    } else {
        format!("{name} {then}, where now it is {now}")
    })
}
