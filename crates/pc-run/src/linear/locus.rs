//! The eigenvalues as functions of a parameter, as text and tables.

use std::io::{self, Seek, Write};

use pc_analysis::{Eigenvalue, Mode, RootLocus};
use pc_model::Model;
use pc_print::short;
use pc_report::picture::Picture;
use serde_json::{Value, json};

use crate::category::Category;
use crate::error::RunError;
use crate::linear::arrays::of_locus;
use crate::linear::error::LinearError;
use crate::linear::linearizable::Linearizable;
use crate::linear::locus_picture::{Axes, picture};
use crate::linear::near::Varied;
use crate::linear::output::Contents;
use crate::linear::state::StateChoice;
use crate::linear::text::{aligned, complex};
use crate::observer::Observer;
use crate::sweep::values::Vary;
use crate::table::csv::field;
use crate::table::format::Format;
use crate::table::tabulated::Tabulated;

/// A root locus, with its model and parameter.
#[derive(Debug)]
pub struct Locus {
    title: String,
    /// The parameter or start value that is varied.
    name: String,
    components: Vec<String>,
    /// The eigenvalues.
    pub locus: RootLocus,
    /// The values for which there is no linearization, each with the reason.
    pub missing: Vec<(f64, String)>,
    /// The value that the model has by itself.
    present: Option<f64>,
    /// The modes for the value nearest to the present one, with its place among the values.
    modes: Option<(usize, Vec<Mode>)>,
}

impl Locus {
    /// The eigenvalues of a model for each value of the varied quantity.
    ///
    /// # Errors
    /// [`RunError`], also if there is no linearization for any value.
    pub fn of(
        model: &Model,
        vary: &Vary,
        state: &StateChoice,
        verify: bool,
        observer: &dyn Observer,
    ) -> Result<Locus, RunError> {
        let graph = model.graph();
        let ground = Linearizable::vouched(model, &graph, verify, observer)?;
        let linearizations = Varied::of(model, &ground, state);
        let values = vary.values.in_order();
        let mut locus = Locus {
            title: model.title().to_owned(),
            name: vary.name.clone(),
            components: Vec::new(),
            locus: RootLocus::default(),
            missing: Vec::new(),
            present: present(model, &vary.name),
            modes: None,
        };
        let nearest = locus.present.map_or(f64::INFINITY, |present| distance_to(&values, present));
        for (place, &value) in values.iter().enumerate() {
            ground.assembly.within_limits()?;
            let mut varied = model.clone();
            varied.set_value(&vary.name, value).map_err(LinearError::Varied)?;
            let found = linearizations.linearization(&varied);
            let eigenvalues = match &found {
                Ok(linear) => {
                    locus.components.clone_from(&linear.components);
                    let is_nearest = locus.present.is_none_or(|present| (value - present).abs() <= nearest);
                    if is_nearest || locus.modes.is_none() {
                        locus.modes = Some((place, linear.modes.clone()));
                    }
                    Some(linear.spectrum.eigenvalues())
                }
                // A wrong request is wrong for all values.
                Err(error) if error.category() == Category::Request => return found.map(|_| locus),
                Err(error) => {
                    locus.missing.push((value, error.to_string()));
                    None
                }
            };
            let pushed = locus.locus.push(value, eigenvalues);
            pushed.map_err(|cause| LinearError::Branches { name: vary.name.clone(), value, cause })?;
        }
        match locus.missing.first() {
            Some((_, first)) if locus.missing.len() == values.len() => {
                Err(LinearError::NoneSteady { values: values.len(), first: first.clone() }.into())
            }
            _ => {
                locus.say_missing(observer);
                Ok(locus)
            }
        }
    }

    fn say_missing(&self, observer: &dyn Observer) {
        for (value, reason) in &self.missing {
            let reason = reason.lines().next().unwrap_or_default();
            observer.remark(&format!("nothing at {} = {}: {reason}", self.name, short(*value, 6)));
        }
    }

    /// The eigenvalues as text, with a line for each value.
    pub fn text(&self) -> String {
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

    /// The columns: the value, then the real and imaginary part of each branch.
    pub fn csv(&self) -> String {
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
    pub fn json(&self) -> Value {
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

    /// A picture of the branches in the complex plane, and of their real and imaginary parts against the parameter.
    pub fn picture(&self, axes: Axes) -> Picture {
        let modes = (0..self.locus.branches().len()).map(|branch| self.mode(branch)).collect::<Vec<_>>();
        picture((&self.title, &self.name), &self.locus, (self.present, &modes), axes)
    }

    /// The components that are largest in the mode of a branch, the largest first.
    fn mode(&self, branch: usize) -> Vec<String> {
        let Some((place, modes)) = &self.modes else { return Vec::new() };
        let eigenvalue = self.locus.branches()[branch][*place];
        let mode = modes.iter().find(|mode| Some(mode.eigenvalue) == eigenvalue);
        let Some(vector) = mode.and_then(|mode| mode.vector.as_ref()) else { return Vec::new() };
        let sizes = vector.iter().map(|&(re, im)| re.hypot(im));
        let mut sized: Vec<(f64, &String)> = sizes.zip(&self.components).collect();
        sized.sort_by(|a, b| b.0.total_cmp(&a.0));
        let large = sized.into_iter().filter(|(size, _)| *size >= LARGE);
        large.take(MOST_NAMED).map(|(_, name)| name.clone()).collect()
    }
}

impl Tabulated for Locus {
    fn formats(&self) -> &'static [Format] {
        Format::OF_ARRAYS
    }

    fn write_as(&self, format: Format, out: &mut (impl Write + Seek + Send)) -> io::Result<()> {
        let contents = Contents {
            text: &|| self.text(),
            json: &|| self.json(),
            csv: &|| self.csv(),
            arrays: &|| of_locus(&self.locus),
            texts: &[("parameter", self.name.clone()), ("components", self.components.join(","))],
        };
        contents.write_as(format, out)
    }
}

/// A component of a mode that is a smaller part of the largest does not name it.
const LARGE: f64 = 0.2;
/// The largest number of components that name a mode.
const MOST_NAMED: usize = 3;

/// The value that a model gives to a parameter or start value.
fn present(model: &Model, name: &str) -> Option<f64> {
    let parameter = model.parameters().find(|(known, _)| *known == name).map(|(_, value)| value);
    parameter.or_else(|| {
        let place = model.start_names().iter().position(|known| known == name)?;
        model.start().ok()?.get(place).copied()
    })
}

/// The distance of a value from the nearest of a list.
fn distance_to(values: &[f64], from: f64) -> f64 {
    values.iter().map(|value| (value - from).abs()).fold(f64::INFINITY, f64::min)
}
