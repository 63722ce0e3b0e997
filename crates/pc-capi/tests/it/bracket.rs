//! The bracket of two functions generates the motion.

use std::ptr;

use crate::common::{Model, Refusal, System, c, call};
use pc::pc_form::{PC_CANONICAL, PC_POINCARE};
use pc::pc_status::*;
use pc::*;

fn bracket(system: &System, f: &str, g: &str, t: f64, y: &[f64]) -> Result<f64, Refusal> {
    let (f, g, mut value) = (c(f), c(g), 0.0);
    call(|error| unsafe {
        // SAFETY: a live system, texts, and arrays as said.
        pc_system_bracket(system.0, f.as_ptr(), g.as_ptr(), t, y.as_ptr(), y.len(), &raw mut value, error)
    })?;
    Ok(value)
}

/// A few dozen roundings of numbers of order ten.
const ROUNDING: f64 = 1e-12;

const TOP: &str = "(I1*ω1^2 + I2*ω2^2 + I3*ω3^2)/2 + mg*r3*γ3";
const POINT: &str = "
[coordinates]
x = 0.2
y = 0.7
z = -0.3
[quasi_velocities]
\"x'\" = 0.5
\"y'\" = -0.4
\"z'\" = 0.35
[constraints]
knife = \"z' - y*x'\"
[lagrangian]
kinetic = \"(x'^2 + y'^2 + z'^2)/2\"
potential = \"x*z + y^2\"
";
const HELD: &str = "(x'^2 + y'^2 + z'^2)/2 + x*z + y^2";

fn rates(system: &System, t: f64, y: &[f64]) -> Vec<f64> {
    system.at(pc_system_rhs, t, y, y.len()).unwrap()
}

/// (x_i, H) = ẋ_i and (f, g) = −(g, f), in both forms, with multipliers and without.
#[test]
fn the_bracket_with_the_energy_is_the_rate() {
    let models = [
        (Model::named("heavy-top-lagrange"), TOP, ["ω1*γ2", "I1*ω1"]),
        (Model::text(POINT).unwrap(), HELD, ["x'*y", "y'"]),
    ];
    for (model, energy, [f, g]) in models {
        for form in [PC_POINCARE, PC_CANONICAL] {
            let system = model.system(form).unwrap();
            let (t, y) = system.start();
            let rates = rates(&system, t, &y);
            for i in 0..3 {
                let (name, rate) = (system.name(i), rates[i]);
                let found = bracket(&system, &name, energy, t, &y).unwrap();
                assert!((found - rate).abs() < ROUNDING, "{name}: {found} against {rate}");
            }
            let [there, back] = [(f, g), (g, f)].map(|(f, g)| bracket(&system, f, g, t, &y).unwrap());
            assert!((there + back).abs() < ROUNDING && there.abs() > 0.01, "{there} {back}");
        }
    }
}

/// ṗ = (p, H), compared with Poincaré's equations of a top with known moments of inertia.
#[test]
fn momenta_follow_the_bracket() {
    let system = System::of("heavy-top-lagrange");
    let (t, y) = system.start();
    let found = bracket(&system, "I1*ω1", TOP, t, &y).unwrap();
    let mass = system.at(pc_system_mass_matrix, t, &y, 9).unwrap(); // diag(I1, I2, I3)
    let expected = mass[0] * rates(&system, t, &y)[3];
    assert!((found - expected).abs() < ROUNDING, "{found} against {expected}");
    // The algebra so(3), with the sign of body axes: (I1 ω1, I2 ω2) = −I3 ω3.
    let found = bracket(&system, "I1*ω1", "I2*ω2", t, &y).unwrap();
    assert!((found + mass[8] * y[5]).abs() < ROUNDING, "{found}");
}

/// Independent momenta of the particle on ż = y ẋ: p = (1 + y²) ẋ has ṗ = (p, H).
#[test]
fn the_almost_poisson_bracket_includes_the_vanishing_momenta() {
    let system = Model::text(POINT).unwrap().system(PC_POINCARE).unwrap();
    let y = [0.2, 0.7, -0.3, 0.5, -0.4, 0.35];
    let rates = rates(&system, 0.0, &y);
    let found = bracket(&system, "(1 + y^2)*x'", HELD, 0.0, &y).unwrap();
    let expected = 2.0 * y[1] * y[4] * y[3] + (1.0 + y[1] * y[1]) * rates[3];
    assert!((found - expected).abs() < ROUNDING, "{found} against {expected}");
}

#[test]
fn a_text_that_is_not_a_function_of_the_state_is_refused() {
    let system = System::of("heavy-top-lagrange");
    let (t, y) = system.start();
    let refusal = bracket(&system, "γ1*(ω1 + w2)", "γ2", t, &y).unwrap_err();
    assert_eq!((refusal.status, refusal.line), (PC_INVALID_MODEL, 1));
    assert!(refusal.message.starts_with("expression:1:10: "), "{}", refusal.message);
    assert!(bracket(&system, "γ1 +", "γ2", t, &y).is_err());
    assert_eq!(bracket(&system, "γ1", "γ2", t, &y[1..]).unwrap_err().status, PC_INVALID_ARGUMENT);
    let (name, mut value) = (c("γ1"), 0.0);
    let (name, y, n) = (name.as_ptr(), y.as_ptr(), y.len());
    let null = ptr::null();
    // SAFETY: a live system or null, texts or nulls, arrays as said.
    unsafe {
        for (system, f, g, value) in [
            (ptr::null_mut(), name, name, &raw mut value),
            (system.0, null, name, &raw mut value),
            (system.0, name, null, &raw mut value),
            (system.0, name, name, ptr::null_mut()),
        ] {
            let refusal = call(|error| pc_system_bracket(system, f, g, t, y, n, value, error)).unwrap_err();
            assert_eq!(refusal.status, PC_INVALID_ARGUMENT);
        }
    }
    let nonlinear = System::of("appell-hamel");
    let (t, y) = nonlinear.start();
    let name = nonlinear.name(0);
    assert_eq!(bracket(&nonlinear, &name, &name, t, &y).unwrap_err().status, PC_UNSUPPORTED);
}
