//! Quasi-velocities that move several links.
//!
//! Where joints follow another, one quasi-velocity η_d moves the links i by m_i η_d, the ratio of the joint that has
//! it being 1. Its force and acceleration are known only where all these links meet: the innermost link on
//! which all of them hang, or which is one of them and carries the others.

use pc_expr::Expr;

use crate::tree::link::Link;

/// A quasi-velocity that moves several links.
#[derive(Clone, Debug)]
pub(crate) struct Coupling<'g> {
    /// The link to which the quasi-velocity belongs.
    pub(crate) owner: usize,
    /// All links that it moves with their ratios, the owner first.
    pub(crate) moved: Vec<(usize, Expr<'g>)>,
    /// The link at which they meet; `None` for the world.
    pub(crate) meeting: Option<usize>,
}

impl<'g> Coupling<'g> {
    /// The couplings among links, in the order of their owners.
    pub(crate) fn all(links: &[Link<'g>]) -> Vec<Coupling<'g>> {
        let mut couplings: Vec<Coupling<'g>> = Vec::new();
        for owner in 0..links.len() {
            let followers = links.iter().enumerate().filter_map(|(i, link)| match link.follows {
                Some((followed, ratio)) if followed == owner => Some((i, ratio)),
                _ => None,
            });
            let moved: Vec<_> = std::iter::once((owner, Expr::ONE)).chain(followers).collect();
            if moved.len() > 1 {
                let meet = |a: Option<usize>, &(b, _): &(usize, Expr<'g>)| common(links, a?, b);
                let meeting = moved[1..].iter().fold(Some(owner), meet);
                couplings.push(Coupling { owner, moved, meeting });
            }
        }
        couplings
    }

    /// The ratio with which the quasi-velocity moves a link.
    pub(crate) fn ratio(&self, link: usize) -> Option<Expr<'g>> {
        self.moved.iter().find(|(moved, _)| *moved == link).map(|&(_, ratio)| ratio)
    }
}

/// The innermost link that carries both links or is one of them.
fn common(links: &[Link<'_>], mut a: usize, mut b: usize) -> Option<usize> {
    // A link comes after its parent: the later of two different links is not the common one.
    while a != b {
        let later = if a > b { &mut a } else { &mut b };
        *later = links[*later].parent?;
    }
    Some(a)
}
