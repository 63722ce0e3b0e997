//! `[parameters]` that are expressions in those before them.

use pc_mech::Graph;
use pc_model::{Category, Document, Model, Source};

use crate::verified::derived_twice;

fn model(parameters: &str) -> Model {
    let text = format!(
        "[parameters]\n{parameters}[definitions]\nhalf = \"m/2\"\n[coordinates]\nx = 1.0\n[lagrangian]\n\
         kinetic = \"half*x'^2\"\n"
    );
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap())
}

fn values(model: &Model) -> Vec<f64> {
    model.parameters().map(|(_, value)| value).collect()
}

/// A tube: its mass and moment of inertia by its size.
const TUBE: &str = "rho = 2\nr = +0.5\nm = \"rho*pi*r^2\"\nI = \"m*r^2\"\n";

#[test]
fn an_expression_follows_the_parameters_in_it() {
    let pi = std::f64::consts::PI;
    let mut tube = model(TUBE);
    assert_eq!(values(&tube), [2.0, 0.5, pi / 2.0, pi / 8.0]);
    tube.set("r", 1.0).unwrap();
    assert_eq!(values(&tube), [2.0, 1.0, 2.0 * pi, 2.0 * pi]);
    let graph = Graph::new();
    let assembly = tube.assemble(&graph).unwrap();
    let of_system: Vec<f64> = assembly.system.parameters().iter().map(|&(_, value)| value).collect();
    assert_eq!(of_system, values(&tube));
}

/// In any order of setting them.
#[test]
fn a_value_that_is_set_replaces_its_expression() {
    for order in [["m", "r", "rho"], ["rho", "m", "r"], ["r", "rho", "m"]] {
        let mut tube = model(TUBE);
        for name in order {
            tube.set(name, 3.0).unwrap();
        }
        assert_eq!(values(&tube), [3.0, 3.0, 3.0, 27.0], "{order:?}");
    }
}

fn refused(model: &Model) -> (Category, String) {
    let graph = Graph::new();
    let error = model.assemble(&graph).err().unwrap();
    assert_eq!(model.start().unwrap_err().to_string(), error.to_string());
    (error.category(), error.to_string())
}

#[test]
fn an_expression_contains_only_earlier_parameters() {
    for (parameters, message, help) in [
        ("a = \"m\"\nm = 1\n", "2:6: [parameters] a: `m` is used before it is defined", "move it up"),
        ("m = \"m + 1\"\n", "2:6: [parameters] m: `m` is used before it is defined", "move it up"),
        ("m = \"q\"\n", "2:6: [parameters] m: the name `q` is not declared", "declare it"),
        ("m = \"half\"\n", "2:6: [parameters] m: `half` cannot be used in the value", "parameters before it"),
        ("m = \"2 + x\"\n", "2:10: [parameters] m: `x` cannot be used in the value", "parameters before it"),
        ("m = \"2*x'\"\n", "2:8: [parameters] m: `x'` cannot be used in the value", "parameters before it"),
        ("m = \"t\"\n", "2:6: [parameters] m: `t` cannot be used in the value", "parameters before it"),
        ("m = \"d(2)\"\n", "2:6: [parameters] m: `d(2)` cannot be used in the value", "parameters before it"),
        ("m = \"1/0\"\n", "2:6: [parameters] m: `1/0` divides by zero", "whatever"),
    ] {
        let (category, text) = refused(&model(parameters));
        assert!(text.starts_with(&format!("m.toml:{message}")), "{text}");
        assert!(text.contains(help), "{text}");
        assert_eq!(category, Category::Text);
    }
}

/// An expression without a value is refused, until a parameter in it is set so that it has one.
#[test]
fn an_expression_without_a_value_is_refused() {
    for parameters in ["a = 0\nm = \"1/a\"\n", "a = 1\nm = \"sqrt(0 - a)\"\n", "a = 0\nm = \"log(a)\"\n"] {
        let mut model = model(parameters);
        let (category, text) = refused(&model);
        assert!(text.starts_with("m.toml:3:6: [parameters] m: `"), "{text}");
        assert!(text.ends_with("help: give the parameters in it other values"), "{text}");
        assert_eq!(category, Category::Inconsistent);
        model.set("m", 2.0).unwrap();
        model.assemble(&Graph::new()).unwrap();
    }
    let mut one = model("a = 0\nm = \"1/a\"\n");
    one.set("a", 4.0).unwrap();
    one.assemble(&Graph::new()).unwrap();
    assert_eq!(values(&one), [4.0, 0.25]);
    let (_, text) = refused(&model("m = \"log(0 - 1)\"\n"));
    assert!(text.contains("[parameters] m: `log(0 - 1)` is NaN"), "{text}");
}
