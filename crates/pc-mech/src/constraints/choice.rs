//! The choice of independent quasi-velocities: those requested, or those whose equations are shortest.

use pc_algebra::Matrix;
use pc_expr::Expr;

use crate::constraints::multipliers::Multipliers;
use crate::equations::poincare::Equations;
use crate::error::{ConstraintError, MechError};

/// The maximum number of choices whose equations are compared.
const MOST_TRIED: usize = 20;
/// Equations are compared only if there are at most this many constraints and the Lagrangian has at most this
/// many operations.
const MOST_SOLVED: usize = 3;
const LONGEST_TRIED: u32 = 1000;
/// A choice is regular if its determinant, in the kinetic metric, is at least this fraction of the largest: the
/// motion then stays away from states with singular equations for a while.
const REGULAR: f64 = 0.5;
/// A choice that is regular everywhere is taken with a determinant of this fraction of the largest.
const REGULAR_EVERYWHERE: f64 = 0.1;
/// The number of states at which determinants are compared, and how far from the given values they reach, in units of 1 +
/// |x|: an angle passes through a turn.
const STATES: usize = 48;
const REACH: f64 = 3.2;
const NEAR: f64 = 0.5;
/// A choice whose determinant falls below this fraction of the largest at one of the states has a pole nearby.
const POLE: f64 = 0.02;
/// A pivot chosen because it is the shortest in print must be at least this fraction of the largest, so that
/// equations lose at most one digit. (There is a second reason to derive the equations of only a few choices:
/// expressions formed earlier in a graph influence the form of later ones.)
const PIVOT: f64 = 0.1;

/// The matrix C at a state, with its rows scaled to length one and its columns divided by the square roots of
/// the masses, so that the matrix does not depend on units.
struct Weighed {
    rows: Vec<Vec<f64>>,
}

impl<'g> Multipliers<'g> {
    /// The equations with these k − m quasi-velocities as the
    /// [independent](Multipliers::in_independent_velocities) ones.
    ///
    /// # Errors
    /// [`ConstraintError::NotIndependent`] if the number of quasi-velocities is wrong, one of them does not belong
    /// to the system, or they do not determine the others at the values `at` of time, coordinates, quasi-velocities
    /// and parameters.
    ///
    /// ```
    /// use pc_mech::{Constraint, Graph, System};
    ///
    /// // A pendulum: one of ẋ and ẏ is free.
    /// let graph = Graph::new();
    /// let pendulum = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - 10.0 * x[1])
    ///     .build()?;
    /// let [x, y, vx, vy] = graph.symbols(["x", "y", "x'", "y'"]);
    /// let held = pendulum.with_multipliers(&[Constraint::new("length", x.square() + y.square() - 1.0)])?;
    /// let at = [(x, 0.6), (y, -0.8), (vx, 0.0), (vy, 0.0)];
    /// let chosen = held.with_independent(&[vy], &at)?;
    /// assert_eq!(chosen.in_independent_velocities(&at)?.quasi_velocities(), [vy]);
    /// let below = [(x, 0.0), (y, -1.0), (vx, 0.0), (vy, 0.0)];
    /// assert!(held.with_independent(&[vy], &below).is_err());
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn with_independent(
        &self,
        independent: &[Expr<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Result<Multipliers<'g>, MechError> {
        let eta = self.equations().system().quasi_velocities();
        let refuse = |why: String| {
            let chosen = independent.iter().map(Expr::to_string).collect();
            Err(ConstraintError::NotIndependent { chosen, why }.into())
        };
        let names = || eta.iter().map(Expr::to_string).collect::<Vec<_>>().join(", ");
        if let Some(stray) = independent.iter().find(|name| !eta.contains(name)) {
            return refuse(format!("`{stray}` is not among them; they are {}", names()));
        }
        let dependent: Vec<usize> = (0..eta.len()).filter(|&s| !independent.contains(&eta[s])).collect();
        let m = self.constraints().len();
        if dependent.len() != m {
            let free = eta.len() - m;
            return refuse(format!("the constraints leave {free} of {} free", names()));
        }
        if !self.determines(&dependent, at)? {
            return refuse("with the constraints they do not determine the others at the start".to_owned());
        }
        Ok(self.depending(dependent))
    }

    /// Of all equations in independent quasi-velocities that are regular at the values `at`, those that are
    /// shortest in print, as derived by `derive`. Among equally short equations, those with the best
    /// conditioned constraints are taken. Choices without a pole in the reach of the motion come first: one that has none
    /// in a neighbourhood of the values is preferred to any that has.
    ///
    /// If there are more than 20 choices or more than 3 constraints, or the Lagrangian is long, no equations are
    /// compared: C is then eliminated, each time with the pivot that is shortest in print among those that are at
    /// least a tenth of the largest.
    ///
    /// # Errors
    /// The errors of [`dependent_at`](Multipliers::dependent_at).
    pub fn shortest<E>(
        &self,
        at: &[(Expr<'g>, f64)],
        derive: impl Fn(&Multipliers<'g>) -> Result<Equations<'g>, E>,
    ) -> Result<Multipliers<'g>, MechError> {
        let best = self.dependent_at(at)?;
        let is_given = self.dependent.as_ref() == Some(&best);
        let (k, m) = (self.coefficients().columns(), self.constraints().len());
        if is_given || self.is_nonlinear() || m == 0 {
            return Ok(self.depending(best));
        }
        let weighed = self.weighed(at)?;
        let lagrangian = self.equations().system().lagrangian();
        let is_short = m <= MOST_SOLVED && lagrangian.tree_cost() <= LONGEST_TRIED;
        let Some(choices) = choices(k, m).filter(|_| is_short) else {
            return Ok(self.depending(weighed.shortest_pivots(self.coefficients()).unwrap_or(best)));
        };
        let largest = choices.iter().map(|choice| weighed.determinant(choice).abs()).fold(0.0, f64::max);
        let regular = |choice: &Vec<usize>, part: f64| weighed.determinant(choice).abs() >= part * largest;
        let everywhere: Vec<Vec<usize>> = self
            .without_poles(&choices, at, REACH)
            .into_iter()
            .filter(|choice| regular(choice, REGULAR_EVERYWHERE))
            .collect();
        let candidates = if everywhere.is_empty() {
            let others = choices.into_iter().filter(|choice| *choice != best && regular(choice, REGULAR));
            std::iter::once(best.clone()).chain(others).collect()
        } else {
            everywhere
        };
        let tried = candidates.into_iter().filter_map(|choice| {
            let chosen = self.depending(choice);
            // One choice may fail where another succeeds; if all fail, the error is that of the best.
            derive(&chosen).ok().map(|equations| (printed_length(&equations), chosen))
        });
        let shortest = tried.min_by_key(|&(length, _)| length).map(|(_, chosen)| chosen);
        Ok(shortest.unwrap_or_else(|| self.depending(best)))
    }

    /// Whether the constraints determine these dependent quasi-velocities at the values and at all states near them, up to
    /// about half the size of a coordinate or a radian away.
    pub fn determines_near(&self, dependent: &[usize], at: &[(Expr<'g>, f64)]) -> bool {
        !self.without_poles(&[dependent.to_vec()], at, NEAR).is_empty()
    }

    /// Those of the choices of dependent quasi-velocities that determine these at all states as far from the values as
    /// `reach`, in units of 1 + |x|: their determinants keep their signs, and stay comparable to the largest of the state
    /// and to their own.
    fn without_poles(&self, choices: &[Vec<usize>], at: &[(Expr<'g>, f64)], reach: f64) -> Vec<Vec<usize>> {
        let x = self.equations().system().frame().coordinates();
        let primes = (2u32..).filter(|n| (2..*n).all(|d| n % d != 0));
        let roots: Vec<f64> = primes.take(x.len()).map(|p| f64::from(p).sqrt()).collect();
        let beside = |number: usize| -> Vec<(Expr<'g>, f64)> {
            let side = |i: usize| 2.0 * (number as f64 * roots[i]).fract() - 1.0;
            let moved = |&(symbol, value): &(Expr<'g>, f64)| match x.iter().position(|&x| x == symbol) {
                Some(i) => (symbol, value + reach * (1.0 + value.abs()) * side(i)),
                None => (symbol, value),
            };
            at.iter().map(moved).collect()
        };
        // Where C is not defined, nothing is compared.
        let states = std::iter::once(at.to_vec()).chain((1..STATES).map(beside));
        let determinants: Vec<Vec<f64>> = states
            .filter_map(|state| self.weighed(&state).ok())
            .filter(Weighed::is_finite)
            .map(|weighed| choices.iter().map(|choice| weighed.determinant(choice)).collect())
            .collect();
        let is_regular = |choice: &usize| {
            let sizes = determinants.iter().map(|state| state[*choice].abs());
            let own = sizes.fold(0.0, f64::max);
            let is_large = |state: &Vec<f64>| {
                let largest = state.iter().fold(own, |largest, determinant| largest.max(determinant.abs()));
                state[*choice].abs() > POLE * largest
            };
            let positive = determinants.iter().filter(|state| state[*choice] > 0.0).count();
            (positive == 0 || positive == determinants.len()) && determinants.iter().all(is_large)
        };
        (0..choices.len()).filter(is_regular).map(|choice| choices[choice].clone()).collect()
    }

    fn weighed(&self, at: &[(Expr<'g>, f64)]) -> Result<Weighed, MechError> {
        let (system, c) = (self.equations().system(), self.coefficients());
        let (graph, k) = (system.graph(), c.columns());
        let mass = self.equations().mass_matrix();
        let entries: Vec<Expr<'g>> =
            (0..k).map(|s| mass[(s, s)]).chain(c.entries().iter().copied()).collect();
        let values = graph.evaluate(&entries, &[system.parameters(), at].concat())?;
        let (masses, values) = values.split_at(k);
        let lightest = masses.iter().copied().filter(|&mass| mass > 0.0).fold(f64::INFINITY, f64::min);
        let lightest = if lightest.is_finite() { lightest } else { 1.0 };
        let weight = |mass: f64| (if mass > 0.0 { mass } else { lightest }).sqrt().recip();
        let row = |row: &[f64]| -> Vec<f64> {
            let row: Vec<f64> = row.iter().zip(masses).map(|(c, &mass)| c * weight(mass)).collect();
            let size = row.iter().fold(0.0f64, |size, entry| size.hypot(*entry));
            row.into_iter().map(|entry| entry / size).collect()
        };
        Ok(Weighed { rows: values.chunks(k.max(1)).map(row).collect() })
    }
}

impl Weighed {
    fn is_finite(&self) -> bool {
        self.rows.iter().flatten().all(|entry| entry.is_finite())
    }

    /// det C_D
    fn determinant(&self, dependent: &[usize]) -> f64 {
        let mut rows: Vec<Vec<f64>> =
            self.rows.iter().map(|row| dependent.iter().map(|&d| row[d]).collect()).collect();
        let mut determinant = 1.0f64;
        for step in 0..rows.len() {
            let Some(best) =
                (step..rows.len()).max_by(|&a, &b| rows[a][step].abs().total_cmp(&rows[b][step].abs()))
            else {
                break;
            };
            if best != step {
                rows.swap(step, best);
                determinant = -determinant;
            }
            determinant *= rows[step][step];
            if determinant == 0.0 || determinant.is_nan() {
                return 0.0;
            }
            let (done, below) = rows.split_at_mut(step + 1);
            for row in below {
                let factor = row[step] / done[step][step];
                row.iter_mut()
                    .zip(&done[step])
                    .skip(step)
                    .for_each(|(entry, pivot)| *entry -= factor * pivot);
            }
        }
        determinant
    }

    /// The columns of the pivots that are shortest in print among the regular ones, in ascending order.
    fn shortest_pivots(self, c: &Matrix<Expr<'_>>) -> Option<Vec<usize>> {
        let mut rows: Vec<(usize, Vec<f64>)> = self.rows.into_iter().enumerate().collect();
        let mut dependent = Vec::new();
        while !rows.is_empty() {
            let largest =
                rows.iter().flat_map(|(_, row)| row).fold(0.0f64, |largest, c| largest.max(c.abs()));
            if largest == 0.0 || !largest.is_finite() {
                return None;
            }
            let places = (0..rows.len()).flat_map(|a| (0..c.columns()).map(move |s| (a, s)));
            let regular = places.filter(|&(a, s)| rows[a].1[s].abs() >= PIVOT * largest);
            let (a, s) = regular.min_by_key(|&(a, s)| c[(rows[a].0, s)].tree_cost())?;
            let (_, pivot) = rows.remove(a);
            for (_, row) in &mut rows {
                let factor = row[s] / pivot[s];
                row.iter_mut().zip(&pivot).for_each(|(entry, pivot)| *entry -= factor * pivot);
                row[s] = 0.0;
            }
            dependent.push(s);
        }
        dependent.sort_unstable();
        Some(dependent)
    }
}

/// All choices of m out of k, in lexicographic order; `None` if there are too many to be compared.
fn choices(k: usize, m: usize) -> Option<Vec<Vec<usize>>> {
    let mut all: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 0..m {
        let longer = |choice: &Vec<usize>| {
            let from = choice.last().map_or(0, |last| last + 1);
            let choice = choice.clone();
            (from..k).map(move |s| [choice.as_slice(), &[s]].concat()).collect::<Vec<_>>()
        };
        all = all.iter().flat_map(longer).collect();
        if all.len() > MOST_TRIED * k.max(1) {
            return None;
        }
    }
    (all.len() <= MOST_TRIED).then_some(all)
}

/// The length of the equations when written out.
fn printed_length(equations: &Equations<'_>) -> u64 {
    let mass = equations.mass_matrix().entries();
    let sides = mass.iter().chain(equations.right_hand_side()).chain(equations.velocities());
    sides.map(|side| u64::from(side.tree_cost())).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_choices_are_tried_unless_there_are_many() {
        assert_eq!(choices(3, 2), Some(vec![vec![0, 1], vec![0, 2], vec![1, 2]]));
        assert_eq!(choices(4, 0), Some(vec![vec![]]));
        assert_eq!(choices(6, 3).map(|all| all.len()), Some(20));
        assert_eq!(choices(7, 3), None);
        assert_eq!(choices(40, 20), None);
    }

    #[test]
    fn determinants_are_those_of_the_columns() {
        let weighed = Weighed { rows: vec![vec![0.0, 1.0, 2.0], vec![1.0, 0.0, 3.0]] };
        assert_eq!(weighed.determinant(&[0, 1]), -1.0);
        assert_eq!(weighed.determinant(&[0, 2]), -2.0);
        assert_eq!(weighed.determinant(&[1, 2]), 3.0);
    }
}
