//! The numbers are those of the crates below.

use std::ffi::{CStr, c_int, c_void};
use std::ptr;

use crate::common::{Model, ROD, System, c, call, stopped, taken};
use ::pc_model::{Document, Source};
use pc::*;
use pc_mech::{Graph, Motion, VectorField};

/// The same model without C.
fn motion(name: &str) -> (Motion, f64, Vec<f64>) {
    let builtin = || ::pc_model::Builtin::named(name).unwrap().document();
    let rod = || Document::parse(Source::new("rod", ROD));
    let model = ::pc_model::Model::new(if name == "rod" { rod() } else { builtin() }.unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let (motion, start) = model.compile(&assembly).unwrap();
    (motion, assembly.t_start, start)
}

/// Free, with redundant coordinates, with vanishing quasi-velocities, with multipliers, rheonomic,
/// with L not quadratic, with bodies on joints, and with loops.
const MODELS: [&str; 11] = [
    "heavy-top-lagrange",
    "euler-top",
    "chaplygin-sleigh",
    "spherical-pendulum-cartesian",
    "voronets-rheonomic",
    "relativistic-particle",
    "toda-chain",
    "rod",
    "puma-560",
    "satellite",
    "four-bar-loop",
];

#[test]
fn rates_and_jacobians_are_those_of_the_motion_to_the_last_bit() {
    for name in MODELS {
        let (system, (mut motion, t, start)) = (System::of(name), motion(name));
        let dim = start.len();
        assert_eq!(system.start(), (t, start.clone()), "{name}");
        assert_eq!((0..dim).map(|i| system.name(i)).collect::<Vec<_>>(), motion.names());
        let mut rates = vec![0.0; dim];
        motion.rhs(t, &start, &mut rates).unwrap();
        assert_eq!(system.at(pc_system_rhs, t, &start, dim), Ok(rates));
        let mut jacobian = vec![0.0; dim * dim];
        motion.jacobian(t, &start, &mut jacobian).unwrap();
        assert_eq!(system.at(pc_system_jacobian, t, &start, dim * dim), Ok(jacobian.clone()));
        let observed = motion.observe(t, &start);
        assert_eq!(system.at(pc_system_observe, t, &start, observed.len()), Ok(observed.clone()));
        let mut energy = 0.0;
        call(|error| unsafe {
            // SAFETY: a live system and places as said.
            pc_system_energy(system.0, t, start.as_ptr(), dim, &raw mut energy, error)
        })
        .unwrap();
        assert_eq!(energy, observed[motion.conserved_len() - 1]);

        // The same by the pattern, and in a direction: sums of at most dim terms, in a different
        // order.
        let (mut entries, mut starts, mut rows) = (0, ptr::null(), ptr::null());
        let pattern = call(|error| unsafe {
            // SAFETY: a live system and places for results.
            pc_system_jacobian_pattern(system.0, &raw mut entries, &raw mut starts, &raw mut rows, error)
        });
        pattern.unwrap();
        // SAFETY: as many numbers as documented, of the live system.
        let (starts, rows) = unsafe {
            (std::slice::from_raw_parts(starts, dim + 1), std::slice::from_raw_parts(rows, entries))
        };
        let values = system.at(pc_system_sparse_jacobian, t, &start, entries).unwrap();
        let v: Vec<f64> = (0..dim).map(|i| (i as f64 + 1.0).sin()).collect();
        let (mut dense, mut expected) = (vec![0.0; dim * dim], vec![0.0; dim]);
        for j in 0..dim {
            for e in starts[j]..starts[j + 1] {
                dense[rows[e] + j * dim] = values[e];
            }
            for i in 0..dim {
                expected[i] += jacobian[i + j * dim] * v[j];
            }
        }
        assert_eq!(dense, jacobian, "{name}");
        let mut product = vec![0.0; dim];
        // SAFETY: a live system, and places for results as said.
        call(|error| unsafe {
            let (y, v, out) = (start.as_ptr(), v.as_ptr(), product.as_mut_ptr());
            // SAFETY: a live system and arrays as said.
            pc_system_jvp(system.0, t, y, dim, v, dim, out, dim, error)
        })
        .unwrap();
        for (product, expected) in product.iter().zip(&expected) {
            assert!((product - expected).abs() <= 1e-14 * (1.0 + expected.abs()), "{name}");
        }
    }
}

#[test]
fn a_kernel_is_the_right_hand_side() {
    let system = System::of("heavy-top-lagrange");
    let ((t, y), dim) = (system.start(), system.dim());
    let mut kernel = ptr::null_mut();
    // SAFETY: a live system and places for results; the kernel is freed once.
    unsafe {
        call(|error| pc_kernel_new(system.0, &raw mut kernel, error)).unwrap();
        assert_eq!(pc_kernel_dim(kernel.as_ref()), dim);
        let mut ydot = vec![0.0; dim];
        assert_eq!(pc_kernel_rhs(t, y.as_ptr(), ydot.as_mut_ptr(), kernel.cast()), 0);
        assert_eq!(system.at(pc_system_rhs, t, &y, dim), Ok(ydot.clone()));
        let mut jacobian = vec![0.0; dim * dim];
        assert_eq!(pc_kernel_jacobian(t, y.as_ptr(), jacobian.as_mut_ptr(), kernel.cast()), 0);
        assert_eq!(system.at(pc_system_jacobian, t, &y, dim * dim), Ok(jacobian));

        let nan = vec![f64::NAN; dim];
        assert_eq!(pc_kernel_rhs(t, nan.as_ptr(), ydot.as_mut_ptr(), kernel.cast()), 1);
        let in_place = ydot.as_mut_ptr();
        assert_eq!(pc_kernel_rhs(t, in_place, in_place, kernel.cast()), -1);
        assert_eq!(pc_kernel_rhs(t, y.as_ptr(), in_place, ptr::null_mut()), -1);
        pc_kernel_free(kernel);
    }
}

#[test]
fn the_integration_is_that_of_the_solver_below() {
    for name in ["heavy-top-lagrange", "rod"] {
        let (system, (motion, t, start)) = (System::of(name), motion(name));
        let times = [1.0, 2.0, 5.0];
        let adams = pc_solve::Options::new(pc_solve::Method::Adams);
        let mut expected = pc_solve::Integration::new(motion, t, &start, &adams).unwrap();
        let options = pc_solver_options { method: pc_method::PC_ADAMS as c_int, ..Default::default() };
        let mut solver = ptr::null_mut();
        // SAFETY: live handles, arrays as said; the solver is freed once.
        unsafe {
            let new = |error| {
                pc_solver_new(system.0, &raw const options, 0.0, ptr::null(), 0, &raw mut solver, error)
            };
            call(new).unwrap();
            let mut y = vec![0.0; system.dim()];
            for time in times {
                call(|error| pc_solver_advance(solver, time, y.as_mut_ptr(), y.len(), error)).unwrap();
                // The same operations in the same order.
                assert_eq!(y, expected.state_at(time).unwrap(), "{name}");
            }
            let mut counts = pc_statistics::default();
            call(|error| pc_solver_statistics(solver, &raw mut counts, size_of::<pc_statistics>(), error))
                .unwrap();
            assert!(counts.steps > 10 && counts.rhs_evaluations > counts.steps);
            pc_solver_free(solver);
        }
    }
}

/// The times that an observer has seen, and the number after which it stops.
struct Seen {
    times: Vec<f64>,
    stop_after: usize,
    solver: *mut pc_solver,
    refused: Vec<pc_status>,
}

extern "C" fn see(t: f64, y: *const f64, y_length: usize, user: *mut c_void) -> c_int {
    // SAFETY: what `observers_see_stop_and_are_refused` passes.
    let seen = unsafe { &mut *user.cast::<Seen>() };
    assert!(y_length == 6 && !y.is_null());
    seen.times.push(t);
    let mut now = 0.0;
    // SAFETY: a live solver, in use; it is not freed.
    unsafe {
        seen.refused.push(pc_solver_time(seen.solver, &raw mut now, ptr::null_mut()));
        pc_solver_free(seen.solver);
    }
    c_int::from(seen.times.len() >= seen.stop_after)
}

#[test]
fn observers_see_stop_and_are_refused() {
    let system = System::of("heavy-top-lagrange");
    let times = [0.5, 1.0, 1.5];
    for (stop_after, outcome) in [(9, Ok(())), (2, Err(stopped()))] {
        let mut solver = ptr::null_mut();
        // SAFETY: live handles, arrays as said; the solver is freed once, after the run.
        unsafe {
            let new =
                |error| pc_solver_new(system.0, ptr::null(), 0.0, ptr::null(), 0, &raw mut solver, error);
            call(new).unwrap();
            let mut seen = Seen { times: vec![], stop_after, solver, refused: vec![] };
            let user = (&raw mut seen).cast();
            let run = call(|error| pc_solver_run(solver, times.as_ptr(), 3, Some(see), user, error));
            assert_eq!(run, outcome);
            assert_eq!(seen.times, times[..stop_after.min(3)]);
            assert!(seen.refused.iter().all(|&status| status == pc_status::PC_BUSY));
            pc_solver_free(solver);
        }
    }
}

#[test]
fn momenta_and_quasi_velocities_are_converted_both_ways() {
    let model = Model::named("heavy-top-lagrange");
    let forms = [pc_form::PC_POINCARE, pc_form::PC_CANONICAL].map(|form| model.system(form).unwrap());
    let ((t, y), (_, p)) = (forms[0].start(), forms[1].start());
    for system in &forms {
        let there = system.at(pc_system_to_momenta, t, &y, y.len()).unwrap();
        assert_eq!(there, p);
        // I3 = 1/2, the other moments 1.
        assert_eq!(there[3..], [y[3], y[4], y[5] / 2.0]);
        assert_eq!(system.at(pc_system_to_quasi_velocities, t, &p, p.len()), Ok(y.clone()));
    }
    // Setting a parameter also sets it in the transform.
    // SAFETY: a live system, and places for results as said.
    call(|error| unsafe { pc_system_set_parameter(forms[1].0, 2, 2.0, error) }).unwrap();
    assert_eq!(forms[1].at(pc_system_to_momenta, t, &y, y.len()).unwrap()[5], 2.0 * y[5]);
}

#[test]
fn the_parts_of_the_equations_fit_together() {
    let model = Model::named("heavy-top-lagrange");
    for form in [pc_form::PC_POINCARE, pc_form::PC_CANONICAL] {
        let system = model.system(form).unwrap();
        let (t, y) = system.start();
        let mass = system.at(pc_system_mass_matrix, t, &y, 9).unwrap();
        assert_eq!(mass, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.5]);
        let mut operators = 0;
        // SAFETY: a live system, and places for results as said.
        call(|error| unsafe { pc_system_operator_count(system.0, &raw mut operators, error) }).unwrap();
        assert_eq!(operators, 3);
        let c = system.at(pc_system_structure_coefficients, t, &y, 48).unwrap();
        let of = |r: usize, s: usize, m: usize| c[(r * 4 + s) * 3 + m - 1];
        assert_eq!((of(1, 2, 3), of(2, 1, 3), of(3, 1, 2), of(0, 1, 1)), (1.0, -1.0, 1.0, 0.0));
        assert_eq!(c.iter().filter(|&&c| c != 0.0).count(), 6);
    }
}

#[test]
fn the_residual_vanishes_on_the_rates_and_grows_by_the_mass_matrix() {
    for name in MODELS {
        let system = System::of(name);
        let ((t, y), dim) = (system.start(), system.dim());
        // SAFETY: a live system.
        let n = unsafe { pc_system_coordinate_count(system.0.as_ref()) };
        let k = dim - n;
        let residual = |rates: &[f64]| {
            let mut r = vec![0.0; dim];
            let (y, rates, out) = (y.as_ptr(), rates.as_ptr(), r.as_mut_ptr());
            // SAFETY: a live system and arrays as said.
            call(|error| unsafe { pc_system_residual(system.0, t, y, dim, rates, dim, out, dim, error) })
                .unwrap();
            r
        };
        let mut rates = system.at(pc_system_rhs, t, &y, dim).unwrap();
        // Rounding of M M⁻¹ r: sums of a few terms of order 1 to 100.
        assert!(residual(&rates).iter().all(|r| r.abs() < 1e-13), "{name}: {:?}", residual(&rates));
        rates[n] += 1.0;
        let mass = system.at(pc_system_mass_matrix, t, &y, k * k).unwrap();
        for (r, m) in residual(&rates)[n..].iter().zip(&mass[..k]) {
            assert!((r - m).abs() < 1e-13, "{name}");
        }
    }
}

/// The second part of the residual, and its value at rest.
#[test]
fn inverse_dynamics_is_the_residual_of_accelerations() {
    for name in MODELS {
        let system = System::of(name);
        let ((t, y), dim) = (system.start(), system.dim());
        // SAFETY: a live system.
        let n = unsafe { pc_system_coordinate_count(system.0.as_ref()) };
        let k = dim - n;
        let forces = |accelerations: Option<&[f64]>| {
            let mut tau = vec![f64::NAN; k];
            let (y, out) = (y.as_ptr(), tau.as_mut_ptr());
            let (given, count) = accelerations.map_or((ptr::null(), 0), |a| (a.as_ptr(), a.len()));
            // SAFETY: a live system and arrays as said.
            call(|error| unsafe {
                pc_system_inverse_dynamics(system.0, t, y, dim, given, count, out, k, error)
            })
            .map(|()| tau)
        };
        let rates = system.at(pc_system_rhs, t, &y, dim).unwrap();
        let of_motion = forces(Some(&rates[n..])).unwrap();
        let bias = forces(None).unwrap();
        let right = system.at(pc_system_right_hand_side, t, &y, k).unwrap();
        // Rounding, as above. The forces of a motion include those of multipliers.
        // SAFETY: a live system.
        if unsafe { pc_system_constraint_count(system.0.as_ref()) } == 0 {
            assert!(of_motion.iter().all(|force| force.abs() < 1e-12), "{name}: {of_motion:?}");
        }
        assert!(right.iter().zip(&bias).all(|(r, b)| (r + b).abs() < 1e-12), "{name}: {right:?} {bias:?}");
        let wrong = forces(Some(&rates[n..n + k - 1])).unwrap_err();
        assert_eq!(wrong.status, pc_status::PC_INVALID_ARGUMENT, "{name}");
    }
}

#[test]
fn reactions_are_observed_on_request() {
    let model = Model::named("chaplygin-sleigh");
    let silent = model.system(pc_form::PC_POINCARE).unwrap();
    // SAFETY: live handles.
    unsafe {
        assert_eq!(pc_system_reaction_count(silent.0.as_ref()), 0);
        call(|error| pc_model_observe_reactions(model.0, 1, error)).unwrap();
    }
    let system = model.system(pc_form::PC_POINCARE).unwrap();
    // SAFETY: a live system; its name lives as long.
    let (count, name) = unsafe {
        (
            pc_system_reaction_count(system.0.as_ref()),
            CStr::from_ptr(pc_system_reaction_name(system.0.as_ref(), 0)),
        )
    };
    assert_eq!((count, name.to_str()), (1, Ok("λ_blade")));
    // λ = v ω (m − m² a²/(m a² + J)), m = J = 1 and a = 1/2: 4/5 v ω.
    let state: Vec<f64> = (0..system.dim()).map(|i| if system.name(i) == "v" { 2.0 } else { 3.0 }).collect();
    let reaction = system.at(pc_system_reactions, 0.0, &state, 1).unwrap()[0];
    assert!((reaction - 4.8).abs() < 1e-14, "{reaction}");
    let refused = silent.at(pc_system_reactions, 0.0, &state, 1).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_UNSUPPORTED);
}

#[test]
fn projection_moves_a_state_onto_the_constraints() {
    let system = System::of("rod");
    let (t, mut y) = system.start();
    // SAFETY: a live system and arrays as said.
    let count = unsafe { pc_system_constraint_count(system.0.as_ref()) };
    let residual = |y: &[f64]| {
        let residuals = system.at(pc_system_constraint_residuals, t, y, count).unwrap();
        residuals.iter().fold(0.0_f64, |max, r| max.max(r.abs()))
    };
    assert_eq!(count, 1);
    assert!(residual(&y) < 1e-12, "{}", residual(&y));
    y[0] += 1e-3;
    assert!(residual(&y) > 1e-4);
    // SAFETY: a live system and an array as long as its state.
    call(|error| unsafe { pc_system_project(system.0, t, y.as_mut_ptr(), y.len(), error) }).unwrap();
    assert!(residual(&y) < 1e-12); // a few ulps of numbers of order 1 after Newton's iteration
}

#[test]
fn integrals_are_kept_at_their_values_for_the_current_parameters() {
    let model = Model::named("heavy-top-lagrange");
    // SAFETY: a live model and a text.
    call(|error| unsafe { pc_model_keep(model.0, c"energy".as_ptr(), error) }).unwrap();
    let system = model.system(pc_form::PC_POINCARE).unwrap();
    let (t, start) = system.start();
    let mut y = start.clone();
    // SAFETY: a live system and arrays as said.
    unsafe {
        let count = pc_system_parameter_count(system.0.as_ref());
        for i in 0..count {
            call(|error| pc_system_set_parameter(system.0, i, 1.5 + i as f64, error)).unwrap();
        }
        call(|error| pc_system_project(system.0, t, y.as_mut_ptr(), y.len(), error)).unwrap();
    }
    assert_eq!(y, start); // the start has the kept energy for these parameters
}

#[test]
fn integrals_are_kept_at_their_values_at_a_given_state() {
    let model = Model::named("heavy-top-lagrange");
    // SAFETY: a live model and a text.
    call(|error| unsafe { pc_model_keep(model.0, c"energy".as_ptr(), error) }).unwrap();
    let system = model.system(pc_form::PC_POINCARE).unwrap();
    let (t, start) = system.start();
    let there: Vec<f64> = start.iter().map(|y| 1.5 * y).collect();
    let projected = |y: &[f64]| {
        let mut y = y.to_vec();
        // SAFETY: a live system and an array as long as its state.
        call(|error| unsafe { pc_system_project(system.0, t, y.as_mut_ptr(), y.len(), error) }).unwrap();
        y
    };
    assert_ne!(projected(&there), there); // the start of the model has another energy
    // SAFETY: a live system and arrays as long as its state.
    unsafe {
        call(|error| pc_system_keep_from(system.0, t, there.as_ptr(), there.len(), error)).unwrap();
        assert_eq!(projected(&there), there);
        // The kept state stays the same when parameters change.
        call(|error| pc_system_set_parameter(system.0, 0, 1.5, error)).unwrap();
        assert_eq!(projected(&there), there);
        assert_ne!(projected(&start), start);

        let nowhere =
            call(|error| pc_system_keep_from(system.0, f64::NAN, there.as_ptr(), there.len(), error));
        assert_eq!(nowhere.unwrap_err().message, "t is NaN, but must be finite");
        let short = call(|error| pc_system_keep_from(system.0, t, there.as_ptr(), 1, error));
        assert_eq!(short.unwrap_err().status, pc_status::PC_INVALID_ARGUMENT);
        assert_eq!(projected(&there), there);
    }
}

#[test]
fn equations_are_printed_and_emitted() {
    let model = Model::named("heavy-top-lagrange");
    for (form, format, line) in [
        (pc_form::PC_POINCARE, pc_format::PC_TEXT, "I1 ω1' = "),
        (pc_form::PC_POINCARE, pc_format::PC_LATEX, "\\begin{align*}"),
        (pc_form::PC_POINCARE, pc_format::PC_JSON, "\"mass_matrix\": ["),
        (pc_form::PC_CANONICAL, pc_format::PC_TEXT, "Hamiltonian\n  p_ω1²/(2 I1)"),
    ] {
        let system = model.system(form).unwrap();
        let mut text = ptr::null_mut();
        // SAFETY: a live system and a place for the text.
        call(|error| unsafe { pc_system_print(system.0, format as c_int, &raw mut text, error) }).unwrap();
        let text = taken(text);
        assert!(text.contains(line), "{text}");
    }
    let system = model.system(pc_form::PC_POINCARE).unwrap();
    let (name, mut header, mut source) = (c("top"), ptr::null_mut(), ptr::null_mut());
    let emit = |error| {
        // SAFETY: a live system and places for the texts.
        unsafe { pc_system_emit_c(system.0, name.as_ptr(), 1.0, &raw mut header, &raw mut source, error) }
    };
    call(emit).unwrap();
    assert!(taken(header).contains("void top_rhs(") && taken(source).contains("#include \"top.h\""));
}

/// A charge of 1e-9 beside an angle: those of the program, by the scale of each, and as the text has them.
#[test]
fn absolute_tolerances_are_those_of_the_program() {
    let text = "[coordinates]\nq = 1e-9\na = 1\n[lagrangian]\nkinetic = \"(q'^2 + a'^2)/2\"\npotential = \"2*q^2 + a^2/2\"\n";
    let tolerances = |text: &str, relative: f64| {
        let system = Model::text(text).unwrap().system(pc_form::PC_POINCARE).unwrap();
        let mut values = [f64::NAN; 4];
        call(|error| unsafe {
            // SAFETY: a live system, and room for as many numbers as said.
            pc_system_absolute_tolerances(system.0, relative, 10.0, values.as_mut_ptr(), 4, error)
        })
        .map(|()| values)
    };
    assert_eq!(tolerances(text, 1e-9), Ok([1e-16, 1e-12, 1e-16, 1e-12]));
    assert_eq!(tolerances(text, 1e-3), Ok([1e-12; 4]));
    let given = format!("{text}[simulation]\natol = {{ q = 1e-20 }}\n");
    assert_eq!(tolerances(&given, 1e-9), Ok([1e-20, 1e-12, 1e-16, 1e-12]));
    assert_eq!(tolerances(text, f64::NAN).unwrap_err().message, "relative is NaN, but must be finite");
}
