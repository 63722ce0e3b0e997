//! Calls that derive from threads with little stack.

use std::ptr;
use std::thread;

use crate::common::{Model, call, taken};
use pc::*;

/// The stack that the header demands of a thread.
const STACK: usize = 128 << 10;

/// Makes all calls that derive, printing in the first `formats` formats. With fewer than three it
/// omits the second derivation, which takes long for long expressions.
fn on_small_stack(potential: &str, formats: i32) {
    let text = format!(
        "[coordinates]\nx = 0.3\n[lagrangian]\nkinetic = \"(1 + t^2)*x'^2/2\"\npotential = \"{potential}\"\n"
    );
    let derive = move || {
        let model = Model::text(&text).unwrap();
        // SAFETY: a live model.
        call(|error| unsafe { pc_model_check(model.0, error) }).unwrap();
        let system = model.system(pc_form::PC_POINCARE).unwrap();
        let (t, y) = system.start();
        assert!(system.at(pc_system_mass_matrix, t, &y, 1).unwrap()[0] >= 1.0);
        system.at(pc_system_time_derivative, t, &y, 2).unwrap();
        system.at(pc_system_to_momenta, t, &y, 2).unwrap();
        for format in 0..formats {
            let mut text = ptr::null_mut();
            // SAFETY: a live system and a place for a text.
            call(|error| unsafe { pc_system_print(system.0, format, &raw mut text, error) }).unwrap();
            taken(text);
        }
        if formats < 3 {
            return;
        }
        let mut report = ptr::null_mut();
        // SAFETY: a live system and a place for a text.
        call(|error| unsafe { pc_system_verify(system.0, 3, &raw mut report, error) }).unwrap();
        taken(report);
    };
    thread::Builder::new().stack_size(STACK).spawn(derive).unwrap().join().unwrap();
}

#[test]
fn functions_nest_up_to_the_limit() {
    on_small_stack(&format!("{}x{}", "sin(".repeat(199), ")".repeat(199)), 3);
}

#[test]
fn long_sums_are_handled() {
    on_small_stack(&(1..5000).map(|i| format!("sin({i}*x)")).collect::<Vec<_>>().join(" + "), 1);
}
