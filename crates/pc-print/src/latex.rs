//! The equations for a paper: displays of LaTeX with amsmath.

use std::fmt::Write as _;

use pc_mech::{Canonical, Expr, Style, System};

use crate::derived::Derived;
use crate::sides::{momenta, rates_of_states, state_rates};

/// One display for each part of Poincaré's equations, with a comment above it.
pub(crate) fn poincare(heading: &str, derived: &Derived<'_>) -> String {
    let equations = &derived.equations;
    let set = |list: &[(Expr<'_>, Expr<'_>)]| -> Vec<(String, String)> {
        list.iter().map(|(left, right)| (left.display(Style::Latex), right.display(Style::Latex))).collect()
    };
    displays(
        heading,
        &[
            ("Constraints", constraints(derived)),
            ("Quasi-velocities", set(&derived.quasi_velocities)),
            ("Kinematics", kinematics(equations.system(), equations.velocities())),
            ("Brackets", brackets(equations.system(), &derived.vanishing)),
            ("Equations", equations.balance(Style::Latex)),
            ("States", state_rates(equations.system(), &rates_of_states(equations.system()), Style::Latex)),
            (&titled("Energy", derived), vec![("E".to_owned(), equations.energy().display(Style::Latex))]),
            ("Reactions", set(&derived.reactions)),
        ],
    )
}

fn constraints(derived: &Derived<'_>) -> Vec<(String, String)> {
    let constraints = derived.constraints.iter();
    constraints.map(|(c, _)| (derived.vanishing(c).display(Style::Latex), "0".to_owned())).collect()
}

/// The same of the canonical equations.
pub(crate) fn canonical(heading: &str, derived: &Derived<'_>, equations: &Canonical<'_>) -> String {
    displays(
        heading,
        &[
            ("Constraints", constraints(derived)),
            ("Kinematics", kinematics(equations.system(), equations.velocities())),
            ("Brackets", brackets(equations.system(), &[])),
            ("Momenta", momenta(equations, Style::Latex)),
            (
                &titled("Hamiltonian", derived),
                vec![("H".to_owned(), equations.hamiltonian().display(Style::Latex))],
            ),
            ("Equations", equations.balance(Style::Latex)),
            ("States", state_rates(equations.system(), equations.state_rates(), Style::Latex)),
        ],
    )
}

/// The title with what is to be known of the energy.
fn titled(title: &str, derived: &Derived<'_>) -> String {
    derived.energy_remark.map_or_else(|| title.to_owned(), |remark| format!("{title}. {remark}"))
}

fn displays(heading: &str, parts: &[(&str, Vec<(String, String)>)]) -> String {
    let mut page = format!("% {heading} (needs amsmath)\n");
    for (part, lines) in parts {
        display(&mut page, part, lines);
    }
    page
}

fn display(page: &mut String, part: &str, lines: &[(String, String)]) {
    if lines.is_empty() {
        return;
    }
    let lines: Vec<String> = lines.iter().map(|(left, right)| format!("  {left} &= {right}")).collect();
    // Writing to a string cannot fail.
    let _ = write!(page, "\n% {part}\n\\begin{{align*}}\n{}\n\\end{{align*}}\n", lines.join(" \\\\\n"));
}

fn kinematics(system: &System<'_>, velocities: &[Expr<'_>]) -> Vec<(String, String)> {
    let graph = system.graph();
    let rate = |x: &Expr<'_>| graph.symbol(&format!("{x}'"));
    let velocities = system.frame().coordinates().iter().zip(velocities);
    velocities
        .filter(|(x, velocity)| rate(x) != **velocity)
        .map(|(x, velocity)| (rate(x).display(Style::Latex), velocity.display(Style::Latex)))
        .collect()
}

fn brackets(system: &System<'_>, vanishing: &[Expr<'_>]) -> Vec<(String, String)> {
    let structure = system.structure();
    let graph = system.graph();
    let free = system.quasi_velocities().len();
    let all = [system.quasi_velocities(), vanishing].concat();
    let k = structure.operators().min(all.len());
    let operator = |s: usize| match s.checked_sub(1).and_then(|s| all.get(s)) {
        Some(eta) => format!("X_{{{}}}", eta.display(Style::Latex)),
        None => format!("X_{{{s}}}"),
    };
    let mut lines = Vec::new();
    // The operators stand in for symbols of a sum, so that signs and brackets are set as in any other.
    let placeholders: Vec<Expr<'_>> = (1..=k).map(|m| graph.symbol(&format!("X_{m}"))).collect();
    let nonzero: Vec<_> = structure.nonzero().filter(|&(_, s, m, _)| s <= free && m <= k).collect();
    for pair in nonzero.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let sum = graph.sum(pair.iter().map(|&(_, _, m, c)| c * placeholders[m - 1]));
        let named = |text: String, &(_, _, m, _): &(usize, usize, usize, Expr<'_>)| {
            text.replace(&format!("X_{{{m}}}"), &operator(m))
        };
        let text = pair.iter().rev().fold(sum.display(Style::Latex), named);
        lines.push((format!("[{}, {}]", operator(pair[0].0), operator(pair[0].1)), text));
    }
    lines
}
