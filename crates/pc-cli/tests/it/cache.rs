//! `PC_CACHE_DIR`: equations that are kept from one run to the next.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

fn run(cache: Option<&Path>, arguments: &[&str]) -> (String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    command.arg("run").args(arguments).stdin(Stdio::null()).env_remove("PC_CACHE_DIR");
    cache.map(|directory| command.env("PC_CACHE_DIR", directory));
    let Output { status, stdout, stderr } = command.output().expect("pc starts");
    let (out, said) = (String::from_utf8(stdout).expect("UTF-8"), String::from_utf8(stderr).expect("UTF-8"));
    assert!(status.success(), "{said}");
    (out, said)
}

fn files(directory: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(directory).into_iter().flatten();
    entries.map(|entry| entry.expect("an entry").path()).collect()
}

/// What a summary says of equations that were kept.
const KEPT: &str = "\n  verified in an earlier run, by a second derivation";

/// The summary without the computing time and the lines about comparisons.
fn without(said: &str) -> Vec<&str> {
    let others = said.lines().filter(|line| !line.starts_with("  verified"));
    others
        .map(|line| match line.strip_prefix("  work") {
            Some(work) => work.rsplit_once(", ").map_or(line, |(work, _)| work),
            None => line,
        })
        .collect()
}

#[test]
fn a_second_run_has_the_same_numbers_and_remarks() {
    let place = TempDir::new().expect("a directory");
    let cache = place.path().join("not/there/yet");
    for model in ["chaplygin-sleigh", "bouncing-ball", "four-bar-loop", "stick-slip-block"] {
        let arguments = [model, "--rows", "5"];
        let (plain, _) = run(None, &arguments);
        let known = files(&cache).len();
        let (first, said) = run(Some(&cache), &arguments);
        assert_eq!(files(&cache).len(), known + 1, "{model}: {said}");
        let (second, again) = run(Some(&cache), &arguments);
        assert_eq!((&first, &second), (&plain, &plain), "{model}");
        assert_eq!(without(&again), without(&said), "{model}");
        assert!(again.contains(KEPT) && !said.contains(KEPT), "{again}");
    }
}

#[test]
fn other_values_forms_and_texts_are_derived_anew() {
    let cache = TempDir::new().expect("a directory");
    let texts = TempDir::new().expect("a directory");
    let file = texts.path().join("m.toml");
    let path = file.to_str().expect("UTF-8");
    let text = "parameters.k = 4.0\ncoordinates.x = 1.0\nlagrangian.kinetic = \"x'^2/2\"\n\
                lagrangian.potential = \"k*x^2/2\"\nsimulation.t_end = 1.0\n";
    fs::write(&file, text).expect("a file");
    let of = |arguments: &[&str]| {
        let arguments = [&[path, "--rows", "2"], arguments].concat();
        let (plain, _) = run(None, &arguments);
        let (found, said) = run(Some(cache.path()), &arguments);
        assert_eq!(found, plain);
        assert!(!said.contains(KEPT), "{said}");
        files(cache.path()).len()
    };
    assert_eq!(of(&[]), 1);
    assert_eq!(of(&["--set", "k=9"]), 2);
    assert_eq!(of(&["--set", "x=2"]), 3);
    assert_eq!(of(&["--form", "canonical"]), 4);
    fs::write(&file, text.replace("k*x^2/2", "k*x^4/4")).expect("a file");
    assert_eq!(of(&[]), 5);
    // Other times and tolerances need no other equations.
    let (_, said) = run(Some(cache.path()), &[path, "--t-end", "3", "--rtol", "1e-6"]);
    assert!(said.contains(KEPT), "{said}");
}

#[test]
fn what_is_damaged_is_derived_again_and_replaced() {
    let cache = TempDir::new().expect("a directory");
    let arguments = ["damped-oscillator", "--rows", "3"];
    let (plain, _) = run(Some(cache.path()), &arguments);
    let [file] = &files(cache.path())[..] else { panic!("one file") };
    let whole = fs::read(file).expect("a file");
    let mut changed = whole.clone();
    changed[whole.len() / 2] ^= 1;
    for bytes in [&changed[..], &whole[..100], b"", b"something else"] {
        fs::write(file, bytes).expect("a file");
        let (found, said) = run(Some(cache.path()), &arguments);
        assert_eq!(found, plain);
        assert!(said.contains("are not used: ") && !said.contains(KEPT), "{said}");
        assert_eq!(fs::read(file).expect("a file"), whole);
    }
}

#[test]
fn a_directory_that_cannot_be_used_does_not_stop_a_run() {
    let place = TempDir::new().expect("a directory");
    let file = place.path().join("file");
    fs::write(&file, "").expect("a file");
    let (found, said) = run(Some(&file.join("below")), &["damped-oscillator", "--rows", "3"]);
    assert_eq!(found, run(None, &["damped-oscillator", "--rows", "3"]).0);
    assert!(said.contains("cannot be "), "{said}");
}
