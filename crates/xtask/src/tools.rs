//! Finding the native tools that the build of SUNDIALS and of its bindings needs.

use std::collections::BTreeMap;
use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A tool outside of Rust without which `pc-solve`, or an example, does not build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tool {
    /// `cc`, `gcc` or `clang`.
    CCompiler,
    /// `cmake`.
    Cmake,
    /// `make`, which cmake calls and on Debian does not bring along.
    Make,
    /// The shared library `libclang` with clang's own headers, for bindgen.
    Libclang,
    /// `g++` or `clang++`, for the examples in C++; not for the build.
    CppCompiler,
    /// Python from 3.10 on with `venv`, for the Python package; not for the build.
    Python,
}

impl Tool {
    /// Those of the build, in the order in which it needs them.
    pub(crate) const OF_BUILD: [Tool; 4] = [Tool::CCompiler, Tool::Cmake, Tool::Make, Tool::Libclang];

    /// The name used in messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Tool::CCompiler => "a C compiler",
            Tool::Cmake => "cmake",
            Tool::Make => "make",
            Tool::Libclang => "libclang with its headers",
            Tool::CppCompiler => "a C++ compiler",
            Tool::Python => "Python from 3.10 on with venv",
        }
    }
}

/// Where to look: a root directory and the variables of the environment.
#[derive(Debug)]
pub(crate) struct Machine {
    root: PathBuf,
    variables: BTreeMap<OsString, OsString>,
    /// What `llvm-config --prefix` says.
    llvm_prefix: Option<PathBuf>,
}

/// Directories that hold libclang, below the root; `*` stands within one component.
const LIBCLANG_DIRECTORIES: [&str; 13] = [
    "usr/lib/llvm-*/lib",
    "usr/lib/llvm/*/lib*",
    "usr/lib/*-linux-gnu*",
    "usr/lib64/llvm*/lib*",
    "usr/lib64",
    "usr/lib",
    "usr/local/llvm*/lib*",
    "usr/local/lib64",
    "usr/local/lib",
    "opt/homebrew/opt/llvm*/lib",
    "usr/local/opt/llvm*/lib",
    "Library/Developer/CommandLineTools/usr/lib",
    "Applications/Xcode.app/Contents/Developer/Toolchains/XcodeDefault.xctoolchain/usr/lib",
];

impl Machine {
    /// The machine that we run on.
    pub(crate) fn this() -> Machine {
        let llvm_config = env::var_os("LLVM_CONFIG_PATH").unwrap_or_else(|| "llvm-config".into());
        let prefix = Command::new(llvm_config).arg("--prefix").output().ok().filter(|o| o.status.success());
        let llvm_prefix = prefix.map(|o| PathBuf::from(String::from_utf8_lossy(&o.stdout).trim()));
        Machine { root: "/".into(), variables: env::vars_os().collect(), llvm_prefix }
    }

    /// One with programs in a single directory.
    #[cfg(test)]
    pub(crate) fn with_path(directory: &Path) -> Machine {
        let variables = BTreeMap::from([("PATH".into(), directory.into())]);
        Machine { root: directory.to_owned(), variables, llvm_prefix: None }
    }

    /// Those of some tools that are not found.
    pub(crate) fn missing(&self, tools: &[Tool]) -> Vec<Tool> {
        tools.iter().copied().filter(|&tool| !self.has(tool)).collect()
    }

    /// Whether a program of this name is on the `PATH`.
    pub(crate) fn has_program(&self, name: &str) -> bool {
        self.variable("PATH").is_some_and(|path| env::split_paths(path).any(|d| d.join(name).is_file()))
    }

    /// Whether a variable of the environment is set.
    pub(crate) fn has_variable(&self, name: &str) -> bool {
        self.variable(name).is_some()
    }

    /// `LIBCLANG_PATH`, if it is set and leads to no libclang.
    pub(crate) fn wrong_libclang_path(&self) -> Option<PathBuf> {
        let path = PathBuf::from(self.variable("LIBCLANG_PATH")?);
        (!leads_to_libclang(&path)).then_some(path)
    }

    fn has(&self, tool: Tool) -> bool {
        match tool {
            Tool::CCompiler => {
                self.variable("CC").is_some() || ["cc", "gcc", "clang"].iter().any(|c| self.has_program(c))
            }
            Tool::Cmake => self.variable("CMAKE").is_some() || self.has_program("cmake"),
            Tool::Make => self.variable("CMAKE_GENERATOR").is_some() || self.has_program("make"),
            Tool::Libclang => self.has_libclang(),
            // It is tried where it is used.
            Tool::Python => false,
            // One of C without its sister is no use to examples that are built by both.
            Tool::CppCompiler => {
                [["gcc", "g++"], ["clang", "clang++"]].iter().any(|c| c.iter().all(|c| self.has_program(c)))
            }
        }
    }

    /// The library alone, as other programs depend on it, does not do: without clang's own headers
    /// bindgen stops at `stddef.h`. Whoever sets `LIBCLANG_PATH` sees to the headers too.
    fn has_libclang(&self) -> bool {
        if let Some(path) = self.variable("LIBCLANG_PATH") {
            return leads_to_libclang(Path::new(path));
        }
        let directories = self.libclang_directories();
        directories.iter().any(|d| holds_libclang(d)) && directories.iter().any(|d| holds_headers(d))
    }

    fn libclang_directories(&self) -> Vec<PathBuf> {
        let mut directories = Vec::new();
        if let Some(prefix) = &self.llvm_prefix {
            directories.extend([prefix.join("lib"), prefix.join("lib64")]);
        }
        for variable in ["LD_LIBRARY_PATH", "LIBRARY_PATH"] {
            directories.extend(self.variable(variable).into_iter().flat_map(env::split_paths));
        }
        directories.extend(LIBCLANG_DIRECTORIES.iter().flat_map(|pattern| expand(&self.root, pattern)));
        directories
    }

    fn variable(&self, name: &str) -> Option<&OsString> {
        self.variables.get(std::ffi::OsStr::new(name)).filter(|value| !value.is_empty())
    }
}

/// `LIBCLANG_PATH` may name the library or its directory.
fn leads_to_libclang(path: &Path) -> bool {
    holds_libclang(path)
        || (path.is_file() && path.file_name().is_some_and(|n| is_libclang(&n.to_string_lossy())))
}

fn holds_libclang(directory: &Path) -> bool {
    names_in(directory).iter().any(|name| is_libclang(name))
}

/// `lib/clang/<version>/include` beside the library.
fn holds_headers(directory: &Path) -> bool {
    expand(directory, "clang/*/include").iter().any(|include| include.join("stddef.h").is_file())
}

/// `libclang.so`, `libclang.so.1`, `libclang-14.so.13`, `libclang.dylib`; not `libclang-cpp.so` or `libclangAST.a`.
fn is_libclang(name: &str) -> bool {
    let Some(rest) = name.strip_prefix("libclang") else { return false };
    let version_length = rest.find(|c: char| !(c == '-' || c == '.' || c.is_ascii_digit())).unwrap_or(0);
    // The dot of `.so` was taken for part of the version.
    let extension = &rest[version_length..];
    rest[..version_length].ends_with('.')
        && (extension == "so" || extension.starts_with("so.") || extension == "dylib")
}

/// The directories that match the pattern below `root`.
fn expand(root: &Path, pattern: &str) -> Vec<PathBuf> {
    let mut found = vec![root.to_path_buf()];
    for component in pattern.split('/') {
        found = if component.contains('*') {
            let matching = |directory: &PathBuf| {
                let mut names = names_in(directory);
                names.retain(|name| matches(name, component));
                names.into_iter().map(|name| directory.join(name)).collect::<Vec<_>>()
            };
            found.iter().flat_map(matching).collect()
        } else {
            found.into_iter().map(|directory| directory.join(component)).collect()
        };
    }
    found.retain(|path| path.is_dir());
    found
}

fn names_in(directory: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(directory) else { return Vec::new() };
    entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
}

/// Whether `name` fits `pattern`, in which `*` stands for any characters.
fn matches(name: &str, pattern: &str) -> bool {
    match pattern.split_once('*') {
        None => name == pattern,
        Some((head, tail)) => name.strip_prefix(head).is_some_and(|rest| {
            rest.char_indices().map(|(i, _)| i).chain([rest.len()]).any(|i| matches(&rest[i..], tail))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::TempDir;

    /// A root directory with the given files, and `usr/bin` as the path.
    fn machine(files: &[&str]) -> (TempDir, Machine) {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path().to_path_buf();
        for file in files {
            let path = root.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "").unwrap();
        }
        let variables = BTreeMap::from([("PATH".into(), root.join("usr/bin").into())]);
        (directory, Machine { root, variables, llvm_prefix: None })
    }

    #[test]
    fn everything_is_missing_from_an_empty_machine() {
        assert_eq!(machine(&[]).1.missing(&Tool::OF_BUILD), Tool::OF_BUILD);
    }

    #[test]
    fn debian_and_fedora_layouts() {
        let programs = ["usr/bin/gcc", "usr/bin/cmake", "usr/bin/make"];
        for library in [
            ["usr/lib/llvm-14/lib/libclang.so.1", "usr/lib/llvm-14/lib/clang/14.0.6/include/stddef.h"],
            [
                "usr/lib/x86_64-linux-gnu/libclang-14.so.13",
                "usr/lib/llvm-14/lib/clang/14.0.6/include/stddef.h",
            ],
            ["usr/lib/aarch64-linux-gnu/libclang-19.so.1", "usr/lib/llvm-19/lib/clang/19/include/stddef.h"],
            ["usr/lib64/libclang.so.20.1", "usr/lib/clang/20/include/stddef.h"],
            [
                "Library/Developer/CommandLineTools/usr/lib/libclang.dylib",
                "Library/Developer/CommandLineTools/usr/lib/clang/17/include/stddef.h",
            ],
        ] {
            let files: Vec<&str> = programs.iter().chain(&library).copied().collect();
            assert_eq!(machine(&files).1.missing(&Tool::OF_BUILD), [], "{library:?}");
        }
    }

    #[test]
    fn a_compiler_of_c_alone_builds_no_example_in_cpp() {
        let lacks = |files: &[&str]| !machine(files).1.missing(&[Tool::CppCompiler]).is_empty();
        assert!(lacks(&["usr/bin/gcc", "usr/bin/cc"]));
        assert!(lacks(&["usr/bin/gcc", "usr/bin/clang++"]));
        assert!(!lacks(&["usr/bin/gcc", "usr/bin/g++"]));
        assert!(!lacks(&["usr/bin/clang", "usr/bin/clang++"]));
    }

    #[test]
    fn libclang_without_headers_is_not_enough() {
        let (_directory, machine) = machine(&["usr/lib/x86_64-linux-gnu/libclang-14.so.1"]);
        assert!(machine.missing(&Tool::OF_BUILD).contains(&Tool::Libclang));
    }

    #[test]
    fn llvm_config_finds_libclang() {
        let (directory, mut machine) =
            machine(&["srv/llvm/lib/libclang.so", "srv/llvm/lib/clang/21/include/stddef.h"]);
        assert!(!machine.has(Tool::Libclang));
        machine.llvm_prefix = Some(directory.path().join("srv/llvm"));
        assert!(machine.has(Tool::Libclang));
    }

    #[test]
    fn libclang_path_is_used_even_where_it_is_wrong() {
        let (directory, mut machine) = machine(&[
            "usr/lib/llvm-14/lib/libclang.so.1",
            "usr/lib/llvm-14/lib/clang/14/include/stddef.h",
            "srv/libclang.so",
        ]);
        let root = directory.path();
        for (path, right) in [("srv", true), ("srv/libclang.so", true), ("usr", false), ("nowhere", false)] {
            machine.variables.insert("LIBCLANG_PATH".into(), root.join(path).into());
            assert_eq!(machine.has(Tool::Libclang), right, "{path}");
            assert_eq!(machine.wrong_libclang_path(), (!right).then(|| root.join(path)), "{path}");
        }
    }

    #[test]
    fn a_generator_named_by_the_user_needs_no_make() {
        let (_directory, mut machine) = machine(&[]);
        machine.variables.insert("CMAKE_GENERATOR".into(), "Ninja".into());
        assert!(machine.has(Tool::Make));
    }

    #[test]
    fn names_of_libclang() {
        for name in
            ["libclang.so", "libclang.so.1", "libclang-14.so", "libclang-14.0.6.so.13", "libclang.dylib"]
        {
            assert!(is_libclang(name), "{name}");
        }
        for name in
            ["libclang-cpp.so.14", "libclangAST.a", "libclang.a", "libclang", "clang.so", "libclang-14.so1"]
        {
            assert!(!is_libclang(name), "{name}");
        }
    }

    #[test]
    fn stars_match_any_characters() {
        for (name, pattern, fits) in [
            ("llvm-14", "llvm-*", true),
            ("llvm-", "llvm-*", true),
            ("x86_64-linux-gnu", "*-linux-gnu*", true),
            ("arm-linux-gnueabihf", "*-linux-gnu*", true),
            ("x86_64-linux-musl", "*-linux-gnu*", false),
            ("lib", "lib", true),
            ("lib64", "lib", false),
        ] {
            assert_eq!(matches(name, pattern), fits, "{name} {pattern}");
        }
    }
}
