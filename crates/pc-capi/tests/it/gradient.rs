//! Gradients of functions of a motion against difference quotients, and Lyapunov exponents against closed forms.

use std::ffi::c_int;
use std::ptr;

use crate::common::{Model, Refusal, Solver, System, call, sharp};
use pc::pc_form::PC_POINCARE;
use pc::*;

/// A damped oscillator with a parameter in the force; the observables are the energy, q and its acceleration.
const SPRING: &str = "[parameters]\nk = 4\nc = 0.3\nm = 2\n[coordinates]\nq = 1\n[quasi_velocities]\n\"q'\" = 0.5\n\
    [lagrangian]\nkinetic = \"m*q'^2/2\"\npotential = \"k*q^2/2 + q^4/4\"\ndissipation = \"c*q'^2/2\"\n\
    [outputs]\nplace = \"q\"\npush = \"m*d(q')\"\n";

fn spring(differentiated: bool) -> System {
    let model = Model::text(SPRING).unwrap();
    // SAFETY: a live model.
    call(|error| unsafe { pc_model_differentiate(model.0, c_int::from(differentiated), error) }).unwrap();
    model.system(PC_POINCARE).unwrap()
}

/// G, ∂G/∂y and ∂G/∂p.
type Gradient = (f64, Vec<f64>, Vec<f64>);

fn gradient(
    system: &System,
    y: &[f64],
    (end, density): (usize, usize),
    parameters: usize,
) -> Result<Gradient, Refusal> {
    let (mut value, mut by_start, mut by_parameters) = (0.0, vec![0.0; y.len()], vec![0.0; parameters]);
    let options = sharp();
    // SAFETY: a live system and arrays as long as said.
    call(|error| unsafe {
        let places = if parameters == 0 { ptr::null_mut() } else { by_parameters.as_mut_ptr() };
        pc_system_gradient(
            system.0,
            &raw const options,
            0.0,
            y.as_ptr(),
            y.len(),
            1.5,
            end,
            density,
            &raw mut value,
            by_start.as_mut_ptr(),
            by_start.len(),
            places,
            parameters,
            error,
        )
    })?;
    Ok((value, by_start, by_parameters))
}

#[test]
fn gradients_are_those_of_differences() {
    let system = spring(true);
    let y = [1.0, 0.5];
    let parameters = system.parameters();
    for choice in [(1, usize::MAX), (2, usize::MAX), (usize::MAX, 0), (0, 2)] {
        let of = |y: &[f64]| gradient(&system, y, choice, 0).unwrap().0;
        let (value, by_start, by_parameters) = gradient(&system, &y, choice, 3).unwrap();
        assert_eq!(of(&y), value);
        let h = 1e-5;
        let close = |found: f64, there: f64, back: f64| {
            let quotient = (there - back) / (2.0 * h);
            assert!(
                (found - quotient).abs() < 1e-7 * (1.0 + quotient.abs()),
                "{choice:?}: {found} {quotient}"
            );
        };
        for i in 0..2 {
            let at = |h: f64| {
                of(&[y[0] + h * f64::from(u8::from(i == 0)), y[1] + h * f64::from(u8::from(i == 1))])
            };
            close(by_start[i], at(h), at(-h));
        }
        for j in 0..3 {
            let at = |h: f64| {
                let mut moved = parameters.clone();
                moved[j] += h;
                system.set_parameters(&moved).unwrap();
                of(&y)
            };
            close(by_parameters[j], at(h), at(-h));
            system.set_parameters(&parameters).unwrap();
        }
    }
    // The output at the end is that of the motion.
    let end = Solver::of(&system, &sharp()).advance(1.5).1;
    let (value, ..) = gradient(&system, &y, (1, usize::MAX), 0).unwrap();
    assert!((value - end[0]).abs() < 1e-10);
}

#[test]
fn gradients_that_do_not_exist_are_refused() {
    let system = spring(false);
    let refused = gradient(&system, &[1.0, 0.5], (1, usize::MAX), 3).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_UNSUPPORTED);
    assert!(refused.message.contains("pc_model_differentiate"), "{}", refused.message);
    assert!(gradient(&system, &[1.0, 0.5], (1, usize::MAX), 0).is_ok());
    let refused = gradient(&system, &[1.0, 0.5], (3, 0), 0).unwrap_err();
    assert_eq!(refused.message, "end: index 3 is not below 3");
    assert_eq!(gradient(&system, &[1.0], (1, 0), 0).unwrap_err().message, "y: 1 numbers instead of 2");
    let system = spring(true);
    let refused = gradient(&system, &[1.0, 0.5], (1, 0), 2).unwrap_err();
    assert_eq!(refused.message, "by_parameters: 2 numbers instead of 3");
}

fn exponents(system: &System, y: &[f64], count: usize, interval: f64) -> Result<Vec<f64>, Refusal> {
    let mut all = vec![0.0; count];
    let options = sharp();
    // SAFETY: a live system and arrays as long as said.
    call(|error| unsafe {
        let (to, from) = (all.as_mut_ptr(), y.as_ptr());
        pc_system_lyapunov(
            system.0,
            &raw const options,
            0.0,
            from,
            y.len(),
            interval,
            200,
            20,
            to,
            count,
            error,
        )
    })?;
    Ok(all)
}

/// ẍ = x − ẋ/2 near rest: the roots of λ² + λ/2 − 1.
#[test]
fn exponents_of_a_saddle_are_its_roots() {
    let text = "[coordinates]\nx = 0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"-x^2/2\"\ndissipation = \"x'^2/4\"\n";
    let system = Model::text(text).unwrap().system(PC_POINCARE).unwrap();
    let found = exponents(&system, &[0.0, 0.0], 2, 0.5).unwrap();
    let root = (0.0625f64 + 1.0).sqrt();
    for (found, expected) in found.iter().zip([root - 0.25, -root - 0.25]) {
        assert!((found - expected).abs() < 1e-6, "{found} is not {expected}");
    }
    let largest = exponents(&system, &[0.0, 0.0], 1, 0.5).unwrap();
    assert!(largest.len() == 1 && (largest[0] - found[0]).abs() < 1e-9);
    for (count, interval) in [(0, 0.5), (3, 0.5), (1, -1.0), (1, f64::NAN)] {
        let refused = exponents(&system, &[0.0, 0.0], count, interval).unwrap_err();
        assert_eq!(refused.status, pc_status::PC_INVALID_ARGUMENT, "{}", refused.message);
    }
}
