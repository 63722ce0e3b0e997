//! Energies, forces and outputs of a random model.

use super::Builder;
use super::functions::with;
use crate::fuzz::expression::Expression;

impl Builder {
    /// T, V and R.
    pub(super) fn energies(&mut self) {
        self.kinetic();
        self.potential();
        if self.random.chance(12) {
            let rates = self.rates();
            let rate = Expression::symbol(self.random.pick(&rates));
            let half = self.random.decimal(0.05, 0.4);
            self.specimen.dissipation = vec![rate.power(2.0).times(half)];
        }
    }

    /// Squares of all rates, which outweigh what else there is, but for few with a negative square.
    fn kinetic(&mut self) {
        let shown = self.shown();
        let rates = self.rates();
        let symbol = |name: &String| Expression::symbol(name);
        let mut terms = Vec::new();
        for rate in &rates {
            let mut factors = vec![self.coefficient(0.4, 1.2)];
            if self.random.chance(25) {
                factors.push(self.function(true, &shown));
                // What the function takes, the square gives back.
                terms.push(symbol(rate).power(2.0).times(0.2));
            }
            factors.push(symbol(rate).power(2.0));
            terms.push(Expression::product(factors));
        }
        if rates.len() > 1 {
            self.mixed(&rates, &shown, &mut terms);
        }
        if self.random.chance(12) {
            let rate = symbol(self.random.pick(&rates));
            let function = self.function(false, &shown);
            terms.push(Expression::product(vec![self.coefficient(-0.6, 0.6), function, rate]));
        }
        if self.random.chance(6) {
            let rate = symbol(self.random.pick(&rates));
            terms.push(rate.power(4.0).times(0.05));
        }
        let moving = self.moving();
        if !moving.is_empty() && self.random.chance(20) {
            let velocity = Expression::velocity(self.random.pick(&moving));
            terms.push(velocity.power(2.0).times(self.random.decimal(0.1, 0.5)));
        }
        self.specimen.kinetic = terms;
    }

    fn mixed(&mut self, rates: &[String], shown: &[String], terms: &mut Vec<Expression>) {
        let i = self.random.below(rates.len());
        let j = (i + 1 + self.random.below(rates.len() - 1)) % rates.len();
        let (first, second) = (Expression::symbol(&rates[i]), Expression::symbol(&rates[j]));
        if self.random.chance(35) {
            let factor = self.random.decimal(-0.15, 0.15);
            terms.push(Expression::product(vec![first.clone(), second.clone()]).times(factor));
        }
        if self.random.chance(20) {
            let weight = self.function(true, shown);
            let sum = Expression::sum(vec![Expression::product(vec![weight, first.clone()]), second.clone()]);
            terms.push(sum.power(2.0).times(0.5));
        }
        if !shown.is_empty() && self.random.chance(6) {
            let zero = self.hidden_zero(shown);
            terms.push(Expression::product(vec![zero, first, second]));
        }
        // On constraints it may be degenerate.
        let free = self.specimen.constraints.is_empty();
        if !shown.is_empty() && rates.len() > 2 && self.random.chance(4) && free {
            self.indefinite(rates, shown, terms);
        }
    }

    /// T of the matrix ((A, √A, 1), (√A, 1, 0), (1, 0, 1)), regular everywhere, the second leading minor of which is zero.
    fn indefinite(&mut self, rates: &[String], shown: &[String], terms: &mut Vec<Expression>) {
        let root = with("sqrt(u)", &[("u", Expression::symbol(self.random.pick(shown)))]);
        let names: Vec<(&str, Expression)> = ["A", "B", "C"]
            .into_iter()
            .zip(rates)
            .map(|(name, rate)| (name, Expression::symbol(rate)))
            .chain([("R", root)])
            .collect();
        let rest: Vec<Expression> =
            rates[3..].iter().map(|rate| Expression::symbol(rate).power(2.0)).collect();
        *terms = vec![with("((R*A + B)^2 + 2*A*C + C^2)/2", &names)];
        terms.extend(rest);
    }

    fn potential(&mut self) {
        let shown = self.shown();
        if shown.is_empty() {
            return;
        }
        for _ in 0..self.random.below(3) {
            let name = Expression::symbol(self.random.pick(&shown));
            let other = Expression::symbol(self.random.pick(&shown));
            let place = Expression::Number(self.random.decimal(0.2, 1.3));
            let names = [("u", name), ("v", other), ("c", place)];
            let term = match self.random.below(100) {
                0..45 => self.function(false, &shown),
                45..60 => with("u*v", &names),
                60..66 => with("max(u - c, 0)^3", &names),
                66..70 => with("step(u - c, (u - c)^3, 0)", &names),
                70..73 => with("step(u - c, (u - c)^2.5, 0)", &names),
                73..76 => with("abs(u - c)^3", &names),
                76..82 => with("sin(2*t)*u", &names),
                82..88 => with("sqrt(u*v)", &names),
                88..93 => self.hidden_zero(&shown),
                _ => with("log(1 + u^2) + exp(-v)", &names),
            };
            let coefficient = self.coefficient(-1.5, 1.5);
            self.specimen.potential.push(Expression::product(vec![coefficient, term]));
        }
    }

    /// Forces on quasi-velocities and on coordinates.
    pub(super) fn forces(&mut self) {
        if !self.random.chance(30) {
            return;
        }
        let (shown, moving, rates) = (self.shown(), self.moving(), self.rates());
        let eta = self.specimen.quasi_velocities();
        let mut on: Vec<String> = eta.into_iter().chain(moving).collect();
        self.random.shuffle(&mut on);
        for name in on.into_iter().take(1 + self.random.below(2)) {
            let rate = Expression::symbol(self.random.pick(&rates));
            let force = match self.random.below(3) {
                0 => with("cos(3*t)", &[]),
                1 => rate,
                _ => Expression::product(vec![self.function(false, &shown), rate]),
            };
            let coefficient = self.coefficient(-0.8, 0.8);
            self.specimen.forces.push((name, Expression::product(vec![coefficient, force])));
        }
    }

    /// A function of accelerations that is not linear in them.
    fn accelerated(&mut self, rate: &Expression) -> Expression {
        let moving = self.moving();
        let velocity = match moving.is_empty() {
            true => rate.clone(),
            false => Expression::velocity(self.random.pick(&moving)),
        };
        Expression::product(vec![velocity.rate(), rate.clone()])
    }

    /// Functions of the state, their rates, accelerations and reactions.
    pub(super) fn outputs(&mut self) {
        if !self.random.chance(25) {
            return;
        }
        let (shown, rates) = (self.shown(), self.rates());
        let value = match self.specimen.constraints.first() {
            Some(constraint) if self.random.chance(50) => {
                Expression::symbol(format!("λ_{}", constraint.name)).power(2.0)
            }
            _ => {
                let rate = Expression::symbol(self.random.pick(&rates));
                let weighed = Expression::product(vec![self.function(false, &shown), rate.clone()]);
                match self.random.below(5) {
                    0 => rate.rate(),
                    1 => weighed.rate(),
                    2 => self.function(false, &shown).rate(),
                    3 => self.accelerated(&rate),
                    _ => weighed,
                }
            }
        };
        self.specimen.outputs.push(("out".to_owned(), value));
    }
}
