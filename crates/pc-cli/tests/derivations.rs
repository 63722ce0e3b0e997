//! How often a command derives the equations of its model; in a process of its own, which counts them.

#![expect(clippy::unwrap_used, reason = "tests")]

use std::path::Path;

use clap::Parser;
use pc_cli::args::command_line::Arguments;
use pc_cli::commands;
use pc_model::derivations;

/// The number of derivations of a command, whose output goes to a file in `directory`.
fn derivations_of(directory: &Path, arguments: &str) -> usize {
    let output = directory.join("out");
    let arguments = arguments.replace("OUT", output.to_str().unwrap());
    let before = derivations();
    let parsed = Arguments::try_parse_from(["pc"].into_iter().chain(arguments.split(' '))).unwrap();
    commands::command(parsed.command.as_ref().unwrap())
        .unwrap_or_else(|error| panic!("{arguments}: {error}"));
    derivations() - before
}

/// Once, and once more with the reactions observed where there are constraints: the second derivation compares these,
/// which are not among the outputs of what is printed; and once in the velocities of a steady motion where these are not
/// those of the equations.
#[test]
fn commands_derive_equations_once() {
    let directory = tempfile::tempdir().unwrap();
    let known = [
        ("check heavy-top-euler", 1),
        ("check vertical-disk", 3),
        ("check tilted-disk", 2),
        ("run heavy-top-euler -o OUT.csv", 1),
        ("run heavy-top-euler --sensitivities I1,mg --plot OUT.svg -o OUT.csv", 1),
        ("run heavy-top-euler --form canonical --sensitivities I1,mg --plot OUT.svg -o OUT.csv", 1),
        ("run vertical-disk --sensitivities R,m --plot OUT.svg -o OUT.csv", 1),
        ("run tilted-disk --sensitivities r,m --plot OUT.svg -o OUT.csv", 1),
        ("report heavy-top-euler -o OUT.html", 1),
        ("report vertical-disk -o OUT.html", 2),
        ("animate double-pendulum-cartesian -o OUT.html", 1),
        ("derive vertical-disk --form lagrange", 1),
        ("theory vertical-disk", 1),
        ("emit vertical-disk --lang c -o OUT", 1),
    ];
    let found: Vec<(&str, usize)> =
        known.iter().map(|&(line, _)| (line, derivations_of(directory.path(), line))).collect();
    assert_eq!(found, known);
}
