//! Help, completions, manual pages and the version.

use std::fs;
use std::process::{Command, Output, Stdio};

use clap::{CommandFactory, Parser};
use pc_cli::args::command_line::Arguments;

use crate::live::Live;
use crate::patience::{ended, started};

fn pc(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    command.args(arguments).stdin(Stdio::null()).output().expect("pc starts")
}

#[track_caller]
fn text(arguments: &[&str]) -> String {
    let output = pc(arguments);
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn commands() -> Vec<String> {
    let names = Arguments::command();
    names.get_subcommands().map(|command| command.get_name().to_owned()).collect()
}

/// The words of a shell command: quotes group; `|`, `>` and `#` end it.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quoted) = (Vec::new(), String::new(), false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            '|' | '>' | '#' if !quoted => break,
            ' ' if !quoted => words.extend(Some(std::mem::take(&mut word)).filter(|word| !word.is_empty())),
            c => word.push(c),
        }
    }
    words.extend(Some(word).filter(|word| !word.is_empty()));
    words
}

#[test]
fn the_help_of_each_command_has_examples_that_are_understood() {
    for name in commands() {
        let help = text(&[&name, "--help"]);
        let (_, examples) =
            help.split_once("Examples:\n").unwrap_or_else(|| panic!("{name} has no examples"));
        let lines: Vec<&str> = examples.lines().take_while(|line| line.starts_with("  ")).collect();
        let mut own = 0;
        for part in lines.iter().flat_map(|line| line.split('|')).map(str::trim) {
            if part.starts_with("pc ") {
                let parsed = Arguments::try_parse_from(words(part));
                assert!(parsed.is_ok(), "{part}: {}", parsed.unwrap_err());
                own += usize::from(part.starts_with(&format!("pc {name} ")) || part == format!("pc {name}"));
            }
        }
        assert!(own >= 2 && own >= lines.len() - 1, "{name}: {lines:?}");
    }
}

/// The examples without other programs succeed in a directory with the files that they read.
#[cfg(unix)]
#[test]
fn the_examples_run() {
    let directory = tempfile::tempdir().expect("a directory");
    let here = directory.path();
    for file in ["my-model.toml", "other-model.toml"] {
        fs::write(here.join(file), pc_cli::args::tools::Kind::Coordinates.text()).expect("written");
    }
    let arm = "[parameters]\ndamping = 0.1\n[bodies.arm]\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\n\
               mass = 1.0\ncenter = [0, 0, -0.5]\n[forces]\narm = \"-damping*arm'\"\n";
    fs::write(here.join("my-arm.toml"), arm).expect("written");
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/robots/arm.urdf");
    fs::copy(robot, here.join("robot.urdf")).expect("copied");
    let mut count = 0;
    for name in commands() {
        let help = text(&[&name, "--help"]);
        let examples = help.split_once("Examples:\n").map_or("", |(_, examples)| examples).lines();
        for line in examples.take_while(|line| line.starts_with("  ")).map(str::trim) {
            if line.split('|').any(|part| !part.trim().starts_with("pc ")) || line.contains(['~', '$', '#']) {
                continue;
            }
            if Live::named(here, line).is_some() {
                continue;
            }
            let line =
                line.replace("--seconds 10", "--seconds 0.1").replace("--members 1000 ", "--members 10 ");
            let script = format!("set -e; pc() {{ \"$PC\" \"$@\"; }}; {line}");
            let mut shell = Command::new("bash");
            shell.args(["-c", &script]).env("PC", env!("CARGO_BIN_EXE_pc")).current_dir(here);
            shell.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
            let output = ended(started(&mut shell));
            assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
            count += 1;
        }
    }
    assert!(count > 30, "{count} examples");
}

#[test]
fn only_terminals_get_colours() {
    for arguments in [&["--help"][..], &["run", "--help"], &["run"], &["nonsense"], &["check", "euler-top"]] {
        let output = pc(arguments);
        assert!(!output.stdout.contains(&0x1b) && !output.stderr.contains(&0x1b), "{arguments:?}");
    }
}

#[test]
fn completions_know_every_command() {
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let script = text(&["completions", shell]);
        for name in commands() {
            assert!(script.contains(&name), "{shell}: {name}");
        }
        assert!(script.contains("project-start"), "{shell}");
        assert_eq!(script, text(&["completions", shell]));
    }
    assert_eq!(pc(&["completions", "tcsh"]).status.code(), Some(2));
}

/// Bash reads the script and completes by it.
#[cfg(unix)]
#[test]
fn bash_completes() {
    let script = text(&["completions", "bash"]);
    let asked = "COMP_WORDS=(pc the); COMP_CWORD=1; _pc pc the pc; echo \"${COMPREPLY[@]}\"";
    let output = Command::new("bash").args(["--norc", "-c", &format!("{script}\n{asked}")]).output();
    let output = output.expect("bash");
    assert_eq!(
        String::from_utf8_lossy(&output.stdout).trim(),
        "theory",
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
}

#[test]
fn there_is_a_manual_page_for_each_command() {
    let directory = tempfile::tempdir().expect("a directory");
    let at = directory.path().join("man1");
    let output = pc(&["man", "-o", at.to_str().expect("UTF-8")]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut expected: Vec<String> = commands().iter().map(|name| format!("pc-{name}.1")).collect();
    expected.push("pc.1".to_owned());
    expected.sort();
    let mut files: Vec<String> = fs::read_dir(&at)
        .expect("a directory")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8"))
        .collect();
    files.sort();
    assert_eq!(files, expected);
    for name in commands() {
        let page = fs::read_to_string(at.join(format!("pc-{name}.1"))).expect("a page");
        assert!(page.contains(&format!(".TH pc-{name} 1  \"pc {}\"", env!("CARGO_PKG_VERSION"))), "{page}");
        let examples = page.split(".SH EXAMPLES\n.nf\n").nth(1).unwrap_or_else(|| panic!("{page}"));
        assert!(
            examples.lines().next().is_some_and(|line| line.starts_with(&format!("\\&pc {name}"))),
            "{page}"
        );
        assert_eq!(page, text(&["man", &name]), "the page is the same on standard output");
    }
    let program = fs::read_to_string(at.join("pc.1")).expect("a page");
    assert_eq!(program, text(&["man"]));
    assert!(program.contains(".SH SUBCOMMANDS") && program.contains("Exit codes: 0 done"), "{program}");
    let output = pc(&["man", "chek"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(
        String::from_utf8_lossy(&output.stderr),
        "pc: there is no command `chek`; did you mean `check`?\n"
    );
}

#[test]
fn the_version_says_what_was_built_in() {
    let short = format!("pc {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!([text(&["--version"]), text(&["-V"])], [short.clone(), short.clone()]);
    let long = text(&["--version", "--verbose"]);
    let lines: Vec<&str> = long.strip_prefix(&short).expect("the short one first").lines().collect();
    let labels: Vec<&str> = lines.iter().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(labels, ["features", "SUNDIALS", "target", "build", "processor"], "{long}");
    assert_eq!(lines[0].contains("parquet"), cfg!(feature = "parquet"));
    assert!(lines[2].contains(std::env::consts::ARCH), "{long}");
    for wrong in [&["--verbose"][..], &["--version", "run", "euler-top"]] {
        assert_eq!(pc(wrong).status.code(), Some(2), "{wrong:?}");
    }
}

#[test]
fn the_schema_is_printed_and_written() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("pc-model.schema.json");
    assert!(text(&["schema", "-o", file.to_str().expect("UTF-8")]).is_empty());
    let written = fs::read_to_string(file).expect("a file");
    assert_eq!([text(&["schema"]), text(&["schema", "-o", "-"])], [written.clone(), written.clone()]);
    assert_eq!(written, pc_model::document::SCHEMA);
}
