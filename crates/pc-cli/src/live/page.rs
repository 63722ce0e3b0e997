//! The page itself.

use pc_print::Form;
use pc_report::pieces;
use serde_json::{Value, json};

use crate::live::original::Original;

const PAGE: &str = include_str!("../../live/page.html");
const STYLE: &str = include_str!("../../live/live.css");
/// The editor and what surrounds it, with the licences of its libraries at its end.
const SCRIPT: &str = include_str!("../../live/dist/live.js");

/// The page for a text. Only scripts with this nonce run in it.
pub(super) fn page(original: &Original, nonce: &str) -> String {
    let data = pieces::data(&given(original));
    filled(PAGE, |name| match name {
        "title" => pieces::text(original.given()),
        "nonce" => nonce.to_owned(),
        "style" => pieces::style() + STYLE,
        "viewer" => pieces::VIEWER.to_owned(),
        "plots" => pieces::PLOTS.to_owned(),
        "live" => SCRIPT.to_owned(),
        "data" => data.clone(),
        unknown => unreachable!("the page has no part called {unknown}"),
    })
}

/// What the page may load and run: nothing from elsewhere.
pub(super) fn policy(nonce: &str) -> String {
    format!(
        "default-src 'none'; script-src 'nonce-{nonce}'; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; \
         connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
}

fn given(original: &Original) -> Value {
    let forms = Form::ALL.into_iter().filter(|form| *form != Form::Hamel);
    let forms: Vec<[&str; 2]> =
        [["", "that of the text"]].into_iter().chain(forms.map(|form| [form.name(), words(form)])).collect();
    json!({ "model": original.given(), "file": original.file(), "text": original.text(), "forms": forms })
}

fn words(form: Form) -> &'static str {
    match form {
        Form::Poincare => "Poincaré",
        Form::Canonical => "canonical",
        Form::Lagrange => "Lagrange",
        Form::Voronets => "Voronets",
        Form::Reduced => "reduced (Euler–Poincaré)",
        Form::LiePoisson => "Lie–Poisson",
        Form::Orthonormal => "orthonormal",
        Form::Hamel => "Hamel",
        Form::Maggi => "Maggi",
        Form::Kane => "Kane",
        Form::GibbsAppell => "Gibbs–Appell",
    }
}

/// The text with each `{{name}}` replaced, in one pass, since the parts contain braces themselves.
fn filled(text: &str, part: impl Fn(&str) -> String) -> String {
    let mut whole = String::new();
    let mut rest = text;
    while let Some((before, (name, after))) =
        rest.split_once("{{").and_then(|(before, after)| Some((before, after.split_once("}}")?)))
    {
        whole += before;
        whole += &part(name);
        rest = after;
    }
    whole + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_not_read_for_names() {
        assert_eq!(filled("<{{a}}-{{b}}>", |name| format!("{name}={{{{a}}}}")), "<a={{a}}-b={{a}}>");
        assert_eq!(filled("none {{", str::to_owned), "none {{");
    }

    #[test]
    fn every_part_of_the_page_is_known() {
        let page = page(&Original::open("tilted-disk").unwrap(), "0123");
        assert_eq!(page.matches("nonce=\"0123\"").count(), 3);
        assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>\n"));
    }
}
