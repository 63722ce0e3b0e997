//! `cargo xtask install --prefix DIR` and `uninstall`: the libraries, the headers, and what finds them.

mod places;
mod texts;
#[cfg(test)]
mod trial;

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io, process};

use crate::command::{announce_and_run, cargo, run, target_directory, workspace_root};
use crate::error::Error;
use crate::header::{abi_version, functions_of_header, headers, macro_of_header};
use crate::setup;
use crate::tools::Machine;

pub(crate) use places::Places;

/// What a program linked with the archive needs beside it, and what compilers add by themselves.
pub(crate) const STATIC_LIBS: &str = "-lm -lpthread -ldl -lrt -lutil";

/// A file of the installation.
struct Installed {
    path: PathBuf,
    contents: Contents,
}

enum Contents {
    /// A copy of a file.
    Copy(PathBuf),
    /// What debuggers read of a library.
    Debugging(PathBuf),
    /// A library without that, which tells debuggers the name of the file beside it that has it.
    Library { from: PathBuf, debugging: String },
    /// The archive, in which only the functions of the header are seen.
    Archive(PathBuf),
    /// A link to a file beside it.
    Link(String),
    /// A text written for these places.
    Text(String),
}

/// Builds the library and installs it.
///
/// # Errors
/// [`Error::File`], or the failure of the build; [`Error::NotLinux`].
pub(crate) fn install(places: &Places) -> Result<(), Error> {
    known(env::consts::OS)?;
    setup::native_tools()?;
    announce_and_run(&mut cargo(&["build", "--release", "--package", "pc-capi", "--lib"]))?;
    place(&target_directory()?.join("release"), places)
}

/// Installs what was built in a directory.
///
/// # Errors
/// [`Error::File`], or the failure of a tool; [`Error::Missing`] if there is none, and then nothing is installed;
/// [`Error::NotLinux`].
pub(crate) fn place(built: &Path, places: &Places) -> Result<(), Error> {
    known(env::consts::OS)?;
    binutils(&Machine::this())?;
    for Installed { path, contents } in files(built, places)? {
        let path = places.staged(&path);
        put(&path, contents)?;
        println!("{}", path.display());
    }
    Ok(())
}

/// Removes what [`install`] has written there, libraries of earlier numbers too, and no more.
///
/// # Errors
/// [`Error::File`] where a file cannot be removed; one that is not there is none. [`Error::NotLinux`].
pub(crate) fn uninstall(places: &Places) -> Result<(), Error> {
    known(env::consts::OS)?;
    let files = files(Path::new(""), places)?;
    let mut paths: Vec<PathBuf> = files.iter().map(|file| places.staged(&file.path)).collect();
    paths.extend(numbered(&places.staged(&places.libdir)));
    for path in &paths {
        match fs::remove_file(path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => return Err(file(path, source)),
            _ => {}
        }
    }
    let shared = [&places.libdir.join("cmake"), &places.libdir.join("pkgconfig")];
    let above = |directory: &Path| {
        places.libdir.starts_with(directory)
            || places.includedir.starts_with(directory)
            || shared.iter().any(|shared| directory == *shared)
    };
    let own: BTreeSet<&Path> = files
        .iter()
        .flat_map(|file| file.path.ancestors().skip(1).take_while(|directory| !above(directory)))
        .collect();
    for directory in own.into_iter().rev() {
        let _ = fs::remove_dir(places.staged(directory)); // only if nothing else is in it
    }
    Ok(())
}

/// Refuses systems whose names of libraries and whose linkers are others than those below.
fn known(system: &str) -> Result<(), Error> {
    match system {
        "linux" => Ok(()),
        other => Err(Error::NotLinux { system: other.to_owned() }),
    }
}

/// That there are the tools that make of a library what is installed.
fn binutils(machine: &Machine) -> Result<(), Error> {
    let missing: Vec<_> =
        ["ld", "objcopy", "ar"].into_iter().filter(|name| !machine.has_program(name)).collect();
    let remedy = || "install the package binutils".to_owned();
    if missing.is_empty() { Ok(()) } else { Err(Error::Missing { tools: missing, remedy: remedy() }) }
}

/// The shared libraries in a directory, of whatever number, with what debuggers read of them.
fn numbered(directory: &Path) -> Vec<PathBuf> {
    let number = |name: &str| {
        let number = name.strip_prefix("libpc.so.").map(|rest| rest.strip_suffix(".debug").unwrap_or(rest));
        number.is_some_and(|number| number.parse::<u32>().is_ok())
    };
    let entries = fs::read_dir(directory).into_iter().flatten().flatten();
    entries.filter(|entry| entry.file_name().to_str().is_some_and(number)).map(|entry| entry.path()).collect()
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

/// The files of the library that was built in a directory: the headers are those of `include`.
fn files(built: &Path, places: &Places) -> Result<Vec<Installed>, Error> {
    let (include, abi) = (workspace_root().join("include"), abi_version()?);
    let number = |name| macro_of_header(&format!("PC_VERSION_{name}"));
    let version = format!("{}.{}.{}", number("MAJOR")?, number("MINOR")?, number("PATCH")?);
    let mut files = Vec::new();
    for name in headers(&include)? {
        let contents = Contents::Copy(include.join(&name));
        files.push(Installed { path: places.includedir.join(name), contents });
    }
    let library = format!("libpc.so.{abi}");
    let (from, debugging) = (built.join("libpc.so"), format!("{library}.debug"));
    for (name, contents) in [
        (debugging.as_str(), Contents::Debugging(from.clone())),
        (library.as_str(), Contents::Library { from, debugging: debugging.clone() }),
        ("libpc.so", Contents::Link(library.clone())),
        ("libpc.a", Contents::Archive(built.join("libpc.a"))),
        ("pkgconfig/libpc.pc", Contents::Text(texts::pkg_config(places, &version))),
        ("cmake/pc/pcConfig.cmake", Contents::Text(texts::cmake_config(places, &abi))),
        ("cmake/pc/pcConfigVersion.cmake", Contents::Text(texts::cmake_version(&version))),
    ] {
        files.push(Installed { path: places.libdir.join(name), contents });
    }
    Ok(files)
}

/// Makes a file beside its place and moves it there: who has the one before in use keeps that, and where a link stands,
/// what it leads to stays as it is.
fn put(path: &Path, contents: Contents) -> Result<(), Error> {
    let (Some(directory), Some(name)) = (path.parent(), path.file_name()) else { return Ok(()) };
    let workshop = directory.join(format!(".pc-install-{}", process::id()));
    let new = workshop.join(name);
    fs::create_dir_all(&workshop).map_err(|source| file(&workshop, source))?;
    let made = match contents {
        Contents::Copy(from) => fs::copy(&from, &new).map(|_| ()).map_err(|source| file(&from, source)),
        Contents::Link(to) => symlink(to, &new).map_err(|source| file(&new, source)),
        Contents::Text(text) => fs::write(&new, text).map_err(|source| file(&new, source)),
        Contents::Debugging(from) => {
            run(Command::new("objcopy").arg("--only-keep-debug").arg(from).arg(&new))
        }
        Contents::Library { from, debugging } => stripped(&from, &directory.join(debugging), &new),
        Contents::Archive(from) => archive(&from, &new),
    };
    let moved = made.and_then(|()| fs::rename(&new, path).map_err(|source| file(path, source)));
    let cleared = fs::remove_dir_all(&workshop).map_err(|source| file(&workshop, source));
    moved.and(cleared)
}

/// The library without what is in `debugging`, which stands beside it.
fn stripped(from: &Path, debugging: &Path, to: &Path) -> Result<(), Error> {
    let mut link = OsString::from("--add-gnu-debuglink=");
    link.push(debugging);
    run(Command::new("objcopy").arg("--strip-unneeded").arg(link).arg(from).arg(to))
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
    run(Command::new("ar").arg("rcs").arg(to).arg(&object))
}

fn file(path: &Path, source: io::Error) -> Error {
    Error::File { path: path.display().to_string(), source }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_stands_where_it_should() {
        let places = Places::below(Path::new("/opt/pc")).unwrap();
        let files = files(Path::new("/built"), &places).unwrap();
        for Installed { path, .. } in &files {
            assert!(path.starts_with("/opt/pc/lib") || path.starts_with("/opt/pc/include"), "{path:?}");
        }
        for name in ["include/pc.h", "include/pc.hpp", "include/pc/cvode.h", "lib/libpc.so", "lib/libpc.a"] {
            let path = Path::new("/opt/pc").join(name);
            assert_eq!(files.iter().filter(|file| file.path == path).count(), 1, "{name}");
        }
    }

    #[test]
    fn all_that_is_installed_is_removed_and_nothing_else() {
        let root = tempfile::tempdir().unwrap();
        let at = |name: &str| root.path().join(name).display().to_string();
        let packed =
            ["--prefix", &at("usr"), "--libdir", "lib/x", "--destdir", &at("packed")].map(str::to_owned);
        let plain = ["--prefix", &at("own")].map(str::to_owned);
        for words in [&packed[..], &plain] {
            let places = Places::of("install", words).unwrap();
            let (lib, include) = (places.staged(&places.libdir), places.staged(&places.includedir));
            let mut own = vec![
                include.join("other.h"),
                lib.join("cmake/pc/other.cmake"),
                lib.join("libpc.so.0.1"),
                lib.join("libpc.so.none"),
                lib.join("libpc.so.none.debug"),
                lib.join("libpcre.so.3"),
            ];
            own.sort();
            let files: Vec<_> = files(Path::new("/built"), &places).unwrap();
            let ours = files.iter().map(|file| places.staged(&file.path));
            let earlier = ["libpc.so.7", "libpc.so.7.debug", "libpc.so.12"].map(|name| lib.join(name));
            for path in ours.chain(earlier).chain(own.clone()) {
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, "").unwrap();
            }
            let top = places.staged(&places.prefix);
            assert_eq!(left(&top).unwrap().len(), files.len() + 3 + own.len());
            uninstall(&places).unwrap();
            assert_eq!(left(&top).unwrap(), own);
            assert!(!include.join("pc").exists() && lib.join("cmake/pc").exists());
            uninstall(&places).unwrap(); // there is nothing, which is no failure
            fs::remove_file(lib.join("cmake/pc/other.cmake")).unwrap();
            uninstall(&places).unwrap();
            assert!(!lib.join("cmake/pc").exists() && lib.join("cmake").exists());
        }
    }

    /// As a program that has it mapped does, this one still sees the old contents; and what a link leads to is not written.
    #[test]
    fn files_in_use_are_left_alone() {
        let directory = tempfile::tempdir().unwrap();
        let at = |name: &str| directory.path().join(name);
        let read = |path: &Path| fs::read_to_string(path).unwrap();
        let new = at("new");
        fs::write(&new, "new").unwrap();
        let made: [fn(&Path) -> Contents; 3] = [
            |new| Contents::Copy(new.to_owned()),
            |_| Contents::Text("new".to_owned()),
            |_| Contents::Link("new".to_owned()),
        ];
        for make in made {
            fs::write(at("used"), "old").unwrap();
            let mut in_use = fs::File::open(at("used")).unwrap();
            put(&at("used"), make(&new)).unwrap();
            assert_eq!(io::read_to_string(&mut in_use).unwrap(), "old");
            assert_eq!(read(&at("used")), "new");

            fs::write(at("other"), "other").unwrap();
            symlink("other", at("link")).unwrap();
            put(&at("link"), make(&new)).unwrap();
            assert_eq!((read(&at("link")), read(&at("other"))), ("new".to_owned(), "other".to_owned()));
            for name in ["used", "link", "other"] {
                fs::remove_file(at(name)).unwrap();
            }
        }
        // What fails leaves what was there, and nothing else.
        fs::write(at("used"), "old").unwrap();
        let error = put(&at("used"), Contents::Copy(at("missing"))).unwrap_err().to_string();
        assert!(error.contains("missing"), "{error}");
        assert_eq!(
            (read(&at("used")), left(directory.path()).unwrap()),
            ("old".to_owned(), vec![new, at("used")])
        );
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 2);
    }

    #[test]
    fn missing_tools_are_named() {
        let directory = tempfile::tempdir().unwrap();
        fs::write(directory.path().join("ld"), "").unwrap();
        let error = binutils(&Machine::with_path(directory.path())).unwrap_err();
        assert_eq!(error.to_string(), "missing: objcopy, ar\ninstall the package binutils");
    }

    #[test]
    fn other_systems_are_refused() {
        assert!(known("linux").is_ok());
        assert_eq!(
            known("macos").unwrap_err().to_string(),
            "installing is made for Linux; on macos take the library from target/release and the headers from include"
        );
    }
}
