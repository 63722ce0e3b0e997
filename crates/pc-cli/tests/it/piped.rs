//! `pc` on a model from standard input.

use std::io::Write;
use std::process::{Command, Output, Stdio};

/// What `pc` answers to these arguments, `-` among them, with this model on its standard input.
pub(crate) fn pc(model: &str, arguments: &[&str]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("pc starts");
    // If the arguments are refused, the input stays unread.
    let _ = child.stdin.take().expect("a pipe").write_all(model.as_bytes());
    child.wait_with_output().expect("pc ends")
}

/// The standard output of `pc`, which succeeds.
#[track_caller]
pub(crate) fn answer(model: &str, arguments: &[&str]) -> String {
    let output = pc(model, arguments);
    assert_eq!(output.status.code(), Some(0), "{model}{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}
