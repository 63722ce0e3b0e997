//! The page for a browser.
//!
//! A model is turned into a page of parts under headings. `html` escapes text and writes elements, `formulas`
//! shows displays with their sources, `terms` breaks their lines, `equations`, `theory` and `motion`, with the `player`, the `plots` that
//! answer to the mouse, the `vectors` that they keep together and the `pairs` that portraits show, are the long parts, and `report` combines all parts;
//! `pieces` gives them one by one. The page is XML as well as HTML:
//! every element is closed.

mod equations;
mod formulas;
pub(crate) mod html;
mod motion;
mod pairs;
pub mod pieces;
pub(crate) mod player;
mod plots;
pub(crate) mod report;
mod terms;
mod theory;
mod vectors;
