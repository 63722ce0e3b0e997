//! A frame of a motion as a drawing, as the player of a page shows it.
//!
//! `camera` looks at all that moves, from where the player looks at first; `shapes` has what is drawn of each
//! [`SceneShape`](crate::SceneShape); `frame` puts them into one [`Drawing`](crate::picture::Drawing), the farthest first.

mod camera;
pub(crate) mod frame;
mod shapes;
