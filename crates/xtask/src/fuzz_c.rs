//! `cargo xtask fuzz c`: every function of the C library, called in random sequences with right and wrong arguments.
//!
//! `interface` reads what is declared, `arguments` says what each argument is, `tables` writes it down in C; `program` draws the
//! arguments, makes the calls and checks what the header promises of them; `workers` runs it on all cores and adds up. A new
//! function of the library is called as soon as `pc.h` declares it.

mod arguments;
mod interface;
mod tables;
mod workers;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::c_libraries::{self, SANITIZED};
use crate::command::{announce_and_run, build_as_for_tests, cargo, target_directory, workspace_root};
use crate::error::Error;
use crate::setup;
use crate::tools::Machine;
use interface::Interface;
use workers::Play;

/// The files of the program, without the one that is made.
const SOURCES: [&str; 10] = [
    "call.c",
    "callbacks.c",
    "counts.c",
    "draw.c",
    "log.c",
    "play.c",
    "pool.c",
    "random.c",
    "recipes.c",
    "room.c",
];

/// Calls unless told: a minute on two cores.
const CALLS: u64 = 100_000;

/// Calls among the tests.
const QUICK: u64 = 20_000;

/// What the command line asks for.
#[derive(Debug, PartialEq, Eq)]
struct Wanted {
    play: Play,
    /// Whether the library is the released one, which is faster and does not check its arithmetic.
    release: bool,
    /// Whether sanitizers are left out.
    plain: bool,
}

/// Plays as the arguments say.
///
/// # Errors
/// [`Error::Usage`], and [`Error::Unfit`] where a promise of the header is broken.
pub(crate) fn run(arguments: &[String]) -> Result<(), Error> {
    let wanted = Wanted::of(arguments)?;
    setup::native_tools()?;
    if wanted.release {
        announce_and_run(&mut cargo(&["build", "--release", "--package", "pc-capi", "--lib"]))?;
        return play(&wanted, &target_directory()?.join("release/libpc.so"));
    }
    build_as_for_tests(&["--lib"])?;
    play(&wanted, &target_directory()?.join("debug/deps/libpc.so"))
}

/// Some of it, with the library of the tests.
///
/// # Errors
/// As [`run`].
pub(crate) fn quick() -> Result<(), Error> {
    if !Machine::this().has_program("cc") {
        return Err(Error::Unavailable { what: "there is no `cc`".to_owned() });
    }
    let library = target_directory()?.join("debug/deps/libpc.so");
    if !library.exists() {
        build_as_for_tests(&["--lib"])?;
    }
    play(&Wanted { play: Play { calls: QUICK, ..Play::default() }, release: false, plain: false }, &library)
}

fn play(wanted: &Wanted, library: &Path) -> Result<(), Error> {
    let place = target_directory()?.join("fuzz-c");
    let interface = Interface::read()?;
    let program = build(&interface, library, &place, wanted.plain)?;
    let names: Vec<&str> = interface.functions.iter().map(|function| &*function.name).collect();
    workers::run(&wanted.play, &program, &place, &names)
}

/// Builds the program and returns its path.
fn build(interface: &Interface, library: &Path, place: &Path, plain: bool) -> Result<PathBuf, Error> {
    let libraries = place.join("lib");
    c_libraries::link(library, &libraries)?;
    let tables = place.join("tables.c");
    fs::write(&tables, tables::tables(interface)?).map_err(|source| Error::of_file(&tables, source))?;
    let sanitizes = !plain && c_libraries::works("cc", SANITIZED, place);
    if !plain && !sanitizes {
        println!("skipped: the sanitizers, which do not run here");
    }
    let root = workspace_root();
    let sources = root.join("crates/xtask/src/fuzz_c/program");
    let program = place.join("fuzz");
    let mut compile = Command::new("cc");
    compile.args(["-std=gnu11", "-Wall", "-Wextra", "-Werror"]);
    if sanitizes {
        compile.args(SANITIZED.split_whitespace()).arg("-DSANITIZED");
    } else {
        compile.args(["-O1", "-g"]);
    }
    compile.arg("-I").arg(root.join("include")).arg("-I").arg(&sources).arg(&tables);
    compile.args(SOURCES.iter().map(|source| sources.join(source))).arg("-o").arg(&program);
    compile.arg("-L").arg(&libraries).arg("-lpc").arg(format!("-Wl,-rpath,{}", libraries.display()));
    announce_and_run(compile.args(["-lm", "-lpthread"]))?;
    Ok(program)
}

impl Wanted {
    fn of(arguments: &[String]) -> Result<Wanted, Error> {
        let mut wanted =
            Wanted { play: Play { calls: CALLS, ..Play::default() }, release: false, plain: false };
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            let wrong = |what: &str| Error::Usage { message: format!("`fuzz c {word}` needs {what}") };
            let mut next = |what: &str| words.next().ok_or_else(|| wrong(what));
            let number = |text: &str, what: &str| text.parse().map_err(|_| wrong(what));
            match word.as_str() {
                "--count" => wanted.play.calls = number(next("a number of calls")?, "a number of calls")?,
                "--seed" => wanted.play.seed = number(next("a number")?, "a number")?,
                "--replay" => {
                    let what = "SEED:SEQUENCE, two numbers";
                    let (seed, sequence) = next(what)?.split_once(':').ok_or_else(|| wrong(what))?;
                    wanted.play.seed = number(seed, what)?;
                    wanted.play.replayed = Some(number(sequence, what)?);
                }
                "--table" => wanted.play.table = true,
                "--release" => wanted.release = true,
                "--plain" => wanted.plain = true,
                other => {
                    return Err(Error::Usage { message: format!("`fuzz c` does not take `{other}`") });
                }
            }
        }
        Ok(wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wanted(line: &str) -> Result<Wanted, String> {
        let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        Wanted::of(&words).map_err(|error| error.to_string())
    }

    #[test]
    fn command_lines_are_read() {
        let found = wanted("--count 7 --table --replay 3:14 --plain").unwrap();
        let play = Play { calls: 7, seed: 3, replayed: Some(14), table: true };
        assert_eq!(found, Wanted { play, release: false, plain: true });
        assert_eq!(wanted("--count"), Err("`fuzz c --count` needs a number of calls".to_owned()));
        assert_eq!(
            wanted("--replay 7"),
            Err("`fuzz c --replay` needs SEED:SEQUENCE, two numbers".to_owned())
        );
        assert_eq!(wanted("--fast"), Err("`fuzz c` does not take `--fast`".to_owned()));
    }

    /// What is not compiled is not called.
    #[test]
    fn all_sources_of_the_program_are_compiled() {
        let place = workspace_root().join("crates/xtask/src/fuzz_c/program");
        for entry in fs::read_dir(place).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            assert!(SOURCES.contains(&name.as_str()) || name == "fuzz.h", "{name}");
        }
    }
}
