//! Contacts of bodies with the ground, as terms.
//!
//! The point of contact p is found along fixed axes: the point of the edge of a disc, or of the surface x·A⁻¹x = 1 of an
//! ellipsoid, at which −n is the outward normal,
//!
//!   p = c − r (n − (n·e) e)/|n − (n·e) e|,    p = c − A n/√(n·A n),    A = R diag(a²) Rᵀ.
//!
//! The gap is the height of p above the plane, or along n above the point p_0 of uneven ground, to which p is tied by
//! (1, 0, f_x)·(p − p_0) = 0 and (0, 1, f_y)·(p − p_0) = 0. The material point there has, from c and the axes of the body, the
//! velocity ċ + Ṙ Rᵀ (p − c), or v + ω × (p − x) where ω is given.

use pc_model::document::{Contact, ContactShape, Document, Expression, Orientation};

use crate::error::Unable;
use crate::text::arithmetic::{
    added, cross, difference, dot, negative, quotient, rates, root, sum, times, unit,
};
use crate::text::ground::Ground;
use crate::text::names::Names;
use crate::text::term::Term;

/// A contact of a body whose place and attitude are these terms.
pub(crate) struct Touching<'a> {
    contact: &'a Contact,
    names: &'a Names,
    /// The reference point of the body, and its rotation, row by row.
    place: Vec<Term>,
    rotation: Vec<Term>,
}

impl<'a> Touching<'a> {
    /// The contact of a body that has this rotation and this place.
    pub(crate) fn of(
        contact: &'a Contact,
        names: &'a Names,
        (rotation, place): (Vec<Term>, Vec<Term>),
    ) -> Touching<'a> {
        Touching { contact, names, place, rotation }
    }

    /// The contact of a body with a position, and the angular velocity of this if it is given.
    pub(super) fn placed(
        contact: &'a Contact,
        document: &Document,
        names: &'a Names,
    ) -> Result<(Touching<'a>, Option<Vec<Term>>), Unable> {
        let term = |part: &Expression| names.resolve(&part.ast);
        let terms = |list: &[Expression]| list.iter().map(term).collect::<Result<Vec<Term>, Unable>>();
        let body = document.bodies.iter().find(|body| body.name.text == contact.body.value);
        let body = body.ok_or_else(|| Unable::UnknownName { name: contact.body.value.clone() })?;
        let (rotation, omega) = match (&body.orientation, &contact.attitude) {
            (Some(Orientation::AngularVelocity(omega)), Some(attitude)) => {
                (terms(&attitude.value[..])?, Some(terms(&omega[..])?))
            }
            (Some(Orientation::Rotation(rotation)), _) => (terms(&rotation[..])?, None),
            _ => return Err(Unable::UnknownName { name: contact.body.value.clone() }),
        };
        Ok((Touching { contact, names, place: terms(&body.position)?, rotation }, omega))
    }

    /// The point of contact.
    pub(crate) fn point(&self) -> Result<Vec<Term>, Unable> {
        let n = self.normal()?;
        let arm = match &self.contact.shape {
            ContactShape::Sphere { radius } => {
                let radius = self.names.resolve(&radius.ast)?;
                n.iter().map(|n| negative(times([&radius, n]))).collect()
            }
            ContactShape::Disc { radius, axis } => {
                let radius = self.names.resolve(&radius.ast)?;
                let length = axis.iter().map(|part| part * part).sum::<f64>().sqrt();
                let axle: Vec<Term> = axis.iter().map(|part| Term::Number(part / length)).collect();
                let axle = self.to_fixed(&axle);
                let lean = dot(&n, &axle);
                let across: Vec<Term> =
                    n.iter().zip(&axle).map(|(n, e)| difference(n.clone(), times([&lean, e]))).collect();
                let size = root(dot(&across, &across));
                across.iter().map(|part| negative(quotient(times([&radius, part]), &size))).collect()
            }
            ContactShape::Ellipsoid { semi_axes } => {
                // A n = Σ a_j² (n·u_j) u_j with the axes u_j, the columns of R.
                let mut image: Vec<Vec<Term>> = vec![Vec::new(); 3];
                for (j, half) in semi_axes.iter().enumerate() {
                    let half = self.names.resolve(&half.ast)?;
                    let axis: Vec<Term> = (0..3).map(|i| self.rotation[3 * i + j].clone()).collect();
                    let share = times([&half, &half, &dot(&n, &axis)]);
                    image.iter_mut().zip(&axis).for_each(|(row, u)| row.push(times([&share, u])));
                }
                let image: Vec<Term> = image.into_iter().map(sum).collect();
                let size = root(dot(&n, &image));
                image.into_iter().map(|part| negative(quotient(part, &size))).collect::<Vec<_>>()
            }
        };
        Ok(added(&self.centre()?, &arm))
    }

    fn centre(&self) -> Result<Vec<Term>, Unable> {
        Ok(match &self.contact.at {
            Some(at) => {
                let at: Vec<Term> =
                    at.iter().map(|part| self.names.resolve(&part.ast)).collect::<Result<_, _>>()?;
                added(&self.place, &self.to_fixed(&at))
            }
            None => self.place.clone(),
        })
    }

    fn normal(&self) -> Result<Vec<Term>, Unable> {
        if self.contact.height.is_some() {
            return Ok(Ground::of(self.contact, self.names)?.normal());
        }
        let Some(normal) = &self.contact.normal else { return Ok(unit(2)) };
        let normal: Vec<Term> =
            normal.iter().map(|part| self.names.resolve(&part.ast)).collect::<Result<_, _>>()?;
        let length = root(dot(&normal, &normal));
        Ok(normal.into_iter().map(|part| quotient(part, &length)).collect())
    }

    fn to_fixed(&self, v: &[Term]) -> Vec<Term> {
        self.rotation.chunks(3).map(|row| dot(row, v)).collect()
    }

    /// A point of the ground: on uneven ground the point of contact, of which `point` has the coordinates along which the
    /// height does not change.
    fn through(&self, point: &[Term]) -> Result<Vec<Term>, Unable> {
        if self.contact.height.is_some() {
            let mut through = point[..2].to_vec();
            for (&axis, name) in self.contact.along.iter().zip(self.contact.coordinates()) {
                through[axis] = self.names.coordinate(&name.text)?;
            }
            return Ok([through, vec![Ground::of(self.contact, self.names)?.height()]].concat());
        }
        match &self.contact.through {
            Some(through) => through.iter().map(|part| self.names.resolve(&part.ast)).collect(),
            None => Ok(vec![Term::Number(0.0); 3]),
        }
    }

    /// (1, 0, f_x)·(p − p_0) and (0, 1, f_y)·(p − p_0), for the axes along which the height changes.
    fn off(&self, above: &[Term]) -> Result<Vec<Term>, Unable> {
        if self.contact.along.is_empty() {
            return Ok(Vec::new());
        }
        let ground = Ground::of(self.contact, self.names)?;
        let along = |&axis: &usize| {
            let rise = times([&ground.slope(axis), &above[2]]);
            sum(vec![above[axis].clone(), rise])
        };
        Ok(self.contact.along.iter().map(along).collect())
    }

    /// The components of the contact, whose point of contact is `point`; `omega` is the angular velocity along the axes
    /// of the rotation, if it is given.
    pub(super) fn components(&self, point: Vec<Term>, omega: Option<&[Term]>) -> Result<Vec<Term>, Unable> {
        let n = self.normal()?;
        let through = self.through(&point)?;
        let changes = |i: usize| i == 2 || self.contact.height.is_none() || self.contact.along.contains(&i);
        let above: Vec<Term> = (0..3)
            .map(|i| match changes(i) {
                true => difference(point[i].clone(), through[i].clone()),
                false => Term::Number(0.0),
            })
            .collect();
        let gap = dot(&n, &above);
        let off = self.off(&above)?;
        let velocity = match omega {
            Some(omega) => {
                let arm = self.arm(&point, &self.place);
                added(&rates(&self.place), &cross(&self.to_fixed(omega), &arm))
            }
            None => {
                let centre = self.centre()?;
                let arm = self.arm(&point, &centre);
                let own: Vec<Term> = (0..3)
                    .map(|j| dot(&(0..3).map(|i| self.rotation[3 * i + j].clone()).collect::<Vec<_>>(), &arm))
                    .collect();
                let turning = self.rotation.chunks(3).map(|row| dot(&rates(row), &own)).collect::<Vec<_>>();
                added(&rates(&centre), &turning)
            }
        };
        // The projection of a fixed axis onto the plane, scaled to a unit vector, and n × this.
        let axis = self.contact.first_tangent();
        let share = &n[axis];
        let projected: Vec<Term> =
            unit(axis).into_iter().zip(&n).map(|(e, n)| difference(e, times([share, n]))).collect();
        let size = root(dot(&projected, &projected));
        let first: Vec<Term> = projected.into_iter().map(|part| quotient(part, &size)).collect();
        let slips = [dot(&first, &velocity), dot(&cross(&n, &first), &velocity)];
        let place = if self.contact.height.is_some() { through } else { point };
        Ok(place.into_iter().chain([gap]).chain(slips).chain(off).collect())
    }

    fn arm(&self, point: &[Term], from: &[Term]) -> Vec<Term> {
        point.iter().zip(from).map(|(p, c)| difference(p.clone(), c.clone())).collect()
    }
}
