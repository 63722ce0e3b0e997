//! Pendulums in Cartesian coordinates, held by multipliers: right round, through the singular positions of every fixed
//! choice of independent velocities.

use pc_mech::{Constraint, Graph, Motion, System, VectorField};
use pc_solve::{Method, Options, solve};

const GRAVITY: f64 = 10.0;
const TOLERANCE: f64 = 1e-10;

/// Of squares of lengths of order one, projected at each output; the integration alone would leave them by 1e-7.
const ROUNDING: f64 = 1e-14;

/// An error of 1e-10 a step in an energy of order 100, in 10⁴ steps by Adams' methods and twice as many of BDF, whose
/// errors have one sign.
fn allowed_drift(method: Method) -> f64 {
    match method {
        Method::Adams | Method::Dop853 | Method::Taylor | Method::Auto => 1e-5,
        Method::Bdf => 2e-4,
    }
}

/// The spherical pendulum of unit length, z upwards.
fn spherical(graph: &Graph) -> Motion {
    let system = System::builder(graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0 - GRAVITY * x[2])
        .integral("moment", |_, x, v| x[0] * v[1] - x[1] * v[0])
        .build()
        .unwrap();
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let sphere = Constraint::new("length", x.square() + y.square() + z.square() - 1.0);
    system.with_multipliers(&[sphere]).unwrap().observe_reactions().compile().unwrap()
}

/// Two bobs of masses 1 and 2 on links of lengths 1 and 0.8.
fn double(graph: &Graph) -> Motion {
    let system = System::builder(graph)
        .coordinates(["x1", "y1", "x2", "y2"])
        .lagrangian(|_, x, v| {
            let kinetic = (v[0].square() + v[1].square()) / 2.0 + v[2].square() + v[3].square();
            kinetic - GRAVITY * (x[1] + 2.0 * x[3])
        })
        .build()
        .unwrap();
    let [x1, y1, x2, y2] = graph.symbols(["x1", "y1", "x2", "y2"]);
    let links = [
        Constraint::new("upper", x1.square() + y1.square() - 1.0),
        Constraint::new("lower", (x2 - x1).square() + (y2 - y1).square() - 0.64),
    ];
    system.with_multipliers(&links).unwrap().compile().unwrap()
}

fn options(method: Method) -> Options {
    Options::new(method).relative_tolerance(TOLERANCE).absolute_tolerance(TOLERANCE).max_steps(10_000_000)
}

/// What a motion of 100 time units has come to at 4000 times.
struct Outcome {
    /// The largest residual of a constraint on positions.
    residual: f64,
    /// The largest change of a conserved quantity.
    drift: f64,
    states: Vec<Vec<f64>>,
}

fn run(motion: &mut Motion, start: &[f64], method: Method) -> Outcome {
    let times: Vec<f64> = (0..=4000).map(|i| f64::from(i) / 40.0).collect();
    let trajectory = solve(&mut *motion, 0.0, start, &times, &options(method)).unwrap();
    let conserved = motion.conserved_len();
    let first = motion.observe(0.0, start);
    let mut outcome = Outcome { residual: 0.0, drift: 0.0, states: Vec::new() };
    for (t, y) in trajectory.iter() {
        let residuals = motion.constraint_residuals(t, y);
        outcome.residual = residuals.iter().fold(outcome.residual, |worst, r| worst.max(r.abs()));
        let now = motion.observe(t, y);
        outcome.drift = (0..conserved).fold(outcome.drift, |worst, i| worst.max((now[i] - first[i]).abs()));
        outcome.states.push(y.to_vec());
    }
    outcome
}

/// A function of the state.
type Function = fn(&[f64]) -> f64;

/// How often a function of the state changes its sign.
fn crossings(states: &[Vec<f64>], f: impl Fn(&[f64]) -> f64) -> usize {
    states.windows(2).filter(|pair| f(&pair[0]) * f(&pair[1]) < 0.0).count()
}

/// A choice of two independent velocities of three is singular where the third coordinate vanishes: the motion passes
/// all three many times.
#[test]
fn a_spherical_pendulum_goes_right_round() {
    for method in [Method::Adams, Method::Bdf, Method::Dop853] {
        let graph = Graph::new();
        let start = [0.6, 0.0, -0.8, 4.0, 2.0, 3.0];
        let outcome = run(&mut spherical(&graph), &start, method);
        for i in 0..3 {
            let passed = crossings(&outcome.states, |y| y[i]);
            assert!(passed > 50, "{method:?}: coordinate {i} changes its sign {passed} times");
        }
        assert!(outcome.residual < ROUNDING, "{method:?}: residual {:e}", outcome.residual);
        assert!(outcome.drift < allowed_drift(method), "{method:?}: drift {:e}", outcome.drift);
    }
}

/// The velocity of a bob is determined by its horizontal part unless the link is horizontal, by its vertical part unless
/// it is vertical.
#[test]
fn a_double_pendulum_goes_right_round() {
    for method in [Method::Adams, Method::Bdf, Method::Dop853] {
        let graph = Graph::new();
        // Both links horizontal, the upper turning at the rate 8, the lower at 2.
        let start = [1.0, 0.0, 1.8, 0.0, 0.0, 8.0, 0.0, 9.6];
        let outcome = run(&mut double(&graph), &start, method);
        let choices: [(&str, Function); 4] =
            [("x1", |y| y[0]), ("y1", |y| y[1]), ("x2 - x1", |y| y[2] - y[0]), ("y2 - y1", |y| y[3] - y[1])];
        for (name, f) in choices {
            let passed = crossings(&outcome.states, f);
            assert!(passed > 50, "{method:?}: {name} changes its sign {passed} times");
        }
        assert!(outcome.residual < ROUNDING, "{method:?}: residual {:e}", outcome.residual);
        assert!(outcome.drift < allowed_drift(method), "{method:?}: drift {:e}", outcome.drift);
    }
}

/// End states of the equations in independent velocities, from an integration in arithmetic of 34 digits.
#[test]
fn end_states_are_those_of_independent_velocities() {
    let graph = Graph::new();
    // x, y, z, ẋ, ẏ at t = 3
    let expected = [
        -0.3772148967129942,
        -0.4542546847935442,
        -0.8070697634287403,
        1.038123256567866,
        -1.135765451057696,
    ];
    let mut motion = spherical(&graph);
    let options = Options::new(Method::Adams).relative_tolerance(1e-12).absolute_tolerance(1e-13);
    let end = solve(&mut motion, 0.0, &[0.6, 0.0, -0.8, 0.0, 1.5, 0.0], &[3.0], &options).unwrap();
    for (found, expected) in end.state(0).iter().zip(expected) {
        assert!((found - expected).abs() < 1e-8, "{found} instead of {expected}");
    }

    // x1, y1, x2, y2, ẋ1, ẋ2 at t = 2; small changes of the start grow 40 times
    let (start, expected) = double_reference();
    let end = solve(double(&graph), 0.0, &start, &[2.0], &options).unwrap();
    let y = end.state(0);
    for (found, expected) in [y[0], y[1], y[2], y[3], y[4], y[6]].iter().zip(expected) {
        assert!((found - expected).abs() < 1e-8, "{found} instead of {expected}");
    }
}

/// From angles (0.5, −0.4) with rates (0.3, −0.2).
fn double_reference() -> ([f64; 8], [f64; 6]) {
    let bob = |angle: f64, rate: f64, l: f64| {
        let (s, c) = angle.sin_cos();
        ([l * s, -l * c], [l * c * rate, l * s * rate])
    };
    let (r1, v1) = bob(0.5, 0.3, 1.0);
    let (r2, v2) = bob(-0.4, -0.2, 0.8);
    let start = [r1[0], r1[1], r1[0] + r2[0], r1[1] + r2[1], v1[0], v1[1], v1[0] + v2[0], v1[1] + v2[1]];
    let end = [
        0.1075973531859469,
        -0.994194553187342,
        -0.003406053713783327,
        -1.786456027485224,
        2.882067093982383,
        0.04105203743530662,
    ];
    (start, end)
}

/// The force of the sphere is λ r, λ = (g z − |ṙ|²)/|r|²; the multiplier belongs to |r|² − 1, whose gradient is 2 r.
#[test]
fn the_reaction_is_the_force_of_the_rod() {
    let graph = Graph::new();
    let mut motion = spherical(&graph);
    let y = [0.6, 0.0, -0.8, 1.0, 1.5, 0.75];
    let observed = motion.observe(0.0, &y);
    let place = motion.observable_names().iter().position(|name| name == "λ_length").unwrap();
    let speed = 1.0 + 2.25 + 0.5625;
    assert!((2.0 * observed[place] - (GRAVITY * -0.8 - speed)).abs() < 1e-14);
    let mut rates = [0.0; 6];
    motion.rhs(0.0, &y, &mut rates).unwrap();
    let pull = 2.0 * observed[place];
    for (rate, expected) in rates[3..].iter().zip([pull * 0.6, 0.0, pull * -0.8 - GRAVITY]) {
        assert!((rate - expected).abs() < 1e-14);
    }
}
