//! The structure coefficients that a model gives.

use pc_algebra::affine;
use pc_mech::{AlgebraError, Expr, LieAlgebra, Number, StructureCoefficients};

use super::Assembler;
use crate::document::{AlgebraDefinition, Bracket};
use crate::error::ModelError;
use crate::fault::Fault;
use crate::scope::Stage;

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
                    AlgebraError::UnknownAlgebra { name: wrong, known } => {
                        self.model.error(&name.place, Fault::UnknownAlgebra { name: wrong, known })
                    }
                    other => self.model.algebra_error(other),
                })?;
                if algebra.dim() != eta.len() {
                    let (dimension, operators) = (algebra.dim(), eta.len());
                    let fault = Fault::AlgebraDimension { name: name.value.clone(), dimension, operators };
                    return Err(self.model.error(&name.place, fault));
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
                    let fault = Fault::UnknownName { name: name.text.clone(), known };
                    Err(self.model.error(&name.place, fault))
                }
            }
        };
        let mut table: Vec<((usize, usize), Vec<Number>)> = Vec::new();
        for bracket in brackets {
            let pair = (index(&bracket.left)?, index(&bracket.right)?);
            let value = self.scope.resolve(&bracket.value, Stage::Kinematics)?;
            let linear = affine(self.graph, value, eta).filter(|(_, rest)| rest.is_zero());
            let constants: Option<Vec<Number>> =
                linear.and_then(|(coefficients, _)| coefficients.iter().map(|c| c.constant()).collect());
            let Some(constants) = constants else {
                let fault = |text| Fault::BracketNotLinear { text };
                return Err(self.scope.error(&bracket.value, bracket.value.ast.span, fault));
            };
            let opposite: Vec<Number> = constants.iter().map(|&c| -c).collect();
            if table.iter().any(|(other, known)| *other == (pair.1, pair.0) && *known != opposite) {
                let (left, right) = (bracket.left.text.clone(), bracket.right.text.clone());
                return Err(self.model.error(&bracket.left.place, Fault::BracketsNotSkew { left, right }));
            }
            table.push((pair, constants));
        }
        let constant = |r: usize, s: usize, m: usize| -> Number {
            let direct = table.iter().find(|(pair, _)| *pair == (r, s)).map(|(_, c)| c[m]);
            let reverse = || table.iter().find(|(pair, _)| *pair == (s, r)).map(|(_, c)| -c[m]);
            direct.or_else(reverse).unwrap_or(Number::ZERO)
        };
        let algebra = LieAlgebra::new(k, |r, s, m| constant(r + 1, s + 1, m));
        let structure = algebra.and_then(|algebra| algebra.with_time(|s, m| constant(0, s + 1, m)));
        structure.map_err(|error| self.model.algebra_error(error))
    }
}
