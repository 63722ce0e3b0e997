//! The derivatives of observables and the linear equations near a state are those of difference quotients.

use std::ffi::{c_int, c_void};
use std::ptr;

use crate::common::{Model, Refusal, System, call};
use crate::laws::{Law, declare, forced, text_of};
use pc::*;

/// A model with the reactions of its constraints among the observables.
fn reacting(name: &str, form: pc_form) -> System {
    let model = Model::named(name);
    // SAFETY: a live model.
    call(|error| unsafe { pc_model_observe_reactions(model.0, 1, error) }).unwrap();
    model.system(form).unwrap()
}

fn observables(system: &System) -> usize {
    // SAFETY: a live system.
    unsafe { pc_system_observable_count(system.0.as_ref()) }
}

/// A state near the start, on the constraints.
fn near_start(system: &System, seed: f64) -> (f64, Vec<f64>) {
    let (t, mut y) = system.start();
    for (i, y) in y.iter_mut().enumerate() {
        *y += 0.1 * (seed + 1.7 * i as f64).sin();
    }
    // SAFETY: a live system and as many numbers as said.
    call(|error| unsafe { pc_system_project(system.0, t, y.as_mut_ptr(), y.len(), error) }).unwrap();
    (t, y)
}

/// The central difference of a function of the shift of one number: an error of h² and of rounding / h.
fn difference(mut of_shift: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let h = 1e-5;
    let (there, back) = (of_shift(h), of_shift(-h));
    there.iter().zip(back).map(|(there, back)| (there - back) / (2.0 * h)).collect()
}

/// The columns differ by no more than the errors of the differences; where an observable has no value, it has no
/// derivative.
#[track_caller]
fn assert_near(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size =
        found.iter().filter(|entry| entry.is_finite()).fold(1.0, |size: f64, entry| size.max(entry.abs()));
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let is_near = (found - expected).abs() < 2e-6 * size || !found.is_finite() && !expected.is_finite();
        assert!(is_near, "{what}, row {i}: {found} is not {expected}");
    }
}

fn check_observables(system: &System, (t, y): (f64, &[f64]), name: &str) {
    let (rows, dim) = (observables(system), system.dim());
    let by_state = system.at(pc_system_observable_jacobian, t, y, rows * dim).unwrap();
    for (j, column) in by_state.chunks(rows).enumerate() {
        let shifted = |h: f64| {
            let mut y = y.to_vec();
            y[j] += h;
            system.at(pc_system_observe, t, &y, rows).unwrap()
        };
        assert_near(column, &difference(shifted), &format!("{name}, by {}", system.name(j)));
    }
    let parameters = system.parameters();
    let by_parameters =
        system.at(pc_system_observable_parameter_jacobian, t, y, rows * parameters.len()).unwrap();
    for (j, column) in by_parameters.chunks(rows).enumerate() {
        let shifted = |h: f64| {
            let mut moved = parameters.clone();
            moved[j] += h;
            system.set_parameters(&moved).unwrap();
            system.at(pc_system_observe, t, y, rows).unwrap()
        };
        assert_near(column, &difference(shifted), &format!("{name}, by parameter {j}"));
        system.set_parameters(&parameters).unwrap();
    }
}

/// Models with frames, brackets, trees, loops, multipliers, time and reactions, in both forms where both exist.
#[test]
fn derivatives_of_observables_are_those_of_differences() {
    let names = [
        "heavy-top-lagrange",
        "tilted-disk",
        "puma-560",
        "chaplygin-sleigh",
        "spherical-pendulum-cartesian",
        "double-pendulum-links",
        "relativistic-particle",
        "turning-wire",
        "vertical-disk-driven",
        "rod",
    ];
    for name in names {
        for form in [pc_form::PC_POINCARE, pc_form::PC_CANONICAL] {
            let system = reacting(name, form);
            for seed in [0.3, 1.1] {
                let (t, y) = near_start(&system, seed);
                check_observables(&system, (t, &y), name);
            }
        }
    }
    for name in ["four-bar-loop", "quadruped", "satellite"] {
        let system = reacting(name, pc_form::PC_POINCARE);
        let (t, y) = near_start(&system, 0.3);
        check_observables(&system, (t, &y), name);
    }
}

/// Accelerations of bodies on joints, which are found from link to link.
#[test]
fn accelerations_of_a_tree_are_differentiated() {
    let text = text_of("puma-560")
        .replace("[outputs]\n", "[outputs]\nfirst = \"d(waist')\"\nlast = \"g*d(hand')*waist' + c\"\n");
    let model = Model::text(&text).unwrap();
    for form in [pc_form::PC_POINCARE, pc_form::PC_CANONICAL] {
        let system = model.system(form).unwrap();
        let (t, y) = near_start(&system, 0.4);
        check_observables(&system, (t, &y), "puma-560 with accelerations");
    }
}

/// External forces that are functions of the state change with it.
#[test]
fn observables_change_through_forces_of_the_program() {
    let law = Law::new(|_, y, q, _| {
        q.copy_from_slice(&[y[2].sin() - y[5], 0.3 * y[4] * y[4]]);
        0
    });
    for name in ["rod", "vertical-disk"] {
        let on = if name == "rod" { ["x", "z"] } else { ["X", "θ"] };
        let system = forced(name, &on, pc_form::PC_POINCARE);
        let rows = observables(&system);
        let (t, y) = near_start(&system, 0.2);
        let unset = system.at(pc_system_observable_jacobian, t, &y, rows * system.dim()).unwrap_err();
        assert_eq!(unset.status, pc_status::PC_EVALUATION);
        assert!(unset.message.contains("pc_system_set_force sets one"), "{}", unset.message);
        law.set(&system).unwrap();
        check_observables(&system, (t, &y), name);
    }
}

/// A, B, C and D.
#[derive(Debug, PartialEq)]
struct Linear {
    a: Vec<f64>,
    b: Vec<f64>,
    c: Vec<f64>,
    d: Vec<f64>,
}

fn linearized(
    system: &System,
    (t, y): (f64, &[f64]),
    forces: Option<&[f64]>,
    inputs: &[usize],
) -> Result<Linear, Refusal> {
    // SAFETY: a live system.
    let external = unsafe { pc_system_force_count(system.0.as_ref()) };
    let (dim, rows, columns) = (system.dim(), observables(system), external + inputs.len());
    let zeros = |length: usize| vec![0.0; length];
    let (mut a, mut b, mut c, mut d) =
        (zeros(dim * dim), zeros(dim * columns), zeros(rows * dim), zeros(rows * columns));
    let (forces, count) = forces.map_or((ptr::null(), 0), |forces| (forces.as_ptr(), forces.len()));
    // SAFETY: a live system, arrays as long as said.
    call(|error| unsafe {
        pc_system_linearize(
            system.0,
            t,
            y.as_ptr(),
            y.len(),
            forces,
            count,
            inputs.as_ptr(),
            inputs.len(),
            a.as_mut_ptr(),
            a.len(),
            b.as_mut_ptr(),
            b.len(),
            c.as_mut_ptr(),
            c.len(),
            d.as_mut_ptr(),
            d.len(),
            error,
        )
    })?;
    Ok(Linear { a, b, c, d })
}

unsafe extern "C" fn constant(
    _: f64,
    _: *const f64,
    _: usize,
    q: *mut f64,
    e: usize,
    user: *mut c_void,
) -> c_int {
    // SAFETY: as many numbers as there are forces.
    unsafe { ptr::copy_nonoverlapping(user.cast::<f64>(), q, e) };
    0
}

/// f(t, y, u) and h(t, y, u) for constant forces u.
fn evaluated(system: &System, (t, y): (f64, &[f64]), forces: &mut [f64]) -> Vec<f64> {
    if !forces.is_empty() {
        // SAFETY: a live system, and forces that live as long as they are asked for.
        call(|error| unsafe {
            pc_system_set_force(system.0, Some(constant), None, forces.as_mut_ptr().cast(), None, error)
        })
        .unwrap();
    }
    let mut all = system.at(pc_system_rhs, t, y, system.dim()).unwrap();
    all.extend(system.at(pc_system_observe, t, y, observables(system)).unwrap());
    all
}

fn check_linear(system: &System, (t, y): (f64, &[f64]), inputs: &[usize], name: &str) {
    let dim = system.dim();
    // SAFETY: a live system.
    let external = unsafe { pc_system_force_count(system.0.as_ref()) };
    let forces: Vec<f64> = (0..external).map(|i| 0.7 - 0.4 * i as f64).collect();
    let linear = linearized(system, (t, y), Some(&forces), inputs).unwrap();
    let rows = observables(system);
    let by_state = linear.a.chunks(dim).zip(linear.c.chunks(rows));
    let by_inputs = linear.b.chunks(dim).zip(linear.d.chunks(rows));
    let parameters = system.parameters();
    for (j, (rates, observed)) in by_state.chain(by_inputs).enumerate() {
        let shifted = |h: f64| {
            let (mut y, mut forces, mut moved) = (y.to_vec(), forces.clone(), parameters.clone());
            match j.checked_sub(dim) {
                None => y[j] += h,
                Some(u) if u < external => forces[u] += h,
                Some(u) => moved[inputs[u - external]] += h,
            }
            system.set_parameters(&moved).unwrap();
            evaluated(system, (t, &y), &mut forces)
        };
        let expected = difference(shifted);
        system.set_parameters(&parameters).unwrap();
        assert_near(rates, &expected[..dim], &format!("{name}, rates by {j}"));
        assert_near(observed, &expected[dim..], &format!("{name}, observables by {j}"));
    }
    if external > 0 {
        // The same values by a function.
        let mut forces = forces.clone();
        evaluated(system, (t, y), &mut forces);
        assert_eq!(linearized(system, (t, y), None, inputs).unwrap(), linear);
    }
}

#[test]
fn linear_equations_are_those_of_differences() {
    let cases: [(&str, &[&str]); 6] = [
        ("puma-560", &["waist", "elbow", "hand"]),
        ("rod", &["x", "z"]),
        ("tilted-disk", &["ω2"]),
        ("cart-pole", &[]),
        ("four-bar-loop", &[]),
        ("heavy-top-lagrange", &["ω1", "ω3"]),
    ];
    for (name, on) in cases {
        for form in [pc_form::PC_POINCARE, pc_form::PC_CANONICAL] {
            let is_canonical = matches!(form, pc_form::PC_CANONICAL);
            if is_canonical && name == "four-bar-loop" {
                continue; // momenta of a loop are determined on it alone
            }
            let model = Model::text(&text_of(name)).unwrap();
            declare(&model, on);
            let system = model.system(form).unwrap();
            let inputs: Vec<usize> = (0..system.parameters().len().min(2)).rev().collect();
            let (t, y) = near_start(&system, 0.9);
            check_linear(&system, (t, &y), &inputs, name);
        }
    }
}

#[test]
fn what_is_wrong_with_a_linearization_is_said() {
    let system = forced("rod", &["x"], pc_form::PC_POINCARE);
    let (t, y) = system.start();
    let refused = linearized(&system, (t, &y), Some(&[1.0, 2.0]), &[]).unwrap_err();
    assert_eq!(refused.message, "forces: 2 numbers instead of 1");
    let refused = linearized(&system, (t, &y), Some(&[1.0]), &[3]).unwrap_err();
    assert_eq!(
        (refused.status, refused.message.as_str()),
        (pc_status::PC_INVALID_ARGUMENT, "inputs: index 3 is not below 0")
    );
    let refused = linearized(&system, (t, &y), None, &[]).unwrap_err();
    assert!(refused.message.contains("pc_system_set_force sets one"), "{}", refused.message);
    let refused = linearized(&system, (t, &y[1..]), Some(&[1.0]), &[]).unwrap_err();
    assert_eq!(refused.message, "y: 5 numbers instead of 6");
    let refused = linearized(&system, (t, &[f64::NAN; 6]), Some(&[1.0]), &[]).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_EVALUATION);
    let (mut a, dim) = ([0.0; 40], system.dim());
    let inside = a.as_mut_ptr().wrapping_add(30);
    let mut only = |a_length: usize, b: *mut f64, b_length: usize| {
        let a = a.as_mut_ptr();
        // SAFETY: a live system; arrays as long as said, or refused.
        call(|error| unsafe {
            pc_system_linearize(
                system.0,
                t,
                y.as_ptr(),
                dim,
                [1.0].as_ptr(),
                1,
                ptr::null(),
                0,
                a,
                a_length,
                b,
                b_length,
                ptr::null_mut(),
                0,
                ptr::null_mut(),
                0,
                error,
            )
        })
    };
    assert_eq!(only(36, ptr::null_mut(), 0), Ok(()));
    assert_eq!(only(36, inside, 6).unwrap_err().message, "a and b share memory, but must be separate");
    assert_eq!(only(35, ptr::null_mut(), 0).unwrap_err().message, "a: 35 numbers instead of 36");
    assert_eq!(only(36, ptr::null_mut(), 6).unwrap_err().message, "b is a null pointer");
}

/// What is written there would be read as indices.
#[test]
fn inputs_are_apart_from_what_is_written() {
    let system = System::of("heavy-top-lagrange");
    let ((t, y), dim) = (system.start(), system.dim());
    // The index 1 as the bytes of a number.
    let mut place = vec![f64::from_bits(1); dim];
    let b = place.as_mut_ptr();
    // SAFETY: a live system and arrays as long as said; they overlap, which is refused.
    let shared = call(|error| unsafe {
        let (none, left) = (ptr::null(), ptr::null_mut());
        let (s, y, inputs) = (system.0, y.as_ptr(), b.cast::<usize>());
        pc_system_linearize(s, t, y, dim, none, 0, inputs, 1, left, 0, b, dim, left, 0, left, 0, error)
    });
    assert_eq!(shared.unwrap_err().message, "inputs and b share memory, but must be separate");
}
