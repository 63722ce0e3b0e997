//! Motions of models.

use pc_mech::{Graph, VectorField};
use pc_model::{Document, Flow, Model, Source, Variables};
use pc_solve::{Method, Options, solve};
use pc_tests::verified::derived_twice;

pub(crate) fn document(text: &str) -> Document {
    Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}"))
}

/// The model of a text, derived a second time.
#[track_caller]
pub(crate) fn model(text: &str) -> Model {
    derived_twice(document(text))
}

/// What is integrated of a model.
pub(crate) fn flow(model: &Model) -> Flow {
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    Flow::new(model, &assembly, Variables::QuasiVelocities).unwrap_or_else(|error| panic!("{error}"))
}

/// ẋ and η̇ at a state.
pub(crate) fn rates(flow: &mut Flow, t: f64, state: &[f64]) -> Vec<f64> {
    let mut rates = vec![f64::NAN; state.len()];
    flow.motion.rhs(t, state, &mut rates).unwrap();
    rates
}

/// A table of a motion.
pub(crate) struct Run {
    pub(crate) names: Vec<String>,
    pub(crate) rows: Vec<Vec<f64>>,
}

impl Run {
    /// To times spaced evenly.
    pub(crate) fn of(model: &Model, end: f64, rtol: f64) -> Run {
        Run::of_flow(flow(model), end, rtol)
    }

    pub(crate) fn of_flow(mut flow: Flow, end: f64, rtol: f64) -> Run {
        let times: Vec<f64> = (0..=20).map(|i| end * f64::from(i) / 20.0).collect();
        let options = Options::new(Method::Adams)
            .relative_tolerance(rtol)
            .absolute_tolerance(rtol / 100.0)
            .max_steps(1_000_000);
        let start = flow.start.clone();
        let trajectory = solve(&mut flow.motion, 0.0, &start, &times, &options).unwrap();
        let names = flow.names.iter().chain(flow.motion.observable_names()).cloned().collect();
        let rows = trajectory.iter().map(|(t, state)| flow.row(t, state)).collect();
        Run { names, rows }
    }

    #[track_caller]
    pub(crate) fn column(&self, name: &str) -> Vec<f64> {
        let place = self.names.iter().position(|known| known == name);
        let place = place.unwrap_or_else(|| panic!("{name} is none of {:?}", self.names));
        self.rows.iter().map(|row| row[place]).collect()
    }
}

/// The largest difference of two lists, relative to what is larger than 1.
pub(crate) fn difference(one: &[f64], two: &[f64]) -> f64 {
    assert_eq!(one.len(), two.len());
    let apart = one.iter().zip(two).map(|(a, b)| (a - b).abs() / a.abs().max(1.0));
    apart.fold(0.0, |largest, this| if this <= largest { largest } else { this })
}
