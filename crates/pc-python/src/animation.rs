//! Pages for a browser: one with everything that is known about a model, and one with its motion alone; and the panels of a
//! picture.

use pc_report::picture::{Content, Panel, Picture, Scale, Wanted};
use pc_report::{ColumnKind, Columns, Recording, Samples, Scene, animation, report};
use pyo3::prelude::*;

use crate::system::SystemCore;

/// A motion as Python passes it: times, then columns by kind.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Recorded {
    t: Vec<f64>,
    coordinates: Vec<(String, Vec<f64>)>,
    quasi_velocities: Vec<(String, Vec<f64>)>,
    states: Vec<(String, Vec<f64>)>,
    conserved: Vec<(String, Vec<f64>)>,
    outputs: Vec<(String, Vec<f64>)>,
    derivatives: Vec<(String, Vec<f64>)>,
    errors: Vec<(String, Vec<f64>)>,
    events: Vec<f64>,
    keeps_energy: bool,
    remark: Option<String>,
}

impl From<Recorded> for Recording {
    fn from(recorded: Recorded) -> Recording {
        let columns = |kind, list| Columns { kind, list };
        Recording {
            rows: Samples {
                times: recorded.t,
                columns: vec![
                    columns(ColumnKind::Coordinates, recorded.coordinates),
                    columns(ColumnKind::QuasiVelocities, recorded.quasi_velocities),
                    columns(ColumnKind::States, recorded.states),
                    columns(ColumnKind::Conserved, recorded.conserved),
                    columns(ColumnKind::Outputs, recorded.outputs),
                    columns(ColumnKind::Derivatives, recorded.derivatives),
                    columns(ColumnKind::Errors, recorded.errors),
                ],
            },
            events: recorded.events,
            keeps_energy: recorded.keeps_energy,
            remark: recorded.remark,
            ..Recording::default()
        }
    }
}

/// Curves on common axes, as Python draws them: title, scale of the vertical axis, times of events, and the curves with their
/// names.
type Drawn = (String, &'static str, Vec<f64>, Vec<(String, Vec<f64>, Vec<f64>)>);

/// The panels of a motion, whose curves are grouped by kind and scale.
#[pyfunction]
pub(crate) fn panels_of(title: &str, recorded: Recorded) -> Vec<Drawn> {
    // Without a choice no column is unknown.
    let picture = Picture::of(title, &recorded.into(), &Wanted::default());
    picture.map_or_else(|_| Vec::new(), |picture| picture.panels.into_iter().map(drawn).collect())
}

fn drawn(panel: Panel) -> Drawn {
    let scale = match panel.up.1 {
        Scale::Linear => "linear",
        Scale::Decades | Scale::SignedDecades(_) => "decades",
        Scale::Angles => "angles",
    };
    let curves = match panel.content {
        Content::Curves(curves) => curves,
        Content::Fan(_) | Content::Roots(_) | Content::Bars(_) | Content::Cells { .. } => Vec::new(),
    };
    let curve = |curve: pc_report::picture::Curve| {
        let (across, up) = curve.points.into_iter().unzip();
        (curve.name, across, up)
    };
    (panel.title, scale, panel.events, curves.into_iter().map(curve).collect())
}

#[pymethods]
impl SystemCore {
    /// The page of a motion; `None` if there is nothing to draw.
    #[pyo3(name = "_animation_page")]
    fn animation_page(&self, py: Python<'_>, recorded: Recorded) -> PyResult<Option<String>> {
        let record = Recording::from(recorded);
        self.derive(py, move |model| {
            model.derived(|assembly| {
                let scene = Scene::of(model, assembly, &record)?;
                Ok(scene.map(|scene| animation(model.title(), &scene)))
            })
        })
    }

    /// The page of the model, with a motion if there is one.
    #[pyo3(name = "_report_page")]
    fn report_page(&self, py: Python<'_>, recorded: Option<Recorded>) -> PyResult<String> {
        let record = recorded.map(Recording::from);
        self.derive(py, move |model| model.derived(|assembly| Ok(report(model, assembly, record.as_ref())?)))
    }
}
