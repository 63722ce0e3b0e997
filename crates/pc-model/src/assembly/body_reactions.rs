//! Reactions as forces and torques on the bodies of a model.

use pc_mech::{Constraint, Expr, Multipliers, System};
use pc_nonholo::Redundant;

use crate::assembly::assembler::Assembler;
use crate::assembly::resultant::{force_names, torque_names};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;

/// The reactions on bodies, each component with its name.
#[derive(Default)]
struct Resultants<'g> {
    /// The components, apart from those of vectors that are identically zero.
    columns: Vec<(String, Expr<'g>)>,
    /// The symbols of all components with their values.
    known: Vec<(Expr<'g>, Expr<'g>)>,
    /// Descriptions of the reactions that virtual work leaves undetermined.
    undetermined: Vec<String>,
}

impl<'g> Assembler<'g, '_> {
    /// The system, with the forces and torques of the reactions on bodies substituted in its integrals and
    /// outputs, and descriptions of the undetermined reactions. If all reactions are to be observed, these
    /// forces and torques are added to the outputs.
    ///
    /// # Errors
    /// [`MeaningError::ForceNotDetermined`] if the model names an undetermined reaction.
    pub(crate) fn with_resultants(
        &self,
        system: System<'g>,
        multipliers: &Multipliers<'g>,
        redundant: &[Redundant],
    ) -> Result<(System<'g>, Vec<String>), ModelError> {
        let observes = self.model.observes_reactions();
        if system.bodies().is_empty() || !observes && self.scope.resultants.is_empty() {
            return Ok((system, Vec::new()));
        }
        let found = self.resultants(multipliers, redundant);
        self.check_determined(&found)?;
        let columns = if observes { found.columns } else { Vec::new() };
        Ok((system.with_observed(&found.known).with_more_outputs(columns), found.undetermined))
    }

    fn resultants(&self, multipliers: &Multipliers<'g>, redundant: &[Redundant]) -> Resultants<'g> {
        let mut all = Resultants::default();
        let binding: Vec<&str> = multipliers.constraints().iter().map(Constraint::name).collect();
        let bodies = multipliers.body_reactions();
        for body in &bodies {
            let name = body.body();
            if body.force(0).is_none() {
                all.undetermined.push(format!("the force on `{name}`"));
            }
            if body.turns() && body.torque(0).is_none() {
                all.undetermined.push(format!("the torque on `{name}`"));
            }
        }
        for (a, constraint) in binding.into_iter().enumerate() {
            for body in &bodies {
                self.note(&mut all, force_names(constraint, body.body()), body.force(a));
                self.note(&mut all, torque_names(constraint, body.body()), body.torque(a));
            }
        }
        // Dropped constraints have no reaction.
        for dropped in redundant {
            for body in &bodies {
                let names = [force_names, torque_names].map(|names| names(&dropped.constraint, body.body()));
                let symbols = names.concat().into_iter().map(|name| self.graph.symbol(&name));
                all.known.extend(symbols.map(|symbol| (symbol, Expr::ZERO)));
            }
        }
        all
    }

    fn note(&self, all: &mut Resultants<'g>, names: [String; 3], vector: Option<&[Expr<'g>]>) {
        let Some(vector) = vector else { return };
        let pairs: Vec<(String, Expr<'g>)> = names.into_iter().zip(vector.iter().copied()).collect();
        all.known.extend(pairs.iter().map(|(name, value)| (self.graph.symbol(name), *value)));
        if vector.iter().any(|component| !component.is_zero()) {
            all.columns.extend(pairs);
        }
    }

    /// Checks that virtual work determines the components named in the model.
    fn check_determined(&self, found: &Resultants<'g>) -> Result<(), ModelError> {
        let unknown = |symbol: &Expr<'g>| found.known.iter().all(|(known, _)| known != symbol);
        match self.scope.resultants.iter().find(|(symbol, _)| unknown(symbol)) {
            None => Ok(()),
            Some((symbol, place)) => Err(self
                .model
                .document()
                .error(place, MeaningError::ForceNotDetermined { name: symbol.to_string() })),
        }
    }
}
