//! Random models, section by section.

mod bodies;
mod drives;
mod energies;
mod events;
mod functions;
mod groups;
mod kinematics;
mod restrictions;

use super::random::Random;
use super::specimen::{Frame, Specimen};

/// Names of coordinates, in the order in which they are given out.
const COORDINATES: [&str; 6] = ["x", "y", "φ", "q", "s", "θ"];

/// Names of quasi-velocities.
const QUASI_VELOCITIES: [&str; 4] = ["w1", "w2", "ω", "v"];

/// Model number `index` of the campaign of a seed.
pub fn specimen(seed: u64, index: u64) -> Specimen {
    Builder { random: Random::new(seed, index), specimen: empty() }.build()
}

/// A model without anything.
pub(super) fn empty() -> Specimen {
    Specimen {
        parameters: Vec::new(),
        chart: Vec::new(),
        carried: Vec::new(),
        frame: Frame::Velocities,
        algebra: None,
        constraints: Vec::new(),
        kinetic: Vec::new(),
        potential: Vec::new(),
        dissipation: Vec::new(),
        forces: Vec::new(),
        bodies: Vec::new(),
        gravity: None,
        states: Vec::new(),
        inputs: Vec::new(),
        outputs: Vec::new(),
        events: Vec::new(),
        velocities: Vec::new(),
        t_start: 0.0,
        t_end: 1.0,
    }
}

struct Builder {
    random: Random,
    specimen: Specimen,
}

impl Builder {
    fn build(mut self) -> Specimen {
        if self.random.chance(50) {
            let value = self.random.decimal(0.5, 1.5);
            self.specimen.parameters.push(("p".to_owned(), value));
        }
        if self.random.chance(10) {
            self.specimen.t_start = self.random.decimal(-1.0, 2.0);
        }
        let span = *self.random.pick(&[0.5, 0.5, 0.8, -0.5]);
        self.specimen.t_end = self.specimen.t_start + span;
        match self.random.below(100) {
            0..18 => self.lagrangian_coordinates(),
            18..50 => self.triangular_frame(),
            50..76 => self.group(),
            _ => self.definitions(),
        }
        let n = self.specimen.chart.len();
        self.specimen.velocities = (0..n).map(|_| self.random.decimal(-1.0, 1.0)).collect();
        self.constraints();
        self.energies();
        if self.random.chance(25) {
            self.bodies();
        }
        self.forces();
        self.outputs();
        if self.random.chance(30) {
            self.events();
        }
        self.drives();
        self.gravity();
        if !self.specimen.events.is_empty() {
            self.further_resets();
        }
        self.specimen
    }

    /// The names of the coordinates of the model.
    fn shown(&self) -> Vec<String> {
        self.specimen.coordinates()
    }

    /// The names of coordinates of the model that belong to the chart, so that their velocities have a name in each form.
    fn moving(&self) -> Vec<String> {
        self.specimen.chart.iter().filter(|x| x.shown).map(|x| x.name.clone()).collect()
    }

    /// What the kinetic energy has squares of: the quasi-velocities, or where there are none, or fewer than velocities,
    /// the velocities of coordinates.
    fn rates(&self) -> Vec<String> {
        let eta = self.specimen.quasi_velocities();
        if eta.len() < self.specimen.chart.len() {
            return self.specimen.chart.iter().map(|x| format!("{}'", x.name)).collect();
        }
        eta
    }
}
