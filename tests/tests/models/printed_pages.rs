//! What `pc derive` prints for programs is read back and computed: it has the values of the expressions it was written from.

use std::collections::HashMap;

use pc_expr::Folding;
use pc_print::{Balance, Form, Page, Sheet};
use pc_tests::classical::SplitMix64;
use serde_json::Value;

use crate::derived::Derived;
use crate::pages::printed;
use crate::read_back::{ROUNDING, Read, Sized};

/// The forms whose pages are read back.
const FORMS: [Form; 4] = [Form::Poincare, Form::Canonical, Form::Lagrange, Form::Voronets];

/// Places tried for each page.
const STATES: usize = 20;

fn assert_close(read: &[Sized], written: &[f64], what: &str) {
    assert_eq!(read.len(), written.len(), "{what}");
    for (i, (read, written)) in read.iter().zip(written).enumerate() {
        let same = (read.value - written).abs() <= ROUNDING * read.size.max(written.abs());
        assert!(same || !written.is_finite(), "{what} {i}: read {read:?}, written from {written}");
    }
}

/// Compares each text of a form's page with the expression it was written from, at random places around the start; answers whether
/// the model has the form.
fn agrees(model: &Derived<'_>, form: Form) -> bool {
    let (name, assembly) = (model.name, &model.assembly);
    let Ok((_, derived)) = pc_print::Derived::new(form, assembly) else { return false };
    let paper = assembly.system.graph().page(Folding::Structural);
    let sheet = if form == Form::Canonical {
        let Ok(equations) = assembly.free_system().unwrap().canonical() else { return false };
        Sheet::of_momenta(assembly, &derived, &equations, &paper)
    } else {
        Sheet::of_velocities(assembly, &derived, &paper)
    };
    let printed = printed(model, form, Page::Json).unwrap();
    assert!(!printed.contains('…'), "{name}: something is left out");
    let object: Value = serde_json::from_str(&printed).unwrap();
    let (names, expressions) = match &sheet.balance {
        Balance::Velocities { mass, right, .. } => {
            (vec!["mass_matrix", "equations"], vec![mass.entries().into_owned(), right.clone()])
        }
        Balance::Momenta { of_velocities, right, .. } => {
            (vec!["momenta_of_velocities", "equations"], vec![of_velocities.clone(), right.clone()])
        }
        // `pc-verify` reads the pages of principles.
        Balance::Maggi(_) | Balance::Forces(_) => panic!("{name}: {form:?} is the form of a principle"),
    };
    let energy = if form == Form::Canonical { "hamiltonian" } else { "energy" };
    let mut everything = expressions.concat();
    everything.push(sheet.energy);
    everything.extend(sheet.reactions.iter().map(|&(_, value)| value));
    everything.extend(sheet.constraints.iter().map(|&(_, left, _)| left));
    everything.extend(sheet.frame.0.nonzero_entries().into_iter().chain(sheet.frame.1.clone()));
    everything
        .extend(sheet.brackets.nonzero.iter().flat_map(|bracket| bracket.components.iter().map(|&(_, c)| c)));
    everything.extend(sheet.rates.iter().chain(&sheet.states).map(|&(_, value)| value));
    everything.extend(sheet.definitions.iter().map(|given| given.value));
    let known: HashMap<String, f64> = assembly
        .at_start()
        .into_iter()
        .chain(assembly.system.parameters().iter().copied())
        .map(|(symbol, value)| (symbol.to_string(), value))
        .collect();
    let parameters: Vec<String> = sheet.parameters.iter().map(|(name, _)| name.clone()).collect();
    let symbols = paper.symbols_of(&everything);
    let mut random = SplitMix64::new(11);
    for _ in 0..STATES {
        let at: Vec<_> = symbols
            .iter()
            .map(|&symbol| {
                let name = symbol.symbol_name().unwrap();
                let start = known.get(&name).copied().unwrap_or(0.3);
                let moved =
                    if parameters.contains(&name) { start } else { start + random.uniform(-0.2, 0.2) };
                (symbol, moved)
            })
            .collect();
        let named: Vec<(String, f64)> =
            at.iter().map(|(symbol, value)| (symbol.to_string(), *value)).collect();
        let read = Read::at(&object, &named);
        for (key, list) in names.iter().zip(&expressions) {
            assert_close(
                &read.list(key),
                &paper.evaluate(list, &at).unwrap(),
                &format!("{name}, {form:?}, {key}"),
            );
        }
        let value = paper.evaluate(&[sheet.energy], &at).unwrap();
        assert_close(
            &[read.text(object[energy].as_str().unwrap())],
            &value,
            &format!("{name}, {form:?}, {energy}"),
        );
        for (reaction, value) in &sheet.reactions {
            let text = object["reactions"][reaction.to_string()].as_str().unwrap();
            let value = paper.evaluate(&[*value], &at).unwrap();
            assert_close(&[read.text(text)], &value, &format!("{name}, {form:?}, {reaction}"));
        }
    }
    true
}

pub(crate) fn pages_of_built_in_models_agree_with_their_equations(derived: &Derived<'_>) {
    let pages = FORMS.iter().filter(|&&form| agrees(derived, form)).count();
    derived.findings.borrow_mut().pages = pages;
}

pub(crate) fn pages_of_mechanisms_agree_with_their_equations(derived: &Derived<'_>) {
    for form in FORMS {
        assert!(agrees(derived, form), "{} has no form {form:?}", derived.name);
    }
}
