//! Jacobians of points of bodies and of momenta: against differences of positions, and against a closed form.

use crate::trees::{difference, hung, state, trees, values};
use pc_mech::{Expr, FrameError, Graph, MechError, System};

/// Differences of fourth order of a function along the motion with these rates, in steps of 1e-3: 1e-12 times fifth
/// derivatives of truncation, and rounding errors of 1e-16/1e-3.
fn along(y: &[f64], rates: &[f64], f: impl Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
    let h = 1e-3;
    let beside = |steps: f64| -> Vec<f64> {
        f(&y.iter().zip(rates).map(|(y, rate)| y + steps * h * rate).collect::<Vec<_>>())
    };
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(beside);
    (0..a.len()).map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h)).collect()
}

const DIFFERENCES: f64 = 1e-9;

#[test]
fn a_point_of_the_last_body_moves_with_its_jacobian() {
    trees(12, 3, |bodies, numbers| {
        let graph = Graph::new();
        let system = hung(&graph, bodies, false);
        let (y, k) = (state(bodies, numbers), system.quasi_velocities().len());
        let n = y.len() - k;
        let tree = system.tree().unwrap();
        let motions = tree.motions();
        let point = graph.symbols(["r1", "r2", "r3"]);
        let velocity = motions.velocity_of_point("b2", &point).unwrap();
        let omega = motions.angular_velocity_in_world("b2").unwrap();
        let equations = system.poincare().unwrap();
        let mut map = equations.velocity_map(&[velocity, omega].concat(), &point).unwrap();
        let r = [0.3, -0.4, 0.7];
        map.arguments_mut().copy_from_slice(&r);
        let (mut jacobian, mut rest, mut rates) = (vec![0.0; 6 * k], [f64::NAN; 6], [f64::NAN; 6]);
        map.map(0.0, &y, &mut jacobian, &mut rest).unwrap();
        map.rates(0.0, &y, &mut rates).unwrap();
        assert_eq!(rest, [0.0; 6]);
        let product = |y: &[f64]| -> Vec<f64> {
            (0..6).map(|i| (0..k).map(|s| jacobian[i + 6 * s] * y[n + s]).sum()).collect()
        };
        let w = product(&y);

        let (place, turned) = (motions.place("b2").unwrap(), motions.rotation("b2").unwrap());
        let arm = |i: usize| graph.sum((0..3).map(|j| turned[(i, j)] * r[j]));
        let at: Vec<Expr<'_>> = (0..3).map(|i| place[i] + arm(i)).chain(turned.entries().to_vec()).collect();
        let still = vec![0.0; k];
        let of = |y: &[f64]| values(&system, &at, y, &still);
        let velocities = values(&system, equations.velocities(), &y, &still);
        // At constant η, so that η̇ = 0.
        let drift = [velocities, still.clone()].concat();
        let moved = along(&y, &drift, of);
        assert!(difference(&w[..3], &moved[..3]) < DIFFERENCES, "{w:?} {moved:?}");
        // Ṙ = ω̂ R: ω̂ = Ṙ Rᵀ
        let rotation = &of(&y)[3..];
        let spin =
            |i: usize, j: usize| -> f64 { (0..3).map(|l| moved[3 + 3 * i + l] * rotation[3 * j + l]).sum() };
        let turning = [spin(2, 1), spin(0, 2), spin(1, 0)];
        assert!(difference(&w[3..], &turning) < DIFFERENCES, "{w:?} {turning:?}");

        let functions = [velocity, omega].concat();
        let known: Vec<_> = point.iter().copied().zip(r.map(Expr::from)).collect();
        let functions = graph.substitute(&functions, &known);
        let found = along(&y, &drift, |y| values(&system, &functions, y, &still));
        assert!(difference(&rates, &found) < DIFFERENCES, "{rates:?} {found:?}");
    });
}

#[test]
fn a_frame_that_moves_carries_its_points() {
    // A bead at r on a wire that turns at the rate ω, with η = ṙ: v = η e_r + ω r e_φ, v̇ = −ω² r e_r + 2 ω η e_φ.
    let graph = Graph::new();
    let [t, omega] = graph.symbols(["t", "ω"]);
    let bead = System::builder(&graph)
        .parameter(omega, 2.0)
        .coordinates(["r"])
        .kinetic(|_, x, v| (v[0].square() + (omega * x[0]).square()) / 2.0)
        .build()
        .unwrap();
    let [r, v] = graph.symbols(["r", "r'"]);
    let (cos, sin) = ((omega * t).cos(), (omega * t).sin());
    let velocity = [v * cos - omega * r * sin, v * sin + omega * r * cos];
    let mut map = bead.poincare().unwrap().velocity_map(&velocity, &[]).unwrap();
    let (mut jacobian, mut rest, mut rates) = ([0.0; 2], [0.0; 2], [0.0; 2]);
    for (rate, at, r, v) in [(2.0, 0.0, 0.5, 3.0), (1.5, 0.7, 2.0, -1.0)] {
        map.parameters_mut()[0] = rate;
        let (sin, cos) = f64::sin_cos(rate * at);
        map.map(at, &[r, v], &mut jacobian, &mut rest).unwrap();
        map.rates(at, &[r, v], &mut rates).unwrap();
        assert!(difference(&jacobian, &[cos, sin]) < 1e-15);
        assert!(difference(&rest, &[-rate * r * sin, rate * r * cos]) < 1e-15);
        let (inwards, across) = (-rate * rate * r, 2.0 * rate * v);
        let expected = [inwards * cos - across * sin, inwards * sin + across * cos];
        assert!(difference(&rates, &expected) < 1e-14, "{rates:?} {expected:?}");
    }
}

#[test]
fn what_is_not_affine_in_the_quasi_velocities_is_refused() {
    let graph = Graph::new();
    let free =
        System::builder(&graph).coordinates(["x"]).kinetic(|_, _, v| v[0].square() / 2.0).build().unwrap();
    let v = graph.symbol("x'");
    let error = free.poincare().unwrap().velocity_map(&[v, v.square()], &[]).unwrap_err();
    let expected = FrameError::NotAffine { what: "x'^2".to_owned(), quasi_velocity: "x'".to_owned() };
    assert_eq!(error, MechError::from(expected));
}
