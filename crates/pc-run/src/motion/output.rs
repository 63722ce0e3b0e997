//! Writes the table of a run.

use std::io::{self, Seek, Write};

use pc_solve::Occurrence;
use serde_json::{Map, Value, json};

use crate::motion::run::Run;
use crate::motion::summary;
use crate::motion::table::Table;
use crate::table::chosen::Chosen;
use crate::table::format::Format;
#[cfg(feature = "parquet")]
use crate::table::parquet;
use crate::table::rows::{Cell, CellKind, Column, Rows, Take};
use crate::table::tabulated::Tabulated;
use crate::table::{csv, json, npz};

impl Rows for Table {
    fn columns(&self) -> Vec<Column> {
        Table::columns(self).iter().map(|name| Column::new(name, CellKind::Number)).collect()
    }

    fn count(&self) -> Option<u64> {
        Some(self.len() as u64)
    }

    fn each(&self, take: Take<'_>) -> io::Result<()> {
        let mut cells = Vec::new();
        self.rows().try_for_each(|row| {
            cells.clear();
            cells.extend(row.iter().copied().map(Cell::Number));
            take(&cells)
        })
    }

    fn each_of(&self, j: usize, take: &mut dyn FnMut(Cell<'_>) -> io::Result<()>) -> io::Result<()> {
        self.column(j).try_for_each(|value| take(Cell::Number(value)))
    }
}

impl Tabulated for Run {
    fn formats(&self) -> &'static [Format] {
        Format::OF_TABLES
    }

    /// Writes the table, with parameters, events and summary if the format can hold them.
    fn write_as(&self, format: Format, out: &mut (impl Write + Seek + Send)) -> io::Result<()> {
        let table = Chosen { table: &self.table, places: &self.written };
        match format {
            Format::Json => self.write_json(&table, out),
            Format::Npz => npz::write(&table, &self.times_of_events(), out),
            #[cfg(feature = "parquet")]
            Format::Parquet => parquet::write("motion", &table, &self.said_of_columns(), out),
            Format::Text | Format::Csv | Format::Mat => csv::write(&table, out),
        }
    }
}

impl Run {
    fn write_json(&self, table: &dyn Rows, out: &mut dyn Write) -> io::Result<()> {
        let parameters: Map<String, Value> =
            self.parameters.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
        let mut before = vec![("model", json!(self.title)), ("parameters", Value::from(parameters))];
        before.extend(self.units().map(|units| ("units", units)));
        let occurred = |occurrence: &Occurrence| json!({ "name": self.events[occurrence.event], "time": occurrence.time });
        let events = (!self.events.is_empty())
            .then(|| ("events", self.occurrences.iter().map(occurred).collect::<Value>()));
        let after: Vec<(&str, Value)> =
            events.into_iter().chain([("summary", summary::json(self))]).collect();
        json::write(&before, table, &after, out)
    }

    /// The units of the columns that have one, by their names; none if no column has.
    fn units(&self) -> Option<Value> {
        let columns = Table::columns(&self.table);
        let is_column = |name: &&(String, String)| self.written.iter().any(|&j| columns[j] == name.0);
        let units: Map<String, Value> =
            self.units.iter().filter(is_column).map(|(name, unit)| (name.clone(), json!(unit))).collect();
        (!units.is_empty()).then_some(Value::from(units))
    }

    /// What a file says of the columns besides their names.
    #[cfg(feature = "parquet")]
    fn said_of_columns(&self) -> Vec<(&'static str, String)> {
        self.units().map(|units| ("units", units.to_string())).into_iter().collect()
    }

    /// The times of each event, as lists called `events/NAME`.
    fn times_of_events(&self) -> Vec<(String, Vec<f64>)> {
        let times = |event: usize| {
            let occurrences = self.occurrences.iter().filter(|occurrence| occurrence.event == event);
            occurrences.map(|occurrence| occurrence.time).collect()
        };
        let events = self.events.iter().enumerate();
        events.map(|(event, name)| (format!("events/{name}"), times(event))).collect()
    }
}
