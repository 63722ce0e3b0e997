//! Another method for `Integration`: order, states inside steps, events, checkpoints, breaks,
//! failures.

use std::num::NonZeroU64;
use std::ops::ControlFlow::Continue;

use crate::boxed::{erased, from_fn};
use pc_expr::Failure;
use pc_solve::{
    Checkpoint, Ending, Event, FixedStep, FnEvents, InputError, Integration, Reason, Resumable, RungeKutta4,
    Solve, SolveError, VectorField,
};

/// y = (cos t, −sin t).
fn oscillator() -> impl VectorField {
    from_fn(2, |_t, y: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    })
}

fn oscillating(length: f64) -> Integration<RungeKutta4<impl VectorField>> {
    Integration::of(
        RungeKutta4::new(oscillator(), 0.0, &[1.0, 0.0], &FixedStep::new(length)).expect("valid input"),
    )
}

fn slope(error: impl Fn(f64) -> f64) -> f64 {
    (error(0.1) / error(0.025)).log2() / 2.0
}

#[test]
fn the_error_falls_with_the_fourth_power_of_the_step() {
    for end in [2.0_f64, -2.0] {
        let error = |length: f64| {
            let mut motion = oscillating(length);
            let y = motion.state_at(end).unwrap();
            (y[0] - end.cos()).hypot(y[1] + end.sin())
        };
        assert!((slope(error) - 4.0).abs() < 0.05, "{end}: {}", slope(error));
    }
}

#[test]
fn states_inside_steps_are_as_accurate_and_rates_nearly() {
    let worst = |length: f64, order: u32, exact: fn(f64) -> f64| {
        let mut motion = oscillating(length);
        let mut worst = 0.0_f64;
        while motion.time() < 2.0 {
            let from = motion.time();
            let to = motion.step_towards(5.0).unwrap();
            for part in [0.0, 0.2, 0.5, 0.7, 1.0] {
                let t = from + part * (to - from);
                worst = worst.max((motion.interpolate(t, order).unwrap()[0] - exact(t)).abs());
            }
        }
        worst
    };
    // The error of the cubic Hermite interpolant is h⁴/384 y⁗, that of each derivative one power of
    // h larger.
    for (order, exact) in [f64::cos, |t: f64| -t.sin(), |t: f64| -t.cos(), f64::sin].into_iter().enumerate() {
        let found = slope(|length| worst(length, order as u32, exact));
        let expected = 4.0 - order as f64;
        assert!((found - expected).abs() < 0.15, "order {order}: {found}");
    }
    let mut motion = oscillating(0.1);
    motion.step_towards(1.0).unwrap();
    let error = motion.interpolate(0.05, 4).unwrap_err();
    assert!(matches!(error, SolveError::Input(InputError::DerivativeOrder { order: 4, highest: 3 })));
}

#[test]
fn dense_output_is_what_interpolation_gives() {
    let dense =
        Solve::new(erased(oscillator()), 0.0, &[1.0, 0.0]).method(FixedStep::new(0.1)).dense(1.0).unwrap();
    assert_eq!(dense.span(), Some((0.0, 1.0)));
    for i in 0..=40 {
        let t = f64::from(i) / 40.0;
        let y = oscillating(0.1).state_at(t).unwrap().to_vec();
        let of_polynomial = dense.evaluate(t).unwrap();
        assert!((of_polynomial[0] - y[0]).abs() < 1e-14, "{t}: {of_polynomial:?} {y:?}");
    }
}

const G: f64 = 9.81;

/// Height and velocity of a ball, and its bounces with a restitution of 1/2.
fn ball() -> (impl VectorField, FnEvents<'static>) {
    let fall = from_fn(2, |_t, y: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[y[1], -G]);
        Ok(())
    });
    let reset = |_t: f64, y: &mut [f64]| -> Result<(), Failure> {
        y[1] *= -0.5;
        Ok(())
    };
    (fall, FnEvents::new().with_reset(Event::new("bounce").falling(), |_t, y| Ok(y[0]), reset))
}

#[test]
fn a_ball_bounces_when_it_should() {
    let (fall, bounce) = ball();
    let motion = Solve::new(erased(fall), 0.0, &[1.0, 0.0])
        .method(FixedStep::new(0.07))
        .events(bounce)
        .run(&[1.2])
        .unwrap();
    // The fall takes τ = √(2/g), each flight half as long as the previous one: 2τ/2, 2τ/4, …
    let fall_time = (2.0 / G).sqrt();
    let times = [1.0, 2.0, 2.5].map(|k| k * fall_time);
    assert_eq!(motion.occurrences.len(), 3);
    for (occurrence, t) in motion.occurrences.iter().zip(times) {
        // The method is exact for parabolas up to rounding.
        assert!((occurrence.time - t).abs() < 1e-14, "{} {t}", occurrence.time);
    }
    let (since, speed) = (1.2 - times[2], G * fall_time / 8.0);
    let height = speed * since - G * since * since / 2.0;
    assert!((motion.trajectory.state(0)[0] - height).abs() < 1e-13);
    assert_eq!(motion.ending, Some(Ending::Completed));
}

#[test]
fn a_resumed_integration_is_the_same_to_the_last_bit() {
    let (method, every) = (FixedStep::new(0.013), NonZeroU64::new(9).unwrap());
    let times = [0.3, 0.9, 1.15];
    let mut kept = Vec::new();
    let whole = Resumable::new(ball, Checkpoint::start(0.0, &[1.0, 0.0]))
        .method(&method)
        .every(every)
        .run(&times, |checkpoint, _| kept.push(checkpoint.to_bytes("ball")), |_, _| Continue(()))
        .unwrap();
    assert!(kept.len() > 5 && whole.occurrences.len() == 3);
    for bytes in kept {
        let (from, _) = Checkpoint::from_bytes(&bytes).unwrap();
        let later = Resumable::new(ball, from)
            .method(&method)
            .every(every)
            .run(&times, |_, _| (), |_, _| Continue(()))
            .unwrap();
        assert_eq!(later, whole);
    }
    // A one-step method loses no history at a checkpoint: its steps are those without.
    let (fall, bounce) = ball();
    let plain =
        Solve::new(erased(fall), 0.0, &[1.0, 0.0]).method(&method).events(bounce).run(&times).unwrap();
    assert_eq!(plain.occurrences, whole.occurrences);
}

#[test]
fn steps_end_at_the_last_time_and_not_beyond() {
    let late = |t: f64, _y: &[f64], rates: &mut [f64]| {
        assert!(t <= 1.0, "{t}");
        rates[0] = t;
        Ok(())
    };
    let motion =
        Solve::new(erased(from_fn(1, late)), 0.0, &[0.0]).method(FixedStep::new(0.3)).run(&[1.0]).unwrap();
    assert!((motion.trajectory.state(0)[0] - 0.5).abs() < 1e-15);
    assert_eq!(motion.trajectory.statistics().steps, 4);
    assert_eq!(motion.trajectory.statistics().rhs_evaluations, 1 + 4 * 4);
}

/// ẏ = 0 before t = 1 and 1 after it.
struct Switch {
    breaks: [f64; 1],
    on: bool,
}

impl VectorField for Switch {
    fn dim(&self) -> usize {
        1
    }

    fn rhs(&mut self, t: f64, _y: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        assert!(if self.on { t >= 1.0 } else { t <= 1.0 }, "{t} {}", self.on);
        rates[0] = f64::from(u8::from(self.on));
        Ok(())
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        let before = std::mem::replace(&mut self.on, if end > t { t >= 1.0 } else { t > 1.0 });
        before != self.on
    }
}

#[test]
fn steps_end_where_the_field_jumps() {
    for (t0, end, expected) in [(0.0, 2.5, 1.5), (2.5, 0.0, -1.5)] {
        let field = Switch { breaks: [1.0], on: false };
        let motion = Solve::new(erased(field), t0, &[0.0]).method(FixedStep::new(0.3)).run(&[end]).unwrap();
        assert!((motion.trajectory.state(0)[0] - expected).abs() < 1e-14, "{t0} → {end}");
    }
}

#[test]
fn invalid_input_is_refused() {
    let begin =
        |length: f64| RungeKutta4::new(oscillator(), 0.0, &[1.0, 0.0], &FixedStep::new(length)).map(|_| ());
    for length in [0.0, -0.1, f64::NAN] {
        assert!(matches!(begin(length), Err(SolveError::Input(_))), "{length}");
    }
    let root = from_fn(1, |_t, y: &[f64], rates: &mut [f64]| {
        rates[0] = -y[0].sqrt() - 1.0;
        Ok(())
    });
    let failure =
        Solve::new(erased(root), 0.0, &[1.0]).method(FixedStep::new(0.1)).run(&[0.2, 5.0]).unwrap_err();
    assert_eq!(failure.reached.trajectory.len(), 1);
    let SolveError::Integration(error) = &failure.error else { panic!("{}", failure.error) };
    assert!(matches!(error.reason, Reason::Rates { t } if t > 0.5 && t < 0.9), "{error}");
    assert!(error.to_string().starts_with("the rates at t = 0."), "{error}");
}
