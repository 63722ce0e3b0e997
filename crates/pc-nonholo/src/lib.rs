//! Nonholonomic constraints in quasi-velocities
