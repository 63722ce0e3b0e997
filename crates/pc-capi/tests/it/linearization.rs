//! Linear equations in independent components, equilibria and steady motions, against closed forms.

use std::ffi::{CStr, c_int};
use std::ptr;

use crate::common::{Model, Refusal, System, call};
use crate::laws::{declare, text_of};
use pc::pc_about::{PC_ABOUT_REST, PC_ABOUT_STATE, PC_ABOUT_STEADY};
use pc::pc_form::{PC_CANONICAL, PC_POINCARE};
use pc::pc_linear_matrix::*;
use pc::pc_linear_part::*;
use pc::*;

/// A linearization, freed in the end.
struct Linear(*mut pc_linearization);

impl Drop for Linear {
    fn drop(&mut self) {
        // SAFETY: ours, freed once.
        unsafe { pc_linearization_free(self.0) };
    }
}

impl Linear {
    fn names(&self, part: pc_linear_part) -> Vec<String> {
        let part = part as c_int;
        // SAFETY: a live handle; names live as long.
        unsafe {
            let of = self.0.as_ref();
            let count = pc_linearization_count(of, part);
            assert!(pc_linearization_name(of, part, count).is_null());
            let name = |i| CStr::from_ptr(pc_linearization_name(of, part, i)).to_str().unwrap().to_owned();
            (0..count).map(name).collect()
        }
    }

    fn matrix(&self, which: pc_linear_matrix, length: usize) -> Vec<f64> {
        let mut values = vec![0.0; length];
        // SAFETY: a live handle and room as said.
        call(|error| unsafe {
            pc_linearization_matrix(self.0, which as c_int, values.as_mut_ptr(), length, error)
        })
        .unwrap();
        values
    }

    fn state(&self, dim: usize) -> Vec<f64> {
        let mut y = vec![0.0; dim];
        // SAFETY: a live handle and room as said.
        call(|error| unsafe { pc_linearization_state(self.0, y.as_mut_ptr(), dim, error) }).unwrap();
        y
    }

    fn is_steady(&self) -> bool {
        // SAFETY: a live handle.
        unsafe { pc_linearization_is_steady(self.0.as_ref()) == 1 }
    }
}

/// What is given besides the state.
#[derive(Clone, Copy, Default)]
struct Given<'a> {
    held: &'a [usize],
    forces: Option<&'a [f64]>,
    inputs: &'a [usize],
}

fn about(system: &System, about: pc_about, y: &[f64], given: Given<'_>) -> Result<Linear, Refusal> {
    let mut found = ptr::null_mut();
    let Given { held, forces, inputs } = given;
    let (forces, count) = forces.map_or((ptr::null(), 0), |forces| (forces.as_ptr(), forces.len()));
    // SAFETY: a live system, arrays as long as said, a place for the handle.
    let outcome = call(|error| unsafe {
        pc_system_linearization(
            system.0,
            about as c_int,
            0.0,
            y.as_ptr(),
            y.len(),
            held.as_ptr(),
            held.len(),
            forces,
            count,
            inputs.as_ptr(),
            inputs.len(),
            &raw mut found,
            error,
        )
    });
    assert_eq!(found.is_null(), outcome.is_err());
    outcome.map(|()| Linear(found))
}

fn close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{found} is not {expected}");
    }
}

/// θ̈ = −(g/l) sin θ + u/(m l²) + Q/(m l²): it hangs where g l m sin θ = u + Q.
#[test]
fn a_pendulum_rests_where_its_torques_balance() {
    let text = "[parameters]\ng = 10\nl = 2\nm = 0.5\n[inputs]\nu = 3\n[coordinates]\na = 0.2\n\
        [lagrangian]\nkinetic = \"m*l^2*a'^2/2\"\npotential = \"-m*g*l*cos(a)\"\n[forces]\na = \"u - a'\"\n\
        [outputs]\nheight = \"-l*cos(a)\"\npush = \"2*d(a')\"\n";
    let model = Model::text(text).unwrap();
    declare(&model, &["a"]);
    let system = model.system(PC_POINCARE).unwrap();
    let forces = [2.0];
    let given = || Given { forces: Some(&forces), inputs: &[3], ..Given::default() };
    let rest = about(&system, PC_ABOUT_REST, &[0.3, 0.7], given()).unwrap();
    let angle = 0.5f64.asin();
    close(&rest.state(2), &[angle, 0.0]);
    assert!(rest.is_steady());
    assert_eq!(rest.names(PC_LINEAR_COMPONENTS), ["a", "a'"]);
    assert_eq!(rest.names(PC_LINEAR_INPUTS), ["a'", "u"]);
    assert_eq!(rest.names(PC_LINEAR_OUTPUTS), ["height", "push"]);
    let stiffness = 5.0 * angle.cos();
    close(&rest.matrix(PC_LINEAR_A, 4), &[0.0, -stiffness, 1.0, -0.5]);
    close(&rest.matrix(PC_LINEAR_B, 4), &[0.0, 0.5, 0.0, 0.5]);
    close(&rest.matrix(PC_LINEAR_C, 4), &[1.0, -2.0 * stiffness, 0.0, -1.0]);
    close(&rest.matrix(PC_LINEAR_D, 4), &[0.0, 1.0, 0.0, 1.0]);
    let all = rest.matrix(PC_LINEAR_EIGENVALUES, 4);
    close(&all[..2], &[-0.25; 2]);
    close(&[all[2].abs(), all[2] + all[3]], &[(stiffness - 0.0625).sqrt(), 0.0]);
    // Parameters are the current ones, and a state as it is need not be steady.
    system.set_parameters(&[10.0, 2.0, 0.5, 0.0]).unwrap();
    let there = about(&system, PC_ABOUT_STATE, &[0.3, 0.7], given()).unwrap();
    assert!(!there.is_steady());
    close(&there.state(2), &[0.3, 0.7]);
    close(&there.matrix(PC_LINEAR_A, 4), &[0.0, -5.0 * 0.3f64.cos(), 1.0, -0.5]);
    // The numbers of the direct route are the same.
    let (mut a, y) = ([0.0; 4], [0.3, 0.7]);
    // SAFETY: a live system and arrays as said.
    call(|error| unsafe {
        let (none, nothing) = (ptr::null_mut(), ptr::null());
        let (y, forces, to) = (y.as_ptr(), forces.as_ptr(), a.as_mut_ptr());
        pc_system_linearize(
            system.0, 0.0, y, 2, forces, 1, nothing, 0, to, 4, none, 0, none, 0, none, 0, error,
        )
    })
    .unwrap();
    close(&there.matrix(PC_LINEAR_A, 4), &a);
}

/// The spherical pendulum on its rod: of six components four are independent, and it hangs with ω² = g/l.
#[test]
fn constraints_leave_independent_components() {
    let system = System::of("rod");
    let rest = about(&system, PC_ABOUT_REST, &[0.6, 0.0, -0.8, 0.0, 1.5, 0.0], Given::default()).unwrap();
    close(&rest.state(6), &[0.0, 0.0, -1.0, 0.0, 0.0, 0.0]);
    assert_eq!(rest.names(PC_LINEAR_COMPONENTS).len(), 4);
    let all = rest.matrix(PC_LINEAR_EIGENVALUES, 8);
    close(&all[..4], &[0.0; 4]);
    all[4..].iter().for_each(|frequency| close(&[frequency.abs()], &[10f64.sqrt()]));
}

/// A conical pendulum: its circle is held by the angle, and its turn is constant.
#[test]
fn a_steady_motion_is_one_of_a_family() {
    let text = "[coordinates]\na = 0.5\nb = 0\n[quasi_velocities]\n\"b'\" = 3\n[lagrangian]\n\
        kinetic = \"(a'^2 + sin(a)^2*b'^2)/2\"\npotential = \"-10*cos(a)\"\n";
    let system = Model::text(text).unwrap().system(PC_POINCARE).unwrap();
    let given = Given { held: &[0], ..Given::default() };
    let circle = about(&system, PC_ABOUT_STEADY, &[0.5, 0.0, 0.1, 3.0], given).unwrap();
    let turn = (10.0 / 0.5f64.cos()).sqrt();
    close(&circle.state(4), &[0.5, 0.0, 0.0, turn]);
    assert_eq!(circle.names(PC_LINEAR_COMPONENTS), ["a", "a'", "b'"]);
}

/// The disk in independent velocities: all of its state is found.
#[test]
fn states_are_those_of_the_system() {
    for name in ["tilted-disk", "vertical-disk", "chaplygin-sleigh"] {
        let system = Model::text(&text_of(name)).unwrap().system(PC_POINCARE).unwrap();
        let (_, y) = system.start();
        let there = about(&system, PC_ABOUT_STATE, &y, Given::default()).unwrap();
        close(&there.state(system.dim()), &y);
    }
}

#[test]
fn what_cannot_be_linearized_is_refused() {
    let system = System::of("rod");
    let (_, y) = system.start();
    let of = |given: Given<'_>| about(&system, PC_ABOUT_REST, &y, given).map(drop).unwrap_err();
    assert_eq!(of(Given { held: &[6], ..Given::default() }).message, "held: index 6 is not below 6");
    assert_eq!(of(Given { inputs: &[0], ..Given::default() }).message, "inputs: index 0 is not below 0");
    assert_eq!(
        of(Given { forces: Some(&[1.0]), ..Given::default() }).message,
        "forces: 1 numbers instead of 0"
    );
    let momenta = Model::named("heavy-top-lagrange").system(PC_CANONICAL).unwrap();
    let refused =
        about(&momenta, PC_ABOUT_STATE, &momenta.start().1, Given::default()).map(drop).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_UNSUPPORTED, "{}", refused.message);
    let timed =
        Model::text("[coordinates]\nx = 1\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x*sin(t)\"\n");
    let timed = timed.unwrap().system(PC_POINCARE).unwrap();
    let refused = about(&timed, PC_ABOUT_REST, &[1.0, 0.0], Given::default()).map(drop).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_UNSUPPORTED, "{}", refused.message);
    let falling =
        Model::text("[coordinates]\nx = 1\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x + x^3\"\n");
    let falling = falling.unwrap().system(PC_POINCARE).unwrap();
    let refused = about(&falling, PC_ABOUT_REST, &[1.0, 0.0], Given::default()).map(drop).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_EVALUATION, "{}", refused.message);
    let found = about(&system, PC_ABOUT_STATE, &y, Given::default()).unwrap();
    let mut out = [0.0; 4];
    let mut wrong = |which: c_int| {
        // SAFETY: a live handle and room as said.
        call(|error| unsafe { pc_linearization_matrix(found.0, which, out.as_mut_ptr(), 4, error) })
            .unwrap_err()
            .message
    };
    assert_eq!(wrong(0), "values: 4 numbers instead of 16");
    assert_eq!(wrong(9), "9 is not a value of pc_linear_matrix");
    let mut none = ptr::null_mut();
    // SAFETY: a live system; 7 is no choice.
    let refused = call(|error| unsafe {
        let (y, nothing) = (y.as_ptr(), ptr::null());
        pc_system_linearization(
            system.0,
            7,
            0.0,
            y,
            6,
            nothing,
            0,
            ptr::null(),
            0,
            nothing,
            0,
            &raw mut none,
            error,
        )
    });
    assert_eq!(refused.unwrap_err().message, "7 is not a value of pc_about");
}
