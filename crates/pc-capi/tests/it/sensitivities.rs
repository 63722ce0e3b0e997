//! Sensitivities of the motions of models, with events, from C.

use std::ptr;

use crate::common::ball::{G, bounces};
use crate::common::{Model, Refusal, Solver, System, call, sharp};
use pc::pc_status::*;
use pc::*;

fn differentiated(name: &str, form: pc_form) -> System {
    let model = Model::named(name);
    // SAFETY: a live handle, and arrays as long as said.
    call(|error| unsafe { pc_model_differentiate(model.0, 1, error) }).unwrap();
    model.system(form).unwrap()
}

fn add(solver: &Solver, parameter: usize, start: &[f64]) -> Result<(), Refusal> {
    let data = if start.is_empty() { ptr::null() } else { start.as_ptr() };
    // SAFETY: a live handle, and arrays as long as said.
    call(|error| unsafe { pc_solver_add_sensitivity(solver.0, parameter, data, start.len(), error) })
}

fn column(solver: &Solver, number: usize, dim: usize) -> Result<Vec<f64>, Refusal> {
    let mut column = vec![f64::NAN; dim];
    let (data, len) = (column.as_mut_ptr(), column.len());
    // SAFETY: a live handle, and arrays as long as said.
    call(|error| unsafe { pc_solver_sensitivity(solver.0, number, data, len, error) }).map(|()| column)
}

fn start_by(system: &System, parameter: usize) -> Result<Vec<f64>, Refusal> {
    let mut column = vec![f64::NAN; system.dim()];
    let (data, len) = (column.as_mut_ptr(), column.len());
    // SAFETY: a live handle, and arrays as long as said.
    call(|error| unsafe { pc_system_start_by_parameter(system.0, parameter, data, len, error) })
        .map(|()| column)
}

/// The built-in ball, with m, g, e, h: after n bounces from height h, at a time s after the last, y
/// = eⁿ w s − g s²/2 with w = √(2gh). The derivative by h of a time t is t/2h, that of the speed w
/// is w/2h.
#[test]
fn a_bouncing_ball_by_its_height() {
    for form in [pc_form::PC_POINCARE, pc_form::PC_CANONICAL] {
        let has_momenta = matches!(form, pc_form::PC_CANONICAL);
        let system = differentiated("bouncing-ball", form);
        let start = start_by(&system, 3).unwrap();
        assert!((start[0] - 1.0).abs() < 1e-9 && start[1] == 0.0, "{start:?}");
        let solver = Solver::of(&system, &sharp());
        add(&solver, 0, &[]).unwrap();
        add(&solver, 3, &start).unwrap();
        let t = 2.5;
        solver.advance(t).0.unwrap();
        let times = bounces(0.8, t);
        let (n, last) = (i32::try_from(times.len()).unwrap(), *times.last().unwrap());
        assert!(n > 3);
        let (speed, s) = (0.8_f64.powi(n) * (2.0 * G).sqrt(), t - last);
        let (by_speed, by_s) = (speed / 2.0, -last / 2.0);
        let expected = [by_speed * s + speed * by_s - G * s * by_s, by_speed - G * by_s];
        let found = column(&solver, 1, 2).unwrap();
        for (found, expected) in found.iter().zip(expected) {
            // The error of ∂y₀/∂h, a quotient with ten correct digits, grows by 1/e at each bounce.
            assert!((found - expected).abs() < 1e-7 * expected.abs().max(1.0), "{found} is not {expected}");
        }
        let by_mass = column(&solver, 0, 2).unwrap();
        // The momentum is m v.
        let v = if has_momenta { solver.state()[1] } else { 0.0 };
        assert!(by_mass[0].abs() < 1e-7 && (by_mass[1] - v).abs() < 1e-7, "{by_mass:?} {v}");
    }
}

#[test]
fn sensitivities_that_do_not_exist_are_refused() {
    let system = differentiated("bouncing-ball", pc_form::PC_POINCARE);
    let solver = Solver::of(&system, &sharp());
    let refusal = column(&solver, 0, 2).unwrap_err();
    assert_eq!(
        (refusal.status, refusal.message.as_str()),
        (PC_INVALID_ARGUMENT, "sensitivity: index 0 is not below 0")
    );
    assert_eq!(add(&solver, 4, &[]).unwrap_err().status, PC_INVALID_ARGUMENT);
    assert_eq!(add(&solver, 1, &[0.0]).unwrap_err().status, PC_INVALID_ARGUMENT);
    assert_eq!(start_by(&system, 4).unwrap_err().status, PC_INVALID_ARGUMENT);
    // The refused calls have changed nothing.
    add(&solver, 1, &[]).unwrap();
    column(&solver, 0, 2).unwrap();
    assert!(column(&solver, 1, 2).is_err());
    solver.advance(0.1).0.unwrap();
    let refusal = add(&solver, 1, &[]).unwrap_err();
    assert_eq!(refusal.message, "a sensitivity must come before the first step, and one has been taken");
    // SAFETY: a live handle, and arrays as long as said.
    let refusal = call(|error| unsafe { pc_solver_take_parameters(solver.0, system.0, error) }).unwrap_err();
    assert_eq!(refusal.status, PC_UNSUPPORTED);

    let plain = Solver::of(&System::of("bouncing-ball"), &sharp());
    let refusal = add(&plain, 1, &[]).unwrap_err();
    assert_eq!(refusal.status, PC_INVALID_ARGUMENT);
    assert!(refusal.message.contains("parameters"), "{}", refusal.message);

    let followed = Model::text(
        "[parameters]\na = 1.0\nb = \"2*a\"\n[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"b*x'^2/2\"\n",
    )
    .unwrap();
    // SAFETY: a live handle, and arrays as long as said.
    call(|error| unsafe { pc_model_differentiate(followed.0, 1, error) }).unwrap();
    let refusal = start_by(&followed.system(pc_form::PC_POINCARE).unwrap(), 0).unwrap_err();
    assert_eq!((refusal.status, refusal.line), (PC_INCONSISTENT_MODEL, 2));
}

/// A pulse on a body at rest: the counts show that steps were shortened for it, if the caller's
/// structure has the member.
#[test]
fn statistics_tell_what_shortened_the_steps() {
    let model = Model::text(
        "[coordinates]\nx = 0.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n[forces]\nx = \"exp(-((t - 5)/0.02)^2)\"\n",
    )
    .unwrap();
    let system = model.system(pc_form::PC_POINCARE).unwrap();
    let solver = Solver::of(&system, &sharp());
    solver.advance(10.0).0.unwrap();
    let mut work = pc_statistics::default();
    let read = |work: &mut pc_statistics, size| {
        // SAFETY: a live handle, and arrays as long as said.
        call(|error| unsafe { pc_solver_statistics(solver.0, work, size, error) }).unwrap();
    };
    read(&mut work, size_of::<pc_statistics>());
    assert!(work.limited_steps > 0 && work.limited_steps <= work.steps, "{work:?}");
    let mut older = pc_statistics { limited_steps: 7, ..pc_statistics::default() };
    read(&mut older, std::mem::offset_of!(pc_statistics, limited_steps));
    assert_eq!((older.steps, older.limited_steps), (work.steps, 7));
}
