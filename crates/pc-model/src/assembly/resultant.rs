//! The names of the forces and torques that reactions exert on bodies.

const AXES: [&str; 3] = ["x", "y", "z"];

/// `F_CONSTRAINT_BODY_x`, … `_z`: the components of the force along the axes of the position.
pub(crate) fn force_names(constraint: &str, body: &str) -> [String; 3] {
    AXES.map(|axis| format!("F_{constraint}_{body}_{axis}"))
}

/// `N_CONSTRAINT_BODY_1`, … `_3`: the components of the torque along the axes of the angular velocity.
pub(crate) fn torque_names(constraint: &str, body: &str) -> [String; 3] {
    [1, 2, 3].map(|axis| format!("N_{constraint}_{body}_{axis}"))
}
