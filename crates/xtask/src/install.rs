//! `cargo xtask install --prefix DIR` and `uninstall`: the libraries, the headers, and what finds them.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{announce_and_run, cargo, run, target_directory, workspace_root};
use crate::error::Error;
use crate::header::{abi_version, functions_of_header, headers, macro_of_header};
use crate::setup;

/// What a program linked with the archive needs beside it, and what compilers add by themselves.
pub(crate) const STATIC_LIBS: &str = "-lm -lpthread -ldl -lrt -lutil";

/// Directories of ours alone.
const OWN: [&str; 2] = ["lib/cmake/pc", "include/pc"];

/// A file of the installation, below the prefix.
struct Installed {
    path: String,
    contents: Contents,
}

enum Contents {
    /// A copy of a file.
    Copy(PathBuf),
    /// The archive, in which only the functions of the header are seen.
    Archive(PathBuf),
    /// A link to a file beside it.
    Link(String),
    /// A text written for this prefix.
    Text(String),
}

/// Builds the library and installs it.
///
/// # Errors
/// [`Error::File`], or the failure of the build.
pub(crate) fn install(prefix: &Path) -> Result<(), Error> {
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["build", "--release", "--package", "pc-capi", "--lib"]))?;
    place(&target_directory()?.join("release"), prefix)
}

/// Installs what was built in a directory.
///
/// # Errors
/// [`Error::File`], or the failure of a tool.
pub(crate) fn place(built: &Path, prefix: &Path) -> Result<(), Error> {
    let prefix = std::path::absolute(prefix).map_err(|source| file(prefix, source))?;
    for Installed { path, contents } in files(built, &prefix)? {
        let path = prefix.join(path);
        let directory = path.parent().unwrap_or(&prefix);
        fs::create_dir_all(directory).map_err(|source| file(directory, source))?;
        match contents {
            Contents::Copy(from) => {
                fs::copy(from, &path).map_err(|source| file(&path, source))?;
            }
            Contents::Link(to) => {
                let _ = fs::remove_file(&path); // one that is there would be in the way
                symlink(to, &path).map_err(|source| file(&path, source))?;
            }
            Contents::Text(text) => fs::write(&path, text).map_err(|source| file(&path, source))?,
            Contents::Archive(from) => archive(&from, &path)?,
        }
        println!("{}", path.display());
    }
    Ok(())
}

/// Removes what [`install`] has written, and no more.
///
/// # Errors
/// [`Error::File`] where a file cannot be removed; one that is not there is none.
pub(crate) fn uninstall(prefix: &Path) -> Result<(), Error> {
    let prefix = std::path::absolute(prefix).map_err(|source| file(prefix, source))?;
    for Installed { path, .. } in files(Path::new(""), &prefix)? {
        let path = prefix.join(path);
        match fs::remove_file(&path) {
            Err(source) if source.kind() != std::io::ErrorKind::NotFound => return Err(file(&path, source)),
            _ => {}
        }
    }
    for directory in OWN {
        let _ = fs::remove_dir(prefix.join(directory)); // only if nothing else is in it
    }
    Ok(())
}

/// The files and links below a directory, in order.
///
/// # Errors
/// [`Error::File`] where one cannot be read.
pub(crate) fn left(directory: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    for entry in fs::read_dir(directory).map_err(|source| file(directory, source))? {
        let path = entry.map_err(|source| file(directory, source))?.path();
        if path.is_dir() && !path.is_symlink() {
            found.append(&mut left(&path)?);
        } else {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// The files of the library that was built in a directory.
fn files(built: &Path, prefix: &Path) -> Result<Vec<Installed>, Error> {
    let (root, abi) = (workspace_root(), abi_version()?);
    let number = |name| macro_of_header(&format!("PC_VERSION_{name}"));
    let version = format!("{}.{}.{}", number("MAJOR")?, number("MINOR")?, number("PATCH")?);
    let of = |path: &str, contents| Installed { path: path.to_owned(), contents };
    let include = root.join("include");
    let headers = headers(&include)?.into_iter();
    let headers = headers.map(|name| of(&format!("include/{name}"), Contents::Copy(include.join(name))));
    let libraries = [
        of(&format!("lib/libpc.so.{abi}"), Contents::Copy(built.join("libpc.so"))),
        of("lib/libpc.so", Contents::Link(format!("libpc.so.{abi}"))),
        of("lib/libpc.a", Contents::Archive(built.join("libpc.a"))),
        of("lib/pkgconfig/libpc.pc", Contents::Text(pkg_config(prefix, &version))),
        of("lib/cmake/pc/pcConfig.cmake", Contents::Text(cmake_config(&abi))),
        of("lib/cmake/pc/pcConfigVersion.cmake", Contents::Text(cmake_version(&version))),
    ];
    Ok(headers.chain(libraries).collect())
}

/// Links what the functions of the header need to one object, in which nothing else is global: a program may
/// have a SUNDIALS of its own.
fn archive(from: &Path, to: &Path) -> Result<(), Error> {
    let object = to.with_extension("o");
    let mut link = Command::new("ld");
    link.args(["-r", "--gc-sections"]);
    for function in functions_of_header()? {
        link.arg("-u").arg(function);
    }
    run(link.arg(from).arg("-o").arg(&object))?;
    // The standard library of Rust comes with bitcode, which is of no use here and which tools stumble over.
    let mut hide = Command::new("objcopy");
    hide.args(["--strip-debug", "--remove-section=.llvmbc", "--remove-section=.llvmcmd"]);
    run(hide.args(["--wildcard", "--keep-global-symbol=pc_*"]).arg(&object))?;
    let _ = fs::remove_file(to); // an archive that is there would be added to
    run(Command::new("ar").arg("rcs").arg(to).arg(&object))?;
    fs::remove_file(&object).map_err(|source| file(&object, source))
}

fn pkg_config(prefix: &Path, version: &str) -> String {
    format!(
        "prefix={}\nincludedir=${{prefix}}/include\nlibdir=${{prefix}}/lib\n\n\
         Name: pc\nDescription: Poincaré–Chetaev equations of mechanical systems\nVersion: {version}\n\
         Cflags: -I${{includedir}}\nLibs: -L${{libdir}} -lpc\nLibs.private: {STATIC_LIBS}\n",
        prefix.display()
    )
}

fn cmake_config(abi: &str) -> String {
    format!(
        "# Targets pc::pc, the shared library, and pc::static.\n\
         get_filename_component(_pc_prefix \"${{CMAKE_CURRENT_LIST_DIR}}/../../..\" ABSOLUTE)\n\
         if(NOT TARGET pc::pc)\n  \
           add_library(pc::pc SHARED IMPORTED)\n  \
           set_target_properties(pc::pc PROPERTIES\n    \
             IMPORTED_LOCATION \"${{_pc_prefix}}/lib/libpc.so.{abi}\"\n    \
             IMPORTED_SONAME \"libpc.so.{abi}\"\n    \
             INTERFACE_INCLUDE_DIRECTORIES \"${{_pc_prefix}}/include\")\n  \
           add_library(pc::static STATIC IMPORTED)\n  \
           set_target_properties(pc::static PROPERTIES\n    \
             IMPORTED_LOCATION \"${{_pc_prefix}}/lib/libpc.a\"\n    \
             INTERFACE_INCLUDE_DIRECTORIES \"${{_pc_prefix}}/include\"\n    \
             INTERFACE_LINK_LIBRARIES \"{STATIC_LIBS}\")\n\
         endif()\n"
    )
}

fn cmake_version(version: &str) -> String {
    format!(
        "set(PACKAGE_VERSION \"{version}\")\n\
         if(PACKAGE_VERSION VERSION_LESS PACKAGE_FIND_VERSION)\n  set(PACKAGE_VERSION_COMPATIBLE FALSE)\n\
         else()\n  set(PACKAGE_VERSION_COMPATIBLE TRUE)\nendif()\n\
         if(PACKAGE_VERSION VERSION_EQUAL PACKAGE_FIND_VERSION)\n  set(PACKAGE_VERSION_EXACT TRUE)\nendif()\n"
    )
}

fn file(path: &Path, source: std::io::Error) -> Error {
    Error::File { path: path.display().to_string(), source }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_stands_below_the_prefix() {
        for Installed { path, .. } in files(Path::new("/built"), Path::new("/opt/pc")).unwrap() {
            assert!(path.starts_with("lib/") || path.starts_with("include/"), "{path}");
        }
    }

    #[test]
    fn all_that_is_installed_is_removed_and_nothing_else() {
        let prefix = tempfile::tempdir().unwrap();
        let prefix = std::path::absolute(prefix.path()).unwrap();
        let own = ["include/other.h", "lib/cmake/pc/other.cmake"].map(|path| prefix.join(path));
        let files: Vec<_> = files(Path::new("/built"), &prefix).unwrap();
        for path in files.iter().map(|file| prefix.join(&file.path)).chain(own.clone()) {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        assert_eq!(left(&prefix).unwrap().len(), files.len() + own.len());
        uninstall(&prefix).unwrap();
        assert_eq!(left(&prefix).unwrap(), own);
        assert!(!prefix.join("include/pc").exists() && prefix.join("lib/cmake/pc").exists());
        uninstall(&prefix).unwrap(); // there is nothing, which is no failure
    }

    #[test]
    fn what_finds_the_library_names_its_place() {
        let text = pkg_config(Path::new("/opt/pc"), "0.1.0");
        assert!(text.starts_with("prefix=/opt/pc\n") && text.contains("\nVersion: 0.1.0\n"));
        assert!(cmake_config("3").contains("\"${_pc_prefix}/lib/libpc.so.3\""));
    }
}
