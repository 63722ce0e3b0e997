//! `cargo xtask c-examples`: builds the examples in C and C++ with every compiler there is, runs them, compares their numbers
//! with those of the program `pc`, and runs them again under the sanitizers and valgrind.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::c_libraries::{self, SANITIZED, works};
use crate::command::{
    announce_and_run, build_as_for_tests, built_program, cargo, target_directory, workspace_root,
};
use crate::error::Error;
use crate::tools::Machine;
use crate::{c_fresh, c_interface, c_numbers, install, setup};

/// A C compiler with its C++ compiler.
const COMPILERS: [(&str, &str); 2] = [("gcc", "g++"), ("clang", "clang++")];

/// Races end a program: those of its own code, for that of the library is not instrumented.
const THREADS: &str = "-O1 -g -fsanitize=thread";

/// Memory errors and leaks end a program, in the machine code of the library and in what it compiles as well. What is only
/// possibly lost is not: the standard library's handle of a thread, known by a pointer to its middle, and what crossbeam,
/// under the ensembles, keeps of threads that have ended, by pointers with tags.
const MEMORY: &str =
    "valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite,indirect";

/// Races, likewise.
const RACES: &str = "valgrind --quiet --error-exitcode=9 --tool=helgrind";

/// All of it, against an installation of what is built for debugging.
///
/// # Errors
/// That of the first program that is wrong.
pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools_and_cpp()?;
    announce_and_run(&mut cargo(&["build", "--package", "pc-capi", "--lib"]))?;
    announce_and_run(&mut cargo(&["build", "--package", "pc-cli", "--bin", "pc"]))?;
    let place = target_directory()?.join("c-examples");
    let (built, installed) = (target_directory()?.join("debug"), place.join("installed"));
    let (pc, places) = (built.join("pc"), install::Places::below(&installed)?);
    install::place(&built, &places)?;
    let library = Library::shared(&installed.join("lib"), &place);

    let machine = Machine::this();
    let compilers = compilers(&machine);
    if compilers.is_empty() {
        let remedy = "install gcc with g++, or clang".to_owned();
        return Err(Error::Missing { tools: vec!["a C and C++ compiler"], remedy });
    }
    c_interface::symbols(&installed.join("lib"))?;
    for compiler @ (c, _) in compilers {
        let sundials = c_interface::sundials(&built);
        c_interface::headers(compiler, &installed.join("include"), &sundials, &place.join("headers"))?;
        let sanitizes = c != "clang" || setup::sanitizers_of_clang(|| works(c, SANITIZED, &place));
        let builds = [("-O2", "plain"), (SANITIZED, "sanitized")];
        for (flags, build) in &builds[..if sanitizes { 2 } else { 1 }] {
            let build = format!("{c}/{build}");
            c_numbers::check(&mut library.check(compiler, flags, &build), &pc)?;
            c_numbers::check_source(&place.join(build), &pc)?;
        }
        if sanitizes {
            library.sequences(compiler.1, SANITIZED)?;
        }
    }
    if machine.has_program("valgrind") {
        announce_and_run(library.check(("cc", "c++"), "-O1 -g", "valgrind").arg(format!("UNDER={MEMORY}")))?;
        announce_and_run(threads_alone(
            library.check(("cc", "c++"), "-O1 -g", "valgrind").arg(format!("UNDER={RACES}")),
        ))?;
    } else {
        println!("skipped: valgrind, which is not installed");
    }
    if works("cc", THREADS, &place) {
        announce_and_run(threads_alone(&mut library.check(("cc", "c++"), THREADS, "threads")))?;
    } else {
        println!("skipped: ThreadSanitizer, which does not run here");
    }
    julia(&machine, &installed.join("lib"))?;
    let archive = format!("{} {}", installed.join("lib/libpc.a").display(), install::STATIC_LIBS);
    let archive = Library { flags: archive, place: place.clone() };
    c_numbers::check(&mut archive.check(("cc", "c++"), "-O2", "static"), &pc)?;
    with_cmake(&installed, &place.join("cmake"))?;
    c_fresh::run(&installed)?;
    install::uninstall(&places)?;
    match &install::left(&installed)?[..] {
        [] => Ok(()),
        left => Err(Error::Installed { wrong: format!("not removed: {left:?}") }),
    }
}

/// Those of [`COMPILERS`] that are there.
fn compilers(machine: &Machine) -> Vec<(&'static str, &'static str)> {
    COMPILERS.into_iter().filter(|(c, cpp)| machine.has_program(c) && machine.has_program(cpp)).collect()
}

/// The same in short, against what the tests have built: plain with every compiler, and under the sanitizers with that of
/// the system.
///
/// # Errors
/// That of the first program that is wrong.
pub(crate) fn quick() -> Result<(), Error> {
    let machine = Machine::this();
    if let Some(missing) = ["cc", "c++", "make"].into_iter().find(|program| !machine.has_program(program)) {
        println!("skipped: there is no `{missing}`");
        return Ok(());
    }
    let (built, place) = (target_directory()?.join("debug"), target_directory()?.join("c-examples/quick"));
    let (shared, libraries, pc) = (built.join("deps/libpc.so"), place.join("lib"), built_program()?);
    if !shared.exists() {
        build_as_for_tests(&["--lib"])?;
    }
    c_libraries::link(&shared, &libraries)?;
    let (compiler, include) = (("cc", "c++"), workspace_root().join("include"));
    c_interface::headers(compiler, &include, &c_interface::sundials(&built), &place.join("headers"))?;
    let library = Library::shared(&libraries, &place);
    c_numbers::check(&mut library.check(compiler, "-O1", "plain"), &pc)?;
    c_numbers::check_source(&place.join("plain"), &pc)?;
    julia(&machine, &libraries)?;
    // Each warns of something that the others do not.
    for compiler in compilers(&machine) {
        announce_and_run(&mut library.check(compiler, "-O1", compiler.0))?;
    }
    if !works("cc", SANITIZED, &place) {
        println!("skipped: the sanitizers, which do not run here");
        return Ok(());
    }
    announce_and_run(&mut library.check(compiler, SANITIZED, "sanitized"))?;
    library.sequences(compiler.1, SANITIZED)
}

/// How the examples are linked, and where they are built.
struct Library {
    flags: String,
    place: PathBuf,
}

impl Library {
    fn shared(libraries: &Path, place: &Path) -> Library {
        let lib = libraries.display();
        Library { flags: format!("-L{lib} -lpc -Wl,-rpath,{lib}"), place: place.to_owned() }
    }

    /// Calls at random through the C++ wrapper, whose functions throw.
    fn sequences(&self, compiler: &str, flags: &str) -> Result<(), Error> {
        let root = workspace_root();
        let program = self.place.join("sequences");
        let mut compile = Command::new(compiler);
        compile
            .args(["-std=c++17", "-Wall", "-Wextra", "-Wpedantic", "-Werror"])
            .args(flags.split_whitespace());
        compile.arg("-I").arg(root.join("include")).arg(root.join("crates/pc-capi/tests/cpp/sequences.cpp"));
        announce_and_run(
            compile.arg("-o").arg(&program).args(self.flags.split_whitespace()).arg("-lpthread"),
        )?;
        announce_and_run(&mut Command::new(program))
    }

    /// `make check` of the examples, everything built anew.
    fn check(&self, (c, cpp): (&str, &str), flags: &str, build: &str) -> Command {
        let mut make = Command::new("make");
        make.current_dir(workspace_root().join("examples-c")).args(["--silent", "--always-make", "check"]);
        make.args([format!("CC={c}"), format!("CXX={cpp}"), format!("CFLAGS={flags}")]);
        make.args([
            format!("CXXFLAGS={flags}"),
            format!("PC_LIBS={}", self.flags),
            format!("BUILD={}", self.place.join(build).display()),
        ]);
        make
    }
}

/// The example in Julia, which calls the shared library.
fn julia(machine: &Machine, libraries: &Path) -> Result<(), Error> {
    if !machine.has_program("julia") {
        println!("skipped: julia_top, for there is no `julia`");
        return Ok(());
    }
    let mut julia = Command::new("julia");
    julia.current_dir(workspace_root().join("examples-c")).env("PC_LIBRARY", libraries.join("libpc.so"));
    announce_and_run(julia.arg("julia_top.jl"))
}

/// Of the examples that one alone.
fn threads_alone(make: &mut Command) -> &mut Command {
    make.args(["PROGRAMS=threads", "WITH_FORTRAN=", "WITH_GSL=", "WITH_SUNDIALS="])
}

fn with_cmake(installed: &Path, build: &Path) -> Result<(), Error> {
    let examples = workspace_root().join("examples-c");
    let mut configure = Command::new("cmake");
    configure.arg("-S").arg(examples).arg("-B").arg(build);
    announce_and_run(configure.arg(format!("-DCMAKE_PREFIX_PATH={}", installed.display())))?;
    announce_and_run(Command::new("cmake").arg("--build").arg(build))?;
    announce_and_run(Command::new("ctest").arg("--output-on-failure").arg("--test-dir").arg(build))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn every_example_is_built_and_is_short() {
        // Whole controllers, each with a motion to follow and a regulator.
        const LONG: [&str; 2] = ["computed_torque", "task_space"];
        let examples = workspace_root().join("examples-c");
        let [make, cmake] =
            ["Makefile", "CMakeLists.txt"].map(|name| fs::read_to_string(examples.join(name)).unwrap());
        let words = |text: &str, name: &str| {
            text.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|w| w == name)
        };
        for entry in fs::read_dir(examples).unwrap() {
            let path = entry.unwrap().path();
            if !path.extension().is_some_and(|ending| ending == "c" || ending == "cpp") {
                continue;
            }
            let name = path.file_stem().unwrap().to_str().unwrap();
            assert!(words(&make, name) && words(&cmake, name), "{name} is not built");
            let lines = fs::read_to_string(&path).unwrap().lines().count();
            assert!(lines < 120 || LONG.contains(&name), "{name} is long");
        }
    }
}
