//! How a random model describes its velocities.

use super::functions::with;
use super::{Builder, COORDINATES, QUASI_VELOCITIES};
use crate::fuzz::expression::Expression;
use crate::fuzz::specimen::{Carried, Coordinate, Frame, Triangular};

impl Builder {
    /// So many coordinates, positive, away from zeros and poles of what is made of them.
    pub(super) fn coordinates(&mut self, count: usize) {
        for name in &COORDINATES[..count] {
            let start = self.random.decimal(0.4, 1.1);
            self.specimen.chart.push(Coordinate { name: (*name).to_owned(), start, shown: true });
        }
    }

    /// No quasi-velocities: Lagrange's equations.
    pub(super) fn lagrangian_coordinates(&mut self) {
        let count = 1 + self.random.below(4);
        self.coordinates(count);
    }

    /// ẋ = b η + b_0 with a triangular b, sometimes with coordinates that are functions of others.
    pub(super) fn triangular_frame(&mut self) {
        let count = 1 + self.random.below(4);
        self.coordinates(count);
        let frame = self.triangular(count);
        self.specimen.frame = Frame::Triangular(frame);
        if self.random.chance(55) {
            self.carry();
        }
    }

    fn triangular(&mut self, count: usize) -> Triangular {
        let names = self.moving();
        let eta: Vec<String> = QUASI_VELOCITIES[..count].iter().map(|&name| name.to_owned()).collect();
        let diagonal = (0..count)
            .map(|_| match self.random.below(10) {
                0..4 => Expression::Number(1.0),
                4..6 => self.coefficient(0.4, 1.4),
                _ => self.function(true, &names),
            })
            .collect();
        let mut lower = Vec::new();
        for i in 0..count {
            for j in 0..i {
                if self.random.chance(55) {
                    // Often of the coordinate itself, so that brackets differ from zero.
                    let own = &names[i..=i];
                    let of = if self.random.chance(40) { own } else { &names[..] };
                    let regular = self.random.chance(50);
                    let function = match self.random.chance(8) {
                        true => self.root_of_two(&names),
                        false => self.function(regular, of),
                    };
                    let factor = if self.random.chance(50) { 1.0 } else { self.random.decimal(-1.0, 1.0) };
                    lower.push((i, j, function.times(factor)));
                }
            }
        }
        let drifts = self.random.chance(15);
        let drift = (0..count)
            .map(|_| match drifts && self.random.chance(50) {
                true => self.drift(&names),
                false => Expression::Number(0.0),
            })
            .collect();
        let mut order: Vec<usize> = (0..count).collect();
        self.random.shuffle(&mut order);
        Triangular { eta, diagonal, lower, drift, order, by_definitions: false }
    }

    fn drift(&mut self, names: &[String]) -> Expression {
        match self.random.chance(50) {
            true => with("cos(2*t)", &[]).times(self.random.decimal(0.1, 0.6)),
            false => self.function(false, names).times(self.random.decimal(0.1, 0.6)),
        }
    }

    /// One or two more coordinates that are functions of others.
    pub(super) fn carry(&mut self) {
        let Some(velocities) = self.specimen.chart_velocities() else { return };
        let places: Vec<usize> =
            (0..self.specimen.chart.len()).filter(|&i| self.specimen.chart[i].shown).collect();
        for i in 0..=self.random.below(2) {
            // Rather the later ones, whose rates have more terms.
            let place = self.random.below(places.len());
            let of = places[place.max(self.random.below(places.len()))];
            let name = self.specimen.chart[of].name.clone();
            let (value, derivative) = self.carried_function(&name);
            let factor = if self.random.chance(70) { 1.0 } else { self.random.decimal(0.3, 1.2) };
            let velocity = Expression::product(vec![derivative, velocities[of].clone()]).times(factor);
            let name = ["z", "h"][i].to_owned();
            self.specimen.carried.push(Carried { name, value: value.times(factor), velocity });
        }
    }

    /// Quasi-velocities defined by `is`, as many as coordinates, or fewer with constraints for the rest.
    pub(super) fn definitions(&mut self) {
        let count = 1 + self.random.below(4);
        self.coordinates(count);
        let mut frame = self.triangular(count);
        frame.by_definitions = true;
        if count == 1 || self.random.chance(35) {
            self.specimen.frame = Frame::Triangular(frame);
            return;
        }
        let free = 1 + self.random.below(count - 1);
        let names = self.moving();
        let mut definitions = Vec::new();
        for (name, place) in frame.eta[..free].iter().zip(&frame.order) {
            let mut terms = vec![self.linear_term(*place, &names, true)];
            if self.random.chance(60) {
                let other = self.random.below(count);
                terms.push(self.linear_term(other, &names, false));
            }
            if self.random.chance(10) {
                terms.push(self.drift(&names));
            }
            definitions.push((name.clone(), Expression::sum(terms)));
        }
        self.specimen.frame = Frame::Definitions(definitions);
        let position = self.random.chance(30);
        for number in 0..count - free {
            let place = frame.order[free + number];
            self.completing_constraint(number, place, position && number == 0);
        }
    }

    /// A velocity with a coefficient.
    pub(super) fn linear_term(&mut self, place: usize, names: &[String], regular: bool) -> Expression {
        let coefficient = self.function(regular, names);
        let velocity = Expression::velocity(&self.specimen.chart[place].name);
        Expression::product(vec![coefficient, velocity])
    }
}
