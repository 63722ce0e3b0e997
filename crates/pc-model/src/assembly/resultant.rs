//! The names of the forces and torques that constraints and joints exert on bodies.

const AXES: [&str; 3] = ["x", "y", "z"];

/// `F_CONSTRAINT_BODY_x`, … `_z`: the components of the force along the axes of the position.
pub(crate) fn force_names(constraint: &str, body: &str) -> [String; 3] {
    AXES.map(|axis| format!("F_{constraint}_{body}_{axis}"))
}

/// `F_BODY_x`, … `_z`: the components of the force of its joint on a body, along fixed axes.
pub(crate) fn joint_force_names(body: &str) -> [String; 3] {
    AXES.map(|axis| format!("F_{body}_{axis}"))
}

/// `N_BODY_1`, … `_3`: the components of the torque of its joint on a body, about the point of the joint, along
/// the axes of the body.
pub(crate) fn joint_torque_names(body: &str) -> [String; 3] {
    [1, 2, 3].map(|axis| format!("N_{body}_{axis}"))
}

/// `N_CONSTRAINT_BODY_1`, … `_3`: the components of the torque along the axes of the angular velocity.
pub(crate) fn torque_names(constraint: &str, body: &str) -> [String; 3] {
    [1, 2, 3].map(|axis| format!("N_{constraint}_{body}_{axis}"))
}
