//! Tests of the source text of this workspace, one module a topic.

mod imports;
mod interface;
mod layers;
#[path = "source/modules.rs"]
mod modules;
mod pages;
