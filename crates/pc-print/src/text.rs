//! Equations for people, as a book prints them.

use pc_algebra::{CATALOGUE, LieAlgebra, StructureCoefficients};
use pc_mech::{Canonical, Equations, Expr, Style, System};

use crate::constraints::constraints;
use crate::derived::Derived;
use crate::lines::{columns, combination};
use crate::operations::Operations;
use crate::sides::{momenta, operator_names, rates_of_states, state_rates};

/// The equations as a book prints them: constraints, kinematics, brackets, mass matrix, M η̇ = r, energy, reactions,
/// operations.
pub(crate) fn poincare(derived: &Derived<'_>, operations: &Operations) -> String {
    let equations = &derived.equations;
    let reactions: Vec<(String, String)> = derived
        .reactions
        .iter()
        .map(|(reaction, value)| (reaction.display(Style::Book), value.display(Style::Book)))
        .collect();
    let quasi_velocities: Vec<(String, String)> = (derived.quasi_velocities.iter())
        .map(|(eta, value)| (eta.display(Style::Book), value.display(Style::Book)))
        .collect();
    sections(&[
        ("Constraints", constraints(derived)),
        ("Quasi-velocities", aligned(quasi_velocities.iter().map(|(left, right)| (left, right)))),
        ("Kinematics", kinematics(equations.system(), equations.velocities())),
        ("Brackets", brackets(equations.system(), &derived.vanishing)),
        ("Mass matrix", mass_matrix(equations)),
        ("Equations", balance(equations)),
        ("States", states(equations.system(), &rates_of_states(equations.system()))),
        ("Energy", derived.with_remark(equations.energy().display(Style::Book))),
        ("Reactions", aligned(reactions.iter().map(|(left, right)| (left, right)))),
        ("Operations of one right-hand side", operations.lines()),
    ])
}

/// The equations as a book prints them: constraints, kinematics, brackets, momenta, Hamiltonian, ẏ = …, operations. Where they are
/// not closed, the momenta are equations for η.
pub(crate) fn canonical(derived: &Derived<'_>, equations: &Canonical<'_>, operations: &Operations) -> String {
    let system = equations.system();
    let lines = |pairs: &[(String, String)]| aligned(pairs.iter().map(|(left, right)| (left, right)));
    let cost = if equations.is_closed() {
        "Operations of one right-hand side"
    } else {
        "Operations of one right-hand side, quasi-velocities known"
    };
    sections(&[
        ("Constraints", constraints(derived)),
        ("Kinematics", kinematics(system, equations.velocities())),
        ("Brackets", brackets(system, &[])),
        ("Momenta", lines(&momenta(equations, Style::Book))),
        ("Hamiltonian", derived.with_remark(equations.hamiltonian().display(Style::Book))),
        ("Equations", lines(&equations.balance(Style::Book))),
        ("States", states(system, equations.state_rates())),
        (cost, operations.lines()),
    ])
}

/// A heading with a line under it.
pub(crate) fn underlined(heading: &str) -> String {
    format!("{heading}\n{}\n\n", "=".repeat(columns(heading)))
}

/// Titles with the lines under them; those without lines are left out.
fn sections(parts: &[(&str, Vec<String>)]) -> String {
    let section = |(title, lines): &(&str, Vec<String>)| {
        let lines: String = lines.iter().map(|line| format!("  {line}\n")).collect();
        format!("{title}\n{lines}")
    };
    let written: Vec<String> = parts.iter().filter(|(_, lines)| !lines.is_empty()).map(section).collect();
    written.join("\n")
}

/// ẋ_i = `velocities`, a line each but for those that are quasi-velocities themselves.
pub fn kinematics(system: &System<'_>, velocities: &[Expr<'_>]) -> Vec<String> {
    let rates = system.frame().coordinates().iter().map(|x| format!("{x}'"));
    let velocities = velocities.iter().map(|v| v.display(Style::Book));
    let lines: Vec<(String, String)> =
        rates.zip(velocities).filter(|(rate, velocity)| rate != velocity).collect();
    aligned(lines.iter().map(|(rate, velocity)| (rate, velocity)))
}

/// ż = `rates`, a line each.
pub(crate) fn states(system: &System<'_>, rates: &[Expr<'_>]) -> Vec<String> {
    let lines: Vec<(String, String)> = state_rates(system, rates, Style::Book);
    aligned(lines.iter().map(|(left, right)| (left, right)))
}

/// M η̇ = r, a line an equation.
pub fn balance(equations: &Equations<'_>) -> Vec<String> {
    let sides = equations.balance(Style::Book);
    aligned(sides.iter().map(|(left, right)| (left, right)))
}

/// Left = right, the equals signs under each other unless a left side is long.
fn aligned<'a>(pairs: impl Iterator<Item = (&'a String, &'a String)> + Clone) -> Vec<String> {
    let width = pairs.clone().map(|(left, _)| columns(left)).filter(|&width| width <= 24).max().unwrap_or(0);
    pairs.map(|(left, right)| format!("{left:width$} = {right}")).collect()
}

/// The brackets [X_r, X_s] = c_rs^m X_m of the free operators that are not zero, by the names of the quasi-velocities,
/// `t` for time; they may have components along `vanishing`.
pub fn brackets(system: &System<'_>, vanishing: &[Expr<'_>]) -> Vec<String> {
    let structure = system.structure();
    let free = system.quasi_velocities();
    let all: Vec<String> = free.iter().chain(vanishing).map(Expr::to_string).collect();
    let name: Vec<String> = std::iter::once("t".to_owned()).chain(all).collect();
    let mut lines = Vec::new();
    let nonzero: Vec<_> =
        structure.nonzero().filter(|&(_, s, m, _)| s <= free.len() && m < name.len()).collect();
    for pair in nonzero.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let sum = combination(pair.iter().map(|&(_, _, m, c)| (c.display(Style::Book), name[m].clone())));
        lines.push(format!("[{}, {}] = {sum}", name[pair[0].0], name[pair[0].1]));
    }
    if lines.is_empty() {
        let words = if system.frame().restricted(free.len()).commutes() {
            "all operators commute"
        } else {
            "none within the frame, which is not closed: the constraints are not integrable"
        };
        lines.push(words.to_owned());
    } else if let Some(known) = recognised(structure).filter(|_| vanishing.is_empty()) {
        lines.push(format!("the algebra {known}"));
    }
    lines
}

/// The name of the algebra, if the structure coefficients are those of one in the catalogue.
pub fn recognised(structure: &StructureCoefficients<'_>) -> Option<&'static str> {
    let algebra = structure.lie_algebra().filter(|_| structure.nonzero().all(|(r, ..)| r > 0))?;
    let known = CATALOGUE.iter().find(|entry| LieAlgebra::named(entry.name).as_ref() == Ok(&algebra));
    known.map(|entry| entry.name)
}

fn mass_matrix(equations: &Equations<'_>) -> Vec<String> {
    const WIDEST: usize = 96;
    let rows: Vec<Vec<String>> = equations
        .mass_matrix()
        .to_rows()
        .iter()
        .map(|row| row.iter().map(|entry| entry.display(Style::Book)).collect())
        .collect();
    let k = rows.len();
    let entries = || (0..k).flat_map(|r| (0..k).map(move |s| (r, s)));
    if entries().all(|(r, s)| r == s || rows[r][s] == "0") {
        let diagonal: Vec<&str> = (0..k).map(|s| rows[s][s].as_str()).collect();
        return vec![format!("diag({})", diagonal.join(", "))];
    }
    let widths: Vec<usize> =
        (0..k).map(|s| rows.iter().map(|row| columns(&row[s])).max().unwrap_or(0)).collect();
    if widths.iter().sum::<usize>() + 3 * k <= WIDEST {
        let line = |row: &Vec<String>| {
            let cells: Vec<String> =
                row.iter().zip(&widths).map(|(entry, &width)| format!("{entry:width$}")).collect();
            format!("[ {} ]", cells.join("   "))
        };
        return rows.iter().map(line).collect();
    }
    let name = operator_names(equations.system().quasi_velocities(), "t");
    entries()
        .filter(|&(r, s)| s <= r && rows[r][s] != "0")
        .map(|(r, s)| format!("M({}, {}) = {}", name[r + 1], name[s + 1], rows[r][s]))
        .collect()
}
