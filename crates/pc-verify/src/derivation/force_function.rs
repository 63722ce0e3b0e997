//! The choice of the forces on bodies that count in the energy.
//!
//! A force F on a body at r that depends on the position alone, and is homogeneous of degree d in r there,
//! has the force function U = F·r/(d + 1) (Euler) if F·X_s r = X_s U for all s. The text format adds the
//! force functions of such forces, as a whole or by components, to L; the first derivation chooses the forces
//! by the symbols that their expressions contain: at a state where its rate vanishes, a time-dependent force
//! looks like a constant one, and velocities that cancel leave rounding errors. Here that choice is confirmed
//! numerically: the force does not change with the velocities, and the quotient μ of F·X_s r and X_s (F·r) is
//! the same constant for all s, at all places and for other values of the parameters.

use crate::derivation::derivation::Derivation;
use crate::derivation::place::Place;
use crate::error::Irregular;
use crate::numbers::rounding::{Random, Rounding, within};

/// The number of places at which the quotient is tested, for the present values of the parameters and for
/// other values.
const PLACES: usize = 6;

/// The greatest relative change in the parameters, and the greatest distance between places.
const MOVED: f64 = 0.3;

/// The remainder that rounding errors may leave, relative to the larger of the two sides.
const ALIKE: f64 = 1e-9;

impl Derivation {
    /// Finds the factors μ_i of F_i r_i for all bodies, for the components that `chosen` selects, given the
    /// name of the body and their index.
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

    /// μ of the vector with these components of the force on a body, and zeros elsewhere.
    fn factor(&self, body: usize, components: &[usize], near: &Place) -> Option<f64> {
        let mut random = Random::new(2);
        let mut known: Vec<Sides> = Vec::with_capacity(PLACES);
        for number in 0..PLACES {
            // At any place, also off the surface of a frame or of constraints.
            let scale = if number == 0 { 0.0 } else { MOVED };
            let (x, w) =
                (self.units.displaced(near, scale, &mut random), self.units.faster(near, scale, &mut random));
            let place = Place { x, w, ..near.clone() };
            let Ok(sides) = self.sides(body, components, &place) else { continue };
            known.extend(Some(sides).filter(Sides::are_finite));
        }
        let rate = largest(known.iter().flat_map(|sides| &sides.rates));
        let force = largest(known.iter().flat_map(|sides| &sides.terms));
        if known.is_empty() || !within(rate, ALIKE * force) {
            return None;
        }
        let size = largest(known.iter().flat_map(|sides| sides.of_fields.as_flattened()));
        // Where it vanishes up to rounding, the quotient is noise.
        let pairs = || known.iter().flat_map(|sides| &sides.of_fields);
        let steepest = pairs().max_by(|one, other| one[1].abs().total_cmp(&other[1].abs()));
        let factor = match steepest {
            Some([work, slope]) if slope.abs() > ALIKE * size => work / slope,
            // A force that does no work counts once.
            _ => 1.0,
        };
        let is_exact = |[work, slope]: &[f64; 2]| within((work - factor * slope).abs(), ALIKE * size);
        pairs().all(is_exact).then_some(factor)
    }

    /// Both sides of the equation for these components of the force on a body.
    fn sides(&self, body: usize, components: &[usize], at: &Place) -> Result<Sides, Irregular> {
        let (exact, body) = (Rounding::none(), &self.text.bodies[body]);
        let still = self.still(at, &exact);
        let terms = components.iter().map(|&i| still.largest_term(&body.force[i]));
        let terms = terms.collect::<Result<Vec<f64>, Irregular>>()?;
        let mut rates = Vec::with_capacity(at.w.len() * components.len());
        for s in 0..at.w.len() {
            let point = self.once(at, &at.along_velocity(s), &exact);
            for &i in components {
                rates.push(point.value(&body.force[i])?.eps);
            }
        }
        let mut of_fields = Vec::with_capacity(at.w.len());
        for field in self.frame(at, &exact)? {
            let point = self.once(at, &at.along(field), &exact);
            let (mut work, mut slope) = (0.0, 0.0);
            for &i in components {
                let (force, r) = (point.value(&body.force[i])?, point.value(&body.position[i])?);
                work += force.re * r.eps;
                slope += (force * r).eps;
            }
            of_fields.push([work, slope]);
        }
        Ok(Sides { of_fields, rates, terms })
    }
}

/// The two sides that are compared for the force on a body at a place, and the quantities on which the two
/// sides depend.
struct Sides {
    /// F·X_s r and X_s (F·r) for all s.
    of_fields: Vec<[f64; 2]>,
    /// The derivatives of the components of the force with respect to the velocities, and the largest term of
    /// each component.
    rates: Vec<f64>,
    terms: Vec<f64>,
}

impl Sides {
    fn are_finite(&self) -> bool {
        let all = self.of_fields.as_flattened().iter().chain(&self.rates).chain(&self.terms);
        all.copied().all(f64::is_finite)
    }
}

fn largest<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    values.fold(0.0, |largest, value| largest.max(value.abs()))
}
