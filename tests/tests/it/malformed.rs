//! Malformed models are refused with the right category, at the right line, naming what is wrong.

use pc_mech::Graph;
use pc_model::{Category, Document, Model, ModelError};
use pc_tests::malformed::{Malformed, deeply_nested, malformed};

/// Goes as far as the first evaluation of the equations of motion.
fn start(name: &str, bytes: &[u8]) -> Result<bool, ModelError> {
    let model = Model::new(Document::from_bytes(name, bytes)?);
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    model.compile(&assembly)?;
    Ok(model.document().simulation.t_end.is_some())
}

fn complaints(case: &Malformed) -> Vec<String> {
    let bytes = std::fs::read(case.path()).unwrap();
    let error = match start(case.file, &bytes) {
        Ok(has_end) if case.exit_code == 2 && !has_end => return Vec::new(),
        Ok(_) => return vec!["is accepted".to_owned()],
        Err(error) => error,
    };
    let message = error.to_string();
    let mut complaints = Vec::new();
    let code = i32::from(error.category().exit_code());
    if code != case.exit_code {
        complaints.push(format!("exit code {code} instead of {}", case.exit_code));
    }
    let lower = message.to_lowercase();
    if !case.mentions.iter().any(|text| lower.contains(&text.to_lowercase())) {
        complaints.push(format!("none of {:?} is mentioned", case.mentions));
    }
    if case.line.is_some_and(|line| line != error.position().line) {
        complaints.push(format!("line {} instead of {:?}", error.position().line, case.line));
    }
    complaints.into_iter().map(|complaint| format!("{complaint}\n{message}")).collect()
}

#[test]
fn malformed_models_are_refused() {
    let found: Vec<String> = malformed()
        .flat_map(|case| {
            complaints(case).into_iter().map(move |c| format!("{} ({}): {c}", case.file, case.fault))
        })
        .collect();
    assert!(found.is_empty(), "{} complaints:\n\n{}", found.len(), found.join("\n\n"));
}

#[test]
fn corrected_models_run() {
    for case in malformed() {
        let Some((wrong, right)) = case.correction else { continue };
        let text = String::from_utf8_lossy(&std::fs::read(case.path()).unwrap()).replace(wrong, right);
        if let Err(error) = start(case.file, text.as_bytes()) {
            panic!("{} is still refused when corrected:\n{error}", case.file);
        }
    }
}

#[test]
fn deep_nesting_is_refused() {
    for case in deeply_nested(10_000) {
        match start("deep.toml", case.text.as_bytes()) {
            Ok(_) => assert!(case.exit_codes.contains(&0), "{}", case.what),
            Err(error) => {
                assert_eq!(error.category(), Category::Text, "{}: {error}", case.what);
                assert!(case.exit_codes.contains(&3), "{}: {error}", case.what);
            }
        }
    }
}
