//! The constraints of a model: sorted, checked at the start, and put where they are cheapest to keep.

use pc_mech::{Constraint, Expr, MechError, System, VectorField};
use pc_nonholo::{Constrained, Kind, NonholoError, Sorted};

use super::Assembler;
use crate::bound::{Bound, Form, Held, Verdict};
use crate::document::{self, ConstraintKind};
use crate::error::ModelError;
use crate::fault::Fault;
use crate::scope::Stage;

/// A start that misses a constraint by less is rounding of the numbers it is written with.
const OFF: f64 = 1e-8;

/// A constraint of the text with its expression, x' still symbols.
pub(super) struct Written<'g> {
    place: usize,
    value: Expr<'g>,
    /// The quasi-velocity that it is, where it defines one.
    defines: Option<Expr<'g>>,
}

impl<'g> Written<'g> {
    /// The quasi-velocity that it defines.
    pub(super) fn defines(&self) -> Option<Expr<'g>> {
        self.defines
    }

    /// Its place in the section.
    pub(super) fn place(&self) -> usize {
        self.place
    }

    /// Its expression, x' still symbols.
    pub(super) fn value(&self) -> Expr<'g> {
        self.value
    }
}

impl<'g> Assembler<'g, '_> {
    /// The entries of `[constraints]`. Where quasi-velocities are defined by `is`, each constraint that contains an x'
    /// defines one more.
    pub(super) fn constraints(&mut self) -> Result<Vec<Written<'g>>, ModelError> {
        let document = self.model.document();
        let defining = document.quasi_velocities.iter().any(|q| q.is.is_some());
        let velocities = self.scope.velocities();
        let mut written = Vec::new();
        for (place, constraint) in document.constraints.iter().enumerate() {
            let value = self.scope.resolve(&constraint.expression, Stage::Constraint)?;
            let moves = defining && velocities.iter().any(|&v| value.depends_on(v));
            let defines = moves.then(|| self.graph.symbol(&self.unused(&constraint.name.text)));
            written.push(Written { place, value, defines });
        }
        Ok(written)
    }

    /// The name of a constraint, made longer where it is that of something else.
    fn unused(&self, label: &str) -> String {
        let document = self.model.document();
        let parameters = document.parameters.iter().map(|p| &p.name.text);
        let coordinates = document.coordinates.iter().map(|c| &c.name.text);
        let quasi_velocities = document.quasi_velocities.iter().map(|q| &q.name.text);
        let taken: Vec<&String> = parameters.chain(coordinates).chain(quasi_velocities).collect();
        let mut name = label.to_owned();
        while taken.contains(&&name) || name == "t" {
            name.push('_');
        }
        name
    }

    /// How the constraints bind the system, and the start on them; `at` are values of all symbols there.
    pub(super) fn bound(
        &self,
        system: &System<'g>,
        written: &[Written<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
        at: &[(Expr<'g>, f64)],
        (t_start, start): (f64, &mut Vec<f64>),
    ) -> Result<Bound<'g>, ModelError> {
        if written.is_empty() {
            return Ok(Bound::free());
        }
        let constraints: Vec<Constraint<'g>> = written
            .iter()
            .map(|w| {
                let value = self.graph.substitute(&[w.value], x_dot)[0];
                Constraint::new(self.text_of(w).name.text.clone(), w.defines.unwrap_or(value))
            })
            .collect();
        let sorted = Sorted::new(system, &constraints, at).map_err(|error| self.blame(error))?;
        let verdicts = self.verdicts(&sorted)?;
        if self.model.projects_start()
            && let Some(multipliers) = sorted.multipliers()
        {
            let projected =
                multipliers.compile().map_err(|error| self.blame(error.into())).and_then(|mut motion| {
                    let refused = |failure: pc_mech::Failure| self.blame(MechError::from(failure).into());
                    motion.project(t_start, start).map_err(refused)
                });
            projected?;
        }
        self.check_start(system, written, &constraints, t_start, start)?;

        let eta = system.quasi_velocities();
        let vanishing: Option<Vec<Expr<'g>>> = sorted.multipliers().and_then(|multipliers| {
            let bare = |c: &Constraint<'g>| eta.iter().copied().find(|&eta| eta == c.expression());
            multipliers.constraints().iter().map(bare).collect()
        });
        let redundant = sorted.redundant().to_vec();
        let Some(multipliers) = sorted.multipliers() else { return Ok(Bound::nothing(redundant)) };
        let form = match vanishing {
            Some(eta) => {
                Form::Vanishing(Box::new(Constrained::new(system, &eta).map_err(|error| self.blame(error))?))
            }
            None => {
                let held = Held { multipliers: multipliers.clone(), holonomic: sorted.is_holonomic() };
                Form::Held(Box::new(held))
            }
        };
        Ok(Bound::new(form, multipliers.clone(), verdicts, redundant))
    }

    fn text_of(&self, written: &Written<'g>) -> &document::Constraint {
        &self.model.document().constraints[written.place]
    }

    /// What each binding constraint does, unless the text says otherwise.
    fn verdicts(&self, sorted: &Sorted<'g>) -> Result<Vec<Verdict>, ModelError> {
        let Some(multipliers) = sorted.multipliers() else { return Ok(Vec::new()) };
        let named = |name: &str| self.model.document().constraints.iter().find(|c| c.name.text == name);
        multipliers
            .constraints()
            .iter()
            .zip(sorted.kinds())
            .map(|(constraint, &kind)| {
                let given = named(constraint.name()).and_then(|text| text.kind.as_ref());
                if let (Some(given), Kind::Nonholonomic { residual }) = (given, kind)
                    && given.value == ConstraintKind::Holonomic
                {
                    let constraint = constraint.name().to_owned();
                    return Err(self.model.error(&given.place, Fault::NotHolonomic { constraint, residual }));
                }
                Ok(Verdict { constraint: constraint.name().to_owned(), kind })
            })
            .collect()
    }

    fn check_start(
        &self,
        system: &System<'g>,
        written: &[Written<'g>],
        constraints: &[Constraint<'g>],
        t_start: f64,
        start: &[f64],
    ) -> Result<(), ModelError> {
        let state = system.frame().coordinates().iter().chain(system.quasi_velocities()).copied();
        let mut values: Vec<(Expr<'g>, f64)> = system.parameters().to_vec();
        values.push((system.frame().time(), t_start));
        values.extend(state.zip(start.iter().copied()));
        for (written, constraint) in written.iter().zip(constraints) {
            let text = self.text_of(written);
            for (what, value) in
                [("", constraint.expression()), ("the rate of ", constraint.velocity(system))]
            {
                let residual = self.graph.evaluate(&[value], &values).map_or(f64::NAN, |values| values[0]);
                if residual.abs() <= OFF {
                    continue;
                }
                let constraint = text.name.text.clone();
                let fault = Fault::OffConstraint { what, constraint, residual };
                return Err(self.model.error(&text.expression.place(text.expression.ast.span), fault));
            }
        }
        Ok(())
    }

    /// The error at the constraint that is to blame.
    fn blame(&self, error: NonholoError) -> ModelError {
        let named = |name: &String| self.model.document().constraints.iter().find(|c| c.name.text == *name);
        let name = match &error {
            NonholoError::Contradictory { constraint, .. }
            | NonholoError::Mech(
                MechError::ConstraintNotAffine { constraint }
                | MechError::DependentConstraint { constraint }
                | MechError::SingularConstraint { constraint, .. },
            ) => named(constraint),
            NonholoError::Mech(MechError::NoProjection { constraints, .. }) => {
                constraints.first().and_then(named)
            }
            NonholoError::Mech(MechError::TooManyConstraints { .. }) => {
                self.model.document().constraints.last()
            }
            _ => None,
        };
        match (name, error) {
            (Some(text), error) => {
                let message = error.to_string();
                self.model
                    .error(&text.expression.place(text.expression.ast.span), Fault::Constraint { message })
            }
            (None, NonholoError::Mech(error)) => self.model.derivation_error(error),
            (None, other) => {
                let message = other.to_string();
                self.model.error(&self.model.document().end(), Fault::Constraint { message })
            }
        }
    }
}
