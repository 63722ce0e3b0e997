//! Short forces on a body at rest: none is stepped over.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::boxed::{erased, from_fn};
use pc_expr::{Expr, Graph, Inputs, Interpreter, Kernel, Program, SteepFunctions, TimeDependence};
use pc_solve::{Failure, Method, Options, Reason, SolveError, Trajectory, VectorField, solve};

/// ẍ = −x + F(t, x), compiled.
struct Spring {
    program: Arc<Program>,
    kernel: Interpreter,
    /// Whether its dependence on time is known to integrators.
    shows: bool,
}

impl Spring {
    fn new(force: impl for<'g> Fn(Expr<'g>, Expr<'g>) -> Expr<'g>) -> Spring {
        let graph = Graph::new();
        let [t, x, v] = graph.symbols(["t", "x", "v"]);
        let inputs = Inputs { time: Some(t), state: vec![x, v], parameters: Vec::new() };
        let program = Arc::new(Program::new(&graph, &inputs, &[v, force(t, x) - x]).unwrap());
        Spring { kernel: Interpreter::new(Arc::clone(&program)), program, shows: true }
    }
}

impl VectorField for Spring {
    fn dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.kernel.eval(t, y, &[], ydot);
        Ok(())
    }
    fn time_dependence(&self) -> TimeDependence {
        if self.shows { TimeDependence::of(&[&self.program], 2, &[]) } else { TimeDependence::Unknown }
    }
    fn steep_functions(&self) -> Option<SteepFunctions> {
        SteepFunctions::of(&[&self.program], 2, &[]).filter(|_| self.shows)
    }
}

/// The motion from rest at 0 to `end`.
fn motion(field: impl VectorField, end: f64, method: Method) -> Trajectory {
    solve(erased(field), 0.0, &[0.0, 0.0], &[end], &Options::new(method)).unwrap()
}

fn gauss(at: f64, width: f64) -> Spring {
    Spring::new(move |t, _| (-((t - at) / width).square()).exp())
}

/// After the pulse x = w √π e^(−w²/4) sin(t − at), as ∫ sin(t − s) F(s) ds over all s gives.
fn after_gauss(t: f64, at: f64, width: f64) -> f64 {
    width * PI.sqrt() * (-width * width / 4.0).exp() * (t - at).sin()
}

/// Within the tolerance of a motion of size w at rtol 1e-9, over some hundred steps, and the sum of
/// absolute tolerances.
fn near(found: f64, expected: f64, width: f64) -> bool {
    (found - expected).abs() < 1e-6 * width + 1e-9
}

#[test]
fn a_pulse_on_a_body_at_rest_is_not_stepped_over() {
    for method in [Method::Adams, Method::Bdf, Method::Dop853, Method::Auto] {
        for width in [0.2, 1e-2, 1e-3, 1e-4] {
            for at in [0.05, 1.234_567, 5.0, 8.9] {
                let motion = motion(gauss(at, width), 10.0, method);
                let expected = after_gauss(10.0, at, width);
                // A pulse that begins before 0 is incomplete.
                let found = motion.state(0)[0];
                let whole = at > 5.0 * width;
                assert!(
                    !whole || near(found, expected, width),
                    "{method} {width} {at}: {found}, not {expected}"
                );
                // The explicit method meets some pulses by its stages, or by short first steps.
                let limits =
                    !matches!(method, Method::Adams | Method::Bdf) || motion.statistics().limited_steps > 0;
                assert!(!whole || limits, "{method} {width} {at}");
            }
        }
    }
}

#[test]
fn pulses_of_many_forms_are_not_stepped_over() {
    let (at, w) = (6.543_21, 1e-3);
    type Force = Box<dyn for<'g> Fn(Expr<'g>, Expr<'g>) -> Expr<'g>>;
    // Each with its integral, which is the speed that so short a pulse gives.
    let forces: [(&str, f64, Force); 7] = [
        ("switch on and off", w, Box::new(move |t, _| (t - at).step(1.0, 0.0) - (t - at - w).step(1.0, 0.0))),
        ("triangle", w, Box::new(move |t, _| (1.0 - ((t - at) / w).abs()).max(0.0))),
        ("cusp", 2.0 * w, Box::new(move |t, _| (-((t - at) / w).abs()).exp())),
        (
            "tanh up and down",
            2.0 * w,
            Box::new(move |t, _| {
                let edge = |shift: f64| ((t - at) / (0.05 * w) + shift).tanh();
                edge(10.0) - edge(-10.0)
            }),
        ),
        ("on the state", w * PI.sqrt(), Box::new(move |t, x| (-((t - at) / w).square()).exp() * (1.0 + x))),
        ("travelling", w * PI.sqrt(), Box::new(move |t, x| (-((t - at + x) / w).square()).exp())),
        ("between", w, Box::new(move |t, _| ((t - at) * (at + w - t)).step(1.0, 0.0))),
    ];
    for (name, speed, force) in forces {
        for method in [Method::Adams, Method::Dop853] {
            let motion = motion(Spring::new(&force), 10.0, method);
            // To first order in w/period: the time of the pulse is uncertain by w.
            let expected = speed * (10.0 - at).sin();
            let found = motion.state(0)[0];
            assert!((found - expected).abs() < 3.0 * w * speed, "{name} {method}: {found}, not {expected}");
        }
    }
}

/// A train of pulses, far apart, all found, forwards and backwards.
#[test]
fn each_of_many_pulses_is_found() {
    /// exp(−(sin(πt/10)/0.001)²): at 0, 10, 20, …, each of width 0.01/π.
    fn train(t: Expr<'_>) -> Expr<'_> {
        (-((t * (PI / 10.0)).sin() / 1e-3).square()).exp()
    }
    let width = 1e-2 / PI;
    for direction in [1.0, -1.0] {
        let free = Graph::new();
        let [t, v] = free.symbols(["t", "v"]);
        let inputs = Inputs { time: Some(t), state: vec![v], parameters: Vec::new() };
        let program = Arc::new(Program::new(&free, &inputs, &[train(t) + 0.0 * v]).unwrap());
        struct Body(Arc<Program>, Interpreter);
        impl VectorField for Body {
            fn dim(&self) -> usize {
                1
            }
            fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
                self.1.eval(t, y, &[], ydot);
                Ok(())
            }
            fn time_dependence(&self) -> TimeDependence {
                TimeDependence::of(&[&self.0], 1, &[])
            }
        }
        let body = Body(Arc::clone(&program), Interpreter::new(program));
        let start = 5.0 * direction;
        let motion =
            solve(erased(body), start, &[0.0], &[1005.0 * direction], &Options::new(Method::Adams)).unwrap();
        let expected = direction * 100.0 * width * PI.sqrt();
        let found = motion.state(0)[0];
        assert!((found - expected).abs() < 1e-6 * expected.abs(), "{found}, not {expected}");
    }
}

/// A field without explicit time takes no additional evaluations.
#[test]
fn a_field_without_time_costs_nothing() {
    let pendulum = || {
        from_fn(2, |_t, y: &[f64], ydot: &mut [f64]| {
            ydot.copy_from_slice(&[y[1], -y[0].sin()]);
            Ok(())
        })
    };
    let run = |field: &mut dyn VectorField| {
        let motion = solve(erased(field), 0.0, &[1.0, 0.0], &[100.0], &Options::new(Method::Adams)).unwrap();
        *motion.statistics()
    };
    let (plain, looked) = (run(&mut pendulum().autonomous()), run(&mut pendulum()));
    assert_eq!(plain.limited_steps, 0);
    // One of unknown time dependence is examined 64 times, and has a different first step.
    assert!(looked.rhs_evaluations <= plain.rhs_evaluations * 11 / 10 + 80, "{plain:?} {looked:?}");
    let spring = Spring::new(|_, x| x * 0.5);
    let same = from_fn(2, |_t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], 0.5 * y[0] - y[0]]);
        Ok(())
    });
    let start = [1.0, 0.0];
    let of = |field: &mut dyn VectorField| {
        *solve(erased(field), 0.0, &start, &[50.0], &Options::new(Method::Adams)).unwrap().statistics()
    };
    assert_eq!(of(&mut { spring }).rhs_evaluations, of(&mut same.autonomous()).rhs_evaluations);
}

/// A smooth force takes hardly more evaluations than without foresight.
#[test]
fn a_smooth_force_costs_little() {
    fn force(t: Expr<'_>) -> Expr<'_> {
        0.3 * (2.0 * t).cos() + (0.1 * t).tanh()
    }
    let end = 100.0;
    // The long steps of the explicit method contain turns of the force, which take the stages of
    // dense output too.
    for (method, tenths) in [(Method::Adams, 11), (Method::Dop853, 14)] {
        let shown = motion(Spring::new(|t, _| force(t)), end, method);
        let mut plain = Spring::new(|t, _| force(t));
        plain.shows = false;
        let plain = from_fn(2, move |t, y: &[f64], ydot: &mut [f64]| plain.rhs(t, y, ydot)).autonomous();
        let plain = motion(plain, end, method);
        let (shown, plain) = (shown.statistics(), plain.statistics());
        let fits = 10 * shown.rhs_evaluations <= tenths * plain.rhs_evaluations;
        assert!(fits, "{method}: {shown:?}\n{plain:?}");
    }
}

/// With unknown time dependence, a pulse of a fiftieth of the interval is found.
#[test]
fn a_function_of_a_program_is_sampled() {
    for k in 0..40 {
        let (at, width) = (0.5 + 0.23 * f64::from(k), 0.1);
        for method in [Method::Adams, Method::Dop853] {
            let field = from_fn(2, move |t: f64, y: &[f64], ydot: &mut [f64]| {
                ydot.copy_from_slice(&[y[1], (-((t - at) / width).powi(2)).exp() - y[0]]);
                Ok(())
            });
            let found = motion(field, 10.0, method).state(0)[0];
            let expected = after_gauss(10.0, at, width);
            assert!(near(found, expected, width), "{method} {at}: {found}, not {expected}");
        }
    }
}

/// Pulses of a tenth to a hundred-thousandth of the interval, each at 200 places spread by the
/// golden section.
#[test]
fn pulses_are_found_wherever_they_are() {
    let parts = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5];
    for (part, method) in parts.into_iter().flat_map(|part| [(part, Method::Adams), (part, Method::Dop853)]) {
        let width = 10.0 * part;
        // Four widths from the ends a pulse is complete up to 2e-8.
        let span = 10.0 - 8.0 * width;
        let found = (1..=200).filter(|&k| {
            let at = 4.0 * width + span * (0.618_033_988_749_894_8 * f64::from(k)).fract();
            let motion = motion(gauss(at, width), 10.0, method);
            near(motion.state(0)[0], after_gauss(10.0, at, width), width)
        });
        assert_eq!(found.count(), 200, "of width {width} by {method}");
    }
}

/// A force that turns faster than floating-point times resolve is refused early, unless it is below
/// the tolerances.
#[test]
fn a_force_that_no_step_can_follow_is_refused() {
    for (at, from) in [(1e21, 0.0), (1e17, 3.0)] {
        for method in [Method::Adams, Method::Bdf, Method::Dop853, Method::Auto] {
            let force = |size: f64| Spring::new(move |t, _| size * (at * t).sin());
            let run =
                |size| solve(erased(force(size)), from, &[1.0, 0.0], &[from + 10.0], &Options::new(method));
            let failure = run(1.0).unwrap_err();
            let SolveError::Integration(error) = &failure.error else { panic!("{}", failure.error) };
            assert!(matches!(error.reason, Reason::Unresolved { .. }), "{error}");
            assert!(
                error.time - from < 1e-3 && error.to_string().contains("faster than floating-point times"),
                "{error}"
            );
            // x = cos(t − t_0), to the tolerance of some hundred steps.
            let motion = run(1e-20).unwrap();
            assert!((motion.state(0)[0] - 10.0_f64.cos()).abs() < 1e-6, "{method} {:?}", motion.state(0));
            assert!(motion.statistics().steps < 2000, "{:?}", motion.statistics());
        }
    }
}
