//! The compiler of this machine, and the name that FMI has for its binaries.

use std::env::{self, consts};
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::error::FmuError;
use crate::options::FmiVersion;

/// The folder of binaries and the ending of their names.
///
/// # Errors
/// [`FmuError::Platform`]
pub(crate) fn binary(version: FmiVersion, identifier: &str) -> Result<String, FmuError> {
    let (system, processor) = (consts::OS, consts::ARCH);
    let folder = match (version, system, processor) {
        (FmiVersion::V2, "linux", "x86_64") => "linux64",
        (FmiVersion::V2, "macos", "x86_64" | "aarch64") => "darwin64",
        (_, "linux", "x86_64") => "x86_64-linux",
        (_, "linux", "aarch64") => "aarch64-linux",
        (_, "macos", "x86_64") => "x86_64-darwin",
        (_, "macos", "aarch64") => "aarch64-darwin",
        _ => return Err(FmuError::Platform { system, processor }),
    };
    let ending = if system == "macos" { "dylib" } else { "so" };
    Ok(format!("binaries/{folder}/{identifier}.{ending}"))
}

/// The shared library of these files, of which those called `sources` are compiled, by the compiler that the variable CC names,
/// else `cc`.
///
/// # Errors
/// [`FmuError`] where there is no compiler, or it refuses.
pub(crate) fn compile(files: &[(String, Vec<u8>)], sources: &[String]) -> Result<Vec<u8>, FmuError> {
    let at = |path: &Path| {
        let path = path.to_owned();
        move |source| FmuError::Io { path, source }
    };
    let place = tempfile::tempdir().map_err(at(&env::temp_dir()))?;
    for (name, bytes) in files {
        let path = place.path().join(name);
        fs::write(&path, bytes).map_err(at(&path))?;
    }
    let compiler =
        env::var("CC").ok().filter(|name| !name.trim().is_empty()).unwrap_or_else(|| "cc".to_owned());
    // As make does, CC may have options of its own.
    let mut words = compiler.split_whitespace();
    let mut command = Command::new(words.next().unwrap_or("cc"));
    command.args(words);
    // The same sums in the same order as the library: nothing is fused.
    command.args(["-std=c99", "-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-ffp-contract=off"]);
    command.args(["-o", "model.so"]).args(sources).arg("-lm").current_dir(place.path());
    let output =
        command.output().map_err(|source| FmuError::NoCompiler { compiler: compiler.clone(), source })?;
    if !output.status.success() {
        let arguments: Vec<_> = command.get_args().map(|word| word.to_string_lossy().into_owned()).collect();
        return Err(FmuError::Compiler {
            command: format!("{compiler} {}", arguments.join(" ")),
            output: String::from_utf8_lossy(&output.stderr).trim_end().to_owned(),
        });
    }
    let library = place.path().join("model.so");
    fs::read(&library).map_err(at(&library))
}
