//! The table of a motion: t, coordinates, quasi-velocities, first-order states, integrals, energy, outputs,
//! derivatives, errors.

use pc_model::Flow;
use pc_solve::Trajectory;

use crate::motion::sensitivities::Derivatives;

/// A row for each output time.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    columns: Vec<String>,
    coordinates: usize,
    quasi_velocities: usize,
    states: usize,
    conserved: usize,
    derivatives: usize,
    /// The number of columns of errors: the number of columns between t and the derivatives, or zero.
    errors: usize,
    /// The values, one row after the other.
    values: Vec<f64>,
    /// A record of the rows, if they were written as they were computed: then `values` contains only the last
    /// one.
    streamed: Option<Streamed>,
}

/// The values of a column that are not finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotFinite {
    /// The first value that is not finite.
    pub value: f64,
    /// The time of the first of these values.
    pub t: f64,
    /// How many rows have no finite value.
    pub rows: usize,
}

impl NotFinite {
    /// Counts another value, if it is not finite.
    fn note(known: Option<NotFinite>, t: f64, value: f64) -> Option<NotFinite> {
        match known {
            _ if value.is_finite() => known,
            None => Some(NotFinite { value, t, rows: 1 }),
            Some(known) => Some(NotFinite { rows: known.rows + 1, ..known }),
        }
    }
}

/// A record of rows that were written as they were computed.
#[derive(Clone, Debug, PartialEq)]
struct Streamed {
    rows: usize,
    start: Vec<f64>,
    /// The largest changes since the start.
    worst: Vec<f64>,
    /// The values that were not finite, column by column.
    not_finite: Vec<Option<NotFinite>>,
}

impl Table {
    /// The table of the states of a trajectory, in quasi-velocities, with the observables of its motion.
    pub fn new(flow: &mut Flow, trajectory: &Trajectory) -> Table {
        Table::with_derivatives(flow, trajectory, None)
    }

    /// The same table, with further columns of derivatives.
    pub(crate) fn with_derivatives(
        flow: &mut Flow,
        trajectory: &Trajectory,
        derivatives: Option<&Derivatives>,
    ) -> Table {
        let more = derivatives.map_or_else(Vec::new, |derivatives| derivatives.columns(flow));
        let mut table = Table::empty(flow, more);
        let mut values = Vec::with_capacity(table.columns.len() * trajectory.len());
        for (i, (t, y)) in trajectory.iter().enumerate() {
            values.push(t);
            values.extend(flow.row(t, y));
            values.extend(derivatives.map_or_else(Vec::new, |derivatives| derivatives.row(flow, i, t, y)));
        }
        table.values = values;
        table
    }

    /// A table with the rows of these states.
    pub(crate) fn of_states(flow: &mut Flow, states: impl IntoIterator<Item = (f64, Vec<f64>)>) -> Table {
        let mut table = Table::of(flow);
        for (t, y) in states {
            table.values.push(t);
            table.values.extend(flow.row(t, &y));
        }
        table
    }

    /// A table whose rows are written as they are computed.
    pub(crate) fn streamed(flow: &Flow) -> Table {
        let streamed = Streamed { rows: 0, start: Vec::new(), worst: Vec::new(), not_finite: Vec::new() };
        Table { streamed: Some(streamed), ..Table::of(flow) }
    }

    /// Replaces the last row by the row of a state.
    pub(crate) fn give(&mut self, flow: &mut Flow, t: f64, y: &[f64]) {
        self.values.clear();
        self.values.push(t);
        self.values.extend(flow.row(t, y));
        let Some(streamed) = &mut self.streamed else { return };
        if streamed.rows == 0 {
            streamed.start.clone_from(&self.values);
            streamed.worst = vec![0.0; self.values.len()];
            streamed.not_finite = vec![None; self.values.len()];
        }
        streamed.rows += 1;
        for (worst, (value, start)) in streamed.worst.iter_mut().zip(self.values.iter().zip(&streamed.start))
        {
            *worst = raised(*worst, value - start);
        }
        for (known, &value) in streamed.not_finite.iter_mut().zip(&self.values) {
            *known = NotFinite::note(*known, t, value);
        }
    }

    /// A table without rows; its columns are those of the flow that will compute them.
    pub(crate) fn of(flow: &Flow) -> Table {
        Table::empty(flow, Vec::new())
    }

    fn empty(flow: &Flow, more: Vec<String>) -> Table {
        let derivatives = more.len();
        let columns = std::iter::once("t".to_owned()).chain(flow.columns()).chain(more).collect();
        Table {
            columns,
            coordinates: flow.motion.coordinates(),
            quasi_velocities: flow.quasi_velocities(),
            states: flow.motion.states(),
            conserved: flow.motion.conserved_len(),
            derivatives,
            errors: 0,
            values: Vec::new(),
            streamed: None,
        }
    }

    /// Names of the columns, `t` first.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.streamed.as_ref().map_or(self.values.len() / self.columns.len(), |streamed| streamed.rows)
    }

    /// Whether there are no rows.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The rows in order; if they were written as they were computed, only the last one.
    pub fn rows(&self) -> impl DoubleEndedIterator<Item = &[f64]> + ExactSizeIterator {
        self.values.chunks_exact(self.columns.len())
    }

    /// The values in column number `j`, counted from 0.
    pub fn column(&self, j: usize) -> impl ExactSizeIterator<Item = f64> + Clone + '_ {
        self.values.chunks_exact(self.columns.len()).map(move |row| row[j])
    }

    /// The values of column number `j` that are not finite, if any.
    pub fn not_finite(&self, j: usize) -> Option<NotFinite> {
        match &self.streamed {
            Some(streamed) => streamed.not_finite.get(j).copied().flatten(),
            None => self.rows().fold(None, |known, row| NotFinite::note(known, row[0], row[j])),
        }
    }

    /// The numbers of the columns that are coordinates.
    pub fn coordinates(&self) -> std::ops::Range<usize> {
        1..1 + self.coordinates
    }

    /// The numbers of the columns that are quasi-velocities.
    pub fn quasi_velocities(&self) -> std::ops::Range<usize> {
        let start = self.coordinates().end;
        start..start + self.quasi_velocities
    }

    /// The numbers of the columns that are first-order states.
    pub fn states(&self) -> std::ops::Range<usize> {
        let start = self.quasi_velocities().end;
        start..start + self.states
    }

    /// The numbers of the columns that are integrals, with the energy last.
    pub fn conserved(&self) -> std::ops::Range<usize> {
        let start = self.states().end;
        start..start + self.conserved
    }

    /// The numbers of the columns that are outputs of the model, including reactions.
    pub fn outputs(&self) -> std::ops::Range<usize> {
        self.conserved().end..self.columns.len() - self.derivatives - self.errors
    }

    /// The numbers of the columns that are derivatives with respect to parameters.
    pub fn derivatives(&self) -> std::ops::Range<usize> {
        let start = self.outputs().end;
        start..start + self.derivatives
    }

    /// The numbers of the columns that are errors, in the order of the columns to which they belong.
    pub fn errors(&self) -> std::ops::Range<usize> {
        self.derivatives().end..self.columns.len()
    }

    /// The number of the column that contains the errors of column `j`, if there is one.
    pub fn error_of(&self, j: usize) -> Option<usize> {
        let errors = self.errors();
        (1..=errors.len()).contains(&j).then(|| errors.start + j - 1)
    }

    /// The largest magnitude of column `j`.
    pub fn largest(&self, j: usize) -> f64 {
        self.column(j).fold(0.0, |largest, value| value.abs().max(largest))
    }

    /// Appends columns of errors, whose values in each row are computed by `errors` from the number of the
    /// row and the row itself.
    pub(crate) fn append_errors(
        &mut self,
        names: Vec<String>,
        mut errors: impl FnMut(usize, &[f64]) -> Vec<f64>,
    ) {
        let mut values = Vec::with_capacity(self.values.len() + self.len() * names.len());
        for (i, row) in self.rows().enumerate() {
            values.extend_from_slice(row);
            values.extend(errors(i, row));
        }
        self.errors = names.len();
        self.columns.extend(names);
        self.values = values;
    }

    /// The drift of column `j`: max |I(t) − I(t_start)| over the rows.
    pub fn drift(&self, j: usize) -> Drift {
        let (start, absolute) = match &self.streamed {
            Some(streamed) if streamed.rows > 0 => (streamed.start[j], streamed.worst[j]),
            _ => {
                let start = self.column(j).next().unwrap_or(f64::NAN);
                (start, self.column(j).fold(0.0f64, |worst, value| raised(worst, value - start)))
            }
        };
        // A ratio means nothing where the start value is no larger than the drift.
        Drift { start, absolute, relative: (absolute < start.abs()).then(|| absolute / start.abs()) }
    }
}

/// The largest change so far or another one, whichever is larger (f64::max would lose a NaN).
pub(crate) fn raised(worst: f64, change: f64) -> f64 {
    let change = change.abs();
    if change > worst || change.is_nan() { change } else { worst }
}

/// How far a quantity moved from its start value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// I(t_start)
    pub start: f64,
    /// max |I(t) − I(t_start)|
    pub absolute: f64,
    /// The absolute drift divided by |I(t_start)|; none unless |I(t_start)| is larger than the drift.
    pub relative: Option<f64>,
}
