//! Systems that depend on time or have a Lagrangian linear in the quasi-velocities.

use super::harness::Description;

/// A plane oscillator in a chart that turns with Ω = 0.7; the η are the absolute velocity along its axes.
pub(super) const TURNING_CHART: Description = Description {
    coordinates: &["X", "Y"],
    quasi_velocities: &["u", "v"],
    velocities: |_, x, eta| vec![eta[0] + 0.7 * x[1], eta[1] - 0.7 * x[0]],
    lagrangian: |_, x, eta| {
        (eta[0].square() + eta[1].square()) / 2.0 - (x[0].square() + 4.0 * x[1].square()) / 2.0
    },
};

/// A charge in the uniform magnetic field B(t) = 1 + ½ sin t, in polar coordinates, η = (ρ̇, ρφ̇).
pub(super) const CHARGE: Description = Description {
    coordinates: &["rho", "phi"],
    quasi_velocities: &["u", "v"],
    velocities: |_, x, eta| vec![eta[0], eta[1] / x[0]],
    lagrangian: |t, x, eta| {
        (eta[0].square() + eta[1].square()) / 2.0 + (1.0 + t.sin() / 2.0) * x[0] * eta[1] / 2.0
    },
};

/// The damped oscillator ẍ = −½ẋ − 4x of L = e^(t/2) (½ẋ² − 2x²), in the frame ẋ = e^(−t/4) η + x/4.
pub(super) const SCALED_OSCILLATOR: Description = Description {
    coordinates: &["x"],
    quasi_velocities: &["eta"],
    velocities: |t, x, eta| vec![(-t / 4.0).exp() * eta[0] + x[0] / 4.0],
    lagrangian: |t, x, eta| {
        let velocity = (-t / 4.0).exp() * eta[0] + x[0] / 4.0;
        (t / 2.0).exp() * (velocity.square() / 2.0 - 2.0 * x[0].square())
    },
};
