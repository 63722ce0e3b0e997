//! Wrong calls: each is refused with a status and a message, and nothing else happens.

use std::ffi::{CStr, c_char};
use std::ptr;

use crate::common::{self, Model, Refusal, System, c, call};
use pc::pc_status::*;
use pc::*;

fn status<T: std::fmt::Debug>(outcome: Result<T, Refusal>) -> pc_status {
    outcome.unwrap_err().status
}

#[test]
fn nulls_are_refused_everywhere() {
    let (mut model, mut system, mut kernel, mut solver) =
        (ptr::null_mut(), ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
    let (mut text, mut number, mut size) = (ptr::null_mut(), 0.0, 0);
    let (name, null) = (c("x"), ptr::null::<c_char>());
    let (no_model, no_system, no_solver): (*mut pc_model, *mut pc_system, *mut pc_solver) =
        (ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
    let (none, no_numbers): (*const f64, *mut f64) = (ptr::null(), ptr::null_mut());
    let no_texts: *const *const c_char = ptr::null();
    let name = name.as_ptr();
    let real = Model::named("euler-top");
    let of = System::of("euler-top");
    type Call<'a> = (&'a str, Box<dyn FnOnce(*mut *mut pc_error) -> pc_status + 'a>);
    macro_rules! calls {
        ($($function:ident($($argument:expr),*);)*) => {
            // SAFETY: null, or pointers to live objects; the test is that nulls do no harm.
            vec![$((stringify!($function), Box::new(|error| unsafe { $function($($argument,)* error) }))),*]
        };
    }
    let (model_place, system_place, kernel_place, solver_place) =
        (&raw mut model, &raw mut system, &raw mut kernel, &raw mut solver);
    let (text_place, number_place, size_place) = (&raw mut text, &raw mut number, &raw mut size);
    let places: Vec<Call<'_>> = calls! {
        pc_model_parse(null, 1, null, model_place);
        pc_model_parse(name, 1, null, ptr::null_mut());
        pc_model_from_file(null, model_place);
        pc_model_from_robot(null, 0, 0, model_place);
        pc_model_from_file(name, ptr::null_mut());
        pc_model_from_robot(name, 1, 1, ptr::null_mut());
        pc_model_builtin(null, model_place);
        pc_model_builtin(name, ptr::null_mut());
        pc_model_new(null, model_place);
        pc_model_new(name, ptr::null_mut());
        pc_model_clone(no_model, model_place);
        pc_model_clone(real.0, ptr::null_mut());
        pc_model_check(no_model);
        pc_model_set(no_model, name, 1.0);
        pc_model_set(real.0, null, 1.0);
        pc_model_keep(real.0, null);
        pc_model_keep(no_model, name);
        pc_model_project_start(no_model, 1);
        pc_model_hold_start(no_model, name);
        pc_model_hold_start(real.0, null);
        pc_model_observe_reactions(no_model, 1);
        pc_model_differentiate(no_model, 1);
        pc_model_text(no_model, text_place);
        pc_model_text(real.0, ptr::null_mut());
        pc_model_add_parameter(no_model, name, 1.0);
        pc_model_add_definition(no_model, name, name);
        pc_model_add_coordinate(no_model, name, 1.0);
        pc_model_add_quasi_velocity(no_model, name, null, 1.0);
        pc_model_set_kinematics(no_model, name, name);
        pc_model_set_algebra(no_model, name);
        pc_model_set_bracket(no_model, name, name, name);
        pc_model_add_constraint(no_model, name, name);
        pc_model_set_lagrangian(no_model, name);
        pc_model_set_kinetic(no_model, name);
        pc_model_set_potential(no_model, name);
        pc_model_set_dissipation(no_model, name);
        pc_model_add_force(no_model, name, name);
        pc_model_add_integral(no_model, name, name);
        pc_model_add_output(no_model, name, name);
        pc_system_new(no_model, ptr::null(), system_place);
        pc_system_new(real.0, ptr::null(), ptr::null_mut());
        pc_system_clone(no_system, system_place);
        pc_system_clone(of.0, ptr::null_mut());
        pc_system_start(no_system, number_place, number_place, 1);
        pc_system_start(of.0, number_place, no_numbers, 3);
        pc_system_parameters(of.0, no_numbers, 3);
        pc_system_set_parameters(of.0, none, 3);
        pc_system_set_parameter(no_system, 0, 1.0);
        pc_system_rhs(of.0, 0.0, none, 3, number_place, 3);
        pc_system_jacobian(no_system, 0.0, number_place, 1, number_place, 1);
        pc_system_jacobian_pattern(no_system, ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
        pc_system_project(of.0, 0.0, no_numbers, 3);
        pc_system_operator_count(of.0, ptr::null_mut());
        pc_system_operator_count(no_system, size_place);
        pc_system_print(no_system, 0, text_place);
        pc_system_print(of.0, 0, ptr::null_mut());
        pc_system_emit_c(of.0, name, 1.0, ptr::null_mut(), text_place);
        pc_system_emit_c(of.0, name, 1.0, text_place, ptr::null_mut());
        pc_system_theory(no_system, 0, 2, no_texts, 0, text_place);
        pc_system_theory(of.0, 0, 2, no_texts, 1, text_place);
        pc_system_theory(of.0, 0, 2, no_texts, 0, ptr::null_mut());
        pc_kernel_new(no_system, kernel_place);
        pc_kernel_new(of.0, ptr::null_mut());
        pc_kernel_set_parameters(ptr::null_mut(), none, 0);
        pc_solver_new(no_system, ptr::null(), 0.0, none, 0, solver_place);
        pc_solver_new(of.0, ptr::null(), 0.0, none, 0, ptr::null_mut());
        pc_solver_advance(no_solver, 1.0, number_place, 1);
        pc_solver_step(no_solver, 1.0, number_place, number_place, 1);
        pc_solver_run(no_solver, none, 0, None, ptr::null_mut());
        pc_solver_time(no_solver, number_place);
        pc_solver_state(no_solver, number_place, 1);
        pc_solver_statistics(no_solver, ptr::null_mut(), 0);
    };
    for (name, function) in places {
        let refusal = call(function).unwrap_err();
        assert_eq!(refusal.status, PC_INVALID_ARGUMENT, "{name}");
        assert!(refusal.message.ends_with("is a null pointer"), "{name}: {}", refusal.message);
    }
    assert!(model.is_null() && system.is_null() && kernel.is_null() && solver.is_null() && text.is_null());
    // SAFETY: null.
    unsafe {
        pc_model_free(ptr::null_mut());
        pc_system_free(ptr::null_mut());
        pc_kernel_free(ptr::null_mut());
        pc_solver_free(ptr::null_mut());
        pc_error_free(ptr::null_mut());
        pc_string_free(ptr::null_mut());
        pc_system_options_init(ptr::null_mut(), 16);
        pc_solver_options_init(ptr::null_mut(), 16);
        assert_eq!(pc_system_dim(None), 0);
        assert!(pc_system_name(None, 0).is_null() && pc_system_name(of.0.as_ref(), 99).is_null());
        assert!(pc_system_reaction_name(of.0.as_ref(), 0).is_null() && pc_builtin_name(usize::MAX).is_null());
        assert_eq!(CStr::from_ptr(pc_error_message(None)), c"");
        // Without a place for the error, only the status is returned.
        assert_eq!(pc_model_check(ptr::null(), ptr::null_mut()), PC_INVALID_ARGUMENT);
    }
}

#[test]
fn arrays_of_wrong_lengths_are_refused() {
    let system = System::of("heavy-top-lagrange");
    let ((t, y), dim) = (system.start(), system.dim());
    let functions: [(common::At, usize); 9] = [
        (pc_system_rhs, dim),
        (pc_system_jacobian, dim * dim),
        (pc_system_sparse_jacobian, {
            let mut entries = 0;
            // SAFETY: a live system and a place for a number.
            call(|error| unsafe {
                let null = ptr::null_mut();
                pc_system_jacobian_pattern(system.0, &raw mut entries, null, null.cast(), error)
            })
            .unwrap();
            entries
        }),
        (pc_system_observe, 4),
        (pc_system_mass_matrix, 9),
        (pc_system_structure_coefficients, 48),
        (pc_system_to_momenta, dim),
        (pc_system_to_quasi_velocities, dim),
        (pc_system_constraint_residuals, 0),
    ];
    for (function, length) in functions {
        system.at(function, t, &y, length).unwrap();
        for wrong in [length + 1, length.wrapping_sub(1).min(100)] {
            let refusal = system.at(function, t, &y, wrong).unwrap_err();
            assert_eq!(refusal.status, PC_INVALID_ARGUMENT);
            assert!(
                refusal.message.contains(&format!(": {wrong} numbers instead of ")),
                "{}",
                refusal.message
            );
        }
        assert_eq!(status(system.at(function, t, &y[1..], length)), PC_INVALID_ARGUMENT);
    }
    // A length that exceeds any memory.
    let mut ydot = vec![0.0; dim];
    let refused = call(|error| unsafe {
        // SAFETY: the lengths are refused before the arrays are looked at.
        pc_system_rhs(system.0, t, y.as_ptr(), usize::MAX, ydot.as_mut_ptr(), usize::MAX, error)
    });
    assert_eq!(status(refused), PC_INVALID_ARGUMENT);
    // SAFETY: a live system, and places for results as said.
    let refused = call(|error| unsafe {
        let shared = ydot.as_mut_ptr();
        // SAFETY: a live system; the shared array is refused.
        pc_system_rhs(system.0, t, shared, dim, shared, dim, error)
    });
    assert_eq!(refused.unwrap_err().message, "y and ydot share memory, but must be separate");
}

#[test]
fn a_wrong_text_is_shown_with_its_place() {
    let text = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"k*x^2\"\n";
    let refusal = Model::text(text).and_then(|model| model.system(pc_form::PC_POINCARE)).err().unwrap();
    assert_eq!((refusal.status, refusal.line), (PC_INVALID_MODEL, 5));
    assert!(refusal.message.starts_with("model:5:14: [lagrangian] potential: "), "{}", refusal.message);
    assert_eq!(status(Model::text("\u{0}").map(|_| ())), PC_INVALID_MODEL);
    let latin = *b"[model]\nname = \"Poincar\xe9\"\n";
    let mut model = ptr::null_mut();
    // SAFETY: as many bytes as said, and a place for the handle.
    let parse = |error| unsafe {
        pc_model_parse(latin.as_ptr().cast(), latin.len(), ptr::null(), &raw mut model, error)
    };
    assert_eq!(call(parse).unwrap_err().line, 2);
    let name = [b'\xff', 0];
    // SAFETY: zero-terminated, and a place for the handle.
    let named = |error| unsafe { pc_model_builtin(name.as_ptr().cast(), &raw mut model, error) };
    let refusal = call(named).unwrap_err();
    assert_eq!(refusal.message, "name is not UTF-8 text: byte number 0 (from 0) is invalid");
    assert!(model.is_null());
}

#[test]
fn missing_things_are_not_found() {
    let model = Model::named("euler-top");
    let (name, mut other) = (c("no-such-thing"), ptr::null_mut());
    let name = name.as_ptr();
    // SAFETY: live handles, texts, and places for handles.
    unsafe {
        assert_eq!(status(call(|error| pc_model_builtin(name, &raw mut other, error))), PC_NOT_FOUND);
        assert_eq!(status(call(|error| pc_model_from_file(name, &raw mut other, error))), PC_NOT_FOUND);
        assert_eq!(status(call(|error| pc_model_set(model.0, name, 1.0, error))), PC_NOT_FOUND);
        let refused = call(|error| pc_model_set(model.0, c"A".as_ptr(), f64::NAN, error));
        assert_eq!(refused.unwrap_err().message, "value is NaN, but must be finite");
        let directory = call(|error| pc_model_from_file(c"/".as_ptr(), &raw mut other, error));
        assert_eq!(status(directory), PC_IO);
        let refused = call(|error| pc_model_add_parameter(model.0, name, 1.0, error)).unwrap_err();
        assert!(refused.message.starts_with("pc_model_add_parameter needs a model begun with pc_model_new"));
        call(|error| pc_model_keep(model.0, name, error)).unwrap();
    }
    assert_eq!(model.system(pc_form::PC_POINCARE).err().unwrap().status, PC_NOT_FOUND);
}

#[test]
fn options_are_checked() {
    let (model, of) = (Model::named("euler-top"), System::of("euler-top"));
    let mut system = ptr::null_mut();
    let usual = pc_system_options::default();
    for (size, form, reserved, time_limit) in [
        (0, 0, 0, 0.0),
        (17 + size_of::<pc_system_options>(), 0, 0, 0.0),
        (16, 6, 0, 0.0),
        (16, -1, 0, 0.0),
        (16, 0, 1, 0.0),
        (usual.size, 0, -1, 0.0),
        (usual.size, 0, 0, -1.0),
        (usual.size, 0, 0, f64::NAN),
    ] {
        let options = pc_system_options { size, form, reserved, time_limit, ..usual };
        // SAFETY: live objects.
        let refused =
            call(|error| unsafe { pc_system_new(model.0, &raw const options, &raw mut system, error) });
        assert_eq!(status(refused), PC_INVALID_ARGUMENT, "{size} {form}");
    }
    let changes: [fn(&mut pc_solver_options); 10] = [
        |options| options.reserved = 1,
        |options| options.size = 1 << 40,
        |options| options.method = 7,
        |options| options.iteration = -7,
        |options| options.linear_solver = 77,
        |options| options.max_order = -1,
        |options| options.relative_tolerance = -1.0,
        |options| options.absolute_tolerance = f64::NAN,
        |options| options.initial_step = -1.0,
        |options| options.stop_time = f64::NAN,
    ];
    for (i, change) in changes.into_iter().enumerate() {
        let (mut options, mut solver) = (pc_solver_options::default(), ptr::null_mut());
        change(&mut options);
        // SAFETY: live objects.
        let new = |error| unsafe {
            pc_solver_new(of.0, &raw const options, 0.0, ptr::null(), 0, &raw mut solver, error)
        };
        assert_eq!(status(call(new)), PC_INVALID_ARGUMENT, "{i}");
        assert!(solver.is_null());
    }
    // The options of an earlier header, which ended after the method.
    let (options, mut solver) = (pc_solver_options { size: 16, ..Default::default() }, ptr::null_mut());
    // SAFETY: live objects; the solver is freed once.
    unsafe {
        let new =
            |error| pc_solver_new(of.0, &raw const options, 0.0, ptr::null(), 0, &raw mut solver, error);
        call(new).unwrap();
        pc_solver_free(solver);
    }
}

#[test]
fn a_state_that_cannot_be_evaluated_says_which_expression() {
    let system = System::of("heavy-top-euler");
    let (t, mut y) = system.start();
    y.fill(f64::INFINITY);
    let refusal = system.at(pc_system_rhs, t, &y, y.len()).unwrap_err();
    assert_eq!(refusal.status, PC_EVALUATION);
    assert!(refusal.message.contains("inf"), "{}", refusal.message);
}
