//! Loops: against mechanisms whose constraints are written in angles, and their reactions against statics and Newton's law.

use pc_mech::VectorField;
use pc_model::{Builtin, Model};

use super::run::{Run, difference, document, flow, model};

const CRANK_ROCKER: &str = include_str!("../../../mechanisms/crank-rocker.toml");
const SLIDER_CRANK: &str = include_str!("../../../mechanisms/slider-crank.toml");

/// A motion of a mechanism that is sensitive to its errors: 1e-12 a step grow to 1e-8 in thousands of steps.
const APART: f64 = 1e-7;

#[test]
fn a_four_bar_moves_as_its_angles() {
    let tree = Run::of(&Model::new(Builtin::named("four-bar-loop").unwrap().document().unwrap()), 5.0, 1e-12);
    let angles = Run::of(&Model::new(document(CRANK_ROCKER)), 5.0, 1e-12);
    let coupler: Vec<f64> =
        tree.column("crank").iter().zip(tree.column("coupler")).map(|(a, b)| a + b).collect();
    for (one, two) in [(tree.column("crank"), "α"), (coupler, "β"), (tree.column("rocker"), "γ")] {
        let apart = difference(&one, &angles.column(two));
        assert!(apart < APART, "{two}: {apart}");
    }
    assert!(difference(&tree.column("energy"), &angles.column("energy")) < APART);
}

#[test]
fn a_slider_crank_moves_as_its_angles() {
    let loops = Builtin::named("slider-crank-loop").unwrap().document().unwrap();
    let tree = Run::of(&Model::new(loops), 5.0, 1e-12);
    let angles = Run::of(&Model::new(document(SLIDER_CRANK)), 5.0, 1e-12);
    assert!(difference(&tree.column("crank"), &angles.column("φ")) < APART);
    assert!(difference(&tree.column("slider"), &angles.column("x")) < APART);
    let rod: Vec<f64> = tree.column("crank").iter().zip(tree.column("rod")).map(|(a, b)| -(a + b)).collect();
    assert!(difference(&rod, &angles.column("ψ")) < APART);
}

/// A body held at one point swings as on a spherical joint there, and the loop says what the joint carries.
#[test]
fn a_point_that_is_held_is_a_spherical_joint() {
    const BODY: &str = "mass = 2.0\ninertia = [0.1, 0.2, 0.25]\n";
    let loops = format!(
        "[quasi_velocities]\n\"b_ω1\" = 1.0\n\"b_ω2\" = 0.5\n\"b_ω3\" = -0.3\n[gravity]\nacceleration = [0, 0, -9.81]\n\
         [coordinates]\nb_x = 0.3\nb_y = 0.1\nb_z = -0.4\n\
         [bodies.b]\njoint = {{ kind = \"free\" }}\n{BODY}\
         [loops.pin]\nkind = \"point\"\nbodies = [\"b\", \"world\"]\nat = [[-0.3, -0.1, 0.4], [0, 0, 0]]\n\
         [outputs]\nlx = \"λ_pin_1\"\nly = \"λ_pin_2\"\nlz = \"λ_pin_3\"\n\
         fx = \"F_pin_1_b_x\"\nfz = \"F_pin_3_b_z\"\n\
         ax = \"d(d(b_x))\"\nay = \"d(d(b_y))\"\naz = \"d(d(b_z))\"\n"
    );
    let tree = format!(
        "[quasi_velocities]\n\"b_ω1\" = 1.0\n\"b_ω2\" = 0.5\n\"b_ω3\" = -0.3\n[gravity]\nacceleration = [0, 0, -9.81]\n\
         [bodies.b]\njoint = {{ kind = \"spherical\" }}\ncenter = [0.3, 0.1, -0.4]\n{BODY}"
    );
    let (loops, tree) = (Run::of(&model(&loops), 2.0, 1e-11), Run::of(&model(&tree), 2.0, 1e-11));
    for name in ["b_q0", "b_q1", "b_q2", "b_q3", "b_ω1", "b_ω2", "b_ω3", "energy"] {
        let apart = difference(&loops.column(name), &tree.column(name));
        assert!(apart < 1e-8, "{name}: {apart}");
    }
    // Newton: λ = m (a − g), at the point held, which moves with the coordinates of the body.
    for (reaction, acceleration, weight) in [("lx", "ax", 0.0), ("ly", "ay", 0.0), ("lz", "az", 9.81)] {
        let expected: Vec<f64> = loops.column(acceleration).iter().map(|a| 2.0 * (a + weight)).collect();
        let apart = difference(&expected, &loops.column(reaction));
        assert!(apart < 1e-10, "{reaction}: {apart}");
    }
    assert!(difference(&loops.column("lx"), &loops.column("fx")) < 1e-12);
    assert!(difference(&loops.column("lz"), &loops.column("fz")) < 1e-12);
}

/// A rod between two carts on one rail keeps their distance; the reaction is twice the distance times the force along it.
#[test]
fn a_rod_keeps_a_distance() {
    let run = Run::of(
        &model(
            "[coordinates]\nb = 2.0\n[bodies.a]\njoint = { kind = \"prismatic\", axis = [1, 0, 0] }\nmass = 1.0\n\
             [bodies.b]\njoint = { kind = \"prismatic\", axis = [1, 0, 0] }\nmass = 3.0\n\
             [loops.rod]\nkind = \"rod\"\nbodies = [\"a\", \"b\"]\nat = [[0, 0, 0], [0, 0, 0]]\nlength = 2\n\
             [forces]\n\"a'\" = 4.0\n[outputs]\npush = \"-4*λ_rod_1\"\n",
        ),
        1.0,
        1e-10,
    );
    assert!(
        difference(&run.column("a"), &run.column("b").iter().map(|b| b - 2.0).collect::<Vec<_>>()) < 1e-9
    );
    // Both go at 4/(1 + 3), which takes 3 of the rod.
    assert!(
        run.column("push").iter().all(|push| (push.abs() - 3.0).abs() < 1e-9),
        "{:?}",
        run.column("push")
    );
}

/// The conditions of a platform hold to rounding along its motion, being projected to.
#[test]
fn six_loops_stay_closed() {
    let model = Model::new(Builtin::named("stewart-platform").unwrap().document().unwrap());
    let mut flow = flow(&model);
    let run = Run::of_flow(flow.clone(), 1.0, 1e-9);
    // The heave is that of a plate on a spring: by symmetry it stays level while it is pushed along x.
    assert!(run.column("plate_z").iter().all(|z| (0.9..1.01).contains(z)));
    let end = run.rows.last().unwrap();
    let components = flow.motion.dim();
    let mut state = end[..components].to_vec();
    let before = state.clone();
    flow.motion.project(1.0, &mut state).unwrap();
    // What is left to be projected away: rounding of lengths of 1.
    assert!(difference(&before, &state) < 1e-12, "{}", difference(&before, &state));
}
