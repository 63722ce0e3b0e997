//! What is printed and emitted: that it is, or why not.

use super::runs::hamel;
use super::tried::Tried;

/// Commands, by what counts their refusals, with a form that is put in where one is asked for.
const PAGES: [(&str, &str, &[&str]); 9] = [
    ("pc check", "check", &[]),
    ("pc check", "check", &["--format", "json"]),
    ("pc derive", "derive", &["--form"]),
    ("pc derive", "derive", &["--form", "--format", "latex"]),
    ("pc derive", "derive", &["--form", "--format", "json"]),
    ("pc theory", "theory", &[]),
    ("pc theory", "theory", &["--format", "json"]),
    ("pc emit", "emit", &["--lang", "c", "-o", "source"]),
    ("pc emit", "emit", &["--form", "--lang", "rust", "-o", "source"]),
];

/// The forms that are printed; source has those in quasi-velocities.
const PRINTED: [&str; 8] =
    ["poincare", "canonical", "lagrange", "voronets", "reduced", "lie-poisson", "orthonormal", "hamel"];
const EMITTED: [&str; 4] = ["poincare", "reduced", "orthonormal", "hamel"];

/// One page.
pub(super) fn examine(tried: &mut Tried<'_>) {
    let (stage, command, words) = *tried.random.pick(&PAGES);
    let forms = if command == "emit" { &EMITTED[..] } else { &PRINTED[..] };
    let form = *tried.random.pick(forms);
    let definition = (form == "hamel" && !tried.quasi_velocities.is_empty())
        .then(|| hamel(tried.random, &tried.quasi_velocities));
    let mut arguments = Vec::new();
    for word in words {
        arguments.push((*word).to_owned());
        if *word == "--form" {
            arguments.push(form.to_owned());
            arguments.extend(definition.clone());
        }
    }
    let Some(text) = tried.output(stage, command, &arguments) else { return };
    if command != "emit" && text.trim().is_empty() {
        tried.tally.find("the program prints nothing", format!("{command} {}", arguments.join(" ")));
    }
}
