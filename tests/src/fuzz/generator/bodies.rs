//! Bodies of a random model.

use super::Builder;
use super::functions::with;
use crate::fuzz::expression::Expression;
use crate::fuzz::specimen::{Body, Turning};

impl Builder {
    /// One body, a particle or one that turns.
    pub(super) fn bodies(&mut self) {
        let shown = self.shown();
        let moving = self.moving();
        let entry = |builder: &mut Builder| match builder.random.chance(70) {
            true => builder.function(false, &shown).times(builder.random.decimal(-0.8, 0.8)),
            false => Expression::Number(0.0),
        };
        let position = [entry(self), entry(self), entry(self)];
        let mass = Expression::Number(self.random.decimal(0.2, 0.9));
        let force = self.random.chance(35).then(|| {
            let third = match self.random.chance(50) {
                true => Expression::Number(self.random.decimal(-2.0, 2.0)),
                false => entry(self),
            };
            let first = match self.random.chance(30) {
                true => with("cos(3*t)", &[]).times(self.random.decimal(-0.8, 0.8)),
                false => Expression::Number(0.0),
            };
            [first, Expression::Number(0.0), third]
        });
        let turning = match self.random.below(100) {
            0..40 if !moving.is_empty() => Some(Turning::About {
                tilt: *self.random.pick(&[0.0, 0.3, 1.1]),
                ratio: *self.random.pick(&[1.0, -2.0, 0.5]),
                coordinate: self.random.pick(&moving).clone(),
            }),
            40..75 => Some(Turning::AngularVelocity(self.angular_velocity())),
            _ => None,
        };
        let moments = [1.1, 0.8, 0.5].map(|moment| moment * self.random.decimal(0.9, 1.1));
        let turning = turning.map(|turning| (moments, turning));
        self.specimen.bodies.push(Body { name: "B".to_owned(), mass, position, force, turning });
    }

    /// A direction in which bodies fall, which an input or the time may shake.
    pub(super) fn gravity(&mut self) {
        if self.specimen.bodies.is_empty() || !self.random.chance(40) {
            return;
        }
        let mut along =
            [0.0; 3].map(|_| if self.random.chance(30) { 0.0 } else { self.random.decimal(-2.0, 2.0) });
        along[2] -= 2.0;
        let mut along = along.map(Expression::Number);
        let shakes = match self.specimen.inputs.first() {
            Some((input, _)) if self.random.chance(40) => Some(Expression::symbol(input)),
            _ => self.random.chance(15).then(|| with("sin(2*t)", &[])),
        };
        if let Some(shakes) = shakes {
            along[1] = shakes.times(self.random.decimal(-1.5, 1.5));
        }
        self.specimen.gravity = Some(along);
    }

    fn angular_velocity(&mut self) -> [Expression; 3] {
        let rates = self.rates();
        let names = self.shown();
        let mut component = |i: usize| match rates.get(i) {
            Some(rate) => Expression::symbol(rate),
            None => {
                let rate = Expression::symbol(&rates[0]);
                Expression::product(vec![self.function(false, &names), rate])
            }
        };
        [component(0), component(1), component(2)]
    }
}
