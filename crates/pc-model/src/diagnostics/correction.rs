//! The category of an error in the meaning of a model, and how to correct it.

use crate::diagnostics::category::Category;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::words::{listed, suggest};

impl MeaningError {
    /// Whether the text or the model is at fault.
    pub fn category(&self) -> Category {
        match self {
            MeaningError::DefinitionCount { .. }
            | MeaningError::DependentDefinitions
            | MeaningError::Jacobi { .. }
            | MeaningError::AlgebraNeeded
            | MeaningError::RankDeficient { .. }
            | MeaningError::Undetermined { .. }
            | MeaningError::NotClosed { .. }
            | MeaningError::Contradiction { .. }
            | MeaningError::Degenerate { .. }
            | MeaningError::Jumps { .. }
            | MeaningError::ZeroAxis
            | MeaningError::NotARotation { .. }
            | MeaningError::NotARotationAtTheStart { .. }
            | MeaningError::NotARotationAlong { .. }
            | MeaningError::QuaternionNotUnit { .. }
            | MeaningError::Massless { .. }
            | MeaningError::NoInertia { .. }
            | MeaningError::NoMass { .. }
            | MeaningError::NotHolonomic { .. }
            | MeaningError::StartOpen { .. }
            | MeaningError::StartVelocity { .. }
            | MeaningError::StartHeld { .. }
            | MeaningError::OffConstraint { .. }
            | MeaningError::Contradictory { .. }
            | MeaningError::Constraint { .. }
            | MeaningError::ParameterNotFinite { .. }
            | MeaningError::NotFinite { .. }
            | MeaningError::SingularStart { .. }
            | MeaningError::NotAnIntegral { .. }
            | MeaningError::ForceNotDetermined { .. }
            | MeaningError::JointForceUnknown { .. }
            | MeaningError::NoForm { .. }
            | MeaningError::OfJoint { .. }
            | MeaningError::Derivation { .. } => Category::Inconsistent,
            MeaningError::NoBodies { .. } => Category::Unsupported,
            _ => Category::Text,
        }
    }

    /// A correction.
    pub fn help(&self) -> String {
        match self {
            MeaningError::UnknownName { name, .. } if name == "e" => {
                "the exponential function is written `exp(x)`; another e is declared, for example in [parameters]".into()
            }
            MeaningError::UnknownName { name, known } => suggest(name, known, "declare it, for example in [parameters]"),
            MeaningError::UnknownComponent { name, known } => {
                suggest(name, known, &format!("the components are {}", listed(known)))
            }
            MeaningError::NoQuantity { name, known } => suggest(
                name,
                known,
                "a unit belongs to a declared name, to a velocity `x'`, to `t` or to `energy`",
            ),
            MeaningError::UnknownIntegral { name, known } => {
                suggest(name, known, &format!("the integrals are {}", listed(known)))
            }
            MeaningError::NotAnIntegral { .. } => {
                "leave it out of `project`; `pc check` says what the motion keeps".into()
            }
            MeaningError::NoValue { name, arguments } => format!(
                "give its value in [functions]: `{name} = {{ of = \"{arguments}\", is = \"…\" }}`; without a value the equations can be derived and studied, `pc derive` and `pc theory`"
            ),
            MeaningError::UsedBeforeDefined { .. } => "what is defined is evaluated in order; move it up".into(),
            MeaningError::NotACoordinate { name, coordinates } => {
                suggest(name, coordinates, &format!("the coordinates are {}", listed(coordinates)))
            }
            MeaningError::UnknownForceTarget { name, known } => {
                suggest(name, known, &format!("a force can act on {}", listed(known)))
            }
            MeaningError::NotReset { name, what, known } => match *what {
                "declared nowhere" => suggest(name, known, &format!("an event can reset {}", listed(known))),
                _ => format!("an event can reset {}", listed(known)),
            },
            MeaningError::NotHere { name, place: "a start value", allowed } if name.ends_with('\'') => format!(
                "use {allowed} only; a quasi-velocity is defined by velocities with `is`, as in `v = {{ is = \"{name}\" }}`"
            ),
            MeaningError::NotHere { allowed, .. } => format!("use {allowed} only"),
            MeaningError::Acceleration { .. } => "accelerations can be used in [integrals] and [outputs]".into(),
            MeaningError::DivisionByZero { .. } => "the divisor is zero whatever the motion".into(),
            MeaningError::NonlinearQuasiVelocity { variables, .. } => format!(
                "Hamel's nonlinear quasi-velocities are not taken: write a sum of terms linear in the {variables}, with \
                 coefficients of coordinates, parameters and t; observe a nonlinear function in [outputs], hold it by a \
                 constraint with `kind = \"nonlinear\"`, or give it in [states] by its rate"
            ),
            MeaningError::NotAffine { variables, .. } => format!("write a sum of terms linear in the {variables}"),
            MeaningError::ConstraintNotAffine { constraint, .. } => format!(
                "write a sum of terms linear in the velocities, or declare it nonlinear, with Chetaev's condition for the \
                 displacements: `{constraint} = {{ expr = \"…\", kind = \"nonlinear\" }}`"
            ),
            MeaningError::NotNonlinear { .. } => "leave out its kind".into(),
            MeaningError::JointForceUnknown { .. } => {
                "forces of joints are outputs of models whose bodies all hang on joints; constraints are then loops, or relations \
                 between components of points, none of which follows from others"
                    .into()
            }
            MeaningError::NoFixedAxes { .. } => {
                "give the body a `rotation` in place of `angular_velocity`".into()
            }
            MeaningError::UnknownBody { name, known } => {
                suggest(name, known, "name a body of [bodies], or a point of [points]")
            }
            MeaningError::NoBodies { .. } => {
                "declare its bodies in [bodies], in place of a kinetic energy as a formula".into()
            }
            MeaningError::NoGround { .. } => {
                "the zero-moment point is one of the plane z = 0: give [gravity] a component along z".into()
            }
            MeaningError::ForceNotDetermined { .. } => {
                "use coordinates in which the body moves independently, and constraints that tie it".into()
            }
            MeaningError::NoVelocity { .. } => "write a sum of terms linear in the velocities, such as \"x'\"".into(),
            MeaningError::GivenTwice { .. } => "keep one of them".into(),
            MeaningError::NotLinear { .. } => {
                "write a sum of terms linear in the velocities of the coordinates or in the quasi-velocities, which vanishes with \
                 these, of coordinates, parameters and t"
                    .into()
            }
            MeaningError::NoForm { help, .. } | MeaningError::OfJoint { help, .. } => (*help).into(),
            MeaningError::KinematicsMissing { coordinate } => {
                format!("add `{coordinate} = \"…\"`, affine in the quasi-velocities")
            }
            MeaningError::Undefined { name } => {
                format!("give [kinematics] for every coordinate, or define `{name} = {{ is = \"…\", start = 0.0 }}`")
            }
            MeaningError::TwoKinematics { .. } => "keep either [kinematics] or the `is`".into(),
            MeaningError::DefinitionCount { .. } | MeaningError::DependentDefinitions => {
                "give as many independent definitions (and constraints) as there are coordinates".into()
            }
            MeaningError::NotHolonomic { .. } => "leave out its kind, or write it as a function of coordinates and t".into(),
            MeaningError::OffConstraint { .. } => {
                "give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)".into()
            }
            MeaningError::StartOpen { .. } => {
                "start where they are determined, or define other quasi-velocities".into()
            }
            MeaningError::StartVelocity { .. } => {
                "leave it out, or the `start` of a quasi-velocity, which then follows".into()
            }
            MeaningError::StartHeld { .. } => "keep less".into(),
            MeaningError::Contradictory { .. } => "no motion satisfies it; correct it or leave it out".into(),
            MeaningError::Constraint { help, .. } => (*help).into(),
            MeaningError::UnknownAlgebra { known, .. } => {
                format!("the catalogue has {}; any other is given by `brackets`", known.join(", "))
            }
            MeaningError::AlgebraDimension { .. } => {
                "an algebra has one operator for each quasi-velocity; leave [algebra] out if the frame determines it"
                    .into()
            }
            MeaningError::BracketNotLinear { .. } => "write for example \"w3\", \"-2*w1 + w2\" or \"0\"".into(),
            MeaningError::BracketsNotSkew { .. } => "[X, Y] = -[Y, X]; give one of the two".into(),
            MeaningError::Jacobi { .. } => "no frame of operators has these brackets; check their signs".into(),
            MeaningError::AlgebraNeeded | MeaningError::RankDeficient { .. } | MeaningError::Undetermined { .. } => {
                "give the brackets in [algebra]: `name = \"so3\"` or `brackets = { \"w1,w2\" = \"w3\" }`, or `{}` if all are \
                 zero"
                    .into()
            }
            MeaningError::NotClosed { .. } => {
                "the kinematics stand for constraints that are not integrable; give them in [constraints], and what has a rate \
                 but is not a coordinate in [states]"
                    .into()
            }
            MeaningError::Contradiction { .. } => "check the bracket, or leave [algebra] out to have it computed".into(),
            MeaningError::Degenerate { .. } => "every quasi-velocity needs kinetic energy of its own".into(),
            MeaningError::Jumps { .. } => {
                "write an impulse as an event with a reset, or a steep but continuous function such as tanh".into()
            }
            MeaningError::ZeroAxis => "give it a direction, such as `[0, 0, 1]`".into(),
            MeaningError::NotARotation { .. } => {
                "its rows are orthogonal unit vectors; angles about axes are given by `turns`".into()
            }
            MeaningError::NotARotationAtTheStart { .. } => {
                "give the start with all digits or as expressions, or the body its `angular_velocity`".into()
            }
            MeaningError::NotARotationAlong { .. } => "check signs and indices of its entries and of [kinematics]".into(),
            MeaningError::QuaternionNotUnit { .. } => {
                "a turn by the angle a about the unit vector u has the quaternion cos(a/2), u*sin(a/2)".into()
            }
            MeaningError::Massless { .. } => "give it a mass, or make its joint `fixed`".into(),
            MeaningError::NoInertia { body, .. } => format!(
                "give `{body}` an `inertia`, or by `center` a place off the axis for a mass that is not 0, or make its joint `fixed`"
            ),
            MeaningError::NoMass { body, .. } => {
                format!("give `{body}` a mass that is not 0, or make its joint `fixed`")
            }
            MeaningError::BadTable { help, .. } => (*help).into(),
            MeaningError::UnknownRate { what: "input", .. } => "make it a state, whose rate is given in [states], or an input of its own".into(),
            MeaningError::UnknownRate { .. } => {
                "accelerations and reactions can be observed, not differentiated: take differences of the rows of a run".into()
            }
            MeaningError::ParameterNotFinite { .. } => "give the parameters in it other values".into(),
            MeaningError::SingularStart { is_massless: true, .. } => {
                "a mass or moment of inertia that it moves is zero, as that of a point mass on the axis of its joint, which \
                 `center` moves off; or start where the coordinates and functions are regular"
                    .into()
            }
            MeaningError::NotFinite { .. } | MeaningError::SingularStart { .. } => {
                "start where the coordinates and functions are regular".into()
            }
            MeaningError::Derivation { .. } => "check the model".into(),
        }
    }
}
