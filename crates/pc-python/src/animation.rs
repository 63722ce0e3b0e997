//! Pages for a browser: all that is known of a model, and its motion alone.

use pc_report::{Columns, Kind, Record, Samples, Scene, animation, report};
use pyo3::prelude::*;

use crate::system::SystemCore;

/// A motion as Python has it: times, then columns by their kinds.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Recorded {
    t: Vec<f64>,
    coordinates: Vec<(String, Vec<f64>)>,
    quasi_velocities: Vec<(String, Vec<f64>)>,
    states: Vec<(String, Vec<f64>)>,
    conserved: Vec<(String, Vec<f64>)>,
    outputs: Vec<(String, Vec<f64>)>,
    errors: Vec<(String, Vec<f64>)>,
    events: Vec<f64>,
    remark: Option<String>,
}

impl From<Recorded> for Record {
    fn from(recorded: Recorded) -> Record {
        let columns = |kind, list| Columns { kind, list };
        Record {
            rows: Samples {
                times: recorded.t,
                columns: vec![
                    columns(Kind::Coordinates, recorded.coordinates),
                    columns(Kind::QuasiVelocities, recorded.quasi_velocities),
                    columns(Kind::States, recorded.states),
                    columns(Kind::Conserved, recorded.conserved),
                    columns(Kind::Outputs, recorded.outputs),
                    columns(Kind::Errors, recorded.errors),
                ],
            },
            events: recorded.events,
            remark: recorded.remark,
            ..Record::default()
        }
    }
}

#[pymethods]
impl SystemCore {
    /// The page of a motion; None where there is nothing to be drawn.
    fn animation_page(&self, py: Python<'_>, recorded: Recorded) -> PyResult<Option<String>> {
        let record = Record::from(recorded);
        self.derive(py, move |model| {
            let graph = model.graph();
            let scene = Scene::of(model, &model.assemble(&graph)?, &record)?;
            Ok(scene.map(|scene| animation(model.title(), &scene)))
        })
    }

    /// The page of the model, with a motion where there is one.
    fn report_page(&self, py: Python<'_>, recorded: Option<Recorded>) -> PyResult<String> {
        let record = recorded.map(Record::from);
        self.derive(py, move |model| Ok(report(model, record.as_ref())?))
    }
}
