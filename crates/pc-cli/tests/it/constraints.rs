//! The program on models with `[constraints]`.

mod columns;
mod forms;
mod motions;
mod reports;

use std::process::Output;

use serde_json::Value;

pub(crate) use crate::piped::pc;

/// Chaplygin's sleigh, its blade a constraint that defines a quasi-velocity.
pub(crate) const SLEIGH: &str = r#"
[model]
name = "Chaplygin sleigh"
[parameters]
m = 1.0
J = 0.5
a = 0.3
[coordinates]
x = 0.0
y = 0.0
phi = 0.4
[quasi_velocities]
v = { is = "cos(phi)*x' + sin(phi)*y'", start = 1.0 }
omega = { is = "phi'", start = 2.0 }
[constraints]
blade = "-sin(phi)*x' + cos(phi)*y'"
[lagrangian]
kinetic = "m/2*(x'^2 + y'^2) + m*a*omega*(cos(phi)*y' - sin(phi)*x') + (J + m*a^2)/2*omega^2"
[simulation]
t_end = 3.0
samples = 4
"#;

/// The same in a frame with the lateral velocity u as the second of three.
pub(crate) const SLIP: &str = r#"
[coordinates]
x = 0.0
y = 0.0
phi = 0.4
[quasi_velocities]
v = 1.0
u = 0.0
omega = 2.0
[kinematics]
x = "cos(phi)*v - sin(phi)*u"
y = "sin(phi)*v + cos(phi)*u"
phi = "omega"
[constraints]
slip = "u"
[lagrangian]
kinetic = "(v^2 + (u + 0.3*omega)^2 + 0.5*omega^2)/2"
[simulation]
t_end = 3.0
samples = 4
"#;

/// A spherical pendulum in Cartesian coordinates.
pub(crate) const SPHERE: &str = r#"
[model]
name = "Spherical pendulum"
[parameters]
m = 1.0
g = 9.8
l = 1.0
[coordinates]
x = 0.6
y = 0.0
z = "-0.8*l"
[quasi_velocities]
"y'" = 1.0
[constraints]
length = "x^2+y^2+z^2-l^2"
[lagrangian]
kinetic = "m*(x'^2 + y'^2 + z'^2)/2"
potential = "m*g*z"
[integrals]
area = "x*y' - y*x'"
[simulation]
t_end = 2.0
samples = 5
"#;

pub(crate) fn stderr(output: &Output) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert!(!text.contains("panicked"), "{text}");
    text
}

#[track_caller]
pub(crate) fn stdout(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

/// The header and the rows of a table.
pub(crate) fn table(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    (header, lines.map(row).collect())
}

#[track_caller]
pub(crate) fn run(model: &str, arguments: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
    table(&stdout(&pc(model, &[&["run", "-"], arguments].concat())))
}

pub(crate) fn json_of(model: &str, arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout(&pc(model, arguments))).expect("JSON")
}

/// Compares the columns that both tables have; after some seconds, two integrations with the usual
/// tolerance 10⁻⁹ differ by a few hundred times this.
#[track_caller]
pub(crate) fn agree(
    one: &(Vec<String>, Vec<Vec<f64>>),
    other: &(Vec<String>, Vec<Vec<f64>>),
    tolerance: f64,
) {
    assert_eq!(one.1.len(), other.1.len());
    for (i, name) in one.0.iter().enumerate() {
        let Some(j) = other.0.iter().position(|known| known == name) else { continue };
        for (a, b) in one.1.iter().zip(&other.1) {
            assert!(
                (a[i] - b[j]).abs() <= tolerance * (1.0 + a[i].abs()),
                "{name} at {}: {} {}",
                a[0],
                a[i],
                b[j]
            );
        }
    }
}
