//! Motions known in closed form.
//!
//! All methods control the local error, which adds up over an interval; these tests allow 1000
//! times the relative tolerance, over intervals in which neighbouring motions do not diverge.

use crate::boxed::erased;
use crate::fields::{field, oscillator};
use pc_expr::ProgramField;
use pc_solve::{Method, NonlinearSolver, Options, solve};

const RTOL: f64 = 1e-9;
const MARGIN: f64 = 1e3 * RTOL;

/// Each method, those of CVODES with each nonlinear solver.
fn all_options() -> Vec<Options> {
    let mut all = Vec::new();
    for method in [Method::Adams, Method::Bdf] {
        for solver in [NonlinearSolver::Newton, NonlinearSolver::FixedPoint] {
            all.push(Options::new(method).nonlinear_solver(solver).relative_tolerance(RTOL));
        }
    }
    let explicit = [Method::Dop853, Method::Taylor, Method::Auto];
    all.extend(explicit.map(|method| Options::new(method).relative_tolerance(RTOL)));
    all
}

/// The free top with I = (1, 2, 3).
fn top() -> ProgramField {
    field(|_, [a, b, c]| [-b * c, c * a, -a * b / 3.0])
}

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64]) {
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() < MARGIN, "component {i}: {a} is not {b}");
    }
}

#[test]
fn linear_oscillator() {
    let times: Vec<f64> = (0..=20).map(f64::from).collect();
    for options in all_options() {
        let motion = solve(erased(oscillator()), 0.0, &[1.0, 0.0], &times, &options).unwrap();
        assert!(motion.is_complete());
        assert_eq!(motion.times(), times);
        assert_eq!(motion.state(0), [1.0, 0.0]);
        for (t, y) in motion.iter() {
            assert_near(y, &[t.cos(), -t.sin()]);
        }
    }
}

#[test]
fn linear_oscillator_backwards() {
    let times: Vec<f64> = (1..=20).map(|i| -f64::from(i)).collect();
    for options in all_options() {
        let motion = solve(erased(oscillator()), 0.0, &[1.0, 0.0], &times, &options).unwrap();
        for (t, y) in motion.iter() {
            assert_near(y, &[t.cos(), -t.sin()]);
        }
        assert!(motion.statistics().last_step < 0.0);
    }
}

#[test]
fn exponential_with_a_tolerance_for_each_component() {
    for options in all_options() {
        let decay = field(|_, [x, y]| [-x, y * -1e-6]);
        let options = options.absolute_tolerance(vec![1e-12, 1e-18]);
        let motion = solve(erased(decay), 1.0, &[1.0, 1e-6], &[2.0, 3.0], &options).unwrap();
        for (t, y) in motion.iter() {
            assert_near(&[y[0], 1e6 * y[1]], &[(1.0 - t).exp(), (1e-6 * (1.0 - t)).exp()]);
        }
    }
}

/// Time enters explicitly: ẏ = 2t, y = t².
#[test]
fn right_hand_side_of_time() {
    for options in all_options() {
        let rising = field(|t, [_y]| [t * 2.0]);
        let motion = solve(erased(rising), -1.0, &[1.0], &[0.5, 3.0], &options).unwrap();
        assert_near(motion.states(), &[0.25, 9.0]);
        let falling = field(|t, [_y]| [t * 2.0]);
        let motion = solve(erased(falling), 3.0, &[9.0], &[0.5, -1.0], &options).unwrap();
        assert_near(motion.states(), &[0.25, 1.0]);
    }
}

/// The free top with I = (1, 2, 3) from (√3, 0, 1) moves along the separatrix, where the elliptic
/// functions of Jacobi degenerate: ω = (√3 sech t, √3 tanh t, sech t). [Landau, Lifshitz,
/// Mechanics, § 37]
///
/// The motion ends at the unstable rotation about the middle axis, near which an error grows as
/// e^t; t ≤ 3.
#[test]
fn free_top_on_the_separatrix() {
    let root3 = 3.0_f64.sqrt();
    for options in all_options() {
        for times in [[1.0, 2.0, 3.0], [-1.0, -2.0, -3.0]] {
            let motion = solve(erased(top()), 0.0, &[root3, 0.0, 1.0], &times, &options).unwrap();
            for (t, w) in motion.iter() {
                let sech = 1.0 / t.cosh();
                let growth = t.abs().exp();
                let scaled = |w: [f64; 3]| w.map(|x| x / growth);
                assert_near(&scaled([w[0], w[1], w[2]]), &scaled([root3 * sech, root3 * t.tanh(), sech]));
            }
        }
    }
}

/// The same top off the separatrix: start (1, 0, 1), ω = (cn t, sn t, dn t) with parameter m = 1/3;
/// the values at t = 20 were computed in extended precision; at −20 sn has the other sign.
#[test]
fn free_top() {
    for options in all_options() {
        for end in [20.0_f64, -20.0] {
            let motion = solve(erased(top()), 0.0, &[1.0, 0.0, 1.0], &[end], &options).unwrap();
            let sn = (-0.7043589832440595_f64).copysign(-end);
            assert_near(motion.state(0), &[0.7098439425137012, sn, 0.9135787546280825]);
        }
    }
}
