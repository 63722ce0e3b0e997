//! A right-hand side as a program and as source, and what is asked of those who run it.

use std::sync::Arc;

use pc_expr::{Interpreter, Kernel, Program};
use pc_tests::emitted::Emitted;
use pc_tests::magnitude::terms;

/// Fused operations and sines that are 2 units in the last place off: some hundred roundings of the largest
/// term.
const ROUNDING: f64 = 1e-13;

/// The right-hand side of a model as a program and as source, with states at which it is regular.
#[derive(Debug)]
pub(crate) struct Subject {
    pub(crate) name: String,
    pub(crate) program: Program,
    pub(crate) emitted: Emitted,
    /// t, state, parameters
    pub(crate) inputs: Vec<Vec<f64>>,
    /// What the interpreter makes of each input.
    interpreted: Vec<Vec<f64>>,
}

impl Subject {
    /// With the inputs to try.
    ///
    /// # Panics
    /// If the right-hand side is singular at one of them.
    pub(crate) fn new(name: &str, program: Program, emitted: Emitted, inputs: Vec<Vec<f64>>) -> Subject {
        let mut subject =
            Subject { name: name.to_owned(), program, emitted, inputs, interpreted: Vec::new() };
        subject.interpreted = subject.run(&mut Interpreter::new(Arc::new(subject.program.clone())));
        let regular = subject.interpreted.iter().flatten().all(|rate| rate.is_finite());
        assert!(regular, "{name} has been tried where it is singular");
        subject
    }

    /// What a kernel of the program makes of each input.
    pub(crate) fn run(&self, kernel: &mut dyn Kernel) -> Vec<Vec<f64>> {
        let dimension = self.program.state_len();
        let rates = self.inputs.iter().map(|inputs| {
            let (y, p) = inputs[1..].split_at(dimension);
            let mut rates = vec![f64::NAN; dimension];
            kernel.eval(inputs[0], y, p, &mut rates);
            rates
        });
        rates.collect()
    }

    /// `found` is what the interpreter finds, bit for bit.
    pub(crate) fn assert_bits(&self, found: &[Vec<f64>], by: &str) {
        assert_eq!(found.len(), self.inputs.len());
        for ((inputs, expected), found) in self.inputs.iter().zip(&self.interpreted).zip(found) {
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            let same = bits(expected) == bits(found);
            assert!(same, "{} {by} at {inputs:?}: {found:?}, not {expected:?}", self.name);
        }
    }

    /// The largest difference of `found` from what the interpreter finds, relative to the largest term; at
    /// most [`ROUNDING`].
    pub(crate) fn assert_rounding(&self, found: &[Vec<f64>], by: &str) -> f64 {
        let mut worst = 0.0f64;
        for (inputs, found) in self.inputs.iter().zip(found) {
            for (i, (term, found)) in terms(&self.program, inputs).iter().zip(found).enumerate() {
                let error = (found - term.value).abs();
                assert!(
                    error <= ROUNDING * term.size,
                    "{} {by} at {inputs:?}: component {i} is {found}, not {term:?}",
                    self.name
                );
                if error > 0.0 {
                    worst = worst.max(error / term.size);
                }
            }
        }
        worst
    }
}
