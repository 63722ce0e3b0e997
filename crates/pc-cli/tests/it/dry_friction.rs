//! Dry friction of joints: they slide, stop and stay, in small trees and in large ones.

use std::fmt::Write;
use std::process::Command;

use serde_json::Value;

/// The contents of `-o FILE.json` after a run of a text that succeeds.
fn run(text: &str, options: &[&str]) -> Value {
    let directory = tempfile::tempdir().unwrap();
    let (model, result) = (directory.path().join("m.toml"), directory.path().join("run.json"));
    std::fs::write(&model, text).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    let output = command.arg("run").arg(&model).arg("-o").arg(&result).args(options).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}\n{text}");
    serde_json::from_slice(&std::fs::read(&result).unwrap()).unwrap()
}

/// The last value of a column.
fn last(run: &Value, column: &str) -> f64 {
    let place = run["columns"].as_array().unwrap().iter().position(|name| name == column).unwrap();
    run["rows"].as_array().unwrap().last().unwrap()[place].as_f64().unwrap()
}

/// Blocks of mass 1 on one rail each, with the speed 2 at first and friction i/2 for i = 1, 2, …
fn blocks(count: usize) -> String {
    let mut text = String::from("[quasi_velocities]\n");
    for i in 1..=count {
        writeln!(text, "\"b{i}'\" = 2.0").unwrap();
    }
    for i in 1..=count {
        let joint =
            format!("joint = {{ kind = \"prismatic\", axis = [1, 0, 0], friction = {:?} }}", 0.5 * i as f64);
        writeln!(text, "[bodies.b{i}]\n{joint}\nmass = 1.0").unwrap();
    }
    text
}

/// A block stops after the way v²/(2 F).
#[test]
fn blocks_slide_until_they_stop() {
    for count in [3, 7] {
        let end = run(&blocks(count), &["--t-end", "6", "--rows", "7"]);
        for i in 1..=count {
            // The tolerances are 1e-9.
            let (way, expected) = (last(&end, &format!("b{i}")), 4.0 / i as f64);
            assert!((way - expected).abs() < 1e-7, "{count} blocks: b{i} at {way}, not {expected}");
            assert!(last(&end, &format!("b{i}'")).abs() < 1e-9, "b{i} moves on");
        }
    }
}

/// Fingers of four joints under their weight, each with more friction than its weight has torque.
fn fingers(count: usize, friction: f64) -> String {
    let mut text = String::from("[gravity]\nacceleration = [0, 0, -9.81]\n");
    for i in 0..4 * count {
        let (parent, at) = match i % 4 {
            0 => (String::new(), format!("[0, {:?}, 0]", 0.05 * (i / 4) as f64)),
            _ => (format!("parent = \"f{}\"\n", i - 1), "[0.1, 0, 0]".to_owned()),
        };
        writeln!(
            text,
            "[bodies.f{i}]\n{parent}joint = {{ kind = \"revolute\", axis = [0, 1, 0], at = {at}, damping = 0.01, friction = {friction:?} }}\n\
             mass = 0.1\ncenter = [0.05, 0, 0]\ninertia = [1e-4, 1e-4, 1e-4]"
        )
        .unwrap();
    }
    text
}

#[test]
fn sixteen_joints_stay_where_friction_holds_them() {
    let end = run(&fingers(4, 1.0), &["--t-end", "1000", "--rows", "11"]);
    for i in 0..16 {
        let angle = last(&end, &format!("f{i}"));
        assert!(angle.abs() < 1e-6, "f{i} crept to {angle}");
    }
    // The mean step is a tenth of a second at least.
    let steps = end["summary"]["steps"].as_u64().unwrap();
    assert!(steps < 10_000, "{steps} steps of a hand at rest");
}

/// The energy of a double pendulum and the work done against friction: their sum stays, through all reversals and up to
/// the end, at which both joints rest.
#[test]
fn energy_is_lost_to_friction_alone() {
    let text = "[coordinates]\nu = 1.2\nf = -0.7\n[gravity]\nacceleration = [0, 0, -9.81]\n\
                [bodies.u]\nmass = 1.0\ncenter = [0, 0, -0.5]\ninertia = [0.01, 0.01, 0.01]\n\
                joint = { kind = \"revolute\", axis = [0, 1, 0], friction = 0.4, stiction = 0.6 }\n\
                [bodies.f]\nparent = \"u\"\nmass = 0.5\ncenter = [0, 0, -0.4]\ninertia = [0.01, 0.01, 0.01]\n\
                joint = { kind = \"revolute\", axis = [0, 1, 0], at = [0, 0, -1], friction = 0.3 }\n\
                [states]\nwork = { rate = \"0.4*abs(u') + 0.3*abs(f')\" }\n";
    let end = run(text, &["--t-end", "30", "--rows", "301"]);
    let columns = end["columns"].as_array().unwrap();
    let [energy, work] =
        ["energy", "work"].map(|name| columns.iter().position(|column| column == name).unwrap());
    let of_row = |row: &Value| row[energy].as_f64().unwrap() + row[work].as_f64().unwrap();
    let sums: Vec<f64> = end["rows"].as_array().unwrap().iter().map(of_row).collect();
    // Tolerances of 1e-9, over some hundred steps.
    sums.iter().for_each(|sum| assert!((sum - sums[0]).abs() < 1e-6, "{sum} after {}", sums[0]));
    for rate in ["u'", "f'"] {
        assert!(last(&end, rate).abs() < 1e-9, "{rate} is {}", last(&end, rate));
    }
}

/// A wheel geared to a block by x = r φ, with the friction F on the wheel: the block feels F/r.
#[test]
fn friction_of_a_geared_joint_holds_the_one_that_it_follows() {
    let text = |slope: f64| {
        format!(
            "[gravity]\nacceleration = [{slope:?}, 0, 0]\n[bodies.block]\njoint = {{ kind = \"prismatic\", axis = [1, 0, 0] }}\nmass = 2.0\n\
             [bodies.wheel]\njoint = {{ kind = \"revolute\", axis = [0, 1, 0], follows = \"block\", ratio = 4.0, friction = 0.5, \
             armature = 0.25 }}\n"
        )
    };
    // 2 g < 4 · 0.5 holds; else (2 + 16/4) x'' = 2 g − 2.
    let held = run(&text(0.9), &["--t-end", "5", "--rows", "3"]);
    assert!(last(&held, "block").abs() < 1e-9);
    let slides = run(&text(4.0), &["--t-end", "3", "--rows", "3"]);
    let expected = (8.0 - 2.0) / 6.0 * 9.0 / 2.0;
    assert!((last(&slides, "block") - expected).abs() < 1e-7);
    assert!((last(&slides, "wheel") - 4.0 * expected).abs() < 1e-6);
}

/// LuGre's law as docs/modelling.md writes it, under the force `pull`.
fn bristles(pull: &str) -> String {
    format!(
        "[parameters]\n\"σ0\" = 1e5\n\"σ1\" = \"sqrt(σ0)\"\n\"σ2\" = 0.4\nFc = 1.0\nFs = 1.5\nvs = 0.001\n\
         [bodies.b]\njoint = {{ kind = \"prismatic\", axis = [1, 0, 0] }}\nmass = 1.0\n\
         [definitions]\ng = \"Fc + (Fs - Fc)*exp(-(b'/vs)^2)\"\nbends = \"b' - σ0*abs(b')*z/g\"\n[states]\nz = {{ rate = \"bends\" }}\n\
         [forces]\n\"b'\" = \"{pull} - σ0*z - σ1*bends - σ2*b'\"\n"
    )
}

/// Before it breaks loose a block moves by x with σ_0 z = F_s (1 − exp(−σ_0 x/F_s)), which is the force; under a slow force
/// it breaks loose at F_s; under a constant one above F_s it comes to the speed at which g(v) + σ_2 v is the force.
#[test]
fn bristles_bend_and_slip() {
    let bdf = ["--rows", "1501", "--method", "bdf"];
    let slow = run(&bristles("0.1*t"), &[&["--t-end", "15"], &bdf[..]].concat());
    let rows = slow["rows"].as_array().unwrap();
    let at = |row: &Value, place: usize| row[place].as_f64().unwrap();
    for row in &rows[100..1000] {
        let (force, x) = (0.1 * at(row, 0), at(row, 1));
        // The bristles bend at 1e-6 a second, against their damping.
        let expected = -1.5e-5 * f64::ln(1.0 - (force - 1e-6 * 1e5f64.sqrt()) / 1.5);
        // g is F_s up to (v/v_s)², and inertia takes less than 1e-4 of the force.
        assert!((x - expected).abs() < 1e-3 * expected, "{x}, not {expected} at {force}");
    }
    let loose = rows.iter().find(|row| at(row, 2) > 1e-3).map_or(f64::NAN, |row| 0.1 * at(row, 0));
    assert!((1.45..1.5).contains(&loose), "it breaks loose at {loose}");
    let steady = run(&bristles("2"), &[&["--t-end", "60"], &bdf[..]].concat());
    // At 2.5 m/s the friction has long been F_c: 2 = 1 + 0.4 v.
    assert!((last(&steady, "b'") - 2.5).abs() < 1e-6, "{}", last(&steady, "b'"));
    assert!((1e5 * last(&steady, "z") - 1.0).abs() < 1e-6);
}
