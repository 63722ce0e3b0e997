//! Calls can build whatever the text of a model can say.

use std::collections::BTreeSet;
use std::ffi::{CString, c_char};
use std::ptr;

use crate::common::{Model, Refusal, c, call, taken};
use pc::pc_form::PC_POINCARE;
use pc::pc_status::*;
use pc::*;

/// Calls a function of a model with texts, then other arguments.
macro_rules! say {
    ($model:expr, $function:ident $(, $text:expr)* $(; $($other:expr),*)?) => {{
        // SAFETY: a live model, and texts that live as long as the call.
        call(|error| unsafe { $function($model.0, $(c($text).as_c_str().as_ptr(),)* $($($other,)*)? error) })
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

/// Sets a list of expressions of a body.
fn list(
    model: &Model,
    function: unsafe extern "C" fn(
        *mut pc_model,
        *const c_char,
        *const *const c_char,
        usize,
        *mut *mut pc_error,
    ) -> pc_status,
    body: &str,
    entries: &[&str],
) -> Result<(), Refusal> {
    let (body, entries): (_, Vec<CString>) = (c(body), entries.iter().map(|entry| c(entry)).collect());
    let pointers: Vec<*const c_char> = entries.iter().map(|entry| entry.as_ptr()).collect();
    // SAFETY: a live model, and texts that live as long as the call.
    call(|error| unsafe { function(model.0, body.as_ptr(), pointers.as_ptr(), pointers.len(), error) })
}

/// Sets the turns of a joint.
fn turns(model: &Model, body: &str, axes: &str, angles: &[&str]) -> Result<(), Refusal> {
    let (body, axes, angles) = (c(body), c(axes), angles.iter().map(|angle| c(angle)).collect::<Vec<_>>());
    let pointers: Vec<*const c_char> = angles.iter().map(|angle| angle.as_ptr()).collect();
    // SAFETY: a live model, and texts that live as long as the call.
    call(|error| unsafe {
        let (data, length) = (pointers.as_ptr(), pointers.len());
        pc_model_set_joint_turns(model.0, body.as_ptr(), axes.as_ptr(), data, length, error)
    })
}

/// Joins two bodies in a loop, at points with six components.
fn closed(
    model: &Model,
    name: &str,
    kind: &str,
    [first, second]: [&str; 2],
    places: &[&str; 6],
) -> Result<(), Refusal> {
    let (name, kind, first, second) = (c(name), c(kind), c(first), c(second));
    let places = places.map(c);
    let pointers: Vec<*const c_char> = places.iter().map(|place| place.as_ptr()).collect();
    // SAFETY: a live model, and texts that live as long as the call.
    call(|error| unsafe {
        let bodies = (first.as_ptr(), second.as_ptr());
        pc_model_add_loop(model.0, name.as_ptr(), kind.as_ptr(), bodies.0, bodies.1, pointers.as_ptr(), error)
    })
}

/// Sets an entry of a contact.
fn touching(model: &Model, name: &str, entry: &str, values: &[&str]) -> Result<(), Refusal> {
    let (name, entry) = (c(name), c(entry));
    let values: Vec<_> = values.iter().map(|value| c(value)).collect();
    let pointers: Vec<*const c_char> = values.iter().map(|value| value.as_ptr()).collect();
    // SAFETY: a live model, and texts that live as long as the call.
    call(|error| unsafe {
        let (name, entry) = (name.as_ptr(), entry.as_ptr());
        pc_model_set_contact(model.0, name, entry, pointers.as_ptr(), pointers.len(), error)
    })
}

/// The keys that the reader knows after the text `before`: its refusal of an unknown key lists
/// them.
fn keys(before: &str) -> BTreeSet<String> {
    let refusal = Model::text(&format!("{before}zzzzzz = 1\n")).err().unwrap();
    let help = refusal.message.split_once("help: ").unwrap().1;
    let list = help.rsplit_once(" are ").unwrap().1;
    list.split(", ").map(|key| key.trim().to_owned()).collect()
}

/// A model made by every call that writes an entry; as a whole it makes no sense.
fn everything() -> Model {
    let model = empty("All of it");
    say!(model, pc_model_set_description, "what").unwrap();
    say!(model, pc_model_set_reference, "whence").unwrap();
    say!(model, pc_model_add_parameter, "m"; 1.0).unwrap();
    say!(model, pc_model_add_parameter_expression, "m2", "m^2").unwrap();
    say!(model, pc_model_add_input, "u"; 0.5).unwrap();
    let (name, times, values) = (c("pull"), [0.0, 1.0], [2.0, 3.0]);
    // SAFETY: a live model, a text and two lists of two numbers.
    let add = |error| unsafe {
        pc_model_add_input_table(
            model.0,
            name.as_ptr(),
            times.as_ptr(),
            values.as_ptr(),
            2,
            ptr::null(),
            error,
        )
    };
    call(add).unwrap();
    let name = c("cam");
    // SAFETY: a live model, a text and four lists of two numbers.
    let add = |error| unsafe {
        let [times, values] = [&times, &values].map(|list| list.as_ptr());
        pc_model_add_input_curve(model.0, name.as_ptr(), times, values, values, times, 2, error)
    };
    call(add).unwrap();
    say!(model, pc_model_add_input_file, "push", "/x.csv", "u", "s", "hold").unwrap();
    say!(model, pc_model_add_input_curve_file, "road", "/x.csv", "u", "v", "a", "s").unwrap();
    say!(model, pc_model_add_state, "z", "-z"; 0.25).unwrap();
    say!(model, pc_model_set_gravity, "0", "0", "-9.81").unwrap();
    say!(model, pc_model_add_definition, "twice", "2*m").unwrap();
    say!(model, pc_model_add_coordinate, "x"; 0.0).unwrap();
    say!(model, pc_model_add_quasi_velocity, "v", "x'"; 0.5).unwrap();
    say!(model, pc_model_set_start_expression, "v", "m/3").unwrap();
    say!(model, pc_model_set_kinematics, "x", "v").unwrap();
    say!(model, pc_model_set_algebra, "so3").unwrap();
    say!(model, pc_model_set_bracket, "v", "w", "0").unwrap();
    say!(model, pc_model_add_constraint, "rail", "x").unwrap();
    say!(model, pc_model_set_constraint_kind, "rail", "holonomic").unwrap();
    say!(model, pc_model_set_kinetic, "v^2").unwrap();
    say!(model, pc_model_set_potential, "x").unwrap();
    say!(model, pc_model_set_lagrangian, "v^2").unwrap();
    say!(model, pc_model_set_dissipation, "v^2").unwrap();
    say!(model, pc_model_add_body, "bob", "m", "x", "0", "0").unwrap();
    say!(model, pc_model_set_body_force, "bob", "0", "0", "-m").unwrap();
    say!(model, pc_model_set_body_torque, "bob", "0", "0", "m").unwrap();
    say!(model, pc_model_set_body_angular_velocity, "bob", "0", "0", "v").unwrap();
    list(&model, pc_model_set_body_inertia, "bob", &["1", "1", "m"]).unwrap();
    list(&model, pc_model_set_body_rotation, "bob", &["1", "0", "0", "0", "1", "0", "0", "0", "1"]).unwrap();
    say!(model, pc_model_add_jointed_body, "arm", "world", "universal").unwrap();
    say!(model, pc_model_set_body_mass, "arm", "m").unwrap();
    say!(model, pc_model_set_body_center, "arm", "0", "0", "-m").unwrap();
    list(&model, pc_model_set_body_inertia, "arm", &["1", "1", "m"]).unwrap();
    say!(model, pc_model_set_body_force, "arm", "0", "0", "-m").unwrap();
    say!(model, pc_model_set_body_torque, "arm", "0", "0", "m").unwrap();
    say!(model, pc_model_set_joint_place, "arm", "0", "m", "0").unwrap();
    say!(model, pc_model_set_joint_pitch, "arm", "0.1").unwrap();
    say!(model, pc_model_set_joint_gear, "arm", "bob", "2", "m").unwrap();
    say!(model, pc_model_set_joint_armature, "arm", "m").unwrap();
    say!(model, pc_model_set_joint_spring, "arm", "m", "0.1").unwrap();
    say!(model, pc_model_set_joint_damping, "arm", "m").unwrap();
    say!(model, pc_model_set_joint_friction, "arm", "m").unwrap();
    say!(model, pc_model_set_joint_limits, "arm", "-m", "m", "100", "1").unwrap();
    say!(model, pc_model_set_joint_restitution, "arm", "-m", "m", "0.5").unwrap();
    say!(model, pc_model_set_joint_stiction, "arm", "2*m").unwrap();
    say!(model, pc_model_set_joint_axis, "arm"; [0.0, 0.0, 1.0].as_ptr()).unwrap();
    let (first, second) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    say!(model, pc_model_set_joint_axes, "arm"; first.as_ptr(), second.as_ptr()).unwrap();
    list(&model, pc_model_set_joint_rotation, "arm", &["1", "0", "0", "0", "1", "0", "0", "0", "1"]).unwrap();
    turns(&model, "arm", "zx", &["m", "0.1"]).unwrap();
    list(&model, pc_model_name_joint_coordinates, "arm", &["a", "b"]).unwrap();
    list(&model, pc_model_name_joint_quasi_velocities, "arm", &["c", "d"]).unwrap();
    say!(model, pc_model_add_point, "tip", "arm", "0", "0", "-1").unwrap();
    closed(&model, "closed", "revolute", ["arm", "world"], &["0", "0", "-1", "m", "0", "0"]).unwrap();
    say!(model, pc_model_set_loop_axes, "closed"; first.as_ptr(), second.as_ptr()).unwrap();
    say!(model, pc_model_set_loop_length, "closed", "m").unwrap();
    say!(model, pc_model_add_contact, "ground", "arm", "disc", "rolls").unwrap();
    for (entry, values) in [
        ("radius", &["m"][..]),
        ("axis", &["0", "0", "1"]),
        ("semi_axes", &["m", "m", "1"]),
        ("at", &["0", "0", "m"]),
        ("attitude", &["1", "0", "0", "0", "1", "0", "0", "0", "1"]),
        ("normal", &["0", "0", "m"]),
        ("through", &["0", "m", "0"]),
        ("height", &["m"]),
        ("friction", &["m"]),
        ("creep", &["m"]),
        ("keeps", &["true"]),
    ] {
        touching(&model, "ground", entry, values).unwrap();
    }
    say!(model, pc_model_add_force, "v", "1").unwrap();
    say!(model, pc_model_add_integral, "half", "v/2").unwrap();
    say!(model, pc_model_add_output, "place", "x").unwrap();
    say!(model, pc_model_set_action, "a*x").unwrap();
    say!(model, pc_model_add_action_constant, "a"; 2.0).unwrap();
    let (name, when) = (c("hit"), c("x"));
    call(|error| unsafe {
        // SAFETY: a live model and texts.
        pc_model_add_event(model.0, name.as_ptr(), when.as_ptr(), -1, 1, error)
    })
    .unwrap();
    say!(model, pc_model_add_event_reset, "hit", "v", "-v").unwrap();
    say!(model, pc_model_set_start_time; 1.0).unwrap();
    say!(model, pc_model_set_end_time; 2.0).unwrap();
    say!(model, pc_model_set_samples; 11).unwrap();
    say!(model, pc_model_set_tolerances; 1e-6, 1e-8).unwrap();
    say!(model, pc_model_set_max_step; 0.25).unwrap();
    say!(model, pc_model_set_event_search; 8, 1e-6).unwrap();
    say!(model, pc_model_set_method, "bdf").unwrap();
    say!(model, pc_model_set_form, "canonical").unwrap();
    model
}

/// The keys under a header of the text, or of the table of this name under it.
fn written(text: &str, header: &str, table: Option<&str>) -> BTreeSet<String> {
    let section = text.split_once(&format!("[{header}]\n")).unwrap().1;
    let lines = section.lines().take_while(|line| !line.is_empty());
    let keys = lines.map(|line| line.split_once(" = ").unwrap().0);
    let unquoted = |key: &str| key.trim_matches('"').to_owned();
    keys.filter_map(|key| match table {
        None => Some(unquoted(key.split("\".").next().unwrap())),
        Some(table) => {
            let inner = key.strip_prefix(&format!("\"{table}\"."))?;
            Some(unquoted(inner.split('.').next().unwrap()))
        }
    })
    .collect()
}

#[test]
fn there_is_a_call_for_every_key_of_the_text() {
    let text = text(&everything());
    let headers: BTreeSet<String> = text
        .lines()
        .filter_map(|line| line.strip_prefix('[')?.strip_suffix(']').map(str::to_owned))
        .filter(|header| !header.contains('.'))
        .collect();
    // Drawings and units are for the pages and tables of the program, which the library does not write; a program that calls the library writes the
    // value of a function where it is used.
    let of_text = ["draw", "drawing", "functions", "units"];
    let known: BTreeSet<String> =
        keys("[zzzzzz]\n").into_iter().filter(|key| !of_text.contains(&key.as_str())).collect();
    assert_eq!(headers, known, "{text}");
    for (before, header, table) in [
        ("[model]\n", "model", None),
        ("[quasi_velocities]\nv.", "quasi_velocities", Some("v")),
        ("[constraints]\nc.", "constraints", Some("rail")),
        ("[lagrangian]\n", "lagrangian", None),
        ("[hamilton_jacobi]\n", "hamilton_jacobi", None),
        ("[bodies.b]\n", "bodies", Some("bob")),
        ("[bodies.b]\njoint.kind = \"fixed\"\n", "bodies", Some("arm")),
        ("[points.p]\n", "points", Some("tip")),
        ("[loops.l]\n", "loops", Some("closed")),
        ("[contacts.c]\n", "contacts", Some("ground")),
        ("[events.e]\n", "events", Some("hit")),
    ] {
        assert_eq!(written(&text, header, table), keys(before), "{text}");
    }
    let of_joint = text.lines().filter_map(|line| line.strip_prefix("\"arm\".\"joint\".\""));
    let of_joint: BTreeSet<String> =
        of_joint.map(|rest| rest.split_once('"').unwrap().0.to_owned()).collect();
    assert_eq!(of_joint, keys("[bodies.b.joint]\n"), "{text}");
    let mut simulation = keys("[simulation]\n");
    // pc_model_keep, pc_model_give_quasi_velocity and pc_model_add_independent are settings outside
    // the text.
    assert!(["project", "hamel", "independent"].iter().all(|key| simulation.remove(*key)));
    assert_eq!(written(&text, "simulation", None), simulation, "{text}");
    let algebra: BTreeSet<String> = ["brackets", "name"].map(str::to_owned).into();
    assert_eq!(keys("[algebra]\n"), algebra);
    assert!(text.contains("[algebra]\n\"name\" = \"so3\"\n") && text.contains("[algebra.brackets]\n"));
}

/// The pendulum on a cart, built from bodies by calls, is the same as that of a text.
#[test]
fn bodies_reach_the_text() {
    let by_calls = empty("A pendulum on a cart");
    for (name, value) in [("M", 2.0), ("m", 1.0), ("l", 0.5), ("g", 9.81), ("J", 0.3)] {
        say!(by_calls, pc_model_add_parameter, name; value).unwrap();
    }
    say!(by_calls, pc_model_add_coordinate, "s"; 0.0).unwrap();
    say!(by_calls, pc_model_add_coordinate, "φ"; 0.5).unwrap();
    say!(by_calls, pc_model_add_body, "cart", "M", "s", "0", "0").unwrap();
    say!(by_calls, pc_model_add_body, "bob", "m", "s + l*sin(φ)", "0", "-l*cos(φ)").unwrap();
    say!(by_calls, pc_model_set_body_force, "bob", "0", "0", "-m*g").unwrap();
    say!(by_calls, pc_model_set_body_torque, "bob", "0", "-0.1*φ'", "0").unwrap();
    say!(by_calls, pc_model_set_body_angular_velocity, "bob", "0", "φ'", "0").unwrap();
    list(&by_calls, pc_model_set_body_inertia, "bob", &["J", "J", "J"]).unwrap();
    let system = by_calls.system(PC_POINCARE).unwrap();
    // (M + m) s̈ + m l φ̈ cos φ = m l φ̇² sin φ,  m l s̈ cos φ + (m l² + J) φ̈ = −m g l sin φ − φ̇/10
    let y: [f64; 4] = [0.0, 0.4, 0.2, -0.7];
    let (sin, cos) = y[1].sin_cos();
    let (m11, m12, m22) = (3.0, 0.5 * cos, 0.25 + 0.3);
    let (r1, r2) = (0.5 * y[3] * y[3] * sin, -9.81 * 0.5 * sin - 0.1 * y[3]);
    let det = m11 * m22 - m12 * m12;
    let expected = [y[2], y[3], (m22 * r1 - m12 * r2) / det, (m11 * r2 - m12 * r1) / det];
    let rates = system.at(pc_system_rhs, 0.0, &y, 4).unwrap();
    for (rate, expected) in rates.iter().zip(expected) {
        assert!((rate - expected).abs() < 1e-13, "{rates:?}"); // a few dozen roundings
    }
    // An inertia needs an angular velocity or rotation, and a matrix has nine entries.
    let at_rest =
        Model::text(&text(&by_calls).replace("\"bob\".\"angular_velocity\" = [\"0\", \"φ'\", \"0\"]\n", ""))
            .err();
    assert!(at_rest.unwrap().message.contains("angular_velocity"));
    list(&by_calls, pc_model_set_body_rotation, "bob", &["1"]).unwrap();
    let refusal = say!(by_calls, pc_model_check).unwrap_err();
    assert!(refusal.message.contains("rotation"), "{}", refusal.message);
}

/// A double pendulum and a crank, built by calls, are the same as those of a text.
#[test]
fn joints_reach_the_text() {
    let model = empty("A double pendulum");
    say!(model, pc_model_add_parameter, "l"; 0.5).unwrap();
    say!(model, pc_model_set_gravity, "0", "0", "-9.81").unwrap();
    for (name, parent, place) in [("upper", "world", "0"), ("lower", "upper", "-l")] {
        say!(model, pc_model_add_jointed_body, name, parent, "revolute").unwrap();
        say!(model, pc_model_set_joint_axis, name; [0.0, 1.0, 0.0].as_ptr()).unwrap();
        say!(model, pc_model_set_joint_place, name, "0", "0", place).unwrap();
        say!(model, pc_model_set_body_mass, name, "1").unwrap();
        say!(model, pc_model_set_body_center, name, "0", "0", "-l").unwrap();
    }
    say!(model, pc_model_add_coordinate, "upper"; 0.3).unwrap();
    let system = model.system(PC_POINCARE).unwrap();
    assert_eq!(system.start().1, [0.3, 0.0, 0.0, 0.0]);
    let y: [f64; 4] = [0.3, -0.5, 0.0, 0.0];
    let (g, l, sum) = (9.81f64, 0.5f64, y[0] + y[1]);
    // Angles from the vertical θ1 = q, θ2 = q + p: (2, c; c, 1) l² θ̈ = -g l (2 sin θ1, sin θ2), c = cos(θ1 - θ2).
    let c = y[1].cos();
    let (r1, r2) = (-2.0 * g / l * y[0].sin(), -g / l * sum.sin());
    let det = 2.0 - c * c;
    let (first, second) = ((r1 - c * r2) / det, (2.0 * r2 - c * r1) / det);
    let rates = system.at(pc_system_rhs, 0.0, &y, 4).unwrap();
    for (rate, expected) in rates.iter().zip([0.0, 0.0, first, second - first]) {
        assert!((rate - expected).abs() < 1e-12, "{rates:?}"); // some roundings of numbers below 100
    }
    // With its tip held by a loop, only the knee of the arm can move.
    closed(&model, "tip", "rod", ["lower", "world"], &["0", "0", "-l", "0", "0", "0"]).unwrap();
    say!(model, pc_model_set_loop_length, "tip", "0.8").unwrap();
    assert!(text(&model).contains("[loops]\n\"tip\".\"kind\" = \"rod\"\n"));
    let refusal = turns(&model, "upper", "zxz", &["1"]).unwrap_err();
    assert_eq!(refusal.message, "each axis needs one angle: there are 3 axes and 1 angles");
}

/// A ball that rolls down a slope without slipping, (5/7) g sin s along it.
#[test]
fn contacts_reach_the_text() {
    let model = empty("A ball on a slope");
    say!(model, pc_model_set_gravity, "0", "0", "-9.81").unwrap();
    say!(model, pc_model_add_jointed_body, "ball", "world", "planar").unwrap();
    say!(model, pc_model_set_joint_axis, "ball"; [0.0, 1.0, 0.0].as_ptr()).unwrap();
    say!(model, pc_model_set_body_mass, "ball", "2").unwrap();
    list(&model, pc_model_set_body_inertia, "ball", &["0.008", "0.008", "0.008"]).unwrap();
    say!(model, pc_model_add_coordinate, "ball_z"; 0.1 / 0.3f64.cos()).unwrap();
    say!(model, pc_model_add_contact, "slope", "ball", "sphere", "rolls").unwrap();
    touching(&model, "slope", "radius", &["0.1"]).unwrap();
    touching(&model, "slope", "normal", &["sin(0.3)", "0", "cos(0.3)"]).unwrap();
    assert!(text(&model).contains("[contacts]\n\"slope\".\"body\" = \"ball\"\n"));
    let system = model.system(PC_POINCARE).unwrap();
    let (_, y) = system.start();
    let rates = system.at(pc_system_rhs, 0.0, &y, y.len()).unwrap();
    let expected = 5.0 / 7.0 * 9.81 * 0.3f64.sin() * 0.3f64.cos(); // the horizontal component
    let x = rates[y.len() / 2..].iter().any(|rate| (rate - expected).abs() < 1e-12);
    assert!(x, "{rates:?}");
}

/// A height is an expression, and its coordinate starts below the ball.
#[test]
fn heights_of_contacts_reach_the_text() {
    let model = empty("A ball on a slope");
    say!(model, pc_model_add_jointed_body, "ball", "world", "planar").unwrap();
    say!(model, pc_model_set_joint_axis, "ball"; [0.0, 1.0, 0.0].as_ptr()).unwrap();
    say!(model, pc_model_set_body_mass, "ball", "2").unwrap();
    list(&model, pc_model_set_body_inertia, "ball", &["0.008", "0.008", "0.008"]).unwrap();
    say!(model, pc_model_add_coordinate, "ball_z"; 0.1 / 0.3f64.cos()).unwrap();
    say!(model, pc_model_add_contact, "slope", "ball", "sphere", "rolls").unwrap();
    touching(&model, "slope", "radius", &["0.1"]).unwrap();
    touching(&model, "slope", "height", &["-tan(0.3)*slope_x"]).unwrap();
    assert!(text(&model).contains("\"slope\".\"height\" = \"-tan(0.3)*slope_x\""));
    let y = start(&model);
    assert!(y.iter().any(|value| (value + 0.1 * 0.3f64.sin()).abs() < 1e-12), "{y:?}");
}

fn start(model: &Model) -> Vec<f64> {
    model.system(PC_POINCARE).unwrap().start().1
}

#[test]
fn starts_are_set_as_numbers_and_expressions() {
    let model = empty("A point");
    say!(model, pc_model_add_parameter, "a"; 3.0).unwrap();
    for name in ["x", "y"] {
        say!(model, pc_model_add_coordinate, name; 1.0).unwrap();
    }
    say!(model, pc_model_set_kinetic, "(x'^2 + y'^2)/2").unwrap();
    say!(model, pc_model_set_start_time; 7.5).unwrap();
    assert_eq!(start(&model), [1.0, 1.0, 0.0, 0.0]);
    assert_eq!(model.system(PC_POINCARE).unwrap().start().0, 7.5);
    say!(model, pc_model_set_start_expression, "x", "2*a").unwrap();
    say!(model, pc_model_set_start, "y"; -1.0).unwrap();
    say!(model, pc_model_set_start, "y'"; 4.0).unwrap();
    assert_eq!(start(&model), [6.0, -1.0, 0.0, 4.0]);
    say!(model, pc_model_set_start_expression, "y'", "a/2").unwrap();
    say!(model, pc_model_set, "a"; 5.0).unwrap();
    assert_eq!(start(&model), [10.0, -1.0, 0.0, 2.5]);
    let unknown = say!(model, pc_model_set_start, "z'"; 1.0).unwrap_err();
    assert_eq!(
        (unknown.status, unknown.message.as_str()),
        (PC_NOT_FOUND, "`z'` has no start value in this model; x, y, y' have")
    );

    // A quasi-velocity with a definition, in a model read from a text.
    let sleigh = Model::named("chaplygin-sleigh");
    say!(sleigh, pc_model_set_start, "ω"; 2.0).unwrap();
    assert_eq!(start(&sleigh)[4], 2.0);
    let refusal = say!(sleigh, pc_model_set_start_expression, "ω", "1").unwrap_err();
    assert!(
        refusal.message.starts_with("pc_model_set_start_expression needs a model begun"),
        "{}",
        refusal.message
    );
    assert_eq!(say!(sleigh, pc_model_set_start, "z"; 2.0).unwrap_err().status, PC_NOT_FOUND);
    assert_eq!(say!(sleigh, pc_model_set_start, "ω"; f64::NAN).unwrap_err().status, PC_INVALID_ARGUMENT);
    let turning = empty("A point that turns");
    say!(turning, pc_model_add_coordinate, "φ"; 0.0).unwrap();
    say!(turning, pc_model_add_quasi_velocity, "w", "2*φ'"; 1.0).unwrap();
    say!(turning, pc_model_set_kinetic, "w^2/2").unwrap();
    say!(turning, pc_model_set_start, "w"; 3.0).unwrap();
    assert_eq!(start(&turning), [0.0, 3.0]);
}

/// x'^2 + z'^2 = 1 is held by Chetaev's condition only if its kind is set to nonlinear.
#[test]
fn kinds_of_constraints_reach_the_text() {
    let particle = empty("A particle of given speed");
    for name in ["x", "z"] {
        say!(particle, pc_model_add_coordinate, name; 0.0).unwrap();
    }
    let (name, no_definition) = (c("x'"), ptr::null());
    // SAFETY: a live model and a text.
    call(|error| unsafe {
        pc_model_add_quasi_velocity(particle.0, name.as_ptr(), no_definition, 1.0, error)
    })
    .unwrap();
    say!(particle, pc_model_add_constraint, "speed", "x'^2 + z'^2 - 1").unwrap();
    say!(particle, pc_model_set_kinetic, "(x'^2 + z'^2)/2").unwrap();
    say!(particle, pc_model_set_potential, "10*z").unwrap();
    assert!(particle.system(PC_POINCARE).is_err());
    say!(particle, pc_model_set_constraint_kind, "speed", "nonlinear").unwrap();
    let system = particle.system(PC_POINCARE).unwrap();
    // The reaction is along the velocity, so only the component of gravity across it accelerates.
    let rates = system.at(pc_system_rhs, 0.0, &[0.0, 0.0, 0.6, 0.8], 4).unwrap();
    for (rate, expected) in rates.iter().zip([0.6, 0.8, 10.0 * 0.8 * 0.6, -10.0 * 0.6 * 0.6]) {
        assert!((rate - expected).abs() < 1e-14, "{rates:?}");
    }
    say!(particle, pc_model_set_constraint_kind, "speed", "elastic").unwrap();
    assert_eq!(say!(particle, pc_model_check).unwrap_err().status, PC_INVALID_MODEL);
}

#[test]
fn events_reach_the_text() {
    let ball = empty("A ball");
    say!(ball, pc_model_add_coordinate, "y"; 1.0).unwrap();
    say!(ball, pc_model_set_lagrangian, "y'^2/2 - 9.81*y").unwrap();
    let (name, when) = (c("bounce"), c("y"));
    // SAFETY: a live model and texts.
    call(|error| unsafe { pc_model_add_event(ball.0, name.as_ptr(), when.as_ptr(), 0, 0, error) }).unwrap();
    say!(ball, pc_model_add_event_reset, "bounce", "y'", "-0.8*y'").unwrap();
    say!(ball, pc_model_check).unwrap();
    let expected = "[events]\n\"bounce\".\"when\" = \"y\"\n\"bounce\".\"direction\" = \"both\"\n\
                    \"bounce\".\"terminal\" = false\n\"bounce\".\"reset\".\"y'\" = \"-0.8*y'\"\n";
    assert!(text(&ball).ends_with(expected), "{}", text(&ball));
    ball.system(PC_POINCARE).unwrap();
    say!(ball, pc_model_add_event_reset, "bounce", "y''", "0").unwrap();
    assert_eq!(say!(ball, pc_model_check).unwrap_err().status, PC_INVALID_MODEL);
}

#[test]
fn nulls_and_models_of_texts_are_refused() {
    let (draft, read, null) = (empty("x"), Model::named("euler-top"), ptr::null::<c_char>());
    let x = c("x");
    let (x, list) = (x.as_ptr(), ptr::null::<*const c_char>());
    let nulls = [null];
    macro_rules! refused {
        ($($function:ident($model:expr $(, $argument:expr)*) with $message:expr;)*) => {$(
            // SAFETY: live models, and texts or nulls, which are what is tested.
            let refusal = call(|error| unsafe { $function($model.0 $(, $argument)*, error) }).unwrap_err();
            assert_eq!(refusal.status, PC_INVALID_ARGUMENT);
            assert_eq!(refusal.message, $message);
        )*};
    }
    refused! {
        pc_model_add_body(draft, x, null, x, x, x) with "mass is a null pointer";
        pc_model_add_body(draft, x, x, x, x, null) with "z is a null pointer";
        pc_model_set_body_force(draft, null, x, x, x) with "body is a null pointer";
        pc_model_set_body_torque(draft, x, null, x, x) with "x is a null pointer";
        pc_model_set_body_angular_velocity(draft, x, x, null, x) with "y is a null pointer";
        pc_model_set_body_inertia(draft, x, list, 3) with "entries is a null pointer";
        pc_model_set_body_rotation(draft, x, nulls.as_ptr(), 1) with "entries is a null pointer";
        pc_model_set_description(draft, null) with "description is a null pointer";
        pc_model_set_reference(draft, null) with "reference is a null pointer";
        pc_model_set_start(draft, null, 1.0) with "name is a null pointer";
        pc_model_set_start_expression(draft, x, null) with "expression is a null pointer";
        pc_model_set_constraint_kind(draft, x, null) with "kind is a null pointer";
        pc_model_add_event(draft, x, null, 0, 0) with "when is a null pointer";
        pc_model_add_event_reset(draft, x, x, null) with "expression is a null pointer";
        pc_model_set_action(draft, null) with "expression is a null pointer";
        pc_model_add_action_constant(draft, null, 1.0) with "name is a null pointer";
        pc_model_add_action_constant(draft, x, f64::NAN) with "value is NaN, but must be finite";
        pc_model_set_method(draft, null) with "method is a null pointer";
        pc_model_set_form(draft, null) with "form is a null pointer";
        pc_model_set_start_time(draft, f64::NAN) with "t_start is NaN, but must be finite";
        pc_model_set_end_time(draft, f64::INFINITY) with "t_end is inf, but must be finite";
        pc_model_set_tolerances(draft, 1.0, f64::NAN) with "atol is NaN, but must be finite";
        pc_model_set_max_step(draft, f64::INFINITY) with "max_step is inf, but must be finite";
        pc_model_set_event_search(draft, 4, f64::NAN) with "accumulation is NaN, but must be finite";
        pc_model_set_samples(read, 3) with
            "pc_model_set_samples needs a model begun with pc_model_new; this one was read from a text";
        pc_model_add_body(read, x, x, x, x, x) with
            "pc_model_add_body needs a model begun with pc_model_new; this one was read from a text";
    }
    assert_eq!(text(&draft), "[model]\n\"name\" = \"x\"\n");
}
