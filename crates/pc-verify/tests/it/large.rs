//! Large models, compared at most states along random virtual velocities only.

use std::fmt::Write;

use pc_mech::Graph;
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_verify::{Options, Second, verify};

/// A chain of pendulums, each hanging on the one before; `more` is further text of the model.
fn chain(links: usize, more: &str) -> Model {
    let mut text = "[coordinates]\n".to_owned();
    let sum = |function: &str, i: usize| {
        (0..=i).map(|j| format!("{function}(q{j})")).collect::<Vec<_>>().join(" + ")
    };
    (0..links).for_each(|i| writeln!(text, "q{i} = {}", 0.1 + 0.03 * i as f64).unwrap());
    text += "[quasi_velocities]\n";
    (0..links).for_each(|i| writeln!(text, "\"q{i}'\" = {}", 0.02 * i as f64).unwrap());
    for i in 0..links {
        let (x, y) = (sum("sin", i), sum("cos", i));
        writeln!(text, "[bodies.b{i}]\nmass = 1\nposition = [\"{x}\", \"-({y})\", 0]\nforce = [0, -9.81, 0]")
            .unwrap();
    }
    Model::new(Document::parse(Source::new("chain.toml", text + more)).unwrap())
}

#[test]
fn equations_of_large_models_are_compared_along_random_virtual_velocities() {
    for more in ["", "[forces]\nq3 = \"-0.2*q3'\"\n", "[constraints]\ncoupled = \"q1' - q4' + 0.06\"\n"] {
        let model = chain(24, more);
        let options = Options { states: 30, ..Options::default() };
        let agreement = model.derived(|assembly| verify(&model, assembly, &options)).unwrap();
        assert_eq!((agreement.states, agreement.skipped), (30, 0), "{agreement:?}");
        assert!((1..30).contains(&agreement.projected), "{agreement:?}");
        assert!(agreement.to_string().contains("of them along 3 random virtual velocities"), "{agreement}");
    }
}

/// A small additional force, along the motion of a model without it, shows in the comparison.
#[test]
fn an_equation_that_differs_shows_along_random_virtual_velocities() {
    let (one, other) = (chain(24, ""), chain(24, "[forces]\nq17 = \"1e-6\"\n"));
    let (graph, other_graph) = (Graph::new(), Graph::new());
    let assembly = one.assemble(&graph).unwrap();
    let second = Second::new(&one, &assembly).unwrap();
    let flow = Flow::new(&one, &assembly, Variables::QuasiVelocities).unwrap();
    let agreement = second.agrees("poincare", &flow, &assembly, 0.0, &flow.start).unwrap();
    assert_eq!((agreement.states, agreement.projected), (1, 1));
    let of_other = other.assemble(&other_graph).unwrap();
    let wrong = Flow::new(&other, &of_other, Variables::QuasiVelocities).unwrap();
    let error = second.agrees("poincare", &wrong, &assembly, 0.0, &flow.start).unwrap_err();
    assert!(error.to_string().contains("random virtual velocity 1"), "{error}");
}
