//! The explicit dependence on time, examined up to the end of the next step, for any method.
//!
//! A method sees f at a few times in each step only. Where a field shows its [profile](pc_expr::TimeDependence::Known),
//! `places` are the turns, jumps and corners of what contains t, however close they are; a step in which nothing turns
//! twice needs none. Where only evaluations can tell, they are places evenly spaced over the whole integration.
//! What is done there is the method's: one that predicts looks before the step whether its prediction holds there, one
//! that knows the inside of a step looks after it. `scatter` tells noise: a function that turns faster than
//! floating-point times can resolve cannot be followed, and is an error, unless it is below the tolerances.

pub(crate) mod places;
pub(crate) mod scatter;

/// A defect δ = p′ − f(t, p) of the motion p that a method has matters if over the step, of length h, h δ is more than this
/// times the tolerance. The correction of a step that passes its error test may come to some ten times the tolerance, at
/// the orders from 1 to 12.
pub(crate) const SURPRISE: f64 = 100.0;
