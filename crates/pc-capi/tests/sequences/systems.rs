//! Calls of systems and of their kernels.

use std::ffi::{CStr, c_char, c_int};
use std::ptr;

use pc::*;

use crate::callbacks::{Own, destroy, force, force_jacobian};
use crate::calls::SystemCall;
use crate::common::{At, c};
use crate::handles::{Array, Handles, Outcome, free_text};

/// A body of a model that calls build.
const BODY: &CStr = c"b";

impl Handles {
    fn made_system(
        &mut self,
        make: impl FnOnce(*mut *mut pc_system, *mut *mut pc_error) -> pc_status,
    ) -> Outcome {
        let mut made = ptr::dangling_mut();
        let outcome = self.call(|error| make(&raw mut made, error));
        assert_eq!(made.is_null(), outcome.is_err());
        if !made.is_null() {
            // SAFETY: ours, and forgotten.
            unsafe { pc_system_free(std::mem::replace(&mut self.system, made)) };
        }
        outcome
    }

    pub(crate) fn of_system(&mut self, call: &SystemCall) -> Outcome {
        let (model, system) = (self.model, self.system);
        // SAFETY: the handles are null or live, arrays as long as said, texts are.
        unsafe {
            match call {
                SystemCall::New(form) => {
                    let mut cancel = ptr::null_mut();
                    self.call(|error| pc_cancel_new(&raw mut cancel, error))?;
                    let form = c_int::from(*form);
                    let options = pc_system_options { form, cancel, ..Default::default() };
                    let outcome = self
                        .made_system(|place, error| pc_system_new(model, &raw const options, place, error));
                    pc_cancel_free(cancel);
                    outcome
                }
                SystemCall::Clone => self.made_system(|place, error| pc_system_clone(system, place, error)),
                SystemCall::Free => {
                    pc_system_free(std::mem::replace(&mut self.system, ptr::null_mut()));
                    Ok(())
                }
                SystemCall::At { function, room, t, y } => self.at(*function, *room, *t, y),
                SystemCall::With { function, room, t, y, index } => {
                    self.with(*function, *room, *t, y, usize::from(index % 8))
                }
                SystemCall::Parameters { function, index, value } => {
                    let mut values = Array::of(*index, pc_system_parameter_count(system.as_ref()));
                    let (data, len) = (values.data(), values.len());
                    self.call(|error| match function % 3 {
                        0 => pc_system_set_parameter(system, usize::from(index % 8), *value, error),
                        1 => pc_system_parameters(system, data, len, error),
                        _ => pc_system_set_parameters(system, data, len, error),
                    })
                }
                SystemCall::Bracket([f, g], y) => {
                    let (f, g, mut y, mut value) =
                        (c(f), c(g), Array::state(3, pc_system_dim(system.as_ref()), y), 0.0);
                    let (data, len, place) = (y.data(), y.len(), &raw mut value);
                    let (f, g) = (f.as_ptr(), g.as_ptr());
                    self.call(|error| pc_system_bracket(system, f, g, 0.5, data, len, place, error))
                }
                SystemCall::Print(format) => {
                    let mut text = ptr::null_mut();
                    let outcome = self
                        .call(|error| pc_system_print(system, c_int::from(*format), &raw mut text, error));
                    free_text(text);
                    outcome
                }
                SystemCall::Theory(format, degree) => {
                    let (mut text, format) = (ptr::null_mut(), c_int::from(*format));
                    let place = &raw mut text;
                    let outcome = self.call(|error| match degree {
                        0 | 1 => {
                            let degree = usize::from(*degree);
                            pc_system_theory(system, format, degree, ptr::null(), 0, place, error)
                        }
                        _ => {
                            let (names, functions) = ([c("Q"), c("P")], [c("2*x"), c("x'")]);
                            let names = names.each_ref().map(|name| name.as_ptr());
                            let functions = functions.each_ref().map(|function| function.as_ptr());
                            let (names, functions) = (names.as_ptr(), functions.as_ptr());
                            pc_system_canonical_variables(system, format, names, functions, 2, place, error)
                        }
                    });
                    free_text(text);
                    outcome
                }
                SystemCall::Emit(name, t_end) => {
                    let name = if name.len() > 3 { c("motion") } else { c(name) };
                    let (mut header, mut source) = (ptr::null_mut(), ptr::null_mut());
                    let (place, other) = (&raw mut header, &raw mut source);
                    let outcome = self
                        .call(|error| pc_system_emit_c(system, name.as_ptr(), *t_end, place, other, error));
                    free_text(header);
                    free_text(source);
                    outcome
                }
                SystemCall::Inventory(index) => self.inventory(usize::from(*index % 16)),
                SystemCall::Force { function, good } => {
                    let user = Own::boxed(usize::from(*good) * 8, c_int::from(function % 3) - 1);
                    let forces: pc_force_function = if function % 32 == 31 { None } else { Some(force) };
                    let jacobian: pc_force_jacobian =
                        if function % 2 == 0 { None } else { Some(force_jacobian) };
                    self.call(|error| {
                        pc_system_set_force(system, forces, jacobian, user, Some(destroy), error)
                    })
                }
                SystemCall::Kernel { y, value } => self.kernel(y, *value),
                SystemCall::Code { form, change } => self.code(*form, *change),
            }
        }
    }

    /// A system of a code that is saved and loaded in between; one byte in four times is changed.
    fn code(&mut self, form: i8, change: u8) -> Outcome {
        let options = pc_system_options { form: c_int::from(form), ..Default::default() };
        let (mut code, mut loaded, mut system) = (ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
        let (mut data, mut length) = (ptr::null_mut(), 0);
        let model = self.model;
        // SAFETY: the model is null or live, codes are ours and freed once, bytes are as many as said.
        unsafe {
            let new = self.call(|error| pc_code_new(model, &raw const options, &raw mut code, error));
            assert_eq!(code.is_null(), new.is_err());
            let saved = self.call(|error| pc_code_save(code, &raw mut data, &raw mut length, error));
            assert_eq!(data.is_null(), saved.is_err());
            pc_code_free(code);
            let is_changed = change.is_multiple_of(4) && length > 0;
            if is_changed {
                *data.cast::<u8>().add(usize::from(change) * 7 % length) ^= 1;
            }
            let load = self.call(|error| pc_code_load(data, length, &raw mut loaded, error));
            assert_eq!(load.is_ok(), saved.is_ok() && !is_changed, "{load:?}");
            pc_bytes_free(data);
            let made = self.call(|error| pc_system_of_code(loaded, &raw mut system, error));
            pc_code_free(loaded);
            if made.is_ok() {
                pc_system_free(self.system);
                self.system = system;
            }
            new.and(load).and(made)
        }
    }

    /// A function of (t, y) that writes numbers.
    fn at(&self, function: u8, room: u8, t: f64, y: &[f64]) -> Outcome {
        let system = self.system;
        // SAFETY: the handle is null or live, arrays are as long as said.
        unsafe {
            let dim = pc_system_dim(system.as_ref());
            let velocities =
                dim - pc_system_coordinate_count(system.as_ref()) - pc_system_state_count(system.as_ref());
            let (mut operators, mut entries) = (0, 0);
            let _ = self.call(|error| pc_system_operator_count(system, &raw mut operators, error));
            let _ = self.call(|error| {
                pc_system_jacobian_pattern(system, &raw mut entries, ptr::null_mut(), ptr::null_mut(), error)
            });
            let observables = pc_system_observable_count(system.as_ref());
            let functions: [(At, usize); 22] = [
                (pc_system_time_derivative, dim),
                (pc_system_parameter_jacobian, dim * pc_system_parameter_count(system.as_ref())),
                (pc_system_right_hand_side, velocities),
                (pc_system_events, pc_system_event_count(system.as_ref())),
                (pc_system_rhs, dim),
                (pc_system_jacobian, dim * dim),
                (pc_system_sparse_jacobian, entries),
                (pc_system_observe, pc_system_observable_count(system.as_ref())),
                (pc_system_integrals, pc_system_conserved_count(system.as_ref())),
                (pc_system_reactions, pc_system_reaction_count(system.as_ref())),
                (pc_system_constraint_residuals, pc_system_constraint_count(system.as_ref())),
                (pc_system_mass_matrix, velocities * velocities),
                (pc_system_structure_coefficients, (operators + 1) * (operators + 1) * operators),
                (pc_system_coriolis, velocities * velocities),
                (pc_system_centroidal, 6 * (velocities + 2)),
                (pc_system_centre_of_mass, 3),
                (pc_system_centre_of_mass_jacobian, 3 * (velocities + 2)),
                (pc_system_to_momenta, dim),
                (pc_system_gravity, velocities),
                (pc_system_observable_jacobian, observables * dim),
                (
                    pc_system_observable_parameter_jacobian,
                    observables * pc_system_parameter_count(system.as_ref()),
                ),
                (pc_system_to_quasi_velocities, dim),
            ];
            let (function, length) = functions[usize::from(function) % functions.len()];
            let (mut y, mut values) = (Array::state(room, dim, y), Array::of(room, length));
            let (y, y_length, out) = (y.data(), y.len(), values.data());
            self.call(|error| function(system, t, y, y_length, out, values.len(), error))
        }
    }

    /// A function of (t, y) and further arguments.
    fn with(&self, function: u8, room: u8, t: f64, y: &[f64], index: usize) -> Outcome {
        let system = self.system;
        // SAFETY: the handle is null or live, arrays are as long as said.
        unsafe {
            let dim = pc_system_dim(system.as_ref());
            let [mut y, mut v, mut result] =
                [Array::state(room, dim, y), Array::state(room / 2, dim, y), Array::of(room, dim)];
            let (y, y_length, v, v_length) = (y.data(), y.len(), v.data(), v.len());
            let (out, length) = (result.data(), result.len());
            let mut number = 0.0;
            let velocities =
                dim - pc_system_coordinate_count(system.as_ref()) - pc_system_state_count(system.as_ref());
            let [of_v, of_w] = [v_length, length].map(|length| length.min(velocities));
            let [mut columns, mut point] = [Array::of(room, 6 * (velocities + 2)), Array::of(room / 2, 3)];
            let [mut pose, mut bias] = [Array::of(room, 12), Array::of(room, 6)];
            let forces = pc_system_force_count(system.as_ref());
            let [mut square, mut b] = [Array::of(room, dim * dim), Array::of(room, dim * (forces + 1))];
            self.call(|error| match function % 20 {
                0 => pc_system_project(system, t, y, y_length, error),
                1 => pc_system_keep_from(system, t, y, y_length, error),
                2 => pc_system_event_reset(system, index, t, y, y_length, error),
                3 => pc_system_energy(system, t, y, y_length, &raw mut number, error),
                4 => pc_system_jvp(system, t, y, y_length, v, v_length, out, length, error),
                // The product overlaps its input, which is refused.
                5 => pc_system_jvp(system, t, y, y_length, v, v_length, v, v_length, error),
                6 => pc_system_verify(system, 1 + index, ptr::null_mut(), error),
                10 => pc_system_verify_at(system, t, y, y_length, ptr::null_mut(), error),
                7 => pc_system_start_by_parameter(system, index, out, length, error),
                8 => pc_system_absolute_tolerances(system, t, t + 1.0, out, length, error),
                11 => pc_system_inverse_dynamics(system, t, y, y_length, v, of_v, out, of_w, error),
                12 => {
                    let (body, wide, columns) = (BODY.as_ptr(), columns.len(), columns.data());
                    let (point, count) = (point.data(), point.len());
                    pc_system_body_jacobian(system, t, y, y_length, body, point, count, columns, wide, error)
                }
                13 => pc_system_body_pose(
                    system,
                    t,
                    y,
                    y_length,
                    BODY.as_ptr(),
                    point.data(),
                    point.len(),
                    pose.data(),
                    pose.len(),
                    error,
                ),
                14 => pc_system_body_bias(
                    system,
                    t,
                    y,
                    y_length,
                    BODY.as_ptr(),
                    point.data(),
                    point.len(),
                    bias.data(),
                    bias.len(),
                    error,
                ),
                15 => pc_system_linearize(
                    system,
                    t,
                    y,
                    y_length,
                    ptr::null(),
                    0,
                    &raw const index,
                    1,
                    square.data(),
                    square.len(),
                    b.data(),
                    b.len(),
                    ptr::null_mut(),
                    0,
                    ptr::null_mut(),
                    0,
                    error,
                ),
                16 => {
                    let few = pc_solver_options { max_steps: 200, ..Default::default() };
                    let exponents = if length > dim { length } else { length.min(2) };
                    pc_system_lyapunov(
                        system,
                        &raw const few,
                        t,
                        y,
                        y_length,
                        0.05,
                        1 + room as u32 % 3,
                        0,
                        out,
                        exponents,
                        error,
                    )
                }
                17 => {
                    let few = pc_solver_options { max_steps: 200, ..Default::default() };
                    let end = if index.is_multiple_of(2) { 0 } else { usize::MAX };
                    pc_system_gradient(
                        system,
                        &raw const few,
                        t,
                        y,
                        y_length,
                        t + 0.1,
                        end,
                        index,
                        &raw mut number,
                        out,
                        length,
                        ptr::null_mut(),
                        0,
                        error,
                    )
                }
                18 => {
                    let mut found = ptr::null_mut();
                    let about = c_int::from(room % 4) - i32::from(room == 0);
                    let status = pc_system_linearization(
                        system,
                        about,
                        t,
                        y,
                        y_length,
                        &raw const index,
                        usize::from(room % 8 == 5),
                        ptr::null(),
                        0,
                        &raw const index,
                        usize::from(room % 8 == 6),
                        &raw mut found,
                        error,
                    );
                    assert_eq!(found.is_null(), !matches!(status, pc_status::PC_OK));
                    let known = found.as_ref();
                    for part in -1..4 {
                        let count = pc_linearization_count(known, part);
                        assert!(pc_linearization_name(known, part, count).is_null());
                        assert!(count == 0 || !pc_linearization_name(known, part, count - 1).is_null());
                    }
                    assert!((0..2).contains(&pc_linearization_is_steady(known)));
                    let none = ptr::null_mut();
                    let states = [
                        pc_linearization_state(found, out, length, none),
                        pc_linearization_matrix(found, index as c_int, out, length, none),
                    ];
                    assert!(
                        !found.is_null() || states.iter().all(|status| !matches!(status, pc_status::PC_OK))
                    );
                    pc_linearization_free(found);
                    status
                }
                9 => pc_system_solve_mass_matrix(system, t, y, y_length, v, of_v, out, of_w, error),
                _ => pc_system_residual(system, t, y, y_length, v, v_length, out, length, error),
            })
        }
    }

    /// There are names up to the last index, and none beyond.
    fn inventory(&self, index: usize) -> Outcome {
        type Count = extern "C" fn(Option<&pc_system>) -> usize;
        type Name = extern "C" fn(Option<&pc_system>, usize) -> *const c_char;
        type Find = unsafe extern "C" fn(
            *const pc_system,
            *const c_char,
            *mut usize,
            *mut *mut pc_error,
        ) -> pc_status;
        let system = self.system;
        let lists: [(Count, Name); 7] = [
            (pc_system_dim, pc_system_name),
            (pc_system_parameter_count, pc_system_parameter_name),
            (pc_system_observable_count, pc_system_observable_name),
            (pc_system_constraint_count, pc_system_constraint_name),
            (pc_system_reaction_count, pc_system_reaction_name),
            (pc_system_force_count, pc_system_force_name),
            (pc_system_event_count, pc_system_event_name),
        ];
        // SAFETY: the handle is null or live, the array as long as said.
        unsafe {
            for (count, name) in lists {
                assert_eq!(name(system.as_ref(), index).is_null(), index >= count(system.as_ref()));
            }
            let finds = [
                (pc_system_find as Find, pc_system_name as Name),
                (pc_system_find_parameter, pc_system_parameter_name),
                (pc_system_find_observable, pc_system_observable_name),
            ];
            for (find, name) in finds {
                let (known, mut place) = (name(system.as_ref(), index), usize::MAX);
                let found = self.call(|error| find(system, known, &raw mut place, error));
                assert_eq!(found.is_ok(), !known.is_null());
                assert!(known.is_null() || place <= index); // the first one of the name
            }
            assert!(
                pc_system_conserved_count(system.as_ref()) <= pc_system_observable_count(system.as_ref())
            );
            assert!((-1..2).contains(&pc_system_event_direction(system.as_ref(), index)));
            assert!((0..2).contains(&pc_system_event_is_terminal(system.as_ref(), index)));
            assert!((0..2).contains(&pc_system_event_resets(system.as_ref(), index)));
            let (mut t, mut y) =
                (0.0, vec![0.0; if index == 15 { 3 } else { pc_system_dim(system.as_ref()) }]);
            let (data, len) = (y.as_mut_ptr(), y.len());
            self.call(|error| pc_system_start(system, &raw mut t, data, len, error))
        }
    }

    fn kernel(&self, y: &[f64], value: f64) -> Outcome {
        let (system, mut kernel) = (self.system, ptr::null_mut());
        // SAFETY: the handles are null or live, arrays are as long as said.
        unsafe {
            let outcome = self.call(|error| pc_kernel_new(system, &raw mut kernel, error));
            assert_eq!(kernel.is_null(), outcome.is_err());
            let dim = pc_kernel_dim(kernel.as_ref());
            let (mut y, mut room) = (Array::state(3, dim, y), vec![0.0; dim * dim]);
            let answers = [
                pc_kernel_rhs(0.0, y.data(), room.as_mut_ptr(), kernel.cast()),
                pc_kernel_jacobian(0.0, y.data(), room.as_mut_ptr(), kernel.cast()),
                pc_kernel_rhs_many(0.0, y.data(), 1, room.as_mut_ptr(), kernel.cast()),
                // The rates overlap the state, which is refused.
                pc_kernel_rhs(0.0, y.data(), y.data(), kernel.cast()),
            ];
            assert!(answers.iter().all(|answer| (-1..2).contains(answer)));
            assert!(answers[3] == -1 && (outcome.is_ok() || answers == [-1; 4]));
            let values = vec![value; pc_system_parameter_count(system.as_ref())];
            let (data, len) = (values.as_ptr(), values.len());
            let set = self.call(|error| pc_kernel_set_parameters(kernel, data, len, error));
            pc_kernel_free(kernel);
            outcome.and(set)
        }
    }
}
