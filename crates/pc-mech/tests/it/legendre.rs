//! Momenta and quasi-velocities converted into each other where L is not quadratic: y = ∂L/∂η by Newton's
//! method.

use crate::common::{compiled, rates, some};
use pc_mech::{
    Canonical, EvaluationError, Expr, ExprError, Graph, LagrangianError, MechError, ShapeError, System,
    VectorField,
};
use proptest::prelude::*;

/// L = ½ A_rs η_r η_s + ε |η|⁴ + a e^(b·η) + d·η, convex for ε, a ≥ 0 and positive definite A.
#[derive(Clone, Debug)]
struct Convex {
    /// B of A = 1 + B Bᵀ.
    b: Vec<f64>,
    quartic: f64,
    exponential: f64,
    slope: Vec<f64>,
    linear: Vec<f64>,
}

impl Convex {
    fn system<'g>(&self, graph: &'g Graph) -> System<'g> {
        let k = self.slope.len();
        let names = |letter: &str| (1..=k).map(|s| format!("{letter}{s}")).collect::<Vec<_>>();
        System::builder(graph)
            .coordinates(names("x"))
            .quasi_velocities(names("η"))
            .kinematics(|_, _, eta| eta.to_vec())
            .lagrangian(|t, x, eta| {
                let square = graph.sum(eta.iter().map(|eta| eta.square()));
                let projected = (0..k).map(|j| {
                    let column = (0..k).map(|i| eta[i] * self.b[i * k + j]);
                    graph.sum(column).square()
                });
                let along = |a: &[f64]| graph.sum(eta.iter().zip(a).map(|(&eta, &a)| eta * a));
                let quartic = self.quartic * (1.0 + x[0].square()) * square.square();
                let exponential = self.exponential * (along(&self.slope) * x[0].cos()).exp();
                let kinetic = (square + graph.sum(projected.collect::<Vec<_>>())) / 2.0;
                kinetic + quartic + exponential + t.cos() * along(&self.linear) * x[k - 1]
            })
            .build()
            .unwrap()
    }
}

fn convex() -> impl Strategy<Value = Convex> {
    (1usize..5).prop_flat_map(|k| {
        let entry = || prop::collection::vec(-1.0..1.0, k);
        (prop::collection::vec(-1.0..1.0, k * k), 0.1..2.0, 0.1..2.0, entry(), entry()).prop_map(
            |(b, quartic, exponential, slope, linear)| Convex { b, quartic, exponential, slope, linear },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 60,
        rng_seed: prop::test_runner::RngSeed::Fixed(18),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// η → y → η and y → η → y: as M ≥ 1, an error of y, some roundings of its terms, is at least that of η.
    #[test]
    fn quasi_velocities_and_momenta_are_converted_both_ways(
        lagrangian in convex(),
        x in prop::collection::vec(-2.0..2.0, 4),
        eta in prop::collection::vec(-5.0..5.0, 4),
    ) {
        let graph = Graph::new();
        let k = lagrangian.slope.len();
        let canonical = lagrangian.system(&graph).canonical().unwrap();
        prop_assert!(!canonical.is_closed());
        let mut transform = canonical.legendre_transform().unwrap();
        let velocities = [&x[..k], &eta[..k]].concat();
        let momenta = transform.to_momenta(0.3, &velocities).unwrap();
        let size = momenta.iter().fold(1.0f64, |size, v| size.max(v.abs()));
        let back = transform.to_quasi_velocities(0.3, &momenta).unwrap();
        for (a, b) in back.iter().zip(&velocities) {
            prop_assert!((a - b).abs() <= 1e-14 * size, "{back:?} instead of {velocities:?}");
        }
        let again = transform.to_momenta(0.3, &back).unwrap();
        for (a, b) in again.iter().zip(&momenta) {
            prop_assert!((a - b).abs() <= 2e-14 * size, "{again:?} instead of {momenta:?}");
        }
    }

    /// h² f‴/6 and ε f/h at h = 1e-5, relative to the largest entry.
    #[test]
    fn jacobians_agree_with_difference_quotients(
        lagrangian in convex(),
        x in prop::collection::vec(-1.0..1.0, 4),
        y in prop::collection::vec(-3.0..3.0, 4),
    ) {
        let graph = Graph::new();
        let k = lagrangian.slope.len();
        let mut motion = compiled(&lagrangian.system(&graph).canonical().unwrap());
        let state = [&x[..k], &y[..k]].concat();
        let (dim, h) = (2 * k, 1e-5);
        let mut jacobian = vec![f64::NAN; dim * dim];
        motion.jacobian(0.3, &state, &mut jacobian).unwrap();
        for j in 0..dim {
            let mut at = |shift: f64| {
                let mut state = state.clone();
                state[j] += shift;
                rates(&mut motion, 0.3, &state)
            };
            let (ahead, behind) = (at(h), at(-h));
            let difference: Vec<f64> = ahead.iter().zip(behind).map(|(a, b)| (a - b) / (2.0 * h)).collect();
            let column = &jacobian[j * dim..(j + 1) * dim];
            for (a, b) in column.iter().zip(&difference) {
                let size = difference.iter().fold(1.0f64, |size, v| size.max(v.abs()));
                prop_assert!((a - b).abs() <= 1e-6 * size, "column {j}: {column:?}, {difference:?}");
            }
        }
    }
}

/// Two particles of mass 10⁵ and 10⁻⁵ with velocities of light 10⁵ and 10⁻⁵: each velocity is as precise as
/// its own momentum.
#[test]
fn no_component_is_lost_beside_one_of_other_units() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["a", "b"])
        .lagrangian(|_, x, v| {
            let particle = |mc2: f64, c: f64, s: usize| -mc2 * (1.0 - (v[s] / c).square()).sqrt();
            particle(1e15, 1e5, 0) + particle(1e-15, 1e-5, 1) - x[0] * x[1]
        })
        .build()
        .unwrap();
    let mut transform = system.canonical().unwrap().legendre_transform().unwrap();
    for i in 0..50 {
        let (p, q) = (5.0 * some(i, 1), 5.0 * some(i, 2));
        let found = transform.to_quasi_velocities(0.0, &[0.0, 0.0, p * 1e10, q * 1e-10]).unwrap();
        for (found, expected) in [(found[2], 1e5 * p / p.hypot(1.0)), (found[3], 1e-5 * q / q.hypot(1.0))] {
            assert!((found / expected - 1.0).abs() < 1e-14, "{found:e} instead of {expected:e}");
        }
    }
}

/// L with ∂L/∂η = `p`(η) on a line.
fn on_a_line<'g>(graph: &'g Graph, lagrangian: impl Fn(Expr<'g>) -> Expr<'g>) -> Canonical<'g> {
    let line = System::builder(graph).coordinates(["x"]).lagrangian(|_, _, v| lagrangian(v[0]));
    line.build().unwrap().canonical().unwrap()
}

#[test]
fn a_momentum_that_no_velocity_has_is_an_error() {
    let graph = Graph::new();
    let arctangent = on_a_line(&graph, |v| v * v.atan() - (1.0 + v.square()).log() / 2.0);
    let graph = Graph::new();
    let tangent = on_a_line(&graph, |v| v.cosh().log());
    let graph = Graph::new();
    let linear_growth = on_a_line(&graph, |v| (1.0 + v.square()).sqrt());
    for (canonical, limit) in
        [(arctangent, std::f64::consts::FRAC_PI_2), (tangent, 1.0), (linear_growth, 1.0)]
    {
        let mut motion = compiled(&canonical);
        let inside = rates(&mut motion, 0.0, &[0.3, 0.9 * limit]);
        for y in [2.0 * limit, -3.0 * limit, 1e300] {
            let failure = motion.rhs(0.5, &[0.3, y], &mut [0.0; 2]).unwrap_err();
            assert!(failure.is_recoverable());
            match failure.into() {
                MechError::Evaluation(EvaluationError::LegendreNotSolved { residual, t, state, .. }) => {
                    let expected = y.abs() - limit;
                    assert!((residual - expected).abs() <= 1e-2 * expected, "{residual}, {expected}");
                    assert_eq!(t, 0.5);
                    assert_eq!(state, [("x".to_owned(), 0.3), ("p_x".to_owned(), y)]);
                }
                other => panic!("{other}"),
            }
            assert!(motion.observe(0.5, &[0.3, y])[0].is_nan());
            let mut transform = canonical.legendre_transform().unwrap();
            let error = transform.to_quasi_velocities(0.5, &[0.3, y]).unwrap_err();
            assert!(
                matches!(error, MechError::Evaluation(EvaluationError::LegendreNotSolved { .. })),
                "{error}"
            );
        }
        assert_eq!(rates(&mut motion, 0.0, &[0.3, 0.9 * limit]), inside, "a failure leaves no trace");
        let failure = motion.rhs(0.5, &[0.3, f64::NAN], &mut [0.0; 2]).unwrap_err();
        assert!(failure.to_string().contains("NaN"), "{failure}");
    }
}

#[test]
fn messages_name_momenta_and_state() {
    let graph = Graph::new();
    let mut motion = compiled(&on_a_line(&graph, |v| v.cosh().log()));
    let failure = motion.rhs(0.5, &[0.25, 2.0], &mut [0.0; 2]).unwrap_err().to_string();
    let (start, end) = ("no solution η of y = ∂L/∂η was found: after ", "at t = 0.5, x = 0.25, p_x = 2");
    assert!(failure.starts_with(start) && failure.ends_with(end), "{failure}");

    let mut transform = on_a_line(&graph, |v| -(1.0 - v.square()).sqrt()).legendre_transform().unwrap();
    let error = transform.to_momenta(0.0, &[0.0, 2.0]).unwrap_err();
    assert!(matches!(error, MechError::Expr(ExprError::NotFinite { .. })), "{error}");
    let shape = MechError::Shape(ShapeError { what: "the state", found: 1, expected: 2 });
    assert_eq!(transform.to_momenta(0.0, &[0.0]).unwrap_err(), shape);
    assert_eq!(transform.to_quasi_velocities(0.0, &[0.0]).unwrap_err(), shape);
}

/// p = η³ has a singular M at η = 0; p = η³ − 3η has three η for one y.
#[test]
fn the_guess_chooses_where_to_start_and_which_solution_is_found() {
    let graph = Graph::new();
    let quartic = on_a_line(&graph, |v| v.powi(4) / 4.0);
    let error = quartic.legendre_transform().unwrap().to_quasi_velocities(0.0, &[0.0, 8.0]).unwrap_err();
    let message = "the mass matrix is singular: its pivot for `x'` is 0 at t = 0, x = 0, p_x = 8";
    assert_eq!(error.to_string(), message);
    let mut transform = quartic.with_guess(&[1.0]).unwrap().legendre_transform().unwrap();
    assert_eq!(transform.to_quasi_velocities(0.0, &[0.0, 8.0]).unwrap(), [0.0, 2.0]);

    let wells = on_a_line(&graph, |v| v.powi(4) / 4.0 - 3.0 * v.square() / 2.0);
    for (guess, expected) in [(-2.0, -(3f64.sqrt())), (0.1, 0.0), (1.5, 3f64.sqrt())] {
        let mut transform = wells.clone().with_guess(&[guess]).unwrap().legendre_transform().unwrap();
        let found = transform.to_quasi_velocities(0.0, &[0.0, 0.0]).unwrap()[1];
        assert!((found - expected).abs() < 1e-15, "{found} from {guess}");
    }
    let shape =
        MechError::Shape(ShapeError { what: "the guess of the quasi-velocities", found: 2, expected: 1 });
    assert_eq!(wells.with_guess(&[0.0, 1.0]).unwrap_err(), shape);
}

#[test]
fn an_undetermined_velocity_is_still_refused() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| (v[0] + v[1]).powi(4) - x[0] * x[1])
        .build()
        .unwrap();
    assert!(matches!(
        system.canonical(),
        Err(MechError::Lagrangian(LagrangianError::Degenerate { rank: 1, size: 2, .. }))
    ));
}

/// L may have jumps and corners although ∂²L/∂η∂η does not contain η.
#[test]
fn a_lagrangian_that_is_quadratic_in_pieces_is_not_called_quadratic() {
    let system = |graph: &'static Graph, l: fn(Expr<'static>) -> Expr<'static>| {
        System::builder(graph)
            .coordinates(["x"])
            .lagrangian(move |_, x, v| l(v[0]) - x[0].square() / 2.0)
            .build()
            .unwrap()
    };
    let pieces: [fn(Expr<'static>) -> Expr<'static>; 4] = [
        |v| v.square() / 2.0 + 3.0 * v.abs(),
        |v| v.square() / 2.0 * v.step(Expr::ONE, 3.0),
        |v| v.square() * (2.0 + v.sign()),
        |v| v.square() + v.max(Expr::ONE),
    ];
    for piece in pieces {
        let graph: &'static Graph = Box::leak(Box::new(Graph::new()));
        let system = system(graph, piece);
        let canonical = system.canonical().unwrap();
        assert!(!canonical.is_closed(), "{}", system.lagrangian());
        let error = system.in_orthonormal_frame(["w"]).unwrap_err();
        assert_eq!(
            error,
            MechError::Lagrangian(LagrangianError::NotQuadratic { quasi_velocity: "x'".to_owned() })
        );
        for velocity in [-1.5, 2.0] {
            let canonical = canonical.clone().with_guess(&[velocity / 2.0]).unwrap();
            let mut transform = canonical.legendre_transform().unwrap();
            let state = transform.to_momenta(0.0, &[0.4, velocity]).unwrap();
            let mut rates = [0.0; 2];
            canonical.compile_for(pc_mech::Backend::Fastest).unwrap().rhs(0.0, &state, &mut rates).unwrap();
            assert!((rates[0] - velocity).abs() < 1e-12 && rates[1] == -0.4, "{rates:?}");
        }
    }
}
