//! Chetaev's canonical equations, printed.

use pc_mech::{Canonical, Style};
use serde_json::{Value, json};

use crate::binding::{constraint_objects, constraints};
use crate::derive::{Derived, Operations, aligned, brackets, description, kinematics, sections, strings};

/// The equations as a book prints them: constraints, kinematics, brackets, momenta, Hamiltonian, ẏ = …, operations. Where they are
/// not closed, the momenta are equations for η.
pub fn text(derived: &Derived<'_>, equations: &Canonical<'_>, operations: &Operations) -> String {
    let system = equations.system();
    let lines = |pairs: &[(String, String)]| aligned(pairs.iter().map(|(left, right)| (left, right)));
    let cost = if equations.is_closed() {
        "Operations of one right-hand side"
    } else {
        "Operations of one right-hand side, quasi-velocities known"
    };
    sections(&[
        ("Constraints", constraints(derived)),
        ("Kinematics", kinematics(system, equations.velocities())),
        ("Brackets", brackets(system, &[])),
        ("Momenta", lines(&momenta(equations, Style::Book))),
        ("Hamiltonian", derived.with_remark(equations.hamiltonian().display(Style::Book))),
        ("Equations", lines(&equations.balance(Style::Book))),
        (cost, operations.lines()),
    ])
}

/// y_s = ∂L/∂η_s, the two sides of each.
pub fn momenta(equations: &Canonical<'_>, style: Style) -> Vec<(String, String)> {
    let pairs = equations.momenta().iter().zip(equations.momenta_of_velocities());
    pairs.map(|(y, value)| (y.display(style), value.display(style))).collect()
}

/// The equations for programs. Where they are not `closed`, there are no `quasi_velocities_of_momenta`, and the
/// quasi-velocities stand for the solution of `momenta` = `momenta_of_velocities`.
pub fn object(
    title: &str,
    derived: &Derived<'_>,
    equations: &Canonical<'_>,
    operations: &Operations,
) -> Value {
    let mut object = description(title, equations.system(), &[]);
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
