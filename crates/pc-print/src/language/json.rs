//! Equations for programs, as JSON.

use pc_expr::{Given, Names, Side, Style, Written};
use pc_mech::{Expr, Graph};
use serde_json::{Map, Value, json};

use crate::equations::constraints::kind_in_words;
use crate::equations::operations::Operations;
use crate::equations::principle::{ForceSheet, InertiaSheet};
use crate::equations::sheet::{Balance, Bracket, Sheet};
use crate::layout::layout::Layout;

/// The equations for programs. If canonical equations are not closed, there are no
/// `quasi_velocities_of_momenta`, and the quasi-velocities denote the solution of `momenta` =
/// `momenta_of_velocities`.
pub(crate) fn page(
    title: &str,
    sheet: &Sheet<'_>,
    operations: &Operations,
    layout: &Layout,
    page: &Graph,
) -> Value {
    let names = sheet.names(layout, page);
    let text = Text(names.written(Style::Text));
    let definitions: Vec<Value> = names
        .list()
        .iter()
        .map(|name| json!({ "name": name.name, "value": in_language(&text.0.meaning(name.value).join(" ")) }))
        .collect();
    let mut object = Map::new();
    let mut put = |key: &str, value: Value| _ = object.insert(key.to_owned(), value);
    put("model", json!(title));
    put("coordinates", text.list(&sheet.coordinates));
    put("quasi_velocities", text.list(&sheet.quasi_velocities));
    let parameters = sheet.parameters.iter().map(|(name, value)| (name.clone(), json!(value)));
    put("parameters", Value::Object(parameters.collect()));
    if !definitions.is_empty() {
        put("definitions", json!(definitions));
    }
    put("kinematics", json!({ "b": text.rows(&sheet.frame.0.to_rows()), "b_0": text.list(&sheet.frame.1) }));
    put("structure_coefficients", text.structure(sheet));
    if !sheet.states.is_empty() {
        let name = |rate: &Expr<'_>| rate.to_string().trim_end_matches('\'').to_owned();
        let states = sheet.states.iter().map(|(rate, value)| (name(rate), text.line(*value)));
        put("states", Value::Object(states.collect()));
    }
    if !sheet.changed.is_empty() {
        let changed = sheet.changed.iter().map(|(eta, value)| (eta.to_string(), text.line(*value)));
        put("quasi_velocity_definitions", Value::Object(changed.collect()));
    }
    if !sheet.constraints.is_empty() {
        let constraint = |(name, left, kind): &(String, Expr<'_>, _)| json!({ "name": name, "expression": text.line(*left), "kind": kind_in_words(*kind) });
        put("constraints", sheet.constraints.iter().map(constraint).collect());
    }
    let is_solved = matches!(sheet.balance, Balance::Velocities { .. });
    if (is_solved && !sheet.constraints.is_empty()) || !sheet.reactions.is_empty() {
        put("reactions", text.by_name(&sheet.reactions));
    }
    if !sheet.reaction_forces.is_empty() {
        put("reaction_forces", text.by_name(&sheet.reaction_forces));
    }
    match &sheet.balance {
        Balance::Velocities { mass, right, .. } => {
            put("mass_matrix", text.rows(&mass.to_rows()));
            put("equations", text.list(right));
        }
        Balance::Momenta { momenta, of_velocities, velocities, right, .. } => {
            put("momenta", text.list(momenta));
            put("closed", json!(velocities.is_some()));
            put("momenta_of_velocities", text.list(of_velocities));
            let solved = velocities.as_ref().map(|values| values.iter().map(|&eta| text.line(eta)));
            put("quasi_velocities_of_momenta", json!(solved.map(Iterator::collect::<Vec<_>>)));
            put("hamiltonian", text.line(sheet.energy));
            let rates: Vec<Expr<'_>> = sheet.rates.iter().map(|&(_, value)| value).collect();
            put("velocities", text.list(&rates));
            put("equations", text.list(right));
        }
        Balance::Maggi(maggi) => {
            put("lagrange_expressions", text.by_name(&maggi.expressions));
            put("vanishing", text.list(&maggi.sums));
        }
        Balance::Forces(forces) => {
            put("active_forces", text.list(&forces.active));
            match &forces.inertia {
                InertiaSheet::Forces(inertia) => put("inertia_forces", text.list(inertia)),
                InertiaSheet::Gibbs(function) => put("gibbs_function", text.line(*function)),
            }
            put("acceleration_terms", text.list(&forces.slopes));
        }
    }
    if !matches!(sheet.balance, Balance::Momenta { .. }) {
        put("energy", text.line(sheet.energy));
        if let Some(remark) = sheet.energy_remark {
            put("energy_remark", json!(remark));
        }
    }
    put("operations", operations.object());
    Value::Object(object)
}

/// The text in the expression language, in which x'' is written d(x').
fn in_language(text: &str) -> String {
    let mut pieces = text.split("''");
    let mut written = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let is_part = |c: char| c.is_alphanumeric() || c == '_';
        let begin = written
            .char_indices()
            .rev()
            .take_while(|&(_, c)| is_part(c))
            .last()
            .map_or(written.len(), |(i, _)| i);
        let name = written.split_off(begin);
        written += &format!("d({name}')");
        written += piece;
    }
    written
}

/// Expressions as JSON.
struct Text(Written);

impl Text {
    fn line(&self, expression: Expr<'_>) -> Value {
        json!(in_language(&self.0.line(expression)))
    }

    fn list(&self, expressions: &[Expr<'_>]) -> Value {
        expressions.iter().map(|&expression| self.line(expression)).collect()
    }

    fn by_name(&self, named: &[(Expr<'_>, Expr<'_>)]) -> Value {
        Value::Object(named.iter().map(|(name, value)| (name.to_string(), self.line(*value))).collect())
    }

    fn rows(&self, rows: &[Vec<Expr<'_>>]) -> Value {
        rows.iter().map(|row| self.list(row)).collect()
    }

    /// The coefficients c_rs^m that are not zero; r, s and m are given as names of quasi-velocities, with 0
    /// for time.
    fn structure(&self, sheet: &Sheet<'_>) -> Value {
        let name = |s: &usize| s.checked_sub(1).map_or("0", |s| sheet.brackets.operators[s].as_str());
        let coefficients = sheet.brackets.nonzero.iter().flat_map(|Bracket { pair: [r, s], components }| {
            components.iter().map(move |(m, c)| (r, s, m, c))
        });
        let coefficients = coefficients
            .map(|(r, s, m, c)| json!({ "r": name(r), "s": name(s), "m": name(m), "value": self.line(*c) }));
        coefficients.collect()
    }
}

impl<'p> Sheet<'p> {
    /// Names for long expressions in the output.
    fn names(&self, layout: &Layout, page: &'p Graph) -> Names<'p> {
        let (b, b_0) = &self.frame;
        let second = |pairs: &[(Expr<'p>, Expr<'p>)]| pairs.iter().map(|&(_, x)| x).collect::<Vec<_>>();
        let structure =
            self.brackets.nonzero.iter().flat_map(|bracket| bracket.components.iter().map(|&(_, c)| c));
        let mut all: Vec<Expr<'p>> = [b.entries().into_owned(), b_0.clone(), structure.collect()].concat();
        all.extend(second(&self.states));
        all.extend(second(&self.changed));
        all.extend(self.constraints.iter().map(|&(_, left, _)| left));
        all.extend(second(&self.reactions).into_iter().chain(second(&self.reaction_forces)));
        match &self.balance {
            Balance::Velocities { mass, right, .. } => {
                all.extend([mass.entries().into_owned(), right.clone(), vec![self.energy]].concat());
            }
            Balance::Momenta { of_velocities, velocities, right, .. } => {
                let velocities = velocities.clone().unwrap_or_default();
                all.extend([of_velocities.clone(), velocities, vec![self.energy]].concat());
                all.extend([second(&self.rates), right.clone()].concat());
            }
            Balance::Maggi(maggi) => {
                all.extend(second(&maggi.expressions).into_iter().chain(maggi.sums.iter().copied()));
                all.push(self.energy);
            }
            Balance::Forces(forces) => all.extend(forces.expressions().into_iter().chain([self.energy])),
        }
        let given: &[Given<'p>] = if layout.inline { &[] } else { &self.definitions };
        page.names(&all.into_iter().map(Side::Sum).collect::<Vec<_>>(), given, layout.room())
    }
}

impl<'p> ForceSheet<'p> {
    /// All expressions.
    fn expressions(&self) -> Vec<Expr<'p>> {
        let inertia = match &self.inertia {
            InertiaSheet::Forces(inertia) => inertia.clone(),
            InertiaSheet::Gibbs(function) => vec![*function],
        };
        [self.active.clone(), inertia, self.slopes.clone()].concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accelerations_are_read_back() {
        assert_eq!(in_language("2*x''*sin(φ) - ψ_1''^2 + x'"), "2*d(x')*sin(φ) - d(ψ_1')^2 + x'");
        assert_eq!(in_language("a + b"), "a + b");
    }
}
