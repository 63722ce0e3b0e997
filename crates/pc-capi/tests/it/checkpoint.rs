//! Motions as functions of time, and motions that continue from a checkpoint.

use std::ffi::{c_char, c_void};
use std::ptr;

use crate::common::{Model, Refusal, Solver, System, c, call, sharp, taken};
use pc::pc_status::*;
use pc::*;

#[track_caller]
fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance * (1.0 + expected.abs()), "{found} is not {expected}");
    }
}

#[test]
fn dense_output_agrees_with_a_run_at_its_times() {
    for name in ["heavy-top-lagrange", "bouncing-ball"] {
        let system = System::of(name);
        let (solver, other) = (Solver::of(&system, &sharp()), Solver::of(&system, &sharp()));
        let (outcome, motion) = solver.run_dense(2.5);
        outcome.unwrap();
        assert_eq!((motion.span(), solver.time()), ((0.0, 2.5), 2.5));
        for i in 0..=50 {
            let t = 0.05 * f64::from(i);
            let (outcome, y) = other.advance(t);
            outcome.unwrap();
            // The same polynomials written about other points: rounding, amplified by the degree up
            // to 13. (No time coincides with a bounce, which the function locates to 1e-15.)
            assert_near(&motion.at(t).unwrap(), &y, 1e-10);
            if name == "heavy-top-lagrange" {
                // The derivative of the polynomial is one order less accurate than the states.
                let rate = system.at(pc_system_rhs, t, &y, y.len()).unwrap();
                assert_near(&motion.rate(t).unwrap(), &rate, 1e-7);
            }
        }
        for t in [-0.1, 2.6, f64::NAN] {
            assert_eq!(motion.at(t).unwrap_err().status, PC_INVALID_ARGUMENT);
        }
    }
    // At an event the function gives the state after it.
    let solver = Solver::of(&System::of("bouncing-ball"), &sharp());
    let (_, motion) = solver.run_dense(0.6);
    let (t, _, after) = solver.last(0).unwrap();
    assert_eq!(motion.at(t).unwrap()[1].signum(), after[1].signum());
    assert_near(&motion.at(t).unwrap(), &after, 1e-10);
}

#[test]
fn states_inside_the_last_step_are_interpolated() {
    let system = System::of("heavy-top-lagrange");
    let solver = Solver::of(&system, &sharp());
    assert_eq!(solver.interpolate(0.0, 0).unwrap_err().status, PC_INVALID_ARGUMENT);
    let mut t = 0.0;
    let (mut begin, mut y) = (0.0, vec![]);
    while t < 1.0 {
        begin = t;
        let (outcome, end, state) = solver.step(2.0);
        outcome.unwrap();
        (t, y) = (end, state);
    }
    assert_near(&solver.interpolate(t, 0).unwrap(), &y, 1e-15); // the end itself
    let rate = system.at(pc_system_rhs, t, &y, y.len()).unwrap();
    assert_near(&solver.interpolate(t, 1).unwrap(), &rate, 1e-9); // the corrector has ẏ = f to its tolerance
    let other = Solver::of(&system, &sharp());
    let middle = 0.5 * (begin + t);
    assert_near(&solver.interpolate(middle, 0).unwrap(), &other.advance(middle).1, 1e-10);
    for (t, order) in [(t + 1.0, 0), (begin - 1.0, 0), (t, 40), (f64::NAN, 0), (f64::INFINITY, 1)] {
        let refusal = solver.interpolate(t, order).unwrap_err();
        assert_eq!(refusal.status, PC_INVALID_ARGUMENT, "{t} {order} {}", refusal.message);
    }
    assert_eq!(solver.time(), t); // interpolation has not moved it
}

/// The bytes of a checkpoint, and its label.
fn checkpoint(solver: &Solver, label: *const c_char) -> Result<Vec<u8>, Refusal> {
    let (mut data, mut length) = (ptr::dangling_mut::<c_void>(), 1);
    // SAFETY: a live solver, text or null, and places for results; the bytes are freed once.
    unsafe {
        let written =
            call(|error| pc_solver_checkpoint(solver.0, label, &raw mut data, &raw mut length, error));
        if written.is_err() {
            assert!(data.is_null() && length == 0);
        }
        written?;
        let bytes = std::slice::from_raw_parts(data.cast(), length).to_vec();
        pc_bytes_free(data);
        Ok(bytes)
    }
}

fn label(bytes: &[u8]) -> Result<String, Refusal> {
    let mut text = ptr::null_mut();
    // SAFETY: as many bytes as said, and a place for the text.
    call(|error| unsafe { pc_checkpoint_label(bytes.as_ptr().cast(), bytes.len(), &raw mut text, error) })?;
    Ok(taken(text))
}

#[test]
fn a_resumed_motion_is_the_same_to_the_last_bit() {
    let by = |method: pc_method| pc_solver_options { method: method as i32, ..Default::default() };
    let (stiff, explicit, auto) = (by(pc_method::PC_BDF), by(pc_method::PC_DOP853), by(pc_method::PC_AUTO));
    for name in [
        "heavy-top-lagrange",
        "rod",
        "chaplygin-sleigh",
        "voronets-rheonomic",
        "rocking-block",
        "stick-slip-block",
    ] {
        for options in [pc_solver_options::default(), stiff, explicit, auto] {
            let system = System::of(name);
            let start = system.start().0;
            let solver = Solver::of(&system, &options);
            solver.advance(start + 1.3).0.unwrap();
            let text = c("λόγος");
            let bytes = checkpoint(&solver, text.as_ptr()).unwrap();
            assert_eq!(label(&bytes).as_deref(), Ok("λόγος"));
            let steps = |solver: &Solver| {
                let (mut work, size) = (pc_statistics::default(), size_of::<pc_statistics>());
                // SAFETY: a live solver and room as said.
                call(|error| unsafe { pc_solver_statistics(solver.0, &raw mut work, size, error) }).unwrap();
                work.steps
            };
            let before = steps(&solver);
            let (outcome, y) = solver.advance(start + 3.0);
            outcome.unwrap();
            let other = Solver::restored(&System::of(name), &options, &bytes).unwrap();
            assert_eq!((other.time(), steps(&other)), (start + 1.3, 0));
            assert_eq!(other.advance(start + 3.0), (Ok(()), y), "{name}");
            assert_eq!(before + steps(&other), steps(&solver));
            // A checkpoint of the restored solver.
            let bytes = checkpoint(&other, ptr::null()).unwrap();
            assert_eq!(label(&bytes).as_deref(), Ok(""));
            let third = Solver::restored(&system, &options, &bytes).unwrap();
            assert_eq!(third.advance(start + 4.0), other.advance(start + 4.0));
        }
    }
}

#[test]
fn torn_checkpoints_are_refused() {
    let system = System::of("heavy-top-lagrange");
    let solver = Solver::of(&system, &pc_solver_options::default());
    solver.advance(1.0).0.unwrap();
    let bytes = checkpoint(&solver, c"top".as_ptr()).unwrap();
    let options = pc_solver_options::default();
    for i in 0..20 {
        let place = i * bytes.len() / 20;
        let mut changed = bytes.clone();
        changed[place] ^= 1 << (i % 8);
        let longer = [&bytes[..], &vec![0; i + 1]].concat();
        for torn in [&bytes[..place], &changed, &longer] {
            let refusal = Solver::restored(&system, &options, torn).err().unwrap();
            assert_eq!(refusal.status, PC_INVALID_CHECKPOINT, "{place}");
            assert_eq!(label(torn).unwrap_err().status, PC_INVALID_CHECKPOINT);
        }
    }
    assert_eq!(label(b"\x89PNG").unwrap_err().message, "it is not a checkpoint");
    Solver::restored(&system, &options, &bytes).unwrap();
}

#[test]
fn wrong_calls_are_refused() {
    let (system, ball) = (System::of("heavy-top-lagrange"), System::of("bouncing-ball"));
    let options = pc_solver_options::default();
    let (solver, bouncing) = (Solver::of(&system, &options), Solver::of(&ball, &options));
    solver.advance(1.0).0.unwrap();
    let bytes = checkpoint(&solver, ptr::null()).unwrap();
    let refusal = Solver::restored(&ball, &options, &bytes).err().unwrap();
    assert_eq!(refusal.status, PC_INVALID_CHECKPOINT, "{}", refusal.message);
    let events = checkpoint(&bouncing, ptr::null()).unwrap();
    let refusal = Solver::restored(&system, &options, &events).err().unwrap();
    assert_eq!(refusal.status, PC_INVALID_CHECKPOINT, "{}", refusal.message);
    let latin = [b'\xff', 0];
    let refusal = checkpoint(&solver, latin.as_ptr().cast()).unwrap_err();
    assert_eq!(refusal.message, "label is not UTF-8 text: byte number 0 (from 0) is invalid");

    let (mut made, mut text, mut data, mut length) = (ptr::null_mut(), ptr::null_mut(), ptr::null_mut(), 0);
    let (mut dense, mut y) = (ptr::null_mut(), [0.0; 6]);
    let (no_solver, no_system): (*mut pc_solver, *mut pc_system) = (ptr::null_mut(), ptr::null_mut());
    let (made, text, data, length, dense, y, none) = (
        &raw mut made,
        &raw mut text,
        &raw mut data,
        &raw mut length,
        &raw mut dense,
        y.as_mut_ptr(),
        ptr::null_mut(),
    );
    let (written, size) = (bytes.as_ptr().cast(), bytes.len());
    let (_, motion) = solver.run_dense(2.0);
    refused! { PC_INVALID_ARGUMENT, "is a null pointer";
        pc_solver_checkpoint(no_solver, ptr::null(), data, length);
        pc_solver_checkpoint(solver.0, ptr::null(), ptr::null_mut(), length);
        pc_solver_checkpoint(solver.0, ptr::null(), data, ptr::null_mut());
        pc_solver_restore(no_system, ptr::null(), written, size, made);
        pc_solver_restore(system.0, ptr::null(), ptr::null(), size, made);
        pc_solver_restore(system.0, ptr::null(), written, size, ptr::null_mut());
        pc_checkpoint_label(ptr::null(), size, text);
        pc_checkpoint_label(written, size, ptr::null_mut());
        pc_solver_interpolate(no_solver, 1.0, 0, y, 6);
        pc_solver_interpolate(solver.0, 1.0, 0, none, 6);
        pc_solver_run_dense(no_solver, 3.0, dense);
        pc_solver_run_dense(solver.0, 3.0, ptr::null_mut());
        pc_dense_eval(ptr::null(), 1.0, y, 6);
        pc_dense_eval(motion.0, 1.5, none, 6);
        pc_dense_rate(ptr::null(), 1.0, y, 6);
        pc_dense_rate(motion.0, 1.5, none, 6);
    }
    refused! { PC_INVALID_ARGUMENT, "5 numbers instead of 6";
        pc_solver_interpolate(solver.0, 2.0, 0, y, 5);
        pc_dense_eval(motion.0, 1.5, y, 5);
        pc_dense_rate(motion.0, 1.5, y, 5);
    }
    refused! { PC_INVALID_CHECKPOINT, "it is not a checkpoint";
        pc_solver_restore(system.0, ptr::null(), ptr::null(), 0, made);
        pc_checkpoint_label(ptr::null(), 0, text);
    }
    for t in [f64::NAN, 1.0, 2.0] {
        let (outcome, motion) = solver.run_dense(t);
        assert_eq!((outcome.unwrap_err().status, motion.0.is_null()), (PC_INVALID_ARGUMENT, true));
    }
    // SAFETY: null.
    unsafe {
        assert_eq!(pc_dense_dim(None), 0);
        assert!(pc_dense_t_begin(None).is_nan() && pc_dense_t_end(None).is_nan());
        pc_dense_free(ptr::null_mut());
        pc_bytes_free(ptr::null_mut());
        assert!((*made).is_null() && (*text).is_null() && (*data).is_null() && (*dense).is_null());
    }
}

/// A system of this text, with values of its parameters.
fn oscillator(text: &str) -> System {
    Model::text(text).unwrap().system(pc_form::PC_POINCARE).unwrap()
}

#[test]
fn a_checkpoint_of_another_model_is_refused() {
    let text = "[parameters]\nk = 4.0\n[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"k*x^2/2\"\n";
    let system = oscillator(text);
    let solver = Solver::of(&system, &sharp());
    solver.advance(1.0).0.unwrap();
    let bytes = checkpoint(&solver, c"x".as_ptr()).unwrap();
    let said = "the checkpoint belongs to another model: its names, their number or its equations differ from the system's";
    // Other equations, other names, another number of components, another form.
    for (from, to) in [("k*x^2/2", "k*x^4/2"), ("x", "z"), ("k", "c"), ("x'^2/2", "x'^2/3")] {
        let other = oscillator(&text.replace("kinetic", "T").replace(from, to).replace("T =", "kinetic ="));
        let refusal = Solver::restored(&other, &sharp(), &bytes).err().unwrap();
        assert_eq!((refusal.status, refusal.message.as_str()), (PC_INVALID_CHECKPOINT, said), "{to}");
    }
    for name in ["heavy-top-quaternion", "rod", "bouncing-ball"] {
        let refusal = Solver::restored(&System::of(name), &sharp(), &bytes).err().unwrap();
        assert_eq!((refusal.status, refusal.message.as_str()), (PC_INVALID_CHECKPOINT, said), "{name}");
    }
    let canonical = Model::text(text).unwrap().system(pc_form::PC_CANONICAL).unwrap();
    assert_eq!(Solver::restored(&canonical, &sharp(), &bytes).err().unwrap().message, said);
    // Other parameter values make the same model: x = cos 2t continues as the motion with k = 9.
    let stiffer = oscillator(&text.replace("4.0", "9.0"));
    let other = Solver::restored(&stiffer, &sharp(), &bytes).unwrap();
    let (x, v) = (2.0f64.cos(), -2.0 * 2.0f64.sin());
    let expected = [x * 3.0f64.cos() + v / 3.0 * 3.0f64.sin(), v * 3.0f64.cos() - 3.0 * x * 3.0f64.sin()];
    assert_near(&other.advance(2.0).1, &expected, 1e-9); // a few hundred steps with errors of 1e-13
}

#[test]
fn a_checkpoint_without_a_model_is_refused() {
    let bytes = pc_solve::Checkpoint::start(0.0, &System::of("rod").start().1).to_bytes("mine");
    assert_eq!(label(&bytes).as_deref(), Ok("mine"));
    let refusal = Solver::restored(&System::of("rod"), &sharp(), &bytes).err().unwrap();
    assert_eq!(refusal.status, PC_INVALID_CHECKPOINT);
    assert!(refusal.message.ends_with("pc_solver_checkpoint did not write it"), "{}", refusal.message);
}
