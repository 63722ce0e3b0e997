//! Errors in the meaning of a model whose text is well formed.

use pc_mech::acts_as_zero;

use crate::diagnostics::words::{against, at, listed, rounded, undetermined_text};

/// An error in the meaning of a model; operators are denoted by their quasi-velocities.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeaningError {
    /// A name that is not declared anywhere.
    #[error("the name `{name}` is not declared")]
    UnknownName {
        /// The name.
        name: String,
        /// The existing names.
        known: Vec<String>,
    },
    /// A name that is used before it is declared.
    #[error("`{name}` is used before it is defined")]
    UsedBeforeDefined {
        /// The name.
        name: String,
    },
    /// A velocity, kinematics or a start velocity given for something that is not a coordinate.
    #[error("`{name}` is not a coordinate, so `{name}'` means nothing")]
    NotACoordinate {
        /// The name.
        name: String,
        /// The existing coordinates.
        coordinates: Vec<String>,
    },
    /// A force on something that is neither a quasi-velocity nor a coordinate.
    #[error("`{name}` is neither a quasi-velocity nor a coordinate")]
    UnknownForceTarget {
        /// The name.
        name: String,
        /// The names that can be given a force.
        known: Vec<String>,
    },
    /// A reset of something that has no value of its own in a state.
    #[error("`{name}` cannot be reset: it is {what}")]
    NotReset {
        /// The name.
        name: String,
        /// A phrase that says what the thing is.
        what: &'static str,
        /// The names that can be reset.
        known: Vec<String>,
    },
    /// A name that is not allowed where it is used.
    #[error("`{name}` cannot be used in {place}")]
    NotHere {
        /// The name as written.
        name: String,
        /// A phrase for the place where it is used.
        place: &'static str,
        /// The names that can be used.
        allowed: &'static str,
    },
    /// The rate d() of something that contains velocities, used where accelerations are not allowed.
    #[error("`d()` of velocities gives accelerations, which cannot be used in {place}")]
    Acceleration {
        /// A phrase for the place where it is used.
        place: &'static str,
    },
    /// Numbers asked for from a function whose value is not given.
    #[error("the function `{name}` has no value, so there are no numbers")]
    NoValue {
        /// The name of the function.
        name: String,
        /// The names of its arguments, separated by commas.
        arguments: String,
    },
    /// A division by zero.
    #[error("`{text}` divides by zero")]
    DivisionByZero {
        /// The quotient as written.
        text: String,
    },
    /// A quasi-velocity that is a nonlinear function of the velocities, or kinematics that are nonlinear in the quasi-velocities.
    #[error("`{text}` is not affine in the {variables}")]
    NonlinearQuasiVelocity {
        /// The expression as written.
        text: String,
        /// `velocities` or `quasi-velocities`.
        variables: &'static str,
    },
    /// An angular velocity that is not affine in the velocities.
    #[error("`{text}` is not affine in the {variables}")]
    NotAffine {
        /// The expression as written.
        text: String,
        /// `velocities` or `quasi-velocities`.
        variables: &'static str,
    },
    /// A constraint that is not affine in the velocities and has not been declared nonlinear.
    #[error("`{text}` is not affine in the velocities")]
    ConstraintNotAffine {
        /// Its name.
        constraint: String,
        /// The expression as written.
        text: String,
    },
    /// A constraint that is declared nonlinear but is not.
    #[error("the constraint `{constraint}` is called nonlinear and {what}")]
    NotNonlinear {
        /// Its name.
        constraint: String,
        /// A phrase that says what the constraint is instead.
        what: &'static str,
    },
    /// A reaction force or torque on a body that virtual work does not determine.
    #[error(
        "`{name}` is not determined: the velocity of the body is tied to others by the choice of coordinates"
    )]
    ForceNotDetermined {
        /// The component.
        name: String,
    },
    /// A force or torque of a joint that the motion of bodies does not determine.
    #[error("`{name}` is not known: {cause}")]
    JointForceUnknown {
        /// The component.
        name: String,
        /// Why.
        cause: &'static str,
    },
    /// An angular momentum along fixed axes of a body that has its angular velocity along axes of its own.
    #[error(
        "`{name}` is not known: the angular velocity of the body `{body}` is given along axes of unknown direction"
    )]
    NoFixedAxes {
        /// The component.
        name: String,
        /// The body.
        body: String,
    },
    /// A body or a point of a body that does not exist.
    #[error("no body and no point has the name `{name}`")]
    UnknownBody {
        /// The name.
        name: String,
        /// The names of bodies and points.
        known: Vec<String>,
    },
    /// A momentum or mass centre of a model without bodies.
    #[error("{what} is not known: the model has no bodies")]
    NoBodies {
        /// What was asked for.
        what: &'static str,
    },
    /// A zero-moment point without weight that holds the bodies on the plane.
    #[error("`{name}` is not known: no weight acts along z")]
    NoGround {
        /// The component.
        name: String,
    },
    /// A definition without velocities.
    #[error("`{text}` contains no velocity, so it defines no quasi-velocity")]
    NoVelocity {
        /// The definition as written.
        text: String,
    },
    /// A name given to two of the quasi-velocities requested in addition to the text.
    #[error("`{name}` is given twice")]
    GivenTwice {
        /// Its name.
        name: String,
    },
    /// A quasi-velocity that was requested in addition to the text but is not a linear form in the
    /// velocities.
    #[error("`{text}` is not linear in the velocities")]
    NotLinear {
        /// The definition as written.
        text: String,
    },
    /// A form of the equations that does not exist for the model.
    #[error("{message}")]
    NoForm {
        /// Why.
        message: String,
        /// The forms that exist for it.
        help: &'static str,
    },
    /// Numbers of a joint that contradict each other or the start.
    #[error("{message}")]
    OfJoint {
        /// What is wrong.
        message: String,
        /// What would be right.
        help: &'static str,
    },
    /// A coordinate without kinematics, although other coordinates have kinematics.
    #[error("[kinematics] does not say what `{coordinate}'` is")]
    KinematicsMissing {
        /// The coordinate.
        coordinate: String,
    },
    /// A quasi-velocity whose meaning is not given.
    #[error("nothing says what the quasi-velocity `{name}` is")]
    Undefined {
        /// The quasi-velocity.
        name: String,
    },
    /// Kinematics that are given in two ways.
    #[error("the quasi-velocity `{name}` is defined by `is`, and [kinematics] is given too")]
    TwoKinematics {
        /// The quasi-velocity.
        name: String,
    },
    /// A number of definitions that differs from the number of coordinates.
    #[error("{definitions} definitions of quasi-velocities cannot be solved for {coordinates} velocities")]
    DefinitionCount {
        /// Number of definitions.
        definitions: usize,
        /// Number of coordinates.
        coordinates: usize,
    },
    /// Definitions that are linearly dependent.
    #[error(
        "the definitions of the quasi-velocities are linearly dependent: their matrix is singular everywhere"
    )]
    DependentDefinitions,
    /// Velocities that neither definitions nor constraints determine at the start.
    #[error(
        "at the start the definitions of the quasi-velocities and the constraints leave {} undetermined",
        listed(velocities)
    )]
    StartOpen {
        /// The velocities.
        velocities: Vec<String>,
    },
    /// A start velocity of a coordinate that contradicts the quasi-velocities.
    #[error(
        "the start velocity `{coordinate}'` = {} contradicts the quasi-velocities: by their start it is {}",
        rounded(*given),
        rounded(*found)
    )]
    StartVelocity {
        /// The coordinate.
        coordinate: String,
        /// The velocity given.
        given: f64,
        /// The value that the quasi-velocities determine.
        found: f64,
    },
    /// Components of the start that are to stay fixed but would have to move to satisfy a constraint.
    #[error("with {} kept, nothing is left to move to the constraint `{constraint}`", listed(held))]
    StartHeld {
        /// The constraint.
        constraint: String,
        /// The components that stay fixed.
        held: Vec<String>,
    },
    /// A constraint that is declared holonomic but is not.
    #[error(
        "the constraint `{constraint}` is not holonomic: the velocities it allows leave every surface (component {residual:.1e})"
    )]
    NotHolonomic {
        /// Its name.
        constraint: String,
        /// The largest component, along the constraint, of the commutators of the allowed velocities.
        residual: f64,
    },
    /// A start that does not satisfy a constraint.
    #[error("the start is off the constraint `{constraint}`: {what} {}, not 0", rounded(*residual))]
    OffConstraint {
        /// The words `it is` or `its rate is`.
        what: &'static str,
        /// Its name.
        constraint: String,
        /// Its value at the start.
        residual: f64,
    },
    /// A constraint that other constraints keep at a value other than zero.
    #[error("the constraint `{constraint}` {}{}, not 0", against(others), rounded(*residual))]
    Contradictory {
        /// Its name.
        constraint: String,
        /// The constraints that keep it constant; empty if it is constant by itself.
        others: Vec<String>,
        /// Its value.
        residual: f64,
    },
    /// A constraint that cannot be satisfied.
    #[error("{message}")]
    Constraint {
        /// Why.
        message: String,
        /// A correction.
        help: &'static str,
    },
    /// A name that is not in the catalogue of algebras.
    #[error("there is no algebra named `{name}`")]
    UnknownAlgebra {
        /// The name.
        name: String,
        /// The existing names.
        known: Vec<&'static str>,
    },
    /// An algebra whose dimension differs from the number of quasi-velocities.
    #[error("the algebra `{name}` has dimension {dimension}, but there are {operators} quasi-velocities")]
    AlgebraDimension {
        /// The name.
        name: String,
        /// Its dimension.
        dimension: usize,
        /// Number of quasi-velocities.
        operators: usize,
    },
    /// A bracket that is not a constant linear combination of quasi-velocities.
    #[error("`{text}` is not a constant linear combination of quasi-velocities")]
    BracketNotLinear {
        /// The value as written.
        text: String,
    },
    /// Two brackets of the same pair, in opposite orders, that do not have opposite values.
    #[error("the brackets \"{left},{right}\" and \"{right},{left}\" are not opposite")]
    BracketsNotSkew {
        /// The first name in the later bracket.
        left: String,
        /// The second name in the later bracket.
        right: String,
    },
    /// Brackets that violate the Jacobi identity.
    #[error("the brackets of {}, {} and {} violate the Jacobi identity by {defect} along {component}", triple[0], triple[1], triple[2])]
    Jacobi {
        /// The quasi-velocities.
        triple: [String; 3],
        /// The quasi-velocity along which the defect was found.
        component: String,
        /// Its size.
        defect: String,
    },
    /// A model that has neither coordinates nor an algebra.
    #[error("without coordinates the brackets of the quasi-velocities are not determined")]
    AlgebraNeeded,
    /// A frame that does not determine its brackets.
    #[error(
        "the frame has rank {rank} with {operators} quasi-velocities and does not determine their brackets: [{}, {}] is not a constant combination of them", pair[0], pair[1]
    )]
    RankDeficient {
        /// Rank of b.
        rank: usize,
        /// Number of quasi-velocities.
        operators: usize,
        /// The pair.
        pair: [String; 2],
    },
    /// A frame whose operators have a vanishing linear combination, so that it does not determine brackets
    /// along that combination.
    #[error(
        "the frame does not determine the brackets of the quasi-velocities: {}",
        acts_as_zero(combination, |s| names[s - 1].clone())
    )]
    Undetermined {
        /// The combination: the number of each quasi-velocity in it, counted from 1, with its coefficient.
        combination: Vec<(usize, String)>,
        /// The names of all quasi-velocities.
        names: Vec<String>,
    },
    /// A bracket that leaves the span of the frame.
    #[error(
        "the frame is not closed: [{}, {}] is not a combination of the frame (relative residual {residual:.1e})",
        pair[0], pair[1]
    )]
    NotClosed {
        /// The pair.
        pair: [String; 2],
        /// Relative residual.
        residual: f64,
    },
    /// Given brackets that differ from those of the frame.
    #[error(
        "the bracket of {} and {} given in [algebra] contradicts the kinematics (relative residual {residual:.1e})",
        pair[0], pair[1]
    )]
    Contradiction {
        /// The pair.
        pair: [String; 2],
        /// Relative residual.
        residual: f64,
    },
    /// A singular mass matrix.
    #[error(
        "the Lagrangian is degenerate: its Hessian in the quasi-velocities has rank {rank} of {size}, so {} not \
         determined",
        undetermined_text(undetermined)
    )]
    Degenerate {
        /// Rank.
        rank: usize,
        /// Size.
        size: usize,
        /// The quasi-velocities without an equation.
        undetermined: Vec<String>,
    },
    /// An energy, a frame or a constraint that is discontinuous.
    #[error("{message}")]
    Jumps {
        /// A text that says what is discontinuous, and where.
        message: String,
    },
    /// An axis without direction.
    #[error("the axis has length 0")]
    ZeroAxis,
    /// A matrix that is not a rotation.
    #[error("these nine entries are not a rotation: R·Rᵀ differs from 1 by {}, and the determinant is {}", rounded(*defect), rounded(*determinant))]
    NotARotation {
        /// The largest entry of R Rᵀ − 1.
        defect: f64,
        /// The determinant.
        determinant: f64,
    },
    /// A matrix of a body, in redundant coordinates, that is not a rotation at the start.
    #[error(
        "the matrix of `{body}` is not a rotation at the start: its columns are not orthogonal and of one length, by {}",
        rounded(*defect)
    )]
    NotARotationAtTheStart {
        /// The body.
        body: String,
        /// The deviation of RᵀR from a multiple of the unit matrix.
        defect: f64,
    },
    /// A matrix of a body, in redundant coordinates, that does not stay a rotation along the motion.
    #[error(
        "the matrix of `{body}` does not stay a rotation: along the motion its columns do not stay orthogonal and of one length \
         (rate {})",
        rounded(*defect)
    )]
    NotARotationAlong {
        /// The body.
        body: String,
        /// The largest component of the rates of RᵀR along the operators, minus a multiple of the unit
        /// matrix.
        defect: f64,
    },
    /// A quaternion of a joint whose length at the start is not 1.
    #[error("the quaternion of `{body}` has length {length} at the start, not 1")]
    QuaternionNotUnit {
        /// The body.
        body: String,
        /// Its length.
        length: f64,
    },
    /// A body that can move although neither it nor any body attached to it has mass.
    #[error("`{body}` can move, and neither it nor what hangs on it has mass or inertia")]
    Massless {
        /// The body.
        body: String,
    },
    /// A rotation that no inertia resists.
    #[error("nothing that the {kind} joint of `{body}` turns has inertia about {direction}")]
    NoInertia {
        /// The body.
        body: String,
        /// The kind of its joint.
        kind: &'static str,
        /// The axis.
        direction: String,
    },
    /// A translation that no mass resists.
    #[error("nothing that the {kind} joint of `{body}` moves along {direction} has mass")]
    NoMass {
        /// The body.
        body: String,
        /// The kind of its joint.
        kind: &'static str,
        /// The axis.
        direction: String,
    },
    /// A parameter given by an expression that has no finite value.
    #[error("`{text}` is {value}")]
    ParameterNotFinite {
        /// The expression as written.
        text: String,
        /// NaN or an infinity.
        value: f64,
    },
    /// An invalid table of an input.
    #[error("{what}")]
    BadTable {
        /// The reason.
        what: String,
        /// A correction.
        help: &'static str,
    },
    /// The rate d() of an input, an acceleration or a reaction.
    #[error("the rate of the {what} `{name}` is not known")]
    UnknownRate {
        /// `input`, `acceleration` or `reaction`.
        what: &'static str,
        /// Its name.
        name: String,
    },
    /// An expression that has no finite value at the start.
    #[error("`{text}` is {value} at the start{}", at(state))]
    NotFinite {
        /// The expression as written.
        text: String,
        /// NaN or an infinity.
        value: f64,
        /// Names and values of the start state.
        state: Vec<(String, f64)>,
    },
    /// Equations that cannot be evaluated at the start, although the expressions of the text can.
    #[error("the equations of motion cannot be evaluated at the start: {cause}")]
    SingularStart {
        /// Why.
        cause: String,
        /// Whether there is a velocity at the start that moves no mass.
        is_massless: bool,
    },
    /// A tolerance for something that is not a component of the state.
    #[error("`{name}` is not a component of the state")]
    UnknownComponent {
        /// The name.
        name: String,
        /// The coordinates, the quasi-velocities or velocities, and the first-order states.
        known: Vec<String>,
    },
    /// A unit for something that the model does not have.
    #[error("`{name}` is not a quantity of the model")]
    NoQuantity {
        /// The name.
        name: String,
        /// The names that may have a unit.
        known: Vec<String>,
    },
    /// A name that was requested as an integral to be kept but is not an integral of the model.
    #[error("`{name}` is not an integral")]
    UnknownIntegral {
        /// The name.
        name: String,
        /// The existing integrals.
        known: Vec<String>,
    },
    /// A function that was requested to be kept but is not constant along the motion.
    #[error("`{name}` cannot be kept: it changes along the motion, at t = {} at the rate {}", rounded(*t), rounded(*rate))]
    NotAnIntegral {
        /// The integral.
        name: String,
        /// The time at which the function was found to change.
        t: f64,
        /// Its rate of change.
        rate: f64,
    },
    /// Any other error of the derivation.
    #[error("{message}")]
    Derivation {
        /// Why.
        message: String,
    },
}
