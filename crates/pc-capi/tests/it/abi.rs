//! Programs that were compiled with an earlier header run with this library.

use std::fs;
use std::mem::offset_of;
use std::path::Path;

use crate::interface::{interface, replaces};

fn file(path: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).unwrap()
}

#[test]
fn the_interface_is_that_of_the_header() {
    let (committed, fresh) =
        (file("abi/interface.txt"), interface(&file("../../include/pc.h"), pc::PC_ABI_VERSION));
    if let Err(lost) = replaces(&fresh, &committed) {
        panic!("{lost}");
    }
    let new: Vec<&str> =
        fresh.lines().filter(|line| !committed.lines().any(|known| known == *line)).collect();
    assert!(
        committed == fresh,
        "not in crates/pc-capi/abi/interface.txt, run `cargo xtask header`: {new:#?}"
    );
}

/// Structure and member, with the offset that the compiler has given it.
macro_rules! places {
    ($($structure:ident { $($member:ident),* $(,)? })*) => {
        vec![$($((stringify!($structure), stringify!($member), offset_of!(pc::$structure, $member))),*),*]
    };
}

#[cfg(target_pointer_width = "64")]
#[test]
fn members_have_the_offsets_of_the_interface() {
    let places = places! {
        pc_system_options { size, form, reserved, memory_limit, time_limit, cancel }
        pc_solver_options {
            size, method, iteration, linear_solver, max_order, relative_tolerance, absolute_tolerance, absolute_tolerances,
            absolute_tolerances_length, max_steps, initial_step, min_step, max_step, stop_time,
            samples_per_step, reserved, accumulation, inequalities, inequalities_length,
        }
        pc_statistics {
            steps, rhs_evaluations, jacobian_evaluations, error_test_failures, nonlinear_iterations, nonlinear_failures,
            linear_setups, linear_iterations, last_order, last_step, next_step, step_time, limited_steps,
            implicit_steps, changes, stiff_from,
        }
        pc_member { number, status, message, times, states, rows, dim }
    };
    let interface = file("abi/interface.txt");
    let mut members = 0;
    for line in interface.lines().filter_map(|line| line.strip_prefix("struct ")) {
        let (structure, rest) = line.split_once(": ").unwrap();
        let (place, member) = rest.split_once(' ').unwrap();
        let member = member.rsplit([' ', '*']).next().unwrap();
        let found = places.iter().find(|(s, m, _)| (*s, *m) == (structure, member));
        let Some((_, _, offset)) = found else {
            panic!("`{structure}.{member}` is to be added to this test")
        };
        assert_eq!(place.parse(), Ok(*offset), "{structure}.{member}");
        members += 1;
    }
    assert_eq!(members, places.len());
}

const HEADER: &str = "\
#include <stddef.h>
/* A comment; with a semicolon. */
typedef enum {
  /** Fine. */
  PC_GOOD = 0,
  PC_BAD = 1,
} pc_end;
typedef struct pc_thing pc_thing;
typedef struct {
  size_t size;
  int kind;
  const double *values;
} pc_choice;
typedef int (*pc_watch)(double t, void *user);
extern \"C\" {
pc_end pc_thing_use(const pc_thing *thing,
                    pc_watch watch);
void pc_thing_free(pc_thing *thing);
}  // extern
";

#[test]
fn a_header_is_read_in_lines() {
    let expected = "\
abi 7
enum pc_end: PC_GOOD = 0
enum pc_end: PC_BAD = 1
handle pc_thing
struct pc_choice: 0 size_t size
struct pc_choice: 8 int kind
struct pc_choice: 16 const double *values
callback int (*pc_watch)(double, void *)
pc_end pc_thing_use(const pc_thing *, pc_watch)
void pc_thing_free(pc_thing *)
";
    assert_eq!(interface(HEADER, 7), expected);
}

#[test]
fn additions_are_compatible_and_removals_and_changes_are_not() {
    let old = interface(HEADER, 7);
    let with = |from: &str, to: &str| {
        assert!(HEADER.contains(from));
        replaces(&interface(&HEADER.replace(from, to), 7), &old)
    };
    for (from, to) in [
        ("PC_BAD = 1,", "PC_BAD = 1, PC_UGLY = 2,"),
        ("*values;", "*values; int last;"),
        ("void pc", "int pc_thing_count(void); void pc"),
        ("pc_thing *thing)", "pc_thing *object)"),
        ("void pc_thing_free(pc_thing *", "void pc_thing_free(const pc_thing *"),
    ] {
        assert_eq!(with(from, to), Ok(()), "{to}");
    }
    for (from, to, lost) in [
        ("PC_BAD = 1", "PC_BAD = 2", "enum pc_end: PC_BAD = 1"),
        ("int kind;", "int first; int kind;", "struct pc_choice: 8 int kind"),
        ("int kind;", "unsigned kind;", "struct pc_choice: 8 int kind"),
        ("void *user", "int user", "callback int (*pc_watch)(double, void *)"),
        (
            "pc_thing_use(const pc_thing",
            "pc_thing_use(pc_thing",
            "pc_end pc_thing_use(const pc_thing *, pc_watch)",
        ),
        ("void *user", "const void *user", "callback int (*pc_watch)(double, void *)"),
        ("void pc_thing_free", "int pc_thing_free", "void pc_thing_free(pc_thing *)"),
        ("void pc_thing_free(pc_thing *thing);", "", "void pc_thing_free(pc_thing *)"),
    ] {
        let message = with(from, to).unwrap_err();
        assert!(message.contains(lost) && message.contains("raise PC_ABI_VERSION"), "{message}");
    }
    // Another version allows any change.
    assert_eq!(replaces(&interface("", 8), &old), Ok(()));
}
