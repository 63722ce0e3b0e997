//! A still of a motion as a drawing, such as the player of a page shows.
//!
//! `camera` looks at everything that moves, from the player's initial viewpoint; `shapes` draws each
//! [`SceneShape`](crate::SceneShape); `still` puts the drawn shapes into one [`Drawing`](crate::picture::Drawing),
//! the farthest first.

mod camera;
mod shapes;
pub(crate) mod still;
