//! Names for long or repeated expressions on a page of theory, and its formulas written with them.

use std::ops::Range;

use pc_expr::{Folding, Given, Names, Style, Written};
use pc_mech::Expr;
use pc_model::Assembly;

use crate::language::latex::whole;
use crate::layout::layout::Layout;
use crate::theory::description::{Section, Side, Theory};

/// Writes all expressions of a page in order, using the names that the model defines for expressions of equal
/// value.
pub(crate) fn write<'g>(theory: &mut Theory<'g>, assembly: &Assembly<'g>) {
    let graph = assembly.system.graph();
    let page = graph.page(Folding::Structural);
    let system = &assembly.system;
    let parameters = system.parameters().iter().map(|(symbol, _)| symbol);
    for symbol in parameters.chain(system.frame().coordinates()).chain(system.quasi_velocities()) {
        page.symbol(&symbol.symbol_name().unwrap_or_default());
    }
    let set = |e: Expr<'g>| graph.typeset(&[e], &page)[0];
    let definitions = assembly.definitions.iter();
    let given: Vec<Given<'_>> = definitions
        .map(|(name, value)| Given { name: name.clone(), value: set(*value), shorthand: false })
        .collect();
    let expressions =
        theory.sections.iter().map(|section| section.expressions().map(set).collect::<Vec<_>>());
    let lines: Vec<Vec<Expr<'_>>> = expressions.collect();
    let sides: Vec<pc_expr::Side<'_>> = lines.iter().flatten().copied().map(pc_expr::Side::Sum).collect();
    let names = page.names(&sides, &given, Layout::default().room());
    let written = [Style::Book, Style::Latex, Style::Text, Style::MathMl].map(|style| names.written(style));
    let mut first = 0;
    for (section, lines) in theory.sections.iter_mut().zip(&lines) {
        section.write(&names, &written, lines, first..first + lines.len());
        first += lines.len();
    }
}

impl<'g> Section<'g> {
    fn expressions(&self) -> impl Iterator<Item = Expr<'g>> + '_ {
        let sides =
            self.entries.iter().flat_map(|entry| &entry.formulas).flat_map(|(left, right)| [left, right]);
        sides.filter_map(|side| side.expression)
    }

    /// Writes the expressions on these lines of the page, and the names first used on one of them.
    fn write(
        &mut self,
        names: &Names<'_>,
        [book, latex, text, mathml]: &[Written; 4],
        expressions: &[Expr<'_>],
        lines: Range<usize>,
    ) {
        let here = names.list().iter().filter(|name| lines.contains(&name.line));
        let meaning = |name: &pc_expr::Name<'_>| {
            let side = |write: &dyn Fn(&Written) -> String| {
                let (book, latex, text) = (write(book), whole(write(latex)), write(text));
                Side { expression: None, book, latex, text, mathml: write(mathml) }
            };
            (
                side(&|written| written.name(&name.name)),
                side(&|written| written.meaning(name.value).join(" ")),
            )
        };
        self.names = here.map(meaning).collect();
        let formulas = self.entries.iter_mut().flat_map(|entry| &mut entry.formulas);
        let sides = formulas.flat_map(|(left, right)| [left, right]);
        for (side, &e) in sides.filter(|side| side.expression.is_some()).zip(expressions) {
            (side.book, side.latex, side.text) = (book.line(e), whole(latex.line(e)), text.line(e));
            side.mathml = mathml.line(e);
        }
    }
}
