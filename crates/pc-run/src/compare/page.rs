//! Comparisons in text and JSON.

use pc_print::{columns, one_line};
use serde_json::{Value, json};

use crate::compare::compared::Compared;
use crate::compare::comparison::{Comparison, ending};
use crate::compare::difference::Difference;
use crate::motion::run::Run;
use pc_print::{labelled, short, small, wrapped};

const LABEL: usize = 10;
const WIDTH: usize = 86;

impl Compared {
    /// The comparison for people.
    pub fn text(&self) -> String {
        let Compared { runs: [first, second], comparison } = self;
        let side = |run: &Run| {
            let (form, plan) = (run.plan.form.name(), run.plan.in_words(&run.tolerances));
            vec![one_line(&run.title).into_owned(), format!("{form}, {plan}, {}", ending(run))]
        };
        let start = first.plan.t_start;
        let mut text = labelled("A", LABEL, &side(first));
        text += &labelled("B", LABEL, &side(second));
        let until = short(comparison.until, 10);
        let compared = format!("{} times, {} to {until}", comparison.rows, short(start, 10));
        text += &labelled("compared", LABEL, &[compared]);
        let allowance = comparison.allowance;
        let again = comparison.differences.iter().any(|found| found.uncertain > 0.0);
        let errors = if again { ", and twice what smaller tolerances change" } else { "" };
        let allowed =
            format!("{:e} of the largest value, and {:e}{errors}", allowance.relative, allowance.absolute);
        text += &labelled("allowed", LABEL, &[allowed]);
        let width = comparison.differences.iter().map(|found| columns(&found.name)).max().unwrap_or(0);
        let lines: Vec<String> = comparison.differences.iter().map(|found| line(found, width)).collect();
        text += &labelled("apart", LABEL, &lines);
        text += &labelled("A alone", LABEL, &wrapped(comparison.only_first.iter().cloned(), WIDTH));
        text += &labelled("B alone", LABEL, &wrapped(comparison.only_second.iter().cloned(), WIDTH));
        let verdict =
            if comparison.is_same() { "the same motion in what is compared" } else { "two motions" };
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
            })
        };
        let column = |found: &Difference| {
            json!({
                "name": found.name,
                "largest": found.largest,
                "time": found.time,
                "scale": found.scale,
                "allowed": found.allowed,
                "uncertain": found.uncertain,
                "since": found.since,
                "counts": found.counts,
                "same": found.since.is_none(),
            })
        };
        json!({
            "same": comparison.is_same(),
            "first": side(first),
            "second": side(second),
            "tolerance": comparison.allowance.relative,
            "absolute": comparison.allowance.absolute,
            "t_start": first.plan.t_start,
            "t_end": comparison.until,
            "times": comparison.rows,
            "columns": comparison.differences.iter().map(column).collect::<Value>(),
            "only_first": comparison.only_first,
            "only_second": comparison.only_second,
            "ends": comparison.ends,
        })
    }
}

fn line(found: &Difference, width: usize) -> String {
    let pad = " ".repeat(width - columns(&found.name));
    let largest = format!("{}{pad}  {:<8}", found.name, small(found.largest));
    let scale = short(found.scale, 4);
    match found.since {
        None => format!("{largest}of {scale}"),
        Some(since) => {
            let (time, since) = (short(found.time, 6), short(since, 6));
            let aside = if found.counts { "" } else { ", which does not count" };
            format!("{largest}of {scale}, at t = {time}; more than is allowed from t = {since} on{aside}")
        }
    }
}

impl Comparison {
    /// A phrase for each thing that differs.
    pub(crate) fn differing(&self) -> Vec<String> {
        let phrase = |found: &Difference| {
            format!(
                "{} by {}, where {} is allowed",
                found.name,
                small(found.largest),
                small(found.allowed + found.uncertain)
            )
        };
        let too_far = self.differences.iter().filter(|found| !found.is_allowed()).map(phrase);
        too_far.chain(self.ends.clone()).collect()
    }
}
