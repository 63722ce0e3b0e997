//! Momenta, their brackets, and Casimirs.

use pc_analysis::{AnalysisError, Ansatz, PoissonBracket, Rates};
use pc_mech::{Canonical, Expr, Identity, Style, System};

use crate::language::mathml;
use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Side, Verdict};

/// The largest number of monomials among which Casimirs are sought; a search then takes some tenths of a
/// second.
const MOST_MONOMIALS: usize = 300;

/// The largest number of variables of a bracket whose rank is computed.
const MOST_RANKED: usize = 400;

/// The largest number of variables for which Jacobi's identity is tested, triple by triple.
const MOST_VARIABLES: usize = 16;

/// y_s = ∂L/∂η_s, and H.
pub(crate) fn momenta<'g>(ground: &Basis<'_, 'g>) -> Section<'g> {
    let section = |entries| Section { key: "momenta", title: "Momenta", names: Vec::new(), entries };
    if ground.assembly.constraints.nonlinear().is_some() {
        return section(Vec::new()); // the velocities are not independent
    }
    let (system, graph) = (&ground.free, ground.free.graph());
    let values = graph.shorten(&system.momenta(), system.quasi_velocities());
    let pairs = system.momentum_symbols().into_iter().zip(values);
    let mut entries: Vec<Entry<'g>> =
        pairs.map(|(y, value)| Entry::formula(Side::of(y), Side::of(value))).collect();
    entries.push(match &ground.canonical {
        Ok(canonical) => Entry::formula(Side::letter("H"), Side::of(canonical.hamiltonian())),
        Err(why) => Entry::words(format!("H is not written: {why}")),
    });
    section(entries)
}

/// The bracket of the variables (x, y): Poisson's, or the almost-Poisson one under nonholonomic constraints.
pub(crate) fn bracket<'g>(ground: &Basis<'_, 'g>) -> Result<Option<PoissonBracket<'g>>, AnalysisError> {
    let nonlinear = ground.assembly.constraints.nonlinear().is_some();
    if nonlinear || ground.constrained.is_some() && ground.canonical.is_err() {
        return Ok(None);
    }
    Ok(Some(match &ground.constrained {
        Some(constrained) => PoissonBracket::almost_poisson(constrained)?,
        None if is_stationary(&ground.free) => PoissonBracket::new(&ground.free),
        None => PoissonBracket::extended(&ground.free),
    }))
}

/// Whether b_0 = 0, c_0s = 0 and b is independent of time.
pub(crate) fn is_stationary(system: &System<'_>) -> bool {
    let (frame, structure) = (system.frame(), system.structure());
    let time = frame.time();
    frame.b0().iter().all(|b| b.is_zero())
        && !frame.b().nonzero_entries().iter().any(|b| b.depends_on(time))
        && structure.nonzero().all(|(r, .., c)| r > 0 && !c.depends_on(time))
}

/// The section on the brackets that are not zero, Jacobi's identity, and the motion that they generate.
pub(crate) fn brackets<'g>(ground: &Basis<'_, 'g>, bracket: Option<&PoissonBracket<'g>>) -> Section<'g> {
    let is_poisson = ground.constrained.is_none();
    let section = |entries| Section {
        key: if is_poisson { "poisson_brackets" } else { "almost_poisson_brackets" },
        title: if is_poisson { "Poisson brackets" } else { "Almost-Poisson brackets" },
        names: Vec::new(),
        entries,
    };
    let Some(bracket) = bracket else { return section(Vec::new()) };
    let mut entries = nonzero(bracket);
    if entries.is_empty() {
        entries.push(Entry::words("all are zero"));
    }
    entries.push(if is_poisson { jacobi_by_frame(ground) } else { jacobi(ground, bracket) });
    entries.push(Entry::words(generated(ground, bracket)));
    section(entries)
}

/// The formulas (z_i, z_j) = … for i < j, except those that are zero.
fn nonzero<'g>(bracket: &PoissonBracket<'g>) -> Vec<Entry<'g>> {
    let (z, tensor) = (bracket.variables(), bracket.tensor());
    let pairs = (0..z.len()).flat_map(|i| (i + 1..z.len()).map(move |j| (i, j)));
    let nonzero = pairs.filter(|&(i, j)| !tensor[(i, j)].is_zero());
    nonzero.map(|(i, j)| Entry::formula(Side::bracket(z[i], z[j]), Side::of(tensor[(i, j)]))).collect()
}

const JACOBI: &str = "Jacobi's identity";

/// The bracket (12) of a closed set of operators is a Poisson bracket if the brackets of the operators
/// satisfy Jacobi's identity.
fn jacobi_by_frame<'g>(ground: &Basis<'_, 'g>) -> Entry<'g> {
    let (frame, structure) = (ground.free.frame(), ground.free.structure());
    let residuals =
        [frame.closure_residual(structure, &ground.near), frame.jacobi_residual(structure, &ground.near)];
    let worst = residuals.into_iter().fold(0.0, f64::max);
    Entry::default().with_on(JACOBI, Verdict::of(Identity::of(worst)))
}

/// The verdict on Jacobi's identity: it is disproved by the first three variables that violate the identity,
/// if there are any.
fn jacobi<'g>(ground: &Basis<'_, 'g>, bracket: &PoissonBracket<'g>) -> Entry<'g> {
    if bracket.variables().len() > MOST_VARIABLES {
        return Entry::words("too many variables to test in triples").with_on(JACOBI, Verdict::Open);
    }
    let Some(([f, g, h], defect)) = bracket.jacobi_violation() else {
        return Entry::default().with_on(JACOBI, Verdict::Proved);
    };
    let margin = ground.near.residual(bracket.graph(), &[vec![defect]]);
    let cycle = Side::written(|style| {
        let [f, g, h] = [f, g, h].map(|z| z.display(style));
        if style == Style::MathMl {
            let of = |a: &str, b: &str| mathml::bracketed(&format!("{a}<mo>,</mo>{b}"));
            let cycle = [(&f, &g, &h), (&g, &h, &f), (&h, &f, &g)].map(|(a, b, c)| of(a, &of(b, c)));
            return cycle.join("<mo>+</mo>");
        }
        format!("({f}, ({g}, {h})) + ({g}, ({h}, {f})) + ({h}, ({f}, {g}))")
    });
    Entry::formula(cycle, Side::of(defect)).with_on(JACOBI, Verdict::of(Identity::of(margin)))
}

/// The motion that H generates, in words.
fn generated(ground: &Basis<'_, '_>, bracket: &PoissonBracket<'_>) -> String {
    let hamiltonian = if bracket.time_momentum().is_some() { "K" } else { "H" };
    // The forces of the free system contain the reactions, which the bracket accounts for.
    let system = ground.constrained.as_ref().map_or(&ground.free, |constrained| constrained.system());
    let forced = system.forces().iter().any(|q| !q.is_zero());
    let forces = if forced { " + Q" } else { "" };
    let of_time = bracket.time_momentum().map_or_else(String::new, |y0| format!(", K = H + {y0}"));
    format!("x' = (x, {hamiltonian}), y' = (y, {hamiltonian}){forces}{of_time}")
}

/// The section on the Casimirs of the bracket.
pub(crate) fn casimirs<'g>(
    ground: &Basis<'_, 'g>,
    bracket: Option<&PoissonBracket<'g>>,
    degree: u32,
) -> Section<'g> {
    let section = |entries| Section { key: "casimirs", title: "Casimirs", names: Vec::new(), entries };
    let canonical = ground.canonical.as_ref().ok();
    section(bracket.map_or_else(Vec::new, |bracket| casimir_entries(bracket, canonical, degree)))
}

/// The Casimirs that are polynomials up to a degree, or polynomials in the momenta whose coefficients contain
/// sines and cosines of coordinates.
fn casimir_entries<'g>(
    bracket: &PoissonBracket<'g>,
    canonical: Option<&Canonical<'g>>,
    degree: u32,
) -> Vec<Entry<'g>> {
    let size = bracket.variables().len();
    if size > MOST_RANKED {
        return vec![Entry::words(format!("not looked for: there are {size} variables")).with(Verdict::Open)];
    }
    let rank = bracket.rank();
    let corank = size - rank;
    if corank == 0 {
        return vec![Entry::words(format!("none: the bracket has full rank {rank}"))];
    }
    let tried = (1..=degree.max(2) as usize).rev().find(|&d| binomial(size + d, d) <= MOST_MONOMIALS);
    let mut found: Vec<Expr<'_>> = tried.map_or_else(Vec::new, |d| bracket.casimirs(d as u32));
    if found.len() < corank
        && let Some(canonical) = canonical
    {
        let moving = canonical.momenta();
        let ansatz =
            Ansatz { known: found.clone(), ..Rates::canonical(canonical).ansatz(degree, degree.min(2)) };
        let few = binomial(moving.len() + degree as usize, degree as usize) * ansatz.functions.len();
        if few <= MOST_MONOMIALS {
            found.extend(bracket.casimirs_by(&ansatz, moving).unwrap_or_default());
        }
    }
    let known = |(number, &casimir): (usize, &Expr<'g>)| {
        let mathml = format!("<msub><mi>C</mi><mn>{number}</mn></msub>");
        let left = Side::symbol(&format!("C{number}"), &format!("C_{{{number}}}"), &mathml);
        Entry::formula(left, Side::of(casimir)).with(Verdict::Proved)
    };
    let mut entries: Vec<Entry<'g>> = (1..).zip(&found).map(known).collect();
    let missing = corank - found.len().min(corank);
    let all = format!("rank {rank} of {size}: {corank} independent near almost every point");
    entries.push(match (missing, tried) {
        (0, _) => Entry::words(all),
        (_, Some(d)) => {
            Entry::words(format!("{all}; {missing} not found among polynomials of degree up to {d}"))
                .with(Verdict::Open)
        }
        (_, None) => Entry::words(format!("{all}; not looked for: too many variables")).with(Verdict::Open),
    });
    entries
}

/// n over d
fn binomial(n: usize, d: usize) -> usize {
    (1..=d).fold(1, |product: usize, i| product.saturating_mul(n + 1 - i) / i)
}

/// The system without its ignorable coordinates, if it has any: on a group with invariant L, it has the
/// Lie–Poisson bracket.
pub(crate) fn group_reduction<'g>(ground: &Basis<'_, 'g>, degree: u32) -> Section<'g> {
    let section =
        |entries| Section { key: "reduction", title: "Reduction by symmetry", names: Vec::new(), entries };
    let is_closed = ground.canonical.is_ok() && ground.is_unbound();
    let Some(reduced) = is_closed.then(|| ground.free.reduced().ok()).flatten() else {
        return section(Vec::new());
    };
    let [before, after] = [&ground.free, &reduced].map(|system| system.frame().coordinates().len());
    // Momenta without brackets and coordinates are constants, listed among the integrals.
    if after == before || reduced.structure().nonzero().next().is_none() || !is_stationary(&reduced) {
        return section(Vec::new());
    }
    let Ok(canonical) = reduced.canonical() else { return section(Vec::new()) };
    let bracket = PoissonBracket::new(&reduced);
    let left: Vec<String> = bracket.variables().iter().map(ToString::to_string).collect();
    let what = if after == 0 { ", by the bracket of Lie and Poisson" } else { "" };
    let head = Entry::words(format!("nothing depends on variables other than {}{what}", left.join(", ")));
    let rates = canonical.momenta().iter().zip(canonical.right_hand_side());
    let rate = |(&y, &rate): (&Expr<'g>, &Expr<'g>)| {
        Entry::formula(Side::of(reduced.graph().symbol(&format!("{y}'"))), Side::of(rate))
    };
    let hamiltonian = Entry::formula(Side::letter("H"), Side::of(canonical.hamiltonian()));
    let mut entries = vec![head];
    entries.extend(nonzero(&bracket));
    entries.push(hamiltonian);
    entries.extend(rates.map(rate));
    entries.extend(casimir_entries(&bracket, Some(&canonical), degree));
    section(entries)
}
