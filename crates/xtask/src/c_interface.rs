//! What programs see of the C library: headers that compile, a layout that is the one said, symbols that are those declared.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{announce_and_run, line_of, workspace_root};
use crate::error::Error;
use crate::header::{self, functions_of_header};

/// What is taken for a std::span, which C++17 does not know.
const SPANS: &str = "#include <span>\n#include <pc.hpp>\n\
    template <class From, class To> constexpr bool taken = std::is_convertible_v<From, pc::view<To>>;\n\
    static_assert(taken<std::span<double>, double> && taken<std::span<double, 3>, const double>);\n\
    static_assert(taken<std::span<const double>, const double> && !taken<std::span<const double>, double>);\n\
    int main() {}\n";

const STRICT: [&str; 6] =
    ["-Wall", "-Wextra", "-pedantic-errors", "-Wconversion", "-Werror", "-fsyntax-only"];

/// What strict programs in C++ demand of headers besides.
const STRICT_CPP: [&str; 4] = ["-Weffc++", "-Wshadow", "-Wold-style-cast", "-Wnon-virtual-dtor"];

/// Compiles, in both languages, each header alone and twice, and the layout of `abi/interface.txt`.
///
/// # Errors
/// [`Error::Failed`] where a compiler refuses.
pub(crate) fn headers(
    (c, cpp): (&str, &str),
    include: &Path,
    sundials: &[Vec<PathBuf>],
    place: &Path,
) -> Result<(), Error> {
    let twice =
        |header: &str| format!("#include <{header}>\n#include <{header}>\nint main(void) {{ return 0; }}\n");
    let compile = |compiler: &str, standard: &str, file: PathBuf, further: &[PathBuf]| {
        let mut command = Command::new(compiler);
        command.args(STRICT).arg(format!("-std={standard}")).arg("-I").arg(include);
        if standard.starts_with("c++") {
            command.args(STRICT_CPP);
        }
        // Not ours to be strict with.
        command.args(further.iter().flat_map(|directory| [Path::new("-isystem"), directory]));
        announce_and_run(command.arg(file))
    };
    let written = |name: &str, text: &str| -> Result<PathBuf, Error> {
        let path = place.join(name);
        let wrong = |source| Error::File { path: path.display().to_string(), source };
        fs::create_dir_all(place).and_then(|()| fs::write(&path, text)).map_err(wrong)?;
        Ok(path)
    };
    let layout = layout(&interface()?);
    compile(c, "c99", written("pc.c", &twice("pc.h"))?, &[])?;
    compile(c, "c11", written("layout.c", &layout)?, &[])?;
    compile(cpp, "c++17", written("pc_h.cpp", &twice("pc.h"))?, &[])?;
    for name in header::headers(include)?.iter().filter(|name| name.ends_with(".hpp")) {
        compile(cpp, "c++17", written(&format!("{}.cpp", name.replace('/', "_")), &twice(name))?, &[])?;
    }
    compile(cpp, "c++20", written("spans.cpp", SPANS)?, &[])?;
    compile(cpp, "c++17", written("layout.cpp", &layout)?, &[])?;
    for directories in sundials {
        compile(c, "c99", written("cvode.c", &twice("pc/cvode.h"))?, directories)?;
        compile(cpp, "c++17", written("cvode.cpp", &twice("pc/cvode.h"))?, directories)?;
    }
    Ok(())
}

/// Where there are headers of SUNDIALS, beside the usual places: those of the one that the library was built with, and, if the
/// system has them too, nowhere else.
pub(crate) fn sundials(built: &Path) -> Vec<Vec<PathBuf>> {
    let there = |directory: &Path| directory.join("sunmatrix/sunmatrix_sparse.h").exists();
    let entries = fs::read_dir(built.join("build")).into_iter().flatten().flatten();
    let own = entries.map(|entry| entry.path().join("out/include")).filter(|path| there(path));
    let newest = own.max_by_key(|path| fs::metadata(path).and_then(|data| data.modified()).ok());
    let system = there(Path::new("/usr/include")).then(Vec::new);
    newest.map(|directory| vec![directory]).into_iter().chain(system).collect()
}

fn interface() -> Result<String, Error> {
    let path = workspace_root().join("crates/pc-capi/abi/interface.txt");
    fs::read_to_string(&path).map_err(|source| Error::File { path: path.display().to_string(), source })
}

/// A source that compiles where members and constants are what the interface says, which is for 64 bits.
fn layout(interface: &str) -> String {
    let includes = "#include <assert.h>\n#include <stddef.h>\n#include <stdint.h>\n#include <pc.h>\n";
    let mut source = format!("{includes}#if SIZE_MAX > 0xffffffff\n");
    let mut claim = |condition: String, line: &str| {
        source.push_str(&format!("static_assert({condition}, \"{line}\");\n"));
    };
    for line in interface.lines() {
        if let Some((_, constant)) = line.strip_prefix("enum ").and_then(|rest| rest.split_once(": ")) {
            claim(constant.replace('=', "=="), line);
        } else if let Some((structure, rest)) =
            line.strip_prefix("struct ").and_then(|rest| rest.split_once(": "))
            && let Some((place, member)) = rest.split_once(' ')
        {
            let member = member.rsplit([' ', '*']).next().unwrap_or(member);
            claim(format!("offsetof({structure}, {member}) == {place}"), line);
        }
    }
    source + "#endif\nint main(void) { return 0; }\n"
}

/// Compares what both libraries show with what the header declares.
///
/// # Errors
/// [`Error::Installed`] where they differ.
pub(crate) fn symbols(libraries: &Path) -> Result<(), Error> {
    let declared: BTreeSet<String> = functions_of_header()?.into_iter().collect();
    for (library, tables) in [("libpc.so", "-D"), ("libpc.a", "--extern-only")] {
        let mut nm = Command::new("nm");
        nm.args([tables, "--defined-only"]).arg(libraries.join(library));
        println!("{}", line_of(&nm));
        let listing = nm.output().map_err(|source| Error::Start { program: "nm".to_owned(), source })?;
        let shown = names(&String::from_utf8_lossy(&listing.stdout));
        if shown != declared {
            let differing: Vec<&String> = shown.symmetric_difference(&declared).collect();
            let wrong = format!("{library} and pc.h differ in {differing:?}");
            return Err(Error::Installed { wrong });
        }
        println!("{library} shows the {} functions of pc.h and nothing else", shown.len());
    }
    Ok(())
}

/// The names of a listing of nm.
fn names(listing: &str) -> BTreeSet<String> {
    listing.lines().filter_map(|line| line.split_whitespace().nth(2)).map(str::to_owned).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_layout_claims_constants_and_places() {
        let source = layout(
            "abi 0\nenum pc_end: PC_BAD = 1\nstruct pc_choice: 8 const double *values\nvoid pc_f(int)\n",
        );
        assert!(source.contains("static_assert(PC_BAD == 1, \"enum pc_end: PC_BAD = 1\");"), "{source}");
        assert!(source.contains("static_assert(offsetof(pc_choice, values) == 8, "), "{source}");
        assert!(!source.contains("pc_f"));
    }

    #[test]
    fn the_interface_has_all_functions_of_the_header() {
        let interface = interface().unwrap();
        for function in functions_of_header().unwrap() {
            let named = |line: &str| line.split('(').next().unwrap().ends_with(&function);
            assert!(interface.lines().any(named), "{function}");
        }
    }

    /// What is for C++ as it stands, what a call has told by itself, and what objects own by themselves.
    const LEFT_TO_C: [&str; 5] = [
        "pc_version",
        "pc_version_number",
        "pc_abi_version",
        "pc_error_status",
        "pc_solver_set_event_observer",
    ];

    #[test]
    fn every_function_is_wrapped_for_cpp() {
        let include = workspace_root().join("include");
        let wrappers = header::headers(&include).unwrap().into_iter().filter(|name| name.ends_with(".hpp"));
        let text: String = wrappers.map(|name| fs::read_to_string(include.join(name)).unwrap()).collect();
        let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
        let words: BTreeSet<&str> =
            code.flat_map(|line| line.split(|c: char| !(c.is_alphanumeric() || c == '_'))).collect();
        for function in functions_of_header().unwrap() {
            let left = LEFT_TO_C.contains(&function.as_str());
            assert!(words.contains(function.as_str()) != left, "{function}");
        }
    }

    #[test]
    fn names_are_the_third_column() {
        assert!(names("0000 T pc_a\n\nlib.o:\n0010 T pc_b\n").into_iter().eq(["pc_a", "pc_b"]));
    }
}
