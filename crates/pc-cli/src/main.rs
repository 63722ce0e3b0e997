//! The program `pc`.
fn main() {}
