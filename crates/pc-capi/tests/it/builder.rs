//! A model built call by call is the same as that of a text.

use std::ptr;

use crate::common::{Model, System, c, call, taken};
use pc::*;

/// Calls a function of a model with texts.
macro_rules! say {
    ($model:expr, $function:ident $(, $text:expr)* $(; $number:expr)?) => {{
        // SAFETY: a live model, and texts that live as long as the call.
        call(|error| unsafe { $function($model.0, $(c($text).as_c_str().as_ptr(),)* $($number,)? error) })
    }};
}

fn empty(name: &str) -> Model {
    let (name, mut model) = (c(name), ptr::null_mut());
    // SAFETY: a text and a place for the handle.
    call(|error| unsafe { pc_model_new(name.as_ptr(), &raw mut model, error) }).unwrap();
    Model(model)
}

fn text(model: &Model) -> String {
    let mut text = ptr::null_mut();
    // SAFETY: a live model and a place for the text.
    call(|error| unsafe { pc_model_text(model.0, &raw mut text, error) }).unwrap();
    taken(text)
}

fn heavy_top() -> Model {
    let top = empty("A heavy top");
    for (name, value) in [("I1", 1.0), ("I2", 1.0), ("I3", 0.5), ("r3", 1.0), ("mg", 2.0)] {
        say!(top, pc_model_add_parameter, name; value).unwrap();
    }
    for (name, start) in [("γ1", 0.6), ("γ2", 0.0), ("γ3", 0.8)] {
        say!(top, pc_model_add_coordinate, name; start).unwrap();
    }
    for (name, start) in [("ω1", 0.1), ("ω2", -0.2), ("ω3", 3.0)] {
        let name = c(name);
        // SAFETY: a live model and texts.
        call(|error| unsafe { pc_model_add_quasi_velocity(top.0, name.as_ptr(), ptr::null(), start, error) })
            .unwrap();
    }
    say!(top, pc_model_set_algebra, "so3").unwrap();
    say!(top, pc_model_set_kinematics, "γ1", "γ2*ω3 - γ3*ω2").unwrap();
    say!(top, pc_model_set_kinematics, "γ2", "γ3*ω1 - γ1*ω3").unwrap();
    say!(top, pc_model_set_kinematics, "γ3", "γ1*ω2 - γ2*ω1").unwrap();
    say!(top, pc_model_set_kinetic, "(I1*ω1^2 + I2*ω2^2 + I3*ω3^2)/2").unwrap();
    say!(top, pc_model_set_potential, "mg*r3*γ3").unwrap();
    say!(top, pc_model_add_integral, "area", "I1*ω1*γ1 + I2*ω2*γ2 + I3*ω3*γ3").unwrap();
    say!(top, pc_model_set, "mg"; 1.0).unwrap();
    top
}

#[test]
fn the_heavy_top_is_that_of_the_text() {
    let (top, of_text) = (heavy_top(), System::of("heavy-top-lagrange"));
    say!(top, pc_model_check).unwrap();
    let system = top.system(pc_form::PC_POINCARE).unwrap();
    let (t, y) = system.start();
    assert_eq!((t, y.clone()), of_text.start());
    assert_eq!(system.at(pc_system_rhs, t, &y, 6), of_text.at(pc_system_rhs, t, &y, 6));
    let again = Model::text(&text(&top)).unwrap().system(pc_form::PC_POINCARE).unwrap();
    assert_eq!(system.at(pc_system_rhs, t, &y, 6), again.at(pc_system_rhs, t, &y, 6));
}

#[test]
fn every_kind_of_entry_reaches_the_text() {
    let sleigh = empty("A \"sleigh\"\\\n\u{7f}");
    say!(sleigh, pc_model_add_parameter, "m"; 1.0).unwrap();
    say!(sleigh, pc_model_add_definition, "a", "1/2").unwrap();
    for name in ["x", "y", "φ"] {
        say!(sleigh, pc_model_add_coordinate, name; 0.0).unwrap();
    }
    say!(sleigh, pc_model_add_quasi_velocity, "v", "cos(φ)*x' + sin(φ)*y'"; 0.5).unwrap();
    say!(sleigh, pc_model_add_quasi_velocity, "ω", "φ'"; 1.0).unwrap();
    say!(sleigh, pc_model_add_constraint, "blade", "-sin(φ)*x' + cos(φ)*y'").unwrap();
    let kinetic = "m/2*(x'^2 + y'^2) + m*a*ω*(cos(φ)*y' - sin(φ)*x') + (1 + m*a^2)/2*ω^2";
    say!(sleigh, pc_model_set_lagrangian, kinetic).unwrap();
    say!(sleigh, pc_model_set_dissipation, "v^2").unwrap();
    say!(sleigh, pc_model_add_force, "ω", "3").unwrap();
    say!(sleigh, pc_model_add_output, "speed", "abs(v)").unwrap();
    let system = sleigh.system(pc_form::PC_POINCARE).unwrap();
    // m v̇ = m a ω² − 2 v, (J + m a²) ω̇ = −m a v ω + 3.
    let rates = system.at(pc_system_rhs, 0.0, &[0.0, 0.0, 0.0, 0.5, 1.0], 5).unwrap();
    for (rate, expected) in rates.iter().zip([0.5, 0.0, 1.0, -0.5, (3.0 - 0.25) / 1.25]) {
        assert!((rate - expected).abs() < 1e-15, "{rates:?}");
    }
    let observed = system.at(pc_system_observe, 0.0, &[0.0, 0.0, 0.0, -0.5, 1.0], 2).unwrap();
    assert_eq!(observed[1], 0.5);
}

#[test]
fn brackets_are_those_of_the_algebra() {
    let body = empty("Euler's top");
    for name in ["p", "q", "r"] {
        let name = c(name);
        // SAFETY: a live model and texts.
        call(|error| unsafe { pc_model_add_quasi_velocity(body.0, name.as_ptr(), ptr::null(), 1.0, error) })
            .unwrap();
    }
    for (left, right, value) in [("p", "q", "r"), ("q", "r", "p"), ("r", "p", "q")] {
        say!(body, pc_model_set_bracket, left, right, value).unwrap();
    }
    say!(body, pc_model_set_kinetic, "(p^2 + 2*q^2 + 3*r^2)/2").unwrap();
    let system = body.system(pc_form::PC_POINCARE).unwrap();
    // Euler's equations: A ṗ = (B − C) q r and cyclically.
    let rates = system.at(pc_system_rhs, 0.0, &[1.0, 1.0, 1.0], 3).unwrap();
    for (rate, expected) in rates.iter().zip([-1.0, 1.0, -1.0 / 3.0]) {
        assert!((rate - expected).abs() < 1e-15, "{rates:?}");
    }
}

#[test]
fn errors_name_the_entry() {
    let top = heavy_top();
    say!(top, pc_model_set_potential, "mg*r4*γ3").unwrap();
    let refusal = top.system(pc_form::PC_POINCARE).err().unwrap();
    assert_eq!(refusal.status, pc_status::PC_INVALID_MODEL);
    assert!(refusal.message.contains("[lagrangian] potential: "), "{}", refusal.message);
    let line = text(&top).lines().nth(refusal.line - 1).unwrap().to_owned();
    assert_eq!(line, "\"potential\" = \"mg*r4*γ3\"");

    say!(top, pc_model_set_potential, "mg*r3*γ3").unwrap();
    say!(top, pc_model_add_coordinate, "γ1"; 1.0).unwrap();
    let refusal = say!(top, pc_model_check).unwrap_err();
    assert!(refusal.message.contains("γ1"), "{}", refusal.message);
    let refusal = say!(empty(""), pc_model_check).unwrap_err();
    assert_eq!(refusal.status, pc_status::PC_INVALID_MODEL);
    let unknown = say!(heavy_top(), pc_model_set, "mgl"; 1.0).unwrap_err();
    assert!(unknown.message.ends_with("its parameters are I1, I2, I3, r3, mg"), "{}", unknown.message);
}

/// A robot of the zoo is read as a file of its text would be, notes and all.
#[test]
fn a_robot_is_the_model_of_its_text() {
    let zoo = |name: &str| c(&format!("{}/../../tests/zoo/{name}.urdf", env!("CARGO_MANIFEST_DIR")));
    let read = |name: &str, fix_massless| {
        let (path, mut model) = (zoo(name), ptr::null_mut());
        // SAFETY: a text and a place for the handle.
        call(|error| unsafe { pc_model_from_robot(path.as_ptr(), 0, fix_massless, &raw mut model, error) })
            .map(|()| Model(model))
    };
    let arm = read("arm7_gripper", 0).unwrap();
    assert!(text(&arm).starts_with("# Made of the URDF file "));
    let system = arm.system(pc_form::PC_POINCARE).unwrap();
    assert_eq!(system.dim(), 2 * 8, "seven joints, and the finger that the other one follows");
    let refused = read("refused_massless_tip", 0).err().unwrap();
    assert_eq!(refused.status, pc_status::PC_INVALID_MODEL);
    assert!(refused.message.contains("refused_massless_tip.urdf:"), "{}", refused.message);
    read("refused_massless_tip", 1).unwrap();
}
