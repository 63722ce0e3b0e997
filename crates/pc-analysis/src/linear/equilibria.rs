//! The equilibria in a box.

use pc_mech::{Matrix, Motion, SingularValues};

use crate::error::AnalysisError;
use crate::linear::conserved::Conserved;
use crate::linear::family::Family;
use crate::linear::linearization::Linearization;
use crate::linear::linearizer::Linearizer;
use crate::numeric::equilibrated::Equilibrated;
use crate::numeric::newton;
use crate::stability::steady_motion::{SteadyOptions, first_approximation};
use crate::stability::steady_motions::{SAME, periods, primes};
use crate::stability::steady_search::{Stability, largest};

/// A search for equilibria by Newton's method from many starts: the points of a low-discrepancy sequence,
/// multiples of square roots of primes modulo 1 (R. Kronecker, H. Weyl), which are the same on every run.
///
/// ```
/// use pc_analysis::{Conserved, EquilibriumSearch, Leaf, Linearizer};
/// use pc_mech::{Graph, System};
///
/// // A bead on a hoop that turns twice as fast as it takes to leave the lowest point: cos θ = 1/4 too.
/// let graph = Graph::new();
/// let bead = System::builder(&graph)
///     .coordinates(["θ"])
///     .lagrangian(|_, x, v| v[0].square() / 2.0 + 2.0 * x[0].sin().square() + x[0].cos())
///     .build()?;
/// let equations = bead.poincare()?;
/// let leaf = Leaf::of(&bead);
/// let mut linearizer = Linearizer::new(&equations, &leaf, &[])?;
/// let conserved = Conserved::of(&equations, None, &leaf, &[]);
/// let found = EquilibriumSearch::default().run(&mut linearizer, (0.0, &[0.3, 0.0]), &conserved)?;
/// assert_eq!(found.list.len(), 4); // below, above, and on both sides
/// assert!((found.list[0].state[0].abs() - 0.25f64.acos()).abs() < 1e-12);
/// # Ok::<(), pc_analysis::AnalysisError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct EquilibriumSearch {
    bounds: Vec<(String, f64, f64)>,
    starts: usize,
}

impl Default for EquilibriumSearch {
    /// Angles vary over one turn about the start, other coordinates and first-order states by 2 (1 + |x|) on
    /// either side of it; there are 256 starts.
    fn default() -> EquilibriumSearch {
        EquilibriumSearch { bounds: Vec::new(), starts: 256 }
    }
}

/// The result of the search.
#[derive(Clone, Debug)]
pub struct Equilibria {
    /// The equilibria in ascending order of energy.
    pub list: Vec<FoundEquilibrium>,
    /// The cyclic coordinates, which have their values at the start; an equilibrium remains one whatever
    /// these values are.
    pub anywhere: Vec<String>,
    /// The coordinates and first-order states that were searched over, with the bounds of the starts.
    pub bounds: Vec<(String, f64, f64)>,
    /// The number of starts.
    pub starts: usize,
    /// The number of starts from which Newton's method converged.
    pub converged: usize,
    /// The number of starts from which it came to a state at which the rates have no derivatives: a pole of the coordinates
    /// or of the frame.
    pub poles: usize,
}

/// Where Newton's method ends.
enum End {
    /// At an equilibrium, with the uncertainty of its components.
    Equilibrium(Vec<f64>, f64),
    /// At a state where the conditions of rest hold and the rates have no derivatives.
    Pole,
    /// Not at a zero of the conditions.
    Nowhere,
}

/// An equilibrium.
#[derive(Clone, Debug)]
pub struct FoundEquilibrium {
    /// The whole state.
    pub state: Vec<f64>,
    /// The energy y_s η_s − L.
    pub energy: f64,
    /// The first approximation without cyclic coordinates.
    pub linearization: Linearization,
    /// Its stability, judged without cyclic coordinates.
    pub stability: Stability,
    /// The dimension of the family of the equilibrium, not counting the dimensions due to cyclic coordinates; 0 if it
    /// is isolated, even if the first approximation has a kernel, as at the minimum of x⁴.
    pub family: usize,
    /// The number of members of the family that were found.
    pub members: usize,
    /// Whether it is isolated, although the first approximation has a kernel.
    is_flat: bool,
}

/// If the first approximation has a kernel at an isolated equilibrium, Newton's method ends somewhere within about this
/// distance of it, relative to 1 + |y|, where the rates are below the tolerance of the method.
const FLAT: f64 = 0.02;

/// The error of the components there, at least: that of a threefold zero of conditions with rounding errors of 1e-12.
const BLURRED: f64 = 1e-4;

/// The largest number of steps of Newton's method.
const MOST_STEPS: usize = 60;

/// If the slopes of the rates exceed those at the start by this factor, the coordinates are singular.
const MOST_STEEPER: f64 = 1e6;

/// A small rate above this fraction of |∂f/∂y| (1 + |y|) does not indicate a nearby zero: the rate is small
/// because it decays, like a force at a great distance.
const FALLING: f64 = 1e-3;

/// Conditions on velocities are dependent up to this singular value, relative to the largest.
const DEPENDENT: f64 = 1e-6;

/// How far from a small start guesses are spread, in its units.
const REACH: f64 = 4.0;

/// The largest relative difference of the energies within one family.
const SAME_ENERGY: f64 = 1e-9;

impl EquilibriumSearch {
    /// Bounds a coordinate or first-order state: starts lie in the box, and results outside it are left out.
    #[must_use]
    pub fn within(mut self, name: impl Into<String>, low: f64, high: f64) -> EquilibriumSearch {
        self.bounds.push((name.into(), low, high));
        self
    }

    /// The number of starts.
    #[must_use]
    pub fn starts(self, starts: usize) -> EquilibriumSearch {
        EquilibriumSearch { starts, ..self }
    }

    /// The equilibria found on the leaf of the start (t, y), that is, the states at which all rates vanish.
    /// No two coincide modulo the periods of angles; a family of equal energy is represented by one member.
    /// There may be other equilibria.
    ///
    /// `conserved` are the functions that motions keep, by which stability is judged.
    ///
    /// # Errors
    /// [`AnalysisError::UnknownComponent`], [`AnalysisError::CyclicBox`] or [`AnalysisError::EmptyBox`] for a
    /// wrong box; [`AnalysisError::DependsOnTime`], [`AnalysisError::LeafUnknown`].
    pub fn run(
        &self,
        linearizer: &mut Linearizer,
        (t, start): (f64, &[f64]),
        conserved: &Conserved<'_>,
    ) -> Result<Equilibria, AnalysisError> {
        linearizer.measure_by(t, start);
        let mut motion = linearizer.motion.clone();
        let domain = self.domain(linearizer, &mut motion, t, start)?;
        linearizer.check_searchable(t, start)?;
        let steepest = MOST_STEEPER * largest(&first_approximation(&mut motion, t, start)?).max(1.0);
        let at_rest = SteadyOptions::default().fixed(linearizer.zero_at_rest()).iterations(MOST_STEPS);
        let (mut list, mut converged, mut poles) = (Vec::<FoundEquilibrium>::new(), 0, 0);
        for number in 0..self.starts {
            let guess =
                domain.guess(number, start, linearizer.sizes.coordinates, linearizer.sizes.velocities);
            let (state, uncertainty) = match linearizer.equilibrium(t, start, &guess, &at_rest, steepest) {
                End::Equilibrium(state, uncertainty) => (state, uncertainty),
                End::Pole => {
                    poles += 1;
                    continue;
                }
                End::Nowhere => continue,
            };
            converged += 1;
            let state = domain.normalised(state, start);
            if !domain.contains(&state) {
                continue;
            }
            if list.iter().any(|known| domain.is_same(&known.state, &state)) {
                continue;
            }
            // At a pole of the coordinates there is nothing to describe.
            let found = linearizer.described(&mut motion, t, (state, uncertainty), conserved);
            let Ok(found) = found else {
                poles += 1;
                continue;
            };
            let is_flat = |known: &FoundEquilibrium| {
                known.is_flat && found.is_flat && domain.distance(&known.state, &found.state) <= FLAT
            };
            if list.iter().any(is_flat) {
                continue;
            }
            let of_family = list.iter_mut().find(|known| {
                let apart = if known.is_flat && found.is_flat { FLAT } else { SAME };
                let is_same = |a: &[f64], b: &[f64]| domain.distance(a, b) <= apart;
                known.may_share_a_family(&found)
                    && linearizer.is_in_family(t, (&known.state, &found.state), Family::AtRest, is_same)
            });
            match of_family {
                Some(known) => known.members += 1,
                None => list.push(found),
            }
        }
        let place = |a: &FoundEquilibrium, b: &FoundEquilibrium| {
            let near = (a.energy - b.energy).abs() <= SAME_ENERGY * (1.0 + a.energy.abs());
            let by_energy = if near { std::cmp::Ordering::Equal } else { a.energy.total_cmp(&b.energy) };
            let mut components = a.state.iter().zip(&b.state);
            by_energy.then_with(|| {
                let apart = components.find(|(a, b)| (*a - *b).abs() > SAME);
                apart.map_or(std::cmp::Ordering::Equal, |(a, b)| a.total_cmp(b))
            })
        };
        insertion_sorted(&mut list, place);
        Ok(Equilibria {
            list,
            anywhere: linearizer.cyclic(),
            bounds: domain.named(linearizer.names()),
            starts: self.starts,
            converged,
            poles,
        })
    }

    fn domain(
        &self,
        linearizer: &Linearizer,
        motion: &mut Motion,
        t: f64,
        start: &[f64],
    ) -> Result<Domain, AnalysisError> {
        let (n, l) = (linearizer.sizes.coordinates, linearizer.sizes.velocities);
        let places: Vec<usize> =
            (0..n).chain(n + l..start.len()).filter(|i| !linearizer.cyclic.contains(i)).collect();
        let names = linearizer.names();
        let known: Vec<String> = places.iter().map(|&i| names[i].clone()).collect();
        for (name, low, high) in &self.bounds {
            if linearizer.cyclic().contains(name) {
                return Err(AnalysisError::CyclicBox { name: name.clone() });
            }
            if !known.contains(name) {
                return Err(AnalysisError::UnknownComponent { name: name.clone(), known });
            }
            if low > high || !(high - low).is_finite() {
                return Err(AnalysisError::EmptyBox { name: name.clone(), low: *low, high: *high });
            }
        }
        let periods = periods(motion, t, start);
        let edge = |&i: &usize| {
            let given = self.bounds.iter().rev().find(|(name, ..)| *name == names[i]);
            let reach = periods[i].map_or(2.0 * (1.0 + start[i].abs()), |period| period / 2.0);
            let (low, high) =
                given.map_or((start[i] - reach, start[i] + reach), |&(_, low, high)| (low, high));
            Edge { place: i, low, high, is_given: given.is_some() }
        };
        let is_small = linearizer.is_small();
        Ok(Domain {
            edges: places.iter().map(edge).collect(),
            periods,
            units: linearizer.units.clone(),
            is_small,
        })
    }
}

/// A stable sort for an order in which equality holds only up to rounding errors and is therefore not
/// transitive; the standard library requires a transitive order.
fn insertion_sorted<T>(list: &mut [T], order: impl Fn(&T, &T) -> std::cmp::Ordering) {
    for i in 1..list.len() {
        let mut j = i;
        while j > 0 && order(&list[j - 1], &list[j]).is_gt() {
            list.swap(j - 1, j);
            j -= 1;
        }
    }
}

/// The domain of the search.
struct Domain {
    edges: Vec<Edge>,
    periods: Vec<Option<f64>>,
    units: Vec<f64>,
    is_small: bool,
}

struct Edge {
    place: usize,
    low: f64,
    high: f64,
    is_given: bool,
}

impl Domain {
    /// The guess with this number; number 0 is the model at rest, if that state is in the box.
    fn guess(&self, number: usize, start: &[f64], coordinates: usize, velocities: usize) -> Vec<f64> {
        let mut guess = start.to_vec();
        guess[coordinates..coordinates + velocities].fill(0.0);
        if number == 0 && self.contains(&guess) {
            return guess;
        }
        // A system may be small because it starts near one of its equilibria, or because it is small.
        let is_near = self.is_small && number % 2 == 1;
        for (edge, prime) in self.edges.iter().zip(primes()) {
            let (unit, here) = (self.units[edge.place], start[edge.place]);
            let (low, high) = match is_near && !edge.is_given && unit < 1.0 {
                true => (here - REACH * unit, here + REACH * unit),
                false => (edge.low, edge.high),
            };
            let part = (number as f64 * f64::from(prime).sqrt()).fract();
            guess[edge.place] = low + (high - low) * part;
        }
        guess
    }

    /// The state with its angles within one turn above the lower bound of their box; angles without a given
    /// box are as near as possible to zero, or to the start if they are not searched over.
    fn normalised(&self, mut state: Vec<f64>, start: &[f64]) -> Vec<f64> {
        for (i, period) in self.periods.iter().enumerate() {
            let Some(period) = period else { continue };
            let given = self.edges.iter().find(|edge| edge.place == i && edge.is_given);
            let turns = match given {
                // On the bound, up to rounding, is inside the box.
                Some(edge) => ((state[i] - edge.low + SAME) / period).floor(),
                None if self.edges.iter().any(|edge| edge.place == i) => (state[i] / period).round(),
                None => ((state[i] - start[i]) / period).round(),
            };
            state[i] -= turns * period;
            // Minus half a turn is half a turn.
            if given.is_none() && (state[i] + period / 2.0).abs() <= SAME {
                state[i] += period;
            }
        }
        state
    }

    /// Whether a state is in the given boxes.
    fn contains(&self, state: &[f64]) -> bool {
        self.edges.iter().filter(|edge| edge.is_given).all(|edge| {
            let margin = SAME * (self.units[edge.place] + edge.low.abs().max(edge.high.abs()));
            (edge.low - margin..=edge.high + margin).contains(&state[edge.place])
        })
    }

    fn is_same(&self, a: &[f64], b: &[f64]) -> bool {
        self.distance(a, b) <= SAME
    }

    /// The greatest difference between components of two states modulo their periods, relative to their units and |a|.
    fn distance(&self, a: &[f64], b: &[f64]) -> f64 {
        let components = a.iter().zip(b).enumerate().map(|(i, (a, b))| {
            let distance = (a - b).abs();
            let around = self.periods[i].map_or(distance, |period| (period - distance).abs());
            distance.min(around) / (self.units[i] + a.abs())
        });
        components.fold(0.0, f64::max)
    }

    fn named(&self, names: &[String]) -> Vec<(String, f64, f64)> {
        self.edges.iter().map(|edge| (names[edge.place].clone(), edge.low, edge.high)).collect()
    }
}

impl FoundEquilibrium {
    /// Whether another equilibrium may be a member of the family of this one, along which the kind of stability is constant.
    fn may_share_a_family(&self, other: &FoundEquilibrium) -> bool {
        self.family > 0 && self.stability == other.stability
    }
}

impl Linearizer {
    /// The equilibrium near a guess, if there is one at which coordinates are regular and constraints as independent as at
    /// the start: where they are not, there are no linear equations.
    fn equilibrium(
        &mut self,
        t: f64,
        start: &[f64],
        guess: &[f64],
        options: &SteadyOptions,
        steepest: f64,
    ) -> End {
        let Some(guess) = self.onto_leaf(t, start, guess) else { return End::Nowhere };
        let found = match self.find_on(t, start, &guess, options, &[]) {
            Ok(found) => found,
            Err(AnalysisError::NotSmooth { .. }) => return End::Pole,
            Err(_) => return End::Nowhere,
        };
        let slopes = &found.first_approximation;
        let Ok(rates) = self.motion.rates(t, &found.state) else { return End::Pole };
        let reached = |i: usize| {
            let of_state: f64 = (0..slopes.columns())
                .map(|j| slopes[(i, j)].abs() * (self.units[j] + found.state[j].abs()))
                .sum();
            rates[i].abs() <= FALLING * of_state
        };
        if !(0..rates.len()).all(reached) {
            return End::Nowhere;
        }
        let ranks = (self.rank_of_conditions(t, &found.state), self.rank_of_conditions(t, start));
        let keeps_rank = matches!(ranks, (Ok(here), Ok(least)) if here >= least);
        match largest(slopes) <= steepest && keeps_rank {
            true => End::Equilibrium(found.state, found.uncertainty),
            false => End::Pole,
        }
    }

    /// The number of independent conditions on velocities at a state.
    fn rank_of_conditions(&mut self, t: f64, state: &[f64]) -> Result<usize, AnalysisError> {
        let (_, slopes) = self.surface_at(t, state, None)?;
        let (first, velocities) = (self.sizes.positions + self.sizes.kept, self.quasi_velocities());
        let entry = |a: usize, s: usize| slopes[(first + a, velocities.start + s)];
        let by_velocities = Matrix::from_fn(slopes.rows() - first, velocities.len(), entry);
        let factors = SingularValues::of(&Equilibrated::of(&by_velocities).matrix)?;
        Ok(factors.rank(DEPENDENT * factors.values.first().copied().unwrap_or(0.0)))
    }

    /// A state near the guess on the leaf of the start.
    fn onto_leaf(&mut self, t: f64, start: &[f64], guess: &[f64]) -> Option<Vec<f64>> {
        let levels = self.levels(t, start).ok()?;
        if levels.is_empty() {
            return Some(guess.to_vec());
        }
        let units = self.units.clone();
        let measured = |z: &[f64]| -> Vec<f64> { z.iter().zip(&units).map(|(z, unit)| z * unit).collect() };
        let mut end = newton::solve(self.in_units(guess), MOST_STEPS, |z| {
            let (values, slopes) = self.surface_at(t, &measured(z), Some(&levels))?;
            let by_unit = |a: usize, j: usize| slopes[(a, j)] * units[j];
            Ok((values, Matrix::from_fn(slopes.rows(), slopes.columns(), by_unit)))
        })
        .ok()?;
        let is_solution = end.is_solution(SAME);
        end.point = measured(&end.point);
        if self.rests_at_zero {
            let velocities = self.quasi_velocities();
            end.point[velocities.clone()].copy_from_slice(&guess[velocities]);
        }
        is_solution.then_some(end.point)
    }

    fn described(
        &mut self,
        motion: &mut Motion,
        t: f64,
        (state, uncertainty): (Vec<f64>, f64),
        conserved: &Conserved<'_>,
    ) -> Result<FoundEquilibrium, AnalysisError> {
        let cyclic = self.cyclic.clone();
        let energy = motion.observable_names().iter().position(|name| name == "energy");
        let observed = motion.observe(t, &state);
        let near = self.family(t, &state, Family::AtRest)?;
        let is_flat = near.neutral > near.family;
        let uncertainty = if is_flat { uncertainty.max(BLURRED) } else { uncertainty };
        let linearization = self.put_together(t, &state, &cyclic, Some(uncertainty))?;
        Ok(FoundEquilibrium {
            energy: energy.map_or(f64::NAN, |place| observed[place]),
            stability: self.stability(&linearization, conserved)?,
            linearization,
            family: near.family,
            is_flat,
            members: 1,
            state,
        })
    }
}
