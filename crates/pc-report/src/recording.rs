//! The data of a motion for a report.

use pc_expr::parse::nearest;

/// The kinds of columns of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ColumnKind {
    /// Coordinates x.
    Coordinates,
    /// Quasi-velocities η.
    QuasiVelocities,
    /// First-order states.
    States,
    /// Integrals, the energy last.
    Conserved,
    /// Outputs of the model, including reactions.
    Outputs,
    /// Derivatives with respect to parameters.
    Derivatives,
    /// Estimated global errors of other columns.
    Errors,
}

/// Columns of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// Their kind.
    pub kind: ColumnKind,
    /// The columns, each with its name and its values, one for each time.
    pub list: Vec<(String, Vec<f64>)>,
}

/// Values at some times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples {
    /// The times of the values.
    pub times: Vec<f64>,
    /// The values, with one entry for each kind that is present.
    pub columns: Vec<Columns>,
}

/// The data of a motion, as far as it was computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The samples of the table, evenly spaced like the stills of a film.
    pub rows: Samples,
    /// Samples as dense as smooth curves require, if there are any.
    pub fine: Option<Samples>,
    /// The summary of the motion, as lines with labels; it is the same on every run.
    pub summary: Vec<(String, Vec<String>)>,
    /// Whether the energy, the last of the conserved columns, is an integral.
    pub keeps_energy: bool,
    /// Whether it was compared with a second derivation, and agrees.
    pub agrees: bool,
    /// The times at which events occurred.
    pub events: Vec<f64>,
    /// The units of columns, as pairs of names.
    pub units: Vec<(String, String)>,
    /// The reason why there is no motion, or how it ended if it was not completed.
    pub remark: Option<String>,
}

/// A requested column does not exist.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no column `{name}`;{} the columns are {}", meant(name, known), known.join(", "))]
pub struct UnknownColumn {
    /// The requested name.
    pub name: String,
    /// The known names.
    pub known: Vec<String>,
}

/// A question whether another name is meant, if one is near.
fn meant(name: &str, known: &[String]) -> String {
    let nearest = nearest(name, known.iter().map(String::as_str));
    nearest.map_or_else(String::new, |nearest| format!(" did you mean `{nearest}`?"))
}

impl Samples {
    /// The kind and the values of the column with this name.
    ///
    /// # Errors
    /// [`UnknownColumn`]
    pub(crate) fn column(&self, name: &str) -> Result<(ColumnKind, &[f64]), UnknownColumn> {
        let all =
            || self.columns.iter().flat_map(|columns| columns.list.iter().map(move |c| (columns.kind, c)));
        match all().find(|(_, (known, _))| known == name) {
            Some((kind, (_, values))) => Ok((kind, values)),
            None => {
                let known = all().map(|(_, (name, _))| name.clone()).collect();
                Err(UnknownColumn { name: name.to_owned(), known })
            }
        }
    }
}

impl Recording {
    /// The samples through which curves are drawn.
    pub(crate) fn curves(&self) -> &Samples {
        self.fine.as_ref().unwrap_or(&self.rows)
    }
}
