//! Estimates of global errors of every built-in model, against the errors by references of 16 digits.

use pc_model::document::AbsoluteTolerance;
use pc_solve::{ErrorEstimate, Method, NoEvents, Options, Solve};
use pc_tests::reference::reference;

use crate::derived::Derived;
use crate::estimated::assert_estimated;
use crate::reference_states::STIFF;
use crate::taylor_references::REFUSED;

/// Stiff: an explicit method takes more steps than are allowed.
const EXPLICIT: [Method; 2] = [Method::Adams, Method::Taylor];

pub(crate) fn errors_are_estimated_within_a_factor_of_ten(derived: &Derived<'_>) {
    for method in [Method::Auto, Method::Adams, Method::Taylor] {
        let is_refused = method == Method::Taylor && derived.is_among(&REFUSED);
        if is_refused || EXPLICIT.contains(&method) && derived.name == STIFF {
            continue;
        }
        for rtol in [1e-6, 1e-9, 1e-12] {
            assert_right(derived, method, rtol);
        }
    }
}

fn assert_right(derived: &Derived<'_>, method: Method, rtol: f64) {
    let (name, t_start) = (derived.name, derived.assembly.t_start);
    let reference = reference(name).unwrap();
    let mut flow = derived.flow();
    let (times, start) = ([reference.t_end], flow.start.clone());
    let none = AbsoluteTolerance::default();
    let atol = flow.absolute_tolerances(&none, (t_start, reference.t_end), rtol);
    let options = Options::new(method).relative_tolerance(rtol).absolute_tolerance(atol);
    let field = flow.motion.clone();
    let solve = Solve::new(&mut flow.motion, t_start, &start).method(&options);
    let motion = solve.run(&times).unwrap_or_else(|failure| panic!("{name} by {method}: {failure}"));
    let estimate = ErrorEstimate::of(&motion, (field, t_start, &start), NoEvents, &times, &options);
    assert_eq!(estimate.len(), 1, "{name} by {method} at {rtol:e}: {:?}", estimate.failure());
    let errors = estimate.errors(&motion, 0);
    let names = flow.motion.names();
    for (column, expected) in reference.columns.iter().zip(reference.state) {
        let Some(i) = names.iter().position(|name| name == column) else { continue };
        let of = format!("{name}: {column} by {method} at {rtol:e}");
        assert_estimated(&of, motion.trajectory.state(0)[i], *expected, errors[i]);
    }
}
