//! A motion of several pieces, held on one of them.

use std::sync::Arc;

use pc_expr::{
    Backend, Evaluator, Expr, Failure, Graph, Normals, Program, Sliding, SlidingError, Switching,
    TaylorSeries, TimeDependence, VectorField,
};

use crate::compiled::compile::LONGEST_ELIMINATION;
use crate::compiled::first_order::FirstOrder;
use crate::compiled::motion::{Form, Motion};
use crate::compiled::options::CompileOptions;
use crate::error::MechError;
use crate::system::signals::Signals;

/// Motions with more surfaces are not held.
const MOST: usize = 256;
/// Relative difference of rates above which they are not a sum of what surfaces change.
const ADDS_UP: f64 = 1e-9;

/// The surfaces of a motion, and the motion on given sides of them.
#[derive(Clone, Debug)]
pub(crate) struct Switches {
    /// The texts of the functions.
    names: Vec<String>,
    /// f with the sides as parameters after those of the system.
    pub(super) motion: Box<Motion>,
    /// g from (t, y, p, sides).
    functions: Evaluator,
    slopes: Slopes,
    /// Whether g contains inputs that tables give.
    follows_tables: bool,
    /// The sides on which f is held, if it is.
    sides: Option<Vec<f64>>,
    /// The series of the motion along these surfaces, made on first use.
    along: Option<(Vec<usize>, TaylorSeries)>,
}

/// The derivatives of the functions by time, state and parameters.
#[derive(Clone, Debug)]
struct Slopes {
    entries: Evaluator,
    /// Surface and column of each entry: time, state, parameters.
    places: Vec<(usize, usize)>,
    values: Vec<f64>,
    by_parameters: bool,
}

impl<'g> FirstOrder<'g> {
    /// The motion held on its pieces; none if it has a single one, or if a surface contains unknowns that are solved for
    /// in numbers.
    ///
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn switches(&self, options: &CompileOptions) -> Result<Option<Switches>, MechError> {
        let masses = self.mass.nonzero_entries();
        let left = self.implicit.iter().flat_map(|implicit| &implicit.left).copied();
        let values: Vec<Expr<'g>> =
            masses.iter().chain(&self.right).chain(&self.rates).copied().chain(left).collect();
        let held = self.graph.held(&values, &self.passing());
        if held.surfaces.is_empty() || held.surfaces.len() > MOST {
            return Ok(None);
        }
        let mass = self.mass.with_nonzero_entries(&held.values[..masses.len()]);
        let mut rest = held.values[masses.len()..].iter().copied();
        let right = rest.by_ref().take(self.right.len()).collect();
        let rates = rest.by_ref().take(self.rates.len()).collect();
        let mut implicit = self.implicit.clone();
        if let Some(implicit) = &mut implicit {
            implicit.left = rest.collect();
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
            mass,
            right,
            rates,
            implicit,
            observables: Vec::new(),
            conserved: 0,
            ..self.clone()
        };
        let mut functions: Vec<Expr<'g>> = held.surfaces.iter().map(|surface| surface.function).collect();
        let names = functions.iter().map(Expr::to_string).collect();
        let motion = system.compile_piece(options, LONGEST_ELIMINATION)?;
        if contains(self.graph, &functions, &self.unknowns) {
            let Form::Unrolled(_) = motion.form else { return Ok(None) };
            let unknowns = system.solve(&system.factors());
            let values: Vec<_> = system.unknowns.iter().copied().zip(unknowns).collect();
            functions = self.graph.substitute(&functions, &values);
        }
        Ok(Some(Switches {
            names,
            motion: Box::new(motion),
            slopes: Slopes::new(&system, &functions, options.parameter_jacobian)?,
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

/// Whether one of the expressions contains one of the symbols.
fn contains<'g>(graph: &'g Graph, expressions: &[Expr<'g>], symbols: &[Expr<'g>]) -> bool {
    graph.symbols_of(expressions).iter().any(|symbol| symbols.contains(symbol))
}

impl Slopes {
    fn new<'g>(
        system: &FirstOrder<'g>,
        functions: &[Expr<'g>],
        by_parameters: bool,
    ) -> Result<Slopes, MechError> {
        let mut symbols = vec![system.time];
        symbols.extend(&system.state);
        symbols.extend(system.parameter_symbols());
        // Tables make parameters functions of time.
        let is_needed = |&column: &usize| {
            by_parameters || column <= system.state.len() || system.varying.contains(&symbols[column])
        };
        let columns: Vec<usize> = (0..symbols.len()).filter(is_needed).collect();
        let symbols: Vec<Expr<'g>> = columns.iter().map(|&column| symbols[column]).collect();
        let rows = system.graph.jacobian(functions, &symbols);
        let entries = rows.iter().enumerate().flat_map(|(surface, row)| {
            row.iter().map({
                let columns = &columns;
                move |&(column, entry)| ((surface, columns[column]), entry)
            })
        });
        let (places, entries): (Vec<_>, Vec<Expr<'g>>) = entries.unzip();
        let program = Program::new(system.graph, &system.inputs(&[]), &entries)?;
        let values = vec![0.0; places.len()];
        Ok(Slopes { entries: Evaluator::new(program, Backend::Interpreter), places, values, by_parameters })
    }

    /// The slopes of one surface with their columns.
    fn of(
        &mut self,
        surface: usize,
        (t, y, p): (f64, &[f64], &[f64]),
    ) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.entries.eval(t, y, p, &mut self.values);
        let all = self.places.iter().zip(&self.values);
        all.filter(move |(place, _)| place.0 == surface).map(|(place, &value)| (place.1, value))
    }
}

impl Switches {
    /// Takes over the values of the parameters.
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

    /// Reads inputs from these tables.
    pub(crate) fn drive(&mut self, signals: &Signals) {
        let motion = Motion::clone(&self.motion);
        *self.motion = motion.driven_by(signals.clone());
    }

    /// Whether f is held on sides.
    pub(crate) fn holds(&self) -> bool {
        self.sides.is_some()
    }

    /// The sides, if the motion slides along a surface.
    fn sliding(&self) -> Option<Vec<f64>> {
        self.sides.as_ref().filter(|sides| sides.contains(&0.0)).cloned()
    }

    /// The motion on the sides held.
    ///
    /// # Errors
    /// As [`Motion::rhs`](VectorField::rhs).
    pub(crate) fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        match self.sliding() {
            Some(sides) => {
                ydot.copy_from_slice(&Sliding::of(self, &sides, t, y)?.rates);
                Ok(())
            }
            None => self.motion.rhs(t, y, ydot),
        }
    }

    /// (∂f/∂y) v, where the motion slides as a difference quotient.
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

    /// ∂f/∂y, column after column.
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

    /// ∂f/∂p, column after column.
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

    /// The central difference quotient of rates as a function of a step.
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

    /// The series of the motion on the sides held.
    ///
    /// # Errors
    /// As [`Motion::expand`](VectorField::expand).
    pub(crate) fn expand(&mut self, t: f64, y: &[f64], order: usize) -> Result<&TaylorSeries, Failure> {
        if let Some(sides) = self.sliding() {
            return self.expand_sliding(&sides, t, y, order);
        }
        if self.sides.is_none() {
            let mut values = vec![f64::NAN; self.names.len()];
            // A surface contains the sides of those before it.
            for _ in 0..self.names.len() {
                self.functions(t, y, &mut values);
                let sides: Vec<f64> = values.iter().map(|g| if *g < 0.0 { -1.0 } else { 1.0 }).collect();
                self.set(&sides);
            }
        }
        self.motion.expand(t, y, &[], order)
    }

    /// The series of the motion along the surfaces whose sides are 0.
    ///
    /// # Errors
    /// As [`Sliding::of`], and where f is not a sum of what these surfaces change.
    fn expand_sliding(
        &mut self,
        sides: &[f64],
        t: f64,
        y: &[f64],
        order: usize,
    ) -> Result<&TaylorSeries, Failure> {
        let Sliding { surfaces, rates, .. } = Sliding::of(self, sides, t, y)?;
        if self.along.as_ref().is_none_or(|(known, _)| *known != surfaces) {
            let Some(program) = self.motion.program_of_rates() else {
                return self.motion.expand(t, y, &[], order);
            };
            let first = self.motion.parameters.len() - sides.len();
            let places: Vec<usize> = surfaces.iter().map(|surface| first + surface).collect();
            let entries = self.slopes.places.iter().enumerate().filter_map(|(output, &(surface, column))| {
                let surface = surfaces.iter().position(|&other| other == surface)?;
                (column <= y.len()).then_some((output, surface, column))
            });
            let normals =
                Normals { program: self.slopes.entries.program(), entries: &entries.collect::<Vec<_>>() };
            let program = program.sliding(&places, normals);
            self.along = Some((surfaces.clone(), TaylorSeries::new(&program, self.motion.options.backend)));
        }
        let above: Vec<f64> = sides.iter().map(|side| if *side < 0.0 { -1.0 } else { 1.0 }).collect();
        // What is left of forces that cancel is measured by these.
        let mut beside = vec![f64::NAN; y.len()];
        self.rates(&above, t, y, &mut beside)?;
        let Some((_, series)) = &mut self.along else { return self.motion.expand(t, y, &[], order) };
        series.expand(t, y, &[], &self.motion.parameters, order);
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let size = largest(&rates).max(largest(&beside));
        let differs = |(rate, found): (&f64, &f64)| found.is_nan() || (rate - found).abs() > ADDS_UP * size;
        if rates.iter().zip(series.coefficients(1)).any(differs) {
            let surfaces = surfaces.iter().map(|&surface| self.names[surface].clone()).collect();
            return Err(Failure::fatal(SlidingError::NoSeries { surfaces }));
        }
        Ok(series)
    }

    fn set(&mut self, sides: &[f64]) {
        let first = self.motion.parameters.len() - sides.len();
        if self.motion.parameters[first..] != *sides {
            self.motion.parameters_mut()[first..].copy_from_slice(sides);
        }
    }

    /// Reads the tables at t.
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
            let above: Vec<f64> = sides.iter().map(|side| if *side < 0.0 { -1.0 } else { 1.0 }).collect();
            self.set(&above);
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
