//! The eigenvalues over a parameter, as text and tables.

use pc_analysis::{Eigenvalue, RootLocus};
use pc_report::picture::{Curve, Panel, Picture, Scale};
use serde_json::{Value, json};

use crate::error::CliError;
use crate::linear::arrays::of_locus;
use crate::linear::file::{Contents, Destination};
use crate::linear::text::{aligned, complex};
use crate::output::csv::field;
use crate::report::text::short;

/// A root locus with its model and parameter.
pub(crate) struct Locus {
    pub(crate) title: String,
    /// The parameter or start value that is varied.
    pub(crate) name: String,
    pub(crate) components: Vec<String>,
    pub(crate) locus: RootLocus,
    /// The values that have no linearization, with the reason.
    pub(crate) missing: Vec<(f64, String)>,
}

impl Locus {
    /// A line for each value.
    pub(crate) fn text(&self) -> String {
        let branches = self.locus.branches();
        let header = std::iter::once(self.name.clone()).chain((1..=branches.len()).map(|i| format!("λ{i}")));
        let mut table: Vec<Vec<String>> = vec![header.collect()];
        for (i, &value) in self.locus.values().iter().enumerate() {
            let cell = |lambda: Option<Eigenvalue>| {
                lambda.map_or("-".to_owned(), |l| complex((l.real, l.imaginary)))
            };
            table.push(
                std::iter::once(short(value, 6))
                    .chain(branches.iter().map(|branch| cell(branch[i])))
                    .collect(),
            );
        }
        format!("{}\n{}", pc_print::one_line(&self.title), aligned(&table))
    }

    /// The value, then real and imaginary part of each branch.
    pub(crate) fn csv(&self) -> String {
        let branches = self.locus.branches();
        let names = (1..=branches.len()).flat_map(|i| [format!("re{i}"), format!("im{i}")]);
        let header: Vec<String> = std::iter::once(field(&self.name)).chain(names).collect();
        let mut text = header.join(",") + "\n";
        for (i, value) in self.locus.values().iter().enumerate() {
            text += &format!("{value:.16e}");
            for branch in branches {
                let (re, im) = branch[i].map_or((f64::NAN, f64::NAN), |l| (l.real, l.imaginary));
                text += &format!(",{re:.16e},{im:.16e}");
            }
            text.push('\n');
        }
        text
    }

    /// The locus as one JSON object.
    pub(crate) fn json(&self) -> Value {
        let parts = |branch: &Vec<Option<Eigenvalue>>, part: fn(&Eigenvalue) -> f64| {
            branch.iter().map(|lambda| lambda.as_ref().map(part)).collect::<Vec<_>>()
        };
        let branch = |branch: &Vec<Option<Eigenvalue>>| json!({ "real": parts(branch, |l| l.real), "imaginary": parts(branch, |l| l.imaginary) });
        let missing = self.missing.iter().map(|(value, reason)| json!({ "value": value, "reason": reason }));
        json!({
            "model": self.title,
            "parameter": self.name,
            "components": self.components,
            "values": self.locus.values(),
            "branches": self.locus.branches().iter().map(branch).collect::<Value>(),
            "missing": missing.collect::<Value>(),
        })
    }

    /// Real parts and imaginary parts over the parameter.
    pub(crate) fn picture(&self) -> Picture {
        let curves = |part: fn(&Eigenvalue) -> f64| {
            let points = |branch: &Vec<Option<Eigenvalue>>| {
                let all = self.locus.values().iter().zip(branch);
                all.filter_map(|(&value, lambda)| Some((value, part(lambda.as_ref()?)))).collect::<Vec<_>>()
            };
            let curve = |(i, branch)| Curve { name: format!("λ{i}"), points: points(branch) };
            (1..).zip(self.locus.branches()).map(curve).collect()
        };
        let panel = |title, part| Panel::over(&self.name, title, Scale::Linear, curves(part));
        Picture {
            title: self.title.clone(),
            remarks: Vec::new(),
            panels: vec![panel("Re λ", |l| l.real), panel("Im λ", |l| l.imaginary)],
        }
    }

    /// Writes it to a file.
    ///
    /// # Errors
    /// As [`Destination::write`].
    pub(crate) fn write(&self, destination: &Destination) -> Result<(), CliError> {
        destination.write(&Contents {
            json: &self.json(),
            csv: &self.csv(),
            arrays: &of_locus(&self.locus),
            texts: &[("parameter", self.name.clone()), ("components", self.components.join(","))],
        })
    }
}
