//! What drives a random model from outside: first-order states, inputs and pulses.

use super::Builder;
use super::functions::with;
use crate::fuzz::expression::Expression;
use crate::fuzz::specimen::{Input, Restricts, State};

/// Tables go beyond the span of a motion, and beyond the times of random states, by so much.
const BEYOND: f64 = 4.0;

impl Builder {
    /// Each seldom.
    pub(super) fn drives(&mut self) {
        if self.random.chance(12) {
            self.state();
        }
        if self.random.chance(12) {
            self.input();
        }
        if self.random.chance(6) {
            self.pulse();
        }
    }

    /// A filter of a coordinate or a rate, and a force that is proportional to it.
    fn state(&mut self) {
        let (shown, rates) = (self.shown(), self.rates());
        let followed = match shown.is_empty() || self.random.chance(50) {
            true => Expression::symbol(self.random.pick(&rates)),
            false => self.function(false, &shown),
        };
        let decay = Expression::symbol("c1").times(self.random.decimal(-3.0, -0.2));
        let rate = Expression::sum(vec![decay, followed.times(self.random.decimal(-1.0, 1.0))]);
        let start = self.random.decimal(-0.5, 0.5);
        self.specimen.states.push(State { name: "c1".to_owned(), start, rate });
        self.push(Expression::symbol("c1"));
        if self.random.chance(35) {
            self.weigh();
        }
        if self.random.chance(25) {
            self.specimen.outputs.push(("out2".to_owned(), Expression::symbol("c1").rate()));
        }
    }

    /// Has the state change a mass: that of a body, or a term of the kinetic energy.
    fn weigh(&mut self) {
        let factor = with("1.3 + 0.3*tanh(c1)", &[]);
        let weighed = |of: &Expression| Expression::product(vec![of.clone(), factor.clone()]);
        match self.specimen.bodies.first_mut() {
            Some(body) if self.random.chance(50) => body.mass = weighed(&body.mass),
            _ => {
                let term = self.random.below(self.specimen.kinetic.len());
                self.specimen.kinetic[term] = weighed(&self.specimen.kinetic[term]);
            }
        }
    }

    fn input(&mut self) {
        let input = match self.random.below(4) {
            0 => Input::Constant(self.random.decimal(-1.0, 1.0)),
            kind => {
                let interpolation = ["linear", "cubic", "hold"][kind - 1];
                let (from, to) = (self.specimen.t_start, self.specimen.t_end);
                let mut times = vec![from.min(to) - BEYOND];
                for _ in 0..1 + self.random.below(4) {
                    times.push(self.random.number(from.min(to), from.max(to)));
                }
                times.push(from.max(to) + BEYOND);
                times.sort_by(f64::total_cmp);
                let values = times.iter().map(|_| self.random.decimal(-1.0, 1.0)).collect();
                Input::Table { times, values, interpolation }
            }
        };
        self.specimen.inputs.push(("u1".to_owned(), input));
        let shown = self.shown();
        match self.random.chance(35) && !shown.is_empty() {
            true => {
                let pushed = self.function(false, &shown).times(self.random.decimal(-1.0, 1.0));
                self.specimen.potential.push(Expression::product(vec![Expression::symbol("u1"), pushed]));
            }
            false => self.push(Expression::symbol("u1")),
        }
    }

    /// A short pulse, often on a system at rest.
    fn pulse(&mut self) {
        let span = self.specimen.t_end - self.specimen.t_start;
        let at = self.specimen.t_start + span * self.random.number(0.2, 0.8);
        let width = span.abs() * self.random.number(0.01, 0.15);
        let names = [("c", Expression::Number(at)), ("s", Expression::Number(width))];
        self.push(with("exp(-((t - c)/s)^2)", &names));
        // x'² + y'² = 0 is no constraint that anything can be derived from.
        let nonlinear = self.specimen.constraints.iter().any(|c| c.restricts == Restricts::Nonlinearly);
        if self.specimen.events.is_empty() && !nonlinear && self.random.chance(40) {
            self.specimen.velocities.fill(0.0);
        }
    }

    /// A force in proportion to a value.
    fn push(&mut self, value: Expression) {
        let on: Vec<String> = self.specimen.quasi_velocities().into_iter().chain(self.moving()).collect();
        let name = self.random.pick(&on).clone();
        let force = value.times(self.random.decimal(-1.5, 1.5));
        match self.specimen.forces.iter_mut().find(|(on, _)| *on == name) {
            Some((_, known)) => *known = Expression::sum(vec![known.clone(), force]),
            None => self.specimen.forces.push((name, force)),
        }
    }
}
