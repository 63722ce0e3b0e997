//! A page divided into parts with headings, which are the same in text and in LaTeX.

use pc_expr::{Given, Names, Side};
use pc_mech::{Expr, Graph, Matrix};
use pc_nonholo::ConstraintKind;

use crate::equations::principle::{ForceSheet, InertiaSheet, MaggiSheet};
use crate::equations::sheet::{Balance, Bracket, Sheet};
use crate::layout::layout::Layout;

/// The contents under a heading.
#[derive(Clone, Debug)]
pub(crate) struct Part<'p> {
    pub(crate) heading: Heading,
    pub(crate) rows: Vec<Row<'p>>,
}

impl<'p> Part<'p> {
    /// Writes brackets by their coefficients.
    fn write_symbols(&mut self) {
        if self.heading != Heading::Brackets || self.rows.is_empty() {
            return;
        }
        let symbols = self.rows.iter().flat_map(|row| match row {
            Row::Bracket(Bracket { pair: [r, s], components }) => components
                .iter()
                .map(|&(m, value)| Row::Symbol { indices: [*r, *s, m], value })
                .collect::<Vec<_>>(),
            _ => Vec::new(),
        });
        *self = Part { heading: Heading::HamelSymbols, rows: symbols.collect() };
    }
}

/// What a part is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Heading {
    Constraints,
    Operators,
    Lagrangian,
    Forces,
    Kinematics,
    Brackets,
    HamelSymbols,
    MassMatrix,
    Momenta,
    QuasiVelocities,
    Hamiltonian,
    LagrangeExpressions,
    PartialVelocities,
    ActiveForces,
    InertiaForces,
    GibbsFunction,
    Equations,
    States,
    Energy,
    Reactions,
    ReactionForces,
}

impl Heading {
    pub(crate) fn text(self) -> &'static str {
        match self {
            Heading::Constraints => "Constraints",
            Heading::Operators => "Operators",
            Heading::Lagrangian => "Lagrangian",
            Heading::Forces => "Forces",
            Heading::Kinematics => "Kinematics",
            Heading::Brackets => "Brackets",
            Heading::HamelSymbols => "Symbols of Boltzmann and Hamel",
            Heading::MassMatrix => "Mass matrix",
            Heading::Momenta => "Momenta",
            Heading::QuasiVelocities => "Quasi-velocities",
            Heading::Hamiltonian => "Hamiltonian",
            Heading::LagrangeExpressions => "Lagrange's expressions",
            Heading::PartialVelocities => "Partial velocities",
            Heading::ActiveForces => "Active forces",
            Heading::InertiaForces => "Inertia forces",
            Heading::GibbsFunction => "Gibbs' function",
            Heading::Equations => "Equations",
            Heading::States => "States",
            Heading::Energy => "Energy",
            Heading::Reactions => "Reactions",
            Heading::ReactionForces => "Reaction forces",
        }
    }
}

/// A row of a part.
#[derive(Clone, Debug)]
pub(crate) enum Row<'p> {
    /// A constraint: `name: left = 0 (kind)`.
    Constraint { name: String, left: Expr<'p>, kind: ConstraintKind },
    /// left = right
    Equation { left: Expr<'p>, right: Expr<'p> },
    /// [X_r, X_s] = Σ c X_m
    Bracket(Bracket<'p>),
    /// γ_rs^m = value, with the indices r, s, m.
    Symbol { indices: [usize; 3], value: Expr<'p> },
    /// X_s = Σ b_is ∂/∂x_i, with the name of η_s; for X_0 there is no name.
    Operator { quasi_velocity: Option<String>, components: Vec<(Expr<'p>, Expr<'p>)> },
    /// The force of this letter along η_s, identified by the name of η_s: Q, F, F* for inertia, R for reactions.
    Force { letter: &'static str, quasi_velocity: String, value: Expr<'p> },
    /// ∂ẋ_i/∂η_s = value, with the symbols of ẋ_i and η_s.
    PartialVelocity { rate: Expr<'p>, quasi_velocity: Expr<'p>, value: Expr<'p> },
    /// An entry M_rs.
    Entry { place: [usize; 2], value: Expr<'p> },
    /// A function with the letter that denotes it.
    Function { letter: &'static str, value: Expr<'p> },
}

impl<'p> Row<'p> {
    /// The expressions in this row.
    fn sides(&self) -> Vec<Side<'p>> {
        match self {
            Row::Constraint { left, .. } => vec![Side::Sum(*left)],
            Row::Equation { left, right } => vec![Side::Sum(*left), Side::Sum(*right)],
            Row::Bracket(bracket) => bracket.components.iter().map(|&(_, c)| Side::Factor(c)).collect(),
            Row::Operator { components, .. } => components.iter().map(|&(_, c)| Side::Factor(c)).collect(),
            Row::Force { value, .. }
            | Row::PartialVelocity { value, .. }
            | Row::Symbol { value, .. }
            | Row::Entry { value, .. }
            | Row::Function { value, .. } => vec![Side::Sum(*value)],
        }
    }
}

/// The parts of a page, with the names that they use.
pub(crate) struct Parts<'p> {
    pub(crate) parts: Vec<Part<'p>>,
    pub(crate) names: Names<'p>,
    /// The index of the first line of each part.
    starts: Vec<usize>,
}

impl<'p> Parts<'p> {
    /// The parts of a sheet, with names for long expressions; with `entries` the mass matrix is a part of its
    /// own, which shortens left-hand sides.
    pub(crate) fn new(sheet: &Sheet<'p>, layout: &Layout, page: &'p Graph, entries: bool) -> Parts<'p> {
        let mut given: Vec<Given<'p>> = if layout.inline { Vec::new() } else { sheet.definitions.clone() };
        let mut parts = sheet.parts(page, entries);
        if layout.symbols {
            parts.iter_mut().for_each(Part::write_symbols);
        }
        if entries {
            given.extend(sheet.entry_names());
        }
        given.extend(sheet.velocity_names());
        let mut named = names(&parts, &given, layout, page);
        let early = used_before_matrix(&parts, &named);
        if !early.is_empty() {
            given.retain(|given| !given.shorthand || !early.contains(&given.name));
            named = names(&parts, &given, layout, page);
        }
        let velocities: Vec<Row<'p>> = sheet
            .velocity_names()
            .into_iter()
            .filter(|velocity| named.list().iter().any(|name| name.shorthand && name.name == velocity.name))
            // Those that are velocities are part of the kinematics.
            .filter(|velocity| !sheet.rates.iter().any(|(rate, _)| rate.to_string() == velocity.name))
            .map(|velocity| Row::Equation { left: page.symbol(&velocity.name), right: velocity.value })
            .collect();
        if !velocities.is_empty() {
            // They precede their uses.
            parts.insert(0, Part { heading: Heading::QuasiVelocities, rows: velocities });
            named = names(&parts, &given, layout, page);
        }
        parts.retain(|part| !part.rows.is_empty() || part.heading == Heading::Brackets);
        Parts::of(parts, named)
    }

    /// The parts, with given names for their expressions.
    fn of(parts: Vec<Part<'p>>, names: Names<'p>) -> Parts<'p> {
        let starts = parts.iter().scan(0, |next, part| {
            let start = *next;
            *next += part.rows.iter().map(|row| row.sides().len()).sum::<usize>();
            Some(start)
        });
        let starts = starts.collect();
        Parts { parts, names, starts }
    }

    /// Parts with names for long expressions, including the names that are `given`.
    pub(crate) fn named(
        mut parts: Vec<Part<'p>>,
        given: &[Given<'p>],
        layout: &Layout,
        page: &'p Graph,
    ) -> Parts<'p> {
        parts.retain(|part| !part.rows.is_empty());
        let named = names(&parts, given, layout, page);
        Parts::of(parts, named)
    }

    /// The parts, each with the indices of the names first used in it.
    pub(crate) fn with_names(&self) -> impl Iterator<Item = (&Part<'p>, Vec<usize>)> {
        self.parts.iter().enumerate().map(|(i, part)| {
            let end = self.starts.get(i + 1).copied().unwrap_or(usize::MAX);
            let here = |&(_, name): &(usize, &pc_expr::Name<'p>)| {
                !name.shorthand && (self.starts[i]..end).contains(&name.line)
            };
            (part, self.names.list().iter().enumerate().filter(here).map(|(number, _)| number).collect())
        })
    }
}

/// The names of entries of the mass matrix that are used before the matrix is printed.
fn used_before_matrix(parts: &[Part<'_>], named: &Names<'_>) -> Vec<String> {
    let before = parts.iter().take_while(|part| part.heading != Heading::MassMatrix);
    let lines: usize = before.flat_map(|part| &part.rows).map(|row| row.sides().len()).sum();
    let has_matrix = parts.iter().any(|part| part.heading == Heading::MassMatrix);
    let early = named.list().iter().filter(|name| has_matrix && name.shorthand && name.line < lines);
    early.map(|name| name.name.clone()).collect()
}

fn names<'p>(parts: &[Part<'p>], given: &[Given<'p>], layout: &Layout, page: &'p Graph) -> Names<'p> {
    let sides: Vec<Side<'p>> = parts.iter().flat_map(|part| &part.rows).flat_map(Row::sides).collect();
    page.names(&sides, given, layout.room())
}

/// The name of an entry of the mass matrix.
pub(crate) fn entry_name(sheet: &Sheet<'_>, [r, s]: [usize; 2]) -> String {
    format!("M({}, {})", sheet.quasi_velocities[r], sheet.quasi_velocities[s])
}

/// The equations `left = right`, one for each pair of different sides.
fn equations<'p>(sides: impl IntoIterator<Item = (Expr<'p>, Expr<'p>)>) -> Vec<Row<'p>> {
    let different = sides.into_iter().filter(|(left, right)| left != right);
    different.map(|(left, right)| Row::Equation { left, right }).collect()
}

fn zip<'p>(left: &[Expr<'p>], right: &[Expr<'p>]) -> Vec<Row<'p>> {
    equations(left.iter().copied().zip(right.iter().copied()))
}

fn part<'p>(heading: Heading, rows: Vec<Row<'p>>) -> Part<'p> {
    Part { heading, rows }
}

impl<'p> Sheet<'p> {
    fn parts(&self, page: &'p Graph, entries: bool) -> Vec<Part<'p>> {
        let constraints = self.constraints.iter().map(|(name, left, kind)| {
            let (name, left, kind) = (name.clone(), *left, *kind);
            Row::Constraint { name, left, kind }
        });
        let mut parts = vec![
            part(Heading::Constraints, constraints.collect()),
            part(Heading::QuasiVelocities, equations(self.changed.iter().copied())),
            part(Heading::Kinematics, equations(self.rates.iter().copied())),
        ];
        let brackets = self.brackets.nonzero.iter();
        let brackets =
            part(Heading::Brackets, brackets.map(|bracket| Row::Bracket(bracket.clone())).collect());
        let states = part(Heading::States, equations(self.states.iter().copied()));
        match &self.balance {
            Balance::Velocities { mass, accelerations, written, .. } => {
                parts.push(brackets);
                if entries {
                    parts.push(part(Heading::MassMatrix, entry_rows(mass)));
                }
                let left = (0..mass.rows())
                    .map(|r| page.sum(mass.nonzero(r).map(|(s, entry)| entry * accelerations[s])));
                parts.push(part(Heading::Equations, zip(&left.collect::<Vec<_>>(), written)));
                parts.push(states);
                parts.extend(self.energy_and_reactions());
            }
            Balance::Momenta { momenta, rates, of_velocities, written, .. } => {
                parts.push(brackets);
                parts.push(part(Heading::Momenta, zip(momenta, of_velocities)));
                parts.push(part(
                    Heading::Hamiltonian,
                    vec![Row::Function { letter: "H", value: self.energy }],
                ));
                parts.push(part(Heading::Equations, zip(rates, written)));
                parts.push(states);
            }
            Balance::Maggi(maggi) => {
                parts.extend(maggi.parts());
                parts.push(states);
                parts.extend(self.energy_and_reactions());
            }
            Balance::Forces(forces) => {
                parts.extend(forces.parts(self));
                parts.push(states);
                parts.extend(self.energy_and_reactions());
            }
        }
        parts
    }

    fn energy_and_reactions(&self) -> [Part<'p>; 3] {
        let forces = self.reaction_forces.iter().map(|&(eta, value)| Row::Force {
            letter: "R",
            quasi_velocity: eta.to_string(),
            value,
        });
        [
            part(Heading::Energy, vec![Row::Function { letter: "E", value: self.energy }]),
            part(Heading::Reactions, equations(self.reactions.iter().copied())),
            part(Heading::ReactionForces, forces.collect()),
        ]
    }

    /// Names for the entries of the mass matrix, which is printed.
    fn entry_names(&self) -> Vec<Given<'p>> {
        let Balance::Velocities { mass, .. } = &self.balance else { return Vec::new() };
        let entries = entry_rows(mass).into_iter().filter_map(|row| match row {
            Row::Entry { place, value } => {
                Some(Given { name: entry_name(self, place), value, shorthand: true })
            }
            _ => None,
        });
        entries.collect()
    }

    /// The entries of b that are not zero.
    fn partial_velocities(&self) -> Vec<Row<'p>> {
        let (b, eta) = (&self.frame.0, &self.quasi_velocities);
        let row = |i: usize| {
            let rate = self.rates[i].0;
            b.nonzero(i).map(move |(s, value)| Row::PartialVelocity { rate, quasi_velocity: eta[s], value })
        };
        (0..b.rows()).flat_map(row).collect()
    }

    /// Names for the quasi-velocities as functions of the momenta.
    fn velocity_names(&self) -> Vec<Given<'p>> {
        let Balance::Momenta { velocities: Some(values), .. } = &self.balance else { return Vec::new() };
        let names = self.quasi_velocities.iter().map(Expr::to_string);
        names.zip(values).map(|(name, &value)| Given { name, value, shorthand: true }).collect()
    }
}

impl<'p> MaggiSheet<'p> {
    fn parts(&self) -> Vec<Part<'p>> {
        let sums = self.sums.iter().map(|&sum| (sum, Expr::ZERO));
        vec![
            part(Heading::LagrangeExpressions, equations(self.expressions.iter().copied())),
            part(Heading::Equations, equations(sums)),
        ]
    }
}

impl<'p> ForceSheet<'p> {
    fn parts(&self, sheet: &Sheet<'p>) -> Vec<Part<'p>> {
        let forces = |letter: &'static str, values: &[Expr<'p>]| -> Vec<Row<'p>> {
            let along = sheet.quasi_velocities.iter().zip(values);
            along.map(|(eta, &value)| Row::Force { letter, quasi_velocity: eta.to_string(), value }).collect()
        };
        let equations = part(Heading::Equations, zip(&self.slopes, &self.active));
        match &self.inertia {
            InertiaSheet::Forces(inertia) => vec![
                part(Heading::PartialVelocities, sheet.partial_velocities()),
                part(Heading::ActiveForces, forces("F", &self.active)),
                part(Heading::InertiaForces, forces("F*", inertia)),
                equations,
            ],
            &InertiaSheet::Gibbs(value) => vec![
                part(Heading::GibbsFunction, vec![Row::Function { letter: "S", value }]),
                part(Heading::ActiveForces, forces("Q", &self.active)),
                equations,
            ],
        }
    }
}

/// The entries of a symmetric matrix that are not zero, those on and below its diagonal.
fn entry_rows<'p>(mass: &Matrix<Expr<'p>>) -> Vec<Row<'p>> {
    let below = |r| mass.nonzero(r).filter(move |&(s, _)| s <= r);
    let row = |r| below(r).map(move |(s, value)| Row::Entry { place: [r, s], value });
    (0..mass.rows()).flat_map(row).collect()
}
