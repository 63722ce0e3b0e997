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
        let end = run(&blocks(count), &["--t-end", "6", "--samples", "7"]);
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
    let end = run(&fingers(4, 1.0), &["--t-end", "1000", "--samples", "11"]);
    for i in 0..16 {
        let angle = last(&end, &format!("f{i}"));
        assert!(angle.abs() < 1e-6, "f{i} crept to {angle}");
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
    let held = run(&text(0.9), &["--t-end", "5", "--samples", "3"]);
    assert!(last(&held, "block").abs() < 1e-9);
    let slides = run(&text(4.0), &["--t-end", "3", "--samples", "3"]);
    let expected = (8.0 - 2.0) / 6.0 * 9.0 / 2.0;
    assert!((last(&slides, "block") - expected).abs() < 1e-7);
    assert!((last(&slides, "wheel") - 4.0 * expected).abs() < 1e-6);
}
