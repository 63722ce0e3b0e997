//! `-` means standard input for a file that is read, and standard output for one that is written.

use std::io::Write;
use std::process::{Command, Output, Stdio};

fn run_on(input: &str, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    let child =
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = child.expect("pc starts");
    let _ = child.stdin.take().expect("a pipe").write_all(input.as_bytes()); // not every command reads
    child.wait_with_output().expect("pc ends")
}

#[track_caller]
fn printed(input: &str, arguments: &[&str]) -> String {
    let output = run_on(input, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

const FREE: &str = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2\"\n[simulation]\nt_end = 1.0\n\
                    [[draw]]\nkind = \"point\"\nat = [\"x\", 0]\n";

#[test]
fn a_dash_is_the_standard_stream() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("model.toml").display().to_string();
    std::fs::write(&file, FREE.replace("[coordinates]", "[model]\nname = \"m\"\n[coordinates]"))
        .expect("written");
    let titled = std::fs::read_to_string(&file).expect("a file");
    for command in [&["check"][..], &["derive"], &["theory"], &["run"], &["report"], &["animate"]] {
        let of_file = [command, &[&file]].concat();
        let expected = printed("", &of_file);
        assert_eq!(
            printed(&titled, &[command, &["-"]].concat()).lines().count(),
            expected.lines().count(),
            "{command:?}"
        );
        if !matches!(command[0], "check" | "derive" | "theory") {
            let to_output = [&of_file[..], &["-o", "-"]].concat();
            assert_eq!(printed("", &to_output), expected, "{command:?}");
        }
    }
    assert!(!std::path::Path::new("-").exists(), "no file of that name is made");
}

#[test]
fn a_robot_is_read_and_a_model_written() {
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/robots/arm.urdf");
    let urdf = std::fs::read_to_string(robot).expect("a robot");
    let expected = printed("", &["import", robot]).replacen("arm.urdf", "<stdin>", 1);
    assert_eq!(printed(&urdf, &["import", "-"]), expected);
    assert_eq!(printed(&urdf, &["import", "-", "-o", "-"]), expected);
    let output = run_on("no robot", &["import", "-"]);
    assert_eq!(output.status.code(), Some(3));
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(said.contains("<stdin>:1:1"), "{said}");
}

#[test]
fn source_is_printed_where_it_is_one_file() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().display().to_string();
    printed("", &["emit", "euler-top", "--lang", "rust", "-o", &path]);
    let expected = std::fs::read_to_string(directory.path().join("euler_top.rs")).expect("a file");
    assert_eq!(printed("", &["emit", "euler-top", "--lang", "rust", "-o", "-"]), expected);
    let output = run_on("", &["emit", "euler-top", "--lang", "c", "-o", "-"]);
    let said = "pc: -o -: the source is in several files, euler_top.h and euler_top.c; give a directory\n";
    assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(2), said));
}
