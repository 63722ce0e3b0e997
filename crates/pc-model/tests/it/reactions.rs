//! Reactions as outputs of a model.

use pc_mech::Graph;
use pc_model::{Document, Source};

use crate::verified::derived_twice;

/// The observables at the start, by name.
fn observed(text: &str, all: bool) -> Vec<(String, f64)> {
    let mut model = derived_twice(Document::parse(Source::new("model.toml", text)).unwrap());
    model.observe_reactions(all);
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let (mut motion, start) = model.compile(&assembly).unwrap();
    let values = motion.observe(assembly.t_start, &start);
    motion.observable_names().iter().cloned().zip(values).collect()
}

fn value(observed: &[(String, f64)], name: &str) -> f64 {
    observed.iter().find(|(known, _)| known == name).unwrap().1
}

/// A particle held against the force (2, 3, 0): the reactions are −2 and −3, for any order of the
/// constraints.
const HELD: &str = r#"
[coordinates]
x = 0.0
y = 0.0
z = 0.0
[quasi_velocities]
u = 0.0
s = 0.0
w = 1.0
[kinematics]
x = "u"
y = "s"
z = "w"
[constraints]
second = "s"
first = "u"
[lagrangian]
kinetic = "(u^2 + s^2 + w^2)/2"
potential = "-2*x - 3*y"
[outputs]
both = "λ_first - 10*λ_second"
"#;

#[test]
fn reactions_bear_the_names_of_their_constraints() {
    let found = observed(HELD, true);
    assert_eq!(
        found.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(),
        ["energy", "both", "λ_second", "λ_first"]
    );
    assert_eq!(value(&found, "λ_first"), -2.0);
    assert_eq!(value(&found, "λ_second"), -3.0);
    assert_eq!(value(&found, "both"), 28.0);
    assert!(observed(HELD, false).iter().all(|(name, _)| !name.starts_with('λ')));
}

/// The rod of a spherical pendulum pulls with 2λ r, λ = (g z − |ṙ|²)/(2|r|²); a constraint that follows from
/// it has no reaction.
#[test]
fn multipliers_are_outputs_but_for_those_of_dropped_constraints() {
    let sphere = r#"
[coordinates]
x = 0.6
y = 0.0
z = -0.8
[quasi_velocities]
"y'" = 1.5
[constraints]
length = "x^2 + y^2 + z^2 - 1"
again = "x*x' + y*y' + z*z'"
[lagrangian]
kinetic = "(x'^2 + y'^2 + z'^2)/2"
potential = "10*z"
"#;
    let found = observed(sphere, true);
    assert!((value(&found, "λ_length") - (-8.0 - 2.25) / 2.0).abs() < 1e-14);
    assert!(found.iter().all(|(name, _)| name != "λ_again"), "{found:?}");
}

#[test]
fn a_reaction_of_an_unknown_constraint_is_refused() {
    let wrong = HELD.replace("λ_first - 10*λ_second", "λ_third");
    let model = derived_twice(Document::parse(Source::new("model.toml", &wrong)).unwrap());
    let error = model.assemble(&Graph::new()).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("the name `λ_third` is not declared"), "{error}");
    // … and a reaction cannot occur in expressions that determine the motion.
    let circular = HELD.replace("-2*x - 3*y", "-2*x - 3*y + λ_first");
    let model = derived_twice(Document::parse(Source::new("model.toml", &circular)).unwrap());
    let error = model.assemble(&Graph::new()).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("the name `λ_first` is not declared"), "{error}");
}

/// Accelerations and reactions are no functions of the state in which d() could be taken: x'' = −x has the rate −x',
/// not 0. Where their derivatives cancel before they are named, nothing is unknown.
#[test]
fn accelerations_and_reactions_have_no_rates() {
    let text = |section: &str, function: &str| {
        format!(
            "[inputs]\nu = 7.5\n[coordinates]\nx = 0.6\nz = -0.8\n[quasi_velocities]\nv.is = \"x'\"\nw.is = \"z' + x*x'\"\n\
             [constraints]\nrod = \"x^2 + z^2 - 1\"\n[bodies.bob]\nmass = 1\nposition = [\"x\", 0, \"z\"]\n[{section}]\nf = \"{function}\"\n"
        )
    };
    let assembled = |text: &str| {
        let model = pc_model::Model::new(Document::parse(Source::new("m.toml", text)).unwrap());
        let graph = Graph::new();
        model.assemble(&graph).map(|_| ()).map_err(|error| error.to_string())
    };
    for (function, what, name) in [
        ("d(d(x'))", "acceleration", "x''"),
        ("1 + d(x*d(x'))", "acceleration", "x''"),
        ("d(d(d(x)))", "acceleration", "x''"),
        ("d(d(w))", "acceleration", "w'"),
        ("d(λ_rod)", "reaction", "λ_rod"),
        ("x*d(F_rod_bob_z*x)", "reaction", "F_rod_bob_z"),
    ] {
        for section in ["outputs", "integrals"] {
            let error = assembled(&text(section, function)).unwrap_err();
            let expected = format!("[{section}] f: the rate of the {what} `{name}` is not known\n");
            assert!(error.contains(&expected), "{error}");
            assert!(error.contains("m.toml:15:"), "{error}");
        }
    }
    for function in ["d(d(x))", "d(w) + λ_rod", "d(x'^2)", "d(0*d(x'))", "d(d(x') - d(x') + x)"] {
        assert_eq!(assembled(&text("outputs", function)), Ok(()), "{function}");
    }
}
