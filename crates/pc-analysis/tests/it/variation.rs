//! The equations of variation against neighbouring motions, and the symplectic form of two variations.

use crate::common;
use pc_analysis::Variation;
use pc_mech::{CompileOptions, EvaluationError, Graph, MechError, Motion, System, VectorField};

/// A heavy top with three moments of inertia in Euler's angles, in canonical form.
fn top() -> Motion {
    let graph = Graph::new();
    let top = common::in_eulers_angles(&graph)
        .lagrangian(|_, x, w| {
            let kinetic = (w[0].square() + 1.5 * w[1].square() + 0.5 * w[2].square()) / 2.0;
            kinetic - 2.0 * x[1].cos() - 0.3 * x[1].sin() * x[2].sin()
        })
        .build()
        .unwrap();
    top.canonical().unwrap().compile_for(CompileOptions::default().jvp(true)).unwrap()
}

const START: [f64; 6] = [0.2, 1.1, -0.3, 0.4, -0.5, 1.0];

/// The state after time 1 by the fourth-order Runge–Kutta method.
fn after_unit_time(field: &mut impl VectorField, start: &[f64], steps: usize) -> Vec<f64> {
    let (n, h) = (start.len(), 1.0 / steps as f64);
    let mut y = start.to_vec();
    for step in 0..steps {
        let t = step as f64 * h;
        let mut slopes = [const { Vec::new() }; 4];
        for (stage, fraction) in [0.0, 0.5, 0.5, 1.0].into_iter().enumerate() {
            let at: Vec<f64> = match stage {
                0 => y.clone(),
                _ => y
                    .iter()
                    .zip(&slopes[stage - 1])
                    .map(|(y, k): (&f64, &f64)| y + fraction * h * k)
                    .collect(),
            };
            let mut slope = vec![0.0; n];
            field.rhs(t + fraction * h, &at, &mut slope).unwrap();
            slopes[stage] = slope;
        }
        for i in 0..n {
            y[i] += h / 6.0 * (slopes[0][i] + 2.0 * slopes[1][i] + 2.0 * slopes[2][i] + slopes[3][i]);
        }
    }
    y
}

/// The Runge–Kutta map of (y, δ) is the derivative of that of y, so that only the difference quotient errs:
/// central, s²/6 times a third derivative, with s = 10⁻⁵, and ε/s of rounding.
#[test]
fn a_variation_is_the_difference_of_neighbouring_motions() {
    let delta = [0.3, -0.7, 0.2, 0.5, 0.1, -0.4];
    let mut variation = Variation::new(top(), 1).unwrap();
    let start: Vec<f64> = START.iter().chain(&delta).copied().collect();
    let end = after_unit_time(&mut variation, &start, 100);
    let s = 1e-5;
    let neighbour = |sign: f64| {
        let start: Vec<f64> = START.iter().zip(delta).map(|(y, d)| y + sign * s * d).collect();
        after_unit_time(&mut top(), &start, 100)
    };
    let (after, before) = (neighbour(1.0), neighbour(-1.0));
    for i in 0..6 {
        let quotient = (after[i] - before[i]) / (2.0 * s);
        assert!((end[6 + i] - quotient).abs() < 2e-9, "{} where {quotient} is right", end[6 + i]);
    }
}

/// (δ_1, δ_2) = d(y_m θ^m) = δ_1y_m θ_2^m − δ_2y_m θ_1^m − c_rs^m y_m θ_1^r θ_2^s with the
/// quasi-displacements θ = a δx, here those of the body's rotation, and c that of so(3).
fn symplectic_form(state: &[f64]) -> f64 {
    let (x, y) = (&state[..3], &state[3..6]);
    let turn = |delta: &[f64]| {
        let across = delta[0] * x[1].sin();
        [
            across * x[2].sin() + delta[1] * x[2].cos(),
            across * x[2].cos() - delta[1] * x[2].sin(),
            delta[2] + delta[0] * x[1].cos(),
        ]
    };
    let (first, second) = (&state[6..12], &state[12..18]);
    let (a, b) = (turn(first), turn(second));
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    (0..3).map(|m| first[3 + m] * b[m] - second[3 + m] * a[m] - y[m] * cross[m]).sum()
}

#[test]
fn the_symplectic_form_of_two_variations_is_constant() {
    let mut variation = Variation::new(top(), 2).unwrap();
    let deltas = [0.3, -0.7, 0.2, 0.5, 0.1, -0.4, -0.2, 0.6, 0.9, 0.1, -0.8, 0.3];
    let start: Vec<f64> = START.iter().chain(&deltas).copied().collect();
    let end = after_unit_time(&mut variation, &start, 2000);
    let (before, after) = (symplectic_form(&start), symplectic_form(&end));
    // h⁴ = 6·10⁻¹⁴ times derivatives of order 10
    assert!((after - before).abs() < 1e-11, "{before} becomes {after}");
    assert!(before.abs() > 0.1 && (end[6] - start[6]).abs() > 0.1);
}

/// The variations of an oscillator are motions of it; its components have names.
#[test]
fn linear_motions_vary_as_they_move() {
    let graph = Graph::new();
    let oscillator = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| (v[0].square() - 4.0 * x[0].square()) / 2.0)
        .build()
        .unwrap();
    let equations = oscillator.poincare().unwrap();
    let motion = equations.compile_for(CompileOptions::default().jvp(true)).unwrap();
    let mut variation = Variation::new(motion, 1).unwrap();
    assert_eq!([0, 1, 2, 3].map(|i| variation.component_name(i)), ["x", "x'", "δ1 x", "δ1 x'"]);
    let end = after_unit_time(&mut variation, &[1.0, 0.0, 0.0, 1.0], 1000);
    assert!((end[2] - 2f64.sin() / 2.0).abs() < 1e-12 && (end[3] - 2f64.cos()).abs() < 1e-12);
    assert_eq!(variation.field().names(), ["x", "x'"]);

    let relay = System::builder(&graph)
        .coordinates(["y"])
        .lagrangian(|_, y, v| v[0].square() / 2.0 - y[0].abs())
        .build()
        .unwrap();
    let relay = relay.poincare().unwrap().compile_for(CompileOptions::default().jvp(true)).unwrap();
    assert_eq!(
        Variation::new(relay, 1).unwrap_err().to_string(),
        "deviations from this motion jump where it passes through y = 0: integrate them as sensitivities to the start, which \
         jump there"
    );

    let plain = Variation::new(equations.compile().unwrap(), 1).unwrap_err();
    assert_eq!(
        plain,
        MechError::Evaluation(EvaluationError::NotCompiled { what: "products with the Jacobian" })
    );
}
