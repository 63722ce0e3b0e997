//! Running other programs from the root of the workspace.

use std::env;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::error::Error;

/// The cargo that runs us, at the root of the workspace.
pub(crate) fn cargo(arguments: &[&str]) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(workspace_root());
    command
}

/// The directory of the root manifest.
///
/// Asked of cargo's environment at run time, so that a workspace that was moved finds itself.
pub(crate) fn workspace_root() -> PathBuf {
    let manifest = env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    let mut root = PathBuf::from(manifest);
    root.pop();
    root.pop();
    root
}

/// Where cargo has built this program.
pub(crate) fn target_directory() -> Result<PathBuf, Error> {
    let program = env::current_exe();
    let program = program.map_err(|source| Error::Start { program: "xtask".to_owned(), source })?;
    let target = program.parent().and_then(Path::parent);
    Ok(target.map_or_else(|| workspace_root().join("target"), Path::to_path_buf))
}

/// Builds some targets of the workspace as the tests do, so that neither builds anew what the other has built: with an example
/// among the targets, dependencies have the features that they have for tests.
///
/// # Errors
/// That of the build.
pub(crate) fn build_as_for_tests(targets: &[&str]) -> Result<(), Error> {
    announce_and_run(cargo(&["build", "--workspace", "--example", "header"]).args(targets))
}

/// The program `pc` of the last build for debugging; built where there is none.
///
/// # Errors
/// That of the build.
pub(crate) fn built_program() -> Result<PathBuf, Error> {
    let program = target_directory()?.join("debug/pc");
    if !program.exists() {
        build_as_for_tests(&["--bin", "pc"])?;
    }
    Ok(program)
}

/// Runs to the end with our own input and output.
///
/// # Errors
/// [`Error::Start`], or [`Error::Failed`] where the exit code is not 0.
pub(crate) fn run(command: &mut Command) -> Result<(), Error> {
    let status = command.status().map_err(|source| Error::Start { program: program_of(command), source })?;
    if status.success() { Ok(()) } else { Err(Error::Failed { command: line_of(command), status }) }
}

/// As [`run`], after printing the command line.
///
/// # Errors
/// As [`run`].
pub(crate) fn announce_and_run(command: &mut Command) -> Result<(), Error> {
    println!("{}", line_of(command));
    run(command)
}

/// As [`announce_and_run`], with each piece of standard output given to `sink` as well as to the terminal, when
/// it comes.
///
/// # Errors
/// As [`run`], and [`Error::Output`] where the output cannot be read or passed on.
pub(crate) fn announce_and_tee(command: &mut Command, mut sink: impl FnMut(&[u8])) -> Result<(), Error> {
    println!("{}", line_of(command));
    let program = program_of(command);
    let mut child = command
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|source| Error::Start { program: program.clone(), source })?;
    let output = |source| Error::Output { program: program.clone(), source };
    if let Some(mut pipe) = child.stdout.take() {
        let mut terminal = std::io::stdout();
        let mut piece = [0; 8192];
        loop {
            let length = pipe.read(&mut piece).map_err(output)?;
            if length == 0 {
                break;
            }
            terminal.write_all(&piece[..length]).and_then(|()| terminal.flush()).map_err(output)?;
            sink(&piece[..length]);
        }
    }
    let status = child.wait().map_err(output)?;
    if status.success() { Ok(()) } else { Err(Error::Failed { command: line_of(command), status }) }
}

/// What a program prints, as text; its errors go to ours.
///
/// # Errors
/// As [`run`].
pub(crate) fn text_of(command: &mut Command) -> Result<String, Error> {
    let output = command.stderr(Stdio::inherit()).output();
    let output = output.map_err(|source| Error::Start { program: program_of(command), source })?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(Error::Failed { command: line_of(command), status: output.status })
    }
}

/// Whether the program starts, runs and exits with 0, its output thrown away.
pub(crate) fn succeeds(command: &mut Command) -> bool {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// The command as one would type it; the path of the program is left out.
pub(crate) fn line_of(command: &Command) -> String {
    let mut line = program_of(command);
    for argument in command.get_args() {
        line.push(' ');
        line.push_str(&argument.to_string_lossy());
    }
    line
}

pub(crate) fn program_of(command: &Command) -> String {
    let program = PathBuf::from(command.get_program());
    program.file_name().unwrap_or(program.as_os_str()).to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_shown_as_typed() {
        let mut command = Command::new("/usr/bin/cargo");
        command.args(["fmt", "--all", "--check"]);
        assert_eq!(line_of(&command), "cargo fmt --all --check");
    }

    #[test]
    fn a_program_that_does_not_exist_is_named() {
        let error = run(&mut Command::new("/nowhere/no-such-program")).expect_err("it does not exist");
        assert!(error.to_string().starts_with("cannot start `no-such-program`: "), "{error}");
    }

    #[test]
    fn the_root_holds_the_workspace_manifest() {
        let manifest = std::fs::read_to_string(workspace_root().join("Cargo.toml")).unwrap();
        assert!(manifest.starts_with("[workspace]"));
    }
}
