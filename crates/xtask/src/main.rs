//! Set-up, demonstration, tests and benchmarks of the workspace: `cargo xtask`.
//!
//! No dependency beyond the standard library and nothing native, so that it builds in seconds
//! on a machine that has only Rust and can then say, or install, what else is needed.

mod attack;
mod bench;
mod book;
mod c_examples;
mod c_fresh;
mod c_interface;
mod c_libraries;
mod c_numbers;
mod cargo_tools;
mod command;
mod counts;
mod demo;
mod error;
mod fmu;
mod fuzz;
mod fuzz_c;
mod gallery;
mod header;
mod install;
mod notices;
mod packages;
mod python;
mod python_environment;
mod release;
mod scripts;
mod setup;
mod test;
mod tools;
mod valgrind;

use std::env;
use std::process::ExitCode;

use error::Error;
use install::Places;
use test::Wanted;

const USAGE: &str = "\
usage: cargo xtask <command>

  demo             build `pc`, derive, integrate and plot a heavy top in target/demo
  test [--quick] [--since REV]
                   format, lints, tests, documentation, licences, FMUs, the Python package, with the times of all at the end;
                   --quick leaves out the longest tests and what follows the tests, --since tries only what can behave otherwise than at a revision of git
  stage TITLE      one of the stages that `test` names, by itself
  bench [NAME…]    run the benchmarks, all of them or those named
  fuzz models|trees|breaks [--count N] [--seed S] [--model K]
                   run random models and compare them with independent computations; --model shows one of them
  fuzz c [--count N] [--seed S] [--table] [--replay S:K] [--release] [--plain]
                   call every function of the C library in random sequences, N calls in all, and check what the header
                   promises; --table shows the calls of each function, --replay those of one sequence, --release tries the
                   released library, --plain leaves out the sanitizers
  attack [--minutes N | --count N] [--seed S]
                   run the program on hostile models, files and checkpoints, within small limits, and strike it by kills and
                   signals; 10 minutes unless told
  book             make target/book of the pages in docs by mdbook, which is fetched from PyPI unless it is installed
  gallery [--pictures [NAME…]]
                   write docs/gallery.md from the texts of the models; --pictures also takes pictures of these models, or of all,
                   by Node and Chromium
  header           write include/pc.h from the sources of the C interface
  scripts          bundle the scripts of pages in crates/pc-report from their modules, by npm
  c-examples       build the examples in C and C++, run them, compare their numbers with those of `pc`, and run them
                   under sanitizers and valgrind
  fmu              validate and simulate FMUs of models by FMPy, which is installed into target/fmu, and compare their numbers
                   with those of `pc`
  python [--quick] build the wheel of the Python package, install it in a fresh environment and test it there; --quick tests
                   what is built for debugging, without a wheel
  release [POINT…] try everything that is to be so before a version is published, or these points of the list: tree, version,
                   tests, compiler, packages, pages, wheel, materials; nothing is published
  valgrind         run the tests of failures, panics and events of pc-solve under valgrind, where it is installed
  install --prefix DIR [--libdir DIR] [--includedir DIR] [--destdir DIR]
                   build the C library and install it with its headers; `uninstall` with the same removes it
  setup            install what the build needs (the commands above do it by themselves)
  help             this text";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    match dispatch(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error}");
            match &error {
                Error::Usage { .. } => eprintln!("\n{USAGE}"),
                // A program that crashed or was not built has counted nothing: then the sums say nothing.
                Error::Tests { counts, .. } if counts.failed > 0 => println!("{counts}"),
                _ => {}
            }
            error.exit_code()
        }
    }
}

fn dispatch(arguments: &[String]) -> Result<(), Error> {
    let (name, rest) = match arguments {
        [] => ("help", arguments),
        [name, rest @ ..] => (name.as_str(), rest),
    };
    match name {
        "demo" => {
            no_more(name, rest)?;
            demo::run()
        }
        "test" => test::run(&wanted(rest)?),
        "stage" => match rest {
            [title] => test::stage(title),
            _ => Err(Error::Usage { message: "`stage` needs a TITLE".to_owned() }),
        },
        "bench" => bench::run(rest),
        "book" => {
            no_more(name, rest)?;
            book::run()
        }
        "attack" => attack::run(rest),
        "fuzz" => fuzz::run(rest),
        "gallery" => gallery::run(rest),
        "header" => {
            no_more(name, rest)?;
            header::run()
        }
        "scripts" => {
            no_more(name, rest)?;
            scripts::run()
        }
        "c-examples" => {
            no_more(name, rest)?;
            c_examples::run()
        }
        "fmu" => {
            no_more(name, rest)?;
            fmu::run()
        }
        "python" => {
            if quick(name, rest)? {
                python::quick()
            } else {
                python::run()
            }
        }
        "release" => release::run(rest),
        "valgrind" => {
            no_more(name, rest)?;
            valgrind::run()
        }
        "install" => install::install(&Places::of(name, rest)?),
        "uninstall" => install::uninstall(&Places::of(name, rest)?),
        "setup" => {
            no_more(name, rest)?;
            setup::everything()
        }
        "help" | "-h" | "--help" => {
            println!("{USAGE}");
            Ok(())
        }
        unknown => Err(Error::Usage { message: format!("there is no command `{unknown}`") }),
    }
}

/// What the words after `test` ask for.
fn wanted(rest: &[String]) -> Result<Wanted, Error> {
    let mut wanted = Wanted::default();
    let mut words = rest.iter();
    while let Some(word) = words.next() {
        match word.as_str() {
            "--quick" => wanted.quick = true,
            "--since" => {
                let needed = || Error::Usage { message: "`--since` needs a revision of git".to_owned() };
                wanted.since = Some(words.next().ok_or_else(needed)?.clone());
            }
            other => return Err(Error::Usage { message: format!("`test` does not take `{other}`") }),
        }
    }
    Ok(wanted)
}

fn quick(name: &str, rest: &[String]) -> Result<bool, Error> {
    match rest {
        [] => Ok(false),
        [flag, more @ ..] if flag == "--quick" => no_more(&format!("{name} --quick"), more).map(|()| true),
        [other, ..] => Err(Error::Usage { message: format!("`{name}` does not take `{other}`") }),
    }
}

fn no_more(name: &str, rest: &[String]) -> Result<(), Error> {
    match rest.first() {
        None => Ok(()),
        Some(extra) => Err(Error::Usage { message: format!("`{name}` does not take `{extra}`") }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message_of(arguments: &[&str]) -> String {
        let arguments: Vec<String> = arguments.iter().map(ToString::to_string).collect();
        dispatch(&arguments).expect_err("a wrong command line").to_string()
    }

    #[test]
    fn wrong_command_lines_name_the_word_at_fault() {
        assert_eq!(message_of(&["tset"]), "there is no command `tset`");
        assert_eq!(message_of(&["demo", "--fast"]), "`demo` does not take `--fast`");
        assert_eq!(message_of(&["test", "--fast"]), "`test` does not take `--fast`");
        assert_eq!(message_of(&["test", "--since"]), "`--since` needs a revision of git");
        assert_eq!(message_of(&["stage"]), "`stage` needs a TITLE");
        assert_eq!(message_of(&["install"]), "`install` needs `--prefix DIR`");
        assert_eq!(message_of(&["uninstall", "--prefix", "a", "b"]), "`uninstall` does not take `b`");
        assert_eq!(message_of(&["test", "--quick", "x"]), "`test` does not take `x`");
    }

    #[test]
    fn help_is_not_an_error() {
        assert!(dispatch(&[]).is_ok());
        assert!(dispatch(&["help".into()]).is_ok());
    }
}
