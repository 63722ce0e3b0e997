//! Binding constraints, and the redundant constraints that follow from them.

use pc_mech::{Constraint, Expr, Graph, System};

use crate::classification::positions::{Place, Positions, norm};
use crate::error::NonholoError;

/// A unit vector may be linearly dependent on others if its part orthogonal to them is shorter than this, the
/// square root of a rounding error.
const DEPENDENT: f64 = 1e-7;

/// Coefficients count as linearly dependent on others where conditions on positions hold if the part of them
/// that is orthogonal to the others is, relative to that part at a distance of a hundredth of the system's
/// size, no longer than this: rounding errors leave as much.
const VANISHES: f64 = 1e-8;

/// A condition on positions follows from others if, where these hold, its residual in units of displacements
/// is no larger than this.
const FOLLOWS: f64 = 1e-9;

/// The number of points at which constraints that are dependent at the start are tested.
const PLACES: u64 = 6;

/// A constraint that follows from others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Redundant {
    /// Its name.
    pub constraint: String,
    /// The constraints from which it follows.
    pub follows_from: Vec<String>,
}

/// The constraints of a system, sorted by rank: those that bind it, and those that follow from them.
///
/// Conditions on velocities are C η + c_0 = 0; conditions on positions f = 0 have the coefficients C_s = X_s
/// f, c_0 = X_0 f. Dependence at almost all states is found exactly. An overconstrained mechanism has
/// conditions that are dependent only where all of them hold: if the start is such a state, dependence is
/// tested numerically at points around it that satisfy all conditions on positions, and a condition is
/// redundant if it vanishes near the start wherever the preceding conditions do.
///
/// ```
/// use pc_mech::{Constraint, Graph, System};
/// use pc_nonholo::Binding;
///
/// // Two cranks on one pin (x, y): the second one amounts to a bar that keeps a = b, and one condition is redundant.
/// let graph = Graph::new();
/// let cranks = System::builder(&graph)
///     .coordinates(["a", "b", "x", "y"])
///     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square() + v[3].square()) / 2.0)
///     .build()?;
/// let [t, a, b, x, y] = graph.symbols(["t", "a", "b", "x", "y"]);
/// let pin = [
///     Constraint::new("x of a", x - a.sin()),
///     Constraint::new("y of a", y + a.cos()),
///     Constraint::new("x of b", x - b.sin()),
///     Constraint::new("y of b", y + b.cos()),
/// ];
/// let start = [(t, 0.0), (a, 0.5), (b, 0.5), (x, 0.5f64.sin()), (y, -0.5f64.cos())];
/// let binding = Binding::new(&cranks, &pin, &start)?;
/// assert_eq!(binding.binding(), [0, 1, 2]);
/// assert_eq!(binding.redundant()[0].constraint, "y of b");
/// # Ok::<(), pc_nonholo::NonholoError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Binding {
    binding: Vec<usize>,
    redundant: Vec<Redundant>,
}

impl Binding {
    /// Sorts the constraints of a system. Conditions on positions come first: a condition on velocities may
    /// follow from them, but never the other way round. [Nonlinear](Constraint::nonlinear) constraints bind,
    /// and no other constraint follows from them.
    ///
    /// `at` are the values of time and coordinates at which the motion starts, and possibly values of other
    /// symbols.
    ///
    /// # Errors
    /// [`NonholoError::Contradictory`] for a constraint that contradicts others, so that no velocity
    /// satisfies them all; [`ConstraintError::NotAffine`](pc_mech::ConstraintError::NotAffine).
    pub fn new<'g>(
        system: &System<'g>,
        constraints: &[Constraint<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Result<Binding, NonholoError> {
        let (nonlinear, affine): (Vec<usize>, Vec<usize>) =
            (0..constraints.len()).partition(|&a| constraints[a].is_nonlinear());
        let (positions, velocities): (Vec<usize>, Vec<usize>) =
            affine.into_iter().partition(|&a| constraints[a].is_holonomic(system));
        let mut found =
            Found { system, constraints, rows: Rows::default(), redundant: Vec::new(), open: Vec::new() };
        for a in positions.into_iter().chain(velocities) {
            found.add(a)?;
        }
        found.look_where_they_hold(at)?;
        if let Some((a, others)) = found.open.into_iter().next() {
            return Err(NonholoError::Contradictory { constraint: constraints[a].name().to_owned(), others });
        }
        let mut binding = [nonlinear, found.rows.places].concat();
        binding.sort_unstable();
        Ok(Binding { binding, redundant: found.redundant })
    }

    /// The indices of the binding constraints, in ascending order.
    pub fn binding(&self) -> &[usize] {
        &self.binding
    }

    /// The redundant constraints.
    pub fn redundant(&self) -> &[Redundant] {
        &self.redundant
    }
}

/// Constraints that are independent at almost all states, with their coefficients C_α and c_α0.
#[derive(Default)]
struct Rows<'g> {
    places: Vec<usize>,
    rows: Vec<Vec<Expr<'g>>>,
    whole: Vec<Vec<Expr<'g>>>,
}

struct Found<'a, 'g> {
    system: &'a System<'g>,
    constraints: &'a [Constraint<'g>],
    rows: Rows<'g>,
    redundant: Vec<Redundant>,
    /// Constraints on velocities that contradict others at almost all states, each with the names of the
    /// constraints that it contradicts.
    open: Vec<(usize, Vec<String>)>,
}

impl<'g> Found<'_, 'g> {
    /// Adds a constraint according to its rank at almost all states.
    fn add(&mut self, a: usize) -> Result<(), NonholoError> {
        let (graph, constraint) = (self.system.graph(), &self.constraints[a]);
        let (row, whole) = self.coefficients(a)?;
        let rank = |known: &[Vec<Expr<'g>>], more: &[Expr<'g>]| {
            graph.generic_rank(&[known, std::slice::from_ref(&more.to_vec())].concat())
        };
        if rank(&self.rows.rows, &row) > self.rows.rows.len() {
            self.rows.places.push(a);
            self.rows.rows.push(row);
            self.rows.whole.push(whole);
            return Ok(());
        }
        let name = constraint.name().to_owned();
        let others = self.named(self.rows.depends_on(graph, &row));
        if rank(&self.rows.whole, &whole) == self.rows.whole.len() {
            self.redundant.push(Redundant { constraint: name, follows_from: others });
        } else if constraint.is_holonomic(self.system) || !self.has_positions() {
            return Err(NonholoError::Contradictory { constraint: name, others });
        } else {
            self.open.push((a, others));
        }
        Ok(())
    }

    /// C, and C and c_0.
    fn coefficients(&self, a: usize) -> Result<(Vec<Expr<'g>>, Vec<Expr<'g>>), NonholoError> {
        let (row, rest) = self.constraints[a].coefficients(self.system)?;
        let whole = row.iter().copied().chain([rest]).collect();
        Ok((row, whole))
    }

    fn has_positions(&self) -> bool {
        self.rows.places.iter().any(|&a| self.constraints[a].is_holonomic(self.system))
    }

    fn named(&self, places: Vec<usize>) -> Vec<String> {
        places.into_iter().map(|a| self.constraints[a].name().to_owned()).collect()
    }

    /// Finds the constraints that depend on others where all conditions on positions hold, if there are any
    /// such constraints at the start.
    fn look_where_they_hold(&mut self, at: &[(Expr<'g>, f64)]) -> Result<(), NonholoError> {
        let Some(start) = self.start(at).filter(|_| self.rows.places.len() + self.open.len() > 1) else {
            return Ok(());
        };
        let holonomic: Vec<usize> = self
            .rows
            .places
            .iter()
            .copied()
            .filter(|&a| self.constraints[a].is_holonomic(self.system))
            .collect();
        if holonomic.is_empty() {
            return Ok(());
        }
        let positions = self.positions(&holonomic);
        let on = |place: &Place| {
            if positions.off(place) <= FOLLOWS { Some(place.clone()) } else { positions.near(place) }
        };
        let Some(start) = on(&start) else { return Ok(()) };
        let Some(here) = self.at(&positions, std::slice::from_ref(&start)) else { return Ok(()) };
        if self.open.is_empty() && are_independent(&here[0]) {
            return Ok(());
        }
        let around: Vec<Place> = (0..PLACES).map(|index| start.varied(index)).collect();
        let places: Vec<Place> = around.iter().filter_map(|place| positions.near(place)).collect();
        let (Some(on), Some(off)) = (self.at(&positions, &places), self.at(&positions, &around)) else {
            return Ok(());
        };
        if on.len() > 1 { self.drop_dependent(&Looked { on, off }, &start) } else { Ok(()) }
    }

    /// The time and coordinates in `at`.
    fn start(&self, at: &[(Expr<'g>, f64)]) -> Option<Place> {
        let value = |symbol: Expr<'g>| at.iter().find(|(known, _)| *known == symbol).map(|&(_, value)| value);
        let frame = self.system.frame();
        let x = frame.coordinates().iter().map(|&x| value(x)).collect::<Option<Vec<f64>>>()?;
        Some(Place { t: value(frame.time()).unwrap_or(0.0), x })
    }

    fn positions(&self, places: &[usize]) -> Positions<'g> {
        let functions: Vec<Expr<'g>> = places.iter().map(|&a| self.constraints[a].expression()).collect();
        Positions::new(self.system, &functions)
    }

    /// The coefficients C and c_0 of the independent constraints, then of the `open` ones, at each of the
    /// points `places`.
    fn at(&self, positions: &Positions<'g>, places: &[Place]) -> Option<Vec<Vec<Vec<f64>>>> {
        let width = self.system.quasi_velocities().len() + 1;
        let mut whole: Vec<Expr<'g>> = self.rows.whole.iter().flatten().copied().collect();
        for (a, _) in &self.open {
            whole.extend(self.coefficients(*a).ok()?.1);
        }
        places
            .iter()
            .map(|place| {
                Some(positions.evaluate(&whole, place)?.chunks(width).map(<[f64]>::to_vec).collect())
            })
            .collect()
    }

    /// Drops constraints that depend on preceding ones where all conditions on positions hold; a condition on
    /// positions is dropped only if it follows from preceding ones.
    fn drop_dependent(&mut self, looked: &Looked, start: &Place) -> Result<(), NonholoError> {
        let rows = std::mem::take(&mut self.rows);
        let first_open = rows.places.len();
        let mut kept = Vec::new();
        let coefficients = rows.rows.into_iter().zip(rows.whole);
        for (index, (&a, (row, whole))) in rows.places.iter().zip(coefficients).enumerate() {
            let follows = looked.depends(&kept, index, Part::Velocities)
                && (!self.constraints[a].is_holonomic(self.system) || self.vanishes(a, start));
            if follows {
                self.settle(a, looked, &kept, index)?;
            } else {
                kept.push(index);
                self.rows.places.push(a);
                self.rows.rows.push(row);
                self.rows.whole.push(whole);
            }
        }
        for (offset, (a, others)) in std::mem::take(&mut self.open).into_iter().enumerate() {
            match looked.depends(&kept, first_open + offset, Part::Whole) {
                true => self.settle(a, looked, &kept, first_open + offset)?,
                false => self.open.push((a, others)),
            }
        }
        Ok(())
    }

    /// Settles a constraint whose coefficients C are linearly dependent on those of the `kept` constraints:
    /// drops it if they remain so with c_0 included; otherwise it contradicts the `kept` constraints.
    fn settle(
        &mut self,
        a: usize,
        looked: &Looked,
        kept: &[usize],
        index: usize,
    ) -> Result<(), NonholoError> {
        let needed = (0..kept.len()).filter(|&place| {
            let others = [&kept[..place], &kept[place + 1..]].concat();
            !looked.depends(&others, index, Part::Whole)
        });
        let needed: Vec<usize> = needed.map(|place| self.rows.places[place]).collect();
        let (constraint, others) = (self.constraints[a].name().to_owned(), self.named(needed));
        if !looked.depends(kept, index, Part::Whole) {
            return Err(NonholoError::Contradictory { constraint, others });
        }
        self.redundant.push(Redundant { constraint, follows_from: others });
        Ok(())
    }

    /// Whether a condition on positions vanishes near the start wherever the kept conditions vanish.
    fn vanishes(&self, a: usize, start: &Place) -> bool {
        let holonomic =
            self.rows.places.iter().copied().filter(|&b| self.constraints[b].is_holonomic(self.system));
        let (kept, own) = (self.positions(&holonomic.collect::<Vec<_>>()), self.positions(&[a]));
        let places: Vec<Place> = (0..PLACES).filter_map(|index| kept.near(&start.varied(index))).collect();
        places.len() > 1 && places.iter().all(|place| own.off(place) <= FOLLOWS)
    }
}

impl<'g> Rows<'g> {
    /// The constraints of which `row` is a linear combination; each of them is necessary.
    fn depends_on(&self, graph: &'g Graph, row: &[Expr<'g>]) -> Vec<usize> {
        let independent_without = |a: &usize| {
            let mut rows = self.rows.clone();
            rows[*a] = row.to_vec();
            graph.generic_rank(&rows) == rows.len()
        };
        (0..self.rows.len()).filter(independent_without).map(|a| self.places[a]).collect()
    }
}

/// Which coefficients of a constraint are tested.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    /// C
    Velocities,
    /// C and c_0
    Whole,
}

/// The coefficients C and c_0 of each constraint, at points where all conditions on positions hold (`on`) and
/// at points around them (`off`).
struct Looked {
    on: Vec<Vec<Vec<f64>>>,
    off: Vec<Vec<Vec<f64>>>,
}

impl Looked {
    /// Whether a constraint depends on others where conditions on positions hold: the part of its
    /// coefficients that is orthogonal to theirs is then negligible relative to that part nearby, in any
    /// units.
    fn depends(&self, on: &[usize], index: usize, part: Part) -> bool {
        let left = |places: &[Vec<Vec<f64>>]| {
            let left = places.iter().map(|place| {
                let width = place[index].len() - usize::from(part == Part::Velocities);
                let mut span = Span::default();
                on.iter().for_each(|&other| {
                    span.add(&place[other][..width]);
                });
                span.left_of(&place[index][..width])
            });
            left.fold(0.0, f64::max)
        };
        left(&self.on) <= VANISHES * left(&self.off)
    }
}

/// Whether the coefficients C of constraints, given with c_0, are independent, as far as this can be decided
/// in the given units.
fn are_independent(whole: &[Vec<f64>]) -> bool {
    let mut span = Span::default();
    whole.iter().all(|whole| span.add(&whole[..whole.len() - 1]) > DEPENDENT)
}

/// The span of vectors, as an orthonormal basis.
#[derive(Default)]
struct Span(Vec<Vec<f64>>);

impl Span {
    /// The part of a vector, scaled to length one, that is orthogonal to the span.
    fn rest(&self, vector: &[f64]) -> Vec<f64> {
        let mut rest = unit(vector);
        // Two passes are enough [W. Kahan, B. N. Parlett].
        for known in self.0.iter().chain(&self.0) {
            let along: f64 = known.iter().zip(&rest).map(|(a, b)| a * b).sum();
            rest.iter_mut().zip(known).for_each(|(rest, known)| *rest -= along * known);
        }
        rest
    }

    /// The length of the part of a vector, scaled to length one, that is orthogonal to the span.
    fn left_of(&self, vector: &[f64]) -> f64 {
        norm(&self.rest(vector))
    }

    /// Adds a vector to the span. Returns what `left_of` gives for the vector before it is added.
    fn add(&mut self, vector: &[f64]) -> f64 {
        let rest = self.rest(vector);
        let left = norm(&rest);
        if left > 0.0 {
            self.0.push(unit(&rest));
        }
        left
    }
}

/// The vector scaled to length one; unchanged if it is zero.
fn unit(vector: &[f64]) -> Vec<f64> {
    let length = norm(vector);
    vector.iter().map(|entry| if length > 0.0 { entry / length } else { 0.0 }).collect()
}
