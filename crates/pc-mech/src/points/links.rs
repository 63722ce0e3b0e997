//! The links of bodies that carry one another, recognised from their velocities.

use std::collections::BTreeMap;

use pc_expr::Expr;

use crate::tree::spatial::{Vector, ZERO};

/// ∂v/∂η_s of a point, for each quasi-velocity s on which it depends.
pub(crate) type Row<'g> = BTreeMap<usize, Vector<'g>>;

/// Points that move with their hinge and with the quasi-velocities of the link.
#[derive(Clone, Debug)]
pub(crate) struct Link<'g> {
    /// Its own quasi-velocities, which move nothing but this link and what it carries.
    pub(crate) own: Vec<usize>,
    /// The arm of another link at which its hinge is; none for a hinge that is at rest.
    pub(crate) hinge: Option<(usize, usize)>,
    pub(crate) arms: Vec<Arm<'g>>,
    /// ∂v/∂η_s of the hinge.
    row: Row<'g>,
}

/// A point of a link.
#[derive(Clone, Debug)]
pub(crate) struct Arm<'g> {
    /// ∂v/∂η_s for each of the link's own quasi-velocities.
    pub(crate) directions: Vec<Vector<'g>>,
    /// The mass there.
    pub(crate) mass: Expr<'g>,
    /// The links that it carries.
    pub(crate) carried: Vec<usize>,
}

/// The links, each after the one that carries it, if masses with these velocities are such links and have `count`
/// quasi-velocities in all; none otherwise.
pub(crate) fn links<'g>(mut points: Vec<(Expr<'g>, Row<'g>)>, count: usize) -> Option<Vec<Link<'g>>> {
    points.sort_by_key(|(_, row)| row.len());
    let mut found = Found { links: Vec::new(), link_of: vec![None; count] };
    for (mass, row) in points.into_iter().filter(|(_, row)| !row.is_empty()) {
        let own: Vec<usize> = row.keys().copied().filter(|&s| found.link_of[s].is_none()).collect();
        if !own.is_empty() {
            let hinge: Row<'g> =
                row.iter().filter(|(s, _)| !own.contains(s)).map(|(&s, &v)| (s, v)).collect();
            let place = if hinge.is_empty() { None } else { Some(found.arm(&hinge)?) };
            let link = found.links.len();
            if let Some((carrier, arm)) = place {
                found.links[carrier].arms[arm].carried.push(link);
            }
            own.iter().for_each(|&s| found.link_of[s] = Some(link));
            found.links.push(Link { own, hinge: place, arms: Vec::new(), row: hinge });
        }
        let (link, arm) = found.arm(&row)?;
        found.links[link].arms[arm].mass += mass;
    }
    found.link_of.iter().all(Option::is_some).then_some(found.links)
}

struct Found<'g> {
    links: Vec<Link<'g>>,
    /// The link to which each quasi-velocity belongs.
    link_of: Vec<Option<usize>>,
}

impl<'g> Found<'g> {
    /// The link and the arm with this velocity, which may be a new arm.
    fn arm(&mut self, row: &Row<'g>) -> Option<(usize, usize)> {
        // What a link does not move itself is the velocity of its hinge.
        let is_of = |&link: &usize| {
            let Link { own, row: hinge, .. } = &self.links[link];
            let mut others = row.iter().filter(|(s, _)| !own.contains(s));
            row.keys().filter(|s| !own.contains(s)).count() == hinge.len()
                && others.all(|(s, v)| hinge.get(s) == Some(v))
        };
        let link = row.keys().filter_map(|&s| self.link_of[s]).find(is_of)?;
        let Link { own, arms, .. } = &mut self.links[link];
        let directions: Vec<Vector<'g>> = own.iter().map(|s| row.get(s).copied().unwrap_or(ZERO)).collect();
        let known = arms.iter().position(|arm| arm.directions == directions);
        let arm = known.unwrap_or_else(|| {
            arms.push(Arm { directions, mass: Expr::ZERO, carried: Vec::new() });
            arms.len() - 1
        });
        Some((link, arm))
    }
}
