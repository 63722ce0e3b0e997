//! The models of trees that come with the program.

use pc_mech::{Expr, Graph};
use pc_model::{Builtin, Flow, Model, TREES, Variables};
use pc_verify::{Options, Second, TOLERANCE, verify};

use super::run::{Run, difference};

fn model(name: &str) -> Model {
    Model::new(Builtin::named(name).unwrap().document().unwrap())
}

#[test]
fn all_are_derived_alike_by_both_routes() {
    for builtin in TREES.iter().filter(|builtin| builtin.name != "stewart-platform") {
        let model = model(builtin.name);
        let options = Options { states: 3, seed: 2, ..Options::default() };
        let agreement = model.derived(|assembly| verify(&model, assembly, &options));
        let agreement = agreement.unwrap_or_else(|error| panic!("{}: {error}", builtin.name));
        assert!(agreement.states >= 3 && agreement.error < TOLERANCE, "{}: {agreement}", builtin.name);
    }
    // All forms of this one take a minute: what is integrated, at the start.
    let model = model("stewart-platform");
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let second = Second::new(&model, &assembly).unwrap();
    let agreement = second.agrees("poincare", &flow, &assembly, 0.0, &flow.start).unwrap();
    assert!(agreement.states == 1 && agreement.error < TOLERANCE, "{agreement}");
}

/// Without dampers and motors: by the tolerance of the integration, 1e-10 a step, in thousands of steps.
#[test]
fn energy_is_kept_where_nothing_takes_it() {
    for (name, without, end) in [
        ("puma-560", &["c", "e"][..], 1.0),
        ("spatial-chain", &[], 1.0),
        ("four-bar-loop", &[], 3.0),
        ("slider-crank-loop", &[], 3.0),
        ("satellite", &["c", "M"], 20.0),
        ("quadruped", &["c"], 0.25),
        ("stewart-platform", &["c"], 0.5),
    ] {
        let mut model = model(name);
        without.iter().for_each(|parameter| model.set(parameter, 0.0).unwrap());
        let energy = Run::of(&model, end, 1e-10).column("energy");
        let moved = energy.iter().map(|e| (e - energy[0]).abs()).fold(0.0, f64::max);
        let size = energy.iter().map(|e| e.abs()).fold(1.0, f64::max);
        assert!(moved < 1e-7 * size, "{name}: {moved} of {size}");
    }
}

/// Momentum p and angular momentum about the origin, which no inner force changes: ∂L/∂v and ∂L/∂ω of the hull, taken to
/// axes of space.
#[test]
fn a_satellite_keeps_its_momentum_and_angular_momentum() {
    let model = model("satellite");
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let system = &assembly.system;
    let y = system.momenta();
    let q = graph.symbols(["hull_q0", "hull_q1", "hull_q2", "hull_q3"]);
    let x = graph.symbols(["hull_x", "hull_y", "hull_z"]);
    let p: Vec<Expr<'_>> = (0..3).map(|i| turned(q, [y[0], y[1], y[2]], i)).collect();
    let spin = (0..3).map(|i| {
        let (next, last) = ((i + 1) % 3, (i + 2) % 3);
        turned(q, [y[3], y[4], y[5]], i) + x[next] * p[last] - x[last] * p[next]
    });
    let kept: Vec<Expr<'_>> = p.iter().copied().chain(spin).collect();
    let mut at: Vec<(Expr<'_>, f64)> = system.parameters().to_vec();
    let flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let symbols = system.state();
    let run = Run::of_flow(flow, 20.0, 1e-11);
    let parameters = at.len();
    let mut values = run.rows.iter().map(|row| {
        at.truncate(parameters);
        at.extend(symbols.iter().copied().zip(row.iter().copied()));
        graph.evaluate(&kept, &at).unwrap()
    });
    let first = values.next().unwrap();
    // The hull, panels 1.6 from the middle, two wheels across their axes at 0.3, and one along its own.
    let moment = 140.0 + 24.0 * (5.0 / 12.0 + 1.6 * 1.6) + 2.0 * (0.03 + 4.0 * 0.09) + 0.05;
    assert!((first[5] - 0.02 * moment).abs() < 1e-13, "{first:?}");
    for now in values {
        // 1e-11 a step in a thousand steps, of momenta of 60 N m s.
        assert!(difference(&first, &now) < 1e-7, "{first:?}\n{now:?}");
    }
}

/// Component i of R v, by the entries of the rotation by a unit quaternion.
fn turned<'g>([a, b, c, d]: [Expr<'g>; 4], v: [Expr<'g>; 3], i: usize) -> Expr<'g> {
    let rows = [
        [Expr::ONE - (c * c + d * d) * 2.0, (b * c - a * d) * 2.0, (b * d + a * c) * 2.0],
        [(b * c + a * d) * 2.0, Expr::ONE - (b * b + d * d) * 2.0, (c * d - a * b) * 2.0],
        [(b * d - a * c) * 2.0, (c * d + a * b) * 2.0, Expr::ONE - (b * b + c * c) * 2.0],
    ];
    rows[i][0] * v[0] + rows[i][1] * v[1] + rows[i][2] * v[2]
}
