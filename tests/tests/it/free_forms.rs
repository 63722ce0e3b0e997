//! One motion in the forms its equations have: reduced, Lie–Poisson, in an orthonormal frame, in quasi-velocities that are given, and of
//! any choice of independent velocities; against equations of books and the second derivation. (That all built-in models have the same
//! rates in these forms is a claim of the program `models`.)

use std::collections::BTreeMap;

use pc_expr::Folding;
use pc_mech::Graph;
use pc_model::{Assembly, Builtin, Document, Flow, Model, Source, Variables};
use pc_print::{Derived, Form};
use pc_solve::{Method, Options, solve};
use pc_verify::verify;

fn parsed(text: &str) -> Model {
    Model::new(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

fn builtin(name: &str) -> Model {
    Model::new(Builtin::named(name).unwrap().document().unwrap())
}

fn assembled<'g>(model: &Model, graph: &'g Graph) -> Assembly<'g> {
    model.assemble(graph).unwrap_or_else(|error| panic!("{error}"))
}

/// The quasi-velocities that are free, at least one.
fn free_velocities(model: &Model) -> Vec<String> {
    let graph = Graph::new();
    let assembly = assembled(model, &graph);
    let form = assembly.free_form(Variables::QuasiVelocities).unwrap();
    form.independent.iter().map(ToString::to_string).collect()
}

/// A metric of 1.02, whose root is no number of finitely many digits: rounded, its square would be another, and near x = 0 terms
/// in x⁻⁵ would not cancel. ω̇ by Lagrange's equations with a multiplier, in 40 digits.
#[test]
fn roots_of_numbers_are_exact_in_an_orthonormal_frame() {
    let mut model = parsed(
        r#"
[coordinates]
x = -0.0071324568147978365
"φ" = 0.9528100841076882
[quasi_velocities]
"ω" = 6.21324506640695
w = 0.3967100102515362
[kinematics]
x = "w"
"φ" = "sqrt(1.22*φ)*ω + 0.44*cos(2.0*t)"
[constraints]
k = "0.18 - 0.05*cos(φ)*ω - 0.19*x^2*w"
[lagrangian]
kinetic = "0.51*ω^2 + 0.2*w + 1.04*exp(-1)*w + 0.26*tanh(x)*ω"
[simulation]
t_start = 0.7666216164272852
"#,
    );
    model.choose_independent(["ω"]);
    let graph = Graph::new();
    let assembly = assembled(&model, &graph);
    let equations = assembly.free_form(Variables::Orthonormal).unwrap().system.poincare().unwrap();
    assert_eq!(equations.mass_matrix()[(0, 0)], 1.into());
    // As it is written in print, in the order that a state has.
    let page = graph.page(Folding::Structural);
    let written = equations.written(&page)[0].unwrap();
    let symbols = ["t", "x", "φ", "η1"].map(|name| page.symbol(name));
    let at =
        [0.7666216164272852, -0.0071324568147978365, 0.9528100841076882, 6.21324506640695 * 1.02f64.sqrt()];
    let at: Vec<_> = symbols.into_iter().zip(at).collect();
    let found = page.evaluate(&[written], &at).unwrap()[0] / 1.02f64.sqrt();
    // Terms in x⁻², 2·10⁴, are summed.
    assert!((found / -4746.645073995105 - 1.0).abs() < 1e-14, "{found}");
}

/// The second derivation, which reads the definitions by itself, agrees with each form: by the motion, by what is printed, and by
/// the values of the quasi-velocities, which are outputs.
#[test]
fn forms_are_derived_twice() {
    let options = pc_verify::Options { states: 10, seed: 1, ..pc_verify::Options::default() };
    let cases = [
        ("chaplygin-sleigh", "u = 2*v + ω*sin(φ)", vec!["reduced", "lie-poisson", "orthonormal", "hamel"]),
        (
            "heavy-top-euler-symmetric",
            "n = φ' + ψ'*cos(θ)",
            vec!["reduced", "lie-poisson", "orthonormal", "hamel"],
        ),
        ("charged-particle", "w = 2*η1 - η2", vec!["orthonormal", "hamel"]),
    ];
    for (name, definition, forms) in cases {
        let mut model = builtin(name);
        let known = free_velocities(&model);
        let (symbol, definition) = definition.split_once(" = ").unwrap();
        let definition = if known.iter().any(|eta| definition.contains(eta.as_str())) {
            definition.to_owned()
        } else {
            format!("2*{}", known[0])
        };
        model.give_quasi_velocity(symbol, &definition).unwrap();
        let agreement = model
            .derived(|assembly| verify(&model, assembly, &options))
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        for form in forms {
            for form in [form.to_owned(), format!("{form} as printed")] {
                assert!(agreement.forms.contains(&form), "{name}: {form} of {agreement:?}");
            }
        }
    }
}

/// A free body on a quaternion: Euler's equations, and the Lie–Poisson bracket of so(3).
#[test]
fn euler_and_lie_poisson_equations_are_those_of_books() {
    let text = r#"
[parameters]
A = 1.0
B = 2.0
C = 3.0
[coordinates]
q0 = 1.0
q1 = 0.0
q2 = 0.0
q3 = 0.0
[quasi_velocities]
p = 0.1
q = 2.0
r = 0.1
[kinematics]
q0 = "-(q1*p + q2*q + q3*r)/2"
q1 = "(q0*p + q2*r - q3*q)/2"
q2 = "(q0*q + q3*p - q1*r)/2"
q3 = "(q0*r + q1*q - q2*p)/2"
[lagrangian]
kinetic = "(A*p^2 + B*q^2 + C*r^2)/2"
[integrals]
norm = "q0^2 + q1^2 + q2^2 + q3^2"
momentum = "A^2*p^2 + B^2*q^2 + C^2*r^2"
[simulation]
t_end = 2.0
project = ["norm"]
"#;
    let (model, graph) = (parsed(text), Graph::new());
    let assembly = assembled(&model, &graph);
    let (name, derived) = Derived::new(Form::Reduced, &assembly).unwrap();
    assert_eq!(name, "Euler–Poincaré equations");
    let [a, b, c, p, q, r] = graph.symbols(["A", "B", "C", "p", "q", "r"]);
    let euler = [(b - c) * q * r, (c - a) * r * p, (a - b) * p * q];
    for (found, expected) in derived.equations.right_hand_side().iter().zip(euler) {
        assert!((*found - expected).is_zero(), "{found}");
    }
    let canonical = assembly.free_form(Variables::ReducedMomenta).unwrap().system.canonical().unwrap();
    let momenta = canonical.momenta();
    let expected = momenta[1] * momenta[2] / c - momenta[2] * momenta[1] / b;
    assert!((canonical.right_hand_side()[0] - expected).is_zero(), "{}", canonical.right_hand_side()[0]);
    // The norm is of what is left out: nothing is left to be kept, and the momentum is.
    let mut flow = Flow::new(&model, &assembly, Variables::Reduced).unwrap();
    assert_eq!(flow.names, ["p", "q", "r"]);
    assert_eq!(flow.motion.observable_names(), ["momentum", "energy"]);
    let start = flow.start.clone();
    let solution = solve(&mut flow.motion, 0.0, &start, &[0.0, 2.0], &Options::new(Method::Adams)).unwrap();
    let rows: Vec<Vec<f64>> = solution.iter().map(|(t, y)| flow.row(t, y)).collect();
    assert!((rows[0][3] - rows[1][3]).abs() < 1e-6 * rows[0][3], "{rows:?}");
}

const PENDULUM: &str = r#"
[parameters]
g = 9.81
[coordinates]
x = 0.6
y = -0.8
[constraints]
rod = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "g*y"
[simulation]
t_end = 0.5
"#;

fn end(model: &Model, variables: Variables, t: f64) -> Result<BTreeMap<String, f64>, String> {
    let graph = Graph::new();
    let assembly = model.assemble(&graph).map_err(|error| error.to_string())?;
    let mut flow = Flow::new(model, &assembly, variables).map_err(|error| error.to_string())?;
    let start = flow.start.clone();
    let options = Options::new(Method::Adams).relative_tolerance(1e-11).absolute_tolerance(1e-13);
    let solution = solve(&mut flow.motion, 0.0, &start, &[0.0, t], &options);
    let solution = solution.map_err(|failure| failure.to_string())?;
    let (t, state) = solution.last().unwrap();
    let row = flow.row(t, state);
    Ok(flow.names.iter().cloned().zip(row).collect())
}

/// Whatever velocities are taken for independent ones, and with multipliers, the motion is the same.
#[test]
fn any_choice_of_independent_velocities_gives_the_same_motion() {
    let disk = builtin("vertical-disk").document().source.text().to_owned();
    let cases: [(&str, &[&[&str]]); 2] =
        [(PENDULUM, &[&["x'"], &["y'"]]), (&disk, &[&["φ'", "θ'"], &["φ'", "X'"]])];
    for (text, choices) in cases {
        let held = end(&parsed(text), Variables::QuasiVelocities, 0.5).unwrap();
        for choice in choices {
            let mut model = parsed(text);
            model.choose_independent(choice.iter().copied());
            let forms = [Variables::QuasiVelocities, Variables::Momenta, Variables::Orthonormal];
            for variables in forms {
                let found = end(&model, variables, 0.5).unwrap();
                for (name, value) in &found {
                    // Errors of 1e-11 a step, in some hundred steps, and those of holding the constraints to 1e-9.
                    assert!((value - held[name]).abs() < 1e-7, "{choice:?}, {}: {name}", variables.name());
                }
            }
        }
    }
}

/// Of the velocities of a spherical pendulum those of y and z have shorter equations than those of x and y, though z' is determined
/// better by these; y' is not determined at all by the others.
#[test]
fn independent_velocities_are_those_of_the_shortest_equations() {
    let text = PENDULUM
        .replace("y = -0.8", "y = 0.0\nz = -0.8")
        .replace("x^2 + y^2 - 1", "x^2 + y^2 + z^2 - 1")
        .replace("(x'^2 + y'^2)", "(x'^2 + y'^2 + z'^2)")
        .replace("g*y", "g*z");
    let derived = |choice: &[&str]| {
        let mut model = parsed(&text);
        model.choose_independent(choice.iter().copied());
        let graph = Graph::new();
        let equations = assembled(&model, &graph).equations().unwrap();
        let mass = equations.mass_matrix().nonzero_entries();
        let sides = mass.iter().chain(equations.right_hand_side()).chain(equations.velocities());
        let length: u32 = sides.map(|side| side.tree_cost()).sum();
        let free = equations.system().quasi_velocities().iter().map(ToString::to_string).collect::<Vec<_>>();
        (free, length)
    };
    let (free, shortest) = derived(&[]);
    assert_eq!(free, ["y'", "z'"]);
    assert_eq!(derived(&["y'", "z'"]), (free, shortest));
    assert!(shortest < derived(&["x'", "y'"]).1);
}

/// Past the place where x' does not determine y' the equations of x' say nothing: an error, no number.
#[test]
fn a_choice_ends_where_it_does_not_determine_the_motion() {
    let text = PENDULUM.replace("x = 0.6", "x = 0.0").replace("y = -0.8", "y = -1.0");
    let text = text.replace("[constraints]", "[quasi_velocities]\n\"x'\" = 7.0\n[constraints]");
    let mut model = parsed(&text);
    assert!(end(&model, Variables::QuasiVelocities, 1.0).is_ok(), "it turns over");
    model.choose_independent(["x'"]);
    let error = end(&model, Variables::QuasiVelocities, 1.0).unwrap_err();
    assert!(!error.is_empty());
    model.choose_independent(["y'"]);
    let error = end(&model, Variables::QuasiVelocities, 1.0).unwrap_err();
    assert!(error.contains("`y'` cannot be the independent quasi-velocities"), "{error}");
}

#[test]
fn wrong_requests_are_refused() {
    let refused = |change: &dyn Fn(&mut Model), variables: Variables| {
        let mut model = parsed(PENDULUM);
        change(&mut model);
        end(&model, variables, 0.1).unwrap_err()
    };
    let error = refused(&|model| model.choose_independent(["x'", "y'"]), Variables::QuasiVelocities);
    assert!(error.contains("the constraints leave 1 of x', y' free"), "{error}");
    let error = refused(&|model| model.choose_independent(["z"]), Variables::QuasiVelocities);
    assert!(error.contains("`z` is not among them; they are x', y'"), "{error}");
    let error = refused(&|_| {}, Variables::Orthonormal);
    assert!(error.contains("choose these with --independent"), "{error}");
    let error = refused(&|model| model.choose_independent(["x'"]), Variables::Given);
    assert!(error.contains("no quasi-velocities are given"), "{error}");
    let mut model = builtin("chaplygin-sleigh");
    for (name, definition, message) in [
        ("t", "ω", "reserved"),
        ("2u", "ω", "not a name"),
        ("φ", "ω", "already the name of a coordinate"),
        ("u", "ω +", "expected"),
    ] {
        let error = model.give_quasi_velocity(name, definition).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
    for (definition, message) in [
        ("ω^2", "is not linear in the velocities"),
        ("ω + 1", "is not linear in the velocities"),
        ("sin(φ)", "is not linear in the velocities"),
        ("0*ω", "contains no velocity"),
        ("nothing", "not declared"),
    ] {
        let mut model = builtin("chaplygin-sleigh");
        model.give_quasi_velocity("given", definition).unwrap();
        let error = end(&model, Variables::Given, 0.1).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
}
