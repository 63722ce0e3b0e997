//! The page of a model.

use pc_model::{Assembly, Model};
use pc_print::{Extent, Layout, TheoryOptions, displayed_system, displayed_theory, short};
use pc_verify::{Options, VerifyError, verify};

use crate::check::check::{Check, LONG};
use crate::error::ReportError;
use crate::page::equations::MOST_OPERATIONS;
use crate::page::html::{Part, described, lines, page, paragraph, text};
use crate::page::pairs::pairs;
use crate::page::{equations, formulas, motion, player, theory};
use crate::recording::Recording;
use crate::scene::Scene;

/// The width of a line of a formula, in columns.
pub(super) const WIDTH: usize = 92;
/// The number of states at which the second derivation of a brief page is compared, that for long equations, and that for those
/// that are too long to be shown, if no motion was compared.
const STATES: usize = 32;
const STATES_OF_LONG: usize = 6;
const STATES_OF_LONGEST: usize = 2;
/// What a brief page says of the second derivation of equations that are too long to be shown, where the motion was compared.
const ALONG: &str = "agrees along the motion, as said there; pc report --full compares it at more states";
/// The number of operations up to which a brief page has every form compared with the second derivation.
const SHORT: usize = 60;
/// Texts with more lines than this are folded until they are opened.
const LONG_TEXT: usize = 40;

/// How a page is made.
#[derive(Clone, Copy)]
pub struct Page<'a> {
    /// Whether everything is derived, however long it takes: otherwise work that would take more than seconds is left out, as the
    /// length of the equations tells, and the page says which command does it.
    pub full: bool,
    /// Hears which part is being made.
    pub part: &'a dyn Fn(&'static str),
}

impl Default for Page<'_> {
    fn default() -> Self {
        Page { full: false, part: &|_| () }
    }
}

impl std::fmt::Debug for Page<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Page").field("full", &self.full).finish_non_exhaustive()
    }
}

/// Everything that is known about an assembled model, and about its motion if there is one, as one page for a browser, without
/// what takes long. The same model always results in the same bytes.
///
/// # Errors
/// [`ReportError`] if the equations cannot be derived, or a second derivation disagrees with the first.
pub fn report(
    model: &Model,
    assembly: &Assembly<'_>,
    motion: Option<&Recording>,
) -> Result<String, ReportError> {
    Page::default().of(model, assembly, motion)
}

impl Page<'_> {
    /// As [`report`], in this way.
    ///
    /// # Errors
    /// As for [`report`].
    pub fn of(
        &self,
        model: &Model,
        assembly: &Assembly<'_>,
        motion: Option<&Recording>,
    ) -> Result<String, ReportError> {
        (self.part)("properties");
        let equations = assembly.equations()?;
        let check = match self.full {
            true => Check::new(model, assembly, &equations)?,
            false => Check::brief(model, assembly, &equations)?,
        };
        let extent = match self.full {
            true => Extent::Full,
            false => Extent::Brief { operations: check.operations() },
        };
        (self.part)("theory");
        let theory = self.theory(model, assembly, extent)?;
        (self.part)("forms of the equations");
        let layout = Layout { width: WIDTH, ..Layout::default() };
        let formulas = equations::equations(model.title(), assembly, &layout, extent)?;
        let system = formulas::parts(&displayed_system(assembly, &layout)?, 3);
        (self.part)("motion");
        let moved = motion.map(|record| moved(model, assembly, record)).transpose()?;
        (self.part)("second derivation");
        let verdicts = match motion {
            Some(record) if record.agrees && !self.full && !extent.allows(MOST_OPERATIONS) => {
                [check.entries(), vec![("second derivation", vec![ALONG.to_owned()])]].concat()
            }
            _ => match verify(model, assembly, &self.compared(extent)) {
                Err(error @ VerifyError::Disagreement(_)) => {
                    return Err(ReportError::Verify(Box::new(error)));
                }
                outcome => check.compared(outcome).entries(),
            },
        };
        assembly.within_limits()?;
        let mut parts = vec![
            Part::new("equations", "Equations of motion", formulas),
            Part::new("verdicts", "Verdicts", described(&verdicts)),
            Part::new("system", "Frame and Lagrangian", system),
            Part::new("theory", "Theory of the motions", theory),
            Part::new("text", "Text of the model", written(model)),
        ];
        if let (Some(moved), Some(record)) = (moved, motion) {
            // A motion is seen at a glance; why there is none is not what the page is about.
            let place = if record.curves().times.is_empty() { parts.len() - 1 } else { 0 };
            parts.insert(place, Part::new("motion", "Motion", moved));
        }
        Ok(page(model.title(), &(head(model, &parts) + &body(&parts))))
    }

    /// The part on the theory.
    fn theory(&self, model: &Model, assembly: &Assembly<'_>, extent: Extent) -> Result<String, ReportError> {
        if !extent.allows(LONG) {
            return Ok(paragraph(
                "The equations are long, and their theory is left to pc theory; pc report --full shows it here.",
            ));
        }
        let options = TheoryOptions { extent, ..TheoryOptions::default() };
        let mut shown = theory::theory(&displayed_theory(model, assembly, &options)?);
        if !self.full {
            shown += "<p class=\"soft\">Integrals and steady motions are looked for briefly; pc theory looks further.</p>\n";
        }
        Ok(shown)
    }

    /// How far the second derivation is compared.
    fn compared(&self, extent: Extent) -> Options {
        match self.full {
            true => Options::default(),
            false => Options {
                states: match () {
                    () if extent.allows(LONG) => STATES,
                    () if extent.allows(MOST_OPERATIONS) => STATES_OF_LONG,
                    () => STATES_OF_LONGEST,
                },
                every_form_up_to: SHORT,
                ..Options::default()
            },
        }
    }
}

/// The motion: the player, and the plots.
fn moved(model: &Model, assembly: &Assembly<'_>, record: &Recording) -> Result<String, ReportError> {
    let scene = Scene::of(model, assembly, record)?;
    let watched = scene.as_ref().map_or_else(String::new, player::player);
    Ok(watched + &motion::motion(record, &pairs(assembly, record)))
}

fn body(parts: &[Part]) -> String {
    format!("<main id=\"main\">\n{}</main>\n", parts.iter().map(Part::section).collect::<String>())
}

/// The head of the page: title, description, table of contents.
fn head(model: &Model, parts: &[Part]) -> String {
    let heading = &model.document().model;
    let mut head = format!(
        "<a class=\"skip\" href=\"#main\">Skip to the contents</a>\n<header>\n<h1>{}</h1>\n",
        text(model.title())
    );
    if let Some(description) = &heading.description {
        head += &paragraph(&description.value);
    }
    if let Some(reference) = &heading.reference {
        head += &format!("<p class=\"soft\">{}</p>\n", text(&reference.value));
    }
    let entry = |part: &Part| format!("<li><a href=\"#{}\">{}</a></li>\n", part.id, part.title);
    let entries: String = parts.iter().map(entry).collect();
    head + &format!("</header>\n<nav aria-label=\"Contents\">\n<ol>\n{entries}</ol>\n</nav>\n")
}

/// The text of the model as it was read, with the present values of the parameters.
fn written(model: &Model) -> String {
    let source = model.document().source.text();
    let values: Vec<(String, Vec<String>)> = model
        .parameters()
        .map(|(name, value)| {
            let unit = model.document().unit(name).map_or_else(String::new, |unit| format!(" {unit}"));
            (name.to_owned(), vec![short(value, 10) + &unit])
        })
        .collect();
    let mut shown = String::new();
    if !values.is_empty() {
        shown += "<h3>Values of the parameters</h3>\n";
        shown += &described(&values);
    }
    let count = source.lines().count();
    let open = if count <= LONG_TEXT { " open=\"open\"" } else { "" };
    shown += &format!(
        "<h3>Source</h3>\n<details{open}><summary>{count} lines</summary><pre tabindex=\"0\"><code>{}</code></pre></details>\n",
        lines(source)
    );
    shown
}
