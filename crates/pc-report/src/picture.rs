//! Pictures of a page: curves and eigenvalues as inline SVG in the colours of the page.
//!
//! `axes` chooses round numbers, `chart` draws curves over time, `plane` eigenvalues.

mod axes;
pub(crate) mod chart;
pub(crate) mod plane;
