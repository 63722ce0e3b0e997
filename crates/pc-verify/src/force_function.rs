//! Which forces on bodies count in the energy.
//!
//! A force F on a body at r that depends on the place alone, and is homogeneous of degree d in r there, has
//! the force function U = F·r/(d + 1) (Euler) if F·X_s r = X_s U for all s. The text format adds such forces,
//! whole or by components, to L; which ones is the choice of the first derivation, which proves the property
//! where it can. Here the property is tested in numbers: the quotient μ of F·X_s r and X_s (F·r) is one
//! constant for all s, at all places and for other values of the parameters.

use crate::derivation::Derivation;
use crate::error::Irregular;
use crate::place::{Direction, Place};
use crate::rounding::{Random, Rounding, within};

/// The number of places at which the quotient is tested, for the present parameters and for others.
const PLACES: usize = 6;

/// The greatest change of parameters and places.
const MOVED: f64 = 0.3;

/// The remainder that rounding may leave, relative to the larger of both sides.
const ALIKE: f64 = 1e-9;

impl Derivation {
    /// Finds the factors μ_i of F_i r_i for all bodies, of the components that are chosen by the name of
    /// the body and their place.
    pub(crate) fn find_force_functions(&mut self, near: &Place, chosen: impl Fn(&str, usize) -> bool) {
        let mut random = Random::new(1);
        let mut other = self.clone();
        for value in &mut other.text.parameters {
            *value *= 1.0 + MOVED * random.signed();
        }
        let may = |body: &usize| self.text.bodies[*body].may_have_force_functions;
        for body in (0..self.text.bodies.len()).filter(may).collect::<Vec<_>>() {
            let name = &self.text.names.bodies[body];
            let count = self.text.bodies[body].force.len();
            let components: Vec<usize> = (0..count).filter(|&i| chosen(name, i)).collect();
            let factor = |components: &[usize]| {
                let quotients = [&*self, &other].map(|derivation| derivation.factor(body, components, near));
                let [Some(here), Some(there)] = quotients else { return None };
                ((here - there).abs() <= ALIKE * here.abs()).then_some(here)
            };
            let whole = factor(&components).filter(|_| components.len() == count);
            let of_component = |i: usize| match whole {
                Some(factor) => factor,
                None if components.contains(&i) => factor(&[i]).unwrap_or(0.0),
                None => 0.0,
            };
            let factors: Vec<f64> = (0..count).map(of_component).collect();
            self.text.bodies[body].force_functions = factors;
        }
    }

    /// μ of the vector with these components of the force on a body, and zeros.
    fn factor(&self, body: usize, components: &[usize], near: &Place) -> Option<f64> {
        let mut random = Random::new(2);
        let mut factor = None;
        let mut looked = 0;
        for number in 0..PLACES {
            // At any place, also off the surface of a frame or of constraints.
            let scale = if number == 0 { 0.0 } else { MOVED };
            let mut moved = |values: &[f64]| -> Vec<f64> {
                values.iter().map(|value| value + scale * (1.0 + value.abs()) * random.signed()).collect()
            };
            let place = Place { x: moved(&near.x), w: moved(&near.w), ..near.clone() };
            let Ok(sides) = self.sides(body, components, &place) else { continue };
            let sides = sides?;
            if !sides.iter().flatten().all(|side| side.is_finite()) {
                continue;
            }
            looked += 1;
            let size = sides.iter().flatten().fold(0.0f64, |size, side| size.max(side.abs()));
            for [work, slope] in sides {
                if work.abs() <= ALIKE * size && slope.abs() <= ALIKE * size {
                    continue;
                }
                let factor = *factor.get_or_insert(work / slope);
                if !within((work - factor * slope).abs(), ALIKE * size) {
                    return None;
                }
            }
        }
        // A force that does no work counts once.
        if looked == 0 { None } else { Some(factor.unwrap_or(1.0)) }
    }

    /// F·X_s r and X_s (F·r) for all s; none where the force depends on time or velocities.
    fn sides(
        &self,
        body: usize,
        components: &[usize],
        at: &Place,
    ) -> Result<Option<Vec<[f64; 2]>>, Irregular> {
        let (exact, body) = (Rounding::none(), &self.text.bodies[body]);
        let rests = |along: &Direction| -> Result<bool, Irregular> {
            let point = self.once(at, along, &exact);
            let mut rates = components.iter().map(|&i| point.value(&body.force[i]));
            rates.try_fold(true, |rests, rate| Ok(rests && rate?.eps == 0.0))
        };
        let time = Direction { t: 1.0, ..at.along(vec![0.0; at.x.len()]) };
        for along in (0..at.w.len()).map(|s| at.along_velocity(s)).chain([time]) {
            if !rests(&along)? {
                return Ok(None);
            }
        }
        let mut sides = Vec::with_capacity(at.w.len());
        for field in self.frame(at, &exact)? {
            let point = self.once(at, &at.along(field), &exact);
            let (mut work, mut slope) = (0.0, 0.0);
            for &i in components {
                let (force, r) = (point.value(&body.force[i])?, point.value(&body.position[i])?);
                work += force.re * r.eps;
                slope += (force * r).eps;
            }
            sides.push([work, slope]);
        }
        Ok(Some(sides))
    }
}
