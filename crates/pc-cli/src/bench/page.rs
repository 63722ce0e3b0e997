//! Measured times in text and JSON.

use pc_print::{columns, counted, one_line};
use serde_json::{Map, Value, json};

use crate::bench::derivation::{Derivation, STAGES};
use crate::bench::measure::{Times, Variant};
use crate::terminal::text::labelled;

/// The measurements of a model.
pub(crate) struct Figures<'v> {
    pub(crate) title: String,
    /// Length of the state.
    pub(crate) state: usize,
    /// Expressions of the derivation.
    pub(crate) nodes: usize,
    /// Operations of the right-hand side.
    pub(crate) cost: pc_expr::Cost,
    pub(crate) derivation: Derivation,
    pub(crate) variants: &'v [Variant<'v>],
    pub(crate) times: Vec<Times>,
}

const LABEL: usize = 12;
const NAME: usize = 36;

impl Figures<'_> {
    /// For people.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("{}\n", one_line(&self.title));
        text += &labelled("state", LABEL, &[format!("{} numbers", self.state)]);
        text += &labelled("derived", LABEL, &[format!("{} expressions", self.nodes)]);
        text += &labelled("operations", LABEL, &[counted("one right-hand side", &self.cost)]);
        if cfg!(debug_assertions) {
            let warning = "this program was compiled without optimisation: these times mean nothing";
            text += &labelled("note", LABEL, &[warning.to_owned()]);
        }
        text += &heading(&format!("derivation, ms, {} times", self.derivation.total.len()));
        for (stage, times) in STAGES.iter().zip(&self.derivation.stages) {
            text += &row(stage, times, 3, "");
        }
        text += &row("all of it", &self.derivation.total, 3, "");
        let rounds = self.times.first().map_or(0, Times::len);
        text += &heading(&format!("an evaluation, ns, {rounds} rounds"));
        for (variant, times) in self.variants.iter().zip(&self.times) {
            let operations =
                variant.operations.map_or_else(String::new, |count| format!("{count} operations"));
            text += &row(variant.name, times, 1, &operations);
        }
        text
    }

    /// For programs.
    pub(crate) fn json(&self) -> Value {
        let stages: Map<String, Value> = (STAGES.iter().zip(&self.derivation.stages))
            .map(|(stage, times)| ((*stage).to_owned(), quantiles(times)))
            .chain([("total".to_owned(), quantiles(&self.derivation.total))])
            .collect();
        let kernel = |(variant, times): (&Variant<'_>, &Times)| {
            let mut object = json!({ "name": variant.name, "operations": variant.operations });
            object["ns"] = quantiles(times);
            object
        };
        json!({
            "model": self.title,
            "optimised": !cfg!(debug_assertions),
            "state": self.state,
            "expressions": self.nodes,
            "operations": self.cost.iter().map(|(kind, count)| (kind.to_owned(), json!(count))).collect::<Map<_, _>>(),
            "derivations": self.derivation.total.len(),
            "derivation_ms": stages,
            "rounds": self.times.first().map_or(0, Times::len),
            "evaluations": self.variants.iter().zip(&self.times).map(kernel).collect::<Value>(),
        })
    }
}

fn quantiles(times: &Times) -> Value {
    let [minimum, tenth, median] = times.quantiles();
    json!({ "minimum": minimum, "tenth": tenth, "median": median })
}

fn heading(what: &str) -> String {
    let cells = ["minimum", "10th %", "median"].map(|name| format!("{name:>12}")).concat();
    format!("\n  {}{cells}\n", padded(what))
}

fn row(name: &str, times: &Times, digits: usize, note: &str) -> String {
    let cells = times.quantiles().map(|time| format!("{time:>12.digits$}")).concat();
    format!("{}\n", format!("  {}{cells}  {note}", padded(name)).trim_end())
}

fn padded(name: &str) -> String {
    format!("{name}{}", " ".repeat(NAME - columns(name).min(NAME)))
}
