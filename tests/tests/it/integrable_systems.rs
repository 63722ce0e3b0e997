//! Integrable systems have their known integrals, for all values of the parameters: the list is the same whatever these are.

use pc_analysis::{ConservationVerdict, Integral, Integrals, PolynomialAnsatz};
use pc_mech::{Expr, Graph, Neighbourhood};
use pc_model::{Assembly, Document, Model, Source};
use pc_print::integrals_of;
use pc_tests::fuzz::random::Random;

/// Values of the parameters: no short decimals.
const DRAWS: u64 = 3;

/// A system with integrals that are known from the literature.
struct Integrable {
    name: &'static str,
    text: String,
    degree: u32,
    functions: &'static [&'static str],
    known: &'static [&'static str],
}

fn model(parameters: &str, state: &str, lagrangian: &str) -> String {
    let section = |name: &str, entries: &str| {
        let lines = entries.split(';').map(|entry| match entry.trim().split_once('=') {
            Some((name, value)) => format!("\"{}\" = {}\n", name.trim(), value.trim()),
            None => String::new(),
        });
        format!("[{name}]\n{}\n", lines.collect::<String>())
    };
    let (coordinates, velocities) = state.split_once('|').unwrap();
    let parts = [
        section("parameters", parameters),
        section("coordinates", coordinates),
        section("quasi_velocities", velocities),
        format!("[lagrangian]\n{lagrangian}\n"),
    ];
    parts.concat()
}

const PLANE: &str = "x = 1.0; y = 0.2 | x' = 0.1; y' = 1.1";
const LINE: &str = "x = 0.1; y = 1.2; z = 2.9 | x' = 0.3; y' = 0.25; z' = 0.1";

/// A rigid body by the vertical γ and its angular velocity.
fn body(parameters: &str, lagrangian: &str) -> String {
    let state = "γ1 = 0.48; γ2 = 0.64; γ3 = 0.6 | ω1 = 0.3; ω2 = 0.4; ω3 = 1.7";
    let frame = "[kinematics]\n\"γ1\" = \"ω3*γ2 - ω2*γ3\"\n\"γ2\" = \"ω1*γ3 - ω3*γ1\"\n\
        \"γ3\" = \"ω2*γ1 - ω1*γ2\"\n[algebra]\nname = \"so3\"\n";
    model(parameters, state, lagrangian) + frame
}

fn systems() -> Vec<Integrable> {
    let system = |name, text, (degree, functions), known| Integrable { name, text, degree, functions, known };
    let quadratic: (u32, &'static [&'static str]) = (2, &[]);
    vec![
        system(
            "Kepler",
            model(
                "m = 2.0; k = 3.0",
                PLANE,
                "kinetic = \"m*(x'^2 + y'^2)/2\"\npotential = \"-k/sqrt(x^2 + y^2)\"",
            ),
            (2, &["1/sqrt(x^2 + y^2)"]),
            &[
                "x*y' - y*x'",
                "m*y'*(x*y' - y*x') - k*x/sqrt(x^2 + y^2)",
                "m*x'*(x*y' - y*x') + k*y/sqrt(x^2 + y^2)",
            ],
        ),
        system(
            "isotropic oscillator (Fradkin)",
            model(
                "m = 1.3; k = 0.7",
                PLANE,
                "kinetic = \"m*(x'^2 + y'^2)/2\"\npotential = \"k*(x^2 + y^2)/2\"",
            ),
            quadratic,
            &["x*y' - y*x'", "m*x'*y' + k*x*y", "m*x'^2 + k*x^2"],
        ),
        system(
            "two oscillators",
            model(
                "m = 1.3; k = 0.7; K = 1.9",
                PLANE,
                "kinetic = \"m*(x'^2 + y'^2)/2\"\npotential = \"(k*x^2 + K*y^2)/2\"",
            ),
            quadratic,
            &["m*x'^2 + k*x^2", "m*y'^2 + K*y^2"],
        ),
        system(
            "charge in a magnetic field",
            model("m = 1.3; B = 0.7", PLANE, "lagrangian = \"m*(x'^2 + y'^2)/2 + B*(x*y' - y*x')/2\""),
            quadratic,
            &["m*x' - B*y", "m*y' + B*x"],
        ),
        system(
            "Hénon and Heiles, the separable case",
            model(
                "a = 0.6; w = 1.1",
                PLANE,
                "kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"w*(x^2 + y^2)/2 + a*(x^2*y + y^3/3)\"",
            ),
            quadratic,
            &["x'*y' + w*x*y + a*(x^3/3 + x*y^2)"],
        ),
        system(
            "Garnier",
            model(
                "a = 1.1; b = 0.4; c = 0.3",
                PLANE,
                "kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"(a*x^2 + b*y^2 + c*(x^2 + y^2)^2)/2\"",
            ),
            quadratic,
            &["c*(x*y' - y*x')^2 + (b - a)*(x'^2 + a*x^2 + c*x^2*(x^2 + y^2))"],
        ),
        system(
            "spherical pendulum",
            model(
                "m = 1.5; l = 0.8; g = 9.81",
                "θ = 0.6; φ = 0.1 | θ' = 0.2; φ' = 3.0",
                "kinetic = \"m*l^2*(θ'^2 + φ'^2*sin(θ)^2)/2\"\npotential = \"-m*g*l*cos(θ)\"",
            ),
            quadratic,
            &["m*l^2*φ'*sin(θ)^2"],
        ),
        system(
            "Toda, three particles",
            model(
                "k = 1.2; b = 0.8; m = 1.5",
                LINE,
                "kinetic = \"m*(x'^2 + y'^2 + z'^2)/2\"\npotential = \"k*(exp(b*(x - y)) + exp(b*(y - z)))\"",
            ),
            (3, &["exp(b*(x - y))", "exp(b*(y - z))"]),
            &["x' + y' + z'", "m*x'*y'*z' - k*z'*exp(b*(x - y)) - k*x'*exp(b*(y - z))"],
        ),
        system(
            "Calogero and Moser, three particles",
            model(
                "g = 0.6; m = 1.1",
                LINE,
                "kinetic = \"m*(x'^2 + y'^2 + z'^2)/2\"\npotential = \"g*(1/(x - y)^2 + 1/(y - z)^2 + 1/(z - x)^2)\"",
            ),
            (3, &["1/(x - y)^2", "1/(y - z)^2", "1/(z - x)^2"]),
            &["x' + y' + z'", "m*x'*y'*z' - g*(x'/(y - z)^2 + y'/(z - x)^2 + z'/(x - y)^2)"],
        ),
        system(
            "Euler's top",
            body("A = 2.0; B = 1.5; C = 1.0", "kinetic = \"(A*ω1^2 + B*ω2^2 + C*ω3^2)/2\""),
            quadratic,
            &["A^2*ω1^2 + B^2*ω2^2 + C^2*ω3^2", "A*ω1*γ1 + B*ω2*γ2 + C*ω3*γ3", "γ1^2 + γ2^2 + γ3^2"],
        ),
        system(
            "Lagrange's top",
            body(
                "A = 2.0; C = 1.0; P = 0.7",
                "kinetic = \"(A*(ω1^2 + ω2^2) + C*ω3^2)/2\"\npotential = \"P*γ3\"",
            ),
            quadratic,
            &["ω3", "A*(ω1*γ1 + ω2*γ2) + C*ω3*γ3", "γ1^2 + γ2^2 + γ3^2"],
        ),
        system(
            "Kovalevskaya's top",
            body("C = 1.0; P = 0.7", "kinetic = \"C*(ω1^2 + ω2^2) + C*ω3^2/2\"\npotential = \"P*γ1\""),
            (4, &[]),
            &["(ω1^2 - ω2^2 - P*γ1/C)^2 + (2*ω1*ω2 - P*γ2/C)^2", "2*(ω1*γ1 + ω2*γ2) + ω3*γ3"],
        ),
    ]
}

/// The integrals of the model for the present values of its parameters.
fn list<'g>(system: &Integrable, model: &Model, assembly: &Assembly<'g>) -> Integrals<'g> {
    let equations = assembly.equations().unwrap();
    let centre = [assembly.at_start(), assembly.system.parameters().to_vec()].concat();
    let near = Neighbourhood { centre };
    let mut integrals = integrals_of(assembly, &equations, &near, false);
    let functions = system.functions.iter().map(|text| model.function(assembly, text).unwrap()).collect();
    let ansatz = PolynomialAnsatz { functions, ..PolynomialAnsatz::of_degree(system.degree) };
    integrals.add_polynomials(&equations, &near, &ansatz).unwrap();
    integrals
}

fn rank<'g>(graph: &'g Graph, functions: &[Expr<'g>], variables: &[Expr<'g>]) -> usize {
    let rows: Vec<Vec<Expr<'g>>> = functions.iter().map(|&f| graph.gradient(f, variables)).collect();
    graph.generic_rank(&rows)
}

/// Each integral as it is printed; every one is proved for all values of the parameters, and the known ones are functions of
/// them.
fn printed(system: &Integrable, model: &Model) -> Vec<String> {
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let found = list(system, model, &assembly);
    let values: Vec<Expr<'_>> = found.list().iter().map(|integral| integral.value).collect();
    let known = system.known.iter().map(|text| model.function(&assembly, text).unwrap());
    let variables = assembly.system.state();
    let all: Vec<Expr<'_>> = values.iter().copied().chain(known).collect();
    let ranks = (rank(&graph, &values, &variables), rank(&graph, &all, &variables));
    assert_eq!(ranks.0, ranks.1, "{}: a known integral is missing in {values:?}", system.name);
    let line = |integral: &Integral<'_>| {
        assert_eq!(integral.verdict, ConservationVerdict::Conserved, "{}: {integral:?}", system.name);
        format!("{}: {}", integral.name, integral.value)
    };
    found.list().iter().map(line).collect()
}

#[test]
fn known_integrals_are_found_for_all_values_of_the_parameters() {
    for system in systems() {
        let document = Document::parse(Source::new(system.name, &system.text)).unwrap();
        let mut model = Model::new(document);
        let first = printed(&system, &model);
        for draw in 0..DRAWS {
            let mut random = Random::new(39, draw);
            for (place, name) in model.parameter_names().into_iter().enumerate() {
                let value = match (draw, place) {
                    (0, 0) => std::f64::consts::PI,
                    (0, 1) => std::f64::consts::SQRT_2,
                    _ => random.number(0.3, 3.0),
                };
                model.set(&name, value).unwrap();
            }
            assert_eq!(printed(&system, &model), first, "{}: {:?}", system.name, model.parameter_values());
        }
    }
}
