//! Bodies on joints in text models: against the same bodies placed by hand, against mechanisms written in angles, loops and
//! their reactions, what is refused and with which words, and robots in URDF.

mod by_hand;
mod contacts;
mod friction_at_rest;
mod ground;
mod library;
mod loops;
mod loops_by_joints;
mod random;
mod refused;
mod run;
mod text;
