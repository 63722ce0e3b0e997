//! The parameters and starts of a text, with their values.

use pc_model::Model;
use serde_json::{Value, json};

/// The names that `--set` takes, in the order of the text, with the values that the text gives.
pub(super) fn names(model: &Model) -> Value {
    let parameters: Vec<Value> = model
        .parameters()
        .filter(|(_, value)| value.is_finite())
        .map(|(name, value)| named(model, name, value))
        .collect();
    let starts: Vec<Value> = match model.start() {
        Ok(values) => {
            model.start_names().iter().zip(values).map(|(name, value)| named(model, name, value)).collect()
        }
        Err(_) => Vec::new(), // the error is told where the equations are derived
    };
    json!({ "kind": "names", "parameters": parameters, "starts": starts })
}

fn named(model: &Model, name: &str, value: f64) -> Value {
    match model.document().unit(name) {
        Some(unit) => json!({ "name": name, "value": value, "unit": unit }),
        None => json!({ "name": name, "value": value }),
    }
}
