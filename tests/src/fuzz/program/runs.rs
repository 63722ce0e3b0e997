//! `pc run` in every form and by every method, against the motion of this process.

use super::table::Table;
use super::tried::Tried;
use crate::fuzz::comparison::{exceeds, resolved, size};
use crate::fuzz::execution::{Motion, SAMPLES};
use crate::fuzz::random::Random;

/// The methods, with `auto` as often as it is met.
const METHODS: [&str; 7] = ["auto", "auto", "auto", "adams", "bdf", "dop853", "taylor"];

/// Relative to a number or to 1: a hundred steps with errors of 1e-9 each.
const TOLERANCE: f64 = 1e-7;

/// Multistep methods take hundreds of steps, with errors that add up from one to the next.
const OF_MULTISTEP: f64 = 1e-6;

/// How much more than what the default tolerances move here another method may be off: an order of magnitude for where its steps
/// end, and one for what its formulas make of an error.
const GROWTH: f64 = 100.0;

/// The relative tolerance at which errors of integration are smaller by orders of magnitude.
const FINER: &str = "1e-12";

/// Rows that the program writes unless it is told otherwise.
const ROWS: usize = 201;

/// A kind of equations, by the arguments that ask for it.
pub(super) fn form(tried: &mut Tried<'_>) -> (&'static str, Vec<String>) {
    let forms = ["poincare", "canonical", "reduced", "lie-poisson", "orthonormal", "hamel"];
    // The last are refused where constraints are held by multipliers, which does not have to be seen each time.
    let held = tried.execution.motion.residual.is_some() && tried.random.chance(80);
    let form = *tried.random.pick(if held { &forms[..2] } else { &forms });
    if form == "poincare" {
        return (form, Vec::new());
    }
    (form, vec!["--form".to_owned(), form.to_owned()])
}

/// The definition of a quasi-velocity for Hamel's form, a linear form in those of the model.
pub(super) fn hamel(random: &mut Random, quasi_velocities: &[String]) -> String {
    let (a, b) = (random.decimal(0.5, 2.0), random.decimal(-0.4, 0.4));
    let (first, second) = (random.pick(quasi_velocities), random.pick(quasi_velocities));
    format!("V={a}*{first} + {b}*{second}")
}

/// Runs the model once.
pub(super) fn examine(tried: &mut Tried<'_>) {
    let (form, mut arguments) = form(tried);
    let method = METHODS[tried.random.below(METHODS.len())];
    let rows = if tried.random.chance(30) { ROWS } else { SAMPLES };
    let reactions = tried.random.chance(50);
    if form == "hamel" {
        if tried.quasi_velocities.is_empty() {
            return;
        }
        arguments.push(hamel(tried.random, &tried.quasi_velocities));
    }
    if method != "auto" {
        arguments.extend(["--method".to_owned(), method.to_owned()]);
    }
    if rows != ROWS {
        arguments.extend(["--rows".to_owned(), rows.to_string()]);
    }
    if reactions {
        arguments.extend(["--outputs".to_owned(), "reactions".to_owned()]);
    }
    let stage = match (form, method) {
        ("poincare", "auto") => "pc run at default options",
        _ => "pc run",
    };
    let Some(text) = tried.output(stage, "run", &arguments) else { return };
    let Some(table) = tried.table(&text, &arguments, |_, _| true) else { return };
    let complete = !["reduced", "lie-poisson"].contains(&form);
    let tolerance = if ["adams", "bdf"].contains(&method) { OF_MULTISTEP } else { TOLERANCE };
    if difference(&tried.execution.motion, &table, tolerance, complete).is_none() {
        return;
    }
    // A motion that is another one stays so; errors of integration, which may grow by orders of magnitude, vanish.
    arguments.extend(["--rtol".to_owned(), FINER.to_owned()]);
    let Some(text) = tried.output("pc run at a finer tolerance", "run", &arguments) else { return };
    let Some(table) = tried.table(&text, &arguments, |_, _| true) else { return };
    if let Some(difference) = difference(&tried.execution.motion, &table, tolerance, complete) {
        let detail = format!("{difference}: run {}", arguments.join(" "));
        tried.tally.find("the motion of the program differs", detail);
    }
}

/// What a table has otherwise than the motion, or lacks where it is to be complete.
fn difference(motion: &Motion, table: &Table, tolerance: f64, complete: bool) -> Option<String> {
    motion.moved.as_ref()?;
    let t = table.place("t")?;
    for (j, name) in motion.columns.iter().enumerate() {
        let Some(k) = table.place(name) else {
            let is_reaction = ["λ_", "F_", "N_"].iter().any(|of| name.starts_with(of));
            if complete && !is_reaction {
                return Some(format!("there is no column {name}"));
            }
            continue;
        };
        for (i, (time, row)) in motion.times.iter().zip(&motion.rows).enumerate() {
            let Some(moved) = resolved(motion, i, j) else { break };
            let apart = |row: &&Vec<f64>| f64::abs(row[t] - time);
            let nearest = table.rows.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
            let allowed = tolerance * size(motion, j) + GROWTH * moved;
            if exceeds(nearest[t] - time, allowed.max(tolerance * time.abs().max(1.0))) {
                return Some(format!("there is no row at {time:?}, but one at {:?}", nearest[t]));
            }
            if exceeds(nearest[k] - row[j], allowed) && !(nearest[k].is_nan() && row[j].is_nan()) {
                let (found, known) = (nearest[k], row[j]);
                return Some(format!(
                    "{name} is {found:?}, not {known:?}, at {time:?}; {allowed:.0e} allowed"
                ));
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::execution::Moved;

    fn motion(moved: f64) -> Motion {
        Motion {
            columns: vec!["x".to_owned(), "energy".to_owned()],
            times: vec![0.0, 1.0],
            rows: vec![vec![0.5, 0.9], vec![0.7, 0.9]],
            happenings: Vec::new(),
            moved: Some(Moved { rows: vec![vec![0.0; 2], vec![moved, 0.0]], happenings: Vec::new() }),
            residual: None,
        }
    }

    fn found(moved: f64, text: &str, complete: bool) -> Option<String> {
        let table = Table::of(text).expect("a table");
        difference(&motion(moved), &table, TOLERANCE, complete)
    }

    #[test]
    fn a_motion_that_is_off_is_found() {
        assert_eq!(found(0.0, "t,x,energy\n0,0.5,0.9\n0.5,4,0.9\n1,0.7,0.9\n", true), None);
        let off = found(0.0, "t,x,energy\n0,0.5,0.9\n1,0.701,0.9\n", true);
        assert!(off.is_some_and(|detail| detail.contains("x is 0.701, not 0.7")));
        let short = found(0.0, "t,x,energy\n0,0.5,0.9\n0.5,0.7,0.9\n", true);
        assert!(short.is_some_and(|detail| detail.contains("no row at 1.0")));
    }

    #[test]
    fn what_tolerances_move_may_be_off_and_what_they_move_far_judges_nothing() {
        let off = "t,x,energy\n0,0.5,0.9\n1,0.700001,0.9\n";
        assert!(found(0.0, off, true).is_some());
        assert_eq!(found(1e-8, off, true), None);
        assert_eq!(found(1e-2, "t,x,energy\n0,0.5,0.9\n1,5,0.9\n", true), None);
    }

    #[test]
    fn a_column_may_be_missing_in_reduced_forms_only() {
        let without = "t,x\n0,0.5\n1,0.7\n";
        assert_eq!(found(0.0, without, false), None);
        assert!(found(0.0, without, true).is_some_and(|detail| detail == "there is no column energy"));
    }
}
