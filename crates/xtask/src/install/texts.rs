//! What finds an installed library: the files of pkg-config and of CMake. They know their own places, so that a prefix can be
//! moved as a whole.

use std::path::Path;

use super::{Places, STATIC_LIBS};

/// `libpc.pc`.
///
/// Blanks in the path of the file itself are escaped by pkg-config, those in what is written here are by us.
pub(super) fn pkg_config(places: &Places, version: &str) -> String {
    let prefix = match places.way(&places.libdir.join("pkgconfig"), &places.prefix) {
        Some(way) => format!("${{pcfiledir}}/{}", way.display()),
        None => escaped(&places.prefix),
    };
    let of = |directory: &Path| match places.inside(directory) {
        Some(rest) => format!("${{prefix}}/{}", escaped(rest)),
        None => escaped(directory),
    };
    format!(
        "prefix={prefix}\nincludedir={}\nlibdir={}\n\n\
         Name: pc\nDescription: Poincaré–Chetaev equations of mechanical systems\nVersion: {version}\n\
         Cflags: -I${{includedir}}\nLibs: -L${{libdir}} -lpc\nLibs.private: {STATIC_LIBS}\n",
        of(&places.includedir),
        of(&places.libdir)
    )
}

/// A path in which what separates words, and quotes, does not.
fn escaped(path: &Path) -> String {
    let mut text = String::new();
    for c in path.display().to_string().chars() {
        if c.is_whitespace() || matches!(c, '"' | '\'' | '\\') {
            text.push('\\');
        }
        text.push(c);
    }
    text
}

/// `pcConfig.cmake`.
///
/// Links on the way to it are followed, since `/lib` may be one to `/usr/lib`.
pub(super) fn cmake_config(places: &Places, abi: &str) -> String {
    let headers = match places.way(&places.libdir, &places.includedir) {
        Some(way) => {
            format!("get_filename_component(_pc_include \"${{_pc_lib}}/{}\" ABSOLUTE)", way.display())
        }
        None => format!("set(_pc_include [==[{}]==])", places.includedir.display()),
    };
    format!(
        "# Targets pc::pc, the shared library, and pc::static.\n\
         get_filename_component(_pc_lib \"${{CMAKE_CURRENT_LIST_DIR}}/../..\" REALPATH)\n\
         {headers}\n\
         if(NOT TARGET pc::pc)\n  \
           add_library(pc::pc SHARED IMPORTED)\n  \
           set_target_properties(pc::pc PROPERTIES\n    \
             IMPORTED_LOCATION \"${{_pc_lib}}/libpc.so.{abi}\"\n    \
             IMPORTED_SONAME \"libpc.so.{abi}\"\n    \
             INTERFACE_INCLUDE_DIRECTORIES \"${{_pc_include}}\")\n  \
           add_library(pc::static STATIC IMPORTED)\n  \
           set_target_properties(pc::static PROPERTIES\n    \
             IMPORTED_LOCATION \"${{_pc_lib}}/libpc.a\"\n    \
             INTERFACE_INCLUDE_DIRECTORIES \"${{_pc_include}}\"\n    \
             INTERFACE_LINK_LIBRARIES \"{STATIC_LIBS}\")\n\
         endif()\n\
         unset(_pc_lib)\nunset(_pc_include)\n"
    )
}

/// `pcConfigVersion.cmake`: what asks for a version takes later ones of the same major version; before 1.0, where anything may
/// change with the minor version, of the same minor version.
pub(super) fn cmake_version(version: &str) -> String {
    let mut numbers = version.split('.');
    let (major, minor) = (numbers.next().unwrap_or_default(), numbers.next().unwrap_or_default());
    let same_minor = match major {
        "0" => format!("\n   AND PACKAGE_FIND_VERSION_MINOR EQUAL {minor}"),
        _ => String::new(),
    };
    format!(
        "set(PACKAGE_VERSION \"{version}\")\n\
         set(PACKAGE_VERSION_COMPATIBLE FALSE)\n\
         if(PACKAGE_FIND_VERSION_MAJOR EQUAL {major}{same_minor}\n   \
            AND PACKAGE_VERSION VERSION_GREATER_EQUAL PACKAGE_FIND_VERSION)\n  \
           set(PACKAGE_VERSION_COMPATIBLE TRUE)\n\
         endif()\n\
         if(PACKAGE_VERSION VERSION_EQUAL PACKAGE_FIND_VERSION)\n  set(PACKAGE_VERSION_EXACT TRUE)\nendif()\n"
    )
}
