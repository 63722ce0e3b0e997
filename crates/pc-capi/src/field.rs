//! What is integrated.

/// The vector field of the equations of motion.
pub(crate) type Field = pc_mech::Motion;
