//! End states of the built-in models by Taylor's method, forwards and back again, against references of 16 digits.

use pc_mech::VectorField;
use pc_solve::{Integration, Method, Options, Taylor};
use pc_tests::reference::reference;

use crate::derived::Derived;

/// What is asked at rtol = 1e-15: the references have 16 digits, and motions magnify the rounding of the start, 1e-16, by at most a few
/// hundred.
const TOLERANCE: f64 = 1e-13;

/// There and back it is magnified again, by the damping of some.
const THERE_AND_BACK: f64 = 1e-11;

/// Against time this one runs away from its slow motion, at a rate of 10⁷.
pub(crate) const IRREVERSIBLE: &str = "stiff-sleigh";

/// Multipliers are solved for in numbers.
pub(crate) const REFUSED: [&str; 3] = ["appell-hamel", "carriage", "vertical-disk"];

pub(crate) fn taylor_reaches_the_references_and_comes_back(derived: &Derived<'_>) {
    let (name, t_start) = (derived.name, derived.assembly.t_start);
    let reference = reference(name).unwrap();
    let (mut motion, start) = derived.motion();
    let series = motion.series().map(|_| ());
    assert_eq!(series.is_err(), derived.is_among(&REFUSED), "{name}: {series:?}");
    if let Err(failure) = series {
        assert!(failure.to_string().contains("solved for in numbers"), "{failure}");
        return;
    }
    let mut watch = motion.clone();
    let options = Options::new(Method::Taylor).relative_tolerance(1e-15).absolute_tolerance(1e-16);
    let stepper = Taylor::new(&mut motion, t_start, &start, &options).unwrap();
    let mut integration = Integration::of(stepper);
    let end = integration.state_at(reference.t_end).unwrap().to_vec();
    let mut compared = 0;
    for (column, expected) in reference.columns.iter().zip(reference.state) {
        let Some(i) = watch.names().iter().position(|name| name == column) else { continue };
        let error = (end[i] - expected).abs() / (1.0 + expected.abs());
        assert!(error <= TOLERANCE, "{name}: {column} is {}, not {expected}", end[i]);
        compared += 1;
    }
    assert_eq!(compared, watch.names().len().min(reference.state.len()), "{name}");
    let first = watch.observe(t_start, &start);
    let last = watch.observe(reference.t_end, &end);
    let names = watch.observable_names();
    for conserved in reference.conserved {
        let i = names.iter().position(|name| name == conserved).unwrap();
        let drift = (last[i] - first[i]).abs() / (1.0 + first[i].abs());
        assert!(drift <= TOLERANCE, "{name}: {conserved} drifts by {drift:e}");
    }
    if name == IRREVERSIBLE {
        return;
    }
    integration.restart(reference.t_end, &end).unwrap();
    let back = integration.state_at(t_start).unwrap();
    for (i, (back, start)) in back.iter().zip(&start).enumerate() {
        let error = (back - start).abs();
        assert!(error <= THERE_AND_BACK, "{name}: {} comes back to {back}, not {start}", watch.names()[i]);
    }
}
