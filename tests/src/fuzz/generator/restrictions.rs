//! Constraints of a random model.

use super::Builder;
use super::functions::with;
use crate::fuzz::expression::Expression;
use crate::fuzz::specimen::{Constraint, Frame, Restricts};

impl Builder {
    /// Fewer constraints than velocities, of positions and of velocities, some of which follow from others.
    pub(super) fn constraints(&mut self) {
        let given = self.specimen.constraints.len();
        let n = self.specimen.chart.len();
        if !matches!(self.specimen.frame, Frame::Definitions(_)) && n > 1 && self.random.chance(50) {
            let count = 1 + self.random.below((n - 1).min(2));
            for number in 0..count {
                self.constraint(number);
            }
        }
        if self.specimen.constraints.len() > given.max(1) - 1 && self.random.chance(8) {
            self.redundant();
        }
    }

    fn constraint(&mut self, number: usize) {
        let shown = self.shown();
        let moving = self.moving();
        let (restricts, expression) = match self.random.below(100) {
            0..35 if !shown.is_empty() => (Restricts::Positions, self.position(&shown)),
            35..43 if moving.len() > 1 => {
                let speed = |name: &String| Expression::velocity(name).power(2.0);
                (Restricts::Nonlinearly, Expression::sum(moving[..2].iter().map(speed).collect()))
            }
            _ => (Restricts::Velocities, self.pfaffian(&shown, &moving)),
        };
        let name = format!("k{number}");
        self.specimen.constraints.push(Constraint { name, restricts, expression });
    }

    fn position(&mut self, shown: &[String]) -> Expression {
        let first = Expression::symbol(self.random.pick(shown));
        let mut terms = vec![match self.random.chance(50) {
            true => first.power(2.0),
            false => first,
        }];
        if self.random.chance(80) {
            let function = self.function(false, shown);
            terms.push(Expression::product(vec![self.coefficient(0.3, 1.5), function]));
        }
        if self.random.chance(12) {
            terms.push(Expression::symbol("t").times(self.random.decimal(-0.6, 0.6)));
        }
        Expression::sum(terms)
    }

    /// Affine in quasi-velocities and velocities.
    fn pfaffian(&mut self, shown: &[String], moving: &[String]) -> Expression {
        let eta = self.specimen.quasi_velocities();
        let mut rates: Vec<Expression> = eta.iter().map(Expression::symbol).collect();
        // One that follows from others says that they vanish, not that it does: few of those.
        if eta.is_empty() || self.random.chance(40) {
            rates.extend(moving.iter().map(Expression::velocity));
        }
        let last = rates.remove(self.random.below(rates.len()));
        match self.random.below(100) {
            0..20 => return last,
            20..35 => return last.times(self.random.decimal(0.5, 2.0)),
            _ => {}
        }
        let coefficient = self.function(true, shown);
        let mut terms = vec![Expression::product(vec![coefficient, last])];
        self.random.shuffle(&mut rates);
        for rate in rates.into_iter().take(2) {
            let function = self.function(false, shown);
            terms.push(Expression::product(vec![self.coefficient(-1.0, 1.0), function, rate]));
        }
        if self.random.chance(12) {
            terms.push(match self.random.chance(50) {
                true => with("sin(2*t)", &[]).times(self.random.decimal(0.1, 0.5)),
                false => Expression::Number(self.random.decimal(0.1, 0.5)),
            });
        }
        Expression::sum(terms)
    }

    /// A constraint that leaves a velocity free no longer, of those that definitions do not describe: of x' and η.
    pub(super) fn completing_constraint(&mut self, number: usize, place: usize, position: bool) {
        let names = self.moving();
        let mut terms = Vec::new();
        if position {
            terms.push(Expression::symbol(&names[place]));
            let others: Vec<String> = names.iter().filter(|name| **name != names[place]).cloned().collect();
            let function = self.function(false, &others);
            terms.push(Expression::product(vec![self.coefficient(0.3, 1.2), function]));
        } else {
            terms.push(self.linear_term(place, &names, true));
            let other = self.random.below(names.len());
            if self.random.chance(50) && other != place {
                terms.push(self.linear_term(other, &names, false));
            }
            let eta = self.specimen.quasi_velocities();
            if self.random.chance(40) {
                let eta = Expression::symbol(self.random.pick(&eta));
                terms.push(Expression::product(vec![self.coefficient(-0.8, 0.8), eta]));
            }
            if self.random.chance(8) {
                terms.push(Expression::Number(self.random.decimal(0.1, 0.5)));
            }
        }
        let restricts = if position { Restricts::Positions } else { Restricts::Velocities };
        let (name, expression) = (format!("k{number}"), Expression::sum(terms));
        self.specimen.constraints.push(Constraint { name, restricts, expression });
    }

    /// One that another one times a function is.
    fn redundant(&mut self) {
        let shown = self.shown();
        let of = self.random.pick(&self.specimen.constraints).clone();
        let factor = match of.restricts {
            Restricts::Velocities => self.function(true, &shown),
            Restricts::Positions | Restricts::Nonlinearly => {
                Expression::Number(self.random.decimal(0.5, 2.0))
            }
        };
        let expression = Expression::product(vec![factor, of.expression]);
        let name = format!("k{}", self.specimen.constraints.len());
        self.specimen.constraints.push(Constraint { name, restricts: of.restricts, expression });
    }
}
