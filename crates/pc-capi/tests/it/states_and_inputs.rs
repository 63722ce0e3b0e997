//! First-order states, and inputs that a program sets between steps.

use crate::common::{self, Model, Solver, System, call, sharp};
use pc::pc_form::{PC_CANONICAL, PC_POINCARE};
use pc::*;

/// A cart with a drive, F' = u − F.
const CART: &str = "[parameters]\nm = 2\nM = \"2*m\"\n[inputs]\nu = 3\n[coordinates]\nx = 0\n[states]\n\
                    F = { start = 1, rate = \"u - F\" }\n[lagrangian]\nkinetic = \"M*x'^2/2\"\n[forces]\nx = \"F\"\n";

fn set(system: &System, index: usize, value: f64) -> Result<(), common::Refusal> {
    // SAFETY: a live system.
    call(|error| unsafe { pc_system_set_parameter(system.0, index, value, error) })
}

#[test]
fn a_state_comes_last_and_is_part_of_everything() {
    for (form, moving) in [(PC_POINCARE, 1.0), (PC_CANONICAL, 4.0)] {
        let system = Model::text(CART).unwrap().system(form).unwrap();
        // SAFETY: a live system.
        assert_eq!(unsafe { pc_system_state_count(system.0.as_ref()) }, 1);
        assert_eq!(system.name(2), "F");

        let y = [0.0, 0.5 * moving, 2.0];
        let rates = system.at(pc_system_rhs, 0.0, &y, 3).unwrap();
        assert_eq!(rates, [0.5, 0.5 * moving, 1.0]);
        assert_eq!(system.at(pc_system_mass_matrix, 0.0, &y, 1).unwrap(), [4.0]);
        let mut residual = [f64::NAN; 3];
        // SAFETY: a live system and arrays as long as said.
        call(|error| unsafe {
            let (y, rates, residual) = (y.as_ptr(), rates.as_ptr(), residual.as_mut_ptr());
            pc_system_residual(system.0, 0.0, y, 3, rates, 3, residual, 3, error)
        })
        .unwrap();
        assert_eq!(residual, [0.0; 3]);
    }
}

#[test]
fn set_values_are_followed() {
    let system = Model::text(CART).unwrap().system(PC_POINCARE).unwrap();
    assert_eq!(system.parameters(), [2.0, 4.0, 3.0]);
    set(&system, 0, 5.0).unwrap();
    assert_eq!(system.parameters(), [5.0, 10.0, 3.0]);
    set(&system, 1, 1.0).unwrap();
    set(&system, 0, 7.0).unwrap();
    assert_eq!(system.parameters(), [7.0, 1.0, 3.0]);
}

/// F = u + (F_0 − u) e^−t from each change on.
#[test]
fn inputs_change_between_steps() {
    for event in ["", "[events.far]\nwhen = \"x - F\"\n"] {
        let system = Model::text(&format!("{CART}{event}")).unwrap().system(PC_POINCARE).unwrap();
        let solver = Solver::of(&system, &sharp());
        let drive = |from: f64, u: f64, time: f64| u + (from - u) * (-time).exp();
        let mut force = drive(1.0, 3.0, 0.7);
        assert!((solver.advance(0.7).1[2] - force).abs() < 1e-11);
        set(&system, 2, -5.0).unwrap();
        assert!((solver.advance(0.9).1[2] - drive(1.0, 3.0, 0.9)).abs() < 1e-11, "it has its own until then");
        force = drive(1.0, 3.0, 0.9);
        // SAFETY: live handles.
        call(|error| unsafe { pc_solver_take_parameters(solver.0, system.0, error) }).unwrap();
        assert_eq!(solver.time(), 0.9);
        assert!((solver.advance(2.0).1[2] - drive(force, -5.0, 1.1)).abs() < 1e-11);
    }
    let (system, other) = (Model::text(CART).unwrap().system(PC_POINCARE).unwrap(), System::of("rod"));
    let solver = Solver::of(&system, &sharp());
    // SAFETY: live handles.
    let refusal = call(|error| unsafe { pc_solver_take_parameters(solver.0, other.0, error) }).unwrap_err();
    assert!(refusal.message.starts_with("the parameters: "), "{}", refusal.message);
}

#[test]
fn an_input_with_a_table_is_not_set() {
    let text = CART.replace("u = 3", "u = { times = [0, 2], values = [0, 8] }");
    let system = Model::text(&text).unwrap().system(PC_POINCARE).unwrap();
    let refusal = set(&system, 2, 1.0).unwrap_err();
    assert_eq!(refusal.status, pc_status::PC_UNSUPPORTED);
    assert_eq!(system.at(pc_system_rhs, 0.5, &[0.0; 3], 3).unwrap(), [0.0, 0.0, 2.0]);
    // F' = 4 t − F, F_0 = 1: F = 4 t − 4 + 5 e^−t
    let force = Solver::of(&system, &sharp()).advance(2.0).1[2];
    assert!((force - 4.0 - 5.0 * (-2.0f64).exp()).abs() < 1e-11, "{force}");
}
