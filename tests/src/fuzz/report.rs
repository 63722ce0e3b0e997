//! What a campaign came to, in words.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::examination::Examined;

/// So many models are named for a cause.
const NAMED: usize = 12;

/// A cause with the models that it was met with, and what was said of the first.
#[derive(Clone, Debug)]
struct Cause {
    models: Vec<u64>,
    example: String,
}

/// Findings and refusals by cause.
#[derive(Clone, Debug, Default)]
pub struct Report {
    models: usize,
    ran: usize,
    rightly_refused: usize,
    without_start: usize,
    with_findings: usize,
    findings: BTreeMap<String, Cause>,
    refusals: BTreeMap<String, Cause>,
}

impl Report {
    /// The report on models in order.
    pub fn of(results: &[(u64, Examined)]) -> Report {
        let mut report = Report::default();
        for (index, examined) in results {
            report.models += 1;
            report.ran += usize::from(examined.ran);
            report.without_start += usize::from(examined.text.is_empty());
            report.rightly_refused += usize::from(examined.rightly_refused);
            report.with_findings += usize::from(!examined.findings.is_empty());
            for finding in &examined.findings {
                note(&mut report.findings, finding.kind.to_owned(), *index, &finding.detail);
            }
            if !examined.rightly_refused {
                for refusal in &examined.refusals {
                    note(&mut report.refusals, refusal.cause(), *index, &refusal.message);
                }
            }
        }
        report
    }

    /// Whether nothing was found.
    pub fn is_clean(&self) -> bool {
        self.findings.is_empty()
    }

    /// The number of models that were run.
    pub fn ran(&self) -> usize {
        self.ran
    }

    /// The kinds of findings, each with the first model that has it.
    pub fn kinds(&self) -> impl Iterator<Item = (&str, u64)> {
        self.findings.iter().map(|(kind, cause)| (kind.as_str(), cause.models[0]))
    }

    /// Numbers, and a table of findings and one of refusals, each cause with an example.
    pub fn text(&self) -> String {
        let Report { models, ran, rightly_refused, without_start, with_findings, .. } = self;
        let mut text = format!(
            "{models} models: {ran} run, {with_findings} with findings; {rightly_refused} refused as they must be, \
             {without_start} without a start\n"
        );
        for (title, causes) in [("findings", &self.findings), ("refusals", &self.refusals)] {
            let mut sorted: Vec<(&String, &Cause)> = causes.iter().collect();
            sorted.sort_by_key(|(_, cause)| std::cmp::Reverse(cause.models.len()));
            let _ = writeln!(text, "\n{title}");
            if sorted.is_empty() {
                text.push_str("  none\n");
            }
            for (cause, Cause { models, example }) in sorted {
                let named: Vec<String> = models.iter().take(NAMED).map(u64::to_string).collect();
                let more = if models.len() > NAMED { ", …" } else { "" };
                let _ =
                    writeln!(text, "{:6}  {cause}\n        models {}{more}", models.len(), named.join(", "));
                for line in example.lines().take(6) {
                    let _ = writeln!(text, "          {line}");
                }
            }
        }
        text
    }
}

fn note(causes: &mut BTreeMap<String, Cause>, cause: String, index: u64, example: &str) {
    let new = || Cause { models: Vec::new(), example: example.to_owned() };
    causes.entry(cause).or_insert_with(new).models.push(index);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::comparison::Finding;
    use crate::fuzz::execution::Refusal;

    #[test]
    fn causes_are_counted_without_places_names_and_numbers() {
        let refused = |message: &str| Examined {
            text: "x".to_owned(),
            refusals: vec![Refusal { stage: "model", message: message.to_owned() }],
            ..Examined::default()
        };
        let kind = "motion differs";
        let found = Examined {
            text: "x".to_owned(),
            ran: true,
            findings: vec![Finding { kind, detail: "x is 1, not 2".to_owned() }],
            ..Examined::default()
        };
        let results = [
            (0, refused("m.toml:3:1: [lagrangian] kinetic: `x^2.5` is NaN at the start (x = -1e-3)\n  text")),
            (1, found),
            (2, refused("m.toml:8:9: [constraints] k: `y` is NaN at the start (x = 4, y = 0.5)")),
        ];
        let report = Report::of(&results);
        let text = report.text();
        assert!(
            text.starts_with(
                "3 models: 1 run, 1 with findings; 0 refused as they must be, 0 without a start"
            )
        );
        assert!(text.contains("2  model: `…` is NaN at the start\n        models 0, 2\n"), "{text}");
        assert_eq!(report.kinds().collect::<Vec<_>>(), [(kind, 1)]);
        assert!(!report.is_clean());
    }
}
