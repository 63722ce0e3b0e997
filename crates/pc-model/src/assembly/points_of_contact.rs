//! Where bodies touch uneven ground at the start.
//!
//! A coordinate of a point of contact that the text does not give follows from the places of bodies: Newton's method solves
//! t_i·(p − p_0) = 0, beginning below the centre of the shape. If it finds no solution, the start is off that constraint, and is
//! refused as such.

use pc_mech::Expr;

use crate::assembly::assembler::Assembler;
use crate::assembly::start::Given;
use crate::diagnostics::error::ModelError;

/// Steps of Newton's method, of which a few are enough unless the body is far above the ground.
const MOST_STEPS: usize = 60;
/// How often a step is halved.
const MOST_HALVINGS: usize = 12;
/// A step this small, compared with the place, ends the iteration.
const SMALL: f64 = 1e-15;

/// One equation: how far the point is beside the normal, and its derivatives with respect to the unknown coordinates.
struct Unknown<'g> {
    /// The index of the coordinate among the values.
    place: usize,
    beside: Expr<'g>,
    below: Expr<'g>,
}

impl<'g> Assembler<'g, '_> {
    /// Finds the coordinates of points of contact that are not given; `known` are the values of parameters and time.
    pub(super) fn place_contacts(
        &mut self,
        given: &mut Given,
        known: &[(Expr<'g>, f64)],
    ) -> Result<(), ModelError> {
        let document = self.model.document();
        let coordinates = self.scope.coordinates();
        for (number, contact) in document.contacts.iter().enumerate() {
            let place = |name: &str| document.coordinates.iter().position(|x| x.name.text == name);
            let places = contact.coordinates().map(|name| place(&name.text));
            let places: Vec<usize> = places.flatten().collect();
            if places.iter().all(|&place| given.is_given[place]) {
                continue;
            }
            let off = self.scope.point_off_body(number)?;
            let unknown = places.into_iter().zip(off).filter(|&(place, _)| !given.is_given[place]);
            let unknown: Vec<Unknown<'g>> =
                unknown.map(|(place, (beside, below))| Unknown { place, beside, below }).collect();
            let symbols: Vec<Expr<'g>> = unknown.iter().map(|unknown| coordinates[unknown.place]).collect();
            let mut wanted: Vec<Expr<'g>> = unknown.iter().map(|unknown| unknown.beside).collect();
            for unknown in &unknown {
                wanted.extend(self.graph.gradient(unknown.beside, &symbols));
            }
            let evaluate = |wanted: &[Expr<'g>], values: &[f64]| {
                let at = coordinates.iter().copied().zip(values.iter().copied());
                let at: Vec<(Expr<'g>, f64)> = known.iter().copied().chain(at).collect();
                self.graph.evaluate(wanted, &at).unwrap_or_default()
            };
            let below =
                evaluate(&unknown.iter().map(|unknown| unknown.below).collect::<Vec<_>>(), &given.values);
            for (unknown, below) in unknown.iter().zip(below) {
                given.values[unknown.place] = below;
            }
            let places: Vec<usize> = unknown.iter().map(|unknown| unknown.place).collect();
            solve(&places, &mut given.values, |values| evaluate(&wanted, values));
        }
        Ok(())
    }
}

/// Newton's method for one or two unknowns at these places; `equations` gives the values, then the derivatives row by row.
fn solve(places: &[usize], values: &mut [f64], equations: impl Fn(&[f64]) -> Vec<f64>) {
    let count = places.len();
    let size = |found: &[f64]| found.iter().take(count).fold(0.0f64, |size, value| size.hypot(*value));
    let mut found = equations(values);
    for _ in 0..MOST_STEPS {
        let step = match found[..] {
            [f, slope] => vec![-f / slope],
            [f, g, a, b, c, d] => {
                let determinant = a * d - b * c;
                vec![(b * g - d * f) / determinant, (c * f - a * g) / determinant]
            }
            _ => return,
        };
        if !step.iter().all(|step| step.is_finite()) {
            return;
        }
        let before: Vec<f64> = places.iter().map(|&place| values[place]).collect();
        let mut part = 1.0;
        for _ in 0..MOST_HALVINGS {
            for ((&place, step), before) in places.iter().zip(&step).zip(&before) {
                values[place] = before + part * step;
            }
            let next = equations(values);
            if size(&next) <= size(&found) {
                found = next;
                break;
            }
            part /= 2.0;
        }
        let largest = before.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
        if step.iter().all(|step| (part * step).abs() <= SMALL * largest) {
            return;
        }
    }
}
