//! Derivatives of motions by state and parameters, against dual numbers and against central differences.

use std::ops::{Add, Mul, Neg};

use num_dual::{Dual64, DualNum};
use pc_expr::{Function, Scalar};
use pc_mech::{
    CompileOptions, Equations, EvaluationError, Expr, Graph, MechError, Motion, System, VectorField,
};

/// A number with its derivative.
#[derive(Clone, Copy, Debug)]
struct Dual(Dual64);

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual(self.0 + other.0)
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        Dual(self.0 * other.0)
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(-self.0)
    }
}

impl Scalar for Dual {
    fn from_f64(value: f64) -> Dual {
        Dual(Dual64::from(value))
    }

    fn powi(self, exponent: i32) -> Dual {
        Dual(DualNum::powi(&self.0, exponent))
    }

    fn call(function: Function, args: &[Dual]) -> Dual {
        Dual(match function {
            Function::Sin => args[0].0.sin(),
            Function::Cos => args[0].0.cos(),
            _ => Dual64::from(f64::NAN), // the systems below call no others
        })
    }
}

/// w of M w = r by elimination without pivoting, for a positive definite M.
fn solve(mut m: Vec<Dual64>, mut r: Vec<Dual64>) -> Vec<Dual64> {
    let k = r.len();
    for p in 0..k {
        for i in p + 1..k {
            let factor = m[i * k + p] / m[p * k + p];
            for j in p..k {
                let product = factor * m[p * k + j];
                m[i * k + j] -= product;
            }
            let product = factor * r[p];
            r[i] -= product;
        }
    }
    for p in (0..k).rev() {
        for j in p + 1..k {
            let product = m[p * k + j] * r[j];
            r[p] -= product;
        }
        r[p] /= m[p * k + p];
    }
    r
}

/// The derivative of (ẋ, η̇) when symbol number `moving` of (x, η, p) changes, from M, r and ẋ in dual
/// numbers.
fn by_dual_numbers(equations: &Equations<'_>, (t, y, p): (f64, &[f64], &[f64]), moving: usize) -> Vec<f64> {
    let system = equations.system();
    let k = system.quasi_velocities().len();
    let parameters = system.parameters().iter().map(|&(symbol, _)| symbol);
    let symbols =
        system.frame().coordinates().iter().chain(system.quasi_velocities()).copied().chain(parameters);
    let seed = |i: usize| if i == moving { 1.0 } else { 0.0 };
    let mut values: Vec<(Expr<'_>, Dual)> = symbols
        .zip(y.iter().chain(p))
        .enumerate()
        .map(|(i, (symbol, &value))| (symbol, Dual(Dual64::new(value, seed(i)))))
        .collect();
    values.push((system.frame().time(), Scalar::from_f64(t)));
    let all =
        [&equations.mass_matrix().entries(), equations.right_hand_side(), equations.velocities()].concat();
    let values: Vec<Dual64> =
        system.graph().evaluate(&all, &values).unwrap().into_iter().map(|v| v.0).collect();
    let (mass, rest) = values.split_at(k * k);
    let (right, velocities) = rest.split_at(k);
    velocities.iter().copied().chain(solve(mass.to_vec(), right.to_vec())).map(|v| v.eps).collect()
}

/// The derivative of f when entry `j` of the state, or of the parameters, changes.
fn by_differences(motion: &Motion, (t, y): (f64, &[f64]), j: usize, of_parameters: bool) -> Vec<f64> {
    let h = 1e-5;
    let at = |shift: f64| {
        let (mut motion, mut y, mut ydot) = (motion.clone(), y.to_vec(), vec![0.0; y.len()]);
        if of_parameters {
            motion.parameters_mut()[j] += shift;
        } else {
            y[j] += shift;
        }
        motion.rhs(t, &y, &mut ydot).unwrap();
        ydot
    };
    at(h).iter().zip(at(-h)).map(|(a, b)| (a - b) / (2.0 * h)).collect()
}

/// Relative to the largest entry; `what` appears in the message.
fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let size = expected.iter().fold(1.0f64, |size, v| size.max(v.abs()));
    assert_eq!(found.len(), expected.len(), "{what}");
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance * size, "{what}, entry {i}: {a} instead of {b}");
    }
}

/// Rounding of elimination and of the terms of a derivative, each some hundred units in the last place.
const ROUNDING: f64 = 1e-12;
/// h² f‴/6 and ε f/h at h = 1e-5, for third derivatives up to some thousands of the entries.
const DIFFERENCE: f64 = 1e-6;

fn check(equations: &Equations<'_>, t: f64, y: &[f64]) {
    let options = CompileOptions::default().jvp(true).parameter_jacobian(true);
    let mut motion = equations.compile_for(options).unwrap();
    assert!(motion.has_jacobian() && motion.has_jvp() && motion.has_parameter_jacobian());
    let p = motion.parameters().to_vec();
    let (dim, parameters) = (y.len(), motion.parameters_len());

    let mut jacobian = vec![f64::NAN; dim * dim];
    motion.jacobian(t, y, &mut jacobian).unwrap();
    let mut by_parameters = vec![f64::NAN; dim * parameters];
    motion.parameter_jacobian(t, y, &mut by_parameters).unwrap();
    let columns = jacobian.chunks(dim).chain(by_parameters.chunks(dim));
    for (j, column) in columns.enumerate() {
        let what = format!("column {j}");
        assert_close(column, &by_dual_numbers(equations, (t, y, &p), j), ROUNDING, &what);
        let (index, of_parameters) = if j < dim { (j, false) } else { (j - dim, true) };
        assert_close(column, &by_differences(&motion, (t, y), index, of_parameters), DIFFERENCE, &what);
    }

    let pattern = motion.sparsity().unwrap().clone();
    let mut entries = vec![f64::NAN; pattern.len()];
    motion.sparse_jacobian(t, y, &mut entries).unwrap();
    let mut scattered = vec![f64::NAN; dim * dim];
    pattern.scatter(&entries, &mut scattered);
    assert_eq!(scattered, jacobian);

    let mut product = vec![f64::NAN; dim];
    let v: Vec<f64> = (0..dim).map(|i| (1.0 + i as f64).sin()).collect();
    motion.jvp(t, y, &v, &mut product).unwrap();
    let expected: Vec<f64> = (0..dim).map(|i| (0..dim).map(|j| jacobian[i + j * dim] * v[j]).sum()).collect();
    assert_close(&product, &expected, ROUNDING, "product");

    let colouring = pattern.colouring();
    for colour in 0..colouring.len() {
        let mut v = vec![0.0; dim];
        colouring.columns(colour).for_each(|j| v[j] = 1.0);
        motion.jvp(t, y, &v, &mut product).unwrap();
        for j in colouring.columns(colour) {
            for &i in pattern.column(j) {
                let size = jacobian.iter().fold(1.0f64, |size, v| size.max(v.abs()));
                assert!((product[i] - jacobian[i + j * dim]).abs() <= ROUNDING * size, "entry ({i}, {j})");
            }
        }
    }
}

fn top<'g>(graph: &'g Graph, quaternion: bool) -> System<'g> {
    let parameters = graph.symbols(["I1", "I2", "I3", "r1", "r2", "r3", "mg"]);
    let [i1, i2, i3, r1, r2, r3, mg] = parameters;
    let mut builder = System::builder(graph);
    for (symbol, value) in parameters.into_iter().zip([2.0, 3.0, 4.0, 0.1, 0.2, 0.3, 10.0]) {
        builder = builder.parameter(symbol, value);
    }
    let names: &[&str] = if quaternion { &["q0", "q1", "q2", "q3"] } else { &["ψ", "θ", "φ"] };
    let vertical = |x: &[Expr<'g>]| match *x {
        [q0, q1, q2, q3] => [
            2.0 * (q1 * q3 - q0 * q2),
            2.0 * (q2 * q3 + q0 * q1),
            q0.square() - q1.square() - q2.square() + q3.square(),
        ],
        _ => [x[1].sin() * x[2].sin(), x[1].sin() * x[2].cos(), x[1].cos()],
    };
    builder
        .coordinates(names)
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, x, w| match *x {
            [q0, q1, q2, q3] => vec![
                (-q1 * w[0] - q2 * w[1] - q3 * w[2]) / 2.0,
                (q0 * w[0] - q3 * w[1] + q2 * w[2]) / 2.0,
                (q3 * w[0] + q0 * w[1] - q1 * w[2]) / 2.0,
                (-q2 * w[0] + q1 * w[1] + q0 * w[2]) / 2.0,
            ],
            _ => {
                let node = w[0] * x[2].sin() + w[1] * x[2].cos();
                vec![
                    node / x[1].sin(),
                    w[0] * x[2].cos() - w[1] * x[2].sin(),
                    w[2] - node * x[1].cos() / x[1].sin(),
                ]
            }
        })
        .lagrangian(|_, x, w| {
            let [g1, g2, g3] = vertical(x);
            let kinetic = (i1 * w[0].square() + i2 * w[1].square() + i3 * w[2].square()) / 2.0;
            kinetic - mg * (r1 * g1 + r2 * g2 + r3 * g3)
        })
        .build()
        .unwrap()
}

#[test]
fn the_derivatives_of_the_top_in_eulers_angles() {
    let graph = Graph::new();
    let equations = top(&graph, false).poincare().unwrap();
    check(&equations, 0.0, &[0.1, 1.0, 0.3, 0.2, -0.3, 1.5]);
    let motion = equations.compile().unwrap();
    let pattern = motion.sparsity().unwrap();
    assert!(pattern.column(0).is_empty(), "nothing depends on ψ");
}

#[test]
fn the_derivatives_of_the_body_with_a_quaternion() {
    let graph = Graph::new();
    check(&top(&graph, true).poincare().unwrap(), 0.0, &[0.8, 0.4, -0.1, 0.3, 0.2, -0.3, 1.5]);
}

#[test]
fn the_derivatives_of_pendulums() {
    for links in [1, 3, 6] {
        let graph = Graph::new();
        let [gravity, length] = graph.symbols(["g", "l"]);
        let system = System::builder(&graph)
            .parameter(gravity, 10.0)
            .parameter(length, 0.7)
            .coordinates((1..=links).map(|i| format!("θ{i}")))
            .lagrangian(|_, theta, eta| {
                let weight = |i: usize| (links - i) as f64;
                let pairs = (0..links).flat_map(|i| (0..=i).map(move |j| (i, j)));
                let kinetic = pairs.map(|(i, j)| {
                    let pair = if i == j { 0.5 } else { 1.0 };
                    pair * weight(i) * length.square() * (theta[i] - theta[j]).cos() * eta[i] * eta[j]
                });
                graph.sum(kinetic.chain((0..links).map(|i| weight(i) * gravity * length * theta[i].cos())))
            })
            .build()
            .unwrap();
        let y: Vec<f64> = (0..2 * links).map(|i| (0.7 * i as f64).cos()).collect();
        check(&system.poincare().unwrap(), 0.0, &y);
    }
}

/// Plane motion of a charge in a growing field, seen from a turning frame whose origin moves.
#[test]
fn the_derivatives_of_a_particle_in_a_frame_that_depends_on_time() {
    let graph = Graph::new();
    let [turn, field, mass] = graph.symbols(["Ω", "B", "m"]);
    let system = System::builder(&graph)
        .parameter(turn, 0.7)
        .parameter(field, 1.3)
        .parameter(mass, 2.0)
        .coordinates(["x", "y"])
        .quasi_velocities(["u", "v"])
        .kinematics(|t, _, w| {
            let (s, c) = ((turn * t).sin(), (turn * t).cos());
            [c * w[0] - s * w[1] + t, s * w[0] + c * w[1] - turn]
        })
        .lagrangian(|t, x, w| {
            let (s, c) = ((turn * t).sin(), (turn * t).cos());
            let velocity = [c * w[0] - s * w[1] + t, s * w[0] + c * w[1] - turn];
            let potential = (x[0] * velocity[1] - x[1] * velocity[0]) / 2.0;
            mass * (velocity[0].square() + velocity[1].square()) / 2.0
                + field * (1.0 + t.square()) * potential
                - x[0].square() * x[1].cos()
        })
        .build()
        .unwrap();
    check(&system.poincare().unwrap(), 0.4, &[0.3, -0.8, 1.1, 0.6]);
}

#[test]
fn derivatives_that_were_not_compiled_are_refused() {
    let graph = Graph::new();
    let options = CompileOptions::default().jacobian(false);
    let mut motion = top(&graph, true).poincare().unwrap().compile_for(options).unwrap();
    assert!(!motion.has_jacobian() && !motion.has_jvp() && !motion.has_parameter_jacobian());
    assert!(motion.sparsity().is_none());
    let y = [1.0, 0.0, 0.0, 0.0, 0.2, -0.3, 1.5];
    let errors = [
        motion.jacobian(0.0, &y, &mut [0.0; 49]).unwrap_err(),
        motion.sparse_jacobian(0.0, &y, &mut [0.0; 49]).unwrap_err(),
        motion.jvp(0.0, &y, &[0.0; 7], &mut [0.0; 7]).unwrap_err(),
        motion.parameter_jacobian(0.0, &y, &mut [0.0; 49]).unwrap_err(),
        motion.observable_jacobian(0.0, &y, &mut [0.0; 7]).unwrap_err(),
        motion.observable_parameter_jacobian(0.0, &y, &mut [0.0; 7]).unwrap_err(),
    ];
    let jacobian = "the motion was compiled without its Jacobian";
    let product = "the motion was compiled without its product with its Jacobian";
    let parameters = "the motion was compiled without its derivative by parameters";
    let observables = "the motion was compiled without its derivatives of observables";
    let messages = [jacobian, jacobian, product, parameters, observables, observables];
    for (error, message) in errors.iter().zip(messages) {
        assert!(!error.is_recoverable());
        assert_eq!(error.to_string(), message);
        assert!(matches!(
            error.cause().downcast_ref(),
            Some(MechError::Evaluation(EvaluationError::NotCompiled { .. }))
        ));
    }
}

/// The energy, and an output that contains an acceleration: φ̈ = −(g/l) sin φ.
#[test]
fn the_derivatives_of_observables() {
    let graph = Graph::new();
    let [g, l] = graph.symbols(["g", "l"]);
    let pendulum = System::builder(&graph)
        .parameter(g, 10.0)
        .parameter(l, 2.0)
        .coordinates(["φ"])
        .lagrangian(|_, x, v| l.square() * v[0].square() / 2.0 + g * l * x[0].cos())
        .output("push", |_, _, _| l * graph.symbol("φ''"))
        .output("speed", |_, _, v| v[0].square().sqrt())
        .build()
        .unwrap();
    let options = CompileOptions::default().observable_jacobian(true);
    let mut motion = pendulum.poincare().unwrap().compile_for(options).unwrap();
    let (x, v): (f64, f64) = (0.4, 0.0);
    let mut by_state = [0.0; 6];
    motion.observable_jacobian(0.0, &[x, v], &mut by_state).unwrap();
    assert_close(&by_state[..2], &[20.0 * x.sin(), -10.0 * x.cos()], ROUNDING, "by φ");
    assert_close(&by_state[3..5], &[4.0 * v, 0.0], ROUNDING, "by φ'");
    assert!(!by_state[5].is_finite(), "at rest a speed has no derivative");
    let mut by_parameters = [0.0; 6];
    motion.observable_parameter_jacobian(0.0, &[x, v], &mut by_parameters).unwrap();
    let expected = [-2.0 * x.cos(), -x.sin(), 0.0, -10.0 * x.cos(), 0.0, 0.0];
    assert_close(&by_parameters, &expected, ROUNDING, "by g and l");
}

/// The mass of the second body is a parameter: a pivot independent of the state.
#[test]
fn a_parameter_that_makes_the_mass_matrix_singular_is_found_when_it_changes() {
    let graph = Graph::new();
    let [m1, m2] = graph.symbols(["m1", "m2"]);
    let system = System::builder(&graph)
        .parameter(m1, 1.0)
        .parameter(m2, 1.0)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (m1 * v[0].square() + m2 * v[1].square()) / 2.0)
        .build()
        .unwrap();
    let mut motion = system.poincare().unwrap().compile().unwrap();
    let (y, mut ydot) = ([0.0, 0.0, 1.0, 2.0], [0.0; 4]);
    motion.rhs(0.0, &y, &mut ydot).unwrap();
    motion.parameters_mut()[1] = 0.0;
    let message =
        "the mass matrix is singular: its pivot for `y'` is 0 at t = 0, x = 0, y = 0, x' = 1, y' = 2";
    assert_eq!(motion.rhs(0.0, &y, &mut ydot).unwrap_err().to_string(), message);
    motion.parameters_mut()[1] = 2.0;
    motion.rhs(0.0, &y, &mut ydot).unwrap();
    assert_eq!(ydot, [1.0, 2.0, 0.0, 0.0]);
}

/// The Earth and a satellite, kg and m: the mass of the lighter body is not a rounding error.
#[test]
fn masses_of_any_ratio_are_regular() {
    let graph = Graph::new();
    let [earth, satellite] = [5.972e24, 1000.0];
    let system = System::builder(&graph)
        .coordinates(["X", "x", "φ"])
        .lagrangian(|_, x, v| {
            let coupled = (v[1] + 1e-3 * x[2].cos() * v[2]).square();
            (earth * v[0].square() + satellite * coupled + 1e-9 * v[2].square()) / 2.0
                + 6.674e-11 * earth * satellite / (x[0] - x[1])
        })
        .build()
        .unwrap();
    let mut motion = system.poincare().unwrap().compile().unwrap();
    let mut rates = [0.0; 6];
    motion.rhs(0.0, &[7e6, 0.0, 1.0, 0.0, 0.0, 0.0], &mut rates).unwrap();
    // m c (ẍ + c φ̈) + 10⁻⁹ φ̈ = 0 and m (ẍ + c φ̈) = F with c = cos φ/1000
    let (force, c) = (6.674e-11 * earth * satellite / 49e12, 1e-3 * 1f64.cos());
    let turn = -c * force / 1e-9;
    assert!((rates[5] - turn).abs() < 1e-9 * turn.abs(), "{rates:?}"); // m c² is 300 000 times 10⁻⁹
}

/// M = (x 1; 1 0) has the determinant −1 also where its first pivot vanishes: ẏ-equation ẍ = −x, and
/// ÿ = −y − ẋ²/2 + x².
#[test]
fn an_indefinite_mass_matrix_is_regular_where_a_pivot_vanishes() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| v[0] * v[1] + x[0] * v[0].square() / 2.0 - x[0] * x[1])
        .build()
        .unwrap();
    let mut motion = system.poincare().unwrap().compile().unwrap();
    let canonical = system.canonical().unwrap();
    let mut in_momenta = canonical.compile_for(pc_mech::Backend::Fastest).unwrap();
    for x in [0.0, 0.5] {
        let (y, vx, vy) = (1.0, 1.0, 0.5);
        let mut rates = [0.0; 4];
        motion.rhs(0.0, &[x, y, vx, vy], &mut rates).unwrap();
        assert_eq!(rates, [vx, vy, -x, -y - vx * vx / 2.0 + x * x]);
        in_momenta.rhs(0.0, &[x, y, vy + x * vx, vx], &mut rates).unwrap();
        assert_eq!(rates, [vx, vy, vx * vx / 2.0 - y, -x]);
    }
}

/// Where a pivot is a rounding error, of an entry or of an indefinite matrix, the rates would be, too.
#[test]
fn a_mass_matrix_that_is_singular_up_to_rounding_is_refused() {
    type Lagrangian = for<'g> fn(&[Expr<'g>], &[Expr<'g>]) -> Expr<'g>;
    let cases: [(Lagrangian, [f64; 2], &str); 4] = [
        // sin² π
        (
            |x, v| (v[0].square() + x[0].sin().square() * v[1].square()) / 2.0,
            [std::f64::consts::PI, 0.0],
            "y'",
        ),
        (|x, v| x[0] * v[0].square() / 2.0 + v[0] * v[1] + v[1].square() / 2.0, [1e-18, 0.0], "x'"),
        (|x, v| x[0] * v[0].square() / 2.0 + x[1].sin() * v[0] * v[1], [0.3, std::f64::consts::PI], "y'"),
        (|x, v| x[0] * v[0].square() / 2.0 + x[1] * v[0] * v[1], [0.3, 0.0], "y'"),
    ];
    for (lagrangian, x, undetermined) in cases {
        let graph = Graph::new();
        let system = System::builder(&graph)
            .coordinates(["x", "y"])
            .lagrangian(|_, x, v| lagrangian(x, v) + x[0])
            .build()
            .unwrap();
        let mut motion = system.poincare().unwrap().compile().unwrap();
        let error = motion.rhs(0.0, &[x[0], x[1], 0.1, 1.0], &mut [0.0; 4]).unwrap_err();
        match error.cause().downcast_ref() {
            Some(MechError::Evaluation(EvaluationError::SingularMassMatrix { quasi_velocity, .. })) => {
                assert_eq!(quasi_velocity, undetermined);
            }
            _ => panic!("{error}"),
        }
    }
}
