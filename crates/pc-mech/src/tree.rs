//! Bodies joined by joints.
//!
//! A description of how each body is attached to another gives coordinates, quasi-velocities and the motion
//! of each body. Read `joint` (the kinds of joint, as they are described), `body`, then `tree`, which divides
//! joints into `link`s: each is one elementary movement, with body axes chosen along its axis. `spatial` has
//! vectors and matrices with three components, `kinematics` the recursion of velocities from body to body,
//! `energy` the contribution to a system. The equations are solved joint by joint, in O(N) operations, by
//! `dynamics`, with the `articulated` inertias of masses that `regrouping` has made sparse: `inertia6` has matrices with
//! six rows, `freedom` eliminates a component of a joint, and `coupling`s are velocities that move several links, which
//! are eliminated where the `open_couplings` meet; `turning` rotates inertias from one body to the next. `system` is a system that is a tree, `own_graph` writes it in a graph
//! of its own, `equations` are its equations of motion, `reactions` the loads on its joints.

pub(crate) mod articulated;
pub(crate) mod body;
pub(crate) mod coupling;
pub(crate) mod dynamics;
pub(crate) mod energy;
pub(crate) mod equations;
pub(crate) mod freedom;
pub(crate) mod inertia6;
pub(crate) mod joint;
pub(crate) mod kinematics;
pub(crate) mod link;
pub(crate) mod open_couplings;
pub(crate) mod own_graph;
pub(crate) mod reactions;
pub(crate) mod regrouping;
pub(crate) mod spatial;
pub(crate) mod system;
pub(crate) mod tree;
pub(crate) mod turning;
