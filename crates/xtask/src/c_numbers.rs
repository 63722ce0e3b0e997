//! The numbers of the examples in C and C++ against those of the program `pc`.
//!
//! An example that follows the motion of a model prints what one types for the same, and what it has come to itself:
//!
//! ```text
//! pc run top.toml --rtol 1e-12 --atol 1e-14
//! t = 10: -0.59833759939880715 -0.14864396223301765 0.78733543654419214 …
//! ```
//!
//! That is typed here, among the examples, and the row of that time has to begin with these numbers.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::command::{announce_and_run, announce_and_tee, line_of, workspace_root};
use crate::error::Error;

/// Library and program derive the same equations, compile them in the same way and integrate them with the same calls, so that
/// the numbers are equal to the last bit. These are other numbers, off by so much at most, as part of 1 or of the number itself.
const OTHER_NUMBERS: [(&str, f64); 7] = [
    // Their own method, of order 4: h⁴ = 6e-14 for h = 5e-4, times derivatives of order 100.
    ("rk4", 1e-11),
    ("emitted", 1e-11),
    ("fortran_top", 1e-11),
    // GSL's method, some hundred steps with local errors of 1e-12.
    ("gsl", 1e-10),
    // A force that is a function is not merged with the equations as one in the text is: other roundings.
    ("controller", 1e-12),
    // Members side by side, with fused multiply-adds: other roundings, and with them steps that differ within the tolerance.
    ("ensemble", 1e-9),
    // An event whose function is one of the program is located by its values, one in the text along the polynomial of the step.
    ("bouncing_ball", 1e-13),
];

/// What an example says it has in common with a run of the program.
#[derive(Debug, PartialEq)]
struct Claim {
    example: String,
    /// What is typed after `pc`.
    arguments: Vec<String>,
    t: f64,
    numbers: Vec<f64>,
}

/// Runs the examples by `make check`, and `pc`, a path, for all that they claim.
///
/// # Errors
/// [`Error::Numbers`] where an example is wrong, or says nothing although its source has such a line.
pub(crate) fn check(make: &mut Command, pc: &Path) -> Result<(), Error> {
    let mut output = Vec::new();
    announce_and_tee(make, |piece| output.extend_from_slice(piece))?;
    let (examples, claims) = read(&String::from_utf8_lossy(&output))?;
    for example in examples {
        let mut of_example = claims.iter().filter(|claim| claim.example == example).peekable();
        if of_example.peek().is_none() && claims_something(&example)? {
            return Err(wrong(&example, "it does not say what `pc run` it is like".to_owned()));
        }
        for claim in of_example {
            compare(claim, pc)?;
        }
    }
    Ok(())
}

/// The source that the example `emit` has written to a directory, against that of `pc emit`.
///
/// # Errors
/// [`Error::Numbers`] where a byte differs.
pub(crate) fn check_source(directory: &Path, pc: &Path) -> Result<(), Error> {
    let model = workspace_root().join("crates/pc-model/models/heavy-top-lagrange.toml");
    let place = directory.join("by-pc");
    let failed = |source| Error::File { path: place.display().to_string(), source };
    fs::create_dir_all(&place).map_err(failed)?;
    fs::copy(model, place.join("top.toml")).map_err(failed)?; // the name of the file is that of the source
    announce_and_run(
        Command::new(pc).current_dir(&place).args(["emit", "top.toml", "--lang", "c", "-o", "."]),
    )?;
    for name in ["top.h", "top.c"] {
        if fs::read(directory.join(name)).map_err(failed)? != fs::read(place.join(name)).map_err(failed)? {
            return Err(wrong("emit", format!("{name} is not what `pc emit` writes")));
        }
    }
    Ok(())
}

/// The examples in the output of `make check`, and what they claim.
fn read(output: &str) -> Result<(Vec<String>, Vec<Claim>), Error> {
    let (mut examples, mut claims) = (Vec::<String>::new(), Vec::new());
    let mut typed: Option<&str> = None;
    for line in output.lines().chain(["--- "]) {
        let example = examples.last().map_or("", String::as_str);
        match (typed.take(), line.strip_prefix("pc run ")) {
            (None, Some(rest)) => typed = Some(rest),
            (None, None) => {}
            (Some(arguments), _) => {
                let claim = claim(example, arguments, line);
                claims
                    .push(claim.ok_or_else(|| wrong(example, format!("`pc run {arguments}` and `{line}`")))?);
            }
        }
        examples.extend(line.strip_prefix("--- ").map(str::to_owned));
    }
    examples.pop();
    Ok((examples, claims))
}

/// The claim of these two lines.
fn claim(example: &str, arguments: &str, line: &str) -> Option<Claim> {
    let (t, numbers) = line.strip_prefix("t = ")?.split_once(':')?;
    let numbers: Option<Vec<f64>> = numbers.split_whitespace().map(|number| number.parse().ok()).collect();
    Some(Claim {
        example: example.to_owned(),
        arguments: ["run"].into_iter().chain(arguments.split_whitespace()).map(str::to_owned).collect(),
        t: t.parse().ok()?,
        numbers: numbers.filter(|numbers| !numbers.is_empty())?,
    })
}

/// Whether the source of an example has a line for the program.
fn claims_something(example: &str) -> Result<bool, Error> {
    let examples = workspace_root().join("examples-c");
    let mut paths =
        ["c", "cpp", "f90"].into_iter().map(|ending| examples.join(example).with_extension(ending));
    let Some(path) = paths.find(|path| path.exists()) else { return Ok(false) };
    let text = fs::read_to_string(&path);
    Ok(text.map_err(|source| Error::File { path: path.display().to_string(), source })?.contains("pc run "))
}

/// Runs the program and looks for the row.
fn compare(claim: &Claim, pc: &Path) -> Result<(), Error> {
    let Claim { example, arguments, t, numbers } = claim;
    let mut command = Command::new(pc);
    command.current_dir(workspace_root().join("examples-c")).args(arguments);
    let line = line_of(&command);
    let output = command.output().map_err(|source| Error::Start { program: "pc".to_owned(), source })?;
    if !output.status.success() {
        eprint!("{}", String::from_utf8_lossy(&output.stderr));
        return Err(Error::Failed { command: line, status: output.status });
    }
    let table = String::from_utf8_lossy(&output.stdout);
    let within = OTHER_NUMBERS.iter().find(|(name, _)| name == example).map_or(0.0, |&(_, within)| within);
    let Some(row) = row_at(&table, *t, within) else {
        return Err(wrong(example, format!("there is no row at t = {t} of `{line}`")));
    };
    match difference(numbers, &row) {
        Some(off) if off <= within => {
            let off =
                if off == 0.0 { "equal to the last bit".to_owned() } else { format!("off by {off:.1e}") };
            println!("{example}: {} numbers at t = {t} as by `{line}`, {off}", numbers.len());
            Ok(())
        }
        off => {
            let off =
                off.map_or_else(|| "cannot be compared".to_owned(), |off| format!("are off by {off:e}"));
            Err(wrong(example, format!("{numbers:?} {off}; `{line}` has {row:?}")))
        }
    }
}

/// The numbers after t in the row at that time.
fn row_at(table: &str, t: f64, within: f64) -> Option<Vec<f64>> {
    let numbers = |line: &str| line.split(',').map(|number| number.parse().unwrap_or(f64::NAN)).collect();
    let mut rows = table.lines().skip(1).map(numbers);
    rows.find(|row: &Vec<f64>| row.first().is_some_and(|time| (time - t).abs() <= within))
        .map(|mut row| row.split_off(1))
}

/// The largest difference, as part of 1 or of the number in the row; none where there are too few, or some are no numbers.
fn difference(numbers: &[f64], row: &[f64]) -> Option<f64> {
    let parts = numbers.iter().zip(row).map(|(a, b)| (a - b).abs() / b.abs().max(1.0));
    let comparable = numbers.len() <= row.len() && parts.clone().all(f64::is_finite);
    comparable.then(|| parts.fold(0.0, f64::max))
}

fn wrong(example: &str, wrong: String) -> Error {
    Error::Numbers { example: example.to_owned(), wrong }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn claims_are_two_lines_of_an_example() {
        let output = "make: …\n--- top\nsome text\npc run top.toml --rtol 1e-12\nt = 10: -0.5 3\n--- other\nt = 1: 2\n";
        let (examples, claims) = read(output).unwrap();
        assert_eq!(examples, ["top", "other"]);
        let arguments = ["run", "top.toml", "--rtol", "1e-12"].map(str::to_owned).to_vec();
        assert_eq!(
            claims,
            [Claim { example: "top".to_owned(), arguments, t: 10.0, numbers: vec![-0.5, 3.0] }]
        );
    }

    #[test]
    fn half_a_claim_is_wrong() {
        for end in
            ["", "\n", "\nt = 10:\n", "\nt = 10: 1 x\n", "\nheight 3\n", "\npc run top.toml\nt = 1: 1\n"]
        {
            let output = format!("--- top\npc run top.toml{end}");
            let error = read(&output).unwrap_err().to_string();
            assert!(error.starts_with("the example top: `pc run top.toml` and "), "{end:?}: {error}");
        }
    }

    #[test]
    fn numbers_are_compared_with_the_row_of_that_time() {
        let table = "t,x,x',energy\n0e0,1e0,0e0,5e-1\n1e-1,9.9e-1,-4e0,5e-1\n";
        let row = row_at(table, 0.1, 0.0).unwrap();
        assert_eq!(row, [0.99, -4.0, 0.5]);
        assert_eq!(row_at(table, 0.2, 0.0), None);
        assert_eq!(difference(&[0.99, -4.0], &row), Some(0.0));
        assert_eq!(difference(&[0.99 + 1e-16, -4.0], &row), Some((0.99_f64 + 1e-16) - 0.99));
        assert_eq!(difference(&[0.99, -5.0], &row), Some(0.25));
        assert_eq!(difference(&[0.99, -4.0, 0.5, 1.0], &row), None);
        assert_eq!(difference(&[f64::NAN], &row), None);
    }

    /// What follows no motion: `emit` writes source, and `cvode_functions` calls functions one by one; and one that stops
    /// where a ball bounces, which no rows do. The motion of `computed_torque` is that of its own controller.
    const WITHOUT: [&str; 4] = ["emit", "cvode_functions", "cvode_events", "computed_torque"];

    #[test]
    fn every_example_in_c_that_follows_a_motion_claims_something() {
        for entry in fs::read_dir(workspace_root().join("examples-c")).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|ending| ending == "c") {
                let name = path.file_stem().unwrap().to_str().unwrap();
                assert_eq!(claims_something(name).unwrap(), !WITHOUT.contains(&name), "{name}");
            }
        }
    }
}
