//! The page on the command line: its commands run, and it names every command and every entry of the results for programs.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use clap::CommandFactory;
use pc_cli::args::command_line::Arguments;
use serde_json::Value;

const PAGE: &str = include_str!("../../../../docs/command-line.md");

fn pc(directory: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    command.args(arguments).current_dir(directory).stdin(Stdio::null()).output().expect("pc starts")
}

#[test]
fn every_command_has_a_row() {
    for command in Arguments::command().get_subcommands() {
        let name = format!("`{}`", command.get_name());
        let has_row = PAGE.lines().any(|line| line.starts_with("| ") && line.contains(&name));
        assert!(has_row, "the page has no row for {name}");
    }
}

/// The commands run in the order of the page, in one directory, since some read files that others
/// write.
#[cfg(unix)]
#[test]
fn the_commands_of_the_page_run() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut count = 0;
    for block in PAGE.split("\n```sh\n").skip(1) {
        let commands = block.split("\n```").next().expect("a block");
        for line in commands.lines().filter(|line| !line.contains('~')) {
            let script = format!("set -e; pc() {{ \"$PC\" \"$@\"; }}; {line}");
            let mut shell = Command::new("bash");
            shell.args(["-c", &script]).env("PC", env!("CARGO_BIN_EXE_pc")).current_dir(directory.path());
            let output = shell.stdin(Stdio::null()).output().expect("bash");
            assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
            count += 1;
        }
    }
    assert_eq!(count, 9, "commands of the page");
    for (file, beginning) in
        [("wheel.csv", "t,x,"), ("disk.html", "<!DOCTYPE"), ("arm.svg", "<svg"), ("arm.html", "<!DOCTYPE")]
    {
        let text = fs::read_to_string(directory.path().join(file)).expect(file);
        assert!(text.to_lowercase().starts_with(&beginning.to_lowercase()), "{file}");
    }
}

#[test]
fn every_entry_of_the_results_is_named() {
    fn names(value: &Value, below: &mut Vec<String>) {
        match value {
            Value::Object(entries) => entries.iter().for_each(|(key, entry)| {
                below.push(key.clone());
                names(entry, below);
            }),
            Value::Array(list) => list.iter().for_each(|entry| names(entry, below)),
            _ => {}
        }
    }
    let results = [
        &["compare", "euler-top", "--form", "poincare,canonical", "--format", "json"][..],
        &["bench", "euler-top", "--seconds", "0.01", "--format", "json"],
        &["models", "--tag", "top", "--format", "json"],
    ];
    for arguments in results {
        let output = pc(Path::new("."), arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let mut result: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        if let Some(kinds) = result.get_mut("operations") {
            kinds.take(); // its keys are names of operations
        }
        let mut all = Vec::new();
        names(&result, &mut all);
        assert!(all.len() > 5);
        for name in all {
            assert!(PAGE.contains(&format!("`{name}`")), "{arguments:?}: the page does not name {name}");
        }
    }
}
