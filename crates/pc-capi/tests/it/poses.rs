//! Poses of bodies, accelerations besides J η̇, and forces at rest.

use std::ptr;

use crate::common::{At, Model, Refusal, System, c, call};
use pc::*;

type OfBody = unsafe extern "C" fn(
    *const pc_system,
    f64,
    *const f64,
    usize,
    *const std::ffi::c_char,
    *const f64,
    usize,
    *mut f64,
    usize,
    *mut *mut pc_error,
) -> pc_status;

fn of_body(
    system: &System,
    function: OfBody,
    (t, y): (f64, &[f64]),
    (body, at): (&str, Option<&[f64]>),
    length: usize,
) -> Result<Vec<f64>, Refusal> {
    let (name, mut values) = (c(body), vec![0.0; length]);
    let (point, count) = at.map_or((ptr::null(), 0), |at| (at.as_ptr(), at.len()));
    // SAFETY: a live system, text, and arrays as said.
    call(|error| unsafe {
        let (out, length) = (values.as_mut_ptr(), values.len());
        function(system.0, t, y.as_ptr(), y.len(), name.as_ptr(), point, count, out, length, error)
    })
    .map(|()| values)
}

fn velocities(system: &System) -> (usize, usize) {
    // SAFETY: a live system.
    let (n, states) =
        unsafe { (pc_system_coordinate_count(system.0.as_ref()), pc_system_state_count(system.0.as_ref())) };
    (n, system.dim() - n - states)
}

/// A state that moves.
fn moving(system: &System) -> (f64, Vec<f64>) {
    let (t, mut y) = system.start();
    for (i, y) in y.iter_mut().enumerate() {
        *y += 0.2 * (1.0 + 1.3 * i as f64).sin();
    }
    // SAFETY: a live system and as many numbers as said.
    call(|error| unsafe { pc_system_project(system.0, t, y.as_mut_ptr(), y.len(), error) }).unwrap();
    (t, y)
}

const AT: [f64; 3] = [0.1, -0.2, 0.3];

/// The rate of the pose along the motion is J η + a, and that of J η + a is J η̇ + r; the rotation turns with ω.
#[test]
fn velocities_are_rates_of_poses() {
    let bodies = [
        ("puma-560", "hand", pc_form::PC_POINCARE),
        ("puma-560", "elbow", pc_form::PC_CANONICAL),
        ("four-bar-loop", "coupler", pc_form::PC_POINCARE),
        ("satellite", "left", pc_form::PC_POINCARE),
        ("quadruped", "front_left_foot", pc_form::PC_POINCARE),
    ];
    for (name, body, form) in bodies {
        let system = Model::named(name).system(form).unwrap();
        let (t, y) = moving(&system);
        let (n, k) = velocities(&system);
        let rates = system.at(pc_system_rhs, t, &y, system.dim()).unwrap();
        let h = 1e-5;
        let along = |h: f64| -> Vec<f64> { y.iter().zip(&rates).map(|(y, rate)| y + h * rate).collect() };
        let pose = |h: f64| {
            of_body(&system, pc_system_body_pose, (t + h, &along(h)), (body, Some(&AT)), 12).unwrap()
        };
        let quasi = |h: f64| match system.name(n).starts_with("p_") {
            true => system.at(pc_system_to_quasi_velocities, t + h, &along(h), system.dim()).unwrap(),
            false => along(h),
        };
        let velocity = |h: f64| -> Vec<f64> {
            let columns =
                of_body(&system, pc_system_body_jacobian, (t + h, &along(h)), (body, Some(&AT)), 6 * (k + 2))
                    .unwrap();
            let eta = &quasi(h)[n..n + k];
            (0..6)
                .map(|i| columns[6 * k + i] + (0..k).map(|s| columns[i + 6 * s] * eta[s]).sum::<f64>())
                .collect()
        };
        let quotient = |there: Vec<f64>, back: Vec<f64>| -> Vec<f64> {
            there.iter().zip(back).map(|(there, back)| (there - back) / (2.0 * h)).collect()
        };
        let close = |found: f64, expected: f64, what: &str| {
            assert!(
                (found - expected).abs() < 1e-6 * (1.0 + expected.abs()),
                "{name}, {what}: {found} {expected}"
            );
        };
        let (moved, here, v) = (quotient(pose(h), pose(-h)), pose(0.0), velocity(0.0));
        (0..3).for_each(|i| close(v[i], moved[i], "velocity"));
        for column in 0..3 {
            let axis = &here[3 + 3 * column..6 + 3 * column];
            assert!((axis.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-9, "{name}: {axis:?}");
            for i in 0..3 {
                let (j, l) = ((i + 1) % 3, (i + 2) % 3);
                let turned = v[3 + j] * axis[l] - v[3 + l] * axis[j];
                close(moved[3 + 3 * column + i], turned, "rotation");
            }
        }
        let bias = of_body(&system, pc_system_body_bias, (t, &y), (body, Some(&AT)), 6).unwrap();
        let columns =
            of_body(&system, pc_system_body_jacobian, (t, &y), (body, Some(&AT)), 6 * (k + 2)).unwrap();
        assert_eq!(bias, columns[6 * (k + 1)..]);
        let (accelerated, accelerations) =
            (quotient(velocity(h), velocity(-h)), quotient(quasi(h), quasi(-h)));
        for i in 0..6 {
            let through: f64 = (0..k).map(|s| columns[i + 6 * s] * accelerations[n + s]).sum();
            close(accelerated[i], through + bias[i], "acceleration");
        }
    }
}

/// The point of `[points]` is that of its body, and space has points too.
#[test]
fn named_points_have_poses() {
    let text = crate::laws::text_of("puma-560")
        + "\n[points]\ntool = { body = \"hand\", at = [0.1, -0.2, 0.3] }\nbench = { body = \"world\", at = [1, \"d2\", 3] }\n";
    let system = Model::text(&text)
        .unwrap_or_else(|refusal| panic!("{refusal:?}"))
        .system(pc_form::PC_POINCARE)
        .unwrap();
    let (t, y) = moving(&system);
    let of = |body, at| of_body(&system, pc_system_body_pose, (t, &y), (body, at), 12).unwrap();
    for (tool, hand) in of("tool", None).iter().zip(of("hand", Some(&AT))) {
        assert!((tool - hand).abs() < 1e-14);
    }
    let unit = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    assert_eq!(of("bench", Some(&[0.5, 0.0, 0.0])), [&[1.5, 0.2435, 3.0], &unit[..]].concat());
    let parameters: Vec<f64> = system.parameters().iter().map(|value| 2.0 * value).collect();
    system.set_parameters(&parameters).unwrap();
    assert_eq!(of("bench", None)[1], 0.487);
}

/// A pendulum with a spring, a damper and a driven pivot: the damper does not act at rest.
#[test]
fn forces_at_rest_are_those_of_weight_and_springs() {
    let system = System::of("puma-560");
    let (t, y) = moving(&system);
    let (n, k) = velocities(&system);
    let found = system.at(pc_system_gravity, t, &y, k).unwrap();
    let mut rest = y.clone();
    rest[n..].fill(0.0);
    let mut expected = vec![0.0; k];
    // SAFETY: a live system and arrays as long as said.
    call(|error| unsafe {
        let (state, dim) = (rest.as_ptr(), rest.len());
        pc_system_inverse_dynamics(system.0, t, state, dim, ptr::null(), 0, expected.as_mut_ptr(), k, error)
    })
    .unwrap();
    assert_eq!(found, expected);
    let text = "[parameters]\nm = 2.0\n[coordinates]\na = 0.4\n[quasi_velocities]\n\"a'\" = 3.0\n\
        [lagrangian]\nkinetic = \"m*a'^2/2\"\npotential = \"-9.81*m*cos(a) + a^2\"\ndissipation = \"5*a'^2\"\n\
        [forces]\na = \"7\"\n";
    let model = Model::text(text).unwrap();
    let on = c("a");
    // SAFETY: a live model and a text.
    call(|error| unsafe { pc_model_add_external_force(model.0, on.as_ptr(), error) }).unwrap();
    for form in [pc_form::PC_POINCARE, pc_form::PC_CANONICAL] {
        // No function is asked for the external force.
        let system = model.system(form).unwrap();
        let (t, y) = system.start();
        let found = system.at(pc_system_gravity, t, &y, 1).unwrap()[0];
        assert!((found - (2.0 * 9.81 * 0.4f64.sin() + 0.8 - 7.0)).abs() < 1e-14, "{found}");
    }
}

/// A controller that sets the forces may ask for Jacobians before it has set any.
#[test]
fn velocities_need_no_forces() {
    let (free, forced) =
        (System::of("puma-560"), crate::laws::forced("puma-560", &["waist", "hand"], pc_form::PC_POINCARE));
    let (t, y) = moving(&free);
    for (function, length) in
        [(pc_system_body_jacobian as OfBody, 48), (pc_system_body_bias, 6), (pc_system_body_pose, 12)]
    {
        let of = |system| of_body(system, function, (t, &y), ("hand", Some(&AT)), length).unwrap();
        assert_eq!(of(&forced), of(&free));
    }
}

/// Positions follow the curve of an input.
#[test]
fn poses_follow_inputs() {
    let text = "[coordinates]\na = 0.5\n[inputs]\nu = { times = [0, 1, 2], values = [0, 2, 4], rates = [2, 2, 2], interpolation = \"cubic\" }\n\
        [bodies.bob]\nmass = 1\nposition = [\"u\", \"sin(a)\", \"cos(a)\"]\n";
    let system =
        Model::text(text).unwrap_or_else(|refusal| panic!("{refusal:?}")).system(pc_form::PC_POINCARE);
    let system = system.unwrap_or_else(|refusal| panic!("{refusal:?}"));
    let (_, y) = system.start();
    for t in [0.5, 1.25] {
        let pose = of_body(&system, pc_system_body_pose, (t, &y), ("bob", None), 12).unwrap();
        assert!((pose[0] - 2.0 * t).abs() < 1e-14 && (pose[1] - 0.5f64.sin()).abs() < 1e-15, "{pose:?}");
    }
    let outside = of_body(&system, pc_system_body_pose, (3.0, &y), ("bob", None), 12).unwrap_err();
    assert_eq!(outside.status, pc_status::PC_EVALUATION);
}

#[test]
fn what_does_not_exist_is_refused() {
    let system = System::of("puma-560");
    let (t, y) = system.start();
    for function in [pc_system_body_pose as OfBody, pc_system_body_bias] {
        let length = if ptr::fn_addr_eq(function, pc_system_body_pose as OfBody) { 12 } else { 6 };
        let of = |body, at: Option<&[f64]>, length| of_body(&system, function, (t, &y), (body, at), length);
        let refused = of("foot", None, length).unwrap_err();
        assert_eq!(refused.status, pc_status::PC_NOT_FOUND);
        assert!(refused.message.starts_with("there is no body or point called `foot`; there are waist"));
        assert_eq!(of("hand", Some(&AT[..2]), length).unwrap_err().message, "point: 2 numbers instead of 3");
        let refused = of("hand", None, length + 1).unwrap_err();
        assert!(refused.message.ends_with(&format!("{} numbers instead of {length}", length + 1)));
        assert_eq!(
            of("hand", Some(&[f64::NAN, 0.0, 0.0]), length).unwrap_err().status,
            pc_status::PC_EVALUATION
        );
    }
    let gravity: At = pc_system_gravity;
    assert_eq!(system.at(gravity, t, &y, 5).unwrap_err().message, "tau: 5 numbers instead of 6");
    // Its angular velocity is given along axes of unknown direction.
    let model = Model::text(
        "[coordinates]\na = 0\n[bodies.b]\nmass = 1\nposition = [\"a\", 0, 0]\nangular_velocity = [\"a'\", 0, 0]\n\
         inertia = [1, 1, 1]\n",
    );
    let system = model.unwrap().system(pc_form::PC_POINCARE).unwrap();
    let (t, y) = system.start();
    let refused = of_body(&system, pc_system_body_pose, (t, &y), ("b", None), 12).unwrap_err();
    assert_eq!(refused.status, pc_status::PC_INVALID_MODEL, "{}", refused.message);
}
