//! Brackets that are given by an algebra alone, through changes of frame and integrable constraints.

use pc_algebra::inverse;
use pc_mech::{Constraint, Expr, Graph, LieAlgebra, Matrix, StructureCoefficients, System};

/// An algebra with a subalgebra, and a linear form that vanishes on all brackets.
struct Case {
    algebra: &'static str,
    subalgebra: &'static [usize],
    form: &'static [i32],
}

const CASES: [Case; 6] = [
    Case { algebra: "bianchi5", subalgebra: &[0, 1], form: &[1, 0, 0] },
    Case { algebra: "se2", subalgebra: &[1, 2], form: &[2, 0, 0] },
    Case { algebra: "heisenberg", subalgebra: &[0, 2], form: &[1, 2, 0] },
    Case { algebra: "sl2", subalgebra: &[0, 1], form: &[] },
    Case { algebra: "se3", subalgebra: &[0, 1, 2], form: &[] },
    Case { algebra: "so4", subalgebra: &[0, 1, 2], form: &[] },
];

/// Some numbers from 0.2 to 1.2.
fn some(i: usize) -> f64 {
    0.2 + (0.618_033_988_75 * (i + 1) as f64).fract()
}

fn weight(s: usize) -> f64 {
    1.0 + some(s + 30)
}

/// q̇ = χ_s η_s if there is a form χ; L = ½ Σ w_s η_s² + cos q, with the algebra given.
fn system<'g>(graph: &'g Graph, case: &Case) -> System<'g> {
    let algebra = LieAlgebra::named(case.algebra).unwrap();
    let names = (1..=algebra.dim()).map(|s| format!("a{s}"));
    let coordinates: &[&str] = if case.form.is_empty() { &[] } else { &["q"] };
    System::builder(graph)
        .coordinates(coordinates)
        .quasi_velocities(names)
        .kinematics(|_, x, eta| {
            let rate = || eta.iter().zip(case.form).map(|(&eta, &form)| eta * form).sum::<Expr<'_>>();
            x.iter().map(|_| rate()).collect::<Vec<_>>()
        })
        .algebra(&algebra)
        .kinetic(|_, _, eta| eta.iter().enumerate().map(|(s, eta)| eta.square() * weight(s) / 2.0).sum())
        .potential(|_, x, _| x.iter().map(|x| -x.cos()).sum())
        .build()
        .unwrap()
}

/// η̇_s of the subalgebra, by hand: w_s η̇_s = c_rs^m η_r w_m η_m − χ_s sin q.
fn by_hand(case: &Case, q: f64, eta: &[f64]) -> Vec<f64> {
    let algebra = LieAlgebra::named(case.algebra).unwrap();
    let mut rates = vec![0.0; eta.len()];
    for &s in case.subalgebra {
        let force = case.form.get(s).map_or(0.0, |&form| -f64::from(form) * q.sin());
        let brackets = case.subalgebra.iter().flat_map(|&r| case.subalgebra.iter().map(move |&m| (r, m)));
        let turned: f64 =
            brackets.map(|(r, m)| algebra.constant(r, s, m).to_f64() * eta[r] * weight(m) * eta[m]).sum();
        rates[s] = (turned + force) / weight(s);
    }
    rates
}

/// The accelerations in another frame, η' = (A + sin q N) η, under integrable constraints agree with those by
/// hand; so do the canonical equations.
#[test]
fn integrable_constraints_keep_the_brackets_that_are_given() {
    for case in &CASES {
        let graph = Graph::new();
        let system = system(&graph, case);
        let (k, q) = (system.quasi_velocities().len(), graph.symbol("q"));
        let bend = if case.form.is_empty() { Expr::ZERO } else { q.sin() };
        let constant = |i: usize, j: usize| if j <= i { some(7 * i + j) + f64::from(i == j) } else { 0.0 };
        let bent = |i: usize, j: usize| if j < i { some(5 * i + 3 * j + 11) } else { 0.0 };
        let a = Matrix::from_fn(k, k, |i, j| constant(i, j) + bend * bent(i, j));
        let names: Vec<String> = (1..=k).map(|s| format!("b{s}")).collect();
        let b: Vec<Expr<'_>> = names.iter().map(|name| graph.symbol(name)).collect();
        let definitions: Vec<Expr<'_>> = (0..k)
            .map(|u| graph.dot(a.row(u).iter().copied(), system.quasi_velocities().iter().copied()))
            .collect();
        let changed = system.in_quasi_velocities(&names, &definitions).unwrap();
        assert!(changed.frame().rank() < k);

        let back = inverse(&graph, &a).unwrap();
        let dropped = (0..k).filter(|s| !case.subalgebra.contains(s));
        let constraints: Vec<Constraint<'_>> = dropped
            .map(|s| {
                Constraint::new(
                    format!("k{s}"),
                    graph.dot(back.row(s).iter().copied(), b.iter().copied()) * 2.0,
                )
            })
            .collect();
        let held = changed.with_multipliers(&constraints).unwrap();

        let place = 0.4;
        let eta: Vec<f64> =
            (0..k).map(|s| if case.subalgebra.contains(&s) { some(s + 3) - 0.5 } else { 0.0 }).collect();
        let expected = by_hand(case, place, &eta);
        let rate: f64 = eta.iter().zip(case.form).map(|(eta, &form)| eta * f64::from(form)).sum();
        let entry = |i: usize, j: usize| {
            constant(i, j) + if case.form.is_empty() { 0.0 } else { place.sin() * bent(i, j) }
        };
        let value = |u: usize| (0..k).map(|s| entry(u, s) * eta[s]).sum::<f64>();
        let acceleration = |u: usize| -> f64 {
            (0..k).map(|s| entry(u, s) * expected[s] + place.cos() * rate * bent(u, s) * eta[s]).sum()
        };
        let mut at: Vec<(Expr<'_>, f64)> = b.iter().enumerate().map(|(u, &b)| (b, value(u))).collect();
        at.extend([(q, place), (graph.symbol("t"), 0.0)]);

        let free = held.in_independent_velocities(&at).unwrap();
        let equations = free.poincare().unwrap();
        let found = graph.evaluate(&equations.accelerations(), &at).unwrap();
        for (symbol, found) in free.quasi_velocities().iter().zip(&found) {
            let expected = acceleration(b.iter().position(|b| b == symbol).unwrap());
            // some hundred operations with numbers of order one to ten
            assert!(
                (found - expected).abs() < 1e-12,
                "{}: {symbol}' = {found}, not {expected}",
                case.algebra
            );
        }

        // ẏ by (10) and by differentiating y = ∂L/∂η along the motion.
        let canonical = free.canonical().unwrap();
        let along: Vec<_> = [q]
            .into_iter()
            .zip(equations.velocities().iter().copied())
            .chain(free.quasi_velocities().iter().copied().zip(equations.accelerations()))
            .collect();
        let rates = graph.directional(canonical.momenta_of_velocities(), &along);
        let momenta: Vec<_> = canonical
            .momenta()
            .iter()
            .copied()
            .zip(canonical.momenta_of_velocities().iter().copied())
            .collect();
        let right = graph.substitute(canonical.right_hand_side(), &momenta);
        let both = graph.evaluate(&[rates, right].concat(), &at).unwrap();
        let (rates, right) = both.split_at(both.len() / 2);
        for (rate, right) in rates.iter().zip(right) {
            assert!(
                (rate - right).abs() < 1e-11 * (1.0 + rate.abs()),
                "{}: {rate} and {right}",
                case.algebra
            );
        }
    }
}

/// ẏ = η_2 and x = t: the push along X_1 makes c_02^3 = c_12^3 of the Heisenberg algebra, η̇_2 = η_3.
#[test]
fn a_drift_gives_brackets_with_time() {
    let graph = Graph::new();
    let [t, x, w2, w3] = graph.symbols(["t", "x", "w2", "w3"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .quasi_velocities(["w1", "w2", "w3"])
        .kinematics(|_, _, eta| [eta[0], eta[1]])
        .algebra(&LieAlgebra::named("heisenberg").unwrap())
        .lagrangian(|_, _, eta| (eta[0].square() + eta[1].square() + eta[2].square()) / 2.0)
        .build()
        .unwrap();
    let held = system.with_multipliers(&[Constraint::new("pushed", x - t)]).unwrap();
    let at: Vec<_> = ["t", "x", "y", "w1", "w2", "w3"]
        .map(|name| graph.symbol(name))
        .into_iter()
        .zip([0.0, 0.0, 0.0, 1.0, 0.3, 0.7])
        .collect();
    let free = held.in_independent_velocities(&at).unwrap();
    assert_eq!(free.quasi_velocities(), [w2, w3]);
    assert_eq!(free.structure().get(0, 1, 2), Expr::ONE);
    assert_eq!(free.poincare().unwrap().accelerations(), [w3, Expr::ZERO]);
}

/// Brackets may contain parameters and, with time, t; those that violate Jacobi's identity are refused.
#[test]
fn given_brackets_may_contain_parameters_and_time() {
    let graph = Graph::new();
    let [t, p, w1, w2] = graph.symbols(["t", "p", "w1", "w2"]);
    let stretched = |stretch| {
        System::builder(&graph)
            .parameter(p, 2.0)
            .quasi_velocities(["w1", "w2"])
            .structure(StructureCoefficients::new(2, |r, s, m| match (r, s, m) {
                (1, 2, 1) => p,
                (0, 2, 1) => t.cos(),
                (0, 1, 0) => stretch,
                _ => Expr::ZERO,
            }))
            .lagrangian(|_, _, eta| (eta[0].square() + eta[1].square()) / 2.0)
            .build()
    };
    let system = stretched(Expr::ZERO).unwrap();
    // v_s = (c_rs^m η_r + c_0s^m) p_m
    let expected = [-p * w2.square(), p * w1 * w2 + t.cos() * w2];
    assert_eq!(system.poincare().unwrap().right_hand_side(), expected);
    let error = stretched(Expr::ONE).unwrap_err().to_string();
    assert_eq!(error, "the Jacobi identity fails for the operators 0, 1 and 2: its component along X_2 is p");
}
