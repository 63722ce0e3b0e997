//! Narrow barriers and pulses in the state: no method carries a motion over them.

use crate::boxed::erased;
use pc_expr::{Backend, Expr, Graph, Inputs, Program, ProgramField, VectorField};
use pc_solve::{Integration, Method, Options, Solve, Statistics, Stepper};

const METHODS: [Method; 5] = [Method::Auto, Method::Dop853, Method::Adams, Method::Bdf, Method::Taylor];

/// ẍ = F(x, z), ż = 1.
fn body(force: impl for<'g> Fn(Expr<'g>, Expr<'g>) -> Expr<'g>) -> ProgramField {
    let graph = Graph::new();
    let [x, v, z] = graph.symbols(["x", "v", "z"]);
    let inputs = Inputs { time: None, state: vec![x, v, z], parameters: vec![] };
    let program = Program::new(&graph, &inputs, &[v, force(x, z), 1.0.into()]).unwrap();
    ProgramField::new(program, vec![], Backend::Fastest)
}

fn begin(
    field: ProgramField,
    start: &[f64],
    method: Method,
) -> Integration<impl Stepper<Field = Box<dyn VectorField>>> {
    Solve::new(erased(field), 0.0, start).method(Options::new(method)).start().unwrap()
}

/// (x, v) after the time `end`, and the work.
fn end(field: ProgramField, start: [f64; 2], end: f64, method: Method) -> ([f64; 2], Statistics) {
    let start = [start[0], start[1], 0.0];
    let mut motion = begin(field, &start, method);
    let state = motion.state_at(end).unwrap();
    let state = [state[0], state[1]];
    (state, motion.statistics())
}

/// Against a barrier of four times its energy a body turns round, with the speed that it had: the time is that
/// to the turning point and back, ∫ dx/√(1 − 4 e^(−u²)) = 2 a + O(w).
#[test]
fn a_barrier_reflects() {
    for width in [1e-1, 1e-2, 1e-3, 1e-4] {
        for at in [2.1, 3.456_789, 7.9] {
            let field = || {
                body(move |x, _| {
                    let u = (x - at) / width;
                    // −V′ of V = 2 exp(−u²)
                    4.0 * u / width * (-u.square()).exp()
                })
            };
            for method in METHODS {
                let ([x, v], work) = end(field(), [0.0, 1.0], 10.0, method);
                // The energy is lost at some hundred steps of rtol 1e-9 of forces that are 1/w.
                assert!((v + 1.0).abs() < 1e-5, "{method} {width} {at}: {v}");
                assert!((x - (2.0 * at - 10.0)).abs() < 10.0 * width, "{method} {width} {at}: {x}");
                assert!(work.rhs_evaluations < 4000, "{method} {width}: {work:?}");
            }
        }
    }
}

/// Pulses in a first-order clock push as much as their area says.
#[test]
fn pulses_in_a_clock_push() {
    let pi = std::f64::consts::PI;
    for width in [1e-1, 1e-2, 1e-3, 1e-4] {
        for method in METHODS {
            let gauss = body(move |_, z| (-((z - 4.3) / width).square()).exp() / width);
            let ([_, v], _) = end(gauss, [0.0, 0.0], 10.0, method);
            assert!((v - pi.sqrt()).abs() < 1e-6, "{method} {width}: {v}");
            let lorentz = body(move |_, z| 1.0 / (1.0 + ((z - 4.3) / width).square()) / width);
            let ([_, v], _) = end(lorentz, [0.0, 0.0], 10.0, method);
            let area = (5.7 / width).atan() + (4.3 / width).atan();
            assert!((v - area).abs() < 1e-6, "{method} {width}: {v}, not {area}");
            // A box with soft edges, between which each function is constant.
            let area = 2.0 * 0.5;
            let field = body(move |_, z| {
                let u = (z - 4.3) / width;
                ((100.0 * (u + 0.25)).tanh() - (100.0 * (u - 0.25)).tanh()) / width
            });
            let ([_, v], _) = end(field, [0.0, 0.0], 10.0, method);
            assert!((v - area).abs() < 1e-6, "{method} {width}: {v}");
        }
    }
}

/// The way bends before the barrier: what was predicted at the start of a step would pass beside it.
#[test]
fn a_barrier_on_a_curved_way_reflects() {
    for method in METHODS {
        // Falls from rest through 5 at t = √10.
        let field = body(|x, _| {
            let u = (x - 5.0) / 1e-3;
            1.0 + 400.0 * u / 1e-3 * (-u.square()).exp()
        });
        let ([x, v], _) = end(field, [0.0, 0.0], 2.0 * 10f64.sqrt(), method);
        assert!(x.abs() < 0.05 && v.abs() < 0.05, "{method}: back at rest, not {x}, {v}");
    }
}

/// Far from a peak no step is changed.
#[test]
fn a_peak_off_the_way_costs_nothing() {
    let plain = |hidden: bool| {
        let graph = Graph::new();
        let [x, v] = graph.symbols(["x", "v"]);
        let inputs = Inputs { time: None, state: vec![x, v], parameters: vec![] };
        // The peak is nowhere on the way.
        let peak = 1e-3 * (-((x - 50.0) / 0.1).square()).exp();
        let force = if hidden { peak - x } else { -x };
        let program = Program::new(&graph, &inputs, &[v, force]).unwrap();
        ProgramField::new(program, vec![], Backend::Fastest)
    };
    // Taylor's method chooses its order by the length of the equations.
    for method in [Method::Auto, Method::Dop853, Method::Adams, Method::Bdf] {
        let work = |hidden| {
            let mut motion = begin(plain(hidden), &[1.0, 0.0], method);
            motion.state_at(50.0).unwrap();
            let statistics = motion.statistics();
            (statistics.steps, statistics.rhs_evaluations)
        };
        let ((steps, evaluations), (more_steps, more)) = (work(false), work(true));
        // One for the direction in which the first step goes.
        assert!(steps == more_steps && more <= evaluations + 1, "{method}: {evaluations} {more}");
    }
}
