//! Bodies joined by joints.
//!
//! In goes how each body hangs on another, out come coordinates, quasi-velocities and how each body moves. Read `joint` (the
//! kinds, as they are described), `body`, then `tree`, which takes them to `link`s: one elementary movement each, with the axes
//! of the body along or about one of which it moves. `spatial` has the vectors and matrices of three components, `kinematics`
//! the recursion of velocities from body to body, `energy` what it adds to a system. Joint after joint, in O(N), its equations are
//! solved by `dynamics`, on `articulated` inertias of masses that `regrouping` has made small; `turning` takes them from one body
//! to the next. `system` is a system that is a tree, `own_graph` writes it in a graph of its own, `equations`
//! are its, `reactions` what its joints bear.

pub(crate) mod articulated;
pub(crate) mod body;
pub(crate) mod dynamics;
pub(crate) mod energy;
pub(crate) mod equations;
pub(crate) mod joint;
pub(crate) mod kinematics;
pub(crate) mod link;
pub(crate) mod own_graph;
pub(crate) mod reactions;
pub(crate) mod regrouping;
pub(crate) mod spatial;
pub(crate) mod system;
pub(crate) mod tree;
pub(crate) mod turning;
