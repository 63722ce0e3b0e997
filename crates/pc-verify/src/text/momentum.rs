//! What bodies have as they move, as terms: mass centres, momenta, energies, and the zero-moment point.

use crate::text::term::{OfBody, Term};

/// A quantity of the body with this number.
fn of(body: usize, quantity: OfBody) -> Term {
    Term::OfBody(body, quantity)
}

fn product(factors: impl IntoIterator<Item = Term>) -> Term {
    Term::Product(factors.into_iter().map(|factor| (false, factor)).collect())
}

fn rate(term: Term) -> Term {
    Term::Rate(Box::new(term))
}

/// m ṙ_i
fn momentum(body: usize, i: usize) -> Term {
    product([of(body, OfBody::Mass), rate(of(body, OfBody::Place(i)))])
}

/// Bodies together, by their numbers.
struct All(usize);

impl All {
    fn sum(&self, of: impl Fn(usize) -> Term) -> Term {
        Term::Sum((0..self.0).map(|body| (false, of(body))).collect())
    }

    fn mass(&self) -> Term {
        self.sum(|body| of(body, OfBody::Mass))
    }

    fn centre(&self, i: usize) -> Term {
        let moment = self.sum(|body| product([of(body, OfBody::Mass), of(body, OfBody::Place(i))]));
        Term::Product(vec![(false, moment), (true, self.mass())])
    }

    fn momentum(&self, i: usize) -> Term {
        self.sum(|body| momentum(body, i))
    }

    /// Component i of Σ r × f + s.
    fn moment(
        &self,
        i: usize,
        force: impl Fn(usize, usize) -> Term,
        own: impl Fn(usize) -> Option<Term>,
    ) -> Term {
        let (j, l) = ((i + 1) % 3, (i + 2) % 3);
        self.sum(|body| {
            let arm =
                |axis: usize, along: usize| product([of(body, OfBody::Place(axis)), force(body, along)]);
            let turning = [(false, arm(j, l)), (true, arm(l, j))];
            Term::Sum(turning.into_iter().chain(own(body).map(|own| (false, own))).collect())
        })
    }

    /// About the origin.
    fn angular_momentum(&self, i: usize) -> Term {
        self.moment(i, momentum, |body| Some(of(body, OfBody::Spin(i))))
    }

    /// What acts on the bodies besides their weight has the force Ṗ − Σ m g and, about the origin, the moment
    /// M = d/dt Σ (r × m ṙ + I ω) − Σ r × m g; about the point (x, y, 0) it has the moments M_x − y F_z and
    /// M_y + x F_z.
    fn zero_moment_point(&self, i: usize, gravity: &[Term]) -> Term {
        let weight = |body: usize, axis: usize| product([of(body, OfBody::Mass), gravity[axis].clone()]);
        let force = Term::Sum(vec![
            (false, rate(self.momentum(2))),
            (true, product([self.mass(), gravity[2].clone()])),
        ]);
        let across = 1 - i;
        let moment = Term::Sum(vec![
            (false, rate(self.angular_momentum(across))),
            (true, self.moment(across, weight, |_| None)),
        ]);
        let quotient = Term::Product(vec![(false, moment), (true, force)]);
        if i == 0 { Term::Negative(Box::new(quotient)) } else { quotient }
    }
}

/// The term with a name such as `COM_x`, `p_BODY_y` or `T_BODY`, among these bodies and in this gravity.
pub(crate) fn named(name: &str, bodies: &[String], gravity: &[Term]) -> Option<Term> {
    let all = All(bodies.len());
    let number = |name: &str| bodies.iter().position(|known| known == name);
    let (symbol, rest) = name.split_once('_')?;
    match symbol {
        "T" => return number(rest).map(|body| of(body, OfBody::Kinetic)),
        "V" => return number(rest).map(|body| of(body, OfBody::Potential)),
        _ => {}
    }
    let i = ["x", "y", "z"].iter().position(|axis| rest.ends_with(axis))?;
    let whose = match &rest[..rest.len() - 1] {
        "" => None,
        body => Some(number(body.strip_suffix('_')?)?),
    };
    match (symbol, whose) {
        _ if bodies.is_empty() => None,
        ("COM", Some(body)) => Some(of(body, OfBody::Place(i))),
        ("COM", None) => Some(all.centre(i)),
        ("p", Some(body)) => Some(momentum(body, i)),
        ("P", None) => Some(all.momentum(i)),
        ("L", Some(body)) => Some(of(body, OfBody::Spin(i))),
        ("L", None) => {
            // About the origin, less that of the common mass centre.
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            let carried = |j: usize, l: usize| product([all.centre(j), all.momentum(l)]);
            let terms = vec![(false, all.angular_momentum(i)), (true, carried(j, l)), (false, carried(l, j))];
            Some(Term::Sum(terms))
        }
        ("ZMP", None) if i < 2 && gravity.len() == 3 => Some(all.zero_moment_point(i, gravity)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_bodies_may_end_like_names_of_axes() {
        let bodies = ["x", "arm_x", "arm"].map(str::to_owned);
        let place = |name: &str| match named(name, &bodies, &[]) {
            Some(Term::OfBody(body, OfBody::Place(i))) => Some((body, i)),
            _ => None,
        };
        assert_eq!(place("COM_x_x"), Some((0, 0)));
        assert_eq!(place("COM_arm_x_z"), Some((1, 2)));
        assert_eq!(place("COM_arm_x"), Some((2, 0)));
        assert!(matches!(named("T_arm_x", &bodies, &[]), Some(Term::OfBody(1, OfBody::Kinetic))));
        for absent in ["COM_leg_x", "p_x", "P_arm_x", "T_x_x", "ZMP_x", "COM_w", "COM"] {
            assert!(named(absent, &bodies, &[]).is_none(), "{absent}");
        }
        assert!(named("COM_x", &[], &[]).is_none());
    }
}
