//! Charges, oscillators and fast particles.

/// A unit charge of unit mass in the field B(t), y = (ρ, φ, η_1, η_2) with η the velocity along and across the
/// radius: ρ̇ = η_1, φ̇ = η_2/ρ, η̇_1 = η_2²/ρ + B η_2, η̇_2 = −η_1 η_2/ρ − B η_1 − ½ Ḃ ρ.
pub fn charged_particle(field: f64, field_rate: f64, y: &[f64], dy: &mut [f64]) {
    let (radius, along, across) = (y[0], y[2], y[3]);
    dy[0] = along;
    dy[1] = across / radius;
    dy[2] = across * across / radius + field * across;
    dy[3] = -along * across / radius - field * along - field_rate * radius / 2.0;
}

/// Acceleration of the damped oscillator, ẍ = −2δ ẋ − ω² x.
pub fn damped_acceleration(damping: f64, frequency: f64, x: f64, velocity: f64) -> f64 {
    -2.0 * damping * velocity - frequency * frequency * x
}

/// The damped oscillator with y = (x, ẋ): ẍ = −2δ ẋ − ω² x.
pub fn damped_oscillator(damping: f64, frequency: f64, y: &[f64], dy: &mut [f64]) {
    dy[0] = y[1];
    dy[1] = damped_acceleration(damping, frequency, y[0], y[1]);
}

/// The damped oscillator with y = (x, η), η = e^(δt) (ẋ − δx): ẋ = e^(−δt) η + δx and
/// η̇ = δη + e^(δt) (ẍ − δẋ), ẍ = −2δ ẋ − ω² x.
pub fn damped_oscillator_in_scaled_frame(damping: f64, frequency: f64, t: f64, y: &[f64], dy: &mut [f64]) {
    let growth = (damping * t).exp();
    let velocity = y[1] / growth + damping * y[0];
    let acceleration = damped_acceleration(damping, frequency, y[0], velocity);
    dy[0] = velocity;
    dy[1] = damping * y[1] + growth * (acceleration - damping * velocity);
}

/// Kepler's problem in special relativity, rest mass one, y = (ρ, φ, η_1, η_2) with η the velocity along and across
/// the radius: ρ̇ = η_1, φ̇ = η_2/ρ and, with F = −κ/ρ² and γ = (1 − |η|²/c²)^(−½),
/// η̇_1 = F (1 − η_1²/c²)/γ + η_2²/ρ, η̇_2 = −F η_1 η_2/(c²γ) − η_1 η_2/ρ.
pub fn relativistic_particle(light: f64, attraction: f64, y: &[f64], dy: &mut [f64]) {
    let (radius, along, across) = (y[0], y[2], y[3]);
    let light_squared = light * light;
    let force = -attraction / (radius * radius);
    let inverse_gamma = (1.0 - (along * along + across * across) / light_squared).sqrt();
    dy[0] = along;
    dy[1] = across / radius;
    dy[2] = force * (1.0 - along * along / light_squared) * inverse_gamma + across * across / radius;
    dy[3] = -force * along * across * inverse_gamma / light_squared - along * across / radius;
}

/// A particle of rest mass one on a line under the constant force f, y = (x, ẋ): ẍ = f (1 − ẋ²/c²)^(3/2).
pub fn relativistic_constant_force(light: f64, force: f64, y: &[f64], dy: &mut [f64]) {
    dy[0] = y[1];
    dy[1] = force * (1.0 - (y[1] / light).powi(2)).powi(3).sqrt();
}
