//! Events of a random model.

use super::Builder;
use crate::fuzz::expression::Expression;
use crate::fuzz::specimen::{Event, Restricts};
use crate::fuzz::start::Start;

impl Builder {
    /// An event where a coordinate or the time passes a value that it comes to on the way.
    pub(super) fn events(&mut self) {
        let Some(start) = Start::of(&self.specimen) else { return };
        let span = self.specimen.t_end - self.specimen.t_start;
        let part = self.random.number(0.15, 0.6);
        let moving = self.moving();
        let fast: Vec<&String> =
            moving.iter().filter(|name| start.value(&format!("{name}'")).abs() > 0.3).collect();
        let value = match fast.is_empty() || self.random.chance(15) {
            true => Expression::symbol("t"),
            false => Expression::symbol(self.random.pick(&fast)),
        };
        let (at, rate) = match &value {
            Expression::Symbol(name) if name != "t" => (start.value(name), start.value(&format!("{name}'"))),
            _ => (self.specimen.t_start, 1.0),
        };
        let threshold = ((at + part * span * rate) * 1e4).round() / 1e4;
        let forwards = if span > 0.0 { 1.0 } else { -1.0 };
        let direction = match self.random.chance(50) {
            true => "both",
            false if rate * forwards > 0.0 => "rising",
            false => "falling",
        };
        let when = Expression::sum(vec![value, Expression::Number(-threshold)]);
        let terminal = self.random.chance(15);
        let reset = if terminal || self.random.chance(20) { Vec::new() } else { self.reset() };
        self.specimen.events.push(Event { name: "e".to_owned(), when, direction, terminal, reset });
    }

    /// New values also of a coordinate or a first-order state, and a function with several zeros close to each other.
    pub(super) fn further_resets(&mut self) {
        let shown = self.moving();
        // A carried coordinate, or a constraint on positions, would have to move with it.
        let free = self.specimen.carried.is_empty()
            && self.specimen.constraints.iter().all(|c| c.restricts == Restricts::Velocities);
        let coordinate = (free && !shown.is_empty()).then(|| self.random.pick(&shown).clone());
        let states = self.specimen.states.iter().map(|state| state.name.clone());
        let names: Vec<String> = coordinate.into_iter().chain(states).collect();
        let span = self.specimen.t_end - self.specimen.t_start;
        let terminal = self.specimen.events[0].terminal;
        for name in names {
            if !terminal && self.random.chance(25) {
                let change = Expression::Number(self.random.decimal(0.02, 0.3));
                let value = Expression::sum(vec![Expression::symbol(&name).times(0.9), change]);
                self.specimen.events[0].reset.push((name, value));
            }
        }
        let event = &mut self.specimen.events[0];
        if event.direction == "both" && event.reset.is_empty() && self.random.chance(40) {
            // Apart by more than the places at which a step is looked at.
            let apart = span * self.random.number(0.06, 0.15);
            let other = Expression::sum(vec![event.when.clone(), Expression::Number(-apart)]);
            event.when = Expression::product(vec![event.when.clone(), other]);
        }
    }

    /// New values of one or two rates.
    fn reset(&mut self) -> Vec<(String, Expression)> {
        let eta = self.specimen.quasi_velocities();
        let mut rates = if eta.is_empty() { self.rates() } else { eta };
        self.random.shuffle(&mut rates);
        let count = 1 + self.random.below(2);
        rates
            .into_iter()
            .take(count)
            .map(|name| {
                let rate = Expression::symbol(&name);
                let value = match self.random.below(3) {
                    0 => rate.times(-0.8),
                    1 => rate.times(0.5),
                    _ => Expression::sum(vec![
                        rate.times(0.9),
                        Expression::Number(self.random.decimal(-0.3, 0.3)),
                    ]),
                };
                (name, value)
            })
            .collect()
    }
}
