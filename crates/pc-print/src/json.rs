//! Equations for programs, as JSON.

use pc_mech::{Canonical, Expr, System};
use serde_json::{Map, Value, json};

use crate::constraints::constraint_objects;
use crate::derived::Derived;
use crate::operations::Operations;
use crate::sides::{operator_names, rates_of_states};

/// The equations for programs.
pub(crate) fn poincare(title: &str, derived: &Derived<'_>, operations: &Operations) -> Value {
    let equations = &derived.equations;
    let mut object =
        description(title, equations.system(), &derived.vanishing, &rates_of_states(equations.system()));
    if !derived.quasi_velocities.is_empty() {
        let definition = |(eta, value): &(Expr<'_>, Expr<'_>)| (eta.to_string(), json!(value.to_string()));
        let definitions = derived.quasi_velocities.iter().map(definition);
        object.insert("quasi_velocity_definitions".to_owned(), Value::Object(definitions.collect()));
    }
    if !derived.constraints.is_empty() {
        object.insert("constraints".to_owned(), constraint_objects(derived));
        let reactions =
            derived.reactions.iter().map(|(name, value)| (name.to_string(), json!(value.to_string())));
        object.insert("reactions".to_owned(), Value::Object(reactions.collect()));
    }
    object.insert("mass_matrix".to_owned(), json!(matrix(&equations.mass_matrix().to_rows())));
    object.insert("equations".to_owned(), json!(strings(equations.right_hand_side())));
    object.insert("energy".to_owned(), json!(equations.energy().to_string()));
    if let Some(remark) = derived.energy_remark {
        object.insert("energy_remark".to_owned(), json!(remark));
    }
    object.insert("operations".to_owned(), operations.object());
    Value::Object(object)
}

/// What all forms of the equations have in common.
fn description(
    title: &str,
    system: &System<'_>,
    vanishing: &[Expr<'_>],
    state_rates: &[Expr<'_>],
) -> Map<String, Value> {
    let frame = system.frame();
    let name = operator_names(&[system.quasi_velocities(), vanishing].concat(), "0");
    let free = system.quasi_velocities().len();
    let structure: Vec<Value> = system
        .structure()
        .nonzero()
        .filter(|&(r, s, m, _)| r <= free && s <= free && m < name.len())
        .map(|(r, s, m, c)| json!({ "r": name[r], "s": name[s], "m": name[m], "value": c.to_string() }))
        .collect();
    let parameters: Map<String, Value> =
        system.parameters().iter().map(|(symbol, value)| (symbol.to_string(), json!(value))).collect();
    let entries = [
        ("model", json!(title)),
        ("coordinates", json!(strings(frame.coordinates()))),
        ("quasi_velocities", json!(strings(system.quasi_velocities()))),
        ("parameters", Value::Object(parameters)),
        ("kinematics", json!({ "b": matrix(&frame.b().to_rows()), "b_0": strings(frame.b0()) })),
        ("structure_coefficients", json!(structure)),
    ];
    let mut object: Map<String, Value> =
        entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
    if !state_rates.is_empty() {
        let rate = |((z, _), rate): (&(Expr<'_>, _), &Expr<'_>)| (z.to_string(), json!(rate.to_string()));
        object.insert("states".to_owned(), system.states().iter().zip(state_rates).map(rate).collect());
    }
    object
}

/// The expressions as text.
fn strings(list: &[Expr<'_>]) -> Vec<String> {
    list.iter().map(Expr::to_string).collect()
}

fn matrix(rows: &[Vec<Expr<'_>>]) -> Vec<Vec<String>> {
    rows.iter().map(|row| strings(row)).collect()
}

/// The equations for programs. Where they are not `closed`, there are no `quasi_velocities_of_momenta`, and the
/// quasi-velocities stand for the solution of `momenta` = `momenta_of_velocities`.
pub(crate) fn canonical(
    title: &str,
    derived: &Derived<'_>,
    equations: &Canonical<'_>,
    operations: &Operations,
) -> Value {
    let mut object = description(title, equations.system(), &[], equations.state_rates());
    let solved = equations.is_closed().then(|| strings(equations.quasi_velocities()));
    if !derived.constraints.is_empty() {
        object.insert("constraints".to_owned(), constraint_objects(derived));
    }
    for (key, value) in [
        ("momenta", json!(strings(equations.momenta()))),
        ("closed", json!(equations.is_closed())),
        ("momenta_of_velocities", json!(strings(equations.momenta_of_velocities()))),
        ("quasi_velocities_of_momenta", json!(solved)),
        ("hamiltonian", json!(equations.hamiltonian().to_string())),
        ("velocities", json!(strings(equations.velocities()))),
        ("equations", json!(strings(equations.right_hand_side()))),
        ("operations", operations.object()),
    ] {
        object.insert(key.to_owned(), value);
    }
    Value::Object(object)
}
