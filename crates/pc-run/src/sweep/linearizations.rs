//! Finds the eigenvalues of each member.

use std::ops::Range;

use pc_analysis::{Eigenvalue, Linearization};
use pc_model::{Model, Variables};
use pc_solve::{Ending, Ensemble, EnsembleError};
use pc_verify::Outlet;

use super::design::Design;
use super::members::{Members, message};
use super::record::{Record, Status};
use super::shard::Shard;
use super::work::{Consume, Work};
use crate::category::Category;
use crate::error::RunError;
use crate::linear::linearizable::Linearizable;
use crate::linear::near::Varied;
use crate::linear::state::{Cyclic, StateChoice};
use crate::motion::remarks::say_dropped;
use crate::motion::verification::compared;
use crate::observer::Observer;
use crate::table::rows::{CellKind, Column};

/// Linearizes the equations of each member at a state near its start.
pub(crate) struct Linearizations {
    members: Members,
    varied: Varied,
    /// The largest number of eigenvalues that a member may have.
    most: usize,
}

impl Linearizations {
    /// # Errors
    /// [`RunError`] if the equations of the unchanged model cannot be linearized.
    pub(crate) fn new(
        model: Model,
        design: Design,
        state: &StateChoice,
        observer: &dyn Observer,
    ) -> Result<Self, RunError> {
        let (varied, most) = {
            let graph = model.graph();
            let mut ground = Linearizable::new(&model, &graph)?;
            say_dropped(&ground.assembly, observer);
            let varied = Varied::of(&model, &ground, state);
            let most = varied.most_components(&mut ground)?;
            (varied, most)
        };
        let numbers = (1..=most).flat_map(|i| [format!("re{i}"), format!("im{i}")]);
        let mut columns: Vec<Column> = numbers.map(|name| Column::new(name, CellKind::Number)).collect();
        columns.push(Column::new("stability", CellKind::Text));
        Ok(Linearizations { members: Members::new(model, design, columns), varied, most })
    }

    /// Everything, apart from the model, on which the numbers depend.
    pub(crate) fn depends_on(state: &StateChoice) -> [(&'static str, String); 3] {
        [
            ("--at", state.at.word().to_owned()),
            ("--hold", state.hold.join(", ")),
            ("--cyclic", state.cyclic.map_or("not given", Cyclic::word).to_owned()),
        ]
    }

    fn record(&self, member: u64) -> Option<Record> {
        if self.members.is_over() {
            return None;
        }
        let blank = self.members.blank(member);
        let refused = |status, message: &str, blank| self.members.ended(status, message, blank);
        match self.varied.linearization(&self.members.model(&blank)) {
            Ok(linear) if linear.components.len() > self.most => {
                let (found, most) = (linear.components.len(), self.most);
                let message = format!(
                    "{found} eigenvalues, where the model as it is has {most}: the constraints have another rank here"
                );
                refused(Status::Refused, &message, blank)
            }
            Ok(linear) => Some(Record {
                status: Status::Completed,
                rows: parts(linear.spectrum.eigenvalues(), self.most),
                words: vec![stability(&linear)],
                ..blank
            }),
            Err(error) => {
                let nothing_found = error.category() == Category::Failed;
                let status = if nothing_found { Status::Failed } else { Status::Refused };
                refused(status, &message(&error), blank)
            }
        }
    }
}

/// The real and imaginary parts, padded if there are fewer than `most`.
fn parts(eigenvalues: &[Eigenvalue], most: usize) -> Vec<f64> {
    let mut parts: Vec<f64> = eigenvalues.iter().flat_map(|value| [value.real, value.imaginary]).collect();
    parts.resize(2 * most, f64::NAN);
    parts
}

/// The word for the verdict of the first approximation.
fn stability(linear: &Linearization) -> String {
    if linear.is_steady { linear.spectrum.verdict().to_string() } else { "not steady".to_owned() }
}

impl Work for Linearizations {
    fn members(&self) -> &Members {
        &self.members
    }

    fn vouched(&self) -> Result<(), RunError> {
        for model in self.members.samples() {
            let graph = model.graph();
            // A member that is refused says so in its record.
            let Ok(assembly) = model.assemble(&graph) else { continue };
            compared(&model, &assembly, Outlet::Equations(Variables::QuasiVelocities))?;
        }
        Ok(())
    }

    fn records(
        &self,
        ensemble: &Ensemble<'_>,
        shard: Shard,
        places: Range<u64>,
        consume: Consume<'_>,
    ) -> Result<Ending, EnsembleError> {
        ensemble.map(places, |place, _| self.record(shard.member(place)), consume)
    }
}
