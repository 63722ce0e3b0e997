//! Misuse of the interface is refused.

use std::ffi::{c_int, c_void};
use std::ptr;

use crate::common::{self, At, Model, Solver, System, call, sharp};
use pc::pc_form::{PC_CANONICAL, PC_POINCARE};
use pc::pc_status::*;
use pc::*;

fn of_text(text: &str) -> System {
    Model::text(text).unwrap().system(PC_POINCARE).unwrap()
}

#[test]
fn misaligned_arrays_are_refused() {
    let system = System::of("heavy-top-lagrange");
    let (y, mut ydot) = ([0.5; 8], [0.0; 8]);
    let off = y.as_ptr().cast::<u8>().wrapping_add(1).cast::<f64>();
    let out = ydot.as_mut_ptr();
    let off_out = out.cast::<u8>().wrapping_add(4).cast::<f64>();
    let rhs = |y, ydot| {
        // SAFETY: a live system; what is refused is not looked at.
        call(|error| unsafe { pc_system_rhs(system.0, 0.0, y, 6, ydot, 6, error) })
    };
    rhs(y.as_ptr(), out).unwrap();
    let refusal = rhs(off, out).unwrap_err();
    assert_eq!(
        (refusal.status, refusal.message.as_str()),
        (PC_INVALID_ARGUMENT, "y is misaligned: its address must be a multiple of 8 bytes")
    );
    assert!(rhs(y.as_ptr(), off_out).unwrap_err().message.starts_with("ydot is misaligned"));
    let mut kernel = ptr::null_mut();
    // SAFETY: a live system, then its kernel, which is freed once.
    unsafe {
        call(|error| pc_kernel_new(system.0, &raw mut kernel, error)).unwrap();
        assert_eq!(pc_kernel_rhs(0.0, off, out, kernel.cast()), -1);
        assert_eq!(pc_kernel_rhs(0.0, y.as_ptr(), off_out, kernel.cast()), -1);
        assert_eq!(pc_kernel_rhs(0.0, y.as_ptr(), out, kernel.cast()), 0);
        pc_kernel_free(kernel);
    }
}

#[test]
fn minus_one_is_refused_as_a_length() {
    let (mut model, text) = (ptr::null_mut(), c"[coordinates]");
    // SAFETY: a text; the length is refused.
    let refusal = call(|error| unsafe {
        pc_model_parse(text.as_ptr(), usize::MAX, ptr::null(), &raw mut model, error)
    });
    let refusal = refusal.unwrap_err();
    assert_eq!(refusal.status, PC_INVALID_ARGUMENT);
    assert_eq!(
        refusal.message,
        "text: memory cannot hold 18446744073709551615 numbers, only 9223372036854775807; is the length −1?"
    );
    let solver = Solver::of(&System::of("euler-top"), &sharp());
    let times = [1.0];
    // SAFETY: a live solver; the length is refused.
    let run = call(|error| unsafe {
        pc_solver_run(solver.0, times.as_ptr(), usize::MAX, None, ptr::null_mut(), error)
    });
    assert_eq!(run.unwrap_err().status, PC_INVALID_ARGUMENT);
}

#[test]
fn a_null_array_has_length_zero() {
    let (system, mut solver) = (System::of("euler-top"), ptr::null_mut());
    // SAFETY: live objects; what is refused is not looked at.
    unsafe {
        let start =
            call(|error| pc_solver_new(system.0, ptr::null(), 5.0, ptr::null(), 6, &raw mut solver, error));
        assert_eq!(start.unwrap_err().status, PC_INVALID_ARGUMENT);
        let options = pc_solver_options { absolute_tolerances_length: system.dim(), ..Default::default() };
        let tolerances = call(|error| {
            pc_solver_new(system.0, &raw const options, 0.0, ptr::null(), 0, &raw mut solver, error)
        });
        assert_eq!(tolerances.unwrap_err().message, "absolute_tolerances is a null pointer");
        let ensemble = call(|error| {
            let (none, times) = (ptr::null::<f64>(), [1.0]);
            let observer: pc_member_observer = Some(never);
            let dim = system.dim();
            pc_ensemble_run(
                system.0,
                none.cast(),
                1,
                0.0,
                none,
                dim,
                none,
                0,
                times.as_ptr(),
                1,
                1,
                observer,
                ptr::null_mut(),
                error,
            )
        });
        assert_eq!(ensemble.unwrap_err().message, "states is a null pointer");
    }
}

extern "C" fn never(_: *const pc_member, _: *mut c_void) -> c_int {
    unreachable!()
}

/// Data of a `destroy` that uses the system being freed.
struct Destroyer {
    system: *mut pc_system,
    statuses: Vec<pc_status>,
    named: bool,
}

extern "C" fn force(_: f64, _: *const f64, _: usize, q: *mut f64, _: usize, _: *mut c_void) -> c_int {
    // SAFETY: one force.
    unsafe { q.write(0.0) };
    0
}

extern "C" fn destroy(user: *mut c_void) {
    // SAFETY: the destroyer below, which lives; its system is being freed.
    unsafe {
        let Destroyer { system, statuses, named } = &mut *user.cast();
        *named = !pc_system_name((*system).as_ref(), 0).is_null();
        let mut energy = 0.0;
        let y = [0.0; 2];
        statuses.push(pc_system_energy(*system, 0.0, y.as_ptr(), 2, &raw mut energy, ptr::null_mut()));
        pc_system_free(*system);
    }
}

#[test]
fn a_system_that_is_being_freed_is_busy() {
    let model = Model::text("[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n").unwrap();
    // SAFETY: a live model and a text.
    call(|error| unsafe { pc_model_add_external_force(model.0, c"x".as_ptr(), error) }).unwrap();
    let system = std::mem::ManuallyDrop::new(model.system(PC_POINCARE).unwrap());
    let mut destroyer = Destroyer { system: system.0, statuses: Vec::new(), named: false };
    // SAFETY: a live system, which is freed once; the destroyer outlives it.
    unsafe {
        let user = (&raw mut destroyer).cast();
        call(|error| pc_system_set_force(system.0, Some(force), None, user, Some(destroy), error)).unwrap();
        pc_system_free(system.0);
    }
    assert!(destroyer.named && destroyer.statuses == [PC_BUSY]);
}

#[test]
fn an_output_named_like_a_reaction_is_not_one() {
    let text = common::ROD.to_owned() + "[outputs]\n\"λ_rod\" = \"7*x\"\n";
    let model = Model::text(&text).unwrap();
    // SAFETY: a live model.
    call(|error| unsafe { pc_model_observe_reactions(model.0, 1, error) }).unwrap();
    let system = model.system(PC_POINCARE).unwrap();
    // SAFETY: a live system.
    assert_eq!(unsafe { pc_system_reaction_count(system.0.as_ref()) }, 1);
    let (t, y) = system.start();
    // The rod of length 1 holds a bob of mass 1 by λ = −v² + 10 z = −1.5² − 8, counted along (x, y, z).
    let reaction = system.at(pc_system_reactions, t, &y, 1).unwrap()[0];
    assert!((reaction + 10.25).abs() < 1e-13, "{reaction}"); // rounding of numbers of order 10
}

#[test]
fn no_energy_is_written_where_there_is_none() {
    let system = of_text(
        "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"sqrt(x)\"\n\
         [integrals]\nroot = \"sqrt(x)\"\n",
    );
    let mut energy = 0.0;
    let y = [-1.0, 0.0];
    let mut error = ptr::null_mut();
    // SAFETY: a live system, arrays as long as said, an error that is freed once.
    unsafe {
        let status = pc_system_energy(system.0, 0.0, y.as_ptr(), 2, &raw mut energy, &raw mut error);
        assert_eq!((status, pc_error_is_recoverable(error.as_ref())), (PC_EVALUATION, 1));
        pc_error_free(error);
    }
    let refusal = system.at(pc_system_integrals, 0.0, &y, 2).unwrap_err();
    assert_eq!(
        (refusal.status, refusal.message.as_str()),
        (PC_EVALUATION, "an integral has no value here: it is NaN")
    );
    let observed = system.at(pc_system_observe, 0.0, &y, 2).unwrap();
    assert!(observed.iter().all(|value| value.is_nan()));
    let known = system.at(pc_system_integrals, 0.0, &[4.0, 1.0], 2).unwrap();
    assert_eq!(known, [2.0, 2.5]);
}

#[test]
fn a_model_is_checked_with_its_names() {
    let model =
        Model::text("[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"k*x\"\n");
    // SAFETY: a live model.
    let refusal = call(|error| unsafe { pc_model_check(model.unwrap().0, error) }).unwrap_err();
    assert_eq!((refusal.status, refusal.line), (PC_INVALID_MODEL, 5));
}

#[test]
fn numbers_that_are_not_finite_give_none_that_are_not() {
    let systems = ["heavy-top-lagrange", "rod", "double-pendulum-links"].map(System::of);
    for (system, wrong) in systems.iter().flat_map(|system| [(system, f64::NAN), (system, f64::INFINITY)]) {
        let (_, mut y) = system.start();
        let (n, last) = (y.len(), y.len() - 1);
        y[last] = wrong;
        let functions: [(At, usize); 4] = [
            (pc_system_rhs, n),
            (pc_system_jacobian, n * n),
            (pc_system_to_momenta, n),
            (pc_system_to_quasi_velocities, n),
        ];
        for (i, (function, length)) in functions.into_iter().enumerate() {
            let found = system.at(function, 0.0, &y, length);
            let refused = found.is_err_and(|refusal| refusal.status == PC_EVALUATION);
            assert!(refused, "function {i} of {} at {wrong}", system.name(0));
        }
        let given = y.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
        let data = y.as_mut_ptr();
        // SAFETY: a live system and a state of its.
        let refusal = call(|error| unsafe { pc_system_project(system.0, 0.0, data, n, error) }).unwrap_err();
        assert_eq!(refusal.status, PC_EVALUATION, "{refusal:?}");
        assert!(y.iter().map(|value| value.to_bits()).eq(given), "the state stays as it is");
    }
    // Of vectors, too.
    let system = &systems[0];
    let (_, y) = system.start();
    let (n, wrong, mut out) = (y.len(), vec![f64::INFINITY; y.len()], vec![0.0; y.len()]);
    let (y, v, out) = (y.as_ptr(), wrong.as_ptr(), out.as_mut_ptr());
    // SAFETY: a live system and arrays as long as said.
    let outcomes = unsafe {
        [
            call(|error| pc_system_jvp(system.0, 0.0, y, n, v, n, out, n, error)),
            call(|error| pc_system_solve_mass_matrix(system.0, 0.0, y, n, v, 3, out, 3, error)),
            call(|error| pc_system_residual(system.0, 0.0, y, n, v, n, out, n, error)),
        ]
    };
    assert!(
        outcomes.into_iter().all(|outcome| outcome.is_err_and(|refusal| refusal.status == PC_EVALUATION))
    );
}

#[test]
fn a_residual_in_momenta_is_finite_or_refused() {
    let system = Model::named("heavy-top-lagrange").system(PC_CANONICAL).unwrap();
    let (_, y) = system.start();
    let (n, rates, mut out) = (y.len(), vec![f64::INFINITY; y.len()], vec![0.0; y.len()]);
    let (y, v, out) = (y.as_ptr(), rates.as_ptr(), out.as_mut_ptr());
    // SAFETY: a live system and arrays as long as said.
    let refusal = call(|error| unsafe { pc_system_residual(system.0, 0.0, y, n, v, n, out, n, error) });
    assert_eq!(refusal.unwrap_err().status, PC_EVALUATION);
}

#[test]
fn exponents_share_no_memory_with_the_state_even_where_they_are_too_many() {
    let system = System::of("euler-top");
    let mut numbers = [0.5; 8];
    let data = numbers.as_mut_ptr();
    // SAFETY: a live system and arrays as long as said; they overlap, which is refused.
    let refusal = call(|error| unsafe {
        pc_system_lyapunov(system.0, ptr::null(), 0.0, data, 3, 0.5, 2, 0, data.add(2), 6, error)
    });
    let refusal = refusal.unwrap_err();
    assert_eq!(
        (refusal.status, refusal.message.as_str()),
        (PC_INVALID_ARGUMENT, "y and exponents share memory, but must be separate")
    );
}
