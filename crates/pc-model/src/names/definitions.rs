//! Definitions, resolved in their order.

use std::collections::{BTreeMap, BTreeSet};

use pc_expr::Expr;
use pc_expr::parse::{Ast, AstKind};

use crate::diagnostics::error::ModelError;
use crate::names::scope::{Context, Scope};
use crate::names::stage::Stage;

impl<'g> Scope<'g, '_> {
    /// Resolves the definitions that are not used, which may contain anything that an output may contain.
    pub(crate) fn look_at_unused(&mut self) -> Result<(), ModelError> {
        let used: BTreeSet<usize> = self.definitions.keys().map(|&(_, place)| place).collect();
        for place in (0..self.document.definitions.len()).filter(|place| !used.contains(place)) {
            self.definition(place, Stage::Observation)?;
        }
        Ok(())
    }

    /// The meaning of each definition after the `replacements` are substituted; definitions that have
    /// different meanings in different places are left out.
    pub(crate) fn meanings(&self, replacements: &[(Expr<'g>, Expr<'g>)]) -> Vec<(String, Expr<'g>)> {
        let places: Vec<usize> = self.definitions.keys().map(|&(_, place)| place).collect();
        let values: Vec<Expr<'g>> = self.definitions.values().copied().collect();
        let values = self.graph.substitute(&values, replacements);
        let mut meanings: BTreeMap<usize, Option<Expr<'g>>> = BTreeMap::new();
        for (place, value) in places.into_iter().zip(values) {
            let meaning = meanings.entry(place).or_insert(Some(value));
            *meaning = meaning.filter(|known| *known == value);
        }
        let name = |place: usize| self.document.definitions[place].name.text.clone();
        meanings.into_iter().filter_map(|(place, value)| Some((name(place), value?))).collect()
    }

    /// The definition with index `place`, resolved after the definitions that it uses: these precede it, so
    /// that resolving all in order needs no deep recursion.
    pub(crate) fn definition(&mut self, place: usize, stage: Stage) -> Result<Expr<'g>, ModelError> {
        self.uses.push(((stage, place), self.context.clone()));
        if let Some(&value) = self.definitions.get(&(stage, place)) {
            return Ok(value);
        }
        let definitions = &self.document.definitions;
        let (mut open, mut needed) = (BTreeSet::from([place]), Vec::new());
        while let Some(last) = open.pop_last() {
            needed.push(last);
            for_each_name(&definitions[last].expression.ast, &mut |name| match self.places.get(name) {
                Some(&earlier) if earlier < last && !self.definitions.contains_key(&(stage, earlier)) => {
                    open.insert(earlier);
                }
                _ => {}
            });
        }
        let mut value = Expr::ZERO;
        for &place in needed.iter().rev() {
            let own = Context { definition: Some((stage, place)), branches: Vec::new() };
            let outer = std::mem::replace(&mut self.context, own);
            let resolved = self.resolve(&definitions[place].expression, stage);
            self.context = outer;
            value = resolved?;
            self.definitions.insert((stage, place), value);
        }
        Ok(value)
    }
}

/// Calls `visit` with each name in an expression.
fn for_each_name(ast: &Ast, visit: &mut impl FnMut(&str)) {
    match &ast.kind {
        AstKind::Number(_) | AstKind::Velocity(_) => {}
        AstKind::Name(name) => visit(name),
        AstKind::TotalDerivative(inner) | AstKind::Negate(inner) => for_each_name(inner, visit),
        AstKind::Sum(terms) => terms.iter().for_each(|(_, term)| for_each_name(term, visit)),
        AstKind::Product(factors) => factors.iter().for_each(|(_, factor)| for_each_name(factor, visit)),
        AstKind::Power(base, exponent) => [base, exponent].into_iter().for_each(|x| for_each_name(x, visit)),
        AstKind::Call(_, _, arguments) => arguments.iter().for_each(|x| for_each_name(x, visit)),
    }
}
