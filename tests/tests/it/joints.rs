//! Bodies on joints in text models: against the same bodies placed by hand, against mechanisms written in angles, loops and
//! their reactions, what is refused and with which words, and robots in URDF.

mod by_hand;
mod contact_friction;
mod contacts;
mod contacts_refused;
mod friction_at_rest;
mod ground;
mod library;
mod loops;
mod loops_by_joints;
mod random;
mod random_contacts;
mod refused;
mod run;
mod text;
