//! Routh's reduction by cyclic coordinates.

use pc_analysis::Routhian;
use pc_mech::{Expr, Style};
use pc_model::ModelError;

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side};

/// The section on the momenta of cyclic coordinates, the Routhian, and the equations that remain.
pub(crate) fn section<'g>(ground: &Basis<'_, 'g>) -> Result<Section<'g>, ModelError> {
    let section =
        |entries| Ok(Section { key: "routh", title: "Routh's reduction", names: Vec::new(), entries });
    if !ground.is_unbound() {
        return section(Vec::new());
    }
    let found = ground.placed(Routhian::of(&ground.free, &ground.near.centre))?;
    let Some(routh) = found else { return section(Vec::new()) };
    let graph = ground.free.graph();
    let momenta = routh.momenta.iter().zip(&routh.momenta_of_velocities);
    let mut entries: Vec<Entry<'g>> =
        momenta.map(|(&p, &value)| Entry::formula(Side::of(p), Side::of(value))).collect();
    let rates = routh.cyclic.iter().zip(&routh.rates);
    entries.extend(
        rates.map(|(x, &rate)| Entry::formula(Side::of(graph.symbol(&format!("{x}'"))), Side::of(rate))),
    );
    entries.push(Entry::formula(Side::letter("R"), Side::of(routh.routhian)));
    let Some(system) = &routh.system else {
        entries.push(Entry::words("all coordinates are cyclic: their rates are functions of time alone"));
        return section(entries);
    };
    let equations = ground.assembly.placed(system.poincare())?;
    let sides = [Style::Book, Style::Latex, Style::Text, Style::MathMl].map(|style| equations.balance(style));
    let side = |i: usize, of: fn(&(String, String)) -> &String| {
        let [book, latex, text, mathml] = [0, 1, 2, 3].map(|style: usize| of(&sides[style][i]).clone());
        Side { expression: None, book, latex, text, mathml }
    };
    let count = sides[0].len();
    entries.extend((0..count).map(|i| Entry::formula(side(i, |pair| &pair.0), side(i, |pair| &pair.1))));
    let at_start = |p: &Expr<'_>| {
        let value = system.parameters().iter().find(|(known, _)| known == p);
        value.map(|&(_, value)| (p.to_string(), value))
    };
    let values = routh.momenta.iter().filter_map(at_start).collect();
    entries.push(Entry { values, ..Entry::words("constants of the motion, with their values at the start") });
    section(entries)
}
