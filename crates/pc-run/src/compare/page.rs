//! Comparisons in text and JSON.

use pc_print::{columns, labelled, one_line, short, small, wrapped};
use serde_json::{Value, json};

use crate::compare::compared::Compared;
use crate::compare::comparison::{Comparison, ending};
use crate::compare::difference::{Difference, SAFETY, Verdict};
use crate::motion::run::Run;

const LABEL: usize = 10;
const WIDTH: usize = 86;

impl Compared {
    /// The comparison for people.
    pub fn text(&self) -> String {
        let Compared { runs: [first, second], comparison } = self;
        let start = first.plan.t_start;
        let mut text = labelled("A", LABEL, &side(first));
        text += &labelled("B", LABEL, &side(second));
        let until = short(comparison.until, 10);
        let mut compared = format!("{} times, {} to {until}", comparison.rows, short(start, 10));
        if comparison.left_out > 0 {
            compared += &format!("; {} at events left out", comparison.left_out);
        }
        text += &labelled("compared", LABEL, &[compared]);
        text += &labelled("allowed", LABEL, &[allowed(comparison)]);
        text += &labelled("apart", LABEL, &lines(&comparison.differences));
        text += &labelled("A alone", LABEL, &wrapped(comparison.only_first.iter().cloned(), WIDTH));
        text += &labelled("B alone", LABEL, &wrapped(comparison.only_second.iter().cloned(), WIDTH));
        let verdict = match comparison.verdict() {
            Verdict::Same => "the same motion in what is compared",
            Verdict::Different => "two motions",
            Verdict::Undecided => "undecided: the errors are too large to tell",
        };
        text += &labelled("verdict", LABEL, &[verdict.to_owned()]);
        text
    }

    /// The comparison for programs.
    pub fn json(&self) -> Value {
        let Compared { runs: [first, second], comparison } = self;
        let side = |run: &Run| {
            json!({
                "model": run.title,
                "form": run.plan.form.name(),
                "method": run.plan.method.to_string().to_lowercase(),
                "ending": run.ending.word(),
                "t_reached": run.reached(),
                "without_errors": without_errors(run),
            })
        };
        let column = |found: &Difference| {
            json!({
                "name": found.name,
                "largest": found.largest,
                "time": found.time,
                "scale": found.scale,
                "errors": found.errors,
                "allowed": found.allowed,
                "since": found.since,
                "untold": found.untold,
                "counts": found.counts,
                "verdict": found.verdict().word(),
            })
        };
        json!({
            "verdict": comparison.verdict().word(),
            "first": side(first),
            "second": side(second),
            "tolerance": comparison.allowance.relative,
            "absolute": comparison.allowance.absolute,
            "t_start": first.plan.t_start,
            "t_end": comparison.until,
            "times": comparison.rows,
            "left_out": comparison.left_out,
            "columns": comparison.differences.iter().map(column).collect::<Value>(),
            "only_first": comparison.only_first,
            "only_second": comparison.only_second,
            "ends": comparison.ends,
        })
    }
}

/// The lines about one of the motions.
fn side(run: &Run) -> Vec<String> {
    let (form, plan) = (run.plan.form.name(), run.plan.in_words(&run.tolerances));
    let how = format!("{form}, {plan}, {}", ending(run));
    let title = one_line(&run.title).into_owned();
    [title, how].into_iter().chain(without_errors(run)).collect()
}

/// Why the errors of later rows of a motion are not known, if they are not.
fn without_errors(run: &Run) -> Option<String> {
    let accuracy = run.accuracy.as_ref()?;
    let why = accuracy.incomplete.as_ref()?;
    let from = run.table.column(0).nth(accuracy.beside.len())?;
    Some(format!("its errors are not known from t = {} on: {why}", short(from, 10)))
}

fn allowed(comparison: &Comparison) -> String {
    let errors = format!("{SAFETY} times the errors of both");
    let allowance = comparison.allowance;
    let parts = [
        (allowance.relative > 0.0).then(|| format!("{:e} of the largest value", allowance.relative)),
        (allowance.absolute > 0.0).then(|| format!("{:e}", allowance.absolute)),
        Some(errors),
    ];
    parts.into_iter().flatten().collect::<Vec<String>>().join(", and ")
}

/// A line for each column, below a line that says what is in them.
fn lines(differences: &[Difference]) -> Vec<String> {
    let head = ["", "at most", "of", "at t", "error of A", "error of B", ""].map(str::to_owned);
    let rows: Vec<[String; 7]> = std::iter::once(head).chain(differences.iter().map(cells)).collect();
    let width = |j: usize| rows.iter().map(|row| columns(&row[j])).max().unwrap_or(0);
    let line = |row: &[String; 7]| {
        let padded = row.iter().enumerate().map(|(j, cell)| {
            let pad = width(j) - columns(cell);
            format!("{cell}{}", " ".repeat(pad))
        });
        padded.collect::<Vec<String>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

fn cells(found: &Difference) -> [String; 7] {
    let error = |error: f64| if error.is_finite() { small(error) } else { "not known".to_owned() };
    let verdict = match (found.verdict(), found.since, found.untold) {
        (Verdict::Different, Some(since), _) => format!("different from t = {} on", short(since, 6)),
        (Verdict::Undecided, _, Some(from)) => format!("undecided from t = {} on", short(from, 6)),
        (verdict, ..) => verdict.word().to_owned(),
    };
    let counts = if found.counts || found.verdict() == Verdict::Same { "" } else { ", which does not count" };
    [
        found.name.clone(),
        small(found.largest),
        short(found.scale, 4),
        short(found.time, 6),
        error(found.errors[0]),
        error(found.errors[1]),
        format!("{verdict}{counts}"),
    ]
}

impl Comparison {
    /// A phrase for each thing that differs.
    pub(crate) fn differing(&self) -> Vec<String> {
        let phrase = |found: &Difference| {
            let [a, b] = found.errors.map(small);
            let mut phrase =
                format!("{} by {}, where the errors are {a} and {b}", found.name, small(found.largest));
            if found.allowed > 0.0 {
                phrase += &format!(" and {} is allowed", small(found.allowed));
            }
            phrase
        };
        self.counting(Verdict::Different).map(phrase).chain(self.ends.clone()).collect()
    }

    /// A phrase for each column that cannot be told.
    pub(crate) fn untold(&self) -> Vec<String> {
        let phrase = |found: &Difference| {
            let from = short(found.untold.unwrap_or(self.until), 6);
            format!("{} from t = {from} on", found.name)
        };
        self.counting(Verdict::Undecided).map(phrase).collect()
    }

    fn counting(&self, verdict: Verdict) -> impl Iterator<Item = &Difference> {
        self.differences.iter().filter(move |found| found.counts && found.verdict() == verdict)
    }
}
