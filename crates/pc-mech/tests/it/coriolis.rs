//! The Coriolis matrix against Christoffel's symbols written by hand, and by its two properties: C η are the terms of the
//! equations quadratic in η, and C + Cᵀ is the rate of M along η.

use crate::common::{driven, top_of_parameters};
use crate::trees::{Hung, difference, geared, hung, state, trees, values};
use pc_mech::{Equations, Expr, Graph, LagrangianError, Matrix, MechError, System};

/// Columns as products go through the recursion of a tree twice: its rounding errors, relative to the largest entry.
const ROUNDING: f64 = 1e-12;

/// η_r X_r M for a frame with b_0 = 0, entry by entry.
fn rate_of_mass<'g>(equations: &Equations<'g>) -> Matrix<Expr<'g>> {
    let (system, mass) = (equations.system(), equations.mass_matrix());
    let (frame, k) = (system.frame(), mass.rows());
    let drift =
        |i: usize| system.graph().sum(frame.b().nonzero(i).map(|(s, b)| b * system.quasi_velocities()[s]));
    let x = frame.coordinates();
    let along: Vec<_> = x.iter().copied().zip((0..x.len()).map(drift)).collect();
    let rates = system.graph().directional(&mass.entries(), &along);
    Matrix::from_fn(k, k, |r, s| rates[r * k + s])
}

/// Checks C + Cᵀ = η_r X_r M, and that C η is what the right-hand side, without forces, has of degree two in η.
fn check(equations: &Equations<'_>) {
    let (system, graph) = (equations.system(), equations.system().graph());
    let (c, rate) = (equations.coriolis_matrix().unwrap(), rate_of_mass(equations));
    let eta = system.quasi_velocities();
    let turned = |sign: i32| -> Vec<_> { eta.iter().map(|&eta| (eta, eta * sign)).collect() };
    let back = graph.substitute(equations.right_hand_side(), &turned(-1));
    let at_rest = graph.substitute(equations.right_hand_side(), &turned(0));
    for s in 0..eta.len() {
        for m in 0..eta.len() {
            assert!((c[(s, m)] + c[(m, s)] - rate[(s, m)]).is_zero(), "{s}, {m}: {}", c[(s, m)]);
        }
        let product = graph.sum((0..eta.len()).map(|m| c[(s, m)] * eta[m]));
        let quadratic = (equations.right_hand_side()[s] + back[s]) / 2.0 - at_rest[s];
        assert!((product + quadratic).is_zero(), "{s}: {product} and {quadratic}");
    }
}

#[test]
fn a_planar_arm_has_its_christoffel_symbols() {
    // Spong & Vidyasagar: with h = −m2 l1 lc2 sin q2, C = [h q2', h (q1' + q2'); −h q1', 0].
    let graph = Graph::new();
    let [m1, m2, l1, a1, a2, i1, i2, g] = graph.symbols(["m1", "m2", "l1", "lc1", "lc2", "I1", "I2", "g"]);
    let arm = System::builder(&graph)
        .coordinates(["q1", "q2"])
        .kinetic(|_, q, v| {
            let both = v[0] + v[1];
            let elbow = l1.square() * v[0].square()
                + a2.square() * both.square()
                + 2.0 * l1 * a2 * q[1].cos() * v[0] * both;
            (m1 * (a1 * v[0]).square() + m2 * elbow + i1 * v[0].square() + i2 * both.square()) / 2.0
        })
        .potential(|_, q, _| g * ((m1 * a1 + m2 * l1) * q[0].sin() + m2 * a2 * (q[0] + q[1]).sin()))
        .build()
        .unwrap();
    let equations = arm.poincare().unwrap();
    let c = equations.coriolis_matrix().unwrap();
    let [q2, v1, v2] = graph.symbols(["q2", "q1'", "q2'"]);
    let h = -m2 * l1 * a2 * q2.sin();
    for (s, m, expected) in [(0, 0, h * v2), (0, 1, h * (v1 + v2)), (1, 0, -h * v1), (1, 1, 0.into())] {
        assert!((c[(s, m)] - expected).is_zero(), "C_{s}{m} = {}", c[(s, m)]);
    }
    check(&equations);
}

#[test]
fn a_double_pendulum_in_absolute_angles_has_no_terms_on_the_diagonal() {
    // M_12 = m2 l1 l2 cos(α − β) alone changes, with the symbols [22, 1] = ∂M_12/∂β and [11, 2] = ∂M_12/∂α.
    let graph = Graph::new();
    let [m1, m2, l1, l2] = graph.symbols(["m1", "m2", "l1", "l2"]);
    let pendulum = System::builder(&graph)
        .coordinates(["α", "β"])
        .kinetic(|_, x, v| {
            let [p, q] = [l1 * v[0], l2 * v[1]];
            let tip = p.square() + q.square() + 2.0 * p * q * (x[0] - x[1]).cos();
            (m1 * p.square() + m2 * tip) / 2.0
        })
        .build()
        .unwrap();
    let equations = pendulum.poincare().unwrap();
    let c = equations.coriolis_matrix().unwrap();
    let [alpha, beta, u, v] = graph.symbols(["α", "β", "α'", "β'"]);
    let h = m2 * l1 * l2 * (alpha - beta).sin();
    for (s, m, expected) in [(0, 0, 0.into()), (0, 1, h * v), (1, 0, -h * u), (1, 1, 0.into())] {
        assert!((c[(s, m)] - expected).is_zero(), "C_{s}{m} = {}", c[(s, m)]);
    }
    check(&equations);
}

#[test]
fn a_top_has_a_skew_symmetric_matrix() {
    // M is constant: all of C is due to the brackets, with C ω = ω × I ω.
    let graph = Graph::new();
    let equations = top_of_parameters(&graph).build().unwrap().poincare().unwrap();
    check(&equations);
    let c = equations.coriolis_matrix().unwrap();
    let [a, b, third, w3] = graph.symbols(["A", "B", "C", "ω3"]);
    // Γ_{1,32} = ½ (c_32^1 A − c_31^2 B − c_21^3 C) = ½ (−A − B + C)
    assert!((c[(0, 1)] - w3 * (third - a - b) / 2.0).is_zero(), "{}", c[(0, 1)]);
}

#[test]
fn a_frame_that_moves_has_the_terms_of_degree_two() {
    let graph = Graph::new();
    let builder = driven(&graph);
    let system = builder
        .kinetic(|t, x, eta| {
            ((1.0 + x[1].square()) * eta[0].square() + t * x[0] * eta[0] * eta[1] + 3.0 * eta[1].square())
                / 2.0
                + x[1] * eta[0]
        })
        .build()
        .unwrap();
    check(&system.poincare().unwrap());
}

#[test]
fn constraints_that_are_not_integrable_project_the_connection() {
    // z' = y x': M = diag(1 + y², 1), and (1 + y²) x'' + y y' x' = 0 has half of the term that M alone would give.
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .quasi_velocities(["u", "v", "w"])
        .kinematics(|_, x, eta| [eta[0], eta[1], eta[2] + x[1] * eta[0]])
        .kinetic(|_, x, eta| (eta[0].square() + eta[1].square() + (eta[2] + x[1] * eta[0]).square()) / 2.0)
        .build()
        .unwrap();
    let equations = particle.poincare_constrained(2).unwrap();
    let c = equations.coriolis_matrix().unwrap();
    let [y, v] = graph.symbols(["y", "v"]);
    let expected = [y * v, Expr::ZERO, Expr::ZERO, Expr::ZERO];
    assert!(c.entries().iter().zip(expected).all(|(&c, expected)| (c - expected).is_zero()), "{c:?}");
    check(&equations);
}

#[test]
fn an_energy_that_is_not_quadratic_has_none() {
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, _, v| -(1.0 - v[0].square()).sqrt())
        .build()
        .unwrap();
    let error = particle.poincare().unwrap().coriolis_of_motion().unwrap_err();
    assert_eq!(error, MechError::from(LagrangianError::NoCoriolisMatrix { quasi_velocity: "x'".to_owned() }));
}

/// C η = h without weight and loads; C + Cᵀ = Ṁ, found by differentiation of M along the flow; and the whole matrix, where
/// products of a large tree found it.
#[test]
fn trees_have_both_properties() {
    let checked = |bodies: &[_], numbers: &[f64]| {
        let graph = Graph::new();
        let system = hung(&graph, bodies, false);
        let equations = system.poincare().unwrap();
        let (y, k) = (state(bodies, numbers), system.quasi_velocities().len());
        let n = y.len() - k;
        let mut found = vec![f64::NAN; k * k];
        equations.coriolis_of_motion().unwrap().eval(0.0, &y, &mut found).unwrap();
        let whole = equations.coriolis_matrix().unwrap();
        let columns: Vec<Expr<'_>> = (0..k).flat_map(|m| whole.column(m)).collect();
        let expected = values(&system, &columns, &y, &vec![0.0; k]);
        assert!(difference(&found, &expected) < ROUNDING, "{found:?} {expected:?}");
        let rate = rate_of_mass(&equations);
        let rate = values(&system, &rate.entries(), &y, &vec![0.0; k]);
        let twice: Vec<f64> = (0..k * k).map(|i| found[i] + found[i % k * k + i / k]).collect();
        assert!(difference(&twice, &rate) < ROUNDING, "{twice:?} {rate:?}");
        let product: Vec<f64> = (0..k).map(|s| (0..k).map(|m| found[s + k * m] * y[n + m]).sum()).collect();
        let mut bias = vec![f64::NAN; k];
        equations.inverse_dynamics_of_motion().unwrap().bias(0.0, &y, &mut bias).unwrap();
        assert!(difference(&product, &bias) < ROUNDING, "{product:?} {bias:?}");
    };
    trees(8, 2, checked);
    trees(4, 3, checked);
}

/// The same without the whole matrix, which is long: joints that follow others, with armatures.
#[test]
fn geared_trees_have_the_products() {
    geared(12, 7, |bodies, numbers| {
        // Without springs and dampers.
        let bodies: Vec<_> = bodies.iter().cloned().map(Hung::with_inertia_alone).collect();
        let graph = Graph::new();
        let system = hung(&graph, &bodies, false);
        let equations = system.poincare().unwrap();
        let (y, k) = (state(&bodies, numbers), system.quasi_velocities().len());
        let n = y.len() - k;
        let mut found = vec![f64::NAN; k * k];
        equations.coriolis_of_motion().unwrap().eval(0.0, &y, &mut found).unwrap();
        let product: Vec<f64> = (0..k).map(|s| (0..k).map(|m| found[s + k * m] * y[n + m]).sum()).collect();
        let mut dynamics = equations.inverse_dynamics_of_motion().unwrap();
        let mut bias = vec![f64::NAN; k];
        dynamics.bias(0.0, &y, &mut bias).unwrap();
        assert!(difference(&product, &bias) < ROUNDING, "{product:?} {bias:?}");
        // Ṁ by differences of fourth order in the step, along ẋ: 1e-12 of truncation, 1e-16/1e-3 of rounding.
        let rates = system.frame().velocities(system.quasi_velocities());
        let mut drift = values(&system, &rates, &y, &vec![0.0; k]);
        drift.resize(n + k, 0.0);
        let h = 1e-3;
        let mut beside = |steps: f64| {
            let moved = y.iter().zip(&drift).map(|(y, rate)| y + steps * h * rate);
            let mut mass = vec![f64::NAN; k * k];
            dynamics.mass_matrix(0.0, &moved.collect::<Vec<_>>(), &mut mass).unwrap();
            mass
        };
        let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(&mut beside);
        let rate: Vec<f64> =
            (0..k * k).map(|i| (a[i] - 8.0 * b[i] + 8.0 * c[i] - d[i]) / (12.0 * h)).collect();
        let twice: Vec<f64> = (0..k * k).map(|i| found[i] + found[i % k * k + i / k]).collect();
        assert!(difference(&twice, &rate) < 1e-8, "{twice:?} {rate:?}");
    });
}
