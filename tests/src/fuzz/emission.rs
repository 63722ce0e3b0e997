//! Emitted source, compiled, against the interpreter.

use super::comparison::{Finding, exceeds};
use super::execution::Emission;
use crate::emitted::{compile_c, run};

/// Of the largest rate: the last digits, where functions of the mathematical libraries differ.
const TOLERANCE: f64 = 1e-12;

/// What the compiled source computes otherwise.
///
/// # Panics
/// If there is no compiler, or it does not take the source.
pub(super) fn compare(emission: &Emission) -> Option<Finding> {
    let directory = match tempfile::tempdir() {
        Ok(directory) => directory,
        Err(error) => panic!("no directory for emitted source: {error}"),
    };
    let sources = std::slice::from_ref(&emission.source);
    let program = compile_c(directory.path(), "gcc", &["-std=c99", "-O1", "-ffp-contract=off"], sources);
    let found = run(&program, [(&emission.source, &emission.inputs[..])]).remove(0);
    for ((inputs, found), expected) in emission.inputs.iter().zip(found).zip(&emission.rates) {
        let size = expected.iter().fold(1.0, |size, rate| f64::max(size, rate.abs()));
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            if exceeds(found - expected, TOLERANCE * size) {
                let detail = format!("rate {i} is {found:?}, not {expected:?}, at {inputs:?}");
                return Some(Finding { kind: "emitted source differs", detail });
            }
        }
    }
    None
}
