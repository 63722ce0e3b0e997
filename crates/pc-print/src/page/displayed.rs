//! Equations and theory as displays for a web page, each with its LaTeX.

use pc_expr::{Folding, Given, Graph};
use pc_mech::{Expr, System};
use pc_model::{Assembly, Model, ModelError};

use crate::equations::constraints::kind_in_words;
use crate::equations::derived::Derived;
use crate::equations::form::Form;
use crate::equations::sheet::{Balance, Brackets, Sheet};
use crate::language::latex;
use crate::language::mathml::{self, Displayed, DisplayedEquation};
use crate::language::text::{LEFT_OUT, no_brackets};
use crate::layout::format::Page;
use crate::layout::layout::Layout;
use crate::layout::part::{Heading, Part, Parts, Row};
use crate::layout::remark::remark;
use crate::page::page::{page, sheet_of};
use crate::theory;
use crate::theory::description::{Section, Side, Theory};
use crate::theory::options::TheoryOptions;
use crate::words::words::short;

/// Formulas, one below the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Display {
    /// All formulas as one `math` element, with broken lines.
    pub mathml: String,
    /// The same formulas in LaTeX, for use with amsmath.
    pub latex: String,
    /// The meanings of the names that these formulas are the first to use.
    pub names: Vec<DisplayedEquation>,
    /// The formulas one by one, which a page may break where it wants to.
    pub equations: Vec<DisplayedEquation>,
}

impl Display {
    fn of(displayed: Displayed, latex: String) -> Display {
        let Displayed { table, names, equations } = displayed;
        Display { mathml: table, latex, names, equations }
    }
}

/// Formulas under a heading.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DisplayedPart {
    /// The heading.
    pub title: &'static str,
    /// The formulas under the heading, if there are any.
    pub display: Option<Display>,
    /// Notes on the formulas.
    pub notes: Vec<String>,
}

/// The equations of motion in one of their forms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DisplayedEquations {
    /// The name of the form.
    pub name: String,
    /// Its parts.
    pub parts: Vec<DisplayedPart>,
    /// All equations in plain text and in LaTeX, in place of the parts, if they are written body by body.
    pub plain: Option<(String, String)>,
    /// The cost of a right-hand side, line by line.
    pub operations: Vec<String>,
}

/// A part of the theory of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayedTheory {
    /// The name of the part, for programs.
    pub key: &'static str,
    /// The heading.
    pub title: &'static str,
    /// The meanings of the names in the formulas of the part.
    pub names: Vec<DisplayedEquation>,
    /// Its contents.
    pub entries: Vec<DisplayedEntry>,
    /// All formulas of the part in LaTeX.
    pub latex: Option<String>,
}

/// Formulas that belong together, with the results about them.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayedEntry {
    /// Its name.
    pub name: Option<String>,
    /// Its formulas, if there are any.
    pub formulas: Vec<DisplayedEquation>,
    /// The verdict on the formulas, in words: proved, disproved or open.
    pub verdict: Option<String>,
    /// Names with their numerical values.
    pub values: Vec<String>,
    /// Further sentences.
    pub words: Vec<String>,
    /// Real and imaginary parts of eigenvalues.
    pub spectrum: Vec<(f64, f64)>,
}

/// The data of the derivation: the operators X_s = b_is ∂/∂x_i of the frame and their brackets (5), T, U and
/// L, and the forces.
///
/// U is the value of L where all quasi-velocities vanish, and T = L − U; if the frame itself moves, L − U is
/// not just the kinetic energy, and only L is shown. For a large tree of bodies L is longer than a page and
/// is left out.
///
/// # Errors
/// [`ModelError`] if a limit is reached.
pub fn displayed_system(assembly: &Assembly<'_>, layout: &Layout) -> Result<Vec<DisplayedPart>, ModelError> {
    let (system, graph) = (&assembly.system, assembly.system.graph());
    let paper = graph.page(Folding::Structural);
    in_order(system, &paper);
    let one = |expression: Expr<'_>| graph.typeset(&[expression], &paper)[0];
    let brackets = Brackets::of(system, &[], &paper);
    let mut parts = vec![
        Part { heading: Heading::Operators, rows: operators(system, &paper) },
        Part {
            heading: Heading::Brackets,
            rows: brackets.nonzero.iter().cloned().map(Row::Bracket).collect(),
        },
    ];
    if system.large_tree().is_none() {
        let eta: Vec<(Expr<'_>, Expr<'_>)> =
            system.quasi_velocities().iter().map(|&eta| (eta, Expr::from(0.0))).collect();
        let lagrangian = system.lagrangian();
        let force_function = graph.substitute(&[lagrangian], &eta)[0];
        let mut rows = Vec::new();
        if system.frame().b0().iter().all(|b| b.is_zero()) {
            let both =
                graph.shorten(&[lagrangian - force_function, force_function], system.quasi_velocities());
            rows.push(Row::Function { letter: "T", value: one(both[0]) });
            rows.push(Row::Function { letter: "U", value: one(both[1]) });
        }
        rows.push(Row::Function { letter: "L", value: one(lagrangian) });
        parts.push(Part { heading: Heading::Lagrangian, rows });
        let forces = system.quasi_velocities().iter().zip(system.forces()).filter(|(_, q)| !q.is_zero());
        let forces = forces.map(|(eta, &q)| Row::Force {
            letter: "Q",
            quasi_velocity: eta.to_string(),
            value: one(q),
        });
        parts.push(Part { heading: Heading::Forces, rows: forces.collect() });
    }
    let given: Vec<Given<'_>> = assembly
        .definitions
        .iter()
        .map(|(name, value)| Given { name: name.clone(), value: one(*value), shorthand: false })
        .collect();
    let parts = Parts::named(parts, &given, layout, &paper);
    let mathml = mathml::displays(&brackets.operators, layout, &parts);
    let latex = latex::displays(&brackets.operators, layout, &parts);
    let mut displayed: Vec<DisplayedPart> = mathml
        .into_iter()
        .zip(latex)
        .map(|((part, mathml), (_, latex))| DisplayedPart {
            title: part.heading.text(),
            display: mathml.zip(latex).map(|(displayed, latex)| Display::of(displayed, latex)),
            notes: if part.heading == Heading::Brackets { algebra(&brackets) } else { Vec::new() },
        })
        .collect();
    if brackets.nonzero.is_empty() {
        let notes = vec![no_brackets(&brackets).to_owned()];
        displayed.insert(1, DisplayedPart { title: Heading::Brackets.text(), display: None, notes });
    }
    assembly.within_limits()?;
    Ok(displayed)
}

fn algebra(brackets: &Brackets<'_>) -> Vec<String> {
    brackets.algebra.map(|name| format!("the algebra {name}")).into_iter().collect()
}

/// Creates the symbols of the page in the order that a book would use.
fn in_order(system: &System<'_>, paper: &Graph) {
    let parameters = system.parameters().iter().map(|(symbol, _)| symbol);
    for symbol in parameters.chain(system.frame().coordinates()).chain(system.quasi_velocities()) {
        paper.symbol(&symbol.symbol_name().unwrap_or_default());
    }
}

/// X_0 = ∂/∂t + b_i0 ∂/∂x_i if the frame moves, and X_s.
fn operators<'p>(system: &System<'_>, paper: &'p Graph) -> Vec<Row<'p>> {
    let (frame, graph) = (system.frame(), system.graph());
    let one = |expression: Expr<'_>| graph.typeset(&[expression], paper)[0];
    let x = |i: usize| one(frame.coordinates()[i]);
    let along_time = frame.b0().iter().enumerate().filter(|(_, b)| !b.is_zero());
    let along_time: Vec<(Expr<'p>, Expr<'p>)> = along_time.map(|(i, &b)| (x(i), one(b))).collect();
    let mut rows = Vec::new();
    if !along_time.is_empty() {
        let time = [(one(frame.time()), Expr::from(1.0))];
        let components = time.into_iter().chain(along_time).collect();
        rows.push(Row::Operator { quasi_velocity: None, components });
    }
    let mut columns = vec![Vec::new(); system.quasi_velocities().len()];
    for i in 0..frame.b().rows() {
        for (s, b) in frame.b().nonzero(i) {
            columns[s].push((x(i), one(b)));
        }
    }
    let named = system.quasi_velocities().iter().map(|eta| Some(eta.to_string()));
    rows.extend(
        named.zip(columns).map(|(quasi_velocity, components)| Row::Operator { quasi_velocity, components }),
    );
    rows
}

/// The equations of an assembled model in one of their forms, part by part.
///
/// # Errors
/// [`ModelError`] if they cannot be derived.
pub fn displayed_equations(
    form: Form,
    layout: &Layout,
    title: &str,
    assembly: &Assembly<'_>,
) -> Result<DisplayedEquations, ModelError> {
    let (name, derived) = Derived::new(form, assembly)?;
    let system = derived.equations.system();
    if form == Form::Poincare && system.large_tree().is_some() {
        let print = |kind| page(form, kind, layout, title, assembly);
        let whole = (print(Page::Text)?, print(Page::Latex)?);
        let name = name.to_owned();
        return Ok(DisplayedEquations {
            name,
            parts: Vec::new(),
            plain: Some(whole),
            operations: Vec::new(),
        });
    }
    let paper = assembly.system.graph().page(Folding::Structural);
    let (name, sheet, operations) = sheet_of(form, name, &derived, assembly, &paper)?;
    let parts = Parts::new(&sheet, layout, &paper, false);
    let operators = &sheet.brackets.operators;
    let mathml = mathml::displays(operators, layout, &parts);
    let displayed = mathml.into_iter().zip(latex::displays(operators, layout, &parts));
    let parts = displayed.map(|((part, mathml), (_, latex))| DisplayedPart {
        title: part.heading.text(),
        display: mathml.zip(latex).map(|(displayed, latex)| Display::of(displayed, latex)),
        notes: notes(&sheet, part),
    });
    let mut lines = operations.lines();
    if matches!(sheet.balance, Balance::Momenta { velocities: None, .. }) {
        lines.push("quasi-velocities known".to_owned());
    }
    Ok(DisplayedEquations { name: name.to_owned(), parts: parts.collect(), plain: None, operations: lines })
}

/// The notes on a part, in addition to its formulas.
fn notes(sheet: &Sheet<'_>, part: &Part<'_>) -> Vec<String> {
    match part.heading {
        Heading::Constraints => part
            .rows
            .iter()
            .filter_map(|row| match row {
                Row::Constraint { name, kind, .. } => Some(format!("{name}: {}", kind_in_words(*kind))),
                _ => None,
            })
            .collect(),
        Heading::Brackets if part.rows.is_empty() => vec![no_brackets(&sheet.brackets).to_owned()],
        Heading::Brackets => {
            let left_out = sheet.brackets.left_out.then(|| LEFT_OUT.to_owned());
            algebra(&sheet.brackets).into_iter().chain(left_out).collect()
        }
        heading => remark(sheet, heading).map(str::to_owned).into_iter().collect(),
    }
}

/// The [theory](Theory) of a model, part by part.
///
/// # Errors
/// As for [`Theory::of`].
pub fn displayed_theory<'g>(
    model: &Model,
    assembly: &Assembly<'g>,
    options: &TheoryOptions,
) -> Result<Vec<DisplayedTheory>, ModelError> {
    let found = Theory::of(model, assembly, options)?;
    let set = |formulas: &[(Side<'g>, Side<'g>)]| -> Vec<DisplayedEquation> {
        let equation = |(left, right): &(Side<'g>, Side<'g>)| DisplayedEquation {
            left: left.mathml.clone(),
            right: right.mathml.clone(),
        };
        formulas.iter().map(equation).collect()
    };
    let section = |section: &Section<'g>| DisplayedTheory {
        key: section.key,
        title: section.title,
        names: set(&section.names),
        latex: theory::latex::display(section),
        entries: section
            .entries
            .iter()
            .map(|entry| DisplayedEntry {
                name: entry.name.clone(),
                formulas: set(&entry.formulas),
                verdict: entry.verdict.map(|(subject, verdict)| match subject {
                    None => verdict.in_words(),
                    Some(subject) => format!("{subject} {}", verdict.in_words()),
                }),
                values: entry
                    .values
                    .iter()
                    .map(|(name, value)| format!("{name} = {}", short(*value, 6)))
                    .collect(),
                words: entry.words.clone(),
                spectrum: entry.spectrum.clone(),
            })
            .collect(),
    };
    Ok(found.sections.iter().map(section).collect())
}
