//! A linearization in a form for programs; docs/linearization.md says what the members are.

use pc_analysis::{Linearization, Mode, SecondOrder};
use pc_mech::Matrix;
use serde_json::{Map, Value, json};

/// An object of names with numbers.
pub(crate) fn map<'a>(pairs: impl IntoIterator<Item = (&'a str, f64)>) -> Value {
    let members: Map<String, Value> =
        pairs.into_iter().map(|(name, value)| (name.to_owned(), json!(value))).collect();
    Value::from(members)
}

/// An array of rows.
fn rows(matrix: &Matrix<f64>) -> Value {
    json!(matrix.to_rows())
}

fn second_order(second: &SecondOrder) -> Value {
    json!({
        "coordinates": second.coordinates,
        "M": rows(&second.mass),
        "G": rows(&second.velocity),
        "K": rows(&second.stiffness),
        "F": rows(&second.input),
    })
}

fn mode(mode: &Mode) -> Value {
    let pairs = |vector: &Vec<(f64, f64)>| vector.iter().map(|&(re, im)| [re, im]).collect::<Vec<_>>();
    json!(mode.vector.as_ref().map(pairs))
}

/// The members of the JSON object of a linearization, except those that identify it.
pub(crate) fn members(linear: &Linearization) -> Map<String, Value> {
    let pairs = |list: &[(String, f64)]| map(list.iter().map(|(name, value)| (name.as_str(), *value)));
    let eigenvalues: Vec<[f64; 2]> =
        linear.spectrum.eigenvalues().iter().map(|value| [value.real, value.imaginary]).collect();
    let members = json!({
        "t": linear.t,
        "state": pairs(&linear.state),
        "steady": linear.is_steady,
        "residual": linear.residual,
        "distance": linear.distance,
        "components": linear.components,
        "left_out": pairs(&linear.cyclic),
        "inputs": linear.inputs,
        "outputs": linear.outputs,
        "output_values": linear.output_values,
        "other_outputs": linear.other_outputs,
        "A": rows(&linear.state_matrix),
        "B": rows(&linear.input_matrix),
        "C": rows(&linear.output_matrix),
        "D": rows(&linear.feedthrough),
        "eigenvalues": eigenvalues,
        "tolerance": linear.spectrum.tolerance(),
        "verdict": linear.is_steady.then(|| linear.spectrum.verdict().to_string()),
        "modes": linear.modes.iter().map(mode).collect::<Value>(),
        "second_order": linear.second_order.as_ref().ok().map(second_order),
        "no_second_order": linear.second_order.as_ref().err().map(ToString::to_string),
    });
    match members {
        Value::Object(members) => members,
        _ => Map::new(),
    }
}
