//! Examination, for any method, of what the field may do between its evaluations, up to the end of
//! the next step.
//!
//! A method evaluates f at only a few times in each step. `places` are the times in a step that a
//! method has to examine. If the [profile](pc_expr::TimeDependence::Known) of a field is known,
//! they are the times of the turns, jumps and corners of its terms in t, however close together
//! these are; a step in which nothing turns twice has none. Otherwise the times are evenly spaced
//! over the whole integration. Added to them are the times at which [steep
//! functions](pc_expr::SteepFunctions) of the state, such as narrow barriers, matter along the
//! polynomial of the step. What happens at these times is up to the method: a method that predicts
//! checks its prediction before the step; a method with dense output checks its polynomial after
//! the step. `scatter` detects noise: a function that varies faster than floating-point times can
//! resolve is an error, unless the variation is below the tolerances.

pub(crate) mod places;
pub(crate) mod scatter;

/// A defect δ = p′ − f(t, p) of the polynomial p of a method matters if, over a step of length h, h
/// δ exceeds this many tolerances. At orders 1 to 12, the correction of an accepted step may be as
/// large as about ten tolerances.
pub(crate) const SURPRISE: f64 = 100.0;
