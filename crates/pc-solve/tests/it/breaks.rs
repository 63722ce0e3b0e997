//! Fields that are not smooth at known times, which no step crosses.

use std::ops::ControlFlow;

use pc_expr::{Failure, VectorField};
use pc_solve::{Integration, Method, Observed, Options, solve};

use crate::boxed::erased;

/// ẏ = a y with a factor for each leg between two breaks, set by `enter`.
#[derive(Clone)]
struct Legs {
    breaks: Vec<f64>,
    factors: Vec<f64>,
    leg: usize,
}

impl Legs {
    fn new() -> Legs {
        Legs { breaks: vec![1.0, 1.25, 3.0], factors: vec![-1.0, 4.0, -4.0, 0.5], leg: 0 }
    }

    /// y(t) from y(0) = 1.
    fn exact(&self, t: f64) -> f64 {
        let ends = self.breaks.iter().copied().chain([f64::INFINITY]);
        let starts = [0.0].into_iter().chain(self.breaks.iter().copied());
        let legs = starts.zip(ends).zip(&self.factors);
        legs.map(|((from, to), a)| a * (t.min(to) - from).max(0.0)).sum::<f64>().exp()
    }
}

impl VectorField for Legs {
    fn dim(&self) -> usize {
        1
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let from = self.leg.checked_sub(1).map_or(f64::NEG_INFINITY, |i| self.breaks[i]);
        let to = self.breaks.get(self.leg).copied().unwrap_or(f64::INFINITY);
        assert!((from..=to).contains(&t), "{t} is outside {from}..{to}");
        ydot[0] = self.factors[self.leg] * y[0];
        Ok(())
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        let leg = match end >= t {
            true => self.breaks.partition_point(|&time| time <= t),
            false => self.breaks.partition_point(|&time| time < t),
        };
        std::mem::replace(&mut self.leg, leg) != leg
    }
}

/// At, before and after breaks.
const TIMES: [f64; 6] = [0.5, 1.0, 1.1, 2.0, 3.0, 4.0];

/// Tolerances: the errors of some hundred steps of 1e-10 each, at worst of one sign.
#[test]
fn each_leg_is_integrated_by_itself() {
    for method in [Method::Bdf, Method::Adams, Method::Dop853, Method::Auto] {
        let options = Options::new(method).relative_tolerance(1e-10).absolute_tolerance(1e-14);
        let found = solve(erased(Legs::new()), 0.0, &[1.0], &TIMES, &options).unwrap();
        for (t, y) in found.iter() {
            let exact = Legs::new().exact(t);
            assert!((y[0] / exact - 1.0).abs() < 1e-7, "{method:?}: y({t}) = {}, not {exact}", y[0]);
        }
        let statistics = found.statistics();
        assert_eq!(statistics.current_time, 4.0);
        assert!(statistics.steps > 20, "those of all legs are counted: {statistics:?}");
    }
}

#[test]
fn steps_end_at_breaks() {
    let mut cvode = Integration::new(erased(Legs::new()), 0.0, &[1.0], &Options::default()).unwrap();
    let mut ends = Vec::new();
    let step = |t, _: &[f64]| {
        ends.push(t);
        ControlFlow::Continue(())
    };
    cvode.run_observed(&[5.0], Observed::new(|_, _| ControlFlow::Continue(())).steps(step)).unwrap();
    for at in Legs::new().breaks {
        assert!(ends.contains(&at), "{at}");
    }
}

/// Back to the start.
#[test]
fn each_leg_is_integrated_by_itself_backwards() {
    let options = Options::default().relative_tolerance(1e-10).absolute_tolerance(1e-14).stop_time(0.0);
    let mut field = Legs::new();
    field.leg = 3;
    let start = field.exact(4.0);
    let mut cvode = Integration::new(erased(field), 4.0, &[start], &options).unwrap();
    let end = cvode.state_at(0.0).unwrap()[0];
    assert!((end - 1.0).abs() < 1e-7, "{end}");
}

/// ẏ = u, with an input changed between steps: 2 up to t = 1, then −3, also if a step went beyond.
#[test]
fn a_field_is_changed_at_the_current_time() {
    struct Input(f64);
    impl VectorField for Input {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _: f64, _: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot[0] = self.0;
            Ok(())
        }
    }
    let mut cvode = Integration::new(Input(2.0), 0.0, &[0.0], &Options::default()).unwrap();
    assert!((cvode.state_at(1.0).unwrap()[0] - 2.0).abs() < 1e-12);
    cvode.change(|field| field.0 = -3.0).unwrap();
    assert_eq!(cvode.time(), 1.0);
    assert!((cvode.state_at(3.0).unwrap()[0] + 4.0).abs() < 1e-12);
}

/// A step that may pass its target does not cross a break at the target, nor one beyond it.
#[test]
fn targets_at_and_before_breaks_are_reached_within_the_leg() {
    let options = Options::default().relative_tolerance(1e-10).absolute_tolerance(1e-14);
    let mut cvode = Integration::new(Legs::new(), 0.0, &[1.0], &options).unwrap();
    for t in [0.999, 1.0, 1.2, 1.25, 2.999, 3.0, 3.5] {
        let y = cvode.state_at(t).unwrap()[0];
        let exact = cvode.field().exact(t);
        assert!((y / exact - 1.0).abs() < 1e-7, "y({t}) = {y}, not {exact}");
    }
}
