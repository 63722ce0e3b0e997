//! The analysis of motions, for C.

use std::ffi::{CString, c_char, c_int};
use std::ptr;

use crate::common::{Model, Refusal, System, c, call, taken};
use pc::pc_form::{PC_CANONICAL, PC_POINCARE};
use pc::pc_status::*;
use pc::*;

fn theory(system: &System, format: c_int, degree: usize, functions: &[&str]) -> Result<String, Refusal> {
    let texts: Vec<CString> = functions.iter().map(|function| c(function)).collect();
    let pointers: Vec<*const c_char> = texts.iter().map(|text| text.as_ptr()).collect();
    let mut text = ptr::null_mut();
    call(|error| unsafe {
        // SAFETY: a live system, texts that live as long as the call, and a place for a text.
        pc_system_theory(system.0, format, degree, pointers.as_ptr(), pointers.len(), &raw mut text, error)
    })?;
    Ok(taken(text))
}

const KEPLER: &str = "
[parameters]
k = 3.0
[coordinates]
x = 1.0
y = 0.2
[quasi_velocities]
\"y'\" = 1.1
[definitions]
r = \"sqrt(x^2 + y^2)\"
[lagrangian]
kinetic = \"(x'^2 + y'^2)/2\"
potential = \"-k/r\"
";

#[test]
fn integrals_are_found_with_the_functions_that_are_given() {
    for form in [PC_POINCARE, PC_CANONICAL] {
        let system = Model::text(KEPLER).unwrap().system(form).unwrap();
        let count = |functions: &[&str]| {
            theory(&system, 0, 2, functions).unwrap().matches("= const   (proved)").count()
        };
        assert_eq!((count(&[]), count(&["1/r"])), (2, 4), "energy, area, and the vector of Runge and Lenz");
    }
}

/// The library prints what `pc_print` prints.
#[test]
fn formats_are_those_of_the_equations() {
    let system = System::of("euler-top");
    let [text, latex, json] = [0, 1, 2].map(|format| theory(&system, format, 2, &[]).unwrap());
    let model = ::pc_model::Model::new(::pc_model::Builtin::named("euler-top").unwrap().document().unwrap());
    let graph = model.graph();
    let assembly = model.assemble(&graph).unwrap();
    let theory = pc_print::Theory::of(&model, &assembly, &pc_print::TheoryOptions::default()).unwrap();
    let pages = [pc_print::Page::Text, pc_print::Page::Latex, pc_print::Page::Json];
    assert_eq!([text, latex, json], pages.map(|page| theory.printed(page)));
}

#[test]
fn an_action_set_by_calls_is_checked() {
    let (name, mut model) = (c("A free particle"), ptr::null_mut());
    // SAFETY: a text and a place for the handle.
    call(|error| unsafe { pc_model_new(name.as_ptr(), &raw mut model, error) }).unwrap();
    let model = Model(model);
    let [x, kinetic, action, a] = ["x", "x'^2/2", "a*x - a^2*t/2", "a"].map(c);
    // SAFETY: a live model and texts.
    unsafe {
        call(|error| pc_model_add_coordinate(model.0, x.as_ptr(), 1.0, error)).unwrap();
        call(|error| pc_model_set_kinetic(model.0, kinetic.as_ptr(), error)).unwrap();
        call(|error| pc_model_set_action(model.0, action.as_ptr(), error)).unwrap();
        call(|error| pc_model_add_action_constant(model.0, a.as_ptr(), 0.5, error)).unwrap();
    }
    let said = theory(&model.system(PC_POINCARE).unwrap(), 0, 1, &[]).unwrap();
    assert!(said.contains("action: S = x a - ½ t a²   (proved)") && said.contains("complete: "), "{said}");
    assert!(said.contains("Jacobi's theorem: ∂S/∂a = x - t a"), "{said}");
}

/// Whether the functions are canonical variables, as text.
fn canonical_variables(system: &System, proposed: &[(&str, &str)]) -> Result<String, Refusal> {
    let [names, functions] = [0, 1].map(|part: usize| -> Vec<CString> {
        proposed.iter().map(|new| c(if part == 0 { new.0 } else { new.1 })).collect()
    });
    let pointers =
        |texts: &[CString]| -> Vec<*const c_char> { texts.iter().map(|text| text.as_ptr()).collect() };
    let (names, functions) = (pointers(&names), pointers(&functions));
    let mut text = ptr::null_mut();
    call(|error| unsafe {
        // SAFETY: a live system, texts that live as long as the call, and a place for a text.
        pc_system_canonical_variables(
            system.0,
            0,
            names.as_ptr(),
            functions.as_ptr(),
            names.len(),
            &raw mut text,
            error,
        )
    })?;
    Ok(taken(text))
}

#[test]
fn functions_are_tested_as_canonical_variables() {
    let system = Model::text(KEPLER).unwrap().system(PC_POINCARE).unwrap();
    let polar = [("R", "r"), ("Φ", "atan2(y, x)"), ("P", "(x*p_x + y*p_y)/r"), ("L", "x*p_y - y*p_x")];
    let said = canonical_variables(&system, &polar).unwrap();
    assert!(said.contains("canonical proved: (X_i, Y_j) = δ_ij, all others zero"), "{said}");
    let said = canonical_variables(&system, &[("X", "x^2"), ("Y", "p_x")]).unwrap();
    assert!(said.contains("(X, Y) = 2 x   (canonical disproved)"), "{said}");
    let odd = canonical_variables(&system, &polar[..3]).unwrap_err();
    assert!(odd.message.contains("as many coordinates as momenta"), "{}", odd.message);
}

#[test]
fn senseless_requests_are_refused() {
    let system = System::of("euler-top");
    for (format, degree, functions, status, message) in [
        (3, 2, [].as_slice(), PC_INVALID_ARGUMENT, "3 is not a value of pc_format"),
        (0, 0, &[], PC_INVALID_ARGUMENT, "0 is not a value of degree"),
        (0, 7, &[], PC_INVALID_ARGUMENT, "7 is not a value of degree"),
        (0, 2, &["1/q"], PC_INVALID_MODEL, "`q`"),
    ] {
        let refusal = theory(&system, format, degree, functions).unwrap_err();
        assert!(refusal.status == status && refusal.message.contains(message), "{}", refusal.message);
    }
}

#[test]
fn the_theory_stays_within_the_limits() {
    let options = pc_system_options { memory_limit: 1 << 20, ..Default::default() };
    let model = Model::named("heavy-top-euler");
    let mut system = ptr::null_mut();
    // SAFETY: a live model, options and a place for the handle.
    call(|error| unsafe { pc_system_new(model.0, &raw const options, &raw mut system, error) }).unwrap();
    let refusal = theory(&System(system), 0, 2, &[]).unwrap_err();
    assert_eq!(refusal.status, PC_LIMIT, "{}", refusal.message);
}
