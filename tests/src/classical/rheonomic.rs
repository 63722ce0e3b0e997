//! A wire, a hoop and a table that turn.

/// A bead on a straight wire that turns about its end in a vertical plane with Ω = 1, g = 3, α = ½.
/// y = (X, Y, η), η = F ṙ, F = 1 + αt: r̈ = Ω²r − g sin Ωt, and so η̇ = F r̈ + Ḟ ṙ.
pub fn turning_wire(t: f64, y: &[f64], dy: &mut [f64]) {
    let ((sin, cos), stretch) = (t.sin_cos(), 1.0 + t / 2.0);
    let (distance, speed) = (y[0] * cos + y[1] * sin, y[2] / stretch);
    dy[0] = cos * speed - y[1];
    dy[1] = sin * speed + y[0];
    dy[2] = stretch * (distance - 3.0 * sin) + speed / 2.0;
}

/// A bead on a hoop that turns about its vertical diameter with Ω = 3, g = 4. y = (X, Y, Z, η), η = e^(t/5) θ̇, θ from
/// the lowest point; on a hoop of any radius R, R²θ̈ = −ρ (Ω²Z + g), with ρ = R sin θ and Z = −R cos θ.
pub fn turning_hoop(t: f64, y: &[f64], dy: &mut [f64]) {
    let ((sin, cos), growth) = ((3.0 * t).sin_cos(), (t / 5.0).exp());
    let (rho, rate) = (y[0] * cos + y[1] * sin, y[3] / growth);
    let acceleration = -rho * (9.0 * y[2] + 4.0) / (rho * rho + y[2] * y[2]);
    dy[0] = -y[2] * cos * rate - 3.0 * y[1];
    dy[1] = -y[2] * sin * rate + 3.0 * y[0];
    dy[2] = rho * rate;
    dy[3] = growth * (acceleration + rate / 5.0);
}

/// A plane oscillator of stiffness 1 and 4 on a table that turns with Ω = 0.7. y = (X, Y, η_1, η_2), η the velocity in
/// space on the axes of the table: η̇_1 = Ωη_2 − X, η̇_2 = −Ωη_1 − 4Y.
pub fn rotating_oscillator(y: &[f64], dy: &mut [f64]) {
    dy[0] = y[2] + 0.7 * y[1];
    dy[1] = y[3] - 0.7 * y[0];
    dy[2] = 0.7 * y[3] - y[0];
    dy[3] = -0.7 * y[2] - 4.0 * y[1];
}
