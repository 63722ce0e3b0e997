//! A model in other units, which moves like the original.
//!
//! With lengths in units of 1/L and masses in units of 1/M, x̃ = L x, energies are E = M L² times what they were, as functions of
//! x̃/L. Quasi-velocities, carried coordinates, first-order states and the time keep their units, so that decades meet within one
//! model. Coordinates of the chart are lengths, all of them.
//!
//! | | factor | | factor |
//! |---|---|---|---|
//! | x, ẋ, gravity | L | λ of a constraint as it was, torques | E |
//! | energies, forces on η | E | forces on x, forces on bodies | E/L |

use super::comparison::{self, Finding};
use super::execution::{ATOL, Execution, Forms, GIVEN_UP, Motion, Moved, execute};
use super::expression::Expression;
use super::random::Random;
use super::specimen::{Frame, Specimen, Turning};
use super::start::Start;
use super::text;

/// Powers of ten up to this, and down to its inverse.
const DECADES: usize = 6;

/// The choices of units are others than those of the generator, whose seed they have.
const UNITS: u64 = 0x75_6e;

/// In a unit length and a unit mass there are so many new ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// The power of ten of lengths.
    length: i32,
    /// The power of ten of masses.
    mass: i32,
}

/// What came of a model in other units: its text, and what is wrong.
pub(super) struct Rescaled {
    pub(super) text: String,
    pub(super) findings: Vec<Finding>,
}

impl Units {
    /// The units for model number `index` of a seed.
    pub fn of(seed: u64, index: u64) -> Units {
        let mut random = Random::new(seed ^ UNITS, index);
        let mut power = || random.below(2 * DECADES + 1) as i32 - DECADES as i32;
        Units { length: power(), mass: power() }
    }

    /// Runs the specimen in these units, and compares its motion with that of the original; none where it has no start there.
    pub(super) fn examine(self, specimen: &Specimen, execution: &Execution) -> Option<Rescaled> {
        let scaled = self.applied(specimen);
        let start = Start::of(&scaled)?;
        let text = text::model(&scaled, &start);
        let atol = ATOL * ten(self.length.min(0));
        let findings = match execute("other-units.toml", &text, Forms { second: true, atol, ..Forms::ONE }) {
            Ok(other) => {
                let second = comparison::second(&other)
                    .map(|finding| Finding { kind: "second derivation disagrees in other units", ..finding });
                let back = self.undone(specimen, &other.motion);
                second.into_iter().chain(difference(&start, &execution.motion, &back)).collect()
            }
            // One absolute tolerance for components of all sizes may ask for more than rounding allows.
            Err(refusal) if refusal.stage == GIVEN_UP => Vec::new(),
            Err(refusal) => {
                let detail = format!("{}: {}", refusal.stage, refusal.message);
                vec![Finding { kind: "refused in other units", detail }]
            }
        };
        // With the text, which is not that of the original.
        let saying = |finding: Finding| {
            let detail = format!("{self:?}: {}\n{text}", finding.detail);
            Finding { detail, ..finding }
        };
        let findings = findings.into_iter().map(saying).collect();
        Some(Rescaled { text, findings })
    }

    fn energy(self) -> i32 {
        self.mass + 2 * self.length
    }

    /// The specimen with all that it contains in these units.
    fn applied(self, specimen: &Specimen) -> Specimen {
        let names = self.replacements(specimen);
        let mut scaled = specimen.clone();
        scaled
            .expressions_mut()
            .into_iter()
            .for_each(|expression| *expression = expression.substitute(&names));
        let (length, energy) = (ten(self.length), ten(self.energy()));
        let times = |expression: &mut Expression, factor: f64| *expression = expression.clone().times(factor);
        scaled.chart.iter_mut().for_each(|x| x.start *= length);
        scaled.velocities.iter_mut().for_each(|velocity| *velocity *= length);
        for carried in &mut scaled.carried {
            carried.value = carried.value.substitute(&names);
            carried.velocity = carried.velocity.substitute(&names);
        }
        match &mut scaled.frame {
            Frame::Velocities | Frame::Definitions(_) => {}
            Frame::Triangular(frame) => {
                let lower = frame.lower.iter_mut().map(|(_, _, b)| b);
                frame.diagonal.iter_mut().chain(&mut frame.drift).chain(lower).for_each(|b| times(b, length));
            }
            Frame::Group { velocities, inverse, .. } => {
                velocities.iter_mut().chain(inverse).for_each(|row| *row = row.substitute(&names));
                velocities.iter_mut().for_each(|row| times(row, length));
            }
        }
        let energies = scaled.kinetic.iter_mut().chain(&mut scaled.potential).chain(&mut scaled.dissipation);
        energies.for_each(|term| times(term, energy));
        let is_length = |name: &str| specimen.chart.iter().any(|x| x.name == name);
        for (on, force) in &mut scaled.forces {
            times(force, if is_length(on) { ten(self.energy() - self.length) } else { energy });
        }
        for body in &mut scaled.bodies {
            times(&mut body.mass, ten(self.mass));
            body.position.iter_mut().for_each(|place| times(place, length));
            body.force.iter_mut().flatten().for_each(|force| times(force, ten(self.energy() - self.length)));
            if let Some((inertia, turning)) = &mut body.turning {
                inertia.iter_mut().for_each(|moment| *moment *= energy);
                match turning {
                    Turning::About { ratio, .. } => *ratio *= ten(-self.length),
                    Turning::AngularVelocity(omega) => {
                        omega.iter_mut().for_each(|rate| *rate = rate.substitute(&names));
                    }
                }
            }
        }
        scaled.gravity.iter_mut().flatten().for_each(|component| times(component, length));
        for (name, value) in scaled.events.iter_mut().flat_map(|event| &mut event.reset) {
            times(value, ten(self.power(specimen, name)));
        }
        scaled
    }

    /// What stands for old names: x̃/L for x, and the like.
    fn replacements(self, specimen: &Specimen) -> Vec<(String, Expression)> {
        let in_old = |name: String, power: i32| {
            let old = Expression::symbol(&name).times(ten(-power));
            (name, old)
        };
        let lengths = specimen.chart.iter().flat_map(|x| [x.name.clone(), format!("{}'", x.name)]);
        let reactions = specimen.constraints.iter().map(|constraint| format!("λ_{}", constraint.name));
        let lengths = lengths.map(|name| in_old(name, self.length));
        lengths.chain(reactions.map(|name| in_old(name, self.energy()))).collect()
    }

    /// The power of ten by which a column is larger.
    pub(super) fn power(self, specimen: &Specimen, column: &str) -> i32 {
        let coordinate = column.strip_suffix('\'').unwrap_or(column);
        match column {
            _ if specimen.chart.iter().any(|x| x.name == coordinate) => self.length,
            "energy" => self.energy(),
            column if column.starts_with("λ_") || column.starts_with("N_") => self.energy(),
            column if column.starts_with("F_") => self.energy() - self.length,
            _ => 0,
        }
    }

    /// A motion in the units of the original.
    fn undone(self, specimen: &Specimen, motion: &Motion) -> Motion {
        let factors: Vec<f64> =
            motion.columns.iter().map(|column| ten(-self.power(specimen, column))).collect();
        let row =
            |row: &Vec<f64>| -> Vec<f64> { row.iter().zip(&factors).map(|(value, by)| value * by).collect() };
        let rows = |rows: &[Vec<f64>]| -> Vec<Vec<f64>> { rows.iter().map(row).collect() };
        let moved = |moved: &Moved| Moved { rows: rows(&moved.rows), happenings: moved.happenings.clone() };
        Motion { rows: rows(&motion.rows), moved: motion.moved.as_ref().map(moved), ..motion.clone() }
    }
}

/// What the motion has otherwise, after its units were undone.
fn difference(start: &Start, motion: &Motion, back: &Motion) -> Option<Finding> {
    let same = |name: &str| {
        let is_reaction = ["λ_", "F_", "N_"].iter().any(|of| name.starts_with(of));
        // Which of several constraints that follow from each other is dropped is a choice.
        (!(is_reaction && start.redundant)).then(|| name.to_owned())
    };
    comparison::compare("motion in other units differs", motion, back, same, None)
}

/// A power of ten to its last digit.
fn ten(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::generator;
    use crate::fuzz::specimen::Coordinate;

    const UNITS: Units = Units { length: -3, mass: 5 };

    fn oscillator(potential: &str) -> Specimen {
        let mut specimen = generator::empty();
        specimen.chart = vec![Coordinate { name: "x".to_owned(), start: 0.5, shown: true }];
        specimen.velocities = vec![0.3];
        let parsed = |text: &str| Expression::parse(text).expect("an expression");
        specimen.kinetic = vec![parsed("x'^2*(1 + x^2)")];
        specimen.potential = vec![parsed(potential)];
        specimen
    }

    fn execution(specimen: &Specimen) -> Execution {
        let start = Start::of(specimen).expect("a start");
        execute("model.toml", &text::model(specimen, &start), Forms::ONE).expect("a motion")
    }

    #[test]
    fn a_model_moves_alike_in_other_units() {
        let specimen = oscillator("x^2 + sin(x)");
        let rescaled = UNITS.examine(&specimen, &execution(&specimen)).expect("a start");
        assert!(rescaled.findings.is_empty(), "{:?}", rescaled.findings);
        assert!(rescaled.text.contains("\"x\" = 0.0005"), "{}", rescaled.text);
    }

    #[test]
    fn another_potential_in_other_units_is_found() {
        let original = execution(&oscillator("x^2 + sin(x)"));
        let rescaled = UNITS.examine(&oscillator("x^2 + 1.001*sin(x)"), &original).expect("a start");
        assert_eq!(
            rescaled.findings.first().map(|finding| finding.kind),
            Some("motion in other units differs")
        );
    }
}
