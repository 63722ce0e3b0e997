//! `[functions]`: given, or undetermined.

use pc_expr::{Limits, VectorField as _};
use pc_mech::Graph;
use pc_model::{Document, Flow, Model, ModelError, Source, Variables};

use crate::verified::derived_twice;

const CENTRAL: &str = "[parameters]\nm = 2.0\nk = 3.0\n[coordinates]\nr = 1.2\n\"φ\" = 0.3\n[quasi_velocities]\n\
    \"r'\" = 0.1\n\"φ'\" = 0.9\n[lagrangian]\nkinetic = \"m*(r'^2 + r^2*φ'^2)/2\"\n";

fn model(text: &str) -> Result<Model, ModelError> {
    let model = Model::new(Document::parse(Source::new("m.toml", text))?);
    model.derived(|_| Ok::<_, ModelError>(()))?;
    Ok(model)
}

fn with_potential(functions: &str, potential: &str) -> Model {
    let text = format!("{functions}{CENTRAL}potential = \"{potential}\"\n");
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap())
}

/// m r̈ = m r φ'² − V'(r) for every V.
#[test]
fn equations_hold_for_every_potential() {
    let central = with_potential("functions.V.of = \"s\"\n", "V(r)");
    let graph = Graph::new();
    let assembly = central.assemble(&graph).unwrap();
    let equations = assembly.equations().unwrap();
    let [m, r, rate] = graph.symbols(["m", "r", "φ'"]);
    let slope = graph.undetermined("V", &[r]).derivative(r);
    assert_eq!(equations.right_hand_side()[0], m * r * rate.square() - slope);
    assert_eq!(slope.to_string(), "V'(r)");
}

/// Kepler's problem and the oscillator: with the value given in [functions], the same equations, and the same
/// motion to the last bit, as with the potential written out.
#[test]
fn a_given_function_is_its_value() {
    for (is, written) in [("-k/s", "-k/r"), ("k*s^2/2", "k*r^2/2")] {
        let given = with_potential(&format!("functions.V = {{ of = \"s\", is = \"{is}\" }}\n"), "V(r)");
        let plain = with_potential("", written);
        let [given, plain] = [given, plain].map(|model| {
            let rates = model.derived(|assembly| {
                let mut flow = Flow::new(&model, assembly, Variables::QuasiVelocities)?;
                let mut rates = vec![0.0; 4];
                flow.motion.rhs(0.0, &[1.2, 0.3, 0.1, 0.9], &mut rates).unwrap();
                Ok::<_, ModelError>(rates)
            });
            rates.unwrap()
        });
        assert_eq!(given, plain, "{written}");
    }
}

/// What is derived for every function agrees with what is derived for one of them.
#[test]
fn values_may_be_put_in_after_the_derivation() {
    let text = |is: &str| {
        format!(
            "[functions]\nf = {{ of = \"s\"{is} }}\nA = {{ of = \"x, y\" }}\n[coordinates]\ns = 0.4\n\"φ\" = 0.1\n\
             [lagrangian]\nlagrangian = \"(s'^2 + f(s)^2*φ'^2)/2 + A(s, φ)*s'\"\n"
        )
    };
    let every = derived_twice(Document::parse(Source::new("m.toml", text(""))).unwrap());
    let one = derived_twice(Document::parse(Source::new("m.toml", text(", is = \"sin(s)\""))).unwrap());
    let graph = Graph::new();
    let sides =
        |model: &Model| model.assemble(&graph).unwrap().equations().unwrap().right_hand_side().to_vec();
    let (every, one) = (sides(&every), sides(&one));
    let s = graph.symbol("s");
    assert_eq!(graph.with_value_of("f", &[s], s.sin(), &every), one);
    assert!(every.iter().any(|rate| rate.to_string().contains("f'(s)")), "{every:?}");
}

/// A function of a function, with parameters whose names are not those of its arguments.
#[test]
fn functions_call_those_before_them() {
    let functions =
        "[functions]\nf = { of = \"r\", is = \"k*r^2\" }\ng = { of = \"a, b\", is = \"f(a - b) + m\" }\n";
    let composed = with_potential(functions, "g(2*r, f(r)/k)");
    let graph = Graph::new();
    let assembly = composed.assemble(&graph).unwrap();
    let [r, k, m] = graph.symbols(["r", "k", "m"]);
    let still: Vec<_> = ["r'", "φ'"].map(|name| (graph.symbol(name), 0.into())).into();
    let potential = -graph.substitute(&[assembly.system.lagrangian()], &still)[0];
    assert_eq!(potential, k * (2.0 * r - r.square()).square() + m);
}

/// Without a value there are no numbers.
#[test]
fn a_motion_needs_values() {
    let central = with_potential("functions.V.of = \"s\"\n", "V(r)");
    let refused = central
        .derived(|assembly| Flow::new(&central, assembly, Variables::QuasiVelocities).map(|_| ()))
        .unwrap_err();
    insta::assert_snapshot!(refused.to_string());
}

#[test]
fn errors_say_what_would_be_right() {
    let faults = [
        ("[functions]\nV = { of = \"r\" }\n", "V(r, φ)"),
        ("[functions]\nV = { of = \"r\" }\n", "V*r"),
        ("[functions]\nVolume = { of = \"r\" }\n", "Volum(r)"),
        ("[functions]\nV = { of = \"r, r\" }\n", "0"),
        ("[functions]\nV = { of = \"2r\" }\n", "0"),
        ("[functions]\nV = { is = \"r\" }\n", "0"),
        ("[functions]\nV = \"r\"\n", "0"),
        ("[functions]\nm = { of = \"r\" }\n", "0"),
        ("[functions]\nsin = { of = \"r\" }\n", "0"),
        ("[functions]\nV = { of = \"s\", is = \"r + s\" }\n", "0"),
        ("[functions]\nV = { of = \"s\", is = \"V(s)\" }\n", "0"),
        ("[functions]\nV = { of = \"s\", value = \"s\" }\n", "0"),
    ];
    let said: Vec<String> = faults
        .iter()
        .map(|(functions, potential)| {
            let text = format!("{functions}{CENTRAL}potential = \"{potential}\"\n");
            model(&text).unwrap_err().to_string()
        })
        .collect();
    insta::assert_snapshot!(said.join("\n"));
}

/// Functions of functions, each called twice by the next, have 2⁶⁰ calls: the limits hold for them, too.
#[test]
fn functions_of_functions_end_at_the_limits() {
    let next = |i: usize| format!("f{} = {{ of = \"s\", is = \"f{i}(f{i}(s))\" }}\n", i + 1);
    let chain: String = (0..59).map(next).collect();
    let text = format!(
        "[functions]\nf0 = {{ of = \"s\", is = \"1 + s^2\" }}\n{chain}{CENTRAL}potential = \"f59(r)\"\n"
    );
    let mut model = Model::new(Document::parse(Source::new("m.toml", text.as_str())).unwrap());
    model.limit(Limits { memory: 20 << 20, ..Limits::default() });
    let error = model.derived(|_| Ok::<_, ModelError>(())).unwrap_err();
    assert!(error.to_string().contains("more memory would be needed than the limit of 20 MiB"), "{error}");
}
