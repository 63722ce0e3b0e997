//! Both derivations speak of one energy: y·η − L of the velocities whose equations are solved.

use pc_mech::Graph;
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_verify::{Options, Second, verify};

/// The energy at the start in the forms that are integrated, compared there and at random states.
fn energy(text: &str) -> f64 {
    let (graph, model) =
        (Graph::new(), Model::new(Document::parse(Source::new("model.toml", text)).unwrap()));
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{text}: {error}"));
    let second = Second::new(&model, &assembly).unwrap();
    let agreement =
        model.derived(|assembly| verify(&model, assembly, &Options { states: 20, ..Options::default() }));
    assert_eq!(agreement.unwrap_or_else(|error| panic!("{text}: {error}")).states, 20);
    let in_form = |variables: Variables| {
        let mut flow = Flow::new(&model, &assembly, variables).unwrap();
        let start = flow.start.clone();
        let found = second.agrees(variables.name(), &flow, &assembly, assembly.t_start, &start);
        found.unwrap_or_else(|error| panic!("{text}: {error}"));
        let place = flow.motion.observable_names().iter().position(|name| name == "energy");
        place.map(|place| flow.motion.observe(assembly.t_start, &start)[place])
    };
    let energy = in_form(Variables::QuasiVelocities).unwrap();
    // Momenta are those of independent velocities, and have the energy of these.
    in_form(Variables::Momenta);
    energy
}

/// A mass of 1 in the plane with the potential 0.7 y, at t = 0.4, x = 0.5, y = 0.3, x' = 0.6. The constraint gives
/// y' = a x' + b. With multipliers the energy is (x'² + y'²)/2 + 0.7 y, in the velocity x' alone that of Jacobi,
/// (1 + a²) x'²/2 − b²/2 + 0.7 y, to a dozen roundings.
#[test]
fn energies_under_moving_constraints() {
    let constraints = [
        ("y' - x", 0.0, 0.5),
        ("y' - t/2", 0.0, 0.2),
        ("y' - x*x' - t", 0.5, 0.4),
        ("3*(y' - x') + 1", 1.0, -1.0 / 3.0),
        ("y - 0.1 - t/2", 0.0, 0.5),
        ("y - x^2 - t/8", 1.0, 0.125),
        ("y' - x*x'", 0.5, 0.0),
    ];
    for (constraint, a, b) in constraints {
        let position = 0.7 * 0.3;
        let rate = a * 0.6 + b;
        let of_all = (0.36 + rate * rate) / 2.0 + position;
        let of_independent = ((1.0 + a * a) * 0.36 - b * b) / 2.0 + position;
        let ordinary = "\"x'\" = 0.6";
        let named = "w = { is = \"x'\", start = 0.6 }";
        let is_on_positions = !constraint.contains("y'");
        // A constraint on velocities completes the quasi-velocities that are defined, and one on positions has a multiplier.
        let by_definition = if is_on_positions { of_all } else { of_independent };
        let cases = [
            (ordinary, "", of_all),
            (ordinary, "independent = [\"x'\"]\n", of_independent),
            (named, "", by_definition),
        ];
        for (velocities, independent, expected) in cases {
            let found = energy(&format!(
                "[coordinates]\nx = 0.5\ny = 0.3\n[quasi_velocities]\n{velocities}\n[constraints]\nc = \"{constraint}\"\n\
                 [lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"0.7*y\"\n\
                 [simulation]\nt_start = 0.4\nt_end = 1\n{independent}"
            ));
            assert!(
                (found - expected).abs() < 1e-14,
                "{constraint}, {velocities}, {independent}: {found} for {expected}"
            );
        }
    }
}
