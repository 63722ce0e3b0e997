//! Equations as a paper prints them.

use std::process::Command;

/// The lines under a heading of `pc derive MODEL`.
fn section(model: &str, heading: &str) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).args(["derive", model]).output().expect("pc starts");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    let lines = text.lines().skip_while(|&line| line != heading).skip(1).take_while(|line| !line.is_empty());
    lines.map(|line| format!("{}\n", line.trim())).collect()
}

/// The Lagrangian in the velocities of the contact point and Euler's angles contains the heading
/// throughout, but the equations only θ, A, C, r and m [Appell 1899; Korteweg 1899].
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

/// Newton's and Euler's equations with thrusts and torques in the usual form [Mellinger and Kumar
/// 2011, (3), (4)].
#[test]
fn a_quadrotor_flies_by_newtons_and_eulers_equations() {
    assert_eq!(
        section("quadrotor", "Equations"),
        "F = f1 + f2 + f3 + f4\n\
         m v_x' = F (sin(θ) cos(φ) cos(ψ) + sin(φ) sin(ψ))\n\
         m v_y' = F (sin(θ) cos(φ) sin(ψ) - sin(φ) cos(ψ))\n\
         m v_z' = cos(φ) cos(θ) F - m g\n\
         I1 p'  = l (f2 - f4) + q s (I2 - I3)\n\
         I2 q'  = l (f3 - f1) + p s (I3 - I1)\n\
         I3 s'  = κ (f1 - f2 + f3 - f4) + p q (I1 - I2)\n"
    );
    assert_eq!(section("quadrotor", "Mass matrix"), "diag(m, m, m, I1, I2, I3)\n");
}

/// [Magnus 1955; Arnold and Maunder 1961].
#[test]
fn a_gyroscope_in_gimbals_drifts_by_its_equations() {
    assert_eq!(
        section("gimbals", "Equations"),
        "u' (A0 + C1 sin(β)² + cos(β)² (A1 + A)) = 2 u v sin(β) cos(β) (A1 - C1 + A) - C v n cos(β)\n\
         v' (B1 + A) = C u n cos(β) - u² sin(β) cos(β) (A1 - C1 + A)\n\
         C n'        = 0\n"
    );
}

/// In momenta, Ω does not occur: p_ω is the angular momentum of the whole, ṗ_ω = p_ω × ω, and each
/// wheel has its own momentum.
#[test]
fn the_wheels_of_a_satellite_are_collected() {
    let output = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(["derive", "reaction-wheels", "--form", "canonical"])
        .output()
        .expect("pc starts");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    for line in [
        "  p_ω1' = p_ω3 cos(ε) (p_Ω2 - p_Ω4)/I2 - p_ω2 sin(ε) z3/I3 + p_ω2 p_ω3 (1/I3 - 1/I2)\n",
        "  p_ω2' = p_ω3 cos(ε) (p_Ω3 - p_Ω1)/I1 + p_ω1 sin(ε) z3/I3 + p_ω1 p_ω3 (1/I1 - 1/I3)\n",
        "  z3 = p_Ω1 + p_Ω2 + p_Ω3 + p_Ω4\n",
    ] {
        assert!(text.contains(line), "{text}");
    }
}
