//! The test programs of the workspace: built together, each run by itself within a limit of its own.

use std::collections::VecDeque;
use std::env;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

use super::libtest::Progress;
use super::limited::{self, Ending};
use super::usual;
use crate::command::{cargo, line_of, target_directory};
use crate::counts::Counts;
use crate::error::Error;

/// The lines that are shown of a program that was killed.
const LAST_LINES: usize = 20;

/// A program of tests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct TestProgram {
    /// Its package and its name in there: `pc-solve it`; `pc-solve unit` for the tests in the sources.
    pub(crate) name: String,
    /// The directory of its package.
    package: PathBuf,
    executable: PathBuf,
}

impl TestProgram {
    pub(crate) fn package(&self) -> &str {
        self.name.split(' ').next().unwrap_or_default()
    }
}

/// Builds everything that the workspace has: libraries, programs, tests and examples, so that no later stage builds it again.
///
/// # Errors
/// Those of the build.
pub(crate) fn build(limit: Duration) -> Result<Vec<TestProgram>, Error> {
    let place = target_directory()?.join("xtask");
    let list = place.join("built.json");
    let wrong = |source| Error::of_file(&list, source);
    fs::create_dir_all(&place).map_err(wrong)?;
    let output = File::create(&list).map_err(wrong)?;
    let mut command = cargo(&["build", "--workspace", "--lib", "--bins", "--tests", "--examples"]);
    command.args(["--message-format", "json-render-diagnostics"]);
    println!("{}", line_of(&command));
    let ending = limited::run(&mut command, limit, Some(output.into()), |line, _| println!("{line}"))?;
    match ending {
        Ending::Exited(status) if status.success() => {}
        Ending::Exited(status) => return Err(Error::Failed { command: line_of(&command), status }),
        Ending::Killed => return Err(Error::time_limit(line_of(&command), limit, Vec::new())),
    }
    let text = fs::read_to_string(&list).map_err(wrong)?;
    let mut programs: Vec<TestProgram> = text.lines().filter_map(test_program).collect();
    programs.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(programs)
}

/// The test program that a message of cargo is about.
fn test_program(message: &str) -> Option<TestProgram> {
    let executable = PathBuf::from(field(message, "executable")?);
    let package = Path::new(&field(message, "manifest_path")?).parent()?.to_owned();
    let is_test = message.contains("\"test\":true},\"features\"");
    if !message.contains("\"reason\":\"compiler-artifact\"") || !is_test {
        return None;
    }
    let kind = message.split_once("\"kind\":[\"")?.1.split('"').next()?;
    let target = message.split_once("\"kind\":[")?.1;
    let target = match kind {
        "test" => field(target, "name")?,
        "bin" | "example" => format!("{kind} {}", field(target, "name")?),
        _ => "unit".to_owned(),
    };
    // Of the packages of the workspace only the directory of the tests has another name than its package.
    let directory = package.file_name()?.to_str()?;
    let name = if directory == "tests" { "pc-tests" } else { directory };
    Some(TestProgram { name: format!("{name} {target}"), package, executable })
}

/// The first value of a key in a line of JSON, where it is a text.
fn field(json: &str, key: &str) -> Option<String> {
    let rest = json.split_once(&format!("\"{key}\":\""))?.1;
    let mut value = String::new();
    let mut letters = rest.chars();
    loop {
        match letters.next()? {
            '"' => return Some(value),
            '\\' => value.push(letters.next()?),
            letter => value.push(letter),
        }
    }
}

/// How a program of tests went.
pub(crate) struct Run {
    /// Each test with its time.
    pub(crate) tests: Vec<(Duration, String)>,
    pub(crate) failure: Option<Error>,
}

/// Runs a program, in a `quick` run without its long tests; its lines go to the terminal and to `counts`.
///
/// # Errors
/// [`Error::Start`] and [`Error::Output`]; that tests fail, or take too long, is in the result.
pub(crate) fn run(program: &TestProgram, counts: &mut Counts, quick: bool) -> Result<Run, Error> {
    println!("\n   Running {}", program.name);
    let skipped = usual::LONG.iter().filter(|(of, _)| quick && *of == program.name);
    let chosen: Vec<&str> = skipped.flat_map(|(_, test)| ["--skip", test]).collect();
    let list = program.command().args(["--list", "--format", "terse"]).args(&chosen).output();
    let list = list.map_err(|source| Error::Start { program: program.name.clone(), source })?;
    let threads = available_parallelism().map_or(1, usize::from);
    let (start, limit) = (Instant::now(), usual::limit_of_program(&program.name));
    let mut progress = Progress::new(&String::from_utf8_lossy(&list.stdout), threads, start);
    let mut last = VecDeque::new();
    let mut command = program.command();
    command.arg(format!("--test-threads={threads}")).args(&chosen);
    let ending = limited::run(&mut command, limit, None, |line, now| {
        println!("{line}");
        counts.add_line(line);
        progress.line(line, now);
        last.push_back(line.to_owned());
        if last.len() > LAST_LINES {
            last.pop_front();
        }
    })?;
    let failure = match ending {
        Ending::Exited(status) if status.success() => None,
        Ending::Exited(status) => Some(Error::Failed { command: program.name.clone(), status }),
        Ending::Killed => {
            println!("== the last lines of {}:", program.name);
            last.iter().for_each(|line| println!("   {line}"));
            Some(Error::time_limit(program.name.clone(), limit, progress.at_work()))
        }
    };
    let tests = progress.times().map(|(took, test)| (took, format!("{}: {test}", program.name))).collect();
    Ok(Run { tests, failure })
}

impl TestProgram {
    /// The program as cargo would start it.
    fn command(&self) -> Command {
        let mut command = Command::new(&self.executable);
        command.current_dir(&self.package).env("CARGO_MANIFEST_DIR", &self.package);
        if env::var_os("CARGO").is_none() {
            command.env("CARGO", "cargo");
        }
        command
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn test_programs_are_read_from_what_cargo_says() {
        let message = r#"{"reason":"compiler-artifact","package_id":"path+file:///w/crates/pc-solve#0.1.0","manifest_path":"/w/crates/pc-solve/Cargo.toml","target":{"kind":["test"],"crate_types":["bin"],"name":"it","src_path":"/w/crates/pc-solve/tests/it/main.rs","edition":"2024","doc":false,"doctest":false,"test":true},"profile":{"opt_level":"1","debuginfo":1,"debug_assertions":true,"overflow_checks":true,"test":true},"features":[],"filenames":["/w/target/debug/deps/it-1"],"executable":"/w/target/debug/deps/it-1","fresh":true}"#;
        let found = test_program(message).unwrap();
        assert_eq!((found.name.as_str(), found.package()), ("pc-solve it", "pc-solve"));
        assert_eq!(found.executable, Path::new("/w/target/debug/deps/it-1"));
        assert_eq!(found.package, Path::new("/w/crates/pc-solve"));
        let of_library =
            message.replace("[\"test\"]", "[\"lib\"]").replace("\"name\":\"it\"", "\"name\":\"pc_solve\"");
        assert_eq!(test_program(&of_library).unwrap().name, "pc-solve unit");
        let program = message.replace("\"test\":true},\"features\"", "\"test\":false},\"features\"");
        assert_eq!(test_program(&program), None);
        let library = message.replace("\"executable\":\"/w/target/debug/deps/it-1\"", "\"executable\":null");
        assert_eq!(test_program(&library), None);
    }
}
