//! No command replaces a file that it reads, under whatever name, nor writes two results to one file.

#![cfg(unix)]

use std::fs::{self, hard_link};
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

const MODEL: &str = "[coordinates]\nx = 1.0\n[inputs]\nu = { file = \"u.csv\", column = \"u\" }\n\
                     [lagrangian]\nkinetic = \"x'^2/2\"\n[forces]\nx = \"u\"\n[simulation]\nt_end = 1\n";
const TABLE: &str = "t,u\n0,1\n2,3\n";

/// The exit code and the error, or else the first line of what is said.
fn pc(directory: &Path, command: &str) -> (i32, String) {
    let mut pc = Command::new(env!("CARGO_BIN_EXE_pc"));
    let done = pc.args(command.split(' ')).current_dir(directory).stdin(Stdio::null()).output().unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    let error = said.lines().find(|line| line.starts_with("pc: ")).or(said.lines().next());
    (done.status.code().unwrap(), error.unwrap_or_default().to_owned())
}

#[test]
fn what_is_read_is_not_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let at = |name: &str| directory.path().join(name);
    for (name, text) in [
        ("m.toml", MODEL),
        ("m.csv", MODEL),
        ("m.html", MODEL),
        ("u.csv", TABLE),
        ("m.fmu", MODEL),
        ("m.rs", MODEL),
    ] {
        fs::write(at(name), text).unwrap();
    }
    symlink("u.csv", at("link.csv")).unwrap();
    hard_link(at("u.csv"), at("twin.csv")).unwrap();
    for (command, written, read) in [
        ("run m.toml -o u.csv", "u.csv", "u.csv"),
        ("run m.toml -o ./link.csv", "./link.csv", "u.csv"),
        ("run m.toml -o twin.csv", "twin.csv", "u.csv"),
        ("run ./m.csv -o m.csv", "m.csv", "./m.csv"),
        ("run m.toml --checkpoint m.toml", "m.toml", "m.toml"),
        ("run m.toml --resume twin.csv -o u.csv", "u.csv", "u.csv"),
        ("sweep m.toml --vary x=0:1:3 -o u.csv", "u.csv", "u.csv"),
        ("linearize m.toml --vary x=0:1:3 -o u.csv", "u.csv", "u.csv"),
        ("equilibria m.toml -o u.csv", "u.csv", "u.csv"),
        ("check m.toml -o u.csv", "u.csv", "u.csv"),
        ("derive m.toml -o ./link.csv", "./link.csv", "u.csv"),
        ("theory m.toml -o m.toml", "m.toml", "m.toml"),
        ("compare m.toml --form poincare,canonical --format text -o m.toml", "m.toml", "m.toml"),
        ("compare m.toml m.html --format json -o m.html", "m.html", "m.html"),
        ("bench m.toml -o twin.csv", "twin.csv", "u.csv"),
        ("report m.html -o m.html", "m.html", "m.html"),
        ("animate m.html -o m.html", "m.html", "m.html"),
        ("import u.csv -o link.csv", "link.csv", "u.csv"),
        ("export m.toml -o twin.csv", "twin.csv", "u.csv"),
        ("merge u.csv -o link.csv", "link.csv", "u.csv"),
        ("emit ./m.fmu --fmu 2 -o m.fmu", "m.fmu", "./m.fmu"),
        ("emit m.rs --lang rust -o .", "./m.rs", "m.rs"),
    ] {
        let (code, said) = pc(directory.path(), command);
        assert_eq!(code, 2, "{command}: {said}");
        assert_eq!(
            said,
            format!(
                "pc: {written} is the file {read}, which is read; it would be replaced, and nothing was computed; \
                 give another name"
            ),
            "{command}"
        );
    }
    assert_eq!(fs::read_to_string(at("u.csv")).unwrap(), TABLE);
    for name in ["m.toml", "m.csv", "m.html", "m.fmu", "m.rs"] {
        assert_eq!(fs::read_to_string(at(name)).unwrap(), MODEL, "{name}");
    }
}

#[test]
fn what_standard_input_reads_is_not_replaced() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("m.csv");
    fs::write(&file, MODEL).unwrap();
    fs::write(directory.path().join("u.csv"), TABLE).unwrap();
    for command in ["run - -o m.csv", "equilibria - -o ./m.csv", "import - -o m.csv"] {
        let input = fs::File::open(&file).unwrap();
        let mut pc = Command::new(env!("CARGO_BIN_EXE_pc"));
        let done = pc.args(command.split(' ')).current_dir(directory.path()).stdin(input).output().unwrap();
        let said = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(2), "{command}: {said}");
        assert!(said.contains("m.csv is the file /dev/stdin, which is read"), "{command}: {said}");
        assert_eq!(fs::read_to_string(&file).unwrap(), MODEL);
    }
}

#[test]
fn two_results_are_two_files() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("m.toml"), MODEL).unwrap();
    fs::write(directory.path().join("u.csv"), TABLE).unwrap();
    let (code, said) = pc(directory.path(), "run m.toml -o a.csv --checkpoint ./a.csv");
    assert_eq!(code, 2);
    assert_eq!(
        said,
        "pc: ./a.csv is the file a.csv, and both would be written; nothing was computed; give another name"
    );
    assert!(!directory.path().join("a.csv").exists());
    // The checkpoint from which a run continues is replaced by later ones.
    let (code, said) = pc(directory.path(), "run m.toml -o b.csv --checkpoint c.pcc");
    assert_eq!(code, 0, "{said}");
    let (code, said) = pc(directory.path(), "run m.toml -o b.csv --resume c.pcc --checkpoint ./c.pcc");
    assert_eq!(code, 0, "{said}");
}
