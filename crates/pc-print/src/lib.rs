//! The equations of a model in print: as a book has them, in LaTeX for a paper, as JSON for programs.
//!
//! A [`page`] is what `pc derive` and `pc_system_print` of the C interface show. Its parts are there too: what is
//! [derived](Derived) in each [`Form`], the [cost](Operations) of a right-hand side, and the lines of
//! [kinematics](kinematics()), [brackets](brackets()) and [equations](balance()).
//!
//! ```
//! use pc_mech::Graph;
//! use pc_model::Builtin;
//! use pc_print::{Form, Page, page};
//!
//! let model = pc_model::Model::new(Builtin::named("chaplygin-sleigh").unwrap().document()?);
//! let graph = Graph::new();
//! let assembly = model.assemble(&graph)?;
//! let printed = page(Form::Poincare, Page::Text, model.title(), &assembly)?;
//! assert!(printed.contains("Reactions\n  λ_"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod constraints;
mod derived;
mod json;
mod latex;
mod lines;
mod operations;
mod text;

use pc_mech::{Canonical, Expr, MechError, Style};
use pc_model::Assembly;
use pc_nonholo::NonholoError;

pub use constraints::kind_in_words;
pub use derived::{Derived, energy_remark};
pub use lines::{columns, combination};
pub use operations::{Operations, counted};
pub use text::{balance, brackets, kinematics, recognised};

/// Form of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Equations for the quasi-velocities.
    Poincare,
    /// Equations for the momenta.
    Canonical,
    /// Equations for the velocities.
    Lagrange,
    /// Equations for independent velocities.
    Voronets,
}

/// How equations are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// For people.
    Text,
    /// For a paper.
    Latex,
    /// For programs.
    Json,
}

/// The equations of an assembled model, called `title`, in one of their forms.
///
/// # Errors
/// [`NonholoError`] if they cannot be derived.
pub fn page(form: Form, page: Page, title: &str, assembly: &Assembly<'_>) -> Result<String, NonholoError> {
    if form == Form::Canonical {
        let (_, derived) = Derived::new(form, assembly)?;
        let equations = assembly.free_system()?.canonical()?;
        let operations = Operations::of_canonical(&equations).map_err(MechError::from)?;
        let heading = format!("{title}: canonical equations");
        return Ok(match page {
            Page::Text => text::underlined(&heading) + &text::canonical(&derived, &equations, &operations),
            Page::Latex => latex::canonical(&heading, &derived, &equations),
            Page::Json => format!("{:#}\n", json::canonical(title, &derived, &equations, &operations)),
        });
    }
    let (name, derived) = Derived::new(form, assembly)?;
    let heading = format!("{title}: {name}");
    let operations = Operations::of(&derived.equations).map_err(MechError::from)?;
    Ok(match page {
        Page::Text => text::underlined(&heading) + &text::poincare(&derived, &operations),
        Page::Latex => latex::poincare(&heading, &derived),
        Page::Json => format!("{:#}\n", json::poincare(title, &derived, &operations)),
    })
}

/// Names of X_0..X_k: that of time, then of the quasi-velocities.
fn operator_names(quasi_velocities: &[Expr<'_>], time: &str) -> Vec<String> {
    std::iter::once(time.to_owned()).chain(quasi_velocities.iter().map(Expr::to_string)).collect()
}

/// y_s = ∂L/∂η_s, the two sides of each.
fn momenta(equations: &Canonical<'_>, style: Style) -> Vec<(String, String)> {
    let pairs = equations.momenta().iter().zip(equations.momenta_of_velocities());
    pairs.map(|(y, value)| (y.display(style), value.display(style))).collect()
}
