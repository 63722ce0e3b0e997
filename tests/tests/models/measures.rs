//! The density of an invariant measure, times the compiled field, has no divergence.

use pc_tests::fuzz::random::Random;

use crate::derived::Derived;

pub(crate) fn measures_of_known_systems_are_kept(derived: &Derived<'_>) {
    let mut findings = derived.findings.borrow_mut();
    let random = &mut Random::new(1, 0);
    findings.measures.compare(derived.name, &derived.assembly, derived.free_system(), random);
}
