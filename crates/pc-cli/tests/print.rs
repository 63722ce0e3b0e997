//! Equations as a paper prints them.

use std::process::Command;

/// What stands under a heading of `pc derive MODEL`.
fn section(model: &str, heading: &str) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).args(["derive", model]).output().expect("pc starts");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let lines = text.lines().skip_while(|&line| line != heading).skip(1).take_while(|line| !line.is_empty());
    lines.map(|line| format!("{}\n", line.trim())).collect()
}

/// From a Lagrangian in the velocities of the contact point and Euler's angles, the heading all over it [Appell 1899;
/// Korteweg 1899]: A, C, r and m alone are left, and θ.
#[test]
fn the_tilted_disk_rolls_in_three_lines() {
    assert_eq!(
        section("tilted-disk", "Equations"),
        "ω1' (m r² + A) = A ω2² cos(θ)/sin(θ) - m r g cos(θ) - ω2 ω3 (m r² + C)\n\
         A ω2'          = C ω1 ω3 - A ω1 ω2 cos(θ)/sin(θ)\n\
         ω3' (m r² + C) = m r² ω1 ω2\n"
    );
    assert_eq!(section("tilted-disk", "Mass matrix"), "diag(m r² + A, A, m r² + C)\n");
    assert_eq!(
        section("tilted-disk", "Energy"),
        "m r g sin(θ) + ½ A ω2² + ½ ω1² (m r² + A) + ½ ω3² (m r² + C)\n"
    );
    assert_eq!(
        section("tilted-disk", "Operations of one right-hand side"),
        "parameters free   34 = 2 add + 2 cos + 4 div + 6 fma + 18 mul + 2 sin\n\
         parameters bound  26 = 2 cos + 1 div + 5 fma + 15 mul + 2 sin + 1 sub\n"
    );
}
