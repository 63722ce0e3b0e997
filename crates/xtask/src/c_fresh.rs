//! A program outside the repository with the installed library, as a newcomer builds it.

use std::path::Path;
use std::process::Command;
use std::{env, fs, process};

use crate::command::announce_and_run;
use crate::error::Error;
use crate::tools::Machine;

const DEMO: &str = r#"#include <stdio.h>
#include <pc.h>

int main(void)
{
    pc_model *model = NULL;
    pc_system *top = NULL;
    pc_solver *solver = NULL;
    pc_error *error = NULL;
    double y[6] = {0.0};
    if (pc_model_builtin("heavy-top-lagrange", &model, &error) == PC_OK &&
        pc_system_new(model, NULL, &top, &error) == PC_OK &&
        pc_solver_new(top, NULL, 0.0, NULL, 0, &solver, &error) == PC_OK &&
        pc_solver_advance(solver, 10.0, y, 6, &error) == PC_OK) {
        printf("pc %s: %s = %.6f at t = 10\n", pc_version(), pc_system_name(top, 2), y[2]);
    }
    if (error) {
        fprintf(stderr, "%s\n", pc_error_message(error));
    }
    pc_error_free(error);
    pc_solver_free(solver);
    pc_system_free(top);
    pc_model_free(model);
    return y[2] > 0.78733 && y[2] < 0.78734 ? 0 : 1; /* 0.787335... */
}
"#;

const LISTS: &str = "\
cmake_minimum_required(VERSION 3.16)
project(demo C)
find_package(pc REQUIRED)
add_executable(demo demo.c)
target_link_libraries(demo pc::pc)
add_executable(demo_static demo.c)
target_link_libraries(demo_static pc::static)
";

/// Builds and runs it in a new directory, by pkg-config and by CMake, with both libraries.
///
/// # Errors
/// [`Error::Failed`], or [`Error::File`] where there can be no such directory.
pub(crate) fn run(prefix: &Path) -> Result<(), Error> {
    let place = env::temp_dir().join(format!("pc-fresh-{}", process::id()));
    let wrong = |source| Error::File { path: place.display().to_string(), source };
    fs::create_dir(&place).map_err(wrong)?;
    fs::write(place.join("demo.c"), DEMO).map_err(wrong)?;
    fs::write(place.join("CMakeLists.txt"), LISTS).map_err(wrong)?;
    let outcome = build_and_run(prefix, &place);
    fs::remove_dir_all(&place).map_err(wrong)?;
    outcome
}

fn build_and_run(prefix: &Path, place: &Path) -> Result<(), Error> {
    let shell = |line: &str| {
        let mut command = Command::new("sh");
        command.current_dir(place).env("PKG_CONFIG_PATH", prefix.join("lib/pkgconfig")).args(["-c", line]);
        command
    };
    if Machine::this().has_program("pkg-config") {
        announce_and_run(&mut shell("cc demo.c $(pkg-config --cflags --libs libpc)"))?;
        announce_and_run(shell("./a.out").env("LD_LIBRARY_PATH", prefix.join("lib")))?;
        announce_and_run(&mut shell("cc -static demo.c $(pkg-config --static --cflags --libs libpc)"))?;
        announce_and_run(&mut shell("./a.out"))?;
    } else {
        println!("skipped: pkg-config, which is not installed");
    }
    let prefix = prefix.display();
    announce_and_run(&mut shell(&format!("cmake -S . -B build -DCMAKE_PREFIX_PATH='{prefix}'")))?;
    announce_and_run(&mut shell("cmake --build build && build/demo && build/demo_static"))
}
