//! Random models of several pieces.

use super::formula::Formula;
use super::specimen::{Coordinate, Part, Specimen, State, Table};
use crate::fuzz::random::Random;

/// The choices of pieces are others than those of other rooms, whose seeds they have.
const BREAKS: u64 = 0x62_72;

/// Model number `index` of a seed.
pub(super) fn specimen(seed: u64, index: u64) -> Specimen {
    let mut maker = Maker { random: Random::new(seed ^ BREAKS, index), specimen: Specimen::default() };
    maker.coordinates();
    maker.smooth_terms();
    for _ in 0..1 + maker.random.below(3) {
        maker.piece();
    }
    maker.simulation();
    maker.specimen
}

struct Maker {
    random: Random,
    specimen: Specimen,
}

impl Maker {
    fn number(&mut self, low: f64, high: f64) -> f64 {
        (self.random.number(low, high) * 1000.0).round() / 1000.0
    }

    /// A new parameter of a size between the bounds, as often small as large.
    fn parameter(&mut self, stem: &str, low: f64, high: f64) -> Formula {
        let value = self.random.number(low.ln(), high.ln()).exp();
        let digits = 10f64.powf(3.0 - value.log10().floor());
        self.named(stem, (value * digits).round() / digits)
    }

    /// A new parameter of either sign.
    fn place(&mut self, stem: &str, low: f64, high: f64) -> Formula {
        let value = self.number(low, high);
        self.named(stem, value)
    }

    fn named(&mut self, stem: &str, value: f64) -> Formula {
        let number = self.specimen.parameters.len();
        self.specimen.parameters.push((format!("{stem}{number}"), value));
        Formula::Parameter(number)
    }

    /// The surface of a function, the same for the same function.
    fn surface(&mut self, function: Formula) -> usize {
        let surfaces = &mut self.specimen.surfaces;
        surfaces.iter().position(|surface| *surface == function).unwrap_or_else(|| {
            surfaces.push(function);
            surfaces.len() - 1
        })
    }

    fn sign(&mut self, function: Formula) -> Formula {
        Formula::Sign(self.surface(function))
    }

    fn abs(&mut self, function: Formula) -> Formula {
        Formula::Abs(self.surface(function))
    }

    fn step(&mut self, function: Formula, above: Formula, below: Formula) -> Formula {
        Formula::Step(self.surface(function), Box::new(above), Box::new(below))
    }

    fn min(&mut self, a: Formula, b: Formula) -> Formula {
        Formula::Min(self.surface(a.clone().less(b.clone())), Box::new(a), Box::new(b))
    }

    fn max(&mut self, a: Formula, b: Formula) -> Formula {
        Formula::Max(self.surface(a.clone().less(b.clone())), Box::new(a), Box::new(b))
    }

    fn count(&self) -> usize {
        self.specimen.coordinates.len()
    }

    fn any(&mut self) -> usize {
        let count = self.count();
        self.random.below(count)
    }

    fn velocity(&self, i: usize) -> Formula {
        Formula::Variable(self.count() + i)
    }

    fn add(&mut self, part: Part, term: Formula) {
        self.specimen.terms.push((part, term));
    }

    fn coordinates(&mut self) {
        let count = 1 + self.random.below(3);
        for name in &["x", "y", "q"][..count] {
            let start = self.place("p", -1.0, 1.0);
            // At rest, so that what sticks may stick from the start.
            let speed =
                if self.random.chance(25) { Formula::Number(0.0) } else { self.place("v", -2.0, 2.0) };
            self.specimen.coordinates.push(Coordinate { name: (*name).to_owned(), start, speed });
        }
    }

    /// Energies, damping and drives without pieces.
    fn smooth_terms(&mut self) {
        for i in 0..self.count() {
            let mass = self.parameter("m", 0.3, 3.0);
            let energy = mass.times(self.velocity(i).squared()).half();
            let energy = if self.random.chance(30) {
                let (slope, j) = (self.parameter("b", 0.1, 1.0), self.any());
                let factor = Formula::Number(1.0).plus(slope.times(Formula::Variable(j).squared()));
                energy.times(factor)
            } else {
                energy
            };
            self.add(Part::Kinetic, energy);
            if self.random.chance(75) {
                let stiffness = self.parameter("k", 0.3, 20.0);
                let x = Formula::Variable(i);
                let potential = match self.random.below(4) {
                    0 => stiffness.times(Formula::Cos(Box::new(x))).minus(),
                    1 => stiffness.times(Formula::Power(Box::new(x), 4)),
                    _ => stiffness.times(x.squared()).half(),
                };
                self.add(Part::Potential, potential);
            }
            if self.random.chance(40) {
                let damping = self.parameter("c", 0.02, 1.0);
                if self.random.chance(50) {
                    self.add(Part::Dissipation, damping.times(self.velocity(i).squared()).half());
                } else {
                    self.add(Part::Force(i), damping.times(self.velocity(i)).minus());
                }
            }
            if self.random.chance(40) {
                let drive = self.drive();
                self.add(Part::Force(i), drive);
            }
        }
        if self.count() > 1 && self.random.chance(60) {
            let stiffness = self.parameter("k", 0.3, 8.0);
            let between = Formula::Variable(0).less(Formula::Variable(1));
            self.add(Part::Potential, stiffness.times(between.squared()).half());
        }
        if self.count() > 1 && self.random.chance(25) {
            let coupling = self.parameter("e", 0.02, 0.2);
            self.add(Part::Kinetic, coupling.times(self.velocity(0)).times(self.velocity(1)));
        }
    }

    fn drive(&mut self) -> Formula {
        let amplitude = self.parameter("A", 0.2, 4.0);
        let frequency = self.parameter("w", 0.4, 5.0);
        amplitude.times(Formula::Cos(Box::new(frequency.times(Formula::Time))))
    }

    /// x - a for a place or a table.
    fn beyond(&mut self, j: usize) -> Formula {
        let place = if self.random.chance(12) { self.table(0.6) } else { self.place("a", -0.8, 0.8) };
        Formula::Variable(j).less(place)
    }

    /// A speed that friction pulls to.
    fn belt(&mut self) -> Formula {
        if self.random.chance(25) { self.table(1.0) } else { self.place("u", -1.0, 1.0) }
    }

    fn table(&mut self, size: f64) -> Formula {
        let number = self.specimen.tables.len();
        let mut times = vec![0.0];
        for _ in 0..2 + self.random.below(4) {
            let last = times[times.len() - 1];
            times.push(last + self.number(0.2, 2.5));
        }
        // Lines end with the table.
        times.push(12.0);
        let values = times.iter().map(|_| self.number(-size, size)).collect();
        let holds = self.random.chance(50);
        self.specimen.tables.push(Table { name: format!("r{number}"), times, values, holds });
        Formula::Input(number)
    }

    /// A first-order state that runs with time, or after a coordinate.
    fn state(&mut self, name: &str) -> Formula {
        let number = self.specimen.states.len();
        let z = Formula::Variable(2 * self.count() + number);
        let start = self.place("s", -0.5, 0.5);
        let pace = self.parameter("h", 0.3, 2.0);
        let rate = match self.random.below(3) {
            0 => pace,
            1 => Formula::Variable(self.any()).less(z.clone()).times(pace),
            _ => {
                let x = Formula::Variable(self.any());
                self.sign(z.clone().less(x)).times(pace).minus()
            }
        };
        self.specimen.states.push(State { name: format!("{name}{number}"), start, rate });
        z
    }

    fn piece(&mut self) {
        let (i, j) = (self.any(), self.any());
        let force = self.parameter("F", 0.2, 5.0);
        let (x, v) = (Formula::Variable(j), self.velocity(i));
        let zero = || Formula::Number(0.0);
        let term = match self.random.below(20) {
            0 => {
                let beyond = self.beyond(j);
                self.step(beyond, force, zero())
            }
            1 => {
                let time = self.parameter("a", 0.2, 5.0);
                self.step(Formula::Time.less(time), force, zero())
            }
            2 => {
                let belt = self.belt();
                let more = self.parameter("G", 0.2, 2.0);
                if self.random.chance(50) {
                    self.step(v.less(belt), force.minus(), more)
                } else {
                    self.step(v.less(belt), more, zero())
                }
            }
            3 => {
                let (z, level) = (self.state("z"), self.place("a", -0.5, 2.0));
                self.step(z.less(level), force, zero())
            }
            4 => {
                let beyond = self.beyond(j);
                self.sign(beyond).times(force).minus()
            }
            5 | 6 => {
                let drive = self.drive();
                self.add(Part::Force(i), drive);
                match self.random.below(3) {
                    0 => {
                        let speed = self.abs(v);
                        return self.add(Part::Dissipation, force.times(speed));
                    }
                    1 => {
                        let slope = self.parameter("b", 0.1, 1.0);
                        let pressure = Formula::Number(1.0).plus(slope.times(x.squared()));
                        self.sign(v).times(force).times(pressure).minus()
                    }
                    _ => self.sign(v).times(force).minus(),
                }
            }
            7 => {
                let belt = self.belt();
                self.sign(v.less(belt)).times(force).minus()
            }
            8 => {
                let (stiffness, beyond) = (self.parameter("k", 1.0, 400.0), self.beyond(j));
                if i == j && self.random.chance(50) {
                    let depth = self.max(beyond, zero());
                    return self.add(Part::Potential, stiffness.times(depth.squared()).half());
                }
                self.max(beyond, zero()).times(stiffness).minus()
            }
            9 => {
                let (stiffness, gap) = (self.parameter("k", 0.5, 40.0), self.parameter("a", 0.05, 0.6));
                let right = self.max(x.clone().less(gap.clone()), zero());
                let left = self.min(x.plus(gap), zero());
                right.plus(left).times(stiffness).minus()
            }
            10 => {
                let beyond = self.beyond(j);
                let distance = self.abs(beyond);
                return self.add(Part::Potential, force.times(distance));
            }
            11 => {
                let (from, width) = (self.place("a", -0.8, 0.5), self.parameter("d", 0.05, 1.0));
                let before = from.clone().plus(width).less(x.clone());
                let inner = self.step(before, force, zero());
                self.step(x.less(from), inner, zero())
            }
            12 => {
                let (distance, width) = (self.abs(x), self.parameter("d", 0.1, 1.0));
                self.step(distance.less(width), zero(), force)
            }
            13 => {
                let frequency = self.parameter("w", 0.4, 6.0);
                self.sign(Formula::Sin(Box::new(frequency.times(Formula::Time)))).times(force)
            }
            14 => self.table(2.0).times(force),
            15 if i != j => {
                let sign = self.sign(v.less(self.velocity(j)));
                self.add(Part::Force(j), force.clone().times(sign.clone()));
                force.times(sign).minus()
            }
            15 | 16 => {
                let lead = self.parameter("l", 0.1, 1.0);
                let function = Formula::Variable(i).plus(lead.times(v));
                self.sign(function).times(force).minus()
            }
            17 => {
                let stiffness = self.parameter("k", 0.5, 20.0);
                let pull = stiffness.times(Formula::Variable(i)).minus();
                let below = self.min(force.clone(), pull);
                self.max(force.minus(), below)
            }
            18 => {
                let speed = self.abs(v.clone());
                speed.times(v).times(force).minus()
            }
            _ => {
                let (beyond, sign) = (self.beyond(j), self.sign(v));
                self.step(beyond, force.times(sign).minus(), zero())
            }
        };
        self.add(Part::Force(i), term);
    }

    fn simulation(&mut self) {
        self.specimen.t_end = self.number(2.0, 8.0);
        let count = self.specimen.parameters.len();
        let mut all: Vec<usize> = (0..count).collect();
        self.random.shuffle(&mut all);
        self.specimen.asked = all.into_iter().take(2).collect();
        self.specimen.asked.sort_unstable();
    }
}
