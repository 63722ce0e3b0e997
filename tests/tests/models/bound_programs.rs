//! Programs with numbers in place of parameters.

use std::sync::Arc;

use pc_expr::{Interpreter, Kernel};
use pc_print::Operations;

use crate::derived::Derived;

/// States tried with each choice of the parameters.
const STATES: usize = 8;

/// Numbers in place of parameters never make a right-hand side longer.
pub(crate) fn bound_programs_cost_no_more_than_free_ones(derived: &Derived<'_>) {
    let operations = Operations::of(&derived.equations).unwrap();
    assert!(operations.bound.total() <= operations.free.total(), "{}: {operations:?}", derived.name);
}

/// What is left of a program where its parameters are numbers computes the same to the last bit, but for the sign of zero.
pub(crate) fn bound_programs_compute_what_free_ones_do(derived: &Derived<'_>) {
    let mut random = derived.random(4);
    let (name, free) = (derived.name, derived.program());
    let system = derived.equations.system();
    let mut values: Vec<f64> = system.parameters().iter().map(|&(_, value)| value).collect();
    for round in 0..3 {
        // Some of them 0 or 1, where operations are left out.
        for value in values.iter_mut().filter(|_| round > 0) {
            *value = [0.0, 1.0, random.normal(), *value][(random.uniform(0.0, 4.0) as usize).min(3)];
        }
        let bound = free.bound(&values);
        assert!(bound.cost().total() <= free.cost().total(), "{name}");
        let [mut free, mut bound] = [free, &bound].map(|p| Interpreter::new(Arc::new(p.clone())));
        for _ in 0..STATES {
            let state: Vec<f64> = system.state().iter().map(|_| random.normal()).collect();
            let (mut one, mut other) = (vec![0.0; state.len()], vec![0.0; state.len()]);
            free.eval(0.3, &state, &values, &mut one);
            bound.eval(0.3, &state, &values, &mut other);
            // 0·∞ is 0 in what is bound.
            let same = |(a, b): (&f64, &f64)| !a.is_finite() || a == b;
            assert!(one.iter().zip(&other).all(same), "{name}: {one:?}, {other:?}");
        }
    }
}
