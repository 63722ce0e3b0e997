//! Places, which are states at a time, and directions in which they change.

/// A place: a time, coordinates, velocities w and first-order states.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) t: f64,
    pub(crate) x: Vec<f64>,
    pub(crate) w: Vec<f64>,
    pub(crate) z: Vec<f64>,
}

/// A direction in which a place changes.
#[derive(Clone, Debug)]
pub(crate) struct Direction {
    pub(crate) t: f64,
    pub(crate) x: Vec<f64>,
    pub(crate) w: Vec<f64>,
    pub(crate) z: Vec<f64>,
}

/// A virtual velocity: the direction of w, and the displacement of the coordinates b w.
#[derive(Clone, Debug)]
pub(crate) struct Virtual {
    pub(crate) w: Direction,
    pub(crate) x: Vec<f64>,
}

impl Place {
    /// The direction in which w_s alone changes.
    pub(crate) fn along_velocity(&self, s: usize) -> Direction {
        let mut still = self.along(vec![0.0; self.x.len()]);
        still.w[s] = 1.0;
        still
    }

    /// A direction in which the coordinates alone change.
    pub(crate) fn along(&self, x: Vec<f64>) -> Direction {
        Direction { t: 0.0, x, w: vec![0.0; self.w.len()], z: vec![0.0; self.z.len()] }
    }

    /// The direction of time, in which coordinates move and velocities and first-order states are at rest.
    pub(crate) fn in_time(&self, velocity: &[f64]) -> Direction {
        Direction { t: 1.0, ..self.along(velocity.to_vec()) }
    }
}
