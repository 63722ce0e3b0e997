//! Options for compilation.

use pc_expr::Backend;
use serde::{Deserialize, Serialize};

/// The parts to compile besides the right-hand side, and the kernel. Each derivative takes time to compile,
/// above all the Jacobian of a large system.
///
/// ```
/// use pc_mech::{CompileOptions, Graph, System, VectorField};
///
/// let graph = Graph::new();
/// let [l, g] = graph.symbols(["l", "g"]);
/// let pendulum = System::builder(&graph)
///     .parameter(l, 2.0).parameter(g, 10.0)
///     .coordinates(["θ"])
///     .lagrangian(|_, x, v| l.square() * v[0].square() / 2.0 + g * l * x[0].cos())
///     .build()?;
/// let options = CompileOptions::default().jacobian(false).parameter_jacobian(true);
/// let mut motion = pendulum.poincare()?.compile_for(options)?;
/// assert!(!motion.has_jacobian());
/// let mut by_parameters = [0.0; 4]; // of (θ̇, θ̈ = −(g/l) sin θ) by l, then by g
/// motion.parameter_jacobian(0.0, &[0.5, 0.0], &mut by_parameters)?;
/// assert_eq!(by_parameters[3], -0.5f64.sin() / 2.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CompileOptions {
    pub(crate) backend: Backend,
    pub(crate) jacobian: bool,
    pub(crate) jvp: bool,
    pub(crate) parameter_jacobian: bool,
    pub(crate) time_derivative: bool,
    pub(crate) observable_jacobian: bool,
    pub(crate) elimination: TreeElimination,
}

/// The method that solves for the accelerations of [bodies joined by joints](crate::Tree), and of bodies with
/// positions that carry one another, such as the links of a chain in angles from the vertical. All methods give the
/// same numbers up to rounding errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum TreeElimination {
    /// Joint by joint if that takes fewer operations, which is the case for all large trees.
    #[default]
    Shorter,
    /// Joint by joint: the number of operations grows in proportion to the number of bodies.
    ByJoints,
    /// Factorisation of the mass matrix of the whole tree.
    Whole,
}

impl Default for CompileOptions {
    /// The fastest kernel and the Jacobian.
    fn default() -> CompileOptions {
        CompileOptions {
            backend: Backend::Fastest,
            jacobian: true,
            jvp: false,
            parameter_jacobian: false,
            time_derivative: false,
            observable_jacobian: false,
            elimination: TreeElimination::default(),
        }
    }
}

impl From<Backend> for CompileOptions {
    /// The default options with another kernel.
    fn from(backend: Backend) -> CompileOptions {
        CompileOptions::default().backend(backend)
    }
}

impl CompileOptions {
    /// The kernel that runs the programs.
    #[must_use]
    pub fn backend(self, backend: Backend) -> CompileOptions {
        CompileOptions { backend, ..self }
    }

    /// Whether to compile ∂f/∂y, which Newton iterations of implicit methods need.
    #[must_use]
    pub fn jacobian(self, jacobian: bool) -> CompileOptions {
        CompileOptions { jacobian, ..self }
    }

    /// Whether to compile products (∂f/∂y) v, which take about as long as f itself.
    #[must_use]
    pub fn jvp(self, jvp: bool) -> CompileOptions {
        CompileOptions { jvp, ..self }
    }

    /// Whether to compile ∂f/∂p for the parameters p.
    #[must_use]
    pub fn parameter_jacobian(self, parameter_jacobian: bool) -> CompileOptions {
        CompileOptions { parameter_jacobian, ..self }
    }

    /// The method for a tree of bodies.
    #[must_use]
    pub fn elimination(self, elimination: TreeElimination) -> CompileOptions {
        CompileOptions { elimination, ..self }
    }

    /// Whether to compile ∂f/∂t, which Rosenbrock's methods need; for a motion in momenta under constraints
    /// this requires the Jacobian as well.
    #[must_use]
    pub fn time_derivative(self, time_derivative: bool) -> CompileOptions {
        CompileOptions { time_derivative, ..self }
    }

    /// Whether to compile the derivatives of the observables [by the state](crate::Motion::observable_jacobian) and [by the
    /// parameters](crate::Motion::observable_parameter_jacobian); for a motion in momenta under constraints this requires
    /// the Jacobian as well.
    #[must_use]
    pub fn observable_jacobian(self, observable_jacobian: bool) -> CompileOptions {
        CompileOptions { observable_jacobian, ..self }
    }
}
