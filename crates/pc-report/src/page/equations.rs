//! The equations of motion in every form that applies.

use pc_model::{Assembly, ModelError, Variables};
use pc_print::{DisplayedEquations, Extent, Form, Layout, displayed_equations};

use crate::page::formulas;
use crate::page::html::{lines, paragraph, text};

/// The number of operations of one right-hand side beyond which further forms take more than a second to derive, and that beyond
/// which Poincaré's equations do.
const MOST_IN_FORMS: usize = 300;
pub(super) const MOST_OPERATIONS: usize = 2500;

/// Equations that take more bytes than this are left to `pc derive`, so that a page is not too long.
const LONGEST: usize = 120_000;

/// Poincaré's equations, followed by the other forms.
pub(super) fn equations(
    title: &str,
    assembly: &Assembly<'_>,
    layout: &Layout,
    extent: Extent,
) -> Result<String, ModelError> {
    if !extent.allows(MOST_OPERATIONS) {
        return Ok(paragraph("The equations are too long to be shown here; pc derive prints them."));
    }
    let first = displayed_equations(Form::Poincare, layout, title, assembly)?;
    let (mut shown, mut long, mut refused) = (String::new(), Vec::new(), Vec::new());
    let mut show = |equations: &DisplayedEquations, form: Form| match self::form(equations) {
        Some(whole) => shown += &whole,
        None => long.push(format!("{} (pc derive --form {})", equations.name, form.name())),
    };
    show(&first, Form::Poincare);
    let (derived, left) = match extent.allows(MOST_IN_FORMS) {
        true => (others(assembly), Vec::new()),
        false => (Vec::new(), others(assembly)),
    };
    for other in derived {
        match displayed_equations(other, layout, title, assembly) {
            Ok(equations) => show(&equations, other),
            // An exhausted limit ends the work; a form that the model does not have is left out.
            Err(error) => match assembly.within_limits() {
                Err(limit) => return Err(limit),
                Ok(()) => refused.push(format!("{}: {error}", other.name())),
            },
        }
    }
    if !left.is_empty() {
        let all: Vec<String> = left.iter().map(|form| format!("pc derive --form {}", form.name())).collect();
        shown += "<h3>Further forms</h3>\n";
        let all = all.join(", ");
        shown +=
            &paragraph(&format!("They take long to derive, and are left to {all}, or pc report --full."));
    }
    if !long.is_empty() {
        let all = long.join(", ");
        shown += "<h3>Longer forms</h3>\n";
        shown += &paragraph(&format!("Too long to be shown here, but printed by the program: {all}."));
    }
    if !refused.is_empty() {
        shown += "<h3>Forms that do not apply</h3>\n";
        shown += &refused.iter().map(|why| paragraph(why)).collect::<String>();
    }
    Ok(shown)
}

/// The forms that may differ from Poincaré's equations.
fn others(assembly: &Assembly<'_>) -> Vec<Form> {
    let system = &assembly.system;
    if system.large_tree().is_some() {
        return Vec::new(); // printed from body to body, in one form
    }
    let mut forms = vec![Form::Canonical];
    let reduced = assembly.free_form(Variables::Reduced).ok();
    let fewer = |count: usize| count < system.frame().coordinates().len();
    if reduced.is_some_and(|reduced| fewer(reduced.system.frame().coordinates().len())) {
        forms.extend([Form::Reduced, Form::LiePoisson]);
    }
    let eta = system.quasi_velocities();
    let velocities = system.frame().velocities(eta);
    let bound = assembly.constraints.multipliers().is_some();
    if bound || velocities != eta {
        forms.push(Form::Lagrange);
    }
    if bound && assembly.constraints.nonlinear().is_none() {
        forms.push(Form::Voronets);
    }
    forms
}

/// The equations in one form, unless they are too long.
pub(super) fn form(equations: &DisplayedEquations) -> Option<String> {
    let mut shown = format!("<h3>{}</h3>\n", text(&capitalised(&equations.name)));
    match &equations.plain {
        Some((whole, latex)) => {
            shown += &format!("<pre tabindex=\"0\">{}</pre>\n", lines(whole));
            shown += &formulas::source(latex);
        }
        None => shown += &formulas::parts(&equations.parts, 4),
    }
    if shown.len() > LONGEST {
        return None;
    }
    if !equations.operations.is_empty() {
        shown += "<h4>Operations of one right-hand side</h4>\n";
        shown += &equations.operations.iter().map(|line| paragraph(line)).collect::<String>();
    }
    Some(shown)
}

fn capitalised(name: &str) -> String {
    let mut chars = name.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().chain(chars).collect())
}
