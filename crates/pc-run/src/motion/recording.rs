//! Prepares a run for pages and pictures.

use std::ops::Range;

use pc_report::{ColumnKind, Columns, Recording, Samples};

use crate::motion::run::{Ending, Run};
use crate::motion::summary;
use crate::motion::table::Table;
use crate::motion::verification::Verification;
use pc_print::short;

impl Run {
    /// The run in the form that pages and pictures require.
    pub fn record(&self) -> Recording {
        let at = || short(self.statistics.current_time, 6);
        let remark = match &self.ending {
            Ending::Completed => None,
            Ending::Event { name } => Some(format!("The event {name} ended the motion.")),
            Ending::Failed(_) => {
                Some(format!("The motion failed at t = {}; what was reached is shown.", at()))
            }
            ending => {
                Some(format!("The motion was {} at t = {}; what was reached is shown.", ending.word(), at()))
            }
        };
        Recording {
            rows: samples(&self.table),
            fine: self.fine.as_ref().map(samples),
            summary: summary::entries(self)
                .into_iter()
                .map(|(label, lines)| (label.to_owned(), lines))
                .collect(),
            keeps_energy: self.keeps_energy,
            agrees: self.verification.as_ref().is_some_and(Verification::agrees),
            events: self.occurrences.iter().map(|occurrence| occurrence.time).collect(),
            units: self.units.clone(),
            remark,
        }
    }
}

fn samples(table: &Table) -> Samples {
    let columns = |kind, places: Range<usize>| Columns {
        kind,
        list: places.map(|j| (table.columns()[j].clone(), table.column(j).collect())).collect(),
    };
    Samples {
        times: table.column(0).collect(),
        columns: vec![
            columns(ColumnKind::Coordinates, table.coordinates()),
            columns(ColumnKind::QuasiVelocities, table.quasi_velocities()),
            columns(ColumnKind::States, table.states()),
            columns(ColumnKind::Conserved, table.conserved()),
            columns(ColumnKind::Outputs, table.outputs()),
            columns(ColumnKind::Derivatives, table.derivatives()),
            columns(ColumnKind::Errors, table.errors()),
        ],
    }
}
