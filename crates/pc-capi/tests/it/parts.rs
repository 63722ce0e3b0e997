//! Look-up by name, derivatives by parameters, the right-hand side of M η̇ = r, kernels over many states.

use std::ffi::c_char;
use std::ptr;

use crate::common::{self, Model, Refusal, System, c, call};
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
    // One rounding each.
    assert!((right[0] + k * y[0]).abs() < 1e-15 && (right[1] - (t * c).cos()).abs() < 1e-15, "{right:?}");
    let refusal = plain.at(pc_system_parameter_jacobian, t, &y, 8).unwrap_err();
    assert_eq!(refusal.status, PC_UNSUPPORTED);
    assert!(refusal.message.ends_with("pc_model_differentiate was not called"), "{}", refusal.message);

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
    // In momenta, r is that of the corresponding velocities.
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

/// M = ((2, ½), (½, 1)) and a force that depends on time: ∂f/∂t = M⁻¹ (0, −c sin(c t)), in momenta
/// without M⁻¹.
#[test]
fn derivatives_by_time_and_the_inverse_of_the_mass_matrix() {
    let (t, y, c) = (0.7, [0.9, 0.1, -0.3, 0.4], 0.5_f64);
    let solved = |r: [f64; 2]| [(r[0] - r[1] / 2.0) / 1.75, (2.0 * r[1] - r[0] / 2.0) / 1.75];
    let near = |found: &[f64], expected: &[f64]| {
        // A few roundings of numbers about 1.
        let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15);
        assert!(near && found.len() == expected.len(), "{found:?} {expected:?}");
    };
    let change = [0.0, -c * (t * c).sin()];
    let model = Model::text(DRIVEN).unwrap();
    let system = model.system(pc_form::PC_POINCARE).unwrap();
    let [x, y_] = solved(change);
    near(&system.at(pc_system_time_derivative, t, &y, 4).unwrap(), &[0.0, 0.0, x, y_]);
    let canonical = model.system(pc_form::PC_CANONICAL).unwrap();
    near(&canonical.at(pc_system_time_derivative, t, &y, 4).unwrap(), &[0.0, 0.0, change[0], change[1]]);
    for (system, v) in [(&system, [1.0, -2.0]), (&canonical, [0.0, 3.0])] {
        let mut w = [0.0; 2];
        // SAFETY: a live system, numbers and room as said.
        call(|e| unsafe {
            pc_system_solve_mass_matrix(system.0, t, y.as_ptr(), 4, v.as_ptr(), 2, w.as_mut_ptr(), 2, e)
        })
        .unwrap();
        near(&w, &solved(v));
    }
    let (mut both, wrong) = ([1.0, 2.0], system.at(pc_system_time_derivative, t, &y, 3).unwrap_err());
    assert_eq!(wrong.status, PC_INVALID_ARGUMENT);
    // SAFETY: a live system; the arrays are one, which is refused.
    let shared = call(|e| unsafe {
        let w = both.as_mut_ptr();
        pc_system_solve_mass_matrix(system.0, t, y.as_ptr(), 4, w, 2, w, 2, e)
    });
    assert_eq!(shared.unwrap_err().message, "v and w share memory, but must be separate");
    // Without explicit time nothing is derived.
    let top = System::of("euler-top");
    let (t, y) = top.start();
    assert_eq!(top.at(pc_system_time_derivative, t, &y, y.len()), Ok(vec![0.0; y.len()]));
    let forced = Model::text(DRIVEN).unwrap();
    let on = common::c("x");
    // SAFETY: a live model and text.
    call(|error| unsafe { pc_model_add_external_force(forced.0, on.as_ptr(), error) }).unwrap();
    let forced = forced.system(pc_form::PC_POINCARE).unwrap();
    assert_eq!(forced.at(pc_system_time_derivative, 0.7, &[0.0; 4], 4).unwrap_err().status, PC_UNSUPPORTED);
}

/// Models that depend on time, in both forms and with multipliers, compared with difference
/// quotients: the error is h² = 1e-8 times the third derivative, and rounding 1e-16 over h.
#[test]
fn derivatives_by_time_are_limits_of_quotients() {
    const HELD: &str = "[coordinates]\nx = 1.0\ny = 0.0\n[quasi_velocities]\n\"x'\" = 0.0\n\"y'\" = 0.3\n\
                        [constraints]\nrod = \"x^2 + y^2 - (1 + sin(t)/4)^2\"\n\
                        [lagrangian]\nkinetic = \"(1 + t^2/2)*(x'^2 + y'^2)/2\"\npotential = \"y*cos(t)\"\n\
                        [simulation]\nt_start = 0.0\n";
    let held = || Model::text(&HELD.replace("\"x'\" = 0.0", "\"x'\" = 0.25")).unwrap();
    let mut compared = 0;
    for (name, model) in [("voronets-rheonomic", None), ("turning-hoop", None), ("held", Some(held()))] {
        let model = model.unwrap_or_else(|| Model::named(name));
        for form in [pc_form::PC_POINCARE, pc_form::PC_CANONICAL] {
            let Ok(system) = model.system(form) else { continue };
            let (t, y) = system.start();
            let (n, h) = (y.len(), 1e-4);
            let found = system.at(pc_system_time_derivative, t, &y, n).unwrap();
            let [after, before] = [t + h, t - h].map(|t| system.at(pc_system_rhs, t, &y, n).unwrap());
            let quotients = after.iter().zip(&before).map(|(a, b)| (a - b) / (2.0 * h));
            let size = after.iter().fold(1.0f64, |size, rate| size.max(rate.abs()));
            for (found, quotient) in found.iter().zip(quotients) {
                assert!((found - quotient).abs() < 1e-6 * size, "{name}: {found} {quotient}");
            }
            compared += usize::from(found.iter().any(|&value| value != 0.0));
        }
    }
    assert!(compared >= 4, "{compared}");
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
        // No states; no arrays; one array for both; more states than memory can hold; no kernel.
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
