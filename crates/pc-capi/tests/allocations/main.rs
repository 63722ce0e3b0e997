//! Calls during a simulation allocate nothing after the first.

#![cfg(all(target_os = "linux", target_env = "gnu"))]
#![expect(clippy::unwrap_used, unsafe_code, reason = "tests")]

#[path = "../it/common/mod.rs"]
mod common;
mod counting;

use std::ffi::{CStr, c_int, c_void};
use std::ptr;

use common::{Model, System, c, call};
use counting::allocations;
use pc::*;

unsafe extern "C" fn push(
    t: f64,
    y: *const f64,
    y_length: usize,
    q: *mut f64,
    q_length: usize,
    _: *mut c_void,
) -> c_int {
    // SAFETY: as many numbers as said.
    let (y, q) =
        unsafe { (std::slice::from_raw_parts(y, y_length), std::slice::from_raw_parts_mut(q, q_length)) };
    q.iter_mut().enumerate().for_each(|(i, q)| *q = 0.1 * (t + i as f64) - 0.2 * y[y_length - 1 - i]);
    0
}

/// A model by name, the quasi-velocities with external forces, the integrals kept, and the form.
struct Case(String, &'static [&'static str], &'static [&'static str], pc_form);

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Case(name, on, kept, form) = self;
        let form = if matches!(form, pc_form::PC_CANONICAL) { "in momenta" } else { "" };
        write!(f, "{name} {form}, forces on {on:?}, keeping {kept:?}")
    }
}

/// All models of the library, and some of them with other settings.
fn cases() -> Vec<Case> {
    use pc_form::{PC_CANONICAL, PC_POINCARE};
    let all = (0..pc_builtin_count()).map(|i| {
        // SAFETY: static text, since the index is below the count.
        let name = unsafe { CStr::from_ptr(pc_builtin_name(i)) };
        Case(name.to_str().unwrap().to_owned(), &[], &[], PC_POINCARE)
    });
    let more: [(&str, &'static [&'static str], &'static [&'static str], pc_form); 11] = [
        ("heavy-top-lagrange", &["ω1", "ω3"], &[], PC_POINCARE),
        ("heavy-top-lagrange", &[], &["energy"], PC_POINCARE),
        ("heavy-top-lagrange", &[], &[], PC_CANONICAL),
        ("heavy-top-lagrange", &["ω2"], &[], PC_CANONICAL),
        ("tilted-disk", &["ω2"], &[], PC_POINCARE),
        ("rod", &[], &[], PC_POINCARE),
        ("rod", &[], &["energy"], PC_POINCARE),
        ("rod", &["y"], &[], PC_POINCARE),
        ("rod", &[], &["energy"], PC_CANONICAL),
        ("rod", &["y"], &[], PC_CANONICAL),
        ("relativistic-particle", &[], &[], PC_CANONICAL),
    ];
    all.chain(more.map(|(name, on, kept, form)| Case(name.to_owned(), on, kept, form))).collect()
}

fn system(Case(name, on, kept, form): &Case) -> System {
    let model = Model::named(name);
    for on in *on {
        let on = c(on);
        // SAFETY: a live model and text.
        call(|error| unsafe { pc_model_add_external_force(model.0, on.as_ptr(), error) }).unwrap();
    }
    for kept in *kept {
        let kept = c(kept);
        // SAFETY: a live model and text.
        call(|error| unsafe { pc_model_keep(model.0, kept.as_ptr(), error) }).unwrap();
    }
    let form =
        if matches!(form, pc_form::PC_POINCARE) { pc_form::PC_POINCARE } else { pc_form::PC_CANONICAL };
    let system = model.system(form).unwrap();
    if !on.is_empty() {
        // SAFETY: a live system and a function of that type.
        call(|error| unsafe {
            pc_system_set_force(system.0, Some(push), None, ptr::null_mut(), None, error)
        })
        .unwrap();
    }
    system
}

/// How often a call allocates after two earlier calls.
fn again(mut function: impl FnMut(*mut *mut pc_error) -> pc_status) -> usize {
    for _ in 0..2 {
        call(&mut function).unwrap();
    }
    let before = allocations();
    for _ in 0..3 {
        assert_eq!(function(ptr::null_mut()), pc_status::PC_OK);
    }
    allocations() - before
}

#[test]
fn allocations_are_counted() {
    let before = allocations();
    let held = std::hint::black_box(Box::new(1.0));
    assert_eq!(allocations(), before + 1);
    drop(held);
}

#[test]
fn evaluations_allocate_nothing() {
    let mut found = Vec::new();
    for case in cases() {
        let system = system(&case);
        let (on_nothing, has_tables) = (case.1.is_empty(), case.0 == "quarter-car");
        let (s, n) = (system.0, system.dim());
        let (t, mut y) = system.start();
        // A little off, so that there is something to project.
        y.iter_mut().enumerate().for_each(|(i, y)| *y += 1e-6 * (1.0 + i as f64).sin());
        let (mut ydot, mut product, mut square) = (vec![0.0; n], vec![0.0; n], vec![0.0; n * n]);
        // SAFETY: a live system.
        let (coordinates, states, parameters, observables, conserved, constraints) = unsafe {
            (
                pc_system_coordinate_count(s.as_ref()),
                pc_system_state_count(s.as_ref()),
                pc_system_parameter_count(s.as_ref()),
                pc_system_observable_count(s.as_ref()),
                pc_system_conserved_count(s.as_ref()),
                pc_system_constraint_count(s.as_ref()),
            )
        };
        let k = n - coordinates - states;
        let (mut mass, values) = (vec![0.0; k * k], system.parameters());
        let mut observed = vec![0.0; observables];
        let mut residuals = vec![0.0; constraints];
        let (mut energy, mut moved) = (0.0, y.clone());
        let (yp, p) = (y.as_ptr(), values.as_ptr());
        let mut note = |what: &str, count: usize| {
            if count > 0 {
                found.push(format!("{what} of {case}: {count}"));
            }
        };
        // SAFETY: a live system and arrays as long as said.
        unsafe {
            note("rhs", again(|e| pc_system_rhs(s, t, yp, n, ydot.as_mut_ptr(), n, e)));
            note("jacobian", again(|e| pc_system_jacobian(s, t, yp, n, square.as_mut_ptr(), n * n, e)));
            let mut entries = 0;
            call(|e| pc_system_jacobian_pattern(s, &raw mut entries, ptr::null_mut(), ptr::null_mut(), e))
                .unwrap();
            let sparse = &mut square[..entries];
            note(
                "sparse",
                again(|e| pc_system_sparse_jacobian(s, t, yp, n, sparse.as_mut_ptr(), entries, e)),
            );
            let v = ydot.as_ptr();
            note("jvp", again(|e| pc_system_jvp(s, t, yp, n, v, n, product.as_mut_ptr(), n, e)));
            note("mass", again(|e| pc_system_mass_matrix(s, t, yp, n, mass.as_mut_ptr(), k * k, e)));
            note("right", again(|e| pc_system_right_hand_side(s, t, yp, n, mass.as_mut_ptr(), k, e)));
            if ["heavy-top-lagrange", "chaplygin-sleigh", "puma-560"].contains(&case.0.as_str()) {
                note("coriolis", again(|e| pc_system_coriolis(s, t, yp, n, mass.as_mut_ptr(), k * k, e)));
            }
            if case.0 == "puma-560" {
                let mut columns = vec![0.0; 6 * (k + 2)];
                let (out, six, three) = (columns.as_mut_ptr(), 6 * (k + 2), 3 * (k + 2));
                note("centroidal", again(|e| pc_system_centroidal(s, t, yp, n, out, six, e)));
                note("centre", again(|e| pc_system_centre_of_mass(s, t, yp, n, out, 3, e)));
                note("of centre", again(|e| pc_system_centre_of_mass_jacobian(s, t, yp, n, out, three, e)));
                let hand = c"hand".as_ptr();
                let of_body = |e| pc_system_body_jacobian(s, t, yp, n, hand, ptr::null(), 0, out, six, e);
                note("body", again(of_body));
            }
            let w = product[..k].as_mut_ptr();
            // A point of contact has no mass: M alone is singular.
            if case.0 != "disk-on-bumps" {
                note("solve_mass", again(|e| pc_system_solve_mass_matrix(s, t, yp, n, v, k, w, k, e)));
            }
            if on_nothing && !has_tables {
                note("time", again(|e| pc_system_time_derivative(s, t, yp, n, product.as_mut_ptr(), n, e)));
            }
            note("residual", again(|e| pc_system_residual(s, t, yp, n, v, n, product.as_mut_ptr(), n, e)));
            note("energy", again(|e| pc_system_energy(s, t, yp, n, &raw mut energy, e)));
            note(
                "integrals",
                again(|e| pc_system_integrals(s, t, yp, n, observed.as_mut_ptr(), conserved, e)),
            );
            note("observe", again(|e| pc_system_observe(s, t, yp, n, observed.as_mut_ptr(), observables, e)));
            if constraints > 0 {
                let (r, m) = (residuals.as_mut_ptr(), constraints);
                note("constraint", again(|e| pc_system_constraint_residuals(s, t, yp, n, r, m, e)));
            }
            let project = |e| {
                moved.copy_from_slice(&y);
                pc_system_project(s, t, moved.as_mut_ptr(), n, e)
            };
            // Projection onto a nonlinear constraint allocates matrices.
            if case.0 != "appell-hamel" {
                note("project", again(project));
            }
            note("set_parameters", again(|e| pc_system_set_parameters(s, p, parameters, e)));
            if parameters > 0 {
                note("set_parameter", again(|e| pc_system_set_parameter(s, 0, values[0], e)));
            }
            let mut kernel = ptr::null_mut();
            call(|e| pc_kernel_new(s, &raw mut kernel, e)).unwrap();
            let ok = |code: c_int| if code == 0 { pc_status::PC_OK } else { pc_status::PC_EVALUATION };
            let evaluate = |e: *mut *mut pc_error| {
                if !e.is_null() {
                    e.write(ptr::null_mut());
                }
                ok(pc_kernel_rhs(t, yp, ydot.as_mut_ptr(), kernel.cast()))
            };
            note("kernel_rhs", again(evaluate));
            let (two, mut both) = ([&y[..], &y[..]].concat(), vec![0.0; 2 * n]);
            let many = |e: *mut *mut pc_error| {
                if !e.is_null() {
                    e.write(ptr::null_mut());
                }
                ok(pc_kernel_rhs_many(t, two.as_ptr(), 2, both.as_mut_ptr(), kernel.cast()))
            };
            note("kernel_rhs_many", again(many));
            note("kernel_set", again(|e| pc_kernel_set_parameters(kernel, p, parameters, e)));
            pc_kernel_free(kernel);
        }
    }
    assert!(found.is_empty(), "{found:#?}");
}

/// This holds once the order of the method has grown, but for one list that grows with it, in steps
/// without events, since an occurrence is stored. Models with steep functions of time and state are left out: each step searches these
/// functions again.
#[test]
fn steps_allocate_nothing() {
    use pc_linear_solver::{PC_LINEAR_AUTOMATIC, PC_LINEAR_KRYLOV, PC_LINEAR_SPARSE};
    use pc_method::{PC_ADAMS, PC_BDF, PC_DOP853};
    let (mut found, mut with_events) = (Vec::new(), 0);
    for case in cases() {
        let system = system(&case);
        if case.0 == "turning-hoop" {
            continue;
        }
        // SAFETY: a live system.
        let events = unsafe { pc_system_event_count(system.0.as_ref()) };
        with_events += usize::from(events > 0);
        let (bdf, newton) = (PC_BDF as c_int, pc_iteration::PC_NEWTON as c_int);
        let methods = [
            (PC_ADAMS as c_int, pc_iteration::PC_ITERATION_OF_METHOD as c_int, PC_LINEAR_AUTOMATIC),
            (bdf, newton, PC_LINEAR_AUTOMATIC),
            (bdf, newton, PC_LINEAR_SPARSE),
            (bdf, newton, PC_LINEAR_KRYLOV),
            (PC_DOP853 as c_int, pc_iteration::PC_ITERATION_OF_METHOD as c_int, PC_LINEAR_AUTOMATIC),
        ];
        for (method, iteration, linear) in methods {
            // The long steps of this method list the extrema of functions of time that they
            // contain.
            let in_time = [
                "turning-wire",
                "charged-particle-induction",
                "snakeboard-driven",
                "voronets-rheonomic",
                "satellite",
            ];
            if method == PC_DOP853 as c_int && in_time.contains(&case.0.as_str()) {
                continue;
            }
            let n = system.dim();
            let options = pc_solver_options {
                method,
                iteration,
                linear_solver: linear as c_int,
                relative_tolerance: 1e-6,
                absolute_tolerance: 1e-8,
                max_step: 10.0, // otherwise one step takes a motion at rest to its end
                ..Default::default()
            };
            let solver = common::Solver::of(&system, &options);
            let (mut t, mut y) = (0.0, vec![0.0; n]);
            let occurred = || {
                let occurrences = |event| {
                    let mut number = 0;
                    // SAFETY: a live solver and a place for a number.
                    let count =
                        |e| unsafe { pc_solver_event_occurrences(solver.0, event, &raw mut number, e) };
                    call(count).unwrap();
                    number
                };
                (0..events).map(occurrences).sum::<u64>()
            };
            // SAFETY: a live solver and room as said.
            let mut step = |e| unsafe { pc_solver_step(solver.0, 1e6, &raw mut t, y.as_mut_ptr(), n, e) };
            for _ in 0..30 {
                match call(&mut step) {
                    Err(refusal) if refusal == common::by_event() => {}
                    other => other.unwrap(),
                }
            }
            let (mut in_steps, mut is_new_start) = (0, false);
            for _ in 0..30 {
                let (known, before) = (occurred(), allocations());
                let status = step(ptr::null_mut());
                let number = allocations() - before;
                assert!(status == pc_status::PC_OK || status == pc_status::PC_EVENT && events > 0);
                is_new_start = occurred() != known;
                if !is_new_start {
                    in_steps += number;
                }
            }
            let before = allocations() - in_steps;
            let (mut work, size) = (pc_statistics::default(), size_of::<pc_statistics>());
            // SAFETY: a live solver and room as said.
            unsafe {
                let none = ptr::null_mut();
                assert_eq!(pc_solver_time(solver.0, &raw mut t, none), pc_status::PC_OK);
                assert_eq!(pc_solver_state(solver.0, y.as_mut_ptr(), n, none), pc_status::PC_OK);
                // After a reset there is no step to interpolate.
                if !is_new_start {
                    let inside = pc_solver_interpolate(solver.0, t, 0, y.as_mut_ptr(), n, none);
                    assert_eq!(inside, pc_status::PC_OK);
                }
                assert_eq!(pc_solver_statistics(solver.0, &raw mut work, size, none), pc_status::PC_OK);
            }
            if allocations() > before {
                let number = allocations() - before;
                found.push(format!("{case}, method {method} {iteration}: {number} in 30 steps"));
            }
        }
    }
    assert!(found.is_empty(), "{found:#?}");
    assert!(with_events > 0);
}
