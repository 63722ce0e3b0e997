//! Pictures of a motion, of a sweep and of eigenvalues, for a page and for files.
//!
//! A [`Recording`](crate::Recording) is divided into [`Panel`]s, each with curves that one scale shows well;
//! several panels form a [`Picture`], and this is turned into a [`Drawing`]: lines, areas and texts that can
//! be written in any format. Read `panel`, the contents of common axes; `scales`, which curves share them;
//! `motion`, the panels of a motion; `axes`, round numbers; `simplify`, the visible points; `fan` and
//! `roots`, two kinds of contents; `chart`, a panel drawn; `drawing` and `svg`, the shapes and their output; `units`, their names; `sheet`, panels arranged one below the other;
//! `plane`, eigenvalues.

mod axes;
pub(crate) mod chart;
mod drawing;
mod fan;
pub(crate) mod motion;
mod panel;
pub(crate) mod plane;
mod roots;
mod scales;
mod sheet;
mod simplify;
mod svg;
pub(crate) mod units;

pub(crate) use drawing::GLASS;
pub use drawing::{Anchor, Drawing, Ink, Shape};
pub use motion::Wanted;
pub use panel::{Band, Content, Curve, Fan, Panel, Root, Scale};
pub use scales::by_scale;
pub use sheet::Picture;
