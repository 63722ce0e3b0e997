//! What is asked for.

/// A version of the Functional Mock-up Interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FmiVersion {
    /// 2.0
    V2,
    /// 3.0
    V3,
}

/// How an FMU integrates by itself, in Co-Simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FmuSolver {
    /// The explicit Runge–Kutta method of order 8 of Dormand and Prince, with steps by the tolerances: not stiff.
    Dop853,
    /// Radau's implicit Runge–Kutta method of order 5, with steps by the tolerances: stiff.
    Radau5,
    /// The classical Runge–Kutta method of order 4 with steps of this length, or a little less between communication points:
    /// the error is not known.
    RungeKutta4 {
        /// The length of a step, positive.
        step: f64,
    },
}

/// Options of an [`Fmu`](crate::Fmu).
#[derive(Clone, Debug)]
pub struct FmuOptions {
    pub(crate) version: FmiVersion,
    pub(crate) solver: Option<FmuSolver>,
    pub(crate) name: String,
}

impl FmuOptions {
    /// An FMU of this version, called `name`: made an identifier of C, it is that of the binary.
    pub fn new(version: FmiVersion, name: impl Into<String>) -> FmuOptions {
        FmuOptions { version, solver: None, name: name.into() }
    }

    /// How it integrates by itself; without this, by Radau's method if the model asks for `bdf` or `auto`, else by that of Dormand
    /// and Prince.
    #[must_use]
    pub fn solver(mut self, solver: FmuSolver) -> FmuOptions {
        self.solver = Some(solver);
        self
    }
}
