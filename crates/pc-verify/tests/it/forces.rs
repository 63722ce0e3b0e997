//! Forces of every kind, rare in the built-in models, derived twice.

use pc_mech::Graph;
use pc_model::{Document, Flow, Model, Source, Variables};
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
    let agreement = model.derived(|assembly| verify(&model, assembly, &Options::default())).unwrap();
    let printed = ["poincare", "canonical", "lagrange", "orthonormal", "maggi", "kane", "gibbs-appell"];
    let forms = ["poincare", "canonical", "orthonormal", "emit"].map(str::to_owned).into_iter();
    let forms: Vec<String> = forms.chain(printed.map(|form| format!("{form} as printed"))).collect();
    assert_eq!((agreement.states, agreement.forms.join(", ")), (100, forms.join(", ")), "{agreement:?}");
    assert!(agreement.error < 1e-13 && agreement.not_compared.is_empty(), "{agreement:?}");
}

/// A mass of 2 with the velocity 1/2 at x = 0.4: the energy is 1/4 − U. U is 3 x of a force of 3, also where velocities or
/// times cancel up to rounding, z x of a first-order state z = 2, and 7.5 x²/2; a force of time or of velocities has
/// none, however it looks at t = 0 or at rest.
#[test]
fn the_text_decides_whether_a_force_counts_in_the_energy() {
    let forces = [
        ("3", 1.2),
        ("0.1*x' + 0.2*x' - 0.3*x' + 3", 1.2),
        ("0.1*t + 0.2*t - 0.3*t + 3", 1.2),
        ("z", 0.8),
        ("7.5*x", 0.6),
        ("3*cos(t)", 0.0),
        ("3*cos(k*t)*x", 0.0),
        ("3 + 1e-12*x'", 0.0),
        ("3 + x'^3", 0.0),
    ];
    for (force, expected) in forces {
        let text = format!(
            "parameters.k = 1.5\n[coordinates]\nx = 0.4\n[quasi_velocities]\n\"x'\" = 0.5\n\
             [states]\nz = {{ start = 2, rate = \"x - z\" }}\n\
             [bodies.b]\nmass = 2\nposition = [\"x\", 0, 0]\nforce = [\"{force}\", 0, 0]\n"
        );
        let model = Model::new(Document::parse(Source::new("force.toml", text)).unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
        let place = flow.motion.observable_names().iter().position(|name| name == "energy").unwrap();
        let start = flow.start.clone();
        let energy = flow.motion.observe(0.0, &start)[place];
        assert!((energy - (0.25 - expected)).abs() < 1e-15, "{force}: {energy}");
        let agreement =
            model.derived(|assembly| verify(&model, assembly, &Options { states: 20, ..Options::default() }));
        assert_eq!(agreement.map_or_else(|error| panic!("{force}: {error}"), |found| found.states), 20);
    }
}
