//! The structure coefficients that a model gives.

use pc_algebra::affine;
use pc_mech::{AlgebraError, Expr, LieAlgebra, StructureCoefficients};

use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{AlgebraDefinition, Bracket};
use crate::names::stage::Stage;

impl<'g> Assembler<'g, '_> {
    /// The structure coefficients given in `[algebra]`.
    pub(super) fn structure(
        &mut self,
        eta: &[Expr<'g>],
    ) -> Result<Option<StructureCoefficients<'g>>, ModelError> {
        let Some(algebra) = &self.model.document().algebra else { return Ok(None) };
        match &algebra.definition {
            AlgebraDefinition::Catalogue(name) => {
                let algebra = LieAlgebra::named(&name.value).map_err(|error| match error {
                    AlgebraError::UnknownAlgebra { name: wrong, known } => self
                        .model
                        .document()
                        .error(&name.place, MeaningError::UnknownAlgebra { name: wrong, known }),
                    other => self
                        .model
                        .document()
                        .error(&name.place, MeaningError::Derivation { message: other.to_string() }),
                })?;
                if algebra.dim() != eta.len() {
                    let (dimension, operators) = (algebra.dim(), eta.len());
                    let fault =
                        MeaningError::AlgebraDimension { name: name.value.clone(), dimension, operators };
                    return Err(self.model.document().error(&name.place, fault));
                }
                Ok(Some(algebra.structure_coefficients()))
            }
            AlgebraDefinition::Brackets(brackets) => self.structure_of(brackets, eta).map(Some),
        }
    }

    fn structure_of(
        &mut self,
        brackets: &[Bracket],
        eta: &[Expr<'g>],
    ) -> Result<StructureCoefficients<'g>, ModelError> {
        let k = eta.len();
        let index = |name: &crate::document::Name| -> Result<usize, ModelError> {
            let declared = &self.model.document().quasi_velocities;
            match declared.iter().position(|q| q.name.text == name.text) {
                Some(s) => Ok(s + 1),
                None if name.text == "t" => Ok(0),
                None => {
                    let known =
                        declared.iter().map(|q| q.name.text.clone()).chain(["t".to_owned()]).collect();
                    let fault = MeaningError::UnknownName { name: name.text.clone(), known };
                    Err(self.model.document().error(&name.place, fault))
                }
            }
        };
        let mut table: Vec<((usize, usize), Vec<Expr<'g>>)> = Vec::new();
        for bracket in brackets {
            let pair = (index(&bracket.left)?, index(&bracket.right)?);
            let value = self.scope.resolve(&bracket.value, Stage::Kinematics)?;
            let still = |c: &Expr<'g>| self.coordinates().iter().all(|&x| !c.depends_on(x));
            let linear = affine(self.graph, value, eta).filter(|(_, rest)| rest.is_zero());
            let Some(constants) = linear.map(|(c, _)| c).filter(|c| c.iter().all(still)) else {
                let fault = |text| MeaningError::BracketNotLinear { text };
                return Err(self.scope.error(&bracket.value, bracket.value.ast.span, fault));
            };
            let is_opposite =
                |known: &[Expr<'g>]| known.iter().zip(&constants).all(|(&a, &b)| (a + b).is_zero());
            if table.iter().any(|(other, known)| *other == (pair.1, pair.0) && !is_opposite(known)) {
                let (left, right) = (bracket.left.text.clone(), bracket.right.text.clone());
                return Err(self
                    .model
                    .document()
                    .error(&bracket.left.place, MeaningError::BracketsNotSkew { left, right }));
            }
            table.push((pair, constants));
        }
        let entry = |r: usize, s: usize, m: usize| -> Expr<'g> {
            let direct = table.iter().find(|(pair, _)| *pair == (r, s)).map(|(_, c)| c[m]);
            let reverse = || table.iter().find(|(pair, _)| *pair == (s, r)).map(|(_, c)| -c[m]);
            direct.or_else(reverse).unwrap_or(Expr::ZERO)
        };
        Ok(StructureCoefficients::new(k, entry))
    }

    fn coordinates(&self) -> Vec<Expr<'g>> {
        self.model.document().coordinates.iter().map(|x| self.graph.symbol(&x.name.text)).collect()
    }
}
