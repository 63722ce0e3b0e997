//! Dirac's bracket, under constraints on the positions.

use pc_analysis::{AnalysisError, PoissonBracket};
use pc_mech::{Canonical, Expr, Style};

use crate::language::mathml;
use crate::theory::basis::Basis;
use crate::theory::brackets::is_stationary;
use crate::theory::description::{Entry, Section, Side, Verdict};

/// The largest number of variables of a bracket that is printed.
const MOST_VARIABLES: usize = 12;
/// The largest number of variables for which Jacobi's identity is tested, triple by triple.
const MOST_TESTED: usize = 8;
/// The greatest length of the Hamiltonian and of the constraints, counted in operations of the written-out expression.
const LONGEST: u32 = 400;

/// The canonical variables with the constraints on their positions.
struct Held<'g> {
    canonical: Canonical<'g>,
    positions: Vec<Expr<'g>>,
}

impl<'g> Held<'g> {
    /// The model in all its momenta, if multipliers enforce constraints on its positions and nothing depends on time.
    fn of(ground: &Basis<'_, 'g>) -> Option<Held<'g>> {
        let system = &ground.assembly.system;
        let positions = ground.assembly.constraints.positions(system).filter(|all| !all.is_empty())?;
        let (n, k) = (system.frame().coordinates().len(), system.quasi_velocities().len());
        let is_moving = |f: &Expr<'g>| f.depends_on(system.frame().time());
        if n + k > MOST_VARIABLES || !is_stationary(system) || positions.iter().any(is_moving) {
            return None;
        }
        let canonical = system.canonical().ok().filter(Canonical::is_closed)?;
        let length = positions.iter().chain([&canonical.hamiltonian()]).map(|f| f.tree_cost()).max();
        length.is_some_and(|length| length <= LONGEST).then_some(Held { canonical, positions })
    }
}

/// The section on Dirac's bracket of all coordinates and momenta.
pub(crate) fn section<'g>(ground: &Basis<'_, 'g>) -> Result<Section<'g>, AnalysisError> {
    let section =
        |entries| Section { key: "dirac_brackets", title: "Dirac brackets", names: Vec::new(), entries };
    let Some(Held { canonical, positions }) = Held::of(ground) else { return Ok(section(Vec::new())) };
    let bracket = PoissonBracket::new(canonical.system());
    let constraints = bracket.with_rates(&positions, canonical.hamiltonian())?;
    let dirac = match bracket.dirac(&constraints) {
        Err(AnalysisError::NotSecondClass { .. }) => return Ok(section(Vec::new())),
        dirac => dirac?,
    };
    let (z, tensor) = (dirac.variables(), dirac.tensor());
    let pairs = (0..z.len()).flat_map(|i| (i + 1..z.len()).map(move |j| (i, j)));
    let nonzero = pairs.filter(|&(i, j)| !tensor[(i, j)].is_zero());
    let mut entries: Vec<Entry<'g>> =
        nonzero.map(|(i, j)| Entry::formula(of_dirac(z[i], z[j]), Side::of(tensor[(i, j)]))).collect();
    entries.push(Entry::formula(Side::letter("H"), Side::of(canonical.hamiltonian())));
    let mut are_casimirs = true;
    for &phi in &constraints {
        are_casimirs &= dirac.is_casimir(phi)?;
    }
    let casimirs = Entry::words("the constraints f and (f, H) are Casimirs");
    entries.push(casimirs.with(if are_casimirs { Verdict::Proved } else { Verdict::Open }));
    if z.len() <= MOST_TESTED && dirac.jacobi_violation().is_none() {
        entries.push(Entry::default().with_on("Jacobi's identity", Verdict::Proved));
    }
    let forced = canonical.system().forces().iter().any(|q| !q.is_zero());
    let motion = if forced {
        "without forces: x' = (x, H)_D, y' = (y, H)_D where the constraints hold"
    } else {
        "x' = (x, H)_D, y' = (y, H)_D where the constraints hold, the motion with multipliers"
    };
    entries.push(Entry::words(motion));
    Ok(section(entries))
}

/// (f, g)_D
fn of_dirac<'g>(f: Expr<'_>, g: Expr<'_>) -> Side<'g> {
    Side::written(|style| {
        let [f, g] = [f, g].map(|z| z.display(style));
        match style {
            Style::Latex => format!("({f},\\, {g})_D"),
            Style::Book | Style::Text => format!("({f}, {g})_D"),
            Style::MathMl => {
                format!("<msub>{}<mi>D</mi></msub>", mathml::bracketed(&format!("{f}<mo>,</mo>{g}")))
            }
        }
    })
}
