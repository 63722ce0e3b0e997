//! `[definitions]`: any number of them, each of earlier ones.

use std::fmt::Write;
use std::thread;

use pc_mech::Graph;
use pc_model::{Document, Model, ModelError, Source};

use crate::verified::derived_twice;

/// An oscillator with definitions before it, in the given potential.
fn oscillator(definitions: &str, potential: &str) -> Model {
    let text = format!(
        "[definitions]\n{definitions}[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
         potential = \"{potential}\"\n"
    );
    derived_twice(Document::parse(Source::new("m.toml", &text)).unwrap())
}

/// On a stack too small for a nested call for each of them.
#[test]
fn ten_thousand_nested_definitions_need_no_deep_stack() {
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

/// Used or not, the error is located at the wrong entry.
#[test]
fn definitions_contain_what_is_defined_before() {
    let (good, bad) = ("b = \"2*x\"\n", "c = \"y + b\"\n");
    for potential in ["e", "b^2"] {
        assert_eq!(
            refused(&format!("{good}{bad}e = \"c + b\"\n"), potential),
            "m.toml:3:6: [definitions] c: the name `y` is not declared"
        );
    }
    for (definitions, at, name) in [
        ("c = \"e\"\ne = \"x\"\n", "2:6", "e"),
        ("c = \"x + c\"\n", "2:10", "c"),
        ("c = \"e\"\ne = \"c\"\n", "2:6", "e"),
    ] {
        for potential in ["c", "0"] {
            let message = refused(definitions, potential);
            assert!(message.starts_with(&format!("m.toml:{at}: [definitions] c: ")), "{message}");
            assert!(message.contains(&format!("`{name}`")), "{message}");
        }
    }
}

/// An unused definition has no place that restricts its contents, and its value does not matter.
#[test]
fn an_unused_definition_may_contain_all_that_an_output_may() {
    let graph = Graph::new();
    let definitions = "b = \"d(x')/x^2\"\nc = \"log(x - 1) + b\"\n";
    let assembly = oscillator(definitions, "x").assemble(&graph).unwrap();
    assert_eq!(assembly.system.lagrangian(), graph.symbol("x'").square() / 2.0 - graph.symbol("x"));
    assert!(refused("c = \"sin(x)/0\"\n", "0").contains("`sin(x)/0` divides by zero"));
}
