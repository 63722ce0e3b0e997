//! `cargo xtask c-examples`: builds the examples in C and C++ with every compiler there is, runs them, and runs them again
//! under the sanitizers.

use std::path::Path;
use std::process::Command;

use crate::command::{announce_and_run, cargo, target_directory, workspace_root};
use crate::error::Error;
use crate::tools::Machine;
use crate::{install, setup};

/// A C compiler with its C++ compiler.
const COMPILERS: [(&str, &str); 2] = [("gcc", "g++"), ("clang", "clang++")];

/// Memory errors, leaks and undefined behaviour end a program.
const SANITIZED: &str = "-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all";

pub(crate) fn run() -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["build", "--package", "pc-capi", "--lib"]))?;
    let place = target_directory()?.join("c-examples");
    let installed = place.join("installed");
    install::place(&target_directory()?.join("debug"), &installed)?;
    let libraries = installed.join("lib");
    let lib = libraries.display();
    let shared = format!("-L{lib} -lpc -Wl,-rpath,{lib}");

    let machine = Machine::this();
    let compilers: Vec<_> =
        COMPILERS.into_iter().filter(|(c, cpp)| machine.has_program(c) && machine.has_program(cpp)).collect();
    if compilers.is_empty() {
        let remedy = "install gcc with g++, or clang".to_owned();
        return Err(Error::Missing { tools: vec!["a C and C++ compiler"], remedy });
    }
    for (c, cpp) in compilers {
        for (flags, build) in [("-O2", "plain"), (SANITIZED, "sanitized")] {
            let build = place.join(c).join(build);
            announce_and_run(&mut check(c, cpp, flags, &shared, &build))?;
        }
    }
    let archive = format!("{lib}/libpc.a {}", install::STATIC_LIBS);
    announce_and_run(&mut check("cc", "c++", "-O2", &archive, &place.join("static")))?;
    with_cmake(&installed, &place.join("cmake"))?;
    if machine.has_program("pkg-config") {
        let mut find = Command::new("pkg-config");
        find.env("PKG_CONFIG_PATH", libraries.join("pkgconfig"));
        announce_and_run(find.args(["--cflags", "--libs", "libpc"]))?;
    }
    install::uninstall(&installed)
}

/// `make check` of the examples, everything built anew.
fn check(c: &str, cpp: &str, flags: &str, library: &str, build: &Path) -> Command {
    let mut make = Command::new("make");
    make.current_dir(workspace_root().join("examples-c")).args(["--silent", "--always-make", "check"]);
    make.args([format!("CC={c}"), format!("CXX={cpp}"), format!("CFLAGS={flags}")]);
    make.args([
        format!("CXXFLAGS={flags}"),
        format!("PC_LIBS={library}"),
        format!("BUILD={}", build.display()),
    ]);
    make
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
        let examples = workspace_root().join("examples-c");
        let [make, cmake] =
            ["Makefile", "CMakeLists.txt"].map(|name| fs::read_to_string(examples.join(name)).unwrap());
        for entry in fs::read_dir(examples).unwrap() {
            let path = entry.unwrap().path();
            if !path.extension().is_some_and(|ending| ending == "c" || ending == "cpp") {
                continue;
            }
            let name = path.file_stem().unwrap().to_str().unwrap();
            assert!(make.contains(name) && cmake.contains(name), "{name} is not built");
            assert!(fs::read_to_string(&path).unwrap().lines().count() < 120, "{name} is long");
        }
    }
}
