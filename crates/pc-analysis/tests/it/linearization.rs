//! Linearizations against closed forms.

use pc_analysis::{
    AnalysisError, CyclicCoordinates, Leaf, Linearization, Linearizer, NoSecondOrder, SteadyOptions, Verdict,
};
use pc_mech::{Constraint, Graph, LieAlgebra, Matrix, System};

/// Newton's method ends at rounding, and so do some ten operations on numbers up to some tens.
const EXACT: f64 = 1e-13;

#[track_caller]
fn near(system: &System<'_>, start: &[f64], inputs: &[&str]) -> Linearization {
    let mut linearizer = Linearizer::new(&system.poincare().unwrap(), &Leaf::of(system), inputs).unwrap();
    linearizer.steady(0.0, start, &SteadyOptions::default()).unwrap()
}

#[track_caller]
fn assert_near(found: &Matrix<f64>, expected: &[&[f64]]) {
    assert_eq!(found.rows(), expected.len());
    for (i, row) in expected.iter().enumerate() {
        assert_eq!(found.columns(), row.len());
        for (j, expected) in row.iter().enumerate() {
            let error = (found[(i, j)] - expected).abs();
            assert!(error <= EXACT * expected.abs().max(1.0), "({i}, {j}): {} for {expected}", found[(i, j)]);
        }
    }
}

fn frequencies(linear: &Linearization) -> Vec<f64> {
    let all = linear.spectrum.eigenvalues().iter();
    let mut found: Vec<f64> = all.map(|l| l.imaginary).filter(|imaginary| *imaginary > 0.0).collect();
    found.sort_by(f64::total_cmp);
    found
}

/// ω² = (g/l)(2 ± √2) for equal masses and lengths.
#[test]
fn a_double_pendulum_has_two_frequencies() {
    let graph = Graph::new();
    let (g, l) = (9.81, 0.7);
    let pendulum = System::builder(&graph)
        .coordinates(["θ1", "θ2"])
        .lagrangian(|_, x, v| {
            let kinetic = v[0].square() + v[1].square() / 2.0 + v[0] * v[1] * (x[0] - x[1]).cos();
            l * l * kinetic + g * l * (2.0 * x[0].cos() + x[1].cos())
        })
        .build()
        .unwrap();
    let linear = near(&pendulum, &[0.2, -0.3, 0.1, 0.0], &[]);
    let expected = [2.0 - 2f64.sqrt(), 2.0 + 2f64.sqrt()].map(|factor| (g / l * factor).sqrt());
    for (found, expected) in frequencies(&linear).iter().zip(expected) {
        assert!((found - expected).abs() < EXACT * expected, "{found} {expected}");
    }
    assert_eq!(linear.components, ["θ1", "θ2", "θ1'", "θ2'"]);
    let second = linear.second_order.as_ref().unwrap();
    assert_near(&second.mass, &[&[2.0 * l * l, l * l], &[l * l, l * l]]);
    assert_near(&second.stiffness, &[&[2.0 * g * l, 0.0], &[0.0, g * l]]);
    assert_near(&second.velocity, &[&[0.0, 0.0], &[0.0, 0.0]]);
    // In the slow mode the lower bob swings √2 times as far.
    let slow =
        linear.modes.iter().find(|mode| (mode.eigenvalue.imaginary - expected[0]).abs() < 1e-9).unwrap();
    let v = slow.vector.as_ref().unwrap();
    let ratio = (v[1].0 * v[0].0 + v[1].1 * v[0].1) / (v[0].0.powi(2) + v[0].1.powi(2));
    assert!((ratio - 2f64.sqrt()).abs() < 1e-12, "{ratio}");
    assert!(linear.modes.iter().all(|mode| residual(&linear.state_matrix, mode) < 1e-12), "A v = λ v");
}

/// |A v − λ v|
fn residual(a: &Matrix<f64>, mode: &pc_analysis::Mode) -> f64 {
    let (v, (re, im)) = (mode.vector.as_ref().unwrap(), (mode.eigenvalue.real, mode.eigenvalue.imaginary));
    let row = |i: usize| {
        let sum = |part: fn(&(f64, f64)) -> f64| (0..v.len()).map(|j| a[(i, j)] * part(&v[j])).sum::<f64>();
        let (own_re, own_im) = (re * v[i].0 - im * v[i].1, re * v[i].1 + im * v[i].0);
        (sum(|x| x.0) - own_re).hypot(sum(|x| x.1) - own_im)
    };
    (0..v.len()).map(row).fold(0.0, f64::max)
}

fn cart<'g>(graph: &'g Graph) -> System<'g> {
    let (cart, bob, g, l, friction) = (2.0, 0.5, 9.81, 0.8, 0.3);
    let f = graph.symbol("f");
    System::builder(graph)
        .parameter(f, 0.0)
        .coordinates(["x", "θ"])
        .lagrangian(|_, x, v| {
            (cart + bob) * v[0].square() / 2.0
                + bob * l * v[0] * v[1] * x[1].cos()
                + bob * l * l * v[1].square() / 2.0
                - bob * g * l * x[1].cos()
        })
        .dissipation(|_, _, v| friction * v[0].square() / 2.0)
        .forces(|_, _, _| [f, 0.0.into()])
        .output("tip", |_, x, _| x[0] + l * x[1].sin())
        .output("angle", |_, x, _| x[1])
        .build()
        .unwrap()
}

/// A and B of the inverted pendulum on a cart, as in books on control: at an equilibrium, x is a component on
/// request.
#[test]
fn a_pole_on_a_cart() {
    let graph = Graph::new();
    let system = cart(&graph);
    let mut linearizer = Linearizer::new(&system.poincare().unwrap(), &Leaf::of(&system), &["f"]).unwrap();
    let (cart, bob, g, l, friction) = (2.0, 0.5, 9.81, 0.8, 0.3);
    let start = [0.4, 0.1, 0.0, 0.0];
    let options = SteadyOptions::default().fixed(["x'"]);
    let linear = linearizer.steady_with(0.0, &start, &options, CyclicCoordinates::KeptAtRest).unwrap();
    assert_eq!(linear.components, ["x", "θ", "x'", "θ'"]);
    assert_eq!(linear.state[0], ("x".to_owned(), 0.4));
    let pole = g * (cart + bob) / (cart * l);
    assert_near(
        &linear.state_matrix,
        &[
            &[0.0, 0.0, 1.0, 0.0],
            &[0.0, 0.0, 0.0, 1.0],
            &[0.0, -bob * g / cart, -friction / cart, 0.0],
            &[0.0, pole, friction / (cart * l), 0.0],
        ],
    );
    assert_near(&linear.input_matrix, &[&[0.0], &[0.0], &[1.0 / cart], &[-1.0 / (cart * l)]]);
    assert_near(&linear.output_matrix, &[&[1.0, l, 0.0, 0.0], &[0.0, 1.0, 0.0, 0.0]]);
    assert_near(&linear.feedthrough, &[&[0.0], &[0.0]]);
    assert_eq!(linear.spectrum.verdict(), Verdict::Unstable);
    let second = linear.second_order.unwrap();
    assert_eq!(second.coordinates, ["x", "θ"]);
    assert_near(&second.mass, &[&[cart + bob, bob * l], &[bob * l, bob * l * l]]);
    assert_near(&second.velocity, &[&[friction, 0.0], &[0.0, 0.0]]);
    assert_near(&second.stiffness, &[&[0.0, 0.0], &[0.0, -bob * g * l]]);
    assert_near(&second.input, &[&[1.0], &[0.0]]);

    // Outputs cannot contain x if it is left out, and the matrices of the second order are the same.
    let reduced = linearizer.steady(0.0, &start, &options).unwrap();
    assert_eq!((reduced.components.len(), reduced.cyclic), (3, vec![("x".to_owned(), 0.0)]));
    assert_eq!((reduced.outputs, reduced.other_outputs), (vec!["angle".to_owned()], vec!["tip".to_owned()]));
    assert_eq!(reduced.second_order.unwrap().coordinates, second.coordinates);
}

/// δh of an output with accelerations, such as that of an accelerometer on the cart.
#[test]
fn accelerations_in_outputs_are_those_of_the_motion() {
    let graph = Graph::new();
    let f = graph.symbol("f");
    let block = System::builder(&graph)
        .parameter(f, 0.0)
        .coordinates(["x"])
        .lagrangian(|_, x, v| v[0].square() - 3.0 * x[0].square())
        .forces(|_, _, _| [f])
        .output("a", |_, x, _| graph.symbol("x''") * 2.0 + x[0])
        .build()
        .unwrap();
    let linear = near(&block, &[0.0, 0.0], &["f"]);
    assert_near(&linear.output_matrix, &[&[-5.0, 0.0]]);
    assert_near(&linear.feedthrough, &[&[1.0]]);
}

/// A particle on a table that turns: M q̈ + 2Ω J q̇ + (k − Ω²) q, G skew.
#[test]
fn gyroscopic_forces_are_skew() {
    let graph = Graph::new();
    let turn = 0.7;
    let particle = System::builder(&graph)
        .coordinates(["X", "Y"])
        .lagrangian(|_, x, v| {
            let (u, w) = (v[0] - turn * x[1], v[1] + turn * x[0]);
            (u.square() + w.square() - x[0].square() - 4.0 * x[1].square()) / 2.0
        })
        .build()
        .unwrap();
    let second = near(&particle, &[0.3, 0.1, 0.0, 0.2], &[]).second_order.unwrap();
    assert_near(&second.velocity, &[&[0.0, -2.0 * turn], &[2.0 * turn, 0.0]]);
    assert_near(&second.stiffness, &[&[1.0 - turn * turn, 0.0], &[0.0, 4.0 - turn * turn]]);
}

/// The sleeping top in γ, which moves on a sphere: with γ = γ1 + iγ2 and w = ω1 + iω2, γ̇ = −iωγ + iw and ẇ =
/// −iωw/2 − iγ, so (λ + iω)(λ + iω/2) = 1: growth by √(1 − ω²/16), below ω = 4.
#[test]
fn a_sleeping_top_is_linearized_on_its_sphere() {
    let graph = Graph::new();
    let top = System::builder(&graph)
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| (w[0].square() + w[1].square() + w[2].square() / 2.0) / 2.0 - g[2])
        .build()
        .unwrap();
    let equations = top.poincare().unwrap();
    let [g1, g2, g3] = graph.symbols(["γ1", "γ2", "γ3"]);
    let sphere = g1.square() + g2.square() + g3.square();
    let leaf = Leaf { kept: vec![sphere], ..Leaf::of(&top) };
    assert_eq!(leaf.codimension(), 1);
    for spin in [3.0, 5.0] {
        let mut linearizer = Linearizer::new(&equations, &leaf, &[]).unwrap();
        let start = [0.02, 0.0, (1.0f64 - 0.0004).sqrt(), 0.0, 0.0, spin];
        let linear = linearizer.steady(0.0, &start, &SteadyOptions::default().fixed(["ω3"])).unwrap();
        assert_eq!(linear.components, ["γ1", "γ2", "ω1", "ω2", "ω3"]);
        let found: Vec<f64> = linear.spectrum.eigenvalues().iter().map(|l| l.real).collect();
        let growth = (1.0 - spin * spin / 16.0f64).max(0.0).sqrt();
        // Eigenvalues are simple, and so known to some roundings.
        assert!((found[0] - growth).abs() < 1e-12, "{found:?} {growth}");
        assert_eq!(
            linear.second_order,
            Err(NoSecondOrder::TooFewCoordinates { coordinates: 2, velocities: 3 })
        );
    }
    // Without the equation of the sphere, only a start that is itself steady gives a result.
    let mut blind = Linearizer::new(&equations, &Leaf::of(&top), &[]).unwrap();
    let away = blind.steady(0.0, &[0.6, 0.0, 0.8, 0.1, 0.0, 1.0], &SteadyOptions::default());
    assert!(matches!(away, Err(AnalysisError::LeafUnknown { .. })), "{away:?}");
    let upright = blind.steady(0.0, &[0.0, 0.0, 1.0, 0.0, 0.0, 5.0], &SteadyOptions::default()).unwrap();
    assert_eq!(upright.components.len(), 5);
}

/// The upright rolling disk: λ² = [mgr − C(C + mr²)Ω²/A]/(A + mr²), without heading and place; equations of
/// the second order in tilt, heading and roll.
#[test]
fn a_disk_that_rolls_straight() {
    let graph = Graph::new();
    let (m, r, g, a, c) = (1.0, 1.0, 10.0, 0.25, 0.5);
    let disk = System::builder(&graph)
        .coordinates(["X", "Y", "ψ", "θ", "φ"])
        .quasi_velocities(["ω1", "ω2", "ω3", "u", "v"])
        .kinematics(|_, x, w| {
            let turn = w[1] / x[3].sin();
            let roll = w[2] - turn * x[3].cos();
            let ahead = w[3] - r * roll;
            [ahead * x[2].cos() - w[4] * x[2].sin(), ahead * x[2].sin() + w[4] * x[2].cos(), turn, w[0], roll]
        })
        .lagrangian(|_, x, w| {
            m * ((w[3] - r * w[2]).square()
                + (w[4] * x[3].cos()).square()
                + (r * w[0] - w[4] * x[3].sin()).square())
                / 2.0
                + a * (w[0].square() + w[1].square()) / 2.0
                + c * w[2].square() / 2.0
                - m * g * r * x[3].sin()
        })
        .build()
        .unwrap();
    let equations = disk.poincare_constrained(3).unwrap();
    let mut linearizer = Linearizer::new(&equations, &Leaf::of(&disk), &[]).unwrap();
    for spin in [1.0, 3.0] {
        let start = [0.0, 0.0, 0.3, std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0, spin];
        let linear = linearizer.steady(0.0, &start, &SteadyOptions::default()).unwrap();
        assert_eq!(linear.components, ["θ", "ω1", "ω2", "ω3"]);
        let square = (m * g * r - c * (c + m * r * r) * spin * spin / a) / (a + m * r * r);
        let first = linear.spectrum.eigenvalues()[0];
        let found = if square > 0.0 { first.real } else { first.imaginary };
        assert!((found - square.abs().sqrt()).abs() < 1e-12, "{found} {square}");
        assert_eq!(linear.spectrum.neutral(), if square > 0.0 { 2 } else { 4 });
        let second = linear.second_order.unwrap();
        assert_eq!(second.coordinates, ["ψ", "θ", "φ"]);
        assert_near(&second.mass, &[&[a, 0.0, 0.0], &[0.0, a + m * r * r, 0.0], &[0.0, 0.0, c + m * r * r]]);
        assert_near(
            &second.velocity,
            &[&[0.0, -c * spin, 0.0], &[(c + m * r * r) * spin, 0.0, 0.0], &[0.0, 0.0, 0.0]],
        );
        assert_near(&second.stiffness, &[&[0.0, 0.0, 0.0], &[0.0, -m * g * r, 0.0], &[0.0, 0.0, 0.0]]);
    }
}

/// A position constraint: the pendulum on a circle in Cartesian coordinates, equations in x', and the same numbers.
#[test]
fn a_pendulum_on_its_circle() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let (g, l) = (9.81, 1.3);
    // η = ẋ, ẏ = −(x/y) ẋ (14).
    let pendulum = System::builder(&graph)
        .coordinates(["x", "y"])
        .quasi_velocities(["u"])
        .kinematics(|_, x, u| [u[0], -x[0] / x[1] * u[0]])
        .lagrangian(|_, x, u| (u[0].square() + (x[0] / x[1] * u[0]).square()) / 2.0 - g * x[1])
        .build()
        .unwrap();
    let leaf = Leaf { kept: vec![x.square() + y.square()], ..Leaf::of(&pendulum) };
    let mut linearizer = Linearizer::new(&pendulum.poincare().unwrap(), &leaf, &[]).unwrap();
    let start = [l * 0.4f64.sin(), -l * 0.4f64.cos(), 0.0];
    let linear = linearizer.steady(0.0, &start, &SteadyOptions::default()).unwrap();
    assert_eq!(linear.components, ["x", "u"]);
    assert!((linear.state[1].1 + l).abs() < EXACT, "{:?}", linear.state);
    assert_near(&linear.state_matrix, &[&[0.0, 1.0], &[-g / l, 0.0]]);
}

/// A mass on a rod, pushed from the side with the force u: with θ from below, T = −2 λ at rest is
/// g cos θ + u sin θ, in balance at tan θ = u/g.
#[test]
fn the_reaction_of_a_rod_by_state_and_input() {
    let graph = Graph::new();
    let [x, y, u, reaction] = graph.symbols(["x", "y", "u", "λ_rod"]);
    let pendulum = System::builder(&graph)
        .parameter(u, 7.5)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - 10.0 * x[1])
        .forces(|_, _, _| [u, 0.0.into()])
        .output("tension", |_, _, _| -2.0 * reaction)
        .output("square", |_, _, _| reaction.square())
        .build()
        .unwrap();
    let circle = x.square() + y.square() - 1.0;
    let held = pendulum.with_multipliers(&[Constraint::new("rod", circle)]).unwrap();
    let leaf = Leaf { positions: vec![circle], ..Leaf::of(&pendulum) };
    let mut linearizer = Linearizer::with_multipliers(&held, &leaf, &["u"]).unwrap();
    let linear = linearizer.steady(0.0, &[0.6, -0.8, 0.0, 0.0], &SteadyOptions::default()).unwrap();
    assert_eq!(linear.outputs, ["tension", "square"]);
    // T = 12.5 there, dT/dθ = −g sin θ + u cos θ = 0, dT/du = sin θ; (T/2)² has the slope T/2 dT/du.
    assert_near(&linear.feedthrough, &[&[0.6], &[3.75]]);
    assert_near(&linear.output_matrix, &[&[0.0, 0.0], &[0.0, 0.0]]);
}

/// Two masses one below the other on rods, moving and pushed: the slopes of outputs with both reactions and an
/// acceleration are difference quotients of what is observed along the constraints.
#[test]
fn reactions_of_two_rods_against_difference_quotients() {
    let graph = Graph::new();
    let [x, y, z, w, u, upper, lower] = graph.symbols(["x", "y", "z", "w", "u", "λ_upper", "λ_lower"]);
    let accelerated = graph.symbol("z''");
    let masses = System::builder(&graph)
        .parameter(u, 0.7)
        .coordinates(["x", "y", "z", "w"])
        .lagrangian(|_, x, v| {
            let kinetic = 3.0 * (v[0].square() + v[1].square()) + v[2].square() + v[3].square();
            kinetic / 2.0 - 9.0 * (3.0 * x[1] + x[3])
        })
        .forces(|_, x, v| [-0.3 * v[0], u * x[0], u, 0.0.into()])
        .output("lower", |_, _, _| lower)
        .output("mixed", |_, x, v| upper * lower * x[0] + u * accelerated + v[2] * upper)
        .build()
        .unwrap();
    let rods = [x.square() + y.square() - 1.0, (z - x).square() + (w - y).square() - 0.64];
    let constraints = [Constraint::new("upper", rods[0]), Constraint::new("lower", rods[1])];
    let held = masses.with_multipliers(&constraints).unwrap();
    let leaf = Leaf { positions: rods.to_vec(), ..Leaf::of(&masses) };
    let mut linearizer = Linearizer::with_multipliers(&held, &leaf, &["u"]).unwrap();

    let state = |angles: &[f64; 4]| {
        let [a, b, p, q] = *angles;
        let first = [a.sin(), -a.cos(), p * a.cos(), p * a.sin()];
        let second = [0.8 * b.sin(), -0.8 * b.cos(), 0.8 * q * b.cos(), 0.8 * q * b.sin()];
        let both = |i: usize| first[i] + second[i];
        [first[0], first[1], both(0), both(1), first[2], first[3], both(2), both(3)]
    };
    let here = [0.4, -0.9, 1.1, 0.5];
    let linear = linearizer.at(0.0, &state(&here)).unwrap();
    assert_eq!(linear.components.len(), 4);
    let mut motion = held.compile().unwrap();
    let places: Vec<usize> = ["lower", "mixed"]
        .map(|name| motion.observable_names().iter().position(|known| known == name).unwrap())
        .to_vec();
    // Truncation and rounding of central differences of numbers up to some tens are alike.
    let (step, close) = (1e-5, 1e-7);
    let quotients = |ahead: &[f64], behind: &[f64]| -> Vec<f64> {
        ahead.iter().zip(behind).map(|(ahead, behind)| (ahead - behind) / (2.0 * step)).collect()
    };
    for i in 0..4 {
        let moved = |sign: f64| {
            let mut angles = here;
            angles[i] += sign * step;
            state(&angles)
        };
        let (ahead, behind) = (moved(1.0), moved(-1.0));
        let slopes = quotients(&motion.observe(0.0, &ahead), &motion.observe(0.0, &behind));
        let all = quotients(&ahead, &behind);
        let names = motion.names();
        let of_components: Vec<f64> = linear
            .components
            .iter()
            .map(|name| all[names.iter().position(|known| known == name).unwrap()])
            .collect();
        for (o, &place) in places.iter().enumerate() {
            let found: f64 = (0..4).map(|j| linear.output_matrix[(o, j)] * of_components[j]).sum();
            assert!((found - slopes[place]).abs() < close * slopes[place].abs().max(1.0), "{i} {o}");
            assert!(slopes[place].abs() > 0.1, "{i} {o}: {}", slopes[place]);
        }
    }
    let mut pushed = |value: f64| {
        motion.parameters_mut()[0] = value;
        motion.observe(0.0, &state(&here))
    };
    let slopes = quotients(&pushed(0.7 + step), &pushed(0.7 - step));
    for (o, &place) in places.iter().enumerate() {
        let found = linear.feedthrough[(o, 0)];
        assert!((found - slopes[place]).abs() < close * slopes[place].abs().max(1.0), "{o}: {found}");
        assert!(found.abs() > 0.01, "{o}: {found}");
    }
}

/// The Jacobian at a state that is not steady is that along the motion: −3x² for ẍ = −x³.
#[test]
fn the_jacobian_of_a_start_that_moves() {
    let graph = Graph::new();
    let [time, drive] = graph.symbols(["t", "drive"]);
    let duffing = System::builder(&graph)
        .parameter(drive, 0.0)
        .coordinates(["x"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 - x[0].powi(4) / 4.0)
        .forces(|_, _, _| [drive * time.cos()])
        .build()
        .unwrap();
    let mut linearizer = Linearizer::new(&duffing.poincare().unwrap(), &Leaf::of(&duffing), &[]).unwrap();
    let linear = linearizer.at(0.0, &[2.0, 0.0]).unwrap();
    assert_near(&linear.state_matrix, &[&[0.0, 1.0], &[-12.0, 0.0]]);
    assert!(!linear.is_steady && linear.second_order == Err(NoSecondOrder::NotSteady));
    assert_eq!(linear.residual, 8.0);
    // Without a drive the middle is an equilibrium; with one there is none.
    assert!(linearizer.at(0.0, &[0.0, 0.0]).unwrap().is_steady);
    linearizer.set_parameters(&[0.5]);
    let driven = linearizer.steady(0.0, &[0.0, 0.0], &SteadyOptions::default());
    assert_eq!(driven, Err(AnalysisError::DependsOnTime));
}

/// A motor: a first-order state that acts on the velocity is a component of A, but excludes equations of the
/// second order.
#[test]
fn first_order_states_are_components() {
    let graph = Graph::new();
    let current = graph.symbol("i");
    let motor = System::builder(&graph)
        .coordinates(["θ"])
        .state(current, |_, _, w| -2.0 * current - w[0])
        .lagrangian(|_, x, w| w[0].square() / 2.0 - x[0].square())
        .forces(|_, _, _| [3.0 * current])
        .build()
        .unwrap();
    let linear = near(&motor, &[0.1, 0.0, 0.2], &[]);
    assert_near(&linear.state_matrix, &[&[0.0, 1.0, 0.0], &[-2.0, 0.0, 3.0], &[0.0, -1.0, -2.0]]);
    assert_eq!(linear.second_order, Err(NoSecondOrder::FirstOrderState { state: "i".to_owned() }));
    assert_eq!(linear.spectrum.verdict(), Verdict::AsymptoticallyStable);
}

/// At the pole of spherical coordinates the pendulum hangs, but rates have no derivatives by them.
#[test]
fn poles_are_refused() {
    let graph = Graph::new();
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let pendulum = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .quasi_velocities(["η1", "η2"])
        .kinematics(|_, x, w| {
            let rho = (x[0].square() + x[1].square()).sqrt();
            [
                (x[0] * x[2] * w[0]) / rho - x[1] * w[1] / rho,
                (x[1] * x[2] * w[0]) / rho + x[0] * w[1] / rho,
                -rho * w[0],
            ]
        })
        .lagrangian(|_, x, w| (w[0].square() + w[1].square()) / 2.0 - x[2])
        .build()
        .unwrap();
    let leaf = Leaf { kept: vec![x.square() + y.square() + z.square()], ..Leaf::of(&pendulum) };
    let mut linearizer = Linearizer::new(&pendulum.poincare().unwrap(), &leaf, &[]).unwrap();
    let start = [0.1, 0.05, -(1.0f64 - 0.0125).sqrt(), 0.0, 0.0];
    let found = linearizer.steady(0.0, &start, &SteadyOptions::default());
    let refused = matches!(
        found,
        Err(AnalysisError::NotSmooth { .. } | AnalysisError::NoSteadyMotion { .. } | AnalysisError::Mech(_))
    );
    assert!(refused, "{found:?}");
}
