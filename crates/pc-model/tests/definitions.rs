//! `[definitions]`: any number of them, made of those before.

#![expect(clippy::unwrap_used, reason = "tests")]

use std::fmt::Write;
use std::thread;

use pc_mech::Graph;
use pc_model::{Document, Model, ModelError, Source};

/// An oscillator with definitions before it, that moves in the potential given.
fn oscillator(definitions: &str, potential: &str) -> Model {
    let text = format!(
        "[definitions]\n{definitions}[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
         potential = \"{potential}\"\n"
    );
    Model::new(Document::parse(Source::new("m.toml", &text)).unwrap())
}

/// With so little stack that each of them may not cost a call.
#[test]
fn ten_thousand_definitions_one_made_of_the_other_cost_no_stack() {
    const COUNT: usize = 10_000;
    const STACK: usize = 256 << 10;
    let follow = || {
        let mut definitions = "a0 = \"x/2\"\n".to_owned();
        for i in 1..COUNT {
            writeln!(definitions, "a{i} = \"sin(a{})\"", i - 1).unwrap();
        }
        let graph = Graph::new();
        let assembly = oscillator(&definitions, &format!("a{}", COUNT - 1)).assemble(&graph).unwrap();
        let x = graph.symbol("x");
        let found = graph.evaluate(&[-assembly.system.lagrangian()], &[(x, 1.0), (graph.symbol("x'"), 0.0)]);
        let expected = (1..COUNT).fold(0.5f64, |a, _| a.sin());
        assert_eq!(found.unwrap(), [expected]);
    };
    thread::Builder::new().stack_size(STACK).spawn(follow).unwrap().join().unwrap();
}

fn refused(definitions: &str, potential: &str) -> String {
    let graph = Graph::new();
    let error: ModelError = match oscillator(definitions, potential).assemble(&graph) {
        Ok(_) => panic!("accepted: {definitions}"),
        Err(error) => error,
    };
    error.to_string().lines().next().unwrap().to_owned()
}

/// What is not used may be anything; what is used is blamed where it stands.
#[test]
fn definitions_are_looked_at_where_they_are_used() {
    let (good, bad) = ("b = \"2*x\"\n", "c = \"y + b\"\n");
    let graph = Graph::new();
    let assembly = oscillator(&format!("{good}{bad}"), "b^2").assemble(&graph).unwrap();
    let x = graph.symbol("x");
    assert_eq!(assembly.system.lagrangian(), graph.symbol("x'").square() / 2.0 - 4.0 * x.square());
    assert_eq!(
        refused(&format!("{good}{bad}e = \"c + b\"\n"), "e"),
        "m.toml:3:6: [definitions] c: the name `y` is not declared"
    );
    for (definitions, at, name) in [
        ("c = \"e\"\ne = \"x\"\n", "2:6", "e"),
        ("c = \"x + c\"\n", "2:10", "c"),
        ("c = \"e\"\ne = \"c\"\n", "2:6", "e"),
    ] {
        let message = refused(definitions, "c");
        assert!(message.starts_with(&format!("m.toml:{at}: [definitions] c: ")), "{message}");
        assert!(message.contains(&format!("`{name}`")), "{message}");
    }
}
