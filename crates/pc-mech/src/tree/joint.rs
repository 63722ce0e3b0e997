//! How a body moves relative to its parent.

use pc_algebra::Matrix;
use pc_expr::Expr;

use crate::tree::spatial::{Tensor, Vector, ZERO, entries_of, unit};

/// A joint: how a body moves relative to its parent.
///
/// A joint is at a point of the parent, and has axes of its own. The origin of the body is the point of the
/// joint, and the axes of the body coincide with those of the joint when all coordinates of the joint vanish.
///
/// | kind | movement of the body | coordinates, quasi-velocities of a body `arm` |
/// |---|---|---|
/// | [`fixed`](Joint::fixed) | none | |
/// | [`revolute`](Joint::revolute) | turns about an axis | `arm`, `arm'` |
/// | [`prismatic`](Joint::prismatic) | slides along an axis | `arm`, `arm'` |
/// | [`screw`](Joint::screw) | both, with one coordinate | `arm`, `arm'` |
/// | [`cylindrical`](Joint::cylindrical) | slides along and turns about an axis | `arm_z`, `arm_φ`, and their rates |
/// | [`universal`](Joint::universal) | turns about an axis of the parent, then about one of its own | `arm_1`, `arm_2`, and their rates |
/// | [`planar`](Joint::planar) | slides along two axes, turns about the third | `arm_x`, `arm_y`, `arm_φ`, and their rates; `arm_y`, `arm_z` for the normal x, `arm_z`, `arm_x` for y |
/// | [`spherical`](Joint::spherical) | turns about a point | a unit quaternion `arm_q0` … `arm_q3`; ω against the parent, in body axes, `arm_ω1` … `arm_ω3` |
/// | [`free`](Joint::free) | any | the place `arm_x`, `arm_y`, `arm_z` of its origin and a quaternion; the velocity of its origin against the parent and ω, in body axes, `arm_v1` … `arm_ω3` |
#[derive(Clone, Debug)]
pub struct Joint<'g> {
    pub(crate) kind: Kind<'g>,
    /// The point of the joint, relative to the parent's origin and along the parent's axes.
    pub(crate) place: Vector<'g>,
    /// The rotation from the axes of the joint to those of the parent.
    pub(crate) rotation: Tensor<'g>,
    /// Names of coordinates and quasi-velocities, if they differ from the default ones.
    pub(crate) names: Option<(Vec<String>, Vec<String>)>,
    /// The joint whose movement this one repeats.
    pub(crate) follows: Option<Follows<'g>>,
    /// What acts on the coordinate of a joint that has exactly one.
    pub(crate) drive: Drive<'g>,
}

/// The drive of a joint with the coordinate x: a rotor, a spring, a damper, dry friction and stops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drive<'g> {
    /// The inertia J of ½ J x'².
    pub(crate) armature: Expr<'g>,
    /// The stiffness k and the place x_0 at rest, of the potential energy ½ k (x − x_0)².
    pub(crate) spring: Option<(Expr<'g>, Expr<'g>)>,
    /// The coefficient d of the force −d x'.
    pub(crate) damping: Expr<'g>,
    /// The size F of Coulomb's force −F sign x'.
    pub(crate) friction: Expr<'g>,
    /// The force F_s up to which friction holds the joint at rest, if it is larger than F.
    pub(crate) stiction: Option<Expr<'g>>,
    /// The stops on both sides.
    pub(crate) stops: Option<Stops<'g>>,
    /// The two ends of its way, where rigid stops hold it.
    pub(crate) ends: Option<[Expr<'g>; 2]>,
}

/// Stops at the ends of the way of a joint with the coordinate x. Beyond an end by s, they push back with k s + d s'.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stops<'g> {
    pub(crate) lower: Expr<'g>,
    pub(crate) upper: Expr<'g>,
    pub(crate) stiffness: Expr<'g>,
    pub(crate) damping: Expr<'g>,
}

impl<'g> Stops<'g> {
    /// ½ k s² on both sides.
    pub(crate) fn energy(&self, x: Expr<'g>) -> Expr<'g> {
        let beyond = [x - self.upper, self.lower - x].map(|s| s.max(0.0).square());
        self.stiffness * (beyond[0] + beyond[1]) / 2.0
    }

    /// The coefficient of the damper: d beyond an end, 0 between the ends.
    pub(crate) fn damper(&self, x: Expr<'g>) -> Expr<'g> {
        self.damping * ((x - self.upper).step(1.0, 0.0) + (self.lower - x).step(1.0, 0.0))
    }
}

impl<'g> Drive<'g> {
    const NONE: Drive<'static> = Drive {
        armature: Expr::ZERO,
        spring: None,
        damping: Expr::ZERO,
        friction: Expr::ZERO,
        stiction: None,
        stops: None,
        ends: None,
    };

    /// Its first part, named, if it has any.
    pub(crate) fn part(&self) -> Option<&'static str> {
        match self {
            Drive { armature, .. } if !armature.is_zero() => Some("armature"),
            Drive { spring: Some(_), .. } => Some("spring"),
            Drive { damping, .. } if !damping.is_zero() => Some("damping"),
            Drive { friction, .. } if !friction.is_zero() => Some("friction"),
            Drive { stiction: Some(_), .. } => Some("stiction"),
            Drive { stops: Some(_), .. } | Drive { ends: Some(_), .. } => Some("limits"),
            _ => None,
        }
    }

    fn map<'n>(&self, put: &impl Fn(Expr<'g>) -> Expr<'n>) -> Drive<'n> {
        Drive {
            armature: put(self.armature),
            spring: self.spring.map(|(stiffness, rest)| (put(stiffness), put(rest))),
            damping: put(self.damping),
            friction: put(self.friction),
            stiction: self.stiction.map(put),
            ends: self.ends.map(|ends| ends.map(put)),
            stops: self.stops.map(|stops| Stops {
                lower: put(stops.lower),
                upper: put(stops.upper),
                stiffness: put(stops.stiffness),
                damping: put(stops.damping),
            }),
        }
    }
}

/// How a joint with one coordinate moves with that of another body: x = ratio · x of the other + offset.
#[derive(Clone, Debug)]
pub(crate) struct Follows<'g> {
    pub(crate) body: String,
    pub(crate) ratio: Expr<'g>,
    pub(crate) offset: Expr<'g>,
}

#[derive(Clone, Debug)]
pub(crate) enum Kind<'g> {
    Fixed,
    Revolute([f64; 3]),
    Prismatic([f64; 3]),
    Screw([f64; 3], Expr<'g>),
    Cylindrical([f64; 3]),
    Universal([f64; 3], [f64; 3]),
    Planar([f64; 3]),
    Spherical,
    Free,
}

impl<'g> Joint<'g> {
    fn of(kind: Kind<'g>) -> Joint<'g> {
        Joint { kind, place: ZERO, rotation: unit(), names: None, follows: None, drive: Drive::NONE }
    }

    /// A joint that holds the body fixed.
    pub fn fixed() -> Joint<'g> {
        Joint::of(Kind::Fixed)
    }

    /// A joint that turns about an axis.
    pub fn revolute(axis: [f64; 3]) -> Joint<'g> {
        Joint::of(Kind::Revolute(axis))
    }

    /// A joint that slides along an axis.
    pub fn prismatic(axis: [f64; 3]) -> Joint<'g> {
        Joint::of(Kind::Prismatic(axis))
    }

    /// A joint that turns about an axis and slides along it, by the angle times the pitch, which is a length
    /// per radian.
    pub fn screw(axis: [f64; 3], pitch: impl Into<Expr<'g>>) -> Joint<'g> {
        Joint::of(Kind::Screw(axis, pitch.into()))
    }

    /// A joint that slides along an axis and turns about it.
    pub fn cylindrical(axis: [f64; 3]) -> Joint<'g> {
        Joint::of(Kind::Cylindrical(axis))
    }

    /// A joint that turns about the first axis, then about the second, which the first rotation carries
    /// along.
    pub fn universal(first: [f64; 3], second: [f64; 3]) -> Joint<'g> {
        Joint::of(Kind::Universal(first, second))
    }

    /// A joint that slides along two axes orthogonal to a normal, with which they form a right-handed system,
    /// and turns about the normal. For the normal (0, 0, 1) the axes are x and y.
    pub fn planar(normal: [f64; 3]) -> Joint<'g> {
        Joint::of(Kind::Planar(normal))
    }

    /// A joint that turns about a point, with a unit quaternion as coordinates.
    pub fn spherical() -> Joint<'g> {
        Joint::of(Kind::Spherical)
    }

    /// A joint that leaves the body free.
    pub fn free() -> Joint<'g> {
        Joint::of(Kind::Free)
    }

    /// The same joint at a point whose components, from the parent's origin, are along the parent's axes.
    #[must_use]
    pub fn at(self, place: [impl Into<Expr<'g>>; 3]) -> Joint<'g> {
        Joint { place: place.map(Into::into), ..self }
    }

    /// The same joint with other axes, given by the constant rotation from the new axes to those of the
    /// parent.
    ///
    /// # Panics
    /// If it does not have three rows and columns.
    #[must_use]
    pub fn rotated(self, rotation: &Matrix<Expr<'g>>) -> Joint<'g> {
        assert_eq!((rotation.rows(), rotation.columns()), (3, 3), "rows and columns of a rotation");
        Joint { rotation: entries_of(rotation), ..self }
    }

    /// The same joint with other names for its coordinates and quasi-velocities.
    #[must_use]
    pub fn named<S: Into<String>>(
        self,
        coordinates: impl IntoIterator<Item = S>,
        quasi_velocities: impl IntoIterator<Item = S>,
    ) -> Joint<'g> {
        let list = (
            coordinates.into_iter().map(Into::into).collect(),
            quasi_velocities.into_iter().map(Into::into).collect(),
        );
        Joint { names: Some(list), ..self }
    }

    /// The same joint, revolute, prismatic or screw, geared to such a joint of another body: its coordinate is
    /// `ratio` times that of the other plus `offset`, its velocity `ratio` times that of the other. It has no
    /// coordinate or quasi-velocity of its own.
    #[must_use]
    pub fn following(
        self,
        body: impl Into<String>,
        ratio: impl Into<Expr<'g>>,
        offset: impl Into<Expr<'g>>,
    ) -> Joint<'g> {
        let follows = Follows { body: body.into(), ratio: ratio.into(), offset: offset.into() };
        Joint { follows: Some(follows), ..self }
    }

    /// The same joint, revolute, prismatic or screw, with a rotor that turns with it: its coordinate x adds
    /// ½ J x'² to the kinetic energy. J is the moment of inertia of the rotor times the square of the gear's ratio,
    /// and moves only with the joint.
    #[must_use]
    pub fn armature(self, inertia: impl Into<Expr<'g>>) -> Joint<'g> {
        Joint { drive: Drive { armature: inertia.into(), ..self.drive }, ..self }
    }

    /// The same joint, revolute, prismatic or screw, with a spring: its coordinate x adds ½ k (x − x_0)² to the
    /// potential energy.
    #[must_use]
    pub fn spring(self, stiffness: impl Into<Expr<'g>>, rest: impl Into<Expr<'g>>) -> Joint<'g> {
        Joint { drive: Drive { spring: Some((stiffness.into(), rest.into())), ..self.drive }, ..self }
    }

    /// The same joint, revolute, prismatic or screw, with a damper: the force −d x' on its coordinate x.
    #[must_use]
    pub fn damping(self, coefficient: impl Into<Expr<'g>>) -> Joint<'g> {
        Joint { drive: Drive { damping: coefficient.into(), ..self.drive }, ..self }
    }

    /// The same joint, revolute, prismatic or screw, with dry friction of constant size: the force −F sign x' on its
    /// coordinate x. Where it is at rest, any force up to F holds it (Coulomb 1785).
    #[must_use]
    pub fn friction(self, size: impl Into<Expr<'g>>) -> Joint<'g> {
        Joint { drive: Drive { friction: size.into(), ..self.drive }, ..self }
    }

    /// The same joint with [friction](Joint::friction) of the size F that holds it at rest up to a larger force F_s, the
    /// `size` of its stiction.
    #[must_use]
    pub fn stiction(self, size: impl Into<Expr<'g>>) -> Joint<'g> {
        Joint { drive: Drive { stiction: Some(size.into()), ..self.drive }, ..self }
    }

    /// The same joint, revolute, prismatic or screw, with rigid stops at the two ends of its way: at rest there, it is
    /// held as long as it is pushed against them. How it rebounds when it arrives with a velocity is up to an event
    /// with the [response](crate::ImpulseResponse) to an impulse.
    #[must_use]
    pub fn ends(self, [lower, upper]: [impl Into<Expr<'g>>; 2]) -> Joint<'g> {
        let ends = Some([lower.into(), upper.into()]);
        Joint { drive: Drive { ends, ..self.drive }, ..self }
    }

    /// The same joint, revolute, prismatic or screw, with stops at the two ends of its way: where its coordinate x is
    /// beyond an end by s, a force k s + d s' drives it back.
    #[must_use]
    pub fn limits(
        self,
        [lower, upper]: [impl Into<Expr<'g>>; 2],
        stiffness: impl Into<Expr<'g>>,
        damping: impl Into<Expr<'g>>,
    ) -> Joint<'g> {
        let (lower, upper) = (lower.into(), upper.into());
        let stops = Stops { lower, upper, stiffness: stiffness.into(), damping: damping.into() };
        Joint { drive: Drive { stops: Some(stops), ..self.drive }, ..self }
    }

    /// The joint with each expression replaced.
    pub(crate) fn map<'n>(&self, put: &impl Fn(Expr<'g>) -> Expr<'n>) -> Joint<'n> {
        let follows = self.follows.as_ref().map(|Follows { body, ratio, offset }| Follows {
            body: body.clone(),
            ratio: put(*ratio),
            offset: put(*offset),
        });
        Joint {
            follows,
            kind: self.kind.map(put),
            place: self.place.map(put),
            rotation: self.rotation.map(|row| row.map(put)),
            names: self.names.clone(),
            drive: self.drive.map(put),
        }
    }

    /// The names of the coordinates and quasi-velocities of the joint, for a body with the given name.
    pub(crate) fn names_for(&self, body: &str) -> (Vec<String>, Vec<String>) {
        let own = || match self.follows {
            Some(_) => (Vec::new(), Vec::new()),
            None => self.kind.names(body),
        };
        self.names.clone().unwrap_or_else(own)
    }
}

const QUATERNION: [&str; 4] = ["q0", "q1", "q2", "q3"];

impl<'g> Kind<'g> {
    /// Whether the joint has exactly one coordinate.
    pub(crate) fn is_single(&self) -> bool {
        matches!(self, Kind::Revolute(_) | Kind::Prismatic(_) | Kind::Screw(..))
    }

    fn map<'n>(&self, put: impl Fn(Expr<'g>) -> Expr<'n>) -> Kind<'n> {
        match *self {
            Kind::Fixed => Kind::Fixed,
            Kind::Revolute(axis) => Kind::Revolute(axis),
            Kind::Prismatic(axis) => Kind::Prismatic(axis),
            Kind::Screw(axis, pitch) => Kind::Screw(axis, put(pitch)),
            Kind::Cylindrical(axis) => Kind::Cylindrical(axis),
            Kind::Universal(first, second) => Kind::Universal(first, second),
            Kind::Planar(normal) => Kind::Planar(normal),
            Kind::Spherical => Kind::Spherical,
            Kind::Free => Kind::Free,
        }
    }

    fn names(&self, body: &str) -> (Vec<String>, Vec<String>) {
        let with = |suffixes: &[&str]| -> Vec<String> {
            suffixes.iter().map(|suffix| format!("{body}_{suffix}")).collect()
        };
        let rates = |names: Vec<String>| {
            let rates = names.iter().map(|name| format!("{name}'")).collect();
            (names, rates)
        };
        match self {
            Kind::Fixed => (Vec::new(), Vec::new()),
            Kind::Revolute(_) | Kind::Prismatic(_) | Kind::Screw(..) => rates(vec![body.to_owned()]),
            Kind::Cylindrical(_) => rates(with(&["z", "φ"])),
            Kind::Universal(..) => rates(with(&["1", "2"])),
            Kind::Planar(normal) => {
                let [first, second] = slides(normal);
                rates(with(&[first, second, "φ"]))
            }
            Kind::Spherical => (with(&QUATERNION), with(&["ω1", "ω2", "ω3"])),
            Kind::Free => {
                let places = with(&["x", "y", "z"]);
                ([places, with(&QUATERNION)].concat(), with(&["v1", "v2", "v3", "ω1", "ω2", "ω3"]))
            }
        }
    }
}

/// The axes of its joint along which a planar joint slides: the two that follow its normal where that is one of them,
/// otherwise the first two of the axes that it gets.
fn slides(normal: &[f64; 3]) -> [&'static str; 2] {
    let along = |axis: usize| (0..3).all(|i| (normal[i] != 0.0) == (i == axis));
    [["y", "z"], ["z", "x"]]
        .into_iter()
        .enumerate()
        .find(|(axis, _)| along(*axis))
        .map_or(["x", "y"], |(_, names)| names)
}
