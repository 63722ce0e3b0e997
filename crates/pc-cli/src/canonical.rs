//! Chetaev's canonical equations, printed.

use pc_mech::{Canonical, Style};
use serde_json::{Value, json};

use crate::derive::{Operations, aligned, brackets, description, kinematics, sections, strings};

/// The equations as a book prints them: kinematics, brackets, momenta, Hamiltonian, ẏ = …, operations.
pub fn text(equations: &Canonical<'_>, operations: &Operations) -> String {
    let system = equations.system();
    let lines = |pairs: &[(String, String)]| aligned(pairs.iter().map(|(left, right)| (left, right)));
    sections(&[
        ("Kinematics", kinematics(system, equations.velocities())),
        ("Brackets", brackets(system)),
        ("Momenta", lines(&momenta(equations, Style::Book))),
        ("Hamiltonian", vec![equations.hamiltonian().display(Style::Book)]),
        ("Equations", lines(&equations.balance(Style::Book))),
        ("Operations of one right-hand side", operations.lines()),
    ])
}

/// y_s = ∂L/∂η_s, the two sides of each.
pub fn momenta(equations: &Canonical<'_>, style: Style) -> Vec<(String, String)> {
    let values = equations.momenta_of_velocities();
    let pairs = equations.momenta().iter().zip(&values);
    pairs.map(|(y, value)| (y.display(style), value.display(style))).collect()
}

/// The equations for programs.
pub fn object(title: &str, equations: &Canonical<'_>, operations: &Operations) -> Value {
    let mut object = description(title, equations.system());
    for (key, value) in [
        ("momenta", json!(strings(equations.momenta()))),
        ("momenta_of_velocities", json!(strings(&equations.momenta_of_velocities()))),
        ("quasi_velocities_of_momenta", json!(strings(equations.quasi_velocities()))),
        ("hamiltonian", json!(equations.hamiltonian().to_string())),
        ("velocities", json!(strings(equations.velocities()))),
        ("equations", json!(strings(equations.right_hand_side()))),
        ("operations", operations.object()),
    ] {
        object.insert(key.to_owned(), value);
    }
    Value::Object(object)
}
