//! Instructions of evaluations and steps through the C interface, against those that are kept.
//!
//! Times depend on the machine and its load; instructions, counted by callgrind, do not. `KEEP_COSTS=1` writes the
//! file anew.

use std::collections::HashMap;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// Counts may grow by this part: functions of the C library, which chooses among several by the processor, are
/// among them.
const SLACK: f64 = 0.1;

#[test]
fn evaluations_and_steps_take_no_more_instructions() {
    if !is_as_kept() {
        eprintln!("skipped: the kept counts are those of x86-64 with AVX2 and FMA under Linux");
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("callgrind.out");
    let program = env!("CARGO_BIN_EXE_counted");
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--quiet"]);
    command.arg(format!("--callgrind-out-file={}", out.display())).arg(program);
    let Ok(output) = command.output() else {
        eprintln!("skipped: there is no valgrind");
        return;
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let profile = fs::read_to_string(&out).unwrap();
    let costs = inclusive_costs(&profile);
    let printed = String::from_utf8(output.stdout).unwrap();
    let rows: Vec<(&str, f64)> = printed
        .lines()
        .map(|line| {
            let (name, units) = line.split_once(' ').unwrap();
            let cost = costs.get(name).unwrap_or_else(|| panic!("no cost of {name} in the profile"));
            (name, *cost as f64 / units.parse::<f64>().unwrap())
        })
        .collect();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("kept-instructions.txt");
    let head =
        "# Instructions of an evaluation or a step through the C interface, in a build for development\n";
    let text: String = rows.iter().map(|(name, each)| format!("{name} {each:.0}\n")).collect();
    if env::var_os("KEEP_COSTS").is_some() {
        fs::write(&file, format!("{head}{text}")).unwrap();
        return;
    }
    let kept = fs::read_to_string(&file).unwrap();
    let kept: HashMap<&str, f64> = kept
        .lines()
        .filter(|line| !line.starts_with('#'))
        .filter_map(|line| line.split_once(' '))
        .map(|(name, each)| (name, each.parse().unwrap()))
        .collect();
    assert_eq!(kept.len(), rows.len(), "a row for each count:\n{text}");
    for (name, each) in rows {
        assert!(
            each <= kept[name] * (1.0 + SLACK),
            "{name}: {each:.0} instructions instead of {}",
            kept[name]
        );
    }
}

/// Whether this is a processor of the kind for which counts are kept.
fn is_as_kept() -> bool {
    #[cfg(all(target_arch = "x86_64", target_os = "linux"))]
    return is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma");
    #[cfg(not(all(target_arch = "x86_64", target_os = "linux")))]
    return false;
}

/// The instructions of each function called from another one, with those of the functions that it calls.
fn inclusive_costs(profile: &str) -> HashMap<&str, u64> {
    // Names are written once, `(number) name`, and then by number.
    let mut names: HashMap<&str, &str> = HashMap::new();
    let mut costs = HashMap::new();
    let mut called = None;
    let mut lines = profile.lines();
    while let Some(line) = lines.next() {
        if let Some(function) = line.strip_prefix("cfn=").or_else(|| line.strip_prefix("fn=")) {
            let (number, name) = function.split_once(' ').unwrap_or((function, ""));
            if !name.is_empty() {
                names.insert(number, name);
            }
            called = line.starts_with("cfn=").then_some(number);
        } else if line.starts_with("calls=")
            && let Some(cost) = lines.next().and_then(|line| line.split_whitespace().nth(1))
            && let Some(&name) = called.and_then(|number| names.get(number))
        {
            *costs.entry(name).or_insert(0) += cost.parse::<u64>().unwrap_or(0);
        }
    }
    costs
}

#[test]
fn costs_are_read_from_a_profile() {
    let profile = "\
fn=(1) main
12 5
cfn=(2) row
calls=1 40
13 700
cfn=(2)
calls=2 40
14 50

fn=(2)
40 250
cfn=(3) leaf
calls=9 60
41 500
";
    let costs = inclusive_costs(profile);
    assert_eq!((costs["row"], costs["leaf"]), (750, 500));
}
