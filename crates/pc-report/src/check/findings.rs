//! The properties of a model in one row of a table: numbers and words that can be compared between models.

use pc_analysis::FrameConstraints;
use pc_nonholo::ConstraintKind;

use crate::check::check::{Check, held};
use crate::check::steady;

/// An entry of the row.
#[derive(Clone, Debug, PartialEq)]
pub enum Finding {
    /// A number; NaN if there is no value.
    Number(f64),
    /// Words.
    Words(String),
}

impl Check<'_> {
    /// The names of the [findings](Check::findings), each with whether it is a number: rank of the frame; closure, Jacobi's identity
    /// and algebra in words; rank of the mass matrix; binding constraints and how many of them are nonholonomic; whether all binding
    /// constraints are integrable; integrals and how many are proved; stability of the steady motion near the start, and its distance;
    /// the deviation of the second derivation, and the number of states at which it was compared.
    pub const FINDINGS: [(&'static str, bool); 14] = [
        ("rank", true),
        ("closure", false),
        ("jacobi", false),
        ("algebra", false),
        ("mass_rank", true),
        ("constraints", true),
        ("nonholonomic", true),
        ("integrability", false),
        ("integrals", true),
        ("proved", true),
        ("stability", false),
        ("distance", true),
        ("deviation", true),
        ("compared", true),
    ];

    /// The findings, in the order of their names.
    pub fn findings(&self) -> [Finding; 14] {
        let count = |count: usize| Finding::Number(count as f64);
        let words = |words: &str| Finding::Words(words.to_owned());
        let is_free = |kind: &ConstraintKind| {
            matches!(kind, ConstraintKind::Nonholonomic { .. } | ConstraintKind::Nonlinear)
        };
        let nonholonomic = self.classified.iter().filter(|verdict| is_free(&verdict.kind)).count();
        let of_frame = matches!(self.frame.constraints, Some(FrameConstraints::NotIntegrable { .. }));
        let is_holonomic = nonholonomic == 0 && !of_frame;
        let list = self.integrals.list();
        let second = self.second.as_ref().and_then(|second| second.as_ref().ok());
        [
            count(self.rank),
            words(&held(self.closure_residual)),
            words(&held(self.jacobi_residual)),
            words(&self.algebra),
            count(self.mass_rank),
            count(self.classified.len()),
            count(nonholonomic),
            words(if is_holonomic { "holonomic" } else { "nonholonomic" }),
            count(list.len()),
            count(list.iter().filter(|integral| integral.is_constant_from_start()).count()),
            words(&steady::verdict(&self.steady)),
            Finding::Number(steady::distance(&self.steady)),
            Finding::Number(second.map_or(f64::NAN, |second| second.error)),
            count(second.map_or(0, |second| second.states)),
        ]
    }
}
