//! Choices by name: methods, the forms of the equations that a command takes, and words.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use pc_model::Variables;
use pc_print::Form;
use pc_solve::Method;

pub(super) fn method(text: &str) -> Result<Method, String> {
    choice(text, &Method::ALL.map(|method| (method.name(), method)), &[])
}

pub(super) fn form(text: &str) -> Result<Form, String> {
    choice(text, &Form::ALL.map(|form| (form.name(), form)), &[])
}

/// The form with this name, if it can be emitted as source code: only forms in velocities can.
pub(super) fn emit_form(text: &str) -> Result<Variables, String> {
    let forms = Variables::ALL.into_iter().filter(|form| !form.has_momenta());
    let named: Vec<(&str, Variables)> = forms.map(|form| (form.name(), form)).collect();
    let others =
        Form::ALL.map(Form::name).into_iter().filter(|name| named.iter().all(|(known, _)| known != name));
    choice(text, &named, &others.collect::<Vec<_>>())
}

/// The form with this name, if it can be integrated.
pub(super) fn run_form(text: &str) -> Result<Variables, String> {
    let named = Variables::ALL.map(|form| (form.name(), form));
    let printed = Form::ALL.into_iter().filter(|form| form.variables().is_none());
    choice(text, &named, &printed.map(Form::name).collect::<Vec<_>>())
}

/// A parser that turns each of these words, listed with its help, into its value.
pub(super) fn by_word<T, const N: usize>(
    known: [(&'static str, &'static str, T); N],
) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let words = known.map(|(word, help, _)| PossibleValue::new(word).help(help));
    PossibleValuesParser::new(words).try_map(move |given| {
        let found = known.iter().find(|(word, ..)| *word == given);
        found.map(|(.., value)| *value).ok_or_else(|| format!("there is no `{given}`"))
    })
}

/// The value with this name among `known`; the names in `later` are not supported yet.
fn choice<T: Copy>(text: &str, known: &[(&str, T)], later: &[&str]) -> Result<T, String> {
    if let Some((_, value)) = known.iter().find(|(name, _)| *name == text) {
        return Ok(*value);
    }
    let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
    let names = match names.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => names.concat(),
    };
    if later.contains(&text) {
        Err(format!("`{text}` is not supported yet; use {names}"))
    } else {
        Err(format!("use {names}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unsupported_choices_are_named() {
        assert_eq!(method("bdf"), Ok(Method::Bdf));
        assert_eq!(method("taylor"), Ok(Method::Taylor));
        assert_eq!(method("rk4").unwrap_err(), "use adams, bdf, dop853, taylor or auto");
        assert_eq!(run_form("lie-poisson"), Ok(Variables::ReducedMomenta));
        let refused =
            "`canonical` is not supported yet; use poincare, reduced, orthonormal, hamel or voronets";
        assert_eq!(emit_form("canonical").unwrap_err(), refused);
    }
}
