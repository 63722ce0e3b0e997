//! `cargo xtask setup`: installs what is missing, and says so before it does.

use std::io::{self, IsTerminal};
use std::process::Command;

use crate::command::{announce_and_run, cargo, succeeds};
use crate::error::Error;
use crate::packages::{PackageManager, remedy};
use crate::tools::{Machine, Tool};

/// Everything that building, formatting and linting need, and the browser in which reports are looked at where it can be had.
pub(crate) fn everything() -> Result<(), Error> {
    native_tools()?;
    rust_components()?;
    browser();
    println!("set-up: nothing is missing");
    Ok(())
}

/// The native tools, without which SUNDIALS does not build. Silent where nothing is missing.
///
/// Installs by itself where there is `apt-get` and a right to use it; elsewhere says what to install.
///
/// # Errors
/// [`Error::Missing`] with the line to type, or the failure of the installation.
pub(crate) fn native_tools() -> Result<(), Error> {
    if let Some(path) = Machine::this().wrong_libclang_path() {
        return Err(Error::LibclangPath { path: path.display().to_string() });
    }
    tools(&Tool::OF_BUILD)
}

/// The same, and a C++ compiler, which a machine that has gcc need not have: the examples in C++ are built with it.
///
/// # Errors
/// As there.
pub(crate) fn native_tools_and_cpp() -> Result<(), Error> {
    native_tools()?;
    tools(&[Tool::CppCompiler])
}

/// Python, installed where we may: whoever asks has looked for it.
///
/// # Errors
/// As there.
pub(crate) fn python() -> Result<(), Error> {
    obtain(&Machine::this(), &[Tool::Python])
}

fn tools(wanted: &[Tool]) -> Result<(), Error> {
    let machine = Machine::this();
    let missing = machine.missing(wanted);
    if missing.is_empty() {
        return Ok(());
    }
    obtain(&machine, &missing)?;
    let missing = Machine::this().missing(wanted);
    if missing.is_empty() { Ok(()) } else { Err(Error::StillMissing { tools: names(&missing) }) }
}

/// Installs tools, or says how to.
fn obtain(machine: &Machine, missing: &[Tool]) -> Result<(), Error> {
    let manager = PackageManager::of(machine);
    let rights = if manager == Some(PackageManager::Apt) { Rights::of(machine) } else { Rights::None };
    let Some(prefix) = rights.prefix() else {
        return Err(Error::Missing { tools: names(missing), remedy: remedy(manager, missing) });
    };
    println!("set-up: missing: {}", names(missing).join(", "));
    install(prefix, &PackageManager::Apt.packages(missing))
}

/// Installs packages of Debian.
fn install(prefix: &[&str], packages: &[&str]) -> Result<(), Error> {
    // A foreign source that does not answer makes the update fail and is no obstacle to the installation.
    if let Err(error) = announce_and_run(&mut apt_get(prefix, &["update", "-q"])) {
        eprintln!("set-up: {error}; going on");
    }
    let install = ["install", "-q", "--yes", "--no-install-recommends"];
    announce_and_run(apt_get(prefix, &install).args(packages))
}

/// Chromium, without which the tests of pages in a browser are skipped: it is installed where we may, and named where not.
fn browser() {
    let machine = Machine::this();
    let found = |machine: &Machine| {
        machine.has_variable("CHROMIUM")
            || ["chromium", "chromium-browser", "google-chrome"].iter().any(|name| machine.has_program(name))
    };
    if found(&machine) {
        return;
    }
    if PackageManager::of(&machine) == Some(PackageManager::Apt)
        && let Some(prefix) = Rights::of(&machine).prefix()
    {
        println!("set-up: missing: chromium");
        if let Err(error) = install(prefix, &["chromium"]) {
            eprintln!("set-up: {error}; going on");
        }
    }
    if !found(&Machine::this()) {
        println!("skipped: the tests of pages in a browser; install chromium, or name one by CHROMIUM");
    }
}

/// Whether clang's sanitizers are there, which distributions have in a package of their own: it is installed where we may, and
/// named where not. `work` tries them.
pub(crate) fn sanitizers_of_clang(work: impl Fn() -> bool) -> bool {
    if work() {
        return true;
    }
    let machine = Machine::this();
    let version = Command::new("clang").arg("-dumpversion").output().map(|output| output.stdout);
    let version = String::from_utf8_lossy(&version.unwrap_or_default()).into_owned();
    let manager = PackageManager::of(&machine);
    let package = manager.and_then(|manager| manager.sanitizers(&version));
    if let (Some(PackageManager::Apt), Some(package)) = (manager, &package)
        && let Some(prefix) = Rights::of(&machine).prefix()
    {
        println!("set-up: missing: the sanitizers of clang");
        if let Err(error) = install(prefix, &[package]) {
            eprintln!("set-up: {error}; going on");
        }
        if work() {
            return true;
        }
    }
    let where_from =
        package.map_or_else(String::new, |package| format!("; they are in the package {package}"));
    println!("skipped: the sanitizers of clang, which do not run here{where_from}");
    false
}

/// rustfmt and clippy.
fn rust_components() -> Result<(), Error> {
    let missing: Vec<&'static str> = [("rustfmt", "fmt"), ("clippy", "clippy")]
        .into_iter()
        .filter(|(_, subcommand)| !succeeds(&mut cargo(&[subcommand, "--version"])))
        .map(|(component, _)| component)
        .collect();
    if missing.is_empty() {
        return Ok(());
    }
    if !succeeds(Command::new("rustup").arg("--version")) {
        let remedy =
            "install them with the packages of your Rust, or Rust itself with https://rustup.rs".into();
        return Err(Error::Missing { tools: missing, remedy });
    }
    announce_and_run(Command::new("rustup").args(["component", "add"]).args(missing))
}

/// The right to install packages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rights {
    Root,
    Sudo,
    None,
}

impl Rights {
    /// `sudo` counts where it needs no password or where there is someone to type it.
    fn of(machine: &Machine) -> Rights {
        let user = Command::new("id").arg("-u").output();
        if user.is_ok_and(|output| output.stdout.trim_ascii() == b"0") {
            Rights::Root
        } else if machine.has_program("sudo")
            && (succeeds(Command::new("sudo").args(["-n", "true"])) || io::stdin().is_terminal())
        {
            Rights::Sudo
        } else {
            Rights::None
        }
    }

    /// What stands before `apt-get` on the command line.
    fn prefix(self) -> Option<&'static [&'static str]> {
        match self {
            Rights::Root => Some(&["env"]),
            Rights::Sudo => Some(&["sudo", "env"]),
            Rights::None => None,
        }
    }
}

fn apt_get(prefix: &[&str], arguments: &[&str]) -> Command {
    let mut command = Command::new(prefix[0]);
    command.args(&prefix[1..]).args(["DEBIAN_FRONTEND=noninteractive", "apt-get"]).args(arguments);
    command
}

fn names(tools: &[Tool]) -> Vec<&'static str> {
    tools.iter().map(|tool| tool.name()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::line_of;

    #[test]
    fn apt_get_asks_no_questions() {
        let lines = [Rights::Root, Rights::Sudo].map(|r| line_of(&apt_get(r.prefix().unwrap(), &["update"])));
        assert_eq!(lines[0], "env DEBIAN_FRONTEND=noninteractive apt-get update");
        assert_eq!(lines[1], "sudo env DEBIAN_FRONTEND=noninteractive apt-get update");
        assert_eq!(Rights::None.prefix(), None);
    }
}
