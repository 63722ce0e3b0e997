//! Linearizations and equilibria of a model.

use pc_model::deep;
use pc_run::linear::found::{Found, Search};
use pc_run::linear::linearized::Linearized;
use pc_run::linear::locus::Locus;
use pc_run::linear::state::{At, Cyclic, StateChoice};
use pc_run::linear::trim::Trimmed;
use pc_run::observer::Nobody;
use pc_run::sweep::values::{Values, Vary};
use pyo3::prelude::*;

use crate::error::Error;
use crate::model::{ModelCore, renewed};
use crate::task::attended;

/// The state about which equations are linearized, as given in a mapping of Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Chosen {
    at: String,
    hold: Vec<String>,
    cyclic: Option<String>,
}

impl Chosen {
    fn choice(self) -> Result<StateChoice, Error> {
        let at = At::ALL.into_iter().find(|at| at.word() == self.at).ok_or_else(|| Error::Choice {
            what: "the state",
            given: self.at.clone(),
            known: At::ALL.map(At::word).to_vec(),
        })?;
        let cyclic = self.cyclic.map(|given| {
            Cyclic::ALL.into_iter().find(|cyclic| cyclic.word() == given).ok_or_else(|| Error::Choice {
                what: "the choice of cyclic coordinates",
                given,
                known: Cyclic::ALL.map(Cyclic::word).to_vec(),
            })
        });
        Ok(StateChoice { at, hold: self.hold, cyclic: cyclic.transpose()? })
    }
}

impl ModelCore {
    /// What `work` finds, as a text for people and as a JSON object.
    fn found(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&pc_model::Model, bool) -> Result<(String, String), Error> + Send + 'static,
    ) -> PyResult<(String, String)> {
        let (mut model, verify) = (self.model.clone(), self.verify);
        let cancel = renewed(&mut model);
        attended(py, &cancel, |_| Ok(()), move || deep(|| work(&model, verify)))
    }
}

#[pymethods]
impl ModelCore {
    /// The linearization at the chosen state, as text and JSON.
    fn linearized(&self, py: Python<'_>, chosen: Chosen) -> PyResult<(String, String)> {
        let choice = chosen.choice()?;
        self.found(py, move |model, verify| {
            let linear = Linearized::of(model, &choice, verify, &Nobody)?;
            Ok((linear.text(), linear.json().to_string()))
        })
    }

    /// The eigenvalues for some values of a parameter or start value, as text and JSON.
    fn locus(
        &self,
        py: Python<'_>,
        name: String,
        values: Vec<f64>,
        chosen: Chosen,
    ) -> PyResult<(String, String)> {
        let (choice, vary) = (chosen.choice()?, Vary { name, values: Values::List(values) });
        self.found(py, move |model, verify| {
            let locus = Locus::of(model, &vary, &choice, verify, &Nobody)?;
            Ok((locus.text(), locus.json().to_string()))
        })
    }

    /// The state and the inputs at rest or in steady motion, found with some of them free, as text and JSON.
    fn trimmed(&self, py: Python<'_>, free: Vec<String>) -> PyResult<(String, String)> {
        self.found(py, move |model, verify| {
            let trimmed = Trimmed::of(model, &free, verify, &Nobody)?;
            Ok((trimmed.text(), trimmed.json().to_string()))
        })
    }

    /// The equilibria between bounds, as text and JSON.
    fn equilibria(
        &self,
        py: Python<'_>,
        bounds: Vec<(String, f64, f64)>,
        starts: usize,
    ) -> PyResult<(String, String)> {
        let search = Search { bounds, starts };
        self.found(py, move |model, verify| {
            let found = Found::of(model, &search, verify, &Nobody)?;
            Ok((found.text(), found.json().to_string()))
        })
    }
}
