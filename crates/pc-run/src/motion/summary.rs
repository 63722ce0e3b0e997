//! The summary of a run, for readers and for files.

use pc_print::{columns, one_line};
use pc_solve::{Method, Slide};
use serde_json::{Map, Value, json};

use crate::motion::run::{Ending, Run};
use pc_print::{assignments, labelled, short, small, wrapped};

const LABEL: usize = 9;
const WIDTH: usize = 86;

/// The summary for people.
pub fn text(run: &Run) -> String {
    let mut text = format!("{}\n", one_line(&run.title));
    for (label, mut lines) in entries(run) {
        if label == WORK
            && let Some(line) = lines.first_mut()
        {
            *line += &format!(", {:.3} ms", run.wall.as_secs_f64() * 1e3);
        }
        text += &labelled(label, LABEL, &lines);
    }
    text
}

/// The labelled lines of the summary, without the computing time, so that the same run gives the same
/// summary.
pub fn entries(run: &Run) -> Vec<(&'static str, Vec<String>)> {
    let (plan, work) = (&run.plan, &run.statistics);
    let mut entries: Vec<(&'static str, Vec<String>)> = Vec::new();
    let mut line = |label: &'static str, lines: &[String]| entries.push((label, lines.to_vec()));

    line("method", &[plan.in_words(&run.tolerances)]);
    let rows = run.table.len();
    let reached = match &run.ending {
        Ending::Completed => format!("{rows} rows"),
        Ending::Event { name } => {
            format!("ended by the event {name} at {}, {rows} rows", short(run.reached(), 10))
        }
        _ => format!(
            "{} at {}, {rows} of {} rows",
            run.ending.word(),
            short(work.current_time, 10),
            plan.samples
        ),
    };
    line("time", &[format!("{} to {}, {reached}", short(plan.t_start, 10), short(plan.t_end, 10))]);
    line(WORK, &[work_done(run)]);
    line("chosen", &chosen(run));
    line("events", &events(run));
    line("slides", &slides(run));
    line("drift", &drifts(run));
    line("errors", &errors(run));
    if !run.constraints.is_empty() {
        line("held", &held(run));
    }
    line("digits", &run.never_exceeded);
    line("values", &not_finite(run));
    let dropped = run.dropped.iter().map(|(name, reason)| format!("{name} {reason}: λ_{name} is taken as 0"));
    line("dropped", &dropped.collect::<Vec<_>>());
    if let Some(verification) = &run.verification {
        line("verified", &verification.lines());
    }
    if let [first, others @ ..] = run.verified_before.as_slice() {
        line("verified", &[&[format!("in an earlier run, {first}")], others].concat());
    }
    if let Some(row) = run.table.rows().next_back() {
        let state = run.table.coordinates().start..run.table.states().end;
        let names = run.table.columns().iter().map(String::as_str).zip(row.iter().copied());
        let shown = names.take(1 + state.len());
        let arrived = matches!(run.ending, Ending::Completed | Ending::Event { .. });
        let label = if arrived { "end" } else { "last row" };
        line(label, &assignments(shown, WIDTH));
    }
    entries.retain(|(_, lines)| !lines.is_empty());
    entries
}

const WORK: &str = "work";

/// The lines about the choices made by the method `auto`, or a remark if DOP853 met a stiff motion.
fn chosen(run: &Run) -> Vec<String> {
    let (plan, work) = (&run.plan, &run.statistics);
    let times = |n: u64| if n == 1 { "once".to_owned() } else { format!("{n} times") };
    match (plan.method, work.stiff_from) {
        (Method::Auto, _) if !plan.sensitivities.is_empty() => {
            vec!["Adams, which has sensitivities".to_owned()]
        }
        (Method::Auto, None) => vec!["DOP853: no stiffness was seen".to_owned()],
        (Method::Auto, Some(t)) => vec![format!(
            "DOP853 for {} steps, BDF for {}: stiffness was seen first at t = {}; changed {}",
            work.steps - work.implicit_steps,
            work.implicit_steps,
            short(t, 6),
            times(work.changes),
        )],
        (Method::Dop853, Some(t)) => {
            vec![format!("stability limits the steps from t = {} on: bdf or auto takes fewer", short(t, 6))]
        }
        (Method::Dop853 | Method::Adams | Method::Bdf | Method::Taylor, _) => Vec::new(),
    }
}

fn work_done(run: &Run) -> String {
    let work = &run.statistics;
    let count = |n: u64, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let mut parts = vec![count(work.steps, "step"), count(work.rhs_evaluations, "evaluation")];
    if work.jacobian_evaluations > 0 {
        parts.push(count(work.jacobian_evaluations, "Jacobian"));
    }
    if work.error_test_failures > 0 {
        parts.push(count(work.error_test_failures, "rejected step"));
    }
    if work.limited_steps > 0 {
        parts.push(format!("{} shortened for explicit time dependence", count(work.limited_steps, "step")));
    }
    parts.join(", ")
}

/// The number of characters of a formula that are shown.
const LONGEST: usize = 80;
/// If an event occurs no more often than this, all its occurrences are listed.
const FEW: usize = 5;
/// The remark on an event whose function is zero at the start and then moves on beyond zero.
const AT_START: &str = "   (zero at the start and beyond it from there on, which is no passage)";

fn events(run: &Run) -> Vec<String> {
    let width = run.events.iter().map(|name| columns(name)).max().unwrap_or(0);
    let line = |(event, name): (usize, &String)| {
        let times = run.occurrences.iter().filter(|occurrence| occurrence.event == event);
        let times: Vec<String> = times.map(|occurrence| short(occurrence.time, 10)).collect();
        let when = match times.as_slice() {
            [] => "does not occur".to_owned(),
            [t] => format!("once: {t}"),
            [first, .., last] if times.len() > FEW => {
                format!("{} times: first {first}, last {last}", times.len())
            }
            all => format!("{} times: {}", all.len(), all.join(", ")),
        };
        let start = if run.passed_at_start.contains(&event) { AT_START } else { "" };
        format!("{name:width$}  {when}{start}")
    };
    run.events.iter().enumerate().map(line).collect()
}

/// The lines that say where the motion slides along surfaces on which forces jump.
fn slides(run: &Run) -> Vec<String> {
    let mut surfaces: Vec<&str> = Vec::new();
    for slide in &run.slides {
        if !surfaces.contains(&slide.surface.as_str()) {
            surfaces.push(&slide.surface);
        }
    }
    let part = |slide: &Slide| match slide.until {
        Some(until) => format!("from {} to {}", short(slide.from, 10), short(until, 10)),
        None => format!("from {} on", short(slide.from, 10)),
    };
    let line = |surface: &str| {
        let parts: Vec<String> =
            run.slides.iter().filter(|slide| slide.surface == surface).map(part).collect();
        let when = match parts.as_slice() {
            [first, .., last] if parts.len() > FEW => {
                format!("{} times: first {first}, last {last}", parts.len())
            }
            all => all.join(", "),
        };
        format!("along {} = 0 {when}", abridged(surface))
    };
    surfaces.into_iter().map(line).collect()
}

/// The beginning of a long formula.
fn abridged(formula: &str) -> String {
    match formula.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &formula[..end]),
        None => formula.to_owned(),
    }
}

fn drifts(run: &Run) -> Vec<String> {
    let table = &run.table;
    let width = table.conserved().map(|j| columns(&table.columns()[j])).max().unwrap_or(0);
    let drifts = table.conserved().map(|j| {
        let name = &table.columns()[j];
        let drift = table.drift(j);
        let relative = drift.relative.map_or_else(
            || "(its start value is no larger)".to_owned(),
            |relative| format!("relative {}", small(relative)),
        );
        let note = if j + 1 == table.conserved().end && !run.keeps_energy {
            "   (not an integral here)"
        } else {
            ""
        };
        format!("{name:width$}  {:<8} {relative}{note}", small(drift.absolute))
    });
    drifts.collect()
}

/// The largest number of rows that are listed one by one.
const FEW_ROWS: usize = 3;

/// The estimated global errors of the state in the last row in which they are known, with remarks.
fn errors(run: &Run) -> Vec<String> {
    let Some(estimate) = &run.estimate else { return Vec::new() };
    let by = format!("by a companion: {}, rtol {}", estimate.method, short(estimate.rtol, 2));
    let mut lines = Vec::new();
    if let Some((t, errors)) = last_errors(run) {
        let shown = errors.iter().map(|(name, error)| format!("{name} {}", small(error.absolute)));
        lines.extend(wrapped(shown, WIDTH));
        let relative = errors.iter().filter_map(|(name, error)| Some((error.relative?, *name)));
        let worst = relative.max_by(|a, b| a.0.total_cmp(&b.0));
        let worst = worst.map_or_else(String::new, |(relative, name)| {
            format!(", relative to the motion up to {} ({name})", small(relative))
        });
        lines.push(format!("at t = {}{worst}, {by}", short(t, 10)));
    } else {
        lines.push(format!("not known, {by}"));
    }
    if let Some(t) = estimate.grown {
        lines.push(format!("the error has the size of the motion first at t = {}", short(t, 10)));
    }
    match estimate.beyond_events.as_slice() {
        [] => {}
        times if times.len() > FEW_ROWS => lines.push(format!(
            "{} rows from t = {} on are before an event in one of both motions alone",
            times.len(),
            short(times[0], 10)
        )),
        times => {
            let times: Vec<String> = times.iter().map(|t| short(*t, 10)).collect();
            lines.push(format!(
                "at t = {} the row is before an event in one of both motions alone",
                times.join(", ")
            ));
        }
    }
    lines.extend(estimate.incomplete.iter().map(|why| format!("later rows have none: {why}")));
    lines
}

/// The error of a column in one row.
struct LastError {
    absolute: f64,
    /// The error divided by the largest value of the column.
    relative: Option<f64>,
}

/// The time of the last row in which errors are known, and the errors of the state there.
fn last_errors(run: &Run) -> Option<(f64, Vec<(&str, LastError)>)> {
    let (table, estimate) = (&run.table, run.estimate.as_ref()?);
    let row = table.rows().nth(estimate.rows.checked_sub(1)?)?;
    let error = |j: usize| {
        let (absolute, largest) = (row[table.error_of(j)?], table.largest(j));
        let relative = (largest > 0.0).then(|| absolute / largest);
        Some((table.columns()[j].as_str(), LastError { absolute, relative }))
    };
    let state = table.coordinates().start..table.states().end;
    Some((row[0], state.filter_map(error).collect()))
}

/// The lines that name columns without a finite value in some rows.
fn not_finite(run: &Run) -> Vec<String> {
    let table = &run.table;
    let line = |(j, name): (usize, &String)| {
        let found = table.not_finite(j)?;
        let (value, t, rows) = (found.value, short(found.t, 10), found.rows);
        Some(format!("{name} is {value} at t = {t}, not finite in {rows} of {} rows", table.len()))
    };
    // Errors that are not known are said with the estimate.
    table.columns()[..table.errors().start].iter().enumerate().filter_map(line).collect()
}

fn held(run: &Run) -> Vec<String> {
    let width = run.constraints.iter().map(|(name, _)| columns(name)).max().unwrap_or(0);
    let line = |(name, worst): &(String, f64)| format!("{name:width$}  to {}", small(*worst));
    run.constraints.iter().map(line).collect()
}

/// The summary for files, without the computing time, so that the same run gives the same file.
pub fn json(run: &Run) -> Value {
    let (plan, work, table) = (&run.plan, &run.statistics, &run.table);
    let drift: Map<String, Value> = table
        .conserved()
        .map(|j| {
            let drift = table.drift(j);
            (table.columns()[j].clone(), json!({ "absolute": drift.absolute, "relative": drift.relative }))
        })
        .collect();
    let held: Map<String, Value> =
        run.constraints.iter().map(|(name, worst)| (name.clone(), json!(worst))).collect();
    let mut summary = json!({
        "ending": run.ending.word(),
        "method": plan.method.to_string().to_lowercase(),
        "rtol": plan.rtol,
        "atol": run.tolerances.json(),
        "max_step": plan.max_step,
        "t_start": plan.t_start,
        "t_end": plan.t_end,
        "t_reached": run.reached(),
        "steps": work.steps,
        "evaluations": work.rhs_evaluations,
        "jacobians": work.jacobian_evaluations,
        "rejected_steps": work.error_test_failures,
        "limited_steps": work.limited_steps,
        "keeps_energy": run.keeps_energy,
        "drift": drift,
        "constraints": held,
    });
    if let Some(estimate) = &run.estimate {
        let (t, errors) = last_errors(run).unzip();
        let end = errors.into_iter().flatten().map(|(name, error)| {
            (name.to_owned(), json!({ "absolute": error.absolute, "relative": error.relative }))
        });
        summary["errors"] = json!({
            "companion": { "method": estimate.method.to_string().to_lowercase(), "rtol": estimate.rtol },
            "t": t,
            "end": end.collect::<Map<_, _>>(),
            "grown_from": estimate.grown,
            "beyond_events": estimate.beyond_events,
            "incomplete": estimate.incomplete,
        });
    }
    if !run.slides.is_empty() {
        let slide =
            |slide: &Slide| json!({ "surface": slide.surface, "from": slide.from, "until": slide.until });
        summary["slides"] = run.slides.iter().map(slide).collect();
    }
    if matches!(plan.method, Method::Dop853 | Method::Auto) {
        summary["stiff_from"] = json!(work.stiff_from);
    }
    if plan.method == Method::Auto {
        summary["implicit_steps"] = json!(work.implicit_steps);
        summary["changes"] = json!(work.changes);
    }
    summary
}
