//! Calls of models.

use std::ffi::{CStr, CString, c_char, c_int};
use std::ptr;

use pc::*;

use crate::calls::ModelCall;
use crate::common::c;
use crate::handles::{Handles, Outcome, free_text};

/// Models that compile quickly: with and without events, constraints of each kind, resets, and L
/// that is not quadratic.
const SHORT: [&CStr; 12] = [
    c"bouncing-ball",
    c"chaplygin-sleigh",
    c"charged-particle",
    c"damped-oscillator",
    c"double-pendulum-cartesian",
    c"euler-top",
    c"nonholonomic-particle",
    c"relativistic-particle",
    c"rotating-oscillator",
    c"stick-slip-block",
    c"suslov",
    c"vertical-disk",
];

impl Handles {
    /// The outcome of a call that makes a model, which replaces the former one.
    fn made(&mut self, make: impl FnOnce(*mut *mut pc_model, *mut *mut pc_error) -> pc_status) -> Outcome {
        let mut made = ptr::dangling_mut();
        let outcome = self.call(|error| make(&raw mut made, error));
        assert_eq!(made.is_null(), outcome.is_err());
        if !made.is_null() {
            // SAFETY: ours, and forgotten.
            unsafe { pc_model_free(std::mem::replace(&mut self.model, made)) };
        }
        outcome
    }

    pub(crate) fn of_model(&mut self, call: &ModelCall) -> Outcome {
        let model = self.model;
        // SAFETY: the handle is null or live, all texts are, and places for results.
        unsafe {
            match call {
                ModelCall::New(name) => {
                    let name = c(name);
                    self.made(|place, error| pc_model_new(name.as_ptr(), place, error))
                }
                ModelCall::Parse(text) => {
                    let (data, len) = (text.as_ptr().cast(), text.len());
                    self.made(|place, error| pc_model_parse(data, len, ptr::null(), place, error))
                }
                ModelCall::Builtin(index) => {
                    let name = SHORT[usize::from(*index) % SHORT.len()].as_ptr();
                    self.made(|place, error| pc_model_builtin(name, place, error))
                }
                ModelCall::File(path) => {
                    let path = CString::new(path.as_slice()).unwrap();
                    self.made(|place, error| match path.count_bytes() % 2 {
                        0 => pc_model_from_file(path.as_ptr(), place, error),
                        _ => pc_model_from_robot(path.as_ptr(), 0, 1, place, error),
                    })
                }
                ModelCall::Clone => self.made(|place, error| pc_model_clone(model, place, error)),
                ModelCall::Say(function, [a, b, z], x) => {
                    let (a, b, z) = (c(a), c(b), c(z));
                    let texts = [a.as_ptr(), b.as_ptr(), z.as_ptr()];
                    self.call(|error| say(model, *function, texts, *x, error))
                }
                ModelCall::Bytes(function, text) => {
                    let text = CString::new(text.as_slice()).unwrap();
                    let (text, name) = (text.as_ptr(), c"x".as_ptr());
                    self.call(|error| match function % 10 {
                        0 => pc_model_add_definition(model, text, name, error),
                        1 => pc_model_set_potential(model, text, error),
                        2 => pc_model_add_event(model, name, text, 0, 0, error),
                        3 => pc_model_set_kinetic(model, text, error),
                        4 => pc_model_set(model, text, 1.0, error),
                        5 => pc_model_set_action(model, text, error),
                        6 => pc_model_add_action_constant(model, text, 1.0, error),
                        7 => pc_model_give_quasi_velocity(model, name, text, error),
                        8 => pc_model_add_independent(model, text, error),
                        _ => pc_model_keep(model, text, error),
                    })
                }
                ModelCall::Event(function, text, direction) => {
                    let (text, when, direction) = (c(text), c"x'*cos(3*t) - 1/10", c_int::from(*direction));
                    let (name, text, terminal) =
                        (c"hit".as_ptr(), text.as_ptr(), c_int::from(function % 8 == 1));
                    self.call(|error| match function % 4 {
                        0 => pc_model_add_event(model, text, text, direction, terminal, error),
                        1 => pc_model_add_event(model, name, when.as_ptr(), direction, terminal, error),
                        2 => pc_model_add_event_reset(model, name, c"x'".as_ptr(), c"-x'/2".as_ptr(), error),
                        _ => pc_model_add_event_reset(model, name, text, text, error),
                    })
                }
                ModelCall::Text => {
                    let mut text = ptr::null_mut();
                    let outcome = self.call(|error| pc_model_text(model, &raw mut text, error));
                    free_text(text);
                    outcome
                }
                ModelCall::Check => self.call(|error| pc_model_check(model, error)),
                ModelCall::Free => {
                    pc_model_free(std::mem::replace(&mut self.model, ptr::null_mut()));
                    Ok(())
                }
            }
        }
    }
}

/// One of the functions that set entries of a model. Those without which there is no model are
/// frequent.
///
/// # Safety
/// The model is null or live, the texts are.
unsafe fn say(
    model: *mut pc_model,
    function: u8,
    [a, b, z]: [*const c_char; 3],
    x: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let (yes, entries, count) = (c_int::from(x > 0.0), [a, b, z], x.clamp(0.0, 3.0) as usize);
    let entries = entries.as_ptr();
    // SAFETY: as promised.
    unsafe {
        match function % 87 {
            0..4 => pc_model_add_coordinate(model, a, x, error),
            4..8 => pc_model_set_kinetic(model, b, error),
            8 => pc_model_add_quasi_velocity(model, a, b, x, error),
            9 => pc_model_add_quasi_velocity(model, a, ptr::null(), x, error),
            10 => pc_model_set_kinematics(model, a, b, error),
            11 => pc_model_set_algebra(model, a, error),
            12 => pc_model_set_bracket(model, a, b, z, error),
            13 => pc_model_add_constraint(model, a, b, error),
            14 => pc_model_set_constraint_kind(model, a, b, error),
            15 => pc_model_set_constraint_kind(model, a, c"nonlinear".as_ptr(), error),
            16 => pc_model_set_lagrangian(model, b, error),
            17 => pc_model_set_potential(model, b, error),
            18 => pc_model_set_dissipation(model, b, error),
            19 => pc_model_add_force(model, a, b, error),
            20 | 21 => pc_model_add_external_force(model, a, error),
            22 => pc_model_add_integral(model, a, b, error),
            23 => pc_model_add_output(model, a, b, error),
            24 => pc_model_add_definition(model, a, b, error),
            25 | 26 => pc_model_add_parameter(model, a, x, error),
            27 | 28 => pc_model_add_body(model, a, c"2".as_ptr(), b, z, c"0".as_ptr(), error),
            29 => pc_model_set_body_force(model, a, b, z, b, error),
            30 => pc_model_set_body_torque(model, a, b, z, z, error),
            31 => pc_model_set_body_angular_velocity(model, a, z, b, z, error),
            32 => pc_model_set_body_inertia(model, a, entries, count, error),
            33 => pc_model_set_body_rotation(model, a, entries, count, error),
            34 => pc_model_set_description(model, z, error),
            35 => pc_model_set_reference(model, z, error),
            36 => pc_model_set_start(model, a, x, error),
            37 => pc_model_set_start_expression(model, a, b, error),
            38 => pc_model_set_start_time(model, x, error),
            39 => pc_model_set_end_time(model, x, error),
            40 => pc_model_set_samples(model, count, error),
            41 => pc_model_set_tolerances(model, x, x / 2.0, error),
            42 => pc_model_set_method(model, if yes == 1 { c"bdf".as_ptr() } else { a }, error),
            43 => pc_model_set_form(model, if yes == 1 { c"canonical".as_ptr() } else { a }, error),
            59 | 60 => pc_model_add_jointed_body(model, a, if yes == 1 { b } else { ptr::null() }, z, error),
            61 => pc_model_add_jointed_body(model, a, ptr::null(), c"revolute".as_ptr(), error),
            62 => pc_model_set_body_mass(model, a, b, error),
            63 => pc_model_set_body_center(model, a, b, z, b, error),
            64 => pc_model_set_joint_place(model, a, b, z, b, error),
            65 => pc_model_set_joint_axis(model, a, [x, 1.0, 0.0].as_ptr(), error),
            66 => pc_model_set_joint_axes(model, a, [x, 1.0, 0.0].as_ptr(), [0.0, x, 1.0].as_ptr(), error),
            67 => pc_model_set_joint_pitch(model, a, b, error),
            68 => pc_model_set_joint_rotation(model, a, entries, count, error),
            69 => pc_model_set_joint_turns(model, a, c"zx".as_ptr(), entries, count, error),
            70 => pc_model_name_joint_coordinates(model, a, entries, count, error),
            71 => pc_model_name_joint_quasi_velocities(model, a, entries, count, error),
            72 => pc_model_add_point(model, a, b, z, b, z, error),
            73 => {
                let places = [b, z, b, z, b, z];
                pc_model_add_loop(model, a, c"point".as_ptr(), b, z, places.as_ptr(), error)
            }
            74 => match yes {
                1 => pc_model_set_loop_length(model, a, b, error),
                _ => pc_model_set_loop_axes(model, a, [x, 1.0, 0.0].as_ptr(), [0.0, x, 1.0].as_ptr(), error),
            },
            75 => pc_model_set_joint_gear(model, a, a, if yes == 1 { b } else { ptr::null() }, z, error),
            76 => pc_model_set_joint_armature(model, a, b, error),
            77 => pc_model_set_joint_spring(model, a, b, if yes == 1 { z } else { ptr::null() }, error),
            78 => pc_model_set_joint_damping(model, a, b, error),
            79 => pc_model_set_joint_friction(model, a, b, error),
            80 => pc_model_set_joint_limits(model, a, b, z, b, if yes == 1 { z } else { ptr::null() }, error),
            81 => pc_model_set_joint_restitution(model, a, b, z, b, error),
            82 => pc_model_set_joint_stiction(model, a, b, error),
            83 => pc_model_add_contact(model, a, b, c"sphere".as_ptr(), c"rolls".as_ptr(), error),
            84 => {
                let entry = if yes == 1 { c"radius".as_ptr() } else { z };
                pc_model_set_contact(model, a, entry, entries, count, error)
            }
            44 => pc_model_keep(model, if yes == 1 { c"energy".as_ptr() } else { a }, error),
            45 => pc_model_project_start(model, yes, error),
            46 => pc_model_observe_reactions(model, yes, error),
            47 => pc_model_set_max_step(model, x, error),
            48 | 49 => pc_model_add_state(model, a, b, x, error),
            50 => pc_model_add_input(model, a, x, error),
            51 => {
                let (times, values) = ([0.0, 1.0, 2.0 + x], [x, -x, 0.5]);
                let word = if yes == 1 { c"hold".as_ptr() } else { ptr::null() };
                pc_model_add_input_table(model, a, times.as_ptr(), values.as_ptr(), count, word, error)
            }
            85 => {
                let (times, values) = ([0.0, 1.0, 2.0 + x], [x, -x, 0.5]);
                let second = if yes == 1 { values.as_ptr() } else { ptr::null() };
                let [times, values] = [&times, &values].map(|list| list.as_ptr());
                pc_model_add_input_curve(model, a, times, values, values, second, count, error)
            }
            86 => pc_model_add_input_curve_file(
                model,
                a,
                z,
                b,
                b,
                if yes == 1 { a } else { ptr::null() },
                b,
                error,
            ),
            52 => pc_model_add_input_file(model, a, z, b, ptr::null(), a, error),
            53 => pc_model_set_gravity(model, b, z, b, error),
            54 => pc_model_add_parameter_expression(model, a, b, error),
            55 => pc_model_set_event_search(model, count, x, error),
            56 => pc_model_hold_start(model, a, error),
            57 => pc_model_differentiate(model, yes, error),
            _ => pc_model_set(model, a, x, error),
        }
    }
}
