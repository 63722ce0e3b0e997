//! A still of a motion as a drawing, such as the player of a page shows.
//!
//! `bounds` measures everything that moves; `camera` looks at it from the player's initial viewpoint; `ground` and `shadows` are
//! below it; `shapes` draws each [`SceneShape`](crate::SceneShape); `still` puts the drawn shapes into one
//! [`Drawing`](crate::picture::Drawing), the farthest first.

mod bounds;
mod camera;
mod ground;
mod shadows;
mod shapes;
pub(crate) mod still;
mod vectors;
