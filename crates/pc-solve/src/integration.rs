//! Integration in one call: what is asked for, and what comes out.
//!
//! In go a [`VectorField`](pc_expr::VectorField), a start, output times and [`Options`](options::Options); out come a
//! [`Trajectory`](trajectory::Trajectory) and [`Statistics`](statistics::Statistics), or
//! [dense output](dense_output::DenseOutput). Read `solve` first. `fn_field` makes closures vector fields, `inequality`
//! keeps signs, `projection` brings states of a multistep method back without a restart, `motion_record` is a piece of a
//! motion to be looked up.

pub(crate) mod dense_output;
pub(crate) mod fn_field;
pub(crate) mod inequality;
pub(crate) mod integrals;
pub(crate) mod motion_record;
pub(crate) mod options;
pub(crate) mod projection;
pub(crate) mod solve;
pub(crate) mod statistics;
pub(crate) mod trajectory;
