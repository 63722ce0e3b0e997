//! The invariant measure, in words.

use pc_analysis::{MeasureSearch, PhaseMeasure};
use pc_mech::{Expr, Style, System};
use pc_model::Assembly;
use pc_print::{columns, combination, reducing_multiplier};
use serde_json::{Value, json};

/// A formula wider than this, in columns, is not printed.
const WIDEST: usize = 80;

/// The results about the invariant measure.
#[derive(Clone, Debug)]
pub(super) struct Measure<'g> {
    /// The result of the search; `None` if a constraint is not affine in the velocities.
    search: Option<MeasureSearch<'g>>,
    /// Whether there are as many free quasi-velocities as coordinates.
    square: bool,
    /// Whether an event may change integrals that hold between events.
    jumps: bool,
    /// Chaplygin's reducing multiplier.
    multiplier: Option<Expr<'g>>,
}

impl<'g> Measure<'g> {
    /// The measure of a model; `at` has the values of time, state and parameters at the start.
    pub(super) fn of(assembly: &Assembly<'g>, at: &[(Expr<'g>, f64)]) -> Measure<'g> {
        let jumps = assembly.events.iter().any(|event| !event.resets.is_empty());
        if assembly.constraints.nonlinear().is_some() {
            return Measure { search: None, square: false, jumps, multiplier: None };
        }
        let positions = assembly.constraints.positions(&assembly.system);
        // The equations have been derived before: an error means that these have no closed form.
        let free = assembly.free_system().ok();
        let frame = free.as_ref().map(System::frame);
        let square = frame.is_some_and(|frame| frame.coordinates().len() == frame.operators());
        let found = free.and_then(|free| MeasureSearch::of(&free, positions.as_deref(), at).ok());
        let search = found.unwrap_or(MeasureSearch::None);
        let is_positive = matches!(&search, MeasureSearch::Found(measure) if measure.singular.is_empty());
        let multiplier =
            if is_positive && positions.is_none() { reducing_multiplier(assembly) } else { None };
        let multiplier = multiplier.map(|reduced| reduced.multiplier);
        Measure { search: Some(search), square, jumps, multiplier }
    }

    /// The lines to print.
    pub(super) fn lines(&self) -> Vec<String> {
        let known = match &self.search {
            None => "not looked for: a constraint is not affine in the velocities".to_owned(),
            Some(MeasureSearch::None) => "none found".to_owned(),
            Some(MeasureSearch::External) => "not looked for: forces are computed outside".to_owned(),
            Some(MeasureSearch::TooLong) => "not looked for: the equations are too long".to_owned(),
            Some(MeasureSearch::Found(measure)) => {
                let between = if self.jumps { ", between events" } else { "" };
                let jumps = if measure.jumps { ", where nothing jumps" } else { "" };
                format!("{}{jumps}{between}", words(measure, self.square))
            }
        };
        let changing = self.multiplier.filter(|multiplier| multiplier.constant().is_none());
        let formula = changing.map(|multiplier| multiplier.display(Style::Book));
        let multiplier = formula.filter(|formula| columns(formula) <= WIDEST);
        let multiplier = multiplier.map(|formula| format!("Chaplygin's multiplier N = {formula}, dτ = N dt"));
        [known].into_iter().chain(multiplier).collect()
    }

    /// The measure as JSON; null if none is known.
    pub(super) fn object(&self) -> Value {
        let Some(MeasureSearch::Found(measure)) = &self.search else { return Value::Null };
        let text = |value: &Option<Expr<'_>>| value.map(|value| value.to_string());
        json!({
            "liouville": measure.liouville,
            "density": text(&measure.density),
            "density_in_velocities": text(&measure.in_velocities),
            "singular": measure.singular.iter().map(Expr::to_string).collect::<Vec<_>>(),
            "jumps": self.jumps || measure.jumps,
            "reducing_multiplier": text(&self.multiplier),
        })
    }
}

/// The measure in words, such as `r dx dy, r³ dx dη, Liouville's`; `square` says whether b is square, so that
/// it has a determinant.
fn words(measure: &PhaseMeasure<'_>, square: bool) -> String {
    let written = |density: Option<Expr<'_>>| {
        let formula = density.map(|density| density.display(Style::Book));
        formula.filter(|formula| columns(formula) <= WIDEST / 2)
    };
    let (density, in_velocities) = (written(measure.density), written(measure.in_velocities));
    let name = if measure.liouville && square { "1/det(b)" } else { "N" };
    let density = density.unwrap_or_else(|| name.to_owned());
    let other = match in_velocities {
        _ if measure.density.is_some() && measure.density == measure.in_velocities => {
            "and so dx dη".to_owned()
        }
        Some(formula) => combination([(formula, "dx dη".to_owned())]),
        None => combination([(density.clone(), "det(M) dx dη".to_owned())]),
    };
    let density = combination([(density, "dx dy".to_owned())]);
    let whose = if measure.liouville { ", Liouville's" } else { "" };
    let zeros: Vec<String> = measure.singular.iter().map(|p| format!("{p} = 0")).collect();
    let singular = match zeros.as_slice() {
        [] => String::new(),
        zeros => format!(", singular where {}", zeros.join(" or ")),
    };
    format!("{density}, {other}{whose}{singular}")
}
