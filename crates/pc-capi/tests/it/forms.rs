//! Systems in all forms of their equations have the same motion, and derived quantities that fit
//! their state.

use crate::common::{self, Model, System, c, call, taken};
use pc::pc_form::*;
use pc::*;

fn give(model: &Model, name: &str, definition: &str) -> Result<(), common::Refusal> {
    let (name, definition) = (c(name), c(definition));
    // SAFETY: a live model and two texts.
    call(|error| unsafe { pc_model_give_quasi_velocity(model.0, name.as_ptr(), definition.as_ptr(), error) })
}

fn ask(model: &Model, name: &str) -> Result<(), common::Refusal> {
    let name = c(name);
    // SAFETY: a live model and a text.
    call(|error| unsafe { pc_model_add_independent(model.0, name.as_ptr(), error) })
}

fn names(system: &System) -> Vec<String> {
    (0..system.dim()).map(|i| system.name(i)).collect()
}

fn energy(system: &System) -> f64 {
    let (t, y) = system.start();
    let mut energy = f64::NAN;
    // SAFETY: a live system, its state, and a number.
    call(|error| unsafe { pc_system_energy(system.0, t, y.as_ptr(), y.len(), &raw mut energy, error) })
        .unwrap();
    energy
}

/// The residual M y' − r at the rates of the system, which should vanish.
fn residual(system: &System) -> f64 {
    let (t, y) = system.start();
    let rates = system.at(pc_system_rhs, t, &y, y.len()).unwrap();
    let mut residual = vec![f64::NAN; y.len()];
    // SAFETY: a live system, arrays as long as said.
    let evaluated = call(|error| unsafe {
        pc_system_residual(
            system.0,
            t,
            y.as_ptr(),
            y.len(),
            rates.as_ptr(),
            rates.len(),
            residual.as_mut_ptr(),
            residual.len(),
            error,
        )
    });
    evaluated.unwrap();
    residual.iter().fold(0.0, |worst, r| worst.max(r.abs()))
}

#[test]
fn all_forms_of_a_sleigh() {
    let model = Model::named("chaplygin-sleigh");
    give(&model, "p", "v + 2*ω").unwrap();
    let plain = model.system(PC_POINCARE).unwrap();
    let free = names(&plain)[3..].to_vec();
    for (form, state) in [
        (PC_REDUCED, free.clone()),
        (PC_LIE_POISSON, free.iter().map(|eta| format!("p_{eta}")).collect()),
        (PC_ORTHONORMAL, ["X", "Y", "φ", "η1", "η2"].map(str::to_owned).to_vec()),
    ] {
        let system = model.system(form).unwrap();
        assert_eq!(names(&system), state);
        assert!((energy(&system) - energy(&plain)).abs() < 1e-14);
        assert!(residual(&system) < 1e-14);
    }
    let hamel = model.system(PC_HAMEL).unwrap();
    assert!(names(&hamel).contains(&"p".to_owned()), "{:?}", names(&hamel));
    assert!((energy(&hamel) - energy(&plain)).abs() < 1e-13 && residual(&hamel) < 1e-13);
    let mut text = std::ptr::null_mut();
    // SAFETY: a live system and a place for a text.
    call(|error| unsafe { pc_system_print(hamel.0, 0, &raw mut text, error) }).unwrap();
    let text = taken(text);
    assert!(text.contains("Hamel's equations") && text.contains("  p = v + 2 ω\n"), "{text}");
}

#[test]
fn wrong_requests_are_refused() {
    let disk = Model::named("vertical-disk");
    let refusal = disk.system(PC_ORTHONORMAL).err().unwrap();
    assert!(format!("{refusal:?}").contains("held by multipliers"), "{refusal:?}");
    ask(&disk, "φ'").unwrap();
    let refusal = disk.system(PC_ORTHONORMAL).err().unwrap();
    assert!(format!("{refusal:?}").contains("the constraints leave 2 of"), "{refusal:?}");
    ask(&disk, "θ'").unwrap();
    let system = disk.system(PC_ORTHONORMAL).unwrap();
    assert_eq!(names(&system), ["X", "Y", "φ", "θ", "η1", "η2"]);
    assert!(residual(&system) < 1e-14);
    let sleigh = Model::named("chaplygin-sleigh");
    give(&sleigh, "t", "ω").unwrap();
    assert!(format!("{:?}", sleigh.system(PC_HAMEL).err().unwrap()).contains("reserved"));
}
