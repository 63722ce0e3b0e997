//! Errors of bodies connected by joints.

/// An error of a tree of bodies.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TreeError {
    /// Two bodies with the same name.
    #[error("there are two bodies called `{body}`")]
    TwoBodies {
        /// Their name.
        body: String,
    },
    /// A parent that does not exist.
    #[error("the body `{body}` hangs on `{parent}`, but there is no body of that name")]
    NoParent {
        /// The body.
        body: String,
        /// Its parent.
        parent: String,
    },
    /// Bodies whose parents form a circle.
    #[error("bodies hang on each other in a circle: {}", bodies.join(" on "))]
    Circle {
        /// The names of the bodies, each before its parent.
        bodies: Vec<String>,
    },
    /// An axis without a direction.
    #[error("the axis ({}, {}, {}) of the joint of `{body}` has no direction", axis[0], axis[1], axis[2])]
    NoDirection {
        /// The body.
        body: String,
        /// The axis.
        axis: [f64; 3],
    },
    /// A list of names whose length does not fit the joint.
    #[error("the joint of `{body}` has {expected} {what}; {found} names are given")]
    Names {
        /// The body.
        body: String,
        /// Coordinates or quasi-velocities.
        what: &'static str,
        /// Number of names.
        found: usize,
        /// The number that the joint needs.
        expected: usize,
    },
    /// A joint that follows one that does not exist.
    #[error("the joint of `{body}` follows that of `{followed}`, but there is no body of that name")]
    NoFollowed {
        /// The body.
        body: String,
        /// The name that is not found.
        followed: String,
    },
    /// A joint that follows another, where one of the two has not exactly one coordinate.
    #[error(
        "the joint of `{body}` cannot follow that of `{followed}`: both must have exactly one coordinate"
    )]
    NotSingle {
        /// The body.
        body: String,
        /// The body whose joint is followed.
        followed: String,
    },
    /// A spring, damping, friction or armature of a joint that has not exactly one coordinate.
    #[error(
        "the joint of `{body}` cannot have the {what} given to it: it does not have exactly one coordinate"
    )]
    NoDrive {
        /// The body.
        body: String,
        /// Which of them.
        what: &'static str,
    },
    /// Joints that follow each other in a circle.
    #[error("joints follow each other in a circle: {}", bodies.join(", "))]
    FollowedCircle {
        /// The names of the bodies, each before the one that it follows.
        bodies: Vec<String>,
    },
    /// A property of a body that is not constant.
    #[error("the {what} of `{body}` is constant; here it depends on `{symbol}`")]
    NotConstant {
        /// The body.
        body: String,
        /// Its part.
        what: &'static str,
        /// The time, coordinate, velocity or state that it contains.
        symbol: String,
    },
    /// Coordinates or quasi-velocities of the tree that the system does not have.
    #[error("a joint uses `{name}`, which is not among the {what} of the system")]
    NotOfTheSystem {
        /// The coordinate or quasi-velocity.
        name: String,
        /// Coordinates or quasi-velocities.
        what: &'static str,
    },
}
