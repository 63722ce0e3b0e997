//! The choice of the state about which equations are linearized.

/// The kind of state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum At {
    /// The equilibrium or steady motion near the start: all components are constant except the cyclic
    /// coordinates.
    #[default]
    Steady,
    /// The equilibrium near the start, with all quasi-velocities 0.
    Rest,
    /// The start itself, whether it is steady or not.
    Start,
}

impl At {
    /// All of them.
    pub const ALL: [At; 3] = [At::Steady, At::Rest, At::Start];

    /// Its name in options and in output.
    pub fn word(self) -> &'static str {
        match self {
            At::Steady => "steady",
            At::Rest => "rest",
            At::Start => "start",
        }
    }
}

/// Which cyclic coordinates are components of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cyclic {
    /// The cyclic coordinates that are at rest.
    Keep,
    /// None.
    Drop,
}

impl Cyclic {
    /// All of them.
    pub const ALL: [Cyclic; 2] = [Cyclic::Keep, Cyclic::Drop];

    /// Its name in options and in output.
    pub fn word(self) -> &'static str {
        match self {
            Cyclic::Keep => "keep",
            Cyclic::Drop => "drop",
        }
    }
}

/// The state about which to linearize, and which components of it to keep.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StateChoice {
    /// The kind of state.
    pub at: At,
    /// The components that keep their start values while a steady state is sought.
    pub hold: Vec<String>,
    /// Which cyclic coordinates are kept; by default all at an equilibrium and at the start, and none for a
    /// steady motion or where values are varied.
    pub cyclic: Option<Cyclic>,
}
