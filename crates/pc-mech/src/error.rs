//! What can be wrong with a mechanical system.

use pc_algebra::AlgebraError;
use pc_expr::{ExprError, Failure, readable};

/// An error of this crate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MechError {
    /// A part of the system with the wrong number of entries.
    #[error("{what} has {found} entries where {expected} are needed")]
    Shape {
        /// The part.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that fits.
        expected: usize,
    },
    /// b or b_0 of ẋ = b η + b_0 depends on a velocity.
    #[error("the frame contains `{velocity}`, and b and b_0 are functions of time and coordinates alone")]
    FrameOfVelocities {
        /// The quasi-velocity, or velocity of a coordinate.
        velocity: String,
    },
    /// A frame or a kinetic energy that contains an input whose rate is not known.
    #[error("velocities or momenta depend on the input `{input}`, whose rate is not known")]
    SignalInMomentum {
        /// The input.
        input: String,
    },
    /// A part of the frame that depends on a first-order state.
    #[error("{what} depends on the first-order state `{state}`, which is no part of the frame")]
    OfState {
        /// The part.
        what: &'static str,
        /// The state.
        state: String,
    },
    /// Neither a Lagrangian was given nor one that depends on the quasi-velocities.
    #[error("the system has no Lagrangian")]
    NoLagrangian,
    /// ∂²L/∂η∂η is singular at almost all states.
    #[error(
        "the Lagrangian is degenerate: its Hessian in the quasi-velocities has rank {rank} of {size}, so that {} not \
         determined by its equation",
        undetermined(quasi_velocities)
    )]
    DegenerateLagrangian {
        /// Rank of the Hessian.
        rank: usize,
        /// Number of quasi-velocities.
        size: usize,
        /// The quasi-velocities in whose elimination no pivot was left.
        quasi_velocities: Vec<String>,
    },
    /// H(t, x, y) was asked for where y = ∂L/∂η is not linear in the quasi-velocities.
    #[error(
        "the Hamiltonian as a function of the momenta needs a Lagrangian that is quadratic in the quasi-velocities; \
         this one is not in `{quasi_velocity}`"
    )]
    NotQuadratic {
        /// A quasi-velocity in which L is not quadratic.
        quasi_velocity: String,
    },
    /// Lagrange's equations asked for in coordinates that are not independent.
    #[error(
        "Lagrange's equations need independent coordinates; here {coordinates} coordinates move with \
         {quasi_velocities} quasi-velocities"
    )]
    Redundant {
        /// Number n of coordinates.
        coordinates: usize,
        /// Number k of quasi-velocities.
        quasi_velocities: usize,
    },
    /// A pivot of the mass matrix vanished on the way.
    #[error(
        "the mass matrix is singular: the kinetic energy {}`{quasi_velocity}` (pivot {}) at t = {t}{}",
        if *pivot == 0.0 { "lacks " } else { "hardly knows " },
        readable(*pivot),
        listed(state)
    )]
    SingularMassMatrix {
        /// The quasi-velocity whose acceleration is not determined.
        quasi_velocity: String,
        /// The pivot.
        pivot: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// Newton's method found no quasi-velocities that have the momenta.
    #[error(
        "y = ∂L/∂η has no solution η that could be found: after {iterations} steps |y − ∂L/∂η| is {} at t = {t}{}",
        readable(*residual),
        listed(state)
    )]
    LegendreNotSolved {
        /// |y − ∂L/∂η|
        residual: f64,
        /// Number of steps made.
        iterations: usize,
        /// Time.
        t: f64,
        /// Names and values of the state (x, y).
        state: Vec<(String, f64)>,
    },
    /// A condition on velocities that is not affine in them.
    #[error("the constraint `{constraint}` is not affine in the quasi-velocities")]
    ConstraintNotAffine {
        /// Its name.
        constraint: String,
    },
    /// Constraints that leave nothing to move.
    #[error("nothing is left free: constraints {constraints}, quasi-velocities {quasi_velocities}")]
    TooManyConstraints {
        /// Number of constraints.
        constraints: usize,
        /// Number k of quasi-velocities.
        quasi_velocities: usize,
    },
    /// A constraint that restricts no velocity, or none that those before it leave free.
    #[error("the constraint `{constraint}` restricts no velocity that those before it leave free")]
    DependentConstraint {
        /// Its name.
        constraint: String,
    },
    /// The same at one state only.
    #[error(
        "the constraint `{constraint}` restricts no velocity that the others leave free at t = {t}{}",
        listed(state)
    )]
    SingularConstraint {
        /// Its name.
        constraint: String,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// Definitions that determine velocities before and after a place, but not there.
    #[error(
        "between t = {from} and t = {to} the definitions of the quasi-velocities become dependent: they do not say how the \
         motion goes on there"
    )]
    Undetermined {
        /// Time at the start of the step that passes it.
        from: f64,
        /// Time at its end.
        to: f64,
    },
    /// A constraint that was left to follow from the others, which it does not everywhere.
    #[error(
        "the constraint `{constraint}`, which followed from the others, does not at t = {t}{}",
        listed(state)
    )]
    Departed {
        /// Its name.
        constraint: String,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// A state from which no way was found to where the constraints are satisfied.
    #[error(
        "no state that satisfies the constraints {} was found near t = {t}{}",
        quoted(constraints),
        listed(state)
    )]
    NoProjection {
        /// Their names.
        constraints: Vec<String>,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// Newton's method found no state with the values of the [kept](crate::Motion::keep) integrals.
    #[error("no state with the values of the integrals is found near t = {t}{}", listed(state))]
    NotKept {
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// An integral to be kept that the system does not have.
    #[error("`{name}` is not an integral of the system; there are {}", quoted(known))]
    UnknownIntegral {
        /// The name asked for.
        name: String,
        /// Those there are.
        known: Vec<String>,
    },
    /// An integral to be kept that is none.
    #[error("`{name}` cannot be kept: it changes along the motion, at t = {t} at the rate {rate}")]
    NotAnIntegral {
        /// The integral.
        name: String,
        /// When it was seen to change.
        t: f64,
        /// Its rate of change.
        rate: f64,
    },
    /// A derivative was asked for that was not [compiled](crate::CompileOptions).
    #[error("the motion was compiled without its {what}")]
    NotCompiled {
        /// The derivative.
        what: &'static str,
    },
    /// A matrix that must be antisymmetric and is not.
    #[error("{what} is antisymmetric; its entries for `{}` and `{}` do not add up to zero", pair[0], pair[1])]
    NotSkew {
        /// The matrix.
        what: &'static str,
        /// The variables of the entries.
        pair: [String; 2],
    },
    /// A rotation whose columns are not orthogonal, or not of one length.
    #[error(
        "the rotation of a body is none: its columns {} and {} are not orthogonal and of one length; they miss it by `{defect}`",
        columns.0, columns.1
    )]
    NotARotation {
        /// Numbers of the columns, from 1.
        columns: (usize, usize),
        /// Text of the product of the columns, or of the difference of their squares.
        defect: String,
    },
    /// A rotation that turns right into left.
    #[error("the rotation of a body is a reflection: its determinant is {determinant}")]
    Reflection {
        /// Its determinant.
        determinant: f64,
    },
    /// A part of a body that depends on velocities.
    #[error("{what} of a body depends on time and coordinates only; here it depends on `{velocity}`")]
    BodyOfVelocities {
        /// The part.
        what: &'static str,
        /// A velocity or quasi-velocity in it.
        velocity: String,
    },
    /// An angular velocity that is not affine in the quasi-velocities.
    #[error("an angular velocity is affine in the quasi-velocities; its component `{component}` is not")]
    AngularVelocityNotAffine {
        /// Text of the component.
        component: String,
    },
    /// A force on something that is not a quasi-velocity.
    #[error("`{name}` is not a quasi-velocity; these are {}", known.join(", "))]
    NotAQuasiVelocity {
        /// The name.
        name: String,
        /// The quasi-velocities there are.
        known: Vec<String>,
    },
    /// An external force for a system that has declared none.
    #[error("no quasi-velocity of the system was declared to have an external force")]
    NoExternalForce,
    /// An external force that is not a number.
    #[error("the external force on `{quasi_velocity}` is {value} at t = {t}{}", listed(state))]
    ExternalForceNotFinite {
        /// The quasi-velocity it acts on.
        quasi_velocity: String,
        /// The force.
        value: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// A derivative of an external force that is not a number.
    #[error(
        "the derivative by `{by}` of the external force on `{quasi_velocity}` is {value} at t = {t}{}",
        listed(state)
    )]
    ExternalSlopeNotFinite {
        /// The quasi-velocity it acts on.
        quasi_velocity: String,
        /// The component of the state.
        by: String,
        /// The derivative.
        value: f64,
        /// Time.
        t: f64,
        /// Names and values of the state.
        state: Vec<(String, f64)>,
    },
    /// An external force that could not be computed.
    #[error("the external force on {} failed at t = {t}: {cause}", quoted(quasi_velocities))]
    ExternalForceFailed {
        /// The quasi-velocities it acts on.
        quasi_velocities: Vec<String>,
        /// Time.
        t: f64,
        /// What it said.
        cause: String,
    },
    /// A matrix whose eigenvalues or singular values cannot be computed.
    #[error(
        "a {rows} × {columns} matrix has entries that are not finite, or eigenvalues that cannot be found"
    )]
    NoEigenvalues {
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
    },
    /// A vector field that could not be evaluated for a reason of its own.
    #[error("{cause}")]
    NotEvaluated {
        /// What it said.
        cause: String,
    },
    /// An error of the frame or its algebra.
    #[error(transparent)]
    Algebra(#[from] AlgebraError),
    /// An error of the expressions.
    #[error(transparent)]
    Expr(#[from] ExprError),
}

impl From<Failure> for MechError {
    /// What a [`Motion`](crate::Motion) failed with; of other vector fields their words.
    fn from(failure: Failure) -> MechError {
        let own = failure.cause().downcast_ref::<MechError>();
        own.cloned().unwrap_or_else(|| MechError::NotEvaluated { cause: failure.to_string() })
    }
}

fn undetermined(names: &[String]) -> String {
    match names {
        [_] => format!("{} is", quoted(names)),
        _ => format!("{} are", quoted(names)),
    }
}

fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// An error unless `found` is `expected`.
pub(crate) fn shape(what: &'static str, found: usize, expected: usize) -> Result<(), MechError> {
    if found == expected { Ok(()) } else { Err(MechError::Shape { what, found, expected }) }
}

fn listed(values: &[(String, f64)]) -> String {
    values.iter().map(|(name, value)| format!(", {name} = {}", readable(*value))).collect()
}
