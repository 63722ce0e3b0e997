//! Which names an expression may contain, depending on its place in the text.

/// Which names an expression may contain, depending on its place in the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Stage {
    /// The value of a parameter may contain the preceding parameters.
    Parameter,
    /// The value of a function may contain its arguments and parameters.
    Body,
    /// The height of the ground may contain the coordinates of the point of contact and parameters.
    Height,
    /// A start value may contain parameters, and definitions in terms of them.
    Start,
    /// A definition of a quasi-velocity may contain coordinates, t, and velocities x'.
    Definition,
    /// Kinematics may contain coordinates, t, and quasi-velocities.
    Kinematics,
    /// The constants of a body with a joint, of the joint, and of a point may contain parameters, and
    /// definitions in terms of them.
    Joint,
    /// The mass, inertia, position and orientation of a body may contain coordinates and t.
    Position,
    /// The mass and inertia of a body may contain coordinates, first-order states and t.
    Inertia,
    /// The rate of a first-order state may contain everything but accelerations.
    Rate,
    /// The acceleration of gravity may contain parameters and t.
    Gravity,
    /// A constraint may contain everything but accelerations.
    Constraint,
    /// The energy or a force may contain everything but accelerations.
    Dynamics,
    /// An event may contain everything but accelerations.
    Event,
    /// A requested function may contain everything but accelerations.
    Function,
    /// A shape that is drawn may contain everything but accelerations.
    Drawing,
    /// The action may contain its constants, coordinates and t.
    Action,
    /// Integrals and outputs may contain everything.
    Observation,
}

impl Stage {
    /// Whether all velocities are known here, those of the text and the x'.
    pub(super) fn has_velocities(self) -> bool {
        match self {
            Stage::Parameter
            | Stage::Body
            | Stage::Height
            | Stage::Start
            | Stage::Definition
            | Stage::Kinematics
            | Stage::Joint
            | Stage::Position
            | Stage::Inertia
            | Stage::Gravity
            | Stage::Action => false,
            Stage::Rate
            | Stage::Constraint
            | Stage::Dynamics
            | Stage::Event
            | Stage::Function
            | Stage::Drawing
            | Stage::Observation => true,
        }
    }

    pub(super) fn place(self) -> &'static str {
        match self {
            Stage::Parameter => "the value of a parameter",
            Stage::Body => "the value of a function",
            Stage::Height => "the height of the ground",
            Stage::Start => "a start value",
            Stage::Definition => "the definition of a quasi-velocity",
            Stage::Kinematics => "[kinematics]",
            Stage::Joint => "a joint, a point, or the mass of a body with a joint",
            Stage::Position | Stage::Inertia => "the mass, inertia, position or rotation of a body",
            Stage::Rate => "the rate of a first-order state",
            Stage::Gravity => "the acceleration of gravity",
            Stage::Constraint => "a constraint",
            Stage::Dynamics => "the Lagrangian or a force",
            Stage::Event => "an event",
            Stage::Function => "a function of the state",
            Stage::Drawing => "[[draw]]",
            Stage::Action => "the action",
            Stage::Observation => "an integral or output",
        }
    }

    pub(super) fn allowed(self) -> &'static str {
        match self {
            Stage::Parameter => "numbers and parameters before it",
            Stage::Body => "numbers, its arguments and parameters",
            Stage::Height => "numbers, parameters, and NAME_x and NAME_y of this contact",
            Stage::Start | Stage::Joint => "numbers, parameters and definitions made of them",
            Stage::Definition => "parameters, coordinates, velocities x' and t",
            Stage::Kinematics => "parameters, coordinates, quasi-velocities and t",
            Stage::Position | Stage::Inertia => "parameters, coordinates and t",
            Stage::Gravity => "numbers, parameters, inputs and t",
            Stage::Action => "parameters, coordinates, its constants and t",
            Stage::Constraint | Stage::Drawing => "parameters, coordinates, velocities and t",
            Stage::Rate | Stage::Dynamics | Stage::Event | Stage::Function | Stage::Observation => {
                "declared names"
            }
        }
    }
}
