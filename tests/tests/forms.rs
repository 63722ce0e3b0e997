//! The equations do not depend on the form: the same motion in two frames, in any gauge, and by Lagrange's equations
//! for random frames and Lagrangians.

#![expect(clippy::unwrap_used, reason = "tests")]

mod holonomic {
    mod definition;
    mod harness;
    mod jet;
    mod random_systems;
    mod shared;
    mod two_frames;
}
