//! A page divided into parts with headings, which are the same in text and in LaTeX.

use pc_expr::{Given, Names, Side};
use pc_mech::{Expr, Graph, Matrix};
use pc_nonholo::ConstraintKind;

use crate::equations::sheet::{Balance, Bracket, Sheet};
use crate::layout::layout::Layout;

/// The contents under a heading.
#[derive(Clone, Debug)]
pub(crate) struct Part<'p> {
    pub(crate) heading: Heading,
    pub(crate) rows: Vec<Row<'p>>,
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
    MassMatrix,
    Momenta,
    QuasiVelocities,
    Hamiltonian,
    Equations,
    States,
    Energy,
    Reactions,
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
            Heading::MassMatrix => "Mass matrix",
            Heading::Momenta => "Momenta",
            Heading::QuasiVelocities => "Quasi-velocities",
            Heading::Hamiltonian => "Hamiltonian",
            Heading::Equations => "Equations",
            Heading::States => "States",
            Heading::Energy => "Energy",
            Heading::Reactions => "Reactions",
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
    /// X_s = Σ b_is ∂/∂x_i, with the name of η_s; for X_0 there is no name.
    Operator { quasi_velocity: Option<String>, components: Vec<(Expr<'p>, Expr<'p>)> },
    /// Q_s = value, identified by the name of η_s.
    Force { quasi_velocity: String, value: Expr<'p> },
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
            Row::Force { value, .. } | Row::Entry { value, .. } | Row::Function { value, .. } => {
                vec![Side::Sum(*value)]
            }
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

impl<'p> Sheet<'p> {
    fn parts(&self, page: &'p Graph, entries: bool) -> Vec<Part<'p>> {
        let part = |heading, rows| Part { heading, rows };
        let equations = |sides: &[(Expr<'p>, Expr<'p>)]| -> Vec<Row<'p>> {
            let different = sides.iter().filter(|(left, right)| left != right);
            different.map(|&(left, right)| Row::Equation { left, right }).collect()
        };
        let zip = |left: &[Expr<'p>], right: &[Expr<'p>]| -> Vec<(Expr<'p>, Expr<'p>)> {
            left.iter().copied().zip(right.iter().copied()).collect()
        };
        let constraints = self.constraints.iter().map(|(name, left, kind)| {
            let (name, left, kind) = (name.clone(), *left, *kind);
            Row::Constraint { name, left, kind }
        });
        let brackets = self.brackets.nonzero.iter();
        let brackets = brackets.map(|bracket| Row::Bracket(bracket.clone()));
        let mut parts = vec![
            part(Heading::Constraints, constraints.collect()),
            part(Heading::QuasiVelocities, equations(&self.changed)),
            part(Heading::Kinematics, equations(&self.rates)),
            part(Heading::Brackets, brackets.collect()),
        ];
        match &self.balance {
            Balance::Velocities { mass, accelerations, written, .. } => {
                if entries {
                    parts.push(part(Heading::MassMatrix, entry_rows(mass)));
                }
                let left = (0..mass.rows())
                    .map(|r| page.sum(mass.nonzero(r).map(|(s, entry)| entry * accelerations[s])));
                parts.push(part(Heading::Equations, equations(&zip(&left.collect::<Vec<_>>(), written))));
                parts.push(part(Heading::States, equations(&self.states)));
                parts.push(part(Heading::Energy, vec![Row::Function { letter: "E", value: self.energy }]));
                parts.push(part(Heading::Reactions, equations(&self.reactions)));
            }
            Balance::Momenta { momenta, rates, of_velocities, written, .. } => {
                parts.push(part(Heading::Momenta, equations(&zip(momenta, of_velocities))));
                parts.push(part(
                    Heading::Hamiltonian,
                    vec![Row::Function { letter: "H", value: self.energy }],
                ));
                parts.push(part(Heading::Equations, equations(&zip(rates, written))));
                parts.push(part(Heading::States, equations(&self.states)));
            }
        }
        parts
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

    /// Names for the quasi-velocities as functions of the momenta.
    fn velocity_names(&self) -> Vec<Given<'p>> {
        let Balance::Momenta { velocities: Some(values), .. } = &self.balance else { return Vec::new() };
        let names = self.quasi_velocities.iter().map(Expr::to_string);
        names.zip(values).map(|(name, &value)| Given { name, value, shorthand: true }).collect()
    }
}

/// The entries of a symmetric matrix that are not zero, those on and below its diagonal.
fn entry_rows<'p>(mass: &Matrix<Expr<'p>>) -> Vec<Row<'p>> {
    let below = |r| mass.nonzero(r).filter(move |&(s, _)| s <= r);
    let row = |r| below(r).map(move |(s, value)| Row::Entry { place: [r, s], value });
    (0..mass.rows()).flat_map(row).collect()
}
