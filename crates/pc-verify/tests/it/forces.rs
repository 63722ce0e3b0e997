//! Forces of every kind, rare in the built-in models, derived twice.

use pc_model::{Document, Model, Source};
use pc_verify::{Options, verify};

const MODEL: &str = r#"
[parameters]
m = 1.3
[coordinates]
x = 0.1
"φ" = 0.4
[quasi_velocities]
u = { is = "x' + φ'*x", start = 0.3 }
w = { is = "φ'*(1 + x^2)", start = -0.7 }
[lagrangian]
kinetic = "m*x'^2/2"
potential = "x^2"
dissipation = "0.2*u^2 + 0.1*w^4"
[bodies.b]
mass = 2.0
position = ["x + 0.3*sin(φ)", "-0.3*cos(φ)", 0]
rotation = ["cos(φ)", "-sin(φ)", 0, "sin(φ)", "cos(φ)", 0, 0, 0, 1]
inertia = [1, 2, 0.4]
force = ["sin(t)", -20, 0]
torque = [0, 0, "0.7*φ"]
[forces]
x = "-0.3*x' + t"
w = "x*u"
"#;

#[test]
fn forces_of_every_kind_agree_by_both_routes() {
    let model = Model::new(Document::parse(Source::new("forces.toml", MODEL)).unwrap());
    let agreement = verify(&model, &Options::default()).unwrap();
    let printed =
        ["poincare as printed", "canonical as printed", "lagrange as printed", "orthonormal as printed"];
    let forms = [&["poincare", "canonical", "orthonormal", "emit"][..], &printed].concat();
    assert_eq!((agreement.states, agreement.forms.join(", ")), (100, forms.join(", ")), "{agreement:?}");
    assert!(agreement.error < 1e-13 && agreement.not_compared.is_empty(), "{agreement:?}");
}
