//! What a report takes over of a motion.

/// What columns of a table are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Coordinates x.
    Coordinates,
    /// Quasi-velocities η.
    QuasiVelocities,
    /// First-order states.
    States,
    /// Integrals, the energy last.
    Conserved,
    /// Outputs of the model, reactions among them.
    Outputs,
}

/// Columns of a kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// What they are.
    pub kind: Kind,
    /// Each with its values, one for each time.
    pub list: Vec<(String, Vec<f64>)>,
}

/// A motion as far as it was computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// The times of the values.
    pub times: Vec<f64>,
    /// What was computed.
    pub columns: Vec<Columns>,
    /// What is said of the motion, each with a label, in lines; nothing that differs from run to run.
    pub summary: Vec<(String, Vec<String>)>,
    /// Whether the energy, the last of what is conserved, is an integral.
    pub keeps_energy: bool,
    /// The times at which events occurred.
    pub events: Vec<f64>,
    /// Why there is no motion, or how it ended, if not at its end.
    pub remark: Option<String>,
}
