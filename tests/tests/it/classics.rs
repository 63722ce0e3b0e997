//! The classics among the models that come with the program, against end states of another origin.

use pc_mech::Graph;
use pc_model::{Builtin, CLASSICS, Flow, Variables};
use pc_solve::{Method, Options, Solve, Trajectory};
use pc_tests::verified::derived_twice;

/// A model, a time, and its coordinates then.
type End = (&'static str, f64, &'static [(&'static str, f64)]);

/// The coordinates at a time, by Lagrange's equations with multipliers in ordinary velocities, whose derivatives were taken
/// by SymPy and which DOP853 of SciPy integrated at a relative tolerance of 1e-13; for the disk on bumps, by d'Alembert's principle
/// in φ' and θ' along the lowest point of the disk, (r² + I/m) θ'' = −g s − A s φ'², (s² + J/m) φ'' = s φ' (A θ' − s'), and Runge and
/// Kutta's method in 16000 steps.
#[rustfmt::skip]
const ENDS: &[End] = &[
    ("foucault-pendulum", 20.0, &[("x", -0.0006897492618959739), ("y", -0.098552658627297)]),
    ("kapitza-pendulum", 2.0, &[("θ", 3.0861183523510505)]),
    ("dumbbell-satellite", 20.0, &[("r", 1.1458095074296617), ("φ", 17.02573817504002), ("θ", -0.2584069085096964)]),
    ("three-bodies", 3.0, &[("x1", -0.8768206158633551), ("y1", -0.307702820131333), ("x2", 1.0310361271068025), ("y2", 0.16980960739141382), ("x3", -0.15421551124344918), ("y3", 0.13789321273991853)]),
    ("double-spherical-pendulum", 3.0, &[("α1", -0.38665300733473423), ("β1", 0.2000965034893132), ("α2", -0.183868379465737), ("β2", 0.10479244067077371)]),
    ("cart-pole", 3.0, &[("s", 0.01592239900407007), ("θ", 3.133614577520882)]),
    ("furuta-pendulum", 5.0, &[("φ", 5.857542690504715), ("θ", -1.1762149079664885)]),
    ("segway", 5.0, &[("x", 0.2891952623749605), ("y", 0.11025262540253508), ("ψ", 2.475486199820551), ("θ", -0.00028463609178407367), ("χ1", -2.020612985864924), ("χ2", 5.4058456135967425)]),
    ("roller-racer", 3.0, &[("x", 0.024329217729776125), ("y", -0.15563033533323328), ("ψ", -1.1437100807380278), ("φ", 2.2543888231127176)]),
    ("elroys-beanie", 20.0, &[("θ", 2.006639138000857), ("ψ", 1.1800825859974309)]),
    ("wilberforce-pendulum", 40.0, &[("z", 0.005071865116280571), ("θ", 5.000783054976064)]),
    ("rolling-spheroid", 3.0, &[("x", 0.03086158765028131), ("y", -0.24712989790016954), ("ψ", 6.309748330815815), ("θ", 1.5477062570496098), ("φ", 14.737751559284867)]),
    ("snake", 5.0, &[("x", -0.5422491828120953), ("y", -0.2748736203422358), ("ψ", 0.08504184762571884), ("α", 0.7677811803092635), ("β", 0.1722936087170385)]),
    ("quarter-car", 1.0, &[("z", -0.005652950178698861), ("w", -0.0010242891344591396)]),
    ("tractor-trailers", 5.0, &[("x", 3.1892630756198375), ("y", 3.151588488142291), ("δ", -0.490132952774586), ("ψ0", 0.6265083138337255), ("ψ1", 0.9745224832301183), ("ψ2", 0.9726723629901244)]),
    ("disk-on-bumps", 4.0, &[("fork_x", 3.876671904561), ("fork_y", 6.327500071904), ("fork_φ", 1.520706889176), ("post", 0.251009984113), ("wheel", 26.417954104846), ("street_x", 3.876641816759)]),
    ("swinging-atwood", 5.0, &[("r", 0.3233492102599241), ("θ", -2.4581879992899527)]),
];

/// Larger than the errors of both integrations, which a smaller tolerance changes by less than 1e-12.
const WITHIN: f64 = 1e-10;

fn motion(name: &str, times: &[f64]) -> (Vec<String>, Trajectory) {
    let model = derived_twice(Builtin::named(name).unwrap().document().unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap();
    let start = flow.start.clone();
    let options = Options::new(Method::Dop853).relative_tolerance(1e-12).absolute_tolerance(1e-14);
    let solve = Solve::new(&mut flow.motion, assembly.t_start, &start).method(&options);
    let solved = solve.events(&mut flow.events).run(times);
    let solved = solved.unwrap_or_else(|failure| panic!("{name}: {}", failure.error));
    (flow.names, solved.trajectory)
}

#[test]
fn they_arrive_where_another_derivation_does() {
    for &(name, t_end, state) in ENDS {
        let (names, trajectory) = motion(name, &[t_end]);
        let end = trajectory.state(trajectory.len() - 1);
        assert_eq!(names[..state.len()], state.iter().map(|of| of.0).collect::<Vec<_>>(), "{name}");
        for (found, (coordinate, expected)) in end.iter().zip(state) {
            let error = (found - expected).abs();
            assert!(
                error <= WITHIN * expected.abs().max(1.0),
                "{name}: {coordinate} = {found}, not {expected}"
            );
        }
    }
}

/// The bicycle and the rattleback, whose motions are tested with the mechanisms, have none here.
#[test]
fn each_of_them_has_an_end() {
    let mut with_ends: Vec<&str> = ENDS.iter().map(|end| end.0).collect();
    with_ends.extend(["whipple-bicycle", "rattleback"]);
    with_ends.sort_unstable();
    let mut classics: Vec<&str> = CLASSICS.iter().map(|classic| classic.name).collect();
    classics.sort_unstable();
    assert_eq!(classics, with_ends);
}

/// x + i y = e^(−i Ω t) (c₁ e^(i ν t) + c₂ e^(−i ν t)) with ν² = g/l + Ω², from rest at x = 0.1.
#[test]
fn the_plane_of_foucaults_pendulum_turns() {
    let rate = std::f64::consts::TAU / 60.0 * 0.85_f64.sin();
    let nu = (9.81 + rate * rate).sqrt();
    let times: Vec<f64> = (1..=40).map(|i| f64::from(i) * 0.5).collect();
    let (_, trajectory) = motion("foucault-pendulum", &times);
    let (forward, backward) = (0.05 * (1.0 + rate / nu), 0.05 * (1.0 - rate / nu));
    for (t, state) in trajectory.iter() {
        let x = forward * ((nu - rate) * t).cos() + backward * ((nu + rate) * t).cos();
        let y = forward * ((nu - rate) * t).sin() - backward * ((nu + rate) * t).sin();
        assert!(
            (state[0] - x).abs() < 1e-10 && (state[1] - y).abs() < 1e-10,
            "t = {t}: {state:?}, not {x}, {y}"
        );
    }
}

/// The figure of eight closes after its period, as well as the eight digits of its start let it, and each body is then where
/// the next was a third of the period before.
#[test]
fn three_bodies_chase_each_other() {
    let period = 6.325_913_98;
    let (_, trajectory) = motion("three-bodies", &[period / 3.0, period]);
    let (third, whole) = (trajectory.state(0), trajectory.state(1));
    let start = [0.970_004_36, -0.243_087_53, -0.970_004_36, 0.243_087_53, 0.0, 0.0];
    for i in 0..6 {
        assert!((whole[i] - start[i]).abs() < 1e-6, "{whole:?}");
        let next = (i + 2) % 6;
        let previous = (i + 4) % 6;
        let chased = (third[i] - start[next]).abs().min((third[i] - start[previous]).abs());
        assert!(chased < 1e-6, "{third:?}");
    }
}

/// Upright, it stays above the horizontal if its support shakes fast, and falls if it does not.
#[test]
fn kapitzas_pendulum_stands() {
    let times: Vec<f64> = (1..=200).map(|i| f64::from(i) * 0.05).collect();
    let (_, trajectory) = motion("kapitza-pendulum", &times);
    assert!(trajectory.iter().all(|(_, state)| (state[0] - std::f64::consts::PI).abs() < 0.6));
}
