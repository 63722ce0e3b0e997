//! What programs in C are built with for the tests: a library where the linker finds it, and the sanitizers where they run.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use crate::command::succeeds;
use crate::error::Error;

/// Memory errors, leaks and undefined behaviour end a program.
pub(crate) const SANITIZED: &str = "-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all";

/// Makes a directory that has the shared library by all its names.
///
/// # Errors
/// [`Error::File`].
pub(crate) fn link(shared: &Path, libraries: &Path) -> Result<(), Error> {
    let wrong = |source| Error::of_file(libraries, source);
    fs::create_dir_all(libraries).map_err(wrong)?;
    for name in ["libpc.so".to_owned(), format!("libpc.so.{}", crate::header::abi_version()?)] {
        let _ = fs::remove_file(libraries.join(&name)); // one that is there would be in the way
        symlink(shared, libraries.join(name)).map_err(wrong)?;
    }
    Ok(())
}

/// Whether a program compiled with such flags can be built and run.
pub(crate) fn works(compiler: &str, flags: &str, place: &Path) -> bool {
    let (source, program) = (place.join("nothing.c"), place.join("nothing"));
    let written = fs::write(&source, "int main(void) { return 0; }\n").is_ok();
    let mut compile = Command::new(compiler);
    compile.args(flags.split_whitespace()).arg(source).arg("-o").arg(&program);
    written && succeeds(&mut compile) && succeeds(&mut Command::new(program))
}
