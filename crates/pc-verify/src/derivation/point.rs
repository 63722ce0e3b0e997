//! Terms evaluated at a point, over numbers that may change in several directions.

use std::cell::{Cell, OnceCell};

use pc_expr::StandIn;

use crate::error::{Irregular, Unable};
use crate::numbers::number::Number;
use crate::numbers::rounding::Rounding;
use crate::text::body::{Body, Turning};
use crate::text::resultant::Resultants;
use crate::text::term::{Function, OfBody, Term};
use crate::text::text::{Text, Velocities};

/// The largest number of definitions that are evaluated by nested calls; if there are more, the earlier
/// definitions are evaluated first, in order.
const DEEP: usize = 64;

/// A point: time, coordinates, velocities w and first-order states as numbers, with everything that follows
/// from them.
pub(crate) struct Point<'a, T: Number> {
    text: &'a Text,
    rounding: &'a Rounding,
    t: T,
    x: Vec<T>,
    w: Vec<T>,
    z: Vec<T>,
    /// Whether w is known here; without accelerations, w is unknown as a function of time.
    knows_velocities: bool,
    /// ẇ, if known.
    accelerations: Option<Vec<T>>,
    /// λ, if known.
    reactions: Option<Vec<f64>>,
    /// The reactions on bodies, if known.
    resultants: Option<Resultants>,
    definitions: Vec<OnceCell<T>>,
    /// The largest summand of each definition.
    pub(crate) largest: Vec<OnceCell<f64>>,
    /// The number of definitions already evaluated in order.
    tried: Cell<usize>,
    /// The definitions that are being evaluated.
    open: Vec<Cell<bool>>,
    velocities: OnceCell<Vec<T>>,
    moving: OnceCell<Box<dyn Moving<T> + 'a>>,
    /// The same point with first-order states at rest. The rates of the first-order states are evaluated at
    /// such a point: they contain no total derivative of a state.
    moving_without_states: OnceCell<Box<dyn Moving<T> + 'a>>,
    /// Whether the rates of the first-order states are being evaluated.
    in_state_rates: Cell<bool>,
}

/// A point as it moves in time; the point is boxed, since otherwise the types of nested points would be
/// infinite.
trait Moving<T> {
    /// The rate of a term.
    fn rate(&self, term: &Term) -> Result<T, Irregular>;
}

struct Moved<'a, T: Number>(Point<'a, T::Rate>);

impl<T: Number> Moving<T> for Moved<'_, T> {
    fn rate(&self, term: &Term) -> Result<T, Irregular> {
        Ok(T::rate_of(self.0.value(term)?))
    }
}

impl<'a, T: Number> Point<'a, T> {
    /// The point at this time, with these coordinates, velocities and first-order states.
    pub(crate) fn new(text: &'a Text, rounding: &'a Rounding, t: T, [x, w, z]: [Vec<T>; 3]) -> Point<'a, T> {
        Point {
            text,
            rounding,
            t,
            x,
            w,
            z,
            knows_velocities: true,
            accelerations: None,
            reactions: None,
            resultants: None,
            definitions: vec![OnceCell::new(); text.definitions.len()],
            largest: vec![OnceCell::new(); text.definitions.len()],
            tried: Cell::new(0),
            open: vec![Cell::new(false); text.definitions.len()],
            velocities: OnceCell::new(),
            moving: OnceCell::new(),
            moving_without_states: OnceCell::new(),
            in_state_rates: Cell::new(false),
        }
    }

    /// The point on a motion whose accelerations and reactions are known.
    pub(crate) fn on_motion(self, accelerations: Vec<T>, reactions: Vec<f64>) -> Point<'a, T> {
        Point { accelerations: Some(accelerations), reactions: Some(reactions), ..self }
    }

    /// The point with known reactions on bodies.
    pub(crate) fn with_resultants(self, resultants: Option<Resultants>) -> Point<'a, T> {
        Point { resultants, ..self }
    }

    /// The point with w unknown.
    fn without_velocities(self) -> Point<'a, T> {
        Point { knows_velocities: false, ..self }
    }

    pub(crate) fn text(&self) -> &Text {
        self.text
    }

    /// The result of an operation that may round. Exact ones, such as 0 + x and 1·x, are left alone: if 1 in 1 − cos φ were
    /// moved as well, by the same step as cos φ, nothing would show what the difference has lost.
    fn round(&self, value: T) -> T {
        value.rounded(self.rounding)
    }

    /// Checks that there is time left; every lengthy evaluation calls this.
    fn within_limits(&self) -> Result<(), Irregular> {
        self.text.deadline.passed().map_or(Ok(()), |what| Err(Irregular::Spent { what }))
    }

    /// ẋ
    pub(crate) fn velocities(&self) -> Result<&[T], Irregular> {
        if self.velocities.get().is_none() {
            let value = match &self.text.velocities {
                Velocities::Ordinary(_) => {
                    self.require_velocities()?;
                    self.w.clone()
                }
                Velocities::Quasi(rates) => {
                    self.within_limits()?;
                    self.all(rates)?
                }
            };
            let _ = self.velocities.set(value); // was empty
        }
        Ok(self.velocities.get().map_or(&[], Vec::as_slice))
    }

    fn require_velocities(&self) -> Result<(), Unable> {
        if self.knows_velocities { Ok(()) } else { Err(Unable::NoRate) }
    }

    fn quasi_velocity(&self, s: usize) -> Result<T, Irregular> {
        self.require_velocities()?;
        match &self.text.velocities {
            Velocities::Ordinary(definitions) => self.value(&definitions[s]),
            Velocities::Quasi(_) => Ok(self.w[s]),
        }
    }

    /// η
    pub(crate) fn quasi_velocities(&self) -> Result<Vec<T>, Irregular> {
        self.within_limits()?;
        (0..self.text.names.quasi_velocities.len()).map(|s| self.quasi_velocity(s)).collect()
    }

    /// This point as it moves in time, at the rates ẋ and ẇ.
    fn moving(&self) -> Result<&(dyn Moving<T> + 'a), Irregular> {
        let has_states = !self.in_state_rates.get();
        let cell = if has_states { &self.moving } else { &self.moving_without_states };
        if cell.get().is_none() {
            let along = |value: T, rate: T| value.changing(rate).ok_or(Unable::NoRate);
            let pairs = |values: &[T], rates: &[T]| -> Result<Vec<T::Rate>, Unable> {
                values.iter().zip(rates).map(|(&value, &rate)| along(value, rate)).collect()
            };
            let t = along(self.t, T::constant(1.0))?;
            let x = pairs(&self.x, self.velocities()?)?;
            let zero = vec![T::constant(0.0); self.w.len()];
            let w = pairs(&self.w, self.accelerations.as_ref().unwrap_or(&zero))?;
            let still = vec![T::constant(0.0); self.z.len()];
            let z = pairs(&self.z, &if has_states { self.state_rates()? } else { still })?;
            let moving = Point::new(self.text, self.rounding, t, [x, w, z]);
            let moving = if self.accelerations.is_some() { moving } else { moving.without_velocities() };
            let _ = cell.set(Box::new(Moved::<T>(moving))); // was empty
        }
        cell.get().map(|moving| &**moving).ok_or(Irregular::Unable(Unable::NoRate))
    }

    /// ż
    fn state_rates(&self) -> Result<Vec<T>, Irregular> {
        self.in_state_rates.set(true);
        let rates = self.all(&self.text.state_rates);
        self.in_state_rates.set(false);
        rates
    }

    /// The total time derivative of a term.
    fn rate(&self, term: &Term) -> Result<T, Irregular> {
        self.moving()?.rate(term)
    }

    pub(crate) fn all(&self, terms: &[Term]) -> Result<Vec<T>, Irregular> {
        terms.iter().map(|term| self.value(term)).collect()
    }

    /// The value of a term.
    pub(crate) fn value(&self, term: &Term) -> Result<T, Irregular> {
        Ok(match term {
            Term::Number(value) => T::constant(*value),
            Term::Time => self.t,
            Term::Coordinate(i) => self.x[*i],
            Term::Velocity(i) => self.velocities()?[*i],
            Term::QuasiVelocity(s) => self.quasi_velocity(*s)?,
            Term::Parameter(j) => self.moving_parameter(*j),
            Term::State(j) => self.z[*j],
            Term::Definition(j) => self.definition(*j)?,
            Term::Reaction(a) => {
                let reaction = self.reactions.as_ref().and_then(|reactions| reactions.get(*a));
                T::constant(*reaction.ok_or(Unable::NoReaction)?)
            }
            Term::Resultant(resultant) => {
                let known = self.resultants.as_ref().ok_or(Unable::NoReaction)?;
                T::constant(known.get(*resultant).value)
            }
            Term::OfBody(body, quantity) => self.of_body(&self.text.bodies[*body], *quantity)?,
            Term::Rate(inner) => self.rate(inner)?,
            Term::Sum(terms) => {
                let mut sum = T::constant(0.0);
                for (i, (subtracted, term)) in terms.iter().enumerate() {
                    let term = self.value(term)?;
                    let next = if *subtracted { sum - term } else { sum + term };
                    sum = if i == 0 { next } else { self.round(next) };
                }
                sum
            }
            Term::Product(factors) => {
                let mut product = T::constant(1.0);
                for (i, (divided, factor)) in factors.iter().enumerate() {
                    let factor = self.value(factor)?;
                    let next = if *divided { product / factor } else { product * factor };
                    product = if i == 0 && !divided { next } else { self.round(next) };
                }
                product
            }
            Term::Negative(inner) => -self.value(inner)?,
            Term::Power(base, exponent) => {
                let base = self.value(base)?;
                let exponent = self.rounding.suspended(|| self.value(exponent))?;
                self.round(if exponent.is_constant() {
                    base.power(exponent.real())
                } else {
                    (base.ln() * exponent).exp()
                })
            }
            Term::Call(function, arguments) => self.round(self.call(*function, arguments)?),
        })
    }

    /// A parameter as it moves in time: along a curve, if it has one for a table.
    fn moving_parameter(&self, j: usize) -> T {
        let table = self.text.tables.iter().find(|(place, _)| *place == j).map(|(_, table)| table);
        let Some((from, curve)) = table.and_then(|table| table.curve_at(self.t.real())) else {
            return T::constant(self.parameter(j));
        };
        let x = self.t - T::constant(from);
        let value = curve.iter().rev().fold(T::constant(0.0), |sum, &c| T::constant(c) + x * sum);
        value + T::constant(self.parameter(j) - value.real())
    }

    /// The value of a parameter, or of an input at this time.
    pub(crate) fn parameter(&self, j: usize) -> f64 {
        match self.text.tables.iter().find(|(place, _)| *place == j) {
            Some((_, table)) => {
                let shifts = self.text.shifts.iter().filter(|(place, _)| *place == j).map(|(_, by)| by);
                table.at(self.t.real()).unwrap_or(f64::NAN) + shifts.sum::<f64>()
            }
            None => self.text.parameters[j],
        }
    }

    fn definition(&self, j: usize) -> Result<T, Irregular> {
        if let Some(value) = self.definitions[j].get() {
            return Ok(*value);
        }
        if j >= DEEP {
            // Definitions in a chain would cost a nested call each. An error is reported again where the
            // value is needed.
            for before in self.tried.get()..j {
                self.tried.set(self.tried.get().max(before + 1));
                if self.definitions[before].get().is_none() {
                    let _ = self.evaluate_definition(before);
                }
            }
        }
        self.evaluate_definition(j)
    }

    fn evaluate_definition(&self, j: usize) -> Result<T, Irregular> {
        if self.open[j].replace(true) {
            return Err(Unable::Circular { name: self.text.names.definitions[j].clone() }.into());
        }
        let value = self.value(&self.text.definitions[j]);
        self.open[j].set(false);
        let value = value?;
        let _ = self.definitions[j].set(value); // was empty
        Ok(value)
    }

    fn call(&self, function: Function, arguments: &[Term]) -> Result<T, Irregular> {
        let x = self.value(&arguments[0])?;
        let second = || self.value(&arguments[1]);
        // Derivatives at a corner are taken on the side of the argument; at the corner itself there are none.
        let side = |difference: T, name| match difference.real() {
            0.0 if !difference.is_constant() => Err(Irregular::Corner { function: name }),
            side => Ok(side),
        };
        Ok(match function {
            Function::Sin => x.sin(),
            Function::Cos => x.cos(),
            Function::Tan => x.tan(),
            Function::Cot => x.cos() / x.sin(),
            Function::Asin => x.asin(),
            Function::Acos => x.acos(),
            Function::Atan => x.atan(),
            Function::Atan2 => x.atan2(second()?),
            Function::Sinh => x.sinh(),
            Function::Cosh => x.cosh(),
            Function::Tanh => x.tanh(),
            Function::Exp => x.exp(),
            Function::Log => x.ln(),
            Function::Sqrt => x.sqrt(),
            Function::Abs => match side(x, "abs")? {
                side if side < 0.0 => -x,
                _ => x,
            },
            Function::Sign => match side(x, "sign")? {
                0.0 => T::constant(0.0),
                side => T::constant(side.signum()),
            },
            Function::Min | Function::Max => {
                let y = second()?;
                let (name, sense) = if function == Function::Min { ("min", 1.0) } else { ("max", -1.0) };
                let side = side(x - y, name)?;
                if x.real().is_nan() || y.real().is_nan() {
                    T::constant(f64::NAN)
                } else if side * sense <= 0.0 {
                    x
                } else {
                    y
                }
            }
            Function::Step => {
                if x.real().is_nan() {
                    return Ok(x);
                }
                let branch = if side(x, "step")? >= 0.0 { 1 } else { 2 };
                self.value(&arguments[branch])?
            }
            Function::Undetermined(place) => self.stand_in(place, &self.all(arguments)?),
        })
    }

    /// The value of the function that takes the place of an undetermined one.
    fn stand_in(&self, place: usize, arguments: &[T]) -> T {
        let waves = &self.text.names.functions[place].stand_in.waves;
        waves.iter().fold(T::constant(StandIn::LEVEL), |sum, wave| {
            let terms = wave.frequencies.iter().zip(arguments);
            let angle = terms.fold(T::constant(wave.phase), |angle, (&frequency, &x)| {
                self.round(angle + self.round(x * frequency))
            });
            self.round(sum + self.round(angle.sin() * wave.amplitude))
        })
    }

    /// The expression of constraint number `a` that stays zero and contains velocities: the constraint
    /// itself, or its rate if it is a constraint on positions.
    pub(crate) fn velocity_constraint(&self, a: usize, on_positions: bool) -> Result<T, Irregular> {
        self.within_limits()?;
        let term = &self.text.constraints[a];
        if on_positions { self.rate(term) } else { self.value(term) }
    }

    /// L, including the kinetic energy and the force functions of the bodies.
    pub(crate) fn lagrangian(&self) -> Result<T, Irregular> {
        let mut lagrangian = self.own_lagrangian()?;
        for body in &self.text.bodies {
            lagrangian += self.kinetic_energy(body)? + self.force_function(body)?;
        }
        Ok(self.round(lagrangian))
    }

    /// L without the energy of the bodies.
    pub(crate) fn own_lagrangian(&self) -> Result<T, Irregular> {
        self.within_limits()?;
        let part = |term: &Option<Term>| term.as_ref().map_or(Ok(T::constant(0.0)), |term| self.value(term));
        let text = self.text;
        Ok(part(&text.lagrangian)? + part(&text.kinetic)? - part(&text.potential)?)
    }

    /// ṙ
    pub(crate) fn velocity(&self, body: &Body) -> Result<Vec<T>, Irregular> {
        body.position.iter().map(|part| self.rate(part)).collect()
    }

    fn of_body(&self, body: &Body, quantity: OfBody) -> Result<T, Irregular> {
        match quantity {
            OfBody::Mass => self.value(&body.mass),
            OfBody::Place(i) => self.value(&body.position[i]),
            OfBody::Kinetic => self.kinetic_energy(body),
            OfBody::Potential => Ok(-self.force_function(body)?),
            OfBody::Spin(i) => self.spin(body, i),
        }
    }

    /// A component of R I ω; zero for a body without inertia.
    fn spin(&self, body: &Body, i: usize) -> Result<T, Irregular> {
        let mut spin = T::constant(0.0);
        if let (Some(inertia), Some(Turning::Rotation(rotation))) = (&body.inertia, &body.turning) {
            let (omega, inertia) = (self.angular_velocity(body)?, self.all(inertia)?);
            for j in 0..3 {
                let along = (0..3).fold(T::constant(0.0), |sum, l| sum + inertia[3 * j + l] * omega[l]);
                spin += self.value(&rotation[3 * i + j])? * along;
            }
        }
        Ok(self.round(spin))
    }

    /// m v²/2 + ω·Iω/2
    fn kinetic_energy(&self, body: &Body) -> Result<T, Irregular> {
        let mut twice = T::constant(0.0);
        for v in self.velocity(body)? {
            twice += v * v;
        }
        twice *= self.value(&body.mass)?;
        if let (Some(inertia), Some(_)) = (&body.inertia, &body.turning) {
            let (omega, inertia) = (self.angular_velocity(body)?, self.all(inertia)?);
            for (i, entry) in inertia.into_iter().enumerate() {
                twice += omega[i / 3] * entry * omega[i % 3];
            }
        }
        Ok(self.round(twice * 0.5))
    }

    /// The force function of a body: m g·r, plus the force function of the force on it if there is one.
    fn force_function(&self, body: &Body) -> Result<T, Irregular> {
        let mut function = T::constant(0.0);
        if !self.text.gravity.is_empty() {
            let mass = self.value(&body.mass)?;
            for (g, r) in self.text.gravity.iter().zip(&body.position) {
                function += mass * self.value(g)? * self.value(r)?;
            }
        }
        for ((force, r), &factor) in body.force.iter().zip(&body.position).zip(&body.force_functions) {
            if factor != 0.0 {
                function += self.value(force)? * self.value(r)? * factor;
            }
        }
        Ok(self.round(function))
    }

    /// ω as it is given, or the vector of the skew matrix RᵀṘ.
    pub(crate) fn angular_velocity(&self, body: &Body) -> Result<Vec<T>, Irregular> {
        match &body.turning {
            Some(Turning::AngularVelocity(omega)) => self.all(omega),
            Some(Turning::Rotation(rotation)) => {
                let r = self.all(rotation)?;
                let rate = rotation.iter().map(|entry| self.rate(entry)).collect::<Result<Vec<T>, _>>()?;
                // (RᵀṘ)_ij, of which ω_1 = (RᵀṘ)_32 = −(RᵀṘ)_23 and so on, for columns of length 1
                let entry = |i: usize, j: usize| {
                    (0..3).fold(T::constant(0.0), |sum, l| sum + r[3 * l + i] * rate[3 * l + j])
                };
                let square = r.iter().fold(T::constant(0.0), |sum, &entry| sum + entry * entry) / 3.0;
                let axis = |i: usize, j: usize| self.round((entry(i, j) - entry(j, i)) / (square * 2.0));
                Ok(vec![axis(2, 1), axis(0, 2), axis(1, 0)])
            }
            None => Ok(Vec::new()),
        }
    }
}
