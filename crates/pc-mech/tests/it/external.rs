//! External forces against the same forces in symbols.

use crate::common;
use pc_analysis::{Conservation, Rates};
use pc_mech::{
    Backend, CompileOptions, EmitOptions, Expr, ExternalForce, Failure, ForceError, Graph, Language,
    MechError, System, SystemBuilder, VectorField,
};

/// Forces on ω3 and ω1 of a top, with their derivatives.
struct Known;

fn q3(t: f64, y: &[f64]) -> f64 {
    y[0] * y[4] - t.sin() * y[5].powi(2)
}

fn q1(y: &[f64]) -> f64 {
    (y[2] * y[3]).sin()
}

impl ExternalForce for Known {
    fn force(&mut self, t: f64, y: &[f64], q: &mut [f64]) -> Result<(), Failure> {
        q.copy_from_slice(&[q3(t, y), q1(y)]);
        Ok(())
    }

    fn jacobian(&mut self, t: f64, y: &[f64], dq: &mut [f64]) -> Result<(), Failure> {
        dq.fill(0.0);
        (dq[0], dq[8], dq[10]) = (y[4], y[0], -2.0 * t.sin() * y[5]);
        let slope = (y[2] * y[3]).cos();
        (dq[5], dq[7]) = (slope * y[3], slope * y[2]);
        Ok(())
    }
}

/// The heavy top with ω̇_3 as an output.
fn top(graph: &Graph) -> SystemBuilder<'_> {
    common::top_of_parameters(graph).output("ω3 grows", |_, _, _| graph.symbol("ω3'"))
}

fn symbolic(graph: &Graph) -> System<'_> {
    top(graph)
        .forces(|t, g, w| [(g[2] * w[0]).sin(), Expr::ZERO, g[0] * w[1] - t.sin() * w[2].square()])
        .build()
        .unwrap()
}

const T: f64 = 0.7;
const Y: [f64; 6] = [0.3, -0.5, 0.8, 0.4, -1.1, 0.6];
/// A few dozen roundings of numbers of order one.
const ROUNDING: f64 = 1e-13;

fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() < tolerance, "entry {i}: {found} against {expected}");
    }
}

/// All results of a vector field at (T, Y): ẏ, ∂f/∂y, (∂f/∂y) v, ∂f/∂p.
fn everything(field: &mut impl VectorField) -> [Vec<f64>; 4] {
    assert!(field.has_jacobian() && field.has_jvp() && field.has_parameter_jacobian());
    let dim = field.dim();
    let (mut rate, mut jacobian, mut product) = (vec![0.0; dim], vec![0.0; dim * dim], vec![0.0; dim]);
    let mut by_parameters = vec![0.0; dim * field.parameters_len()];
    field.rhs(T, &Y, &mut rate).unwrap();
    field.jacobian(T, &Y, &mut jacobian).unwrap();
    field.jvp(T, &Y, &[0.2, -0.1, 0.4, 1.0, 0.3, -0.7], &mut product).unwrap();
    field.parameter_jacobian(T, &Y, &mut by_parameters).unwrap();
    [rate, jacobian, product, by_parameters]
}

#[test]
fn a_force_from_outside_is_the_force_in_symbols() {
    let graph = Graph::new();
    let options = CompileOptions::from(Backend::Interpreter).jvp(true).parameter_jacobian(true);
    let equations = symbolic(&graph).poincare().unwrap();
    let mut inside = equations.compile_for(options).unwrap();
    let expected = everything(&mut inside);

    let declared = top(&graph).external_force(["ω3"]).external_force(["ω1", "ω3"]).build().unwrap();
    let names: Vec<&str> = declared.external_forces().iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["ω3", "ω1"]);
    let equations = declared.poincare().unwrap();
    let mut exact = equations.compile_forced_for(options, Known).unwrap();
    for (found, expected) in everything(&mut exact).iter().zip(&expected) {
        assert_close(found, expected, ROUNDING);
    }
    assert_close(&exact.observe(T, &Y), &inside.observe(T, &Y), ROUNDING);

    // Without derivatives: difference quotients with the error √ε = 1.5e-8 times a curvature of order one.
    let closure = |t: f64, y: &[f64], q: &mut [f64]| q.copy_from_slice(&[q3(t, y), q1(y)]);
    let mut differences = equations.compile_forced_for(options, closure).unwrap();
    let found = everything(&mut differences);
    for (i, tolerance) in [ROUNDING, 1e-6, 1e-6, ROUNDING].into_iter().enumerate() {
        assert_close(&found[i], &expected[i], tolerance);
    }
    assert_eq!(differences.component_name(3), "ω1");
    assert!(differences.sparsity().is_some_and(pc_expr::Pattern::is_full));
}

#[test]
fn parameters_are_separate_from_the_forces() {
    let graph = Graph::new();
    let equations = top(&graph).external_force(["ω3", "ω1"]).build().unwrap().poincare().unwrap();
    let mut motion = equations.compile_forced(Known).unwrap();
    assert_eq!((motion.parameters(), motion.parameters_len()), (&[1.0; 6][..], 6));
    motion.parameters_mut()[2] = 2.0; // the third moment of inertia
    let mut rate = [0.0; 6];
    motion.rhs(T, &Y, &mut rate).unwrap();
    // C ω̇_3 = (A − B) ω_1 ω_2 + m_2 γ_1 − m_1 γ_2 + Q_3, where all but C are one
    let expected = (Y[0] - Y[1] + q3(T, &Y)) / 2.0;
    assert!((rate[5] - expected).abs() < ROUNDING);

    // Compiled without a force, the forces are parameters after the others, zero until they are set.
    let mut motion = equations.compile().unwrap();
    assert_eq!(motion.parameters(), [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0]);
    let mut free = rate;
    motion.rhs(T, &Y, &mut free).unwrap();
    motion.parameters_mut()[6] = 3.0;
    motion.rhs(T, &Y, &mut rate).unwrap();
    assert_close(&rate[..5], &free[..5], ROUNDING);
    assert!((rate[5] - free[5] - 3.0).abs() < ROUNDING);
}

#[test]
fn the_canonical_equations_take_external_forces() {
    let graph = Graph::new();
    let mut inside = symbolic(&graph).canonical().unwrap().compile_for(CompileOptions::default()).unwrap();
    let declared = top(&graph).external_force(["ω3", "ω1"]).build().unwrap();
    // All moments of inertia are one, so that y = ω.
    let canonical = declared.canonical().unwrap();
    let mut outside = canonical.compile_forced_for(CompileOptions::default(), Known).unwrap();
    let [mut rate, mut expected] = [[0.0; 6]; 2];
    outside.rhs(T, &Y, &mut rate).unwrap();
    inside.rhs(T, &Y, &mut expected).unwrap();
    assert_close(&rate, &expected, ROUNDING);
    let [mut jacobian, mut expected] = [[0.0; 36]; 2];
    outside.jacobian(T, &Y, &mut jacobian).unwrap();
    inside.jacobian(T, &Y, &mut expected).unwrap();
    assert_close(&jacobian, &expected, ROUNDING);
}

/// M is factorised in numbers for this chain of pendulums, each hung on the one before.
#[test]
fn a_long_chain_takes_external_forces() {
    const LINKS: usize = 20;
    let graph = Graph::new();
    let names: Vec<String> = (1..=LINKS).map(|i| format!("θ{i}")).collect();
    let chain = || {
        System::builder(&graph).coordinates(&names).kinetic(|_, x, v| {
            let pairs = (0..LINKS).flat_map(|i| (0..LINKS).map(move |j| (i, j)));
            let weight = |i: usize, j: usize| (LINKS - i.max(j)) as f64 / 2.0;
            graph.sum(pairs.map(|(i, j)| weight(i, j) * (x[i] - x[j]).cos() * v[i] * v[j]))
        })
    };
    let y: Vec<f64> = (0..2 * LINKS).map(|i| (i as f64).sin() / 3.0).collect();
    let drag = chain().forces(|_, x, v| {
        let mut q = vec![Expr::ZERO; LINKS];
        (q[0], q[LINKS - 1]) = (-v[0] * x[1], -v[LINKS - 1].powi(3));
        q
    });
    let mut inside = drag.build().unwrap().poincare().unwrap().compile().unwrap();
    let declared = chain().external_force([format!("θ{LINKS}'"), "θ1'".into()]).build().unwrap();
    let closure = |_: f64, y: &[f64], q: &mut [f64]| {
        (q[0], q[1]) = (-y[2 * LINKS - 1].powi(3), -y[LINKS] * y[1]);
    };
    let mut outside = declared.poincare().unwrap().compile_forced(closure).unwrap();
    let (mut rate, mut expected) = (vec![0.0; 2 * LINKS], vec![0.0; 2 * LINKS]);
    outside.rhs(0.0, &y, &mut rate).unwrap();
    inside.rhs(0.0, &y, &mut expected).unwrap();
    assert_close(&rate, &expected, 1e-11); // the mass matrix magnifies roundings by its condition, some hundred
    let (mut jacobian, mut expected) = (vec![0.0; 4 * LINKS * LINKS], vec![0.0; 4 * LINKS * LINKS]);
    outside.jacobian(0.0, &y, &mut jacobian).unwrap();
    inside.jacobian(0.0, &y, &mut expected).unwrap();
    assert_close(&jacobian, &expected, 1e-5); // difference quotients, magnified likewise
}

/// The symbol of the force is kept by transformations of a system.
#[test]
fn the_force_stays_a_symbol() {
    let graph = Graph::new();
    let declared = common::in_eulers_angles(&graph)
        .kinetic(|_, _, w| (w[0].square() + w[1].square() + w[2].square()) / 2.0)
        .external_force(["ω3"])
        .build()
        .unwrap();
    let [q, w3] = graph.symbols(["Q_ω3", "ω3"]);
    assert_eq!(declared.forces()[2], q);
    assert_eq!(declared.energy_rate(), q * w3);
    let rates = Rates::poincare(&declared.poincare().unwrap());
    assert_eq!(rates.verdict(declared.energy()).unwrap(), Conservation::Changing(q * w3));
    assert_eq!(declared.with_parameters_bound().forces()[2], q);
    assert_eq!(declared.permuted(&[2, 0, 1]).forces()[0], q);

    let closure = |_: f64, _: &[f64], q: &mut [f64]| q[0] = 2.0;
    let lagrange = declared.in_velocities().unwrap();
    let mut motion = lagrange.poincare().unwrap().compile_forced(closure).unwrap();
    let (mut rate, y) = ([0.0; 6], [0.2, 1.0, 0.5, 0.3, -0.4, 0.6]);
    motion.rhs(0.0, &y, &mut rate).unwrap();
    let free = |_: f64, _: &[f64], q: &mut [f64]| q[0] = 0.0;
    let mut without = [0.0; 6];
    lagrange.poincare().unwrap().compile_forced(free).unwrap().rhs(0.0, &y, &mut without).unwrap();
    // ω̇_3 = φ̈ + ψ̈ cos θ + … grows by 2, ω̇_1 and ω̇_2 and with them ψ̈ and θ̈ do not.
    assert_close(&[rate[3], rate[4], rate[5]], &[without[3], without[4], without[5] + 2.0], ROUNDING);

    // In emitted source it is a parameter.
    let options = EmitOptions::new(Language::C, "top");
    let files = declared.poincare().unwrap().emit(&options).unwrap();
    assert!(files[1].text.contains("= p[0]; /* Q_ω3 */"), "{}", files[1].text);

    // With a parameter of the same name, the force gets another one.
    let taken = System::builder(&graph)
        .parameter(graph.symbol("Q_x'"), 1.0)
        .coordinates(["x"])
        .kinetic(|_, _, v| v[0].square())
        .external_force(["x'"])
        .build()
        .unwrap();
    assert_eq!(taken.forces(), [graph.symbol("Q_Q_x'")]);
}

#[derive(Debug, thiserror::Error)]
#[error("the motor is off")]
struct Off;

struct Motor {
    recoverable: bool,
}

impl ExternalForce for Motor {
    fn force(&mut self, _: f64, _: &[f64], _: &mut [f64]) -> Result<(), Failure> {
        Err(if self.recoverable { Failure::recoverable(Off) } else { Failure::fatal(Off) })
    }
}

#[test]
fn failures_name_the_force() {
    let graph = Graph::new();
    let equations = top(&graph).external_force(["ω3", "ω1"]).build().unwrap().poincare().unwrap();
    let mut rate = [0.0; 6];
    for recoverable in [true, false] {
        let mut motion = equations.compile_forced(Motor { recoverable }).unwrap();
        let failure = motion.rhs(T, &Y, &mut rate).unwrap_err();
        assert_eq!(failure.is_recoverable(), recoverable);
        assert_eq!(
            failure.to_string(),
            "the external force on `ω3`, `ω1` failed at t = 0.7: the motor is off"
        );
        let of_output = motion.observe(T, &Y);
        assert!(of_output[0].is_finite() && of_output[1].is_nan(), "{of_output:?}"); // energy, ω3'
    }
    // An entry left unwritten counts as NaN.
    let mut motion = equations.compile_forced(|_: f64, y: &[f64], q: &mut [f64]| q[0] = y[0]).unwrap();
    let failure = motion.rhs(T, &Y, &mut rate).unwrap_err();
    assert!(failure.is_recoverable());
    assert_eq!(
        failure.to_string(),
        "the external force on `ω1` is NaN at t = 0.7, γ1 = 0.3, γ2 = -0.5, γ3 = 0.8, ω1 = 0.4, ω2 = -1.1, ω3 = 0.6"
    );
    assert!(matches!(MechError::from(failure), MechError::Force(ForceError::NotFinite { .. })));
    let root = |_: f64, y: &[f64], q: &mut [f64]| (q[0], q[1]) = ((0.3 - y[0]).sqrt(), 0.0);
    let mut motion = equations.compile_forced(root).unwrap();
    motion.rhs(T, &Y, &mut rate).unwrap();
    let failure = motion.jacobian(T, &Y, &mut [0.0; 36]).unwrap_err();
    let said = "the derivative by `γ1` of the external force on `ω3` is NaN at t = 0.7";
    assert!(failure.to_string().starts_with(said), "{failure}");
    assert!(matches!(MechError::from(failure), MechError::Force(ForceError::SlopeNotFinite { .. })));
}

#[test]
fn declarations_are_checked() {
    let graph = Graph::new();
    let error = top(&graph).external_force(["ω4"]).build().unwrap_err();
    assert_eq!(error.to_string(), "`ω4` is not a quasi-velocity; these are ω1, ω2, ω3");
    let error =
        top(&graph).build().unwrap().poincare().unwrap().compile_forced(Known).map(|_| ()).unwrap_err();
    assert_eq!(error, MechError::Force(ForceError::NoneDeclared));
}
