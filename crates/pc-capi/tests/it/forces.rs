//! Forces by functions of the program, compared with the same forces in the text.

use std::ffi::CStr;
use std::ptr;
use std::sync::atomic::Ordering::SeqCst;

use crate::common::{At, Model, Refusal, System, c, call, taken};
use crate::laws::{
    Law, Write, advance, assert_close, constant, count, declare, forced, solver, text_of, written,
};
use pc::pc_form::{PC_CANONICAL, PC_POINCARE};
use pc::pc_status::*;
use pc::*;

/// A few dozen roundings of numbers of order ten.
const ROUNDING: f64 = 1e-12;
/// √ε times curvatures of order ten: the error of difference quotients.
const QUOTIENT: f64 = 1e-6;

/// A model, the form, the forces in the text, and the same forces as a function.
type Case = (&'static str, pc_form, &'static [(&'static str, &'static str)], Write);

fn cases() -> Vec<Case> {
    vec![
        ("pendulum", PC_POINCARE, &[("θ", "cos(t)*θ' - 3*sin(θ)")], |t, y, q, _| {
            q[0] = t.cos() * y[1] - 3.0 * y[0].sin();
            0
        }),
        // p = 4 θ'
        ("pendulum", PC_CANONICAL, &[("θ", "cos(t)*θ' - 3*sin(θ)")], |t, y, q, _| {
            q[0] = t.cos() * y[1] / 4.0 - 3.0 * y[0].sin();
            0
        }),
        // Constraints make quasi-velocities vanish; the state is X, Y, ψ, θ, φ, ω1, ω2, ω3.
        ("tilted-disk", PC_POINCARE, &[("ω3", "θ - ω3/8"), ("ω1", "ω2*sin(t)")], |t, y, q, _| {
            q.copy_from_slice(&[y[3] - y[7] / 8.0, y[6] * t.sin()]);
            0
        }),
        ("tilted-disk", PC_CANONICAL, &[("ω3", "θ"), ("ω1", "sin(ψ)")], |_, y, q, _| {
            q.copy_from_slice(&[y[3], y[2].sin()]);
            0
        }),
        // Multipliers; the state is X, Y, φ, θ and their velocities.
        ("vertical-disk", PC_POINCARE, &[("θ", "cos(φ)"), ("φ", "1 - φ'"), ("X", "Y'")], |_, y, q, _| {
            q.copy_from_slice(&[y[2].cos(), 1.0 - y[6], y[5]]);
            0
        }),
        ("vertical-disk", PC_CANONICAL, &[("θ", "cos(φ)"), ("X", "Y")], |_, y, q, _| {
            q.copy_from_slice(&[y[2].cos(), y[1]]);
            0
        }),
        ("rod", PC_POINCARE, &[("y", "z*x'"), ("x", "1")], |_, y, q, _| {
            q.copy_from_slice(&[y[2] * y[3], 1.0]);
            0
        }),
    ]
}

fn label(&(name, ref form, ..): &Case) -> String {
    format!("{name} in form {}", if matches!(form, PC_POINCARE) { "poincare" } else { "canonical" })
}

/// The same forces, as a function and in the text.
fn pair(&(name, ref form, forces, write): &Case) -> (System, System, Law) {
    let on: Vec<&str> = forces.iter().map(|&(on, _)| on).collect();
    let form = || if matches!(form, PC_POINCARE) { PC_POINCARE } else { PC_CANONICAL };
    (forced(name, &on, form()), written(name, forces, form()), Law::new(write))
}

/// Reactions, outputs and all else that contains accelerations depend on the forces too.
#[test]
fn a_force_of_a_function_is_that_of_the_text() {
    for case in &cases() {
        let ((system, text, law), what) = (pair(case), label(case));
        law.set(&system).unwrap();
        let (t, mut y) = text.start();
        assert_eq!((t, &y), (system.start().0, &system.start().1), "{what}");
        let t = t + 0.7;
        y.iter_mut().enumerate().for_each(|(i, y)| *y += 0.01 * (i as f64 + 1.0));
        let n = y.len();
        let observables = count(&text, pc_system_observable_count);
        assert_eq!(observables, count(&system, pc_system_observable_count), "{what}");
        let reactions = count(&text, pc_system_reaction_count);
        let mut functions: Vec<(At, usize)> = vec![(pc_system_rhs, n), (pc_system_observe, observables)];
        if reactions > 0 {
            functions.push((pc_system_reactions, reactions));
        }
        for (function, length) in functions {
            let (found, expected) = (system.at(function, t, &y, length), text.at(function, t, &y, length));
            assert_close(&found.unwrap(), &expected.unwrap(), ROUNDING, &what);
        }
        let jacobian = system.at(pc_system_jacobian, t, &y, n * n).unwrap();
        assert_close(&jacobian, &text.at(pc_system_jacobian, t, &y, n * n).unwrap(), QUOTIENT, &what);
        // The pattern is full, and the product is the sum of the columns.
        assert_eq!(jacobian, system.at(pc_system_sparse_jacobian, t, &y, n * n).unwrap(), "{what}");
        let (v, mut product) = (vec![1.0; n], vec![0.0; n]);
        call(|error| unsafe {
            // SAFETY: a live system and arrays as said.
            pc_system_jvp(system.0, t, y.as_ptr(), n, v.as_ptr(), n, product.as_mut_ptr(), n, error)
        })
        .unwrap();
        let sums: Vec<f64> = (0..n).map(|i| (0..n).map(|j| jacobian[i + j * n]).sum()).collect();
        assert_close(&product, &sums, ROUNDING, &what);
        // The residual of the rates vanishes.
        let (rates, mut residual) = (system.at(pc_system_rhs, t, &y, n).unwrap(), vec![1.0; n]);
        call(|error| unsafe {
            // SAFETY: a live system and arrays as said.
            pc_system_residual(system.0, t, y.as_ptr(), n, rates.as_ptr(), n, residual.as_mut_ptr(), n, error)
        })
        .unwrap();
        assert_close(&residual, &vec![0.0; n], ROUNDING, &what);
        drop(system);
        assert_eq!(law.destroyed(), 1);
    }
}

#[test]
fn integrations_agree_and_states_stay_projected() {
    for case in &cases() {
        for method in [pc_method::PC_ADAMS, pc_method::PC_BDF] {
            let ((system, text, law), what) = (pair(case), label(case));
            law.set(&system).unwrap();
            let n = system.dim();
            let ends = [&system, &text].map(|system| {
                let solver = solver(
                    system,
                    if matches!(method, pc_method::PC_ADAMS) {
                        pc_method::PC_ADAMS
                    } else {
                        pc_method::PC_BDF
                    },
                )
                .unwrap();
                let end = advance(solver, 1.0, n).unwrap();
                // SAFETY: ours, freed once.
                unsafe { pc_solver_free(solver) };
                end
            });
            // Both have the errors of tolerances of 1e-10 in a few hundred steps.
            assert_close(&ends[0], &ends[1], 1e-7, &what);
        }
    }
}

/// ∂q/∂y of a function is used as it is, whole or not at all.
#[test]
fn derivatives_are_those_of_the_function() {
    let jacobian = |slopes: Write| {
        let system = forced("pendulum", &["θ"], PC_POINCARE);
        let mut law = Law::new(|t, y, q, _| {
            q[0] = t.cos() * y[1] - 3.0 * y[0].sin();
            0
        });
        law.slopes = Some(slopes);
        law.set(&system).unwrap();
        let outcome = system.at(pc_system_jacobian, 0.7, &[0.4, -0.3], 4);
        assert_eq!(law.calls.load(SeqCst), 1); // the force itself, no quotients
        outcome
    };
    let expected = written("pendulum", &[("θ", "cos(t)*θ' - 3*sin(θ)")], PC_POINCARE);
    let expected = expected.at(pc_system_jacobian, 0.7, &[0.4, -0.3], 4).unwrap();
    let exact = jacobian(|t, y, dq, _| {
        dq.copy_from_slice(&[-3.0 * y[0].cos(), t.cos()]);
        0
    });
    assert_close(&exact.unwrap(), &expected, 1e-15, "exact");
    let refusal = jacobian(|_, _, dq, _| {
        dq[0] = 1.0; // the other entries stay unwritten
        0
    });
    let refusal = refusal.unwrap_err();
    assert_eq!(refusal.status, PC_EVALUATION);
    let expected = "the derivative by `θ'` of the external force on `θ'` is NaN at t = 0.7";
    assert!(refusal.message.starts_with(expected), "{}", refusal.message);
    let refusal = jacobian(|_, _, _, _| -3).unwrap_err();
    assert!(refusal.message.ends_with("the function of its derivatives returned -3"), "{}", refusal.message);
}

#[test]
fn without_a_force_function_rates_fail_but_the_energy_is_known() {
    let system = forced("tilted-disk", &["ω3"], PC_POINCARE);
    let (t, y) = system.start();
    let said = "the external force on `ω3` failed at t = 0: no function has been set for it; pc_system_set_force sets one";
    for (function, length) in [(pc_system_rhs as At, 8), (pc_system_jacobian, 64), (pc_system_reactions, 2)] {
        let refusal = system.at(function, t, &y, length).unwrap_err();
        assert_eq!((refusal.status, refusal.message.as_str()), (PC_EVALUATION, said));
    }
    let text = Model::text(&text_of("tilted-disk")).unwrap().system(PC_POINCARE).unwrap();
    let energy = |system: &System| {
        let mut energy = 0.0;
        // SAFETY: a live system and arrays as said.
        call(|error| unsafe { pc_system_energy(system.0, t, y.as_ptr(), y.len(), &raw mut energy, error) })
            .unwrap();
        energy
    };
    assert_eq!(energy(&system), energy(&text));
    system.at(pc_system_mass_matrix, t, &y, 9).unwrap();
    let refusal = solver(&system, pc_method::PC_ADAMS).and_then(|solver| {
        let outcome = advance(solver, 1.0, 8);
        // SAFETY: ours, freed once.
        unsafe { pc_solver_free(solver) };
        outcome
    });
    let refusal = refusal.unwrap_err();
    assert_eq!(refusal.status, PC_INTEGRATION);
    assert!(refusal.message.ends_with(said), "{}", refusal.message);
    let mut kernel = ptr::null_mut();
    let mut ydot = [0.0; 8];
    // SAFETY: a live system, a place for the kernel, arrays of its dimension; freed once.
    unsafe {
        call(|error| pc_kernel_new(system.0, &raw mut kernel, error)).unwrap();
        assert_eq!(pc_kernel_rhs(t, y.as_ptr(), ydot.as_mut_ptr(), kernel.cast()), -1);
        pc_kernel_free(kernel);
    }
}

#[test]
fn names_and_numbers_of_the_forces_are_known() {
    let system = forced("vertical-disk", &["φ", "X", "φ"], PC_POINCARE);
    // SAFETY: a live system, or null.
    unsafe {
        assert_eq!(pc_system_force_count(system.0.as_ref()), 2);
        let name = |i| CStr::from_ptr(pc_system_force_name(system.0.as_ref(), i)).to_str().unwrap();
        assert_eq!([name(0), name(1)], ["φ'", "X'"]);
        assert!(
            pc_system_force_name(system.0.as_ref(), 2).is_null() && pc_system_force_name(None, 0).is_null()
        );
        assert_eq!(pc_system_force_count(None), 0);
        assert_eq!(pc_system_parameter_count(system.0.as_ref()), 4); // forces are no parameters
    }
    let model = Model::text(&text_of("tilted-disk")).unwrap();
    declare(&model, &["u2"]);
    let said = "no external force can act on `u2`; one can on ω1, ω2, ω3, u, v";
    // SAFETY: a live model.
    let refusal = call(|error| unsafe { pc_model_check(model.0, error) }).unwrap_err();
    assert_eq!((refusal.status, refusal.message.as_str()), (PC_NOT_FOUND, said));
    assert_eq!(model.system(PC_POINCARE).err().unwrap().status, PC_NOT_FOUND);
    for (model, on) in [(ptr::null_mut(), c("u")), (model.0, c("u"))] {
        let on = if model.is_null() { on.as_ptr() } else { ptr::null() };
        // SAFETY: a live model or null, a text or null.
        let refusal = call(|error| unsafe { pc_model_add_external_force(model, on, error) }).unwrap_err();
        assert_eq!(refusal.status, PC_INVALID_ARGUMENT);
    }
}

/// As the rates are called, and as forces of the text are: by the velocity or by its coordinate.
#[test]
fn a_force_on_a_velocity_is_one_on_its_coordinate() {
    let name_of = |on: &[&str]| {
        let model = Model::text(&text_of("pendulum")).unwrap();
        declare(&model, on);
        let system = model.system(PC_POINCARE).unwrap();
        // SAFETY: a live system, whose names are text.
        unsafe {
            assert_eq!(pc_system_force_count(system.0.as_ref()), 1);
            CStr::from_ptr(pc_system_force_name(system.0.as_ref(), 0)).to_str().unwrap().to_owned()
        }
    };
    for on in [&["θ"][..], &["θ'"], &["θ", "θ'"]] {
        assert_eq!(name_of(on), "θ'");
    }
    let model = Model::text(&text_of("pendulum")).unwrap();
    declare(&model, &["θ''"]);
    // SAFETY: a live model.
    let refusal = call(|error| unsafe { pc_model_check(model.0, error) }).unwrap_err();
    assert_eq!(refusal.message, "no external force can act on `θ''`; one can on θ'");
}

const TWO_SPRINGS: &str = "
[coordinates]
x = 1.0
y = 0.0
[quasi_velocities]
\"y'\" = 1.0
[lagrangian]
kinetic = \"(x'^2 + y'^2)/2\"
potential = \"(x^2 + y^2)/2\"
[integrals]
area = \"x*y' - y*x'\"
along = \"x'*x' + x*x\"
";

/// The springs with a kept integral and a force.
fn keeping(integral: &str, on: &str) -> Result<System, Refusal> {
    let (model, name) = (Model::text(TWO_SPRINGS).unwrap(), c(integral));
    declare(&model, &[on]);
    // SAFETY: a live model and a text.
    call(|error| unsafe { pc_model_keep(model.0, name.as_ptr(), error) }).unwrap();
    model.system(PC_POINCARE)
}

#[test]
fn only_integrals_that_forces_do_not_change_are_kept() {
    for (kept, on) in [("energy", "x"), ("area", "y"), ("along", "x")] {
        let refusal = keeping(kept, on).err().unwrap();
        assert!(refusal.message.contains(kept), "{}", refusal.message);
    }
    let (system, law) = (keeping("along", "y").unwrap(), Law::new(constant));
    law.set(&system).unwrap();
    // From another start, the value there is kept to rounding, far better than the tolerance.
    let (mut solver, y, mut options) =
        (ptr::null_mut(), [0.3, 0.0, 0.4, 0.0], std::mem::MaybeUninit::uninit());
    call(|error| unsafe {
        // SAFETY: a live system, options set up by the library, a place for the solver.
        pc_solver_options_init(options.as_mut_ptr(), size_of::<pc_solver_options>());
        (*options.as_mut_ptr()).relative_tolerance = 1e-5;
        pc_solver_new(system.0, options.as_ptr(), 0.0, y.as_ptr(), 4, &raw mut solver, error)
    })
    .unwrap();
    let end = advance(solver, 20.0, 4).unwrap();
    let along = system.at(pc_system_observe, 20.0, &end, 3).unwrap()[1];
    // The integral is kept at the ends of steps; interpolation between them has the error of a
    // step.
    assert!((along - 0.25).abs() < 1e-5, "{along}");
    // SAFETY: ours, freed once.
    unsafe { pc_solver_free(solver) };
}

#[test]
fn the_source_takes_forces_as_parameters() {
    let system = forced("pendulum", &["θ"], PC_POINCARE);
    let (name, mut header, mut source) = (c("pendulum"), ptr::null_mut(), ptr::null_mut());
    call(|error| unsafe {
        // SAFETY: a live system, a text, places for texts.
        pc_system_emit_c(system.0, name.as_ptr(), f64::NAN, &raw mut header, &raw mut source, error)
    })
    .unwrap();
    let (header, source) = (taken(header), taken(source));
    assert!(header.contains("Q_θ'"), "{header}");
    assert!(source.contains("Q_theta"), "{source}");
}

/// Forces computed outside are 0 where a system is compared with a second derivation, under constraints of each kind.
#[test]
fn external_forces_are_zero_where_a_system_is_verified() {
    let mass = "[coordinates]\nx = 0.5\n[lagrangian]\nkinetic = \"x'^2/2\"\n";
    let cases: [(Model, &[&str]); 4] = [
        (Model::text(mass).unwrap(), &["x"]),
        (Model::named("tilted-disk"), &["ω1", "ω3"]),
        (Model::named("vertical-disk"), &["θ", "X"]),
        (Model::named("rod"), &["x", "y"]),
    ];
    for (model, on) in cases {
        declare(&model, on);
        let system = model.system(PC_POINCARE).unwrap();
        let mut text = ptr::null_mut();
        // SAFETY: a live system, and a text that is freed once.
        let said = unsafe {
            call(|error| pc_system_verify(system.0, 10, &raw mut text, error)).unwrap();
            let said = CStr::from_ptr(text).to_str().unwrap().to_owned();
            pc_string_free(text);
            said
        };
        assert!(said.starts_with("agrees to "), "{said}");
        let left_out = |on: &&str| said.contains(&format!("not compared: the force on {on}"));
        assert!(on.iter().all(left_out), "{said}");
    }
}
