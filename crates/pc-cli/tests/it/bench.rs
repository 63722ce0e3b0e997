//! `pc bench`: all measurements are present; the times themselves are not tested.

use std::process::{Command, Output};

use serde_json::Value;

fn pc(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc starts");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    output
}

fn measured(model: &str, more: &[&str]) -> Value {
    let arguments = ["bench", model, "--seconds", "0.01", "--format", "json"];
    serde_json::from_slice(&pc(&[&arguments[..], more].concat()).stdout).expect("JSON")
}

fn kernels(figures: &Value) -> Vec<&str> {
    figures["evaluations"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|kernel| kernel["name"].as_str())
        .collect()
}

const INTERPRETED: &str = "right-hand side, interpreted";
const COMPILED: &str = "right-hand side, machine code";
const BOUND: &str = "right-hand side, parameters bound";
const JACOBIAN: &str = "Jacobian, machine code";
const OBSERVED: &str = "integrals, energy, outputs";

#[test]
fn every_kernel_and_stage_is_measured() {
    let figures = measured("heavy-top-euler", &[]);
    assert_eq!(kernels(&figures), [INTERPRETED, COMPILED, BOUND, JACOBIAN, OBSERVED]);
    let stages = figures["derivation_ms"].as_object().expect("an object");
    let names: Vec<&str> = stages.keys().map(String::as_str).collect();
    assert_eq!(names, ["text", "system", "equations", "programs", "machine code", "total"]);
    let kernels = figures["evaluations"].as_array().expect("a list").iter().map(|kernel| &kernel["ns"]);
    for times in stages.values().chain(kernels) {
        let [minimum, tenth, median] =
            ["minimum", "tenth", "median"].map(|name| times[name].as_f64().expect("a number"));
        assert!(0.0 < minimum && minimum <= tenth && tenth <= median, "{times}");
    }
    assert!(figures["derivations"].as_u64() >= Some(1) && figures["rounds"].as_u64() >= Some(3));
    assert_eq!(figures["state"], 6);
}

/// Numbers in place of parameters save operations; the interpreter and the machine code run the
/// same program.
#[test]
fn operations_are_those_of_the_programs() {
    let figures = measured("heavy-top-euler", &[]);
    let operations = |name: &str| {
        let all = figures["evaluations"].as_array().expect("a list");
        all.iter().find(|kernel| kernel["name"] == name).expect("measured")["operations"]
            .as_u64()
            .expect("a number")
    };
    assert_eq!(operations(INTERPRETED), operations(COMPILED));
    assert!(operations(BOUND) < operations(COMPILED));
    let kinds = figures["operations"].as_object().expect("an object");
    assert_eq!(kinds.values().filter_map(Value::as_u64).sum::<u64>(), operations(COMPILED));
}

/// Multipliers have no bound form, nor have inputs that change with time.
#[test]
fn missing_kernels_are_left_out() {
    assert_eq!(
        kernels(&measured("pendulum-chain-cartesian", &[])),
        [INTERPRETED, COMPILED, BOUND, JACOBIAN, OBSERVED]
    );
    assert_eq!(kernels(&measured("appell-hamel", &[])), [INTERPRETED, COMPILED, JACOBIAN, OBSERVED]);
    let starter = tempfile::tempdir().expect("a directory");
    let file = starter.path().join("control.toml").display().to_string();
    pc(&["new", "control", "-o", &file]);
    assert_eq!(kernels(&measured(&file, &[])), [INTERPRETED, COMPILED, JACOBIAN, OBSERVED]);
}

#[test]
fn the_table_is_for_people() {
    let text = String::from_utf8(pc(&["bench", "euler-top", "--seconds", "0.01"]).stdout).expect("UTF-8");
    for wanted in [
        "Euler's top\n",
        "3 numbers",
        "derivation, ms, ",
        "an evaluation, ns, ",
        COMPILED,
        "minimum",
        "10th %",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text}");
    }
    assert_eq!(text.contains("times mean nothing"), cfg!(debug_assertions));
}

#[test]
fn a_wrong_model_is_refused_before_anything_is_measured() {
    let output =
        Command::new(env!("CARGO_BIN_EXE_pc")).args(["bench", "euler-top", "--set", "I1=0"]).output();
    let output = output.expect("pc starts");
    assert_eq!(output.status.code(), Some(4), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());
    let output =
        Command::new(env!("CARGO_BIN_EXE_pc")).args(["bench", "euler-top", "--seconds", "0"]).output();
    assert_eq!(output.expect("pc starts").status.code(), Some(2));
}
