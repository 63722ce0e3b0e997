//! A small library installed, found, moved and removed, where there are the tools for it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::{Places, abi_version, left, place, texts, uninstall};
use crate::tools::Machine;

/// Whether there are these programs; if not, it is said.
fn there_are(programs: &[&str]) -> bool {
    let machine = Machine::this();
    let missing = programs.iter().find(|program| !machine.has_program(program));
    if let Some(program) = missing {
        println!("skipped: there is no `{program}`");
    }
    missing.is_none()
}

/// What a command prints if it ends well.
#[track_caller]
fn printed(command: &mut Command) -> String {
    let output = command.output().unwrap();
    let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert!(output.status.success(), "{command:?}: {text:?}");
    text.concat()
}

/// Both libraries, with one function of the header and one that nobody is to see.
fn built(directory: &Path) -> PathBuf {
    let source = "const char *pc_version(void) { return \"small\"; }\nint hidden(void) { return 1; }\n";
    fs::write(directory.join("small.c"), source).unwrap();
    let soname = format!("-Wl,-soname,libpc.so.{}", abi_version().unwrap());
    let cc = |arguments: &[&str]| {
        printed(Command::new("cc").current_dir(directory).args(arguments));
    };
    cc(&["-g", "-shared", "-fPIC", &soname, "small.c", "-o", "libpc.so"]);
    cc(&["-c", "small.c", "-o", "small.o"]);
    printed(Command::new("ar").current_dir(directory).args(["rcs", "libpc.a", "small.o"]));
    directory.to_owned()
}

const PROGRAM: &str =
    "#include <pc.h>\n#include <string.h>\nint main(void) { return strcmp(pc_version(), \"small\"); }\n";

/// Builds and runs a program by what pkg-config says of the library in `libdir`, with both libraries.
fn with_pkg_config(libdir: &Path, work: &Path) {
    fs::write(work.join("program.c"), PROGRAM).unwrap();
    let archive = "'s/-lpc/-l:libpc.a/'";
    let words = "pkg-config --cflags --libs libpc";
    for line in [
        format!("eval \"cc program.c -o program $({words})\""),
        format!("eval \"cc program.c -o program $({words} --static | sed {archive})\""),
    ] {
        let mut shell = Command::new("sh");
        shell.current_dir(work).env("PKG_CONFIG_PATH", libdir.join("pkgconfig"));
        printed(shell.args(["-c", &format!("set -e; {line}; ./program")]).env("LD_LIBRARY_PATH", libdir));
    }
}

/// The files that CMake's targets name are there.
fn with_cmake(libdir: &Path, work: &Path) {
    let lists = "cmake_minimum_required(VERSION 3.16)\nproject(trial NONE)\nfind_package(pc REQUIRED CONFIG)\n\
                 foreach(target pc::pc pc::static)\n  \
                   get_target_property(library ${target} IMPORTED_LOCATION)\n  \
                   get_target_property(headers ${target} INTERFACE_INCLUDE_DIRECTORIES)\n  \
                   foreach(file \"${library}\" \"${headers}/pc.h\")\n    \
                     if(NOT EXISTS \"${file}\")\n      message(FATAL_ERROR \"no ${file}\")\n    endif()\n  \
                   endforeach()\n\
                 endforeach()\n";
    fs::write(work.join("CMakeLists.txt"), lists).unwrap();
    let _ = fs::remove_dir_all(work.join("build")); // of another place
    let mut cmake = Command::new("cmake");
    cmake.args(["-S", ".", "-B", "build"]).current_dir(work);
    printed(cmake.arg(format!("-Dpc_DIR={}", libdir.join("cmake/pc").display())));
}

/// In places with blanks, in those of a distribution, and in some that have nothing to do with each other.
#[test]
fn a_library_is_found_in_any_prefix() {
    if !there_are(&["cc", "ar", "ld", "objcopy", "pkg-config", "cmake"]) {
        return;
    }
    let root = tempfile::tempdir().unwrap();
    let built = built(root.path());
    for (n, (libdir, includedir)) in
        [("lib", "include"), ("lib/a b/64", "include/ours too"), ("/li b/ä", "/inc lude")]
            .into_iter()
            .enumerate()
    {
        let (top, work) = (root.path().join(format!("to p{n}")), root.path().join(format!("work{n}")));
        fs::create_dir(&work).unwrap();
        // An absolute directory is one beside the prefix.
        let directory = |name: &str| match name.strip_prefix('/') {
            Some(name) => top.join(name).display().to_string(),
            None => name.to_owned(),
        };
        let prefix = top.join("pre fix").display().to_string();
        let mut words = vec!["--prefix".to_owned(), prefix, "--libdir".to_owned(), directory(libdir)];
        words.extend(["--includedir".to_owned(), directory(includedir)]);
        let places = Places::of("install", &words).unwrap();
        place(&built, &places).unwrap();
        place(&built, &places).unwrap(); // once more, over what is there
        with_pkg_config(&places.libdir, &work);
        with_cmake(&places.libdir, &work);
        let symbols = printed(Command::new("nm").arg("-g").arg(places.libdir.join("libpc.a")));
        assert!(symbols.contains("pc_version") && !symbols.contains("hidden"), "{symbols}");
        if let Some(inside) = places.inside(&places.libdir) {
            let moved = root.path().join("mo ved");
            fs::rename(&places.prefix, &moved).unwrap();
            with_pkg_config(&moved.join(inside), &work);
            with_cmake(&moved.join(inside), &work);
            fs::rename(&moved, &places.prefix).unwrap();
        }
        // In a directory of a packager it is the same, to the last byte.
        let dest = root.path().join(format!("dest{n}"));
        words.extend(["--destdir".to_owned(), dest.display().to_string()]);
        let packed = Places::of("install", &words).unwrap();
        place(&built, &packed).unwrap();
        for path in left(&top).unwrap() {
            let (there, here) = (fs::read(packed.staged(&path)).unwrap(), fs::read(&path).unwrap());
            assert!(there == here, "{}", path.display());
        }
        assert_eq!(left(&dest).unwrap().len(), left(&top).unwrap().len());
        uninstall(&packed).unwrap();
        assert_eq!(left(&dest).unwrap(), [] as [PathBuf; 0]);
        uninstall(&places).unwrap();
        assert_eq!(left(&top).unwrap(), [] as [PathBuf; 0]);
    }
}

/// The library is small, and debuggers still find lines and functions, in the file beside it.
#[test]
fn debugging_information_is_beside_the_library() {
    if !there_are(&["cc", "ar", "ld", "objcopy", "nm", "readelf", "addr2line"]) {
        return;
    }
    let root = tempfile::tempdir().unwrap();
    let built = built(root.path());
    let places = Places::below(&root.path().join("pre fix")).unwrap();
    place(&built, &places).unwrap();
    let library = places.libdir.join(format!("libpc.so.{}", abi_version().unwrap()));
    let debugging = library.with_file_name(format!("libpc.so.{}.debug", abi_version().unwrap()));
    let sections = |file: &Path| printed(Command::new("readelf").args(["-S", "-W"]).arg(file));
    let (of_library, beside) = (sections(&library), sections(&debugging));
    assert!(!of_library.contains(".debug_") && of_library.contains(".gnu_debuglink"), "{of_library}");
    assert!(beside.contains(".debug_info") && beside.contains(".symtab"), "{beside}");
    let symbols = printed(Command::new("nm").args(["-D", "--defined-only"]).arg(&library));
    let of_version = symbols.lines().find(|line| line.ends_with(" pc_version")).unwrap();
    let address = of_version.split_whitespace().next().unwrap();
    let place = printed(Command::new("addr2line").args(["-f", "-e"]).arg(&library).arg(address));
    assert!(place.contains("pc_version") && place.contains("small.c:1"), "{place}");
}

/// A later version of the same major version will do; before 1.0, one of the same minor version.
#[test]
fn versions_that_fit() {
    if !there_are(&["cmake"]) {
        return;
    }
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("pcConfig.cmake"), "").unwrap();
    for (version, fitting, others) in [
        ("0.3.2", "0.3 0.3.0 0.3.2", "0 0.1 0.2 0.2.5 0.3.3 0.4 1.0 1.3"),
        ("1.3.2", "1 1.0 1.2.9 1.3 1.3.2", "0.3 0.9 1.3.3 1.4 2.0"),
    ] {
        fs::write(root.path().join("pcConfigVersion.cmake"), texts::cmake_version(version)).unwrap();
        let script = format!(
            "foreach(version {fitting} {others})\n  unset(pc_DIR CACHE)\n  \
               find_package(pc ${{version}} QUIET CONFIG PATHS \"{}\" NO_DEFAULT_PATH)\n  \
               if(pc_FOUND)\n    message(\"${{version}}\")\n  endif()\n\
             endforeach()\n",
            root.path().display()
        );
        fs::write(root.path().join("script.cmake"), script).unwrap();
        let found = printed(Command::new("cmake").arg("-P").arg(root.path().join("script.cmake")));
        assert_eq!(found.split_whitespace().collect::<Vec<_>>().join(" "), fitting, "{version}");
    }
}
