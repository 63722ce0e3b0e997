//! From a model to a mechanical system.
//!
//! A [`Model`](crate::Model) becomes an [`Assembly`](assembly::Assembly). Read `assembly` first, then `assembler`,
//! which the parts of the assembly share, and then the parts in the order in which `assemble` uses them:
//! `parameters` and `tables`, `frame`, `definitions`, `start` with the `points_of_contact`, `bodies`, the `tree` of bodies on joints and
//! `external_force`, `brackets`, `joint_reactions`, `friction_of_contacts`, `constraints` with `constraint_treatment`, `body_reactions` and
//! the names of a `resultant`, `action`, `event` and `events` with the `stops` of joints, and the quasi-velocities `given` in addition to those of the text;
//! `trial`, `definite`, `inertia` and `orientations` check the start. A `function`, a `drawing` and its `arrows` are assembled
//! separately, on request: a `shape` is a shape of the text or part of the `outlines` of bodies, among them the `block` of a body, at what is `placed`.

pub(crate) mod action;
pub(crate) mod arrows;
pub(crate) mod assemble;
pub(crate) mod assembler;
pub(crate) mod assembly;
mod block;
pub(crate) mod bodies;
pub(crate) mod body_reactions;
pub(crate) mod brackets;
mod carrier;
pub(crate) mod constraint_treatment;
pub(crate) mod constraints;
pub(crate) mod definite;
pub(crate) mod definitions;
pub(crate) mod drawing;
pub(crate) mod event;
pub(crate) mod events;
pub(crate) mod external_force;
pub(crate) mod frame;
mod friction_of_contacts;
pub(crate) mod function;
pub(crate) mod given;
mod inertia;
pub(crate) mod joint_reactions;
pub(crate) mod orientations;
mod outlines;
pub(crate) mod parameters;
mod placed;
mod points_of_contact;
pub(crate) mod resultant;
pub(crate) mod shape;
pub(crate) mod start;
mod start_with_values;
pub(crate) mod stops;
pub(crate) mod tables;
pub(crate) mod tree;
pub(crate) mod trial;
