//! Loops closed after the joints are eliminated, S = C M⁻¹ Cᵀ: against the mass matrix bordered by C, and their reactions against
//! Newton's and Euler's equations by hand.

use pc_mech::{CompileOptions, Motion, TreeElimination, VectorField};
use pc_model::{Builtin, Document, Model};

use super::run::{Run, difference, document, flow, rates};

const SQUEEZER: &str = include_str!("../../../mechanisms/squeezer.toml");
const SQUEEZER_LOOP: &str = include_str!("../../../mechanisms/squeezer-loop.toml");

fn builtin(name: &str) -> Document {
    Builtin::named(name).unwrap().document().unwrap()
}

/// The motion with loops joint after joint, with the whole matrix, and with what is shorter.
fn eliminations(model: &Model) -> ([Motion; 3], Vec<f64>) {
    let graph = model.graph();
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    let held = assembly.constraints.held().unwrap();
    let compiled = |elimination| {
        let options = CompileOptions::default().jacobian(false).elimination(elimination);
        held.compile_for(options).unwrap()
    };
    let all = [TreeElimination::ByJoints, TreeElimination::Whole, TreeElimination::Shorter].map(compiled);
    (all, assembly.start.clone())
}

/// A chain of links on alternating axes whose tip is held where it is at the start.
fn closed_chain(links: usize) -> Document {
    let mut text = "[gravity]\nacceleration = [0.3, 0, -9.81]\n[coordinates]\n".to_owned();
    let angle = |i: usize| 0.3 * (1.7 * i as f64).sin();
    (0..links).for_each(|i| text += &format!("q{i} = {}\n", angle(i)));
    for i in 0..links {
        let parent = if i == 0 { String::new() } else { format!("parent = \"q{}\"\n", i - 1) };
        let axis = if i % 2 == 0 { "[1, 0, 0]" } else { "[0, 1, 0]" };
        let at = if i == 0 { "[0, 0, 0]" } else { "[0, 0.1, -1]" };
        text += &format!(
            "[bodies.q{i}]\n{parent}joint = {{ kind = \"revolute\", axis = {axis}, at = {at} }}\nmass = 1\n\
             center = [0, 0, -0.5]\ninertia = [0.1, 0.12, 0.05]\n"
        );
    }
    text += &format!("[points.tip]\nbody = \"q{}\"\nat = [0, 0, -1]\n", links - 1);
    // Where the tip is, the model says itself.
    let open =
        Model::new(document(&format!("{text}[outputs]\nx = \"tip_x\"\ny = \"tip_y\"\nz = \"tip_z\"\n")));
    let mut flow = flow(&open);
    let start = flow.start.clone();
    let row = flow.row(0.0, &start);
    let tip = &row[row.len() - 3..];
    text += &format!(
        "[loops.hold]\nkind = \"point\"\nbodies = [\"q{}\", \"world\"]\nat = [[0, 0, -1], [{:?}, {:?}, {:?}]]\n",
        links - 1,
        tip[0],
        tip[1],
        tip[2]
    );
    document(&text)
}

/// Along the first half second, by the classical method of order four with projection to the loops.
#[test]
fn loops_joint_after_joint_are_those_of_the_bordered_matrix() {
    let models = [
        ("four-bar", builtin("four-bar-loop")),
        ("slider-crank", builtin("slider-crank-loop")),
        ("Stewart's platform", builtin("stewart-platform")),
        ("squeezer", document(SQUEEZER_LOOP)),
        ("chain of 6", closed_chain(6)),
        ("chain of 14", closed_chain(14)),
    ];
    for (name, document) in models {
        let ([mut joints, mut whole, mut shorter], mut y) = eliminations(&Model::new(document));
        let step = if name == "squeezer" { 1e-4 } else { 0.02 };
        let mut is_another_way = false;
        for i in 0..25 {
            let t = step * f64::from(i);
            whole.project(t, &mut y).unwrap();
            let expected = whole.rates(t, &y).unwrap();
            let size = expected.iter().fold(1.0f64, |size, x| size.max(x.abs()));
            for (how, motion) in [("by joints", &mut joints), ("shorter", &mut shorter)] {
                let found = motion.rates(t, &y).unwrap();
                let error =
                    found.iter().zip(&expected).fold(0.0f64, |error, (a, b)| error.max((a - b).abs()));
                // Where S keeps 1e-4 of its diagonal, rounding times 1e4 and the condition of M of some hundreds.
                assert!(error < 1e-10 * size, "{name}, {how}, t = {t}: {error:e} of {size:e}");
                is_another_way |= how == "by joints" && error > 0.0;
            }
            let ahead = |k: &[f64], h: f64| y.iter().zip(k).map(|(y, k)| y + h * k).collect::<Vec<_>>();
            let k1 = expected;
            let k2 = joints.rates(t, &ahead(&k1, step / 2.0)).unwrap();
            let k3 = joints.rates(t, &ahead(&k2, step / 2.0)).unwrap();
            let k4 = joints.rates(t, &ahead(&k3, step)).unwrap();
            for (i, y) in y.iter_mut().enumerate() {
                *y += step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        assert!(is_another_way, "{name}: the same numbers to the last bit");
    }
}

#[test]
fn loops_stay_closed_for_ten_seconds() {
    for name in ["four-bar-loop", "slider-crank-loop", "stewart-platform"] {
        let mut flow = flow(&Model::new(builtin(name)));
        let run = Run::of_flow(flow.clone(), 10.0, 1e-9);
        let components = flow.motion.dim();
        for row in &run.rows {
            let residuals = flow.constraint_residuals(0.0, &row[..components]);
            let worst = residuals.iter().fold(0.0f64, |worst, residual| worst.max(residual.abs()));
            assert!(worst < 1e-12, "{name}: {worst:e}");
        }
    }
}

/// The force in the pin of the four-bar: of the rocker by Euler's equation about its bearing; of the coupler by Newton's and Euler's,
/// with the force of the crank on it eliminated. The crank, which was not used, is in balance with that.
#[test]
fn the_pin_of_a_four_bar_carries_what_newton_and_euler_say() {
    let (a, l, c, weight) = (1.0f64, 3.0f64, 2.5f64, 2.0);
    let mut flow = flow(&Model::new(builtin("four-bar-loop")));
    let run = Run::of_flow(flow.clone(), 3.0, 1e-10);
    let (force_x, force_y) = (run.column("force_x"), run.column("force_y"));
    for (i, row) in run.rows.iter().enumerate() {
        let state = &row[..flow.motion.dim()];
        let rates = rates(&mut flow, 0.0, state);
        let (alpha, beta, gamma) = (state[0], state[0] + state[1], state[2]);
        let (v_alpha, v_beta) = (state[3], state[3] + state[4]);
        let (a_alpha, a_beta, a_gamma) = (rates[3], rates[3] + rates[4], rates[5]);
        // r″ of a point at a distance along a turning line
        let carried = |r: f64, angle: f64, v: f64, a: f64| {
            let (sin, cos) = angle.sin_cos();
            [r * (-cos * v * v - sin * a), r * (-sin * v * v + cos * a)]
        };
        let (joint, arm) = (carried(a, alpha, v_alpha, a_alpha), carried(l / 2.0, beta, v_beta, a_beta));
        // The force of the crank is l (a_c + weight) - F; the moments of both about the mass centre give u × F.
        let whole = [l * (joint[0] + arm[0]), l * (joint[1] + arm[1] + weight)];
        let across = |angle: f64, f: [f64; 2]| angle.cos() * f[1] - angle.sin() * f[0];
        // (l³/12) β″ = (l/2) u × (F - (whole - F)) = l u × F - (l/2) u × whole
        let of_coupler = (l.powi(3) / 12.0 * a_beta + l / 2.0 * across(beta, whole)) / l;
        // (c³/3) γ″ = -c u × F - weight c²/2 cos γ
        let of_rocker = -(c.powi(3) / 3.0 * a_gamma + weight * c * c / 2.0 * gamma.cos()) / c;
        let determinant = (gamma - beta).sin();
        // u_β × F and u_γ × F give F.
        let f = [
            (of_coupler * gamma.cos() - of_rocker * beta.cos()) / determinant,
            (of_coupler * gamma.sin() - of_rocker * beta.sin()) / determinant,
        ];
        let size = f[0].abs().max(f[1].abs()).max(1.0);
        let apart = (f[0] - force_x[i]).abs().max((f[1] - force_y[i]).abs()) / size;
        assert!(apart < 1e-10, "{i}: {f:?} {} {}", force_x[i], force_y[i]);
        let crank = [whole[0] - f[0], whole[1] - f[1]];
        let left = a.powi(3) / 3.0 * a_alpha + a * across(alpha, crank) + weight * a * a / 2.0 * alpha.cos();
        assert!(left.abs() < 1e-10 * size, "{i}: {left}");
    }
}

#[test]
fn a_squeezer_of_joints_and_loops_moves_as_its_angles() {
    let loops = Run::of(&Model::new(document(SQUEEZER_LOOP)), 0.03, 1e-12);
    let angles = Run::of(&Model::new(document(SQUEEZER)), 0.03, 1e-12);
    for (joint, angle) in
        [("K1", "β"), ("K2", "Θ"), ("K3", "γ"), ("K4", "Φ"), ("K5", "δ"), ("K6", "Ω"), ("K7", "ε")]
    {
        let apart = difference(&loops.column(joint), &angles.column(angle));
        // 1e-12 a step in a thousand steps, relative to angles up to 16.
        assert!(apart < 1e-9, "{joint}: {apart:e}");
    }
}
