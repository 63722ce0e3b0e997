//! Look-up by name, derivatives by parameters, the right-hand side of M η̇ = r, kernels over many states.

#![expect(clippy::unwrap_used, unsafe_code, reason = "tests")]

#[macro_use]
mod common;

use std::ffi::c_char;
use std::ptr;

use common::{Model, Refusal, System, c, call};
use pc::pc_status::*;
use pc::*;

const DRIVEN: &str = r#"
[parameters]
k = 4.0
c = 0.5
[coordinates]
x = 1.0
y = 0.2
[lagrangian]
kinetic = "x'^2 + y'^2/2 + x'*y'/2"
potential = "k*x^2/2 - cos(t*c)*y"
[outputs]
sum = "x + y"
"#;

type Find =
    unsafe extern "C" fn(*const pc_system, *const c_char, *mut usize, *mut *mut pc_error) -> pc_status;

fn find(system: &System, function: Find, name: &str) -> Result<usize, Refusal> {
    let (name, mut index) = (c(name), usize::MAX);
    // SAFETY: a live system, text and a place for a number.
    call(|error| unsafe { function(system.0, name.as_ptr(), &raw mut index, error) }).map(|()| index)
}

#[test]
fn names_are_found() {
    let system = Model::text(DRIVEN).unwrap().system(pc_form::PC_POINCARE).unwrap();
    assert_eq!(find(&system, pc_system_find, "y'"), Ok(3));
    assert_eq!(find(&system, pc_system_find_parameter, "c"), Ok(1));
    assert_eq!(find(&system, pc_system_find_observable, "energy"), Ok(0));
    assert_eq!(find(&system, pc_system_find_observable, "sum"), Ok(1));
    for (function, said) in [
        (pc_system_find as Find, "there is no component of the state called `q`; there are x, y, x', y'"),
        (pc_system_find_parameter, "there is no parameter called `q`; there are k, c"),
        (pc_system_find_observable, "there is no observable called `q`; there are energy, sum"),
    ] {
        let refusal = find(&system, function, "q").unwrap_err();
        assert_eq!((refusal.status, refusal.message.as_str()), (PC_NOT_FOUND, said));
    }
    let mut index = 0;
    refused! { PC_INVALID_ARGUMENT, "is a null pointer";
        pc_system_find(ptr::null(), c"x".as_ptr(), &raw mut index);
        pc_system_find(system.0, ptr::null(), &raw mut index);
        pc_system_find_parameter(system.0, c"k".as_ptr(), ptr::null_mut());
    }
}

/// M = ((2, ½), (½, 1)), r = (−k x, cos(t c)).
#[test]
fn the_right_hand_side_and_its_derivatives() {
    let (t, y) = (0.7, [0.9, 0.1, -0.3, 0.4]);
    let (k, c) = (4.0, 0.5);
    let model = Model::text(DRIVEN).unwrap();
    let plain = model.system(pc_form::PC_POINCARE).unwrap();
    let right = plain.at(pc_system_right_hand_side, t, &y, 2).unwrap();
    // A rounding of each.
    assert!((right[0] + k * y[0]).abs() < 1e-15 && (right[1] - (t * c).cos()).abs() < 1e-15, "{right:?}");
    let refusal = plain.at(pc_system_parameter_jacobian, t, &y, 8).unwrap_err();
    assert_eq!(refusal.status, PC_UNSUPPORTED);
    assert!(refusal.message.ends_with("pc_model_differentiate was not asked"), "{}", refusal.message);

    // SAFETY: a live model.
    call(|error| unsafe { pc_model_differentiate(model.0, 1, error) }).unwrap();
    let system = model.system(pc_form::PC_POINCARE).unwrap();
    let found = system.at(pc_system_parameter_jacobian, t, &y, 8).unwrap();
    // M⁻¹ = ((1, −½), (−½, 2)) / (7/4), times (−x, 0) and (0, −t sin(t c)).
    let solved = |r: [f64; 2]| [(r[0] - r[1] / 2.0) / 1.75, (2.0 * r[1] - r[0] / 2.0) / 1.75];
    let (by_k, by_c) = (solved([-y[0], 0.0]), solved([0.0, -t * (t * c).sin()]));
    let expected = [0.0, 0.0, by_k[0], by_k[1], 0.0, 0.0, by_c[0], by_c[1]];
    // A few roundings of numbers about 1.
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?} {expected:?}");
    // In momenta r is that of the velocities they stand for.
    let canonical = model.system(pc_form::PC_CANONICAL).unwrap();
    let momenta = plain.at(pc_system_to_momenta, t, &y, 4).unwrap();
    let of_momenta = canonical.at(pc_system_right_hand_side, t, &momenta, 2).unwrap();
    assert!(of_momenta.iter().zip(&right).all(|(a, b)| (a - b).abs() < 1e-14), "{of_momenta:?}");
    for length in [0, 7, 9] {
        assert_eq!(
            system.at(pc_system_parameter_jacobian, t, &y, length).unwrap_err().status,
            PC_INVALID_ARGUMENT
        );
    }
}

#[test]
fn a_kernel_evaluates_many_states() {
    // √x has no rate below 0.
    let text = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"-x*sqrt(x)\"\n";
    let system = Model::text(text).unwrap().system(pc_form::PC_POINCARE).unwrap();
    let mut kernel = ptr::null_mut();
    // SAFETY: a live system and a place for the handle.
    call(|error| unsafe { pc_kernel_new(system.0, &raw mut kernel, error) }).unwrap();
    let states = [1.0, 0.5, 4.0, -0.5, 9.0, 0.0];
    let mut rates = [0.0; 6];
    let context = kernel.cast();
    // SAFETY: a live kernel and arrays as long as said, or what is to be refused.
    unsafe {
        assert_eq!(pc_kernel_rhs_many(0.0, states.as_ptr(), 3, rates.as_mut_ptr(), context), 0);
        assert_eq!(rates, [0.5, 1.5, -0.5, 3.0, 0.0, 4.5]);
        let states = [1.0, 0.5, -4.0, -0.5, 9.0, 0.0];
        assert_eq!(pc_kernel_rhs_many(0.0, states.as_ptr(), 3, rates.as_mut_ptr(), context), 1);
        assert!(rates[2].is_nan() && rates[3].is_nan());
        assert_eq!((rates[1], rates[5]), (1.5, 4.5));
        // None; no arrays; one array for both; more than there can be; no kernel.
        assert_eq!(pc_kernel_rhs_many(0.0, ptr::null(), 0, ptr::null_mut(), context), 0);
        assert_eq!(pc_kernel_rhs_many(0.0, ptr::null(), 1, rates.as_mut_ptr(), context), -1);
        assert_eq!(pc_kernel_rhs_many(0.0, rates.as_ptr(), 3, rates.as_mut_ptr(), context), -1);
        assert_eq!(pc_kernel_rhs_many(0.0, states.as_ptr(), usize::MAX, rates.as_mut_ptr(), context), -1);
        assert_eq!(pc_kernel_rhs_many(0.0, states.as_ptr(), 3, rates.as_mut_ptr(), ptr::null_mut()), -1);
        pc_kernel_free(kernel);
    }
}

#[test]
fn the_version_of_the_interface_is_known_at_run_time() {
    assert_eq!(pc_abi_version(), PC_ABI_VERSION);
}
