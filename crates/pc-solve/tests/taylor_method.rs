//! Taylor's method: motions known in closed form, its order and its steps.

mod fields;

use fields::{field, oscillator};
use pc_solve::{Integration, IntegrationMethod, Reason, SolveError, Stepper, TaylorOptions, from_fn};

#[test]
fn an_oscillator_is_followed_to_rounding() {
    let options = TaylorOptions::new().relative_tolerance(1e-16).absolute_tolerance(1e-16);
    let mut motion = Integration::of(options.begin(oscillator(), 0.0, &[1.0, 0.0], None).unwrap());
    for t in [1.0, 10.0, 100.0, 3.0e3] {
        let y = motion.state_at(t).unwrap();
        // The phase of t radians is known to some roundings of t.
        let bound = 8.0 * f64::EPSILON * (1.0 + t);
        assert!((y[0] - t.cos()).abs() < bound && (y[1] + t.sin()).abs() < bound, "{t}: {y:?}");
    }
    println!("{:?}", motion.statistics());
}
