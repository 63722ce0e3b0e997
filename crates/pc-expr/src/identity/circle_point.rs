//! Points of the circle and their group law: the values of sines and cosines.

use crate::identity::fingerprint::Fingerprint;
use crate::identity::roots::{Roots, Value};

/// A point (c, s) of the circle c² + s² = 1.
#[derive(Clone)]
pub(crate) struct CirclePoint {
    pub(crate) cos: Value,
    pub(crate) sin: Value,
}

impl CirclePoint {
    pub(crate) fn zero() -> CirclePoint {
        CirclePoint { cos: Value::ONE, sin: Fingerprint::ZERO.into() }
    }

    /// A random point of the circle, from its rational parametrisation.
    pub(crate) fn random(key: u64) -> CirclePoint {
        let u = Fingerprint::random(key);
        let square = u.times(u);
        let scale = Fingerprint::ONE.plus(square).powi(-1);
        CirclePoint {
            cos: Fingerprint::ONE.minus(square).times(scale).into(),
            sin: u.plus(u).times(scale).into(),
        }
    }

    pub(crate) fn plus(&self, other: &CirclePoint, roots: &mut Roots) -> CirclePoint {
        let mut times = |x, y| roots.times(x, y);
        let [cc, ss] = [times(&self.cos, &other.cos), times(&self.sin, &other.sin)];
        let [sc, cs] = [times(&self.sin, &other.cos), times(&self.cos, &other.sin)];
        CirclePoint { cos: roots.plus(&[cc, ss.negated()]), sin: roots.plus(&[sc, cs]) }
    }

    pub(crate) fn negated(&self) -> CirclePoint {
        CirclePoint { cos: self.cos.clone(), sin: self.sin.negated() }
    }

    pub(crate) fn multiple(&self, n: i32, roots: &mut Roots) -> CirclePoint {
        let mut square = if n < 0 { self.negated() } else { self.clone() };
        let mut result = CirclePoint::zero();
        let mut rest = n.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = result.plus(&square, roots);
            }
            rest >>= 1;
            if rest > 0 {
                square = square.plus(&square, roots);
            }
        }
        result
    }
}
