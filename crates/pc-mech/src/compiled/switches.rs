//! A piecewise motion, held on one of its pieces.

use std::sync::Arc;

use pc_expr::{
    Evaluator, Expr, Failure, Graph, Normals, Program, Sliding, SlidingError, SlidingRange, Surface,
    Switching, TaylorSeries, TimeDependence, VariedSeries, VectorField,
};

use crate::compiled::compile::LONGEST_ELIMINATION;
use crate::compiled::first_order::FirstOrder;
use crate::compiled::holds::Holds;
use crate::compiled::motion::{Along, Form, Motion, Switches};
use crate::compiled::options::CompileOptions;
use crate::compiled::surface_slopes::SurfaceSlopes;
use crate::error::{ForceError, MechError};
use crate::system::signals::Signals;

/// Motions with more surfaces than this cannot be held on one side of each.
const MOST: usize = 256;
/// The relative difference above which rates do not count as the sum of the changes at surfaces.
const ADDS_UP: f64 = 1e-9;
/// A surface that will be reached within this fraction of the time t counts as reached.
const AT_ONCE: f64 = 1e-9;
/// A function below this multiple of the rounding error of its terms vanishes.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;
/// The number of rounds for each surface in which it is decided whether the motion slides along it.
const ROUNDS: usize = 20;

impl<'g> FirstOrder<'g> {
    /// The motion, held on one piece at a time; none if it has a single piece, or if a surface contains unknowns that
    /// are solved for numerically.
    ///
    /// # Errors
    /// As for [`Program::new`]; [`ForceError::TooManySurfaces`] where these are held by stops or stiction.
    pub(crate) fn switches(&self, options: &CompileOptions) -> Result<Option<Switches>, MechError> {
        let placed = self.place_holds();
        let pushed = self.pushed(&placed.forces);
        let held = self.graph.held_on(&pushed.terms(), &self.passing(), &placed.surfaces);
        let surfaces = held.surfaces.len();
        if surfaces > MOST && !self.holds.is_empty() {
            // Without its holds, the motion would be another: stops would not stop it.
            return Err(ForceError::TooManySurfaces { surfaces, most: MOST }.into());
        }
        if surfaces == 0 || surfaces > MOST {
            return Ok(None);
        }
        let sides = held.surfaces.iter().map(|surface| surface.side);
        let system = FirstOrder {
            parameters: self
                .parameters
                .iter()
                .copied()
                .chain(sides.clone().map(|side| (side, 1.0)))
                .collect(),
            varying: self.varying.iter().copied().chain(sides).collect(),
            observables: Vec::new(),
            conserved: 0,
            ..pushed.with_terms(&held.values)
        };
        let mut functions: Vec<Expr<'g>> = held.surfaces.iter().map(|surface| surface.function).collect();
        let mut names = written_out(self.graph, &held.surfaces);
        placed.gaps.iter().for_each(|(surface, gap)| names[*surface].clone_from(gap));
        let motion = system.compile_piece(options, LONGEST_ELIMINATION)?;
        if contains(self.graph, &functions, &self.unknowns) {
            let Form::Unrolled(_) = motion.form else { return Ok(None) };
            let unknowns = system.solve(&system.factors());
            let values: Vec<_> = system.unknowns.iter().copied().zip(unknowns).collect();
            functions = self.graph.substitute(&functions, &values);
        }
        let observing = self.observing(&system, &held.surfaces, options)?;
        Ok(Some(Switches {
            names,
            observing: observing.map(Box::new),
            motion: Box::new(motion),
            slopes: SurfaceSlopes::new(&system, &functions, options.parameter_jacobian)?,
            holds: Holds::new(&system, &placed, held.surfaces.len())?,
            follows_tables: contains(self.graph, &functions, &self.varying),
            functions: Evaluator::new(
                Program::new(self.graph, &system.inputs(&[]), &functions)?,
                options.backend,
            ),
            sides: None,
            along: None,
        }))
    }
}

/// The functions that vanish on the surfaces, as text, with the signs of the preceding functions in place of
/// sides.
fn written_out<'g>(graph: &'g Graph, surfaces: &[Surface<'g>]) -> Vec<String> {
    let mut signs: Vec<(Expr<'g>, Expr<'g>)> = Vec::new();
    let written = surfaces.iter().map(|surface| {
        let function = graph.substitute(&[surface.function], &signs)[0];
        signs.push((surface.side, function.sign()));
        function.to_string()
    });
    written.collect()
}

impl<'g> FirstOrder<'g> {
    /// The motion of a system on sides between −1 and 1, with the observables of this system; none if the
    /// observables depend neither on sides nor on unknowns that are solved for.
    ///
    /// # Errors
    /// As for [`Program::new`].
    fn observing(
        &self,
        system: &FirstOrder<'g>,
        surfaces: &[Surface<'g>],
        options: &CompileOptions,
    ) -> Result<Option<Motion>, MechError> {
        let graph = self.graph;
        let observed: Vec<Expr<'g>> = self.observables.iter().map(|&(_, value)| value).collect();
        let held = graph.held_on(&observed, &self.passing(), surfaces);
        let sides: Vec<Expr<'g>> = surfaces.iter().map(|surface| surface.side).collect();
        let moved = [&sides[..], &self.unknowns].concat();
        if !contains(graph, &held.values, &moved) {
            return Ok(None);
        }
        // On surfaces that occur in observables alone, the side is given by the sign.
        let mut own: Vec<(Expr<'g>, Expr<'g>)> = Vec::new();
        for surface in &held.surfaces[surfaces.len()..] {
            let function = graph.substitute(&[surface.function], &own)[0];
            own.push((surface.side, function.step(1.0, -1.0)));
        }
        let observed = graph.substitute(&held.values, &own);
        let terms = system.terms();
        let (terms_len, all) = (terms.len(), [terms, observed].concat());
        let all = graph.blended(&all, &sides);
        let names = self.observables.iter().map(|(name, _)| name.clone());
        let between = FirstOrder {
            observables: names.zip(all[terms_len..].iter().copied()).collect(),
            conserved: self.conserved,
            ..system.with_terms(&all[..terms_len])
        };
        let plain = CompileOptions::default().backend(options.backend).jacobian(false);
        Ok(Some(between.compile_piece(&plain, LONGEST_ELIMINATION)?))
    }
}

/// dg/dt for these rates, from the derivatives of g with respect to time and state.
fn along_normal((by_time, normal): (f64, &[f64]), rates: &[f64]) -> f64 {
    normal.iter().zip(rates).fold(by_time, |sum, (slope, rate)| sum + slope * rate)
}

/// Whether one of the expressions contains one of the symbols.
fn contains<'g>(graph: &'g Graph, expressions: &[Expr<'g>], symbols: &[Expr<'g>]) -> bool {
    graph.symbols_of(expressions).iter().any(|symbol| symbols.contains(symbol))
}

impl Switches {
    /// Copies the values of the parameters.
    pub(crate) fn follow(&mut self, parameters: &[f64]) {
        let motion = &mut self.motion;
        let moved = |&place: &usize| {
            let is_same = motion.parameters[place].to_bits() == parameters[place].to_bits();
            !is_same && !motion.signals.places().any(|read| read == place)
        };
        let moved: Vec<usize> = (0..parameters.len()).filter(moved).collect();
        if !moved.is_empty() {
            let own = motion.parameters_mut();
            moved.into_iter().for_each(|place| own[place] = parameters[place]);
        }
    }

    /// Makes the motion read inputs from these tables.
    pub(crate) fn drive(&mut self, signals: &Signals) {
        let motion = Motion::clone(&self.motion);
        *self.motion = motion.driven_by(signals.clone());
        if let Some(observing) = &mut self.observing {
            let motion = Motion::clone(observing);
            **observing = motion.driven_by(signals.clone());
        }
    }

    /// Whether f is held on sides.
    pub(crate) fn holds(&self) -> bool {
        self.sides.is_some()
    }

    /// The sides, if the motion slides along a surface.
    fn sliding(&self) -> Option<Vec<f64>> {
        self.sides.as_ref().filter(|sides| sides.contains(&0.0)).cloned()
    }

    /// Writes the observables where the motion slides along a surface at (t, y); false if it does not slide, or if no
    /// observable changes from one side to the other.
    ///
    /// These observables are those of Filippov's combination: for a body held by friction, zero acceleration and the
    /// friction force that holds it. The motion slides if f leads back to the surface from both sides and reaches it
    /// within a time as short as a rounding error.
    pub(crate) fn observe(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> bool {
        if self.observing.is_none() {
            return false;
        }
        self.read(t);
        let held = self.sides.clone();
        let weights = self.weights(t, y);
        self.hold(held.as_deref());
        let (Some(observing), Some(weights)) = (&mut self.observing, weights) else { return false };
        let first = self.motion.parameters.len() - weights.len();
        let own = observing.parameters_mut();
        own[..first].copy_from_slice(&self.motion.parameters[..first]);
        own[first..].copy_from_slice(&weights);
        observing.watch(t, y, values, true);
        true
    }

    /// The sides of all surfaces at (t, y), σ for surfaces along which the motion slides; none if it is on no surface.
    fn weights(&mut self, t: f64, y: &[f64]) -> Option<Vec<f64>> {
        let mut functions = vec![f64::NAN; self.names.len()];
        let mut sides = vec![1.0; self.names.len()];
        for _ in 0..self.names.len() {
            self.set(&sides);
            self.functions(t, y, &mut functions);
            sides = functions.iter().map(|g| if *g < 0.0 { -1.0 } else { 1.0 }).collect();
        }
        let mut normal = vec![0.0; y.len()];
        let mut open = Vec::new();
        for surface in 0..sides.len() {
            let by_time = self.gradient(surface, t, y, &mut normal);
            let fastest = [1.0, -1.0].into_iter().fold(0.0, |fastest: f64, side| {
                let mut beside = sides.clone();
                beside[surface] = side;
                fastest.max(self.rate(&beside, (t, y), (by_time, &normal)).abs())
            });
            let terms = normal.iter().zip(y).map(|(slope, y)| (slope * y).abs());
            let rounding = ROUNDINGS * terms.fold(0.0, f64::max);
            if functions[surface].abs() <= rounding.max(AT_ONCE * t.abs() * fastest) {
                open.push((surface, by_time, normal.clone()));
            }
        }
        if open.is_empty() { None } else { self.decided(sides, &open, (t, y)) }
    }

    /// The sides on which the motion goes on from surfaces, each given with the derivatives of its function: at first it slides
    /// along all of them, and then leaves those that do not hold it, one after the other [Murty 1974].
    fn decided(
        &mut self,
        mut sides: Vec<f64>,
        open: &[(usize, f64, Vec<f64>)],
        (t, y): (f64, &[f64]),
    ) -> Option<Vec<f64>> {
        open.iter().for_each(|&(surface, ..)| sides[surface] = 0.0);
        'rounds: for _ in 0..ROUNDS * open.len() {
            let sliding = match sides.contains(&0.0) {
                true => Some(Sliding::of(self, &sides, t, y).ok()?),
                false => None,
            };
            let mut along = sides.clone();
            if let Some(sliding) = &sliding {
                sliding
                    .surfaces
                    .iter()
                    .zip(&sliding.weights)
                    .for_each(|(&surface, &weight)| along[surface] = weight);
            }
            for (surface, by_time, normal) in open {
                if sides[*surface] == 0.0 {
                    if !self.range(*surface, t, y).holds(along[*surface], ADDS_UP) {
                        sides[*surface] = 1.0_f64.copysign(along[*surface]);
                        continue 'rounds;
                    }
                    continue;
                }
                let rate = match &sliding {
                    Some(sliding) => along_normal((*by_time, normal), &sliding.rates),
                    None => self.rate(&sides, (t, y), (*by_time, normal)),
                };
                // What holds without an end on one side has no other side.
                if rate * sides[*surface] < 0.0 && self.range(*surface, t, y) != SlidingRange::NONE {
                    sides[*surface] = 0.0;
                    continue 'rounds;
                }
            }
            return Some(along);
        }
        None
    }

    /// dg/dt on these sides, none of them 0, for a function with these derivatives; NaN where f has no value.
    fn rate(&mut self, sides: &[f64], (t, y): (f64, &[f64]), normal: (f64, &[f64])) -> f64 {
        let mut rates = vec![f64::NAN; y.len()];
        let known = self.rates(sides, t, y, &mut rates).is_ok();
        if known { along_normal(normal, &rates) } else { f64::NAN }
    }

    /// The rates of the motion on the sides held.
    ///
    /// # Errors
    /// As for [`Motion::rhs`](VectorField::rhs).
    pub(crate) fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        match self.sliding() {
            Some(sides) => {
                ydot.copy_from_slice(&Sliding::of(self, &sides, t, y)?.rates);
                self.holds.still(&sides).for_each(|component| ydot[component] = 0.0);
                Ok(())
            }
            None => self.motion.rhs(t, y, ydot),
        }
    }

    /// Computes (∂f/∂y) v; where the motion slides, as a difference quotient.
    pub(crate) fn jvp(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        if self.sliding().is_none() {
            return self.motion.jvp(t, y, v, product);
        }
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let length = largest(v);
        if length == 0.0 {
            product.fill(0.0);
            return Ok(());
        }
        let step = f64::EPSILON.cbrt() * largest(y).max(1.0) / length;
        self.quotient(step, product, |switches, step, rates| {
            let moved: Vec<f64> = y.iter().zip(v).map(|(y, v)| y + step * v).collect();
            switches.rhs(t, &moved, rates)
        })
    }

    /// Computes ∂f/∂y, column by column.
    pub(crate) fn jacobian(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), Failure> {
        if self.sliding().is_none() {
            return self.motion.jacobian(t, y, entries);
        }
        let mut unit = vec![0.0; y.len()];
        for (i, column) in entries.chunks_exact_mut(y.len()).enumerate() {
            unit[i] = 1.0;
            self.jvp(t, y, &unit, column)?;
            unit[i] = 0.0;
        }
        Ok(())
    }

    /// Computes ∂f/∂p, column by column.
    pub(crate) fn parameter_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        entries: &mut [f64],
    ) -> Result<(), Failure> {
        if self.sliding().is_none() {
            let mut all = vec![0.0; y.len() * self.motion.parameters.len()];
            self.motion.parameter_jacobian(t, y, &mut all)?;
            entries.copy_from_slice(&all[..entries.len()]);
            return Ok(());
        }
        for (j, column) in entries.chunks_exact_mut(y.len()).enumerate() {
            let value = self.motion.parameters[j];
            let step = f64::EPSILON.cbrt() * value.abs().max(1.0);
            let outcome = self.quotient(step, column, |switches, step, rates| {
                switches.motion.parameters_mut()[j] = value + step;
                switches.rhs(t, y, rates)
            });
            self.motion.parameters_mut()[j] = value;
            outcome?;
        }
        Ok(())
    }

    /// The central difference quotient of the rates, which are given as a function of a step.
    fn quotient(
        &mut self,
        step: f64,
        quotient: &mut [f64],
        mut rates: impl FnMut(&mut Switches, f64, &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut behind = vec![0.0; quotient.len()];
        rates(self, step, quotient)?;
        rates(self, -step, &mut behind)?;
        quotient.iter_mut().zip(behind).for_each(|(ahead, behind)| *ahead = (*ahead - behind) / (2.0 * step));
        Ok(())
    }

    /// The Taylor series of the motion on the sides held.
    ///
    /// # Errors
    /// As for [`Motion::expand`](VectorField::expand).
    pub(crate) fn expand(&mut self, t: f64, y: &[f64], order: usize) -> Result<&TaylorSeries, Failure> {
        if let Some(sides) = self.sliding() {
            return self.expand_sliding(&sides, &[], (t, y), order);
        }
        self.take_sides(t, y);
        self.motion.expand(t, y, &[], order)
    }

    /// The Taylor series of the motion on the sides held, with its derivatives with respect to `columns`.
    ///
    /// # Errors
    /// As for [`Motion::expand_varied`](VectorField::expand_varied).
    pub(crate) fn expand_varied(
        &mut self,
        columns: &[Option<usize>],
        t: f64,
        all: &[f64],
        order: usize,
    ) -> Result<&TaylorSeries, Failure> {
        if let Some(sides) = self.sliding() {
            return self.expand_sliding(&sides, columns, (t, all), order);
        }
        self.take_sides(t, &all[..self.motion.names.len()]);
        self.motion.expand_varied(columns, t, all, &[], order)
    }

    /// Takes the sides from the signs of the functions, unless f is held.
    fn take_sides(&mut self, t: f64, y: &[f64]) {
        if self.sides.is_some() {
            return;
        }
        let mut values = vec![f64::NAN; self.names.len()];
        // A surface contains the sides of those before it.
        for _ in 0..self.names.len() {
            self.functions(t, y, &mut values);
            self.set(&self.beside(&values));
        }
    }

    /// The sides on which f is evaluated where the motion is on these sides, or the functions have these values.
    fn beside(&self, sides: &[f64]) -> Vec<f64> {
        sides.iter().enumerate().map(|(surface, &side)| self.holds.beside(surface, side)).collect()
    }

    /// The Taylor series of the motion along the surfaces whose sides are 0, with its derivatives with respect
    /// to `columns`.
    ///
    /// # Errors
    /// As for [`Sliding::of`]; also if f is not the sum of the changes at these surfaces.
    fn expand_sliding(
        &mut self,
        sides: &[f64],
        columns: &[Option<usize>],
        (t, all): (f64, &[f64]),
        order: usize,
    ) -> Result<&TaylorSeries, Failure> {
        let y = &all[..self.motion.names.len()];
        let Sliding { surfaces, rates, .. } = Sliding::of(self, sides, t, y)?;
        if self.along.as_ref().is_none_or(|along| along.surfaces != surfaces) {
            self.along = self.program_along(&surfaces, sides.len()).map(|program| Along {
                surfaces: surfaces.clone(),
                program,
                series: VariedSeries::default(),
            });
        }
        let above = self.beside(sides);
        // The remainder of forces that cancel is compared with these.
        let mut beside = vec![f64::NAN; y.len()];
        self.rates(&above, t, y, &mut beside)?;
        let Some(Along { program, series, .. }) = &mut self.along else {
            return self.motion.expand_varied(columns, t, all, &[], order);
        };
        let series = series.of(columns, program, self.motion.options.backend);
        series.expand(t, all, &[], &self.motion.parameters, order);
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let size = largest(&rates).max(largest(&beside));
        let differs = |(rate, found): (&f64, &f64)| found.is_nan() || (rate - found).abs() > ADDS_UP * size;
        if rates.iter().zip(series.coefficients(1)).any(differs) {
            let surfaces = surfaces.iter().map(|&surface| self.names[surface].clone()).collect();
            return Err(Failure::fatal(SlidingError::NoSeries { surfaces }));
        }
        Ok(series)
    }

    /// The program of the motion along `surfaces`, which are some of the `len` surfaces; none if f is not a
    /// single program.
    fn program_along(&self, surfaces: &[usize], len: usize) -> Option<Program> {
        let program = self.motion.program_of_rates()?;
        let (dim, first) = (program.state_len(), self.motion.parameters.len() - len);
        let places: Vec<usize> = surfaces.iter().map(|surface| first + surface).collect();
        let entries = self.slopes.places.iter().enumerate().filter_map(|(output, &(surface, column))| {
            let surface = surfaces.iter().position(|&other| other == surface)?;
            (column <= dim).then_some((output, surface, column))
        });
        let entries: Vec<_> = entries.collect();
        let normals = Normals { program: self.slopes.entries.program(), entries: &entries };
        Some(program.sliding(&places, normals))
    }

    fn set(&mut self, sides: &[f64]) {
        let first = self.motion.parameters.len() - sides.len();
        if self.motion.parameters[first..] != *sides {
            self.motion.parameters_mut()[first..].copy_from_slice(sides);
        }
    }

    /// Sets the inputs to the values of the tables at t.
    fn read(&mut self, t: f64) {
        if self.follows_tables && !self.motion.signals.is_empty() {
            // Where a table has no value, f fails.
            drop(self.motion.read_signals(t));
        }
    }
}

impl Switching for Switches {
    fn surfaces(&self) -> &[String] {
        &self.names
    }

    fn hold(&mut self, sides: Option<&[f64]>) {
        self.sides = sides.map(<[f64]>::to_vec);
        if let Some(sides) = sides {
            self.set(&self.beside(sides));
        }
    }

    fn held(&self) -> Option<&[f64]> {
        self.sides.as_deref()
    }

    fn functions(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        self.read(t);
        self.functions.eval(t, y, &self.motion.parameters, values);
        values.iter_mut().filter(|value| !value.is_finite()).for_each(|value| *value = f64::NAN);
    }

    fn rates(&mut self, sides: &[f64], t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        self.set(sides);
        self.motion.rhs(t, y, rates)
    }

    fn range(&mut self, surface: usize, t: f64, y: &[f64]) -> SlidingRange {
        self.holds.range(surface, (t, y, &self.motion.parameters))
    }

    fn gradient(&mut self, surface: usize, t: f64, y: &[f64], by_state: &mut [f64]) -> f64 {
        self.read(t);
        by_state.fill(0.0);
        let mut by_time = 0.0;
        for (column, slope) in self.slopes.of(surface, (t, y, &self.motion.parameters)) {
            match column.checked_sub(1) {
                None => by_time += slope,
                Some(i) if i < by_state.len() => by_state[i] = slope,
                Some(i) => by_time += slope * self.motion.signals.rate(i - by_state.len(), t),
            }
        }
        by_time
    }

    fn by_parameter(&mut self, surface: usize, parameter: usize, t: f64, y: &[f64]) -> Option<f64> {
        self.read(t);
        if !self.slopes.by_parameters {
            return None;
        }
        let wanted = 1 + y.len() + parameter;
        let mut slopes = self.slopes.of(surface, (t, y, &self.motion.parameters));
        Some(slopes.find(|&(column, _)| column == wanted).map_or(0.0, |(_, slope)| slope))
    }

    fn time_dependence(&self) -> TimeDependence {
        self.motion.time_dependence()
    }

    fn program(&self) -> Option<(&Arc<Program>, &[f64])> {
        (!self.follows_tables).then(|| (self.functions.program(), &self.motion.parameters[..]))
    }
}
