//! Joints with rigid stops and with stiction: impacts, rest, and the way from rest into motion.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;
use std::process::Command;

use serde_json::Value;

/// `pc run` of a text: its exit code, what it says, and the contents of `-o FILE.json`.
fn told(text: &str, options: &[&str]) -> (Option<i32>, String, Option<Value>) {
    let directory = tempfile::tempdir().unwrap();
    let (model, result) = (directory.path().join("m.toml"), directory.path().join("run.json"));
    std::fs::write(&model, text).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    let output = command.arg("run").arg(&model).arg("-o").arg(&result).args(options).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let written = std::fs::read(&result).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
    (output.status.code(), said, written)
}

fn run(text: &str, options: &[&str]) -> Value {
    let (code, said, written) = told(text, options);
    assert_eq!(code, Some(0), "{said}\n{text}");
    written.unwrap()
}

/// A column.
fn column(run: &Value, name: &str) -> Vec<f64> {
    let place = run["columns"].as_array().unwrap().iter().position(|column| column == name).unwrap();
    run["rows"].as_array().unwrap().iter().map(|row| row[place].as_f64().unwrap()).collect()
}

fn last(run: &Value, name: &str) -> f64 {
    *column(run, name).last().unwrap()
}

/// The times of an event.
fn times(run: &Value, event: &str) -> Vec<f64> {
    let of_event = run["events"].as_array().unwrap().iter().filter(|found| found["name"] == event);
    of_event.map(|found| found["time"].as_f64().unwrap()).collect()
}

/// The parts in which the motion slides along a surface.
fn slides(run: &Value, surface: &str) -> Vec<(f64, Option<f64>)> {
    let all = run["summary"]["slides"].as_array().cloned().unwrap_or_default();
    let of_surface = all.iter().filter(|slide| slide["surface"] == surface);
    of_surface.map(|slide| (slide["from"].as_f64().unwrap(), slide["until"].as_f64())).collect()
}

fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() < tolerance, "{found}, not {expected}");
}

/// A body of mass 1 on a vertical rail with its floor at 0.
fn ball(restitution: f64, start: f64) -> String {
    format!(
        "[coordinates]\nball = {start:?}\n[gravity]\nacceleration = [0, 0, -2]\n[bodies.ball]\nmass = 1.0\n\
         joint = {{ kind = \"prismatic\", axis = [0, 0, 1], limits = [0, 10], restitution = {restitution:?} }}\n"
    )
}

/// With g = 2 and the height 1 the ball is down at 1, and each flight takes e times as long as the one before: all of
/// them end at (1 + e)/(1 − e), up to the flights lower than 1e-9 of the way.
#[test]
fn a_ball_bounces_until_it_lies() {
    for e in [0.8, 0.5, 0.1] {
        let end = run(&ball(e, 1.0), &["--t-end", "20", "--rows", "21"]);
        let bounces = times(&end, "ball_lower");
        let mut expected = 1.0;
        for (k, &time) in bounces.iter().take(6).enumerate() {
            assert_near(time, expected, 1e-8);
            expected += 2.0 * f64::powi(e, i32::try_from(k).unwrap() + 1);
        }
        let rest = slides(&end, "ball");
        let [(from, None)] = rest[..] else { panic!("rests at {rest:?}") };
        assert_near(from, (1.0 + e) / (1.0 - e), 1e-3);
        // It lies where its last flight was highest.
        let place = last(&end, "ball");
        assert!((-1e-12..1e-8).contains(&place), "lies at {place}");
        assert!(last(&end, "ball'").abs() < 1e-12);
    }
}

#[test]
fn a_ball_without_rebound_lies_at_once_and_one_without_loss_goes_on() {
    let lies = run(&ball(0.0, 1.0), &["--t-end", "5", "--rows", "3"]);
    assert_eq!(times(&lies, "ball_lower").len(), 1);
    assert_near(slides(&lies, "ball")[0].0, 1.0, 1e-9);
    assert!(last(&lies, "ball").abs() < 1e-12);
    let bounces = run(&ball(1.0, 1.0), &["--t-end", "20", "--rows", "3"]);
    let all = times(&bounces, "ball_lower");
    assert_eq!(all.len(), 10);
    all.iter().zip(0..).for_each(|(&time, k)| assert_near(time, 1.0 + 2.0 * f64::from(k), 1e-7));
    assert!(slides(&bounces, "ball").is_empty());
}

/// A start at rest on the floor is rest.
#[test]
fn what_lies_on_a_stop_stays_there() {
    for method in ["auto", "adams", "bdf", "dop853"] {
        let lies = run(&ball(0.5, 0.0), &["--t-end", "1000", "--rows", "3", "--method", method]);
        assert!(last(&lies, "ball").abs() < 1e-12, "{method}: {}", last(&lies, "ball"));
        assert!(times(&lies, "ball_lower").is_empty());
        assert!(lies["summary"]["steps"].as_u64().unwrap() < 200, "{method}");
    }
}

/// −cos t pushes a body of mass 1 against its stop until π/2, and lifts it then: x = t − π/2 + cos t.
#[test]
fn a_stop_holds_as_long_as_it_is_pressed() {
    let text = "[gravity]\nacceleration = [0, 0, 0]\n[bodies.b]\nmass = 1.0\n\
                joint = { kind = \"prismatic\", axis = [1, 0, 0], limits = [0, 10], restitution = 0.5 }\n\
                [forces]\n\"b'\" = \"-cos(t)\"\n";
    let lifts = run(text, &["--t-end", "3", "--rows", "31"]);
    for (t, x) in column(&lifts, "t").into_iter().zip(column(&lifts, "b")) {
        assert_near(x, if t < FRAC_PI_2 { 0.0 } else { t - FRAC_PI_2 + t.cos() }, 1e-8);
    }
    let [(from, Some(until))] = slides(&lifts, "b")[..] else { panic!("{:?}", slides(&lifts, "b")) };
    assert_near(from, 0.0, 1e-12);
    assert_near(until, FRAC_PI_2, 1e-8);
}

/// The complete elliptic integral K(k), by the arithmetic-geometric mean.
fn elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    while (a - b).abs() > 1e-15 {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    PI / (2.0 * a)
}

/// A pendulum that strikes a wall below its axis: the angle φ of its swing has sin φ/2 = e^n sin φ_0/2 after n impacts,
/// and the swing takes 2 K(sin φ/2)/ω.
#[test]
fn a_pendulum_bounces_off_a_wall() {
    let e = 0.9f64;
    let text = format!(
        "[coordinates]\np = 2.0\n[gravity]\nacceleration = [0, 0, -9]\n[bodies.p]\nmass = 2.0\ncenter = [0, 0, -1]\n\
         joint = {{ kind = \"revolute\", axis = [0, 1, 0], limits = [0, 3], restitution = {e:?} }}\n"
    );
    let swings = run(&text, &["--t-end", "12", "--rows", "3"]);
    let (mut k, mut expected) = (f64::sin(1.0), elliptic(f64::sin(1.0)) / 3.0);
    let found = times(&swings, "p_lower");
    assert!(found.len() > 8);
    for &time in &found {
        // Tolerances of 1e-9 a step.
        assert_near(time, expected, 1e-7);
        k *= e;
        expected += 2.0 * elliptic(k) / 3.0;
    }
}

/// A cart strikes the end of its rail with e = 0: the momentum of the pendulum on it, m l cos φ x' + m l² φ', stays, and
/// the cart rests as long as the pendulum presses it.
#[test]
fn an_impact_moves_all_joints() {
    let text = "[coordinates]\ncart = 0.0\narm = 0.5\n[quasi_velocities]\n\"cart'\" = 1.0\n\
                [gravity]\nacceleration = [0, 0, 0]\n\
                [bodies.cart]\nmass = 3.0\njoint = { kind = \"prismatic\", axis = [1, 0, 0], limits = [-5, 1], restitution = 0 }\n\
                [bodies.arm]\nparent = \"cart\"\nmass = 2.0\ncenter = [0, 0, -0.7]\njoint = { kind = \"revolute\", axis = [0, -1, 0] }\n\
                [outputs]\np = \"2*0.7*cos(arm)*cart' + 2*0.49*arm'\"\n";
    let strikes = run(text, &["--t-end", "1.5", "--rows", "31"]);
    let hits = times(&strikes, "cart_upper");
    assert_eq!(hits.len(), 1);
    assert_near(hits[0], 1.0, 1e-9);
    // Before the impact the arm does not turn; at it p stays.
    let turns = column(&strikes, "arm'");
    let before = 2.0 * 0.7 * f64::cos(0.5);
    let after = before / (2.0 * 0.49);
    let (t, arm) = (column(&strikes, "t"), column(&strikes, "arm"));
    for ((t, arm), turn) in t.into_iter().zip(arm).zip(turns) {
        let expected = if t < 1.0 { (0.5, 0.0) } else { (0.5 + after * (t - 1.0), after) };
        // The centrifugal force m l φ'² sin φ pulls the cart on, against its stop, while φ is between 0 and π.
        assert_near(turn, expected.1, 1e-7);
        assert_near(arm, expected.0, 1e-7);
    }
    assert_near(last(&strikes, "cart"), 1.0, 1e-12);
}

/// A slider of mass 1 strikes the end of its rail on a block of mass 3: the momentum of both stays, and they part at half
/// the speed at which they met.
#[test]
fn two_bodies_keep_their_momentum() {
    let text = "[quasi_velocities]\n\"b'\" = 1.0\n[bodies.a]\nmass = 3.0\njoint = { kind = \"prismatic\", axis = [1, 0, 0] }\n\
                [bodies.b]\nparent = \"a\"\nmass = 1.0\n\
                joint = { kind = \"prismatic\", axis = [1, 0, 0], limits = [-1, 0.5], restitution = 0.5 }\n";
    let parts = run(text, &["--t-end", "1", "--rows", "3"]);
    assert_near(times(&parts, "b_upper")[0], 0.5, 1e-12);
    assert_near(last(&parts, "b'"), -0.5, 1e-14);
    // 1 = 3 v + (v − 1/2)
    assert_near(last(&parts, "a'"), 0.375, 1e-14);
    let energy = column(&parts, "energy");
    // ½ (1 − e²) v²/(w·M⁻¹ w), with the reduced mass 3/4.
    assert_near(energy[0] - energy[2], 0.5 * 0.75 * 0.75, 1e-14);
}

/// A block rests on its stop, and a slider on it strikes its own: the stop of the block takes the impulse.
#[test]
fn what_rests_on_a_stop_is_not_driven_through_it() {
    let text = "[coordinates]\nb = 1.0\n[gravity]\nacceleration = [-2, 0, 0]\n[bodies.a]\nmass = 3.0\n\
                joint = { kind = \"prismatic\", axis = [1, 0, 0], limits = [0, 10], restitution = 0.3 }\n\
                [bodies.b]\nparent = \"a\"\nmass = 1.0\n\
                joint = { kind = \"prismatic\", axis = [1, 0, 0], limits = [0, 10], restitution = 0.5 }\n";
    let falls = run(text, &["--t-end", "1.5", "--rows", "7"]);
    assert_near(times(&falls, "b_lower")[0], 1.0, 1e-9);
    assert_near(last(&falls, "b"), 0.25, 1e-8);
    column(&falls, "a").into_iter().for_each(|a| assert_near(a, 0.0, 1e-12));
}

/// A wheel geared to a block by 4, with the stop on the wheel: the block stops where the wheel is at its end, and both
/// go back at half their speeds.
#[test]
fn the_stop_of_a_follower_stops_the_leader() {
    let text = "[quasi_velocities]\n\"block'\" = 1.0\n[bodies.block]\nmass = 2.0\njoint = { kind = \"prismatic\", axis = [1, 0, 0] }\n\
                [bodies.wheel]\njoint = { kind = \"revolute\", axis = [0, 1, 0], follows = \"block\", ratio = 4.0, armature = 0.25, \
                limits = [-8, 8], restitution = 0.5 }\n";
    let turns = run(text, &["--t-end", "4", "--rows", "5"]);
    assert_near(times(&turns, "wheel_upper")[0], 2.0, 1e-9);
    assert_near(last(&turns, "block'"), -0.5, 1e-12);
    assert_near(last(&turns, "wheel"), 4.0, 1e-8);
}

/// A crank of a parallelogram strikes a stop: its three bars keep moving as one, at half their speeds. By joints and
/// with all velocities the same.
#[test]
fn loops_stay_closed_in_an_impact() {
    let bar = |name: &str, parent: &str, joint: &str, length: f64| {
        format!(
            "[bodies.{name}]\n{parent}joint = {{ kind = \"revolute\", axis = [0, 0, 1]{joint} }}\nmass = {length:?}\n\
             center = [{:?}, 0, 0]\ninertia = [0, 0.1, 0.1]\n",
            length / 2.0
        )
    };
    let text = format!(
        "[coordinates]\ncrank = \"pi/2\"\ncoupler = \"-pi/2\"\nrocker = \"pi/2\"\n[quasi_velocities]\n\"crank'\" = -1.0\n{}{}{}\
         [loops.pin]\nkind = \"point\"\nbodies = [\"coupler\", \"rocker\"]\nat = [[2, 0, 0], [1, 0, 0]]\n",
        bar("crank", "", ", limits = [1, 3], restitution = 0.5", 1.0),
        bar("coupler", "parent = \"crank\"\n", ", at = [1, 0, 0]", 2.0),
        bar("rocker", "", ", at = [2, 0, 0]", 1.0),
    );
    let turns = run(&text, &["--t-end", "1", "--rows", "101"]);
    // The coupler is moved without turning: all is as for one joint, whose speed is constant.
    let hits = times(&turns, "crank_lower");
    assert_near(hits[0], FRAC_PI_2 - 1.0, 1e-7);
    assert_near(last(&turns, "crank'"), 0.5, 1e-7);
    assert_near(last(&turns, "rocker'"), 0.5, 1e-7);
    assert_near(last(&turns, "coupler'"), -0.5, 1e-7);
}

/// Two fingers of four joints under their weight, with these starts.
fn hand(starts: &str) -> String {
    let mut text = format!("[coordinates]\n{starts}[gravity]\nacceleration = [0, 0, -9.81]\n");
    for i in 0..8 {
        let (parent, at) = match i % 4 {
            0 => (String::new(), format!("[0, {:?}, 0]", 0.05 * f64::from(i / 4))),
            _ => (format!("parent = \"f{}\"\n", i - 1), "[0.1, 0, 0]".to_owned()),
        };
        writeln!(
            text,
            "[bodies.f{i}]\n{parent}joint = {{ kind = \"revolute\", axis = [0, 1, 0], at = {at}, damping = 0.01, \
             limits = [-1, 0], restitution = 0.3 }}\nmass = 0.1\ncenter = [0.05, 0, 0]\ninertia = [1e-4, 1e-4, 1e-4]"
        )
        .unwrap();
    }
    text
}

/// Each joint at its stop: all of them rest there, in few steps.
#[test]
fn a_hand_rests_on_its_stops() {
    let end = run(&hand(""), &["--t-end", "100", "--rows", "11"]);
    for i in 0..8 {
        assert_near(last(&end, &format!("f{i}")), 0.0, 1e-12);
    }
    assert!(end["summary"]["steps"].as_u64().unwrap() < 100);
}

/// Fingers that fall open strike their stops one after the other and in turn, ever faster, until they rest.
#[test]
fn a_hand_falls_open_and_rests() {
    let end = run(&hand("f0 = -0.5\nf2 = -0.3\nf5 = -0.4\n"), &["--t-end", "10", "--rows", "11"]);
    for i in 0..8 {
        // They lie within 1e-9 of the way.
        assert_near(last(&end, &format!("f{i}")), 0.0, 2e-9);
        assert_near(last(&end, &format!("f{i}'")), 0.0, 1e-9);
    }
    let energy = column(&end, "energy");
    assert!(energy.last() < energy.first());
}

/// A block of mass 1 on a spring of stiffness 1 whose end is pulled at V = 1/2, with the friction 1/2 and the stiction 1:
/// it breaks loose when the spring pulls with 1, slips for 2π − 2 arctan q with q = (F_s − F)/V, and sticks for
/// 2 (F_s − F)/V.
#[test]
fn stick_and_slip_by_turns() {
    let text = "[parameters]\nV = 0.5\n[bodies.b]\nmass = 1.0\n\
                joint = { kind = \"prismatic\", axis = [1, 0, 0], friction = 0.5, stiction = 1.0 }\n\
                [lagrangian]\npotential = \"(b - V*t)^2/2\"\n";
    for (method, tolerance) in [("auto", 1e-8), ("adams", 1e-8), ("bdf", 1e-7)] {
        let moves = run(text, &["--t-end", "40", "--rows", "3", "--method", method, "--rtol", "1e-11"]);
        let sticks = slides(&moves, "b'");
        assert!(sticks.len() > 4, "{sticks:?}");
        let (q, mut from) = (0.5 / 0.5, 0.0);
        let mut until = 1.0 / 0.5;
        for (found_from, found_until) in sticks {
            assert_near(found_from, from, tolerance);
            let Some(found_until) = found_until else { continue };
            assert_near(found_until, until, tolerance);
            from = until + 2.0 * PI - 2.0 * f64::atan(q);
            until = from + 2.0 * 0.5 / 0.5;
        }
    }
}

/// At rest the friction 1 with the stiction 2 holds against 1.5, and no longer against 2.5; once it slides, 1.5 keeps it
/// going.
#[test]
fn stiction_holds_more_than_friction() {
    let text = |push: f64, speed: f64| {
        format!(
            "[quasi_velocities]\n\"b'\" = {speed:?}\n[bodies.b]\nmass = 1.0\n\
             joint = {{ kind = \"prismatic\", axis = [1, 0, 0], friction = 1.0, stiction = 2.0 }}\n[forces]\n\"b'\" = {push:?}\n"
        )
    };
    let options = ["--t-end", "2", "--rows", "3"];
    assert_near(last(&run(&text(1.5, 0.0), &options), "b"), 0.0, 1e-12);
    assert_near(last(&run(&text(2.5, 0.0), &options), "b"), 3.0, 1e-8);
    assert_near(last(&run(&text(1.5, 1.0), &options), "b"), 2.0 + 1.0, 1e-8);
    // Against the push it stops after 1/2.5 at 1/5, and stays.
    let stops = run(&text(-1.5, 1.0), &options);
    assert_near(last(&stops, "b"), 0.2, 1e-8);
    assert_near(last(&stops, "b'"), 0.0, 1e-12);
}

#[test]
fn what_contradicts_itself_is_refused() {
    for (joint, start, expected) in [
        ("limits = [0, 1]", "", "`limits` has no effect without `restitution` or `stop_stiffness`"),
        ("restitution = 0.5", "", "`restitution` has no effect without `limits`"),
        (
            "limits = [0, 1], restitution = 0.5, stop_stiffness = 3",
            "",
            "`restitution` and `stop_stiffness` exclude each other",
        ),
        (
            "limits = [0, 1], restitution = 1.5",
            "",
            "a coefficient of restitution is between 0 and 1, not 1.5",
        ),
        (
            "limits = [1, 0], restitution = 0.5",
            "",
            "the lower end of the way of `b` is not below the upper one",
        ),
        ("limits = [0.5, 1], restitution = 0.5", "", "`b` starts beyond its lower end, by 0.5"),
        (
            "limits = [-1, 0], restitution = 0.5",
            "[quasi_velocities]\n\"b'\" = 1.0\n",
            "`b` starts at its upper end with a velocity that leads beyond it",
        ),
        ("stiction = 2", "", "`stiction` has no effect without `friction`"),
        ("friction = 3, stiction = 2", "", "stiction 2 is less than the friction 3, or that is 0"),
    ] {
        let text = format!(
            "{start}[bodies.b]\nmass = 1.0\njoint = {{ kind = \"prismatic\", axis = [1, 0, 0], {joint} }}\n"
        );
        let (code, said, _) = told(&text, &["--t-end", "1"]);
        assert!(matches!(code, Some(3 | 4)) && said.contains(expected), "{said}");
    }
}

/// Forms in momenta, and FMUs, have no forces that act at rest only.
#[test]
fn forms_in_momenta_are_refused() {
    let (code, said, _) = told(&ball(0.5, 1.0), &["--t-end", "1", "--form", "canonical"]);
    assert_eq!(code, Some(4), "{said}");
    assert!(
        said.contains("its joints are held at rest by stops or stiction, but this form has momenta"),
        "{said}"
    );
}

/// Stops that no motion could hold are refused; without them, the blocks would go through their ends.
#[test]
fn more_stops_than_a_motion_can_hold_are_refused() {
    let mut text = String::new();
    for i in 0..70 {
        writeln!(
            text,
            "[bodies.b{i}]\nmass = 1\n\
             joint = {{ kind = \"prismatic\", axis = [1, 0, 0], limits = [0, 1], restitution = 0.5 }}"
        )
        .unwrap();
    }
    let (code, said, written) = told(&text, &["--t-end", "1"]);
    assert_eq!((code, written), (Some(4), None), "{said}");
    let said = said.split_once("m.toml:").unwrap().1;
    assert_eq!(
        said,
        "1:1: [bodies.b0]: dry friction and rigid stops of the joints make 280 surfaces on which a motion can stay; the most \
         that are followed at a time are 256\n    [bodies.b0]\n    ^^^^^^^^^^^\n  \
         help: give fewer joints friction or rigid stops; stops with `stop_stiffness` need no surfaces to stay on\n"
    );
}

/// A pair of legs on smooth ground folds until its hinge strikes a stop without rebound. Nothing moves any more but along the ground.
#[test]
fn legs_rest_on_the_ground_and_at_the_stop_of_their_hinge() {
    let leg = |name: &str, hung: &str, mass: f64, inertia: f64| {
        format!(
            "[bodies.{name}]\n{hung}\nmass = {mass:?}\ncenter = [0, 0, -0.5]\ninertia = [0, {inertia:?}, 0]\n\
             [contacts.foot_{name}]\nbody = \"{name}\"\nshape = \"disc\"\naxis = [0, 1, 0]\nradius = 0.02\nat = [0, 0, -1]\n\
             motion = \"slides\"\n"
        )
    };
    let hinge = "parent = \"a\"\njoint = { kind = \"revolute\", axis = [0, 1, 0], limits = [-1.0, 0.5], restitution = 0 }";
    let text = format!(
        "[coordinates]\na_z = 0.9410609940028851\n\"a_φ\" = 0.4\nb = -0.8\n[gravity]\nacceleration = [0, 0, -9.81]\n{}{}",
        leg("a", "joint = { kind = \"planar\", axis = [0, 1, 0] }", 1.0, 1.0 / 12.0),
        leg("b", hinge, 1.5, 0.125)
    );
    let run = run(&text, &["--t-end", "1", "--rows", "201"]);
    assert_eq!(times(&run, "b_lower").len(), 1);
    // The stop is reached to within 1e-9 of the way.
    assert!(column(&run, "b").into_iter().all(|b| b >= -1.0 - 1e-8), "{:?}", column(&run, "b"));
    assert!(last(&run, "b'").abs() < 1e-9);
}
