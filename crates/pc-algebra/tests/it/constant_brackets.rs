//! Brackets of frames whose operators are dependent at each point: found if the frame determines them,
//! refused otherwise.

use pc_algebra::{AlgebraError, CATALOGUE, Frame, LieAlgebra, Matrix, Neighbourhood, StructureCoefficients};
use pc_expr::{Expr, Graph, Number};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn near<'g>() -> Neighbourhood<'g> {
    Neighbourhood::default()
}

/// Equal, or equal at p = 0.7 up to the rounding of fractions beyond 2⁵³ and of results computed from them.
fn assert_same<'g>(graph: &'g Graph, c: &StructureCoefficients<'g>, expected: &StructureCoefficients<'g>) {
    let k = expected.operators();
    let at = [(graph.symbol("p"), 0.7)];
    let is_rounding = |difference: Expr<'g>| {
        graph.evaluate(&[difference], &at).is_ok_and(|difference| difference[0].abs() < 1e-9)
    };
    for (r, s, m) in (0..=k).flat_map(|r| (0..=k).flat_map(move |s| (1..=k).map(move |m| (r, s, m)))) {
        let difference = c.get(r, s, m) - expected.get(r, s, m);
        assert!(
            difference.is_zero() || is_rounding(difference),
            "c_{r}{s}^{m} = {} instead of {}",
            c.get(r, s, m),
            expected.get(r, s, m)
        );
    }
}

/// γ̇ = γ × (σ ω + Ω), with σ diagonal.
fn turning<'g>(graph: &'g Graph, scale: [Expr<'g>; 3], drift: [Expr<'g>; 3]) -> Frame<'g> {
    let [t, a, b, c, w1, w2, w3] = graph.symbols(["t", "γ1", "γ2", "γ3", "ω1", "ω2", "ω3"]);
    let omega = [0, 1, 2].map(|i| scale[i] * [w1, w2, w3][i] + drift[i]);
    let velocities = [b * omega[2] - c * omega[1], c * omega[0] - a * omega[2], a * omega[1] - b * omega[0]];
    Frame::from_velocities(graph, t, vec![a, b, c], &[w1, w2, w3], &velocities).unwrap()
}

/// Sixteen places around the sphere, some near its poles: the brackets are the same everywhere.
#[test]
fn brackets_do_not_depend_on_the_start() {
    let graph = Graph::new();
    let frame = turning(&graph, [Expr::ONE; 3], [Expr::ZERO; 3]);
    for start in 0..16 {
        let (z, turn) = (f64::from(start) / 8.0 - 0.97, 0.7 * f64::from(start));
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let place = [radius * turn.cos(), radius * turn.sin(), z];
        let centre = frame.coordinates().iter().copied().zip(place).collect();
        let c = frame.structure_coefficients(&Neighbourhood { centre }).unwrap();
        assert_eq!(c.lie_algebra(), Some(LieAlgebra::so3()));
    }
}

/// With σ_s ω_s for ω_s: [X_1, X_2] = σ_1 σ_2/σ_3 X_3.
#[test]
fn brackets_are_fractions_of_any_size_or_functions_of_parameters() {
    let graph = Graph::new();
    let [p, q] = graph.symbols(["p", "q"]);
    for scale in [[1.into(), Expr::ratio(37, 100), Expr::ratio(5, 997)], [p, q.cos(), 2.0 * q.sqrt()]] {
        let c = turning(&graph, scale, [Expr::ZERO; 3]).structure_coefficients(&near()).unwrap();
        assert_eq!(c.get(1, 2, 3), scale[0] * scale[1] / scale[2]);
        assert_eq!(c.get(2, 3, 1), scale[1] * scale[2] / scale[0]);
        assert_eq!(c.get(3, 1, 2), scale[2] * scale[0] / scale[1]);
    }
}

/// X_0 = ∂/∂t + Ω_r X_r: [X_0, X_s] = Ω_r [X_r, X_s].
#[test]
fn brackets_with_time_are_functions_of_time() {
    let graph = Graph::new();
    let [t, p] = graph.symbols(["t", "p"]);
    let drift = [Expr::ZERO, 0.37 * t, p * (0.3 * t).cos()];
    let c = turning(&graph, [Expr::ONE; 3], drift).structure_coefficients(&near()).unwrap();
    assert_eq!([c.get(0, 1, 2), c.get(0, 1, 3)], [drift[2], -drift[1]]);
    assert_eq!([c.get(0, 3, 1), c.get(0, 3, 2)], [drift[1], -drift[0]]);
}

/// √2 and cos 0.3 are rounded, and so are the brackets.
#[test]
fn rounded_constants_have_rounded_brackets() {
    let graph = Graph::new();
    let scale = [2f64.sqrt(), 0.3f64.cos(), 1.0];
    let c = turning(&graph, scale.map(Expr::from), [Expr::ZERO; 3]).structure_coefficients(&near()).unwrap();
    let found = c.get(1, 2, 3).constant().unwrap().to_f64();
    assert!((found - scale[0] * scale[1]).abs() < 1e-9, "{found}"); // solved from points near each other
}

/// Any multiple of a vanishing combination could be added to every bracket.
#[test]
fn operators_that_are_dependent_over_the_constants_have_no_brackets_of_their_own() {
    let graph = Graph::new();
    let [t, x, y, p, q] = graph.symbols(["t", "x", "y", "p", "q"]);
    let [u, v, w] = graph.symbols(["u", "v", "w"]);
    let cases = [
        ([u + 2.0 * v, Expr::ZERO], "2*X_1 - X_2"),
        ([Expr::ZERO, v + w], "X_1"),
        ([x.cos() * u, x.sin() * u + v + x * w], "none"),
        ([p * u + q * t * v, p * x * u + q * t * x * v + w], "(t*q/p)*X_1 - X_2"),
        ([u + x * v - (3.0 + x) * w, y * u + x * y * v - (3.0 * y + x * y) * w], "-3*X_1 - X_2 - X_3"),
        ([x.abs() * u + x.square().sqrt() * v + w, Expr::ZERO], "X_1 - X_2"),
    ];
    for (velocities, combination) in cases {
        let frame = Frame::from_velocities(&graph, t, vec![x, y], &[u, v, w], &velocities).unwrap();
        let found = frame.structure_coefficients(&near());
        if combination == "none" {
            assert!(!matches!(found, Err(AlgebraError::Undetermined { .. })), "{found:?}");
            continue;
        }
        let error = found.unwrap_err();
        assert!(matches!(error, AlgebraError::Undetermined { operators: 3, .. }), "{error}");
        let words =
            format!("structure coefficients: {combination} acts as zero on the coordinates, with rank");
        assert!(error.to_string().contains(&words), "{error}");
    }
}

/// [X_1, X_2] = p X_2, [X_0, X_2] = u X_2, [X_0, X_1] = v X_1.
fn stretching<'g>(p: Expr<'g>, u: Expr<'g>, v: Expr<'g>) -> StructureCoefficients<'g> {
    StructureCoefficients::new(3, |r, s, m| match (r, s, m) {
        (1, 2, 1) => p,
        (0, 2, 1) => u,
        (0, 1, 0) => v,
        _ => Expr::ZERO,
    })
}

#[test]
fn jacobis_identity_counts_parameters_and_time() {
    let graph = Graph::new();
    let [t, p] = graph.symbols(["t", "p"]);
    let frame = Frame::new(&graph, t, vec![], Matrix::from_fn(0, 3, |_, _| Expr::ZERO), vec![]).unwrap();
    let structure = |stretch| stretching(p, stretch, stretch - t.cos());
    assert_eq!(frame.check_jacobi(&structure(t.cos()), &near()), Ok(()));
    let error = frame.check_jacobi(&structure(t.sin()), &near()).unwrap_err();
    assert!(matches!(error, AlgebraError::Jacobi { triple: (0, 1, 2), component: 2, .. }), "{error}");
}

/// The fields of the coadjoint action, X_r = c_rs^m x_m ∂/∂x_s, which are independent over the constants where
/// the algebra has no centre.
fn coadjoint<'g>(graph: &'g Graph, algebra: &LieAlgebra) -> Frame<'g> {
    let k = algebra.dim();
    let x: Vec<Expr<'g>> = (1..=k).map(|i| graph.symbol(&format!("x{i}"))).collect();
    let b = Matrix::from_fn(k, k, |s, r| -> Expr<'g> {
        (0..k).map(|m| x[m] * Expr::from(algebra.constant(r, s, m))).sum()
    });
    Frame::new(graph, graph.symbol("t"), x, b, vec![Expr::ZERO; k]).unwrap()
}

fn fraction() -> impl Strategy<Value = Number> {
    (-40i64..=40, 1i64..=90).prop_map(|(num, den)| Number::ratio(num, den))
}

/// Algebras of the catalogue without centre.
fn centreless() -> Vec<LieAlgebra> {
    let all = CATALOGUE.iter().map(|entry| LieAlgebra::named(entry.name).unwrap());
    all.filter(|algebra| algebra.dim() <= 6 && algebra.centre().unwrap().dim() == 0).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, rng_seed: RngSeed::Fixed(16), ..ProptestConfig::default() })]

    /// A constant change of frame, in numbers and with parameters: the brackets found are those of the
    /// catalogue, changed.
    #[test]
    fn brackets_of_the_catalogue_are_found_in_any_basis(
        which in 0usize..64,
        entries in prop::collection::vec(fraction(), 36),
        parameters in any::<bool>(),
    ) {
        let graph = Graph::new();
        let algebras = centreless();
        let algebra = &algebras[which % algebras.len()];
        let k = algebra.dim();
        let p = graph.symbol("p");
        // Parameters only where the fractions stay exact; rounded numbers have no relations with parameters.
        let parameters = parameters && k <= 3;
        // Triangular: regular, with a short inverse.
        let a = Matrix::from_fn(k, k, |i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => Expr::ZERO,
            std::cmp::Ordering::Equal if parameters && i == 0 => p,
            std::cmp::Ordering::Equal => Expr::from(Number::integer(1 + (i % 3) as i32)),
            std::cmp::Ordering::Greater => Expr::from(entries[i * k + j]),
        });
        let change = coadjoint(&graph, algebra).changed_by(&a, &vec![Expr::ZERO; k]).unwrap();
        let expected = change.structure_coefficients(&algebra.structure_coefficients()).unwrap();
        let found = change.frame().structure_coefficients(&near()).unwrap();
        assert_same(&graph, &found, &expected);
    }

    /// Where rank b = k, transformed brackets are those of the transformed frame: in other quasi-velocities,
    /// and after the elimination of some where the remaining operators are integrable.
    #[test]
    fn brackets_carried_over_are_those_of_the_frame(
        shears in prop::collection::vec(fraction(), 9),
        place in 0usize..3,
        moves in any::<bool>(),
    ) {
        let graph = Graph::new();
        let [t, x, y, z, u, v, w] = graph.symbols(["t", "x", "y", "z", "u", "v", "w"]);
        let number = |i: usize| Expr::from(shears[i]);
        let rates = [
            u + number(0) * y * v + t.sin(),
            v * (2.0 + z.cos()) + number(1) * x * w,
            w * (1.0 + x.square()) + number(2) * y * u + t * x,
        ];
        let frame = Frame::from_velocities(&graph, t, vec![x, y, z], &[u, v, w], &rates).unwrap();
        let c = frame.structure_coefficients(&near()).unwrap();
        let a = Matrix::from_fn(3, 3, |i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => number(3) * x * t,
            std::cmp::Ordering::Equal => 3.0 + y.sin(),
            std::cmp::Ordering::Greater => number(4) * z,
        });
        let change = frame.changed_by(&a, &[x * t, number(5), y]).unwrap();
        let by_frame = change.frame().structure_coefficients(&near()).unwrap();
        assert_same(&graph, &change.structure_coefficients(&c).unwrap(), &by_frame);

        // f = x + f_1 sin y + f_2 z² (+ t²) = const, solved for one of the quasi-velocities.
        let f = x + number(6) * y.sin() + (number(7) + 1.0) * z.square() + if moves { t.square() } else { Expr::ZERO };
        let slopes: Vec<Expr<'_>> = (1..=3).map(|s| frame.apply(s, &[f])[0]).collect();
        prop_assume!(!slopes[place].is_zero());
        let free: Vec<usize> = (0..3).filter(|&s| s != place).collect();
        let matrix = Matrix::from_fn(1, 2, |_, s| -slopes[free[s]] / slopes[place]);
        let drift = vec![-frame.apply(0, &[f])[0] / slopes[place]];
        let left = frame.eliminated(&[place], matrix, drift).unwrap();
        let by_frame = left.frame().structure_coefficients(&near()).unwrap();
        assert_same(&graph, &left.structure_coefficients(&c, &near()).unwrap(), &by_frame);
    }
}
