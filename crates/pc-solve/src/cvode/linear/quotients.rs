//! Difference quotients for sparse Jacobians.

use std::ffi::c_void;

use pc_expr::Pattern;

use crate::cvode::handles::Memory;
use crate::settings::inequality::Inequality;

/// Difference quotients of f for all columns of one colour at once, with CVODE's increments.
pub(super) struct Quotients {
    /// CVODE's memory, from which error weights and γ are read.
    pub(super) memory: *mut c_void,
    pub(super) pattern: Pattern,
    /// The columns of each colour.
    pub(super) colours: Vec<Vec<usize>>,
    inequalities: Vec<Inequality>,
    pub(super) moved: Vec<f64>,
    pub(super) rates: Vec<f64>,
    pub(super) evaluations: u64,
}

impl Quotients {
    /// Quotients for the CVODES instance at `memory`, which must outlive the quotients.
    pub(super) fn new(memory: &Memory, pattern: &Pattern, inequalities: &[Inequality]) -> Self {
        let colouring = pattern.colouring();
        let colours = (0..colouring.len()).map(|colour| colouring.columns(colour).collect()).collect();
        let dim = pattern.columns();
        Quotients {
            memory: memory.raw(),
            pattern: pattern.clone(),
            colours,
            inequalities: inequalities.to_vec(),
            moved: vec![0.0; dim],
            rates: vec![0.0; dim],
            evaluations: 0,
        }
    }

    pub(super) fn forget_evaluations(&mut self) {
        self.evaluations = 0;
    }

    pub(super) fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Moves component `j` of z by max(√ε |zⱼ|, `least`/wⱼ), in the direction in which the
    /// component satisfies its inequality, and returns the increment.
    pub(super) fn shift(&mut self, j: usize, z: &[f64], weight: f64, least: f64) -> f64 {
        let length = (f64::EPSILON.sqrt() * z[j].abs()).max(least / weight);
        let forwards = self.inequalities.get(j).is_none_or(|inequality| inequality.holds(z[j] + length));
        self.moved[j] = if forwards { z[j] + length } else { z[j] - length };
        self.moved[j] - z[j]
    }
}
