//! The C library gives the numbers of `pc run`.
//!
//! Both derive the same equations, compile them in the same way, and integrate them by the same
//! method: the same operations in the same order. So states, observables, times of events
//! and counts of the work must be equal to the last bit.

use std::fs;
use std::process::Command;

use crate::followed::{Asked, Motion, builtin_models, by_library, by_program};

/// The place of column `j` of the library among those of the program, which has quasi-velocities for momenta.
fn place(program: &[String], library: &[String], j: usize) -> Option<usize> {
    let name = &library[j];
    let Some(eta) = name.strip_prefix("p_") else { return program.iter().position(|column| column == name) };
    // The velocity of the coordinate X is called X', and its momentum p_X.
    let coordinates = library.iter().position(|column| column.starts_with("p_"))?;
    (coordinates..program.len()).find(|&k| program[k].trim_end_matches('\'') == eta)
}

/// Follows a motion in both ways and compares all common columns. The program has additional
/// columns for velocities that follow from those of the state; where multipliers hold constraints
/// on positions, the library has additional ones for velocities of the state that the text does not
/// declare.
fn compare(model: &str, asked: &Asked<'_>, further: &[&str]) -> Motion {
    let (program, settings) = by_program(model, asked, further);
    let (library, observables) = by_library(model, asked, &settings);
    let observed = &library.columns[library.columns.len() - observables..];
    assert!(program.columns.ends_with(observed), "{model}: {:?} {observed:?}", program.columns);
    let places: Vec<(usize, usize)> = (0..library.columns.len())
        .filter_map(|j| Some((j, place(&program.columns, &library.columns, j)?)))
        .collect();
    let fewer = library.columns.len().min(program.columns.len());
    assert_eq!(places.len(), fewer, "{model}: {:?}, {:?}", library.columns, program.columns);
    assert_eq!(library.rows.len(), program.rows.len(), "{model}");
    for (found, expected) in library.rows.iter().zip(&program.rows) {
        for &(j, k) in &places {
            let (name, t, found, expected) = (&library.columns[j], expected[0], found[j], expected[k]);
            assert!(found == expected, "{model}: {name} at t = {t} is {found}, not {expected}");
        }
    }
    assert_eq!(library.events, program.events, "{model}");
    assert_eq!(library.ending, program.ending, "{model}");
    assert_eq!(library.reached, program.reached, "{model}");
    assert_eq!(library.work, program.work, "{model}");
    program
}

/// Models of bodies on joints: their equations consist of shared steps, whose choice depends on
/// earlier derivations, so the last digits of the two ways differ.
fn is_a_tree(model: &str) -> bool {
    pc_model::TREES.iter().any(|tree| tree.name == model)
}

fn every_model(canonical: bool) {
    let models = builtin_models();
    for model in models.iter().filter(|model| !is_a_tree(model)) {
        let motion = compare(model, &Asked { canonical, ..Asked::default() }, &[]);
        assert_eq!(motion.ending, "completed", "{model}");
        // Of the seventh order, a step goes far.
        assert!(motion.work[0] > 5, "{model}: {:?}", motion.work);
    }
}

#[test]
fn trees_of_bodies_move_alike() {
    for tree in pc_model::TREES {
        let asked = Asked::default();
        let (program, settings) = by_program(tree.name, &asked, &[]);
        let (library, _) = by_library(tree.name, &asked, &settings);
        assert_eq!(library.rows.len(), program.rows.len(), "{}", tree.name);
        let places: Vec<(usize, usize)> = (0..library.columns.len())
            .filter_map(|j| Some((j, place(&program.columns, &library.columns, j)?)))
            .collect();
        assert_eq!(places.len(), library.columns.len(), "{}", tree.name);
        for (found, expected) in library.rows.iter().zip(&program.rows) {
            // Reaction forces are large, and as accurate as the largest number of a row.
            let size = expected.iter().fold(1.0f64, |size, x| size.max(x.abs()));
            for &(j, k) in &places {
                let name = &library.columns[j];
                let difference = (found[j] - expected[k]).abs();
                // The tolerance of the steps is 1e-9, and the motions last some seconds.
                assert!(difference < 1e-6 * size, "{}: {name} differs by {difference}", tree.name);
            }
        }
    }
}

#[test]
fn every_model_in_quasi_velocities() {
    every_model(false);
}

#[test]
fn every_model_in_momenta() {
    every_model(true);
}

#[test]
fn the_models_are_those_of_the_program() {
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).arg("models").output().unwrap();
    let listed = String::from_utf8(output.stdout).unwrap();
    let listed: Vec<&str> = listed.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert_eq!(builtin_models(), listed);
}

/// Parameters, also in the start; kept integrals; method and tolerances; backwards in time.
#[test]
fn settings_mean_the_same() {
    for canonical in [false, true] {
        let asked = Asked { canonical, ..Asked::default() };
        let parameters = Asked { set: &[("mg", 2.0), ("I3", 0.7)], ..asked };
        compare("heavy-top-lagrange", &parameters, &["--method", "bdf", "--t-end", "-3"]);
        let kept = Asked { keep: &["energy"], ..asked };
        compare("double-pendulum-cartesian", &kept, &["--rtol", "1e-6", "--atol", "1e-8"]);
        compare("heavy-top-lagrange", &asked, &["--method", "adams"]);
        let start = Asked { set: &[("h", 2.5), ("e", 0.7)], ..asked };
        let motion = compare("bouncing-ball", &start, &["--rtol", "1e-12"]);
        assert_eq!(motion.events.len(), 4);
    }
}

/// A start off the constraint, at a time other than zero, and an end by an event.
const ROD: &str = r#"
[coordinates]
x = 0.61
y = 0.0
z = -0.8
[quasi_velocities]
"y'" = 1.5
[constraints]
rod = "(x^2 + y^2 + z^2 - 1)/2"
[lagrangian]
kinetic = "(x'^2 + y'^2 + z'^2)/2"
potential = "10*z"
[events.across]
when = "x"
[events.back]
when = "y"
direction = "falling"
terminal = true
[simulation]
t_start = 1.0
t_end = 9.0
"#;

#[test]
fn a_start_is_moved_and_an_event_ends() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("rod.toml");
    fs::write(&path, ROD).unwrap();
    let asked = Asked { project_start: true, ..Asked::default() };
    let motion = compare(path.to_str().unwrap(), &asked, &[]);
    assert_eq!(motion.ending, "event");
    let names: Vec<&str> = motion.events.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["across", "back"]);
    assert_eq!(motion.rows.last().unwrap()[0], motion.events[1].1);
}
