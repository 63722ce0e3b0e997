//! Errors of the derivation, located at the entry of the file that causes them.

use pc_mech::{
    AlgebraError, ConstraintError, ExprError, FrameError, Graph, IntegralError, LagrangianError, MechError,
};
use pc_nonholo::NonholoError;

use crate::deep::deep;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::source::Place;
use crate::document::{AlgebraDefinition, Bracket, Constraint, Document};

impl Document {
    /// Runs `work` in a graph. If the graph's budget is spent before or during `work`, the result is an error
    /// that says so, whatever `work` returns.
    pub(crate) fn stage<T>(
        &self,
        graph: &Graph,
        name: &'static str,
        work: impl FnOnce() -> Result<T, ModelError>,
    ) -> Result<T, ModelError> {
        match deep(|| graph.stage(name, || Ok::<_, ExprError>(work()))) {
            Ok(done) => done,
            Err(ExprError::Spent { what, stage, nodes }) => {
                Err(self.error(&self.energy_place(), ErrorKind::Spent { what, stage, nodes }))
            }
            Err(other) => Err(self.derivation_error(other.into())),
        }
    }

    /// Locates an error of the derivation under constraints at the entry of the file that causes it.
    pub(crate) fn constraint_error(&self, error: NonholoError) -> ModelError {
        let message = error.to_string();
        let cannot = |name: &str, help| {
            self.constraint_fault(name, MeaningError::Constraint { message: message.clone(), help })
        };
        let last = self.constraints.last().map_or("", |constraint| constraint.name.text.as_str());
        match error {
            NonholoError::Contradictory { constraint, .. } => {
                cannot(&constraint, "no motion satisfies it; correct it or leave it out")
            }
            NonholoError::Nonlinear { constraint, .. } => {
                cannot(&constraint, "use a form with multipliers: poincare, lagrange, or canonical")
            }
            NonholoError::Mech(MechError::Constraint(error)) => match error {
                ConstraintError::NotAffine { constraint } => {
                    let text = self.constraint_text(&constraint).map(|c| c.expression.text.clone());
                    let text = text.unwrap_or_default();
                    let fault = MeaningError::ConstraintNotAffine { constraint: constraint.clone(), text };
                    self.constraint_fault(&constraint, fault)
                }
                ConstraintError::TooMany { .. } => cannot(
                    last,
                    "there must be fewer independent constraints than velocities, or nothing moves",
                ),
                ConstraintError::Dependent { constraint } => {
                    cannot(&constraint, "leave out what follows from other constraints")
                }
                ConstraintError::TwoSlips { constraint } => {
                    cannot(&constraint, "write `creep = \"v\"`, a velocity far below those of interest")
                }
                ConstraintError::Singular { constraint, .. } => {
                    cannot(&constraint, "start where the constraints are independent of each other")
                }
                ConstraintError::NoProjection { constraints, .. } => cannot(
                    constraints.first().map_or(last, String::as_str),
                    "start nearer to a state that satisfies them, if there is one",
                ),
                ConstraintError::NotIndependent { .. } => cannot(
                    last,
                    "choose as many as the constraints leave free: quasi-velocities of the model, velocities x' for lagrange and voronets",
                ),
                ConstraintError::Jumps { ref constraint, .. } => {
                    self.constraint_fault(constraint, MeaningError::Jumps { message: message.clone() })
                }
                other => self.derivation_error(other.into()),
            },
            NonholoError::Mech(error) => self.derivation_error(error),
            NonholoError::NotAQuasiVelocity { .. }
            | NonholoError::Twice { .. }
            | NonholoError::NotInVelocities => cannot(last, "check [constraints]"),
        }
    }

    /// The text of a constraint.
    pub(crate) fn constraint_text(&self, name: &str) -> Option<&Constraint> {
        self.constraints.iter().find(|constraint| constraint.name.text == name)
    }

    /// An error about a constraint, located at its expression.
    pub(crate) fn constraint_fault(&self, name: &str, fault: MeaningError) -> ModelError {
        let expression = self.constraint_text(name).map(|constraint| &constraint.expression);
        let place = expression.map(|expression| expression.place(expression.ast.span));
        self.error(&place.unwrap_or_else(|| self.end()), fault)
    }

    /// Locates an error of the derivation at the entry of the file that causes it.
    pub(crate) fn derivation_error(&self, error: MechError) -> ModelError {
        if let Some(&ExprError::Spent { what, stage, nodes }) = error.of_expressions() {
            return self.error(&self.energy_place(), ErrorKind::Spent { what, stage, nodes });
        }
        match error {
            MechError::Lagrangian(LagrangianError::Degenerate { rank, size, quasi_velocities }) => {
                let fault = MeaningError::Degenerate { rank, size, undetermined: quasi_velocities };
                self.error(&self.energy_place(), fault)
            }
            MechError::Lagrangian(LagrangianError::Jumps { .. } | LagrangianError::MomentumJumps { .. }) => {
                self.error(&self.energy_place(), MeaningError::Jumps { message: error.to_string() })
            }
            MechError::Frame(FrameError::Jumps { .. }) => {
                self.error(&self.operator_place(1), MeaningError::Jumps { message: error.to_string() })
            }
            error if error.is_of_dependent_coordinates() => {
                let help = "its forms are poincare, canonical, kane and gibbs-appell, in the quasi-velocities of the model";
                self.error(&self.energy_place(), MeaningError::NoForm { message: error.to_string(), help })
            }
            error if error.is_not_quadratic() => {
                let help = "its forms are poincare and, where the coordinates are independent, lagrange";
                self.error(&self.energy_place(), MeaningError::NoForm { message: error.to_string(), help })
            }
            MechError::Lagrangian(LagrangianError::NoCoriolisMatrix { .. }) => {
                let help = "the kinetic energy of bodies is quadratic in the velocities; such a matrix belongs to it alone";
                self.error(&self.energy_place(), MeaningError::NoForm { message: error.to_string(), help })
            }
            MechError::Algebra(error) => self.algebra_error(error),
            MechError::Integral(IntegralError::Unknown { name, known }) => {
                self.error(&self.kept_place(&name), MeaningError::UnknownIntegral { name, known })
            }
            MechError::Integral(IntegralError::NotAnIntegral { name, t, rate }) => {
                self.error(&self.kept_place(&name), MeaningError::NotAnIntegral { name, t, rate })
            }
            other => {
                self.error(&self.energy_place(), MeaningError::Derivation { message: other.to_string() })
            }
        }
    }

    pub(crate) fn error(&self, place: &Place, kind: impl Into<ErrorKind>) -> ModelError {
        self.source.error(place, kind)
    }

    /// The place in the file that asks for an integral to be kept, or the place of its definition if the file does
    /// not ask for it.
    pub(crate) fn kept_place(&self, name: &str) -> Place {
        let written = self.simulation.project.iter().find(|written| written.value == name);
        let integral = || self.integrals.iter().find(|integral| integral.name.text == name);
        let defined = || integral().map(|integral| integral.name.place.clone());
        written.map(|name| name.place.clone()).or_else(defined).unwrap_or_else(|| self.energy_place())
    }

    pub(crate) fn energy_place(&self) -> Place {
        let document = self;
        let energy = document.lagrangian.as_ref().map(|l| &l.place);
        let hanging = || document.tree.first().map(|body| &body.place);
        let place = energy.or_else(|| document.bodies.first().map(|body| &body.place)).or_else(hanging);
        place.cloned().unwrap_or_else(|| document.end())
    }

    /// The name of operator number s, where operators are counted from 1 and 0 stands for time.
    fn operator_name(&self, s: usize) -> String {
        let declared = &self.quasi_velocities;
        match (s, declared.is_empty()) {
            (0, _) => "t".to_owned(),
            (_, false) => declared.get(s - 1).map_or_else(String::new, |q| q.name.text.clone()),
            (_, true) => {
                self.coordinates.get(s - 1).map_or_else(String::new, |x| format!("{}'", x.name.text))
            }
        }
    }

    pub(crate) fn operator_place(&self, s: usize) -> Place {
        let quasi_velocity = self.quasi_velocities.get(s.max(1) - 1);
        quasi_velocity.map_or_else(|| self.end(), |q| q.name.place.clone())
    }

    pub(crate) fn algebra_error(&self, error: AlgebraError) -> ModelError {
        let names = |pair: (usize, usize)| [self.operator_name(pair.0), self.operator_name(pair.1)];
        let brackets_of = |pair: (usize, usize)| -> Place {
            let algebra = self.algebra.as_ref();
            let brackets = match algebra.map(|a| &a.definition) {
                None => return self.operator_place(pair.1),
                Some(AlgebraDefinition::Catalogue(name)) => return name.place.clone(),
                Some(AlgebraDefinition::Brackets(brackets)) => brackets,
            };
            let section = algebra.map_or_else(|| self.end(), |a| a.place.clone());
            let [r, s] = names(pair);
            let matches = |b: &&Bracket| {
                (b.left.text == r && b.right.text == s) || (b.left.text == s && b.right.text == r)
            };
            brackets.iter().find(matches).map_or(section, |b| b.left.place.clone())
        };
        match error {
            AlgebraError::RankDeficient { rank, operators, pair } => self.error(
                &self.operator_place(pair.1),
                MeaningError::RankDeficient { rank, operators, pair: names(pair) },
            ),
            AlgebraError::Undetermined { combination, operators, .. } => {
                let last = combination.last().map_or(1, |&(s, _)| s);
                let names = (1..=operators).map(|s| self.operator_name(s)).collect();
                self.error(&self.operator_place(last), MeaningError::Undetermined { combination, names })
            }
            AlgebraError::NotClosed { pair, residual } => self
                .error(&self.operator_place(pair.1), MeaningError::NotClosed { pair: names(pair), residual }),
            AlgebraError::Contradiction { pair, residual } => {
                self.error(&brackets_of(pair), MeaningError::Contradiction { pair: names(pair), residual })
            }
            AlgebraError::Jacobi { triple: (r, s, u), component, defect } => {
                let triple = [r, s, u].map(|s| self.operator_name(s));
                let fault = MeaningError::Jacobi { triple, component: self.operator_name(component), defect };
                self.error(&brackets_of((r, s)), fault)
            }
            AlgebraError::AlgebraNeeded => self.error(&self.operator_place(1), MeaningError::AlgebraNeeded),
            other => {
                self.error(&self.operator_place(1), MeaningError::Derivation { message: other.to_string() })
            }
        }
    }
}
