//! Codes: shared by threads, saved and loaded.

use std::ffi::c_void;
use std::ptr;
use std::thread;

use crate::common::{Model, Refusal, Solver, System, call};
use pc::pc_status::*;
use pc::*;

/// A code, freed in the end.
struct Code(*mut pc_code);

// SAFETY: any number of threads may use a code.
unsafe impl Sync for Code {}

impl Code {
    fn of(name: &str, form: i32) -> Code {
        let (model, mut code) = (Model::named(name), ptr::null_mut());
        let mut options = pc_system_options::default();
        // SAFETY: all pointers are of live objects.
        unsafe {
            pc_system_options_init(&raw mut options, size_of::<pc_system_options>());
            options.form = form;
            call(|error| pc_code_new(model.0, &raw const options, &raw mut code, error)).unwrap();
        }
        Code(code)
    }

    fn loaded(bytes: &[u8]) -> Result<Code, Refusal> {
        let mut code = ptr::null_mut();
        // SAFETY: as many bytes as said, and a place for the handle.
        call(|error| unsafe { pc_code_load(bytes.as_ptr().cast(), bytes.len(), &raw mut code, error) })?;
        Ok(Code(code))
    }

    fn saved(&self) -> Vec<u8> {
        let (mut data, mut length): (*mut c_void, usize) = (ptr::null_mut(), 0);
        // SAFETY: a live code, places for results; the bytes are ours and freed once.
        unsafe {
            call(|error| pc_code_save(self.0, &raw mut data, &raw mut length, error)).unwrap();
            let bytes = std::slice::from_raw_parts(data.cast::<u8>(), length).to_vec();
            pc_bytes_free(data);
            bytes
        }
    }

    fn system(&self) -> System {
        let mut system = ptr::null_mut();
        // SAFETY: a live code and a place for the handle.
        call(|error| unsafe { pc_system_of_code(self.0, &raw mut system, error) }).unwrap();
        System(system)
    }
}

impl Drop for Code {
    fn drop(&mut self) {
        // SAFETY: ours, freed once.
        unsafe { pc_code_free(self.0) };
    }
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// What a system computes: rates, their derivatives, observables, M, and the end of a motion.
fn everything(system: &System) -> Vec<Vec<u64>> {
    let ((t, y), n) = (system.start(), system.dim());
    // SAFETY: a live system.
    let (k, observables) = unsafe {
        let handle = system.0.as_ref();
        let k = n - pc_system_coordinate_count(handle) - pc_system_state_count(handle);
        (k, pc_system_observable_count(handle))
    };
    let (outcome, end) = Solver::of(system, &pc_solver_options::default()).advance(t + 1.3);
    let mut found = vec![bits(&y), bits(&end), vec![u64::from(outcome.is_ok())]];
    for at in [&y, &end] {
        found.push(bits(&system.at(pc_system_rhs, t, at, n).unwrap()));
        found.push(bits(&system.at(pc_system_jacobian, t, at, n * n).unwrap()));
        found.push(bits(&system.at(pc_system_observe, t, at, observables).unwrap()));
        found.push(bits(&system.at(pc_system_mass_matrix, t, at, k * k).unwrap()));
    }
    found
}

#[test]
fn a_loaded_code_computes_the_same_to_the_last_bit() {
    use pc_form::{PC_CANONICAL, PC_POINCARE, PC_REDUCED};
    for (name, form) in [
        ("heavy-top-lagrange", PC_POINCARE),
        ("heavy-top-lagrange", PC_CANONICAL),
        ("heavy-top-lagrange", PC_REDUCED),
        ("rod", PC_POINCARE),
        ("rod", PC_CANONICAL),
        ("bouncing-ball", PC_POINCARE),
        ("snakeboard", PC_POINCARE),
        ("stick-slip-block", PC_POINCARE),
        ("four-bar-loop", PC_POINCARE),
        ("quadruped", PC_POINCARE),
    ] {
        let form = form as i32;
        let title = format!("{name} in form {form}");
        let code = Code::of(name, form);
        let expected = everything(&code.system());
        let bytes = code.saved();
        drop(code);
        let loaded = Code::loaded(&bytes).unwrap_or_else(|refusal| panic!("{title}: {refusal:?}"));
        assert_eq!(everything(&loaded.system()), expected, "{title}");
        assert_eq!(loaded.saved(), bytes, "{title}");
    }
}

#[test]
fn parameters_that_follow_others_still_follow_in_a_loaded_code() {
    let text = "parameters.a = 2.0\nparameters.b = \"3*a\"\ncoordinates.x = 1.0\n\
                lagrangian.kinetic = \"b*x'^2/2\"\nlagrangian.potential = \"x^2/2\"";
    let model = Model::text(text).unwrap();
    let mut code = ptr::null_mut();
    // SAFETY: live objects and a place for the handle.
    call(|error| unsafe { pc_code_new(model.0, ptr::null(), &raw mut code, error) }).unwrap();
    let loaded = Code::loaded(&Code(code).saved()).unwrap();
    let system = loaded.system();
    // SAFETY: a live system.
    call(|error| unsafe { pc_system_set_parameter(system.0, 0, 5.0, error) }).unwrap();
    assert_eq!(system.parameters(), [5.0, 15.0]);
    assert_eq!(system.at(pc_system_rhs, 0.0, &[1.0, 0.0], 2).unwrap(), [0.0, -1.0 / 15.0]);
    assert_eq!(loaded.system().parameters(), [2.0, 6.0], "other systems keep their values");
}

#[test]
fn damaged_bytes_are_refused() {
    let code = Code::of("rod", pc_form::PC_POINCARE as i32);
    let bytes = code.saved();
    for place in (0..bytes.len()).step_by(97) {
        let mut changed = bytes.clone();
        changed[place] ^= 0x20;
        let refusal = Code::loaded(&changed).err().unwrap();
        assert_eq!(refusal.status, PC_INVALID_CODE, "byte {place}: {refusal:?}");
        assert_eq!(Code::loaded(&bytes[..place]).err().unwrap().status, PC_INVALID_CODE);
    }
    let refusal = Code::loaded(b"[coordinates]\nx = 1.0\n").err().unwrap();
    assert_eq!(refusal.message, "the code cannot be used: this is not a derived model that pc has saved");
    assert_eq!(Code::loaded(&[]).err().unwrap().status, PC_INVALID_CODE);
}

#[test]
fn the_layout_that_is_written_has_the_number_that_it_says() {
    let code = Code::of("rod", pc_form::PC_POINCARE as i32);
    let bytes = code.saved();
    // Where this fails, other bytes are written for the same model: raise LAYOUT in pc_model::sealed.
    let hash: String = bytes[12..20].iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!((bytes[8], bytes.len(), &*hash), (1, 2783, "c10cbbaf62e66da3"));
}

#[test]
fn sixteen_threads_compute_with_one_code() {
    let code = Code::of("snakeboard", pc_form::PC_POINCARE as i32);
    let expected = everything(&code.system());
    // What nobody has needed so far is derived and compiled by whichever thread comes first.
    let fresh = Code::loaded(&Code::of("snakeboard", pc_form::PC_POINCARE as i32).saved()).unwrap();
    thread::scope(|scope| {
        for _ in 0..16 {
            let (fresh, expected) = (&fresh, &expected);
            scope.spawn(move || assert_eq!(everything(&fresh.system()), *expected));
        }
    });
}

#[test]
fn systems_outlive_their_code() {
    let code = Code::of("rod", pc_form::PC_POINCARE as i32);
    let (first, second) = (code.system(), code.system());
    drop(code);
    first.set_parameters(&[]).unwrap();
    let (t, y) = first.start();
    assert_eq!(first.at(pc_system_rhs, t, &y, 6), second.at(pc_system_rhs, t, &y, 6));
}

#[test]
fn null_is_refused_and_freed() {
    // SAFETY: null is allowed, and refused where it is not.
    unsafe {
        pc_code_free(ptr::null_mut());
        let (mut system, mut code) = (ptr::null_mut(), ptr::null_mut());
        let refusal = call(|error| pc_system_of_code(ptr::null(), &raw mut system, error)).unwrap_err();
        assert_eq!((refusal.status, &*refusal.message), (PC_INVALID_ARGUMENT, "code is a null pointer"));
        let refusal = call(|error| pc_code_load(ptr::null(), 7, &raw mut code, error)).unwrap_err();
        assert_eq!((refusal.status, &*refusal.message), (PC_INVALID_ARGUMENT, "data is a null pointer"));
    }
}
