//! Bodies on joints, as terms: their positions, their rotations, and the rates of the joints' coordinates.
//!
//! A body has thirty definitions: the constant rotation of its joint, the rotation by the joint, its own
//! rotation, and its position; a point has three, and so has the place where a body touches the ground, of which uneven ground has six more. These definitions follow the constant definitions of the
//! text, which joints may contain, and precede the others, which may contain points.

use std::collections::HashSet;

use pc_expr::parse::{Ast, AstKind};
use pc_model::document::{
    Contact, Document, Drive, Expression, Following, Joint, JointKind, JointRotation, NamedExpression, Point,
    TreeBody,
};

use crate::error::Unable;
use crate::text::body::{Body, Turning, matrix};
use crate::text::contacts::Touching;
use crate::text::ground;
use crate::text::names::Names;
use crate::text::term::{Function, Term};

/// The terms of the rotors, springs and dampers of joints.
#[derive(Default)]
pub(crate) struct Drives {
    pub(crate) kinetic: Vec<Term>,
    pub(crate) potential: Vec<Term>,
    pub(crate) dissipation: Vec<Term>,
    /// The forces of dry friction, with the coordinates on which they act.
    pub(crate) friction: Vec<(String, Term)>,
    pub(crate) stops: Vec<Stop>,
}

/// A rigid stop.
#[derive(Clone, Debug)]
pub(crate) struct Stop {
    /// The name of the event at which it is struck.
    pub(crate) event: String,
    /// The gap, its rate, and the distance between the two ends.
    pub(crate) gap: Term,
    pub(crate) rate: Term,
    pub(crate) way: Term,
    pub(crate) restitution: Term,
}

/// The number of definitions of a body: J_0, J, R and r.
const OF_BODY: usize = 9 + 9 + 9 + 3;
/// The number of definitions of a point.
const OF_POINT: usize = 3;

/// The number of definitions of a contact of a body on a joint: its point of contact.
const OF_CONTACT: usize = 3;

/// The bodies on joints of a document, with the order of the definitions.
pub(crate) struct Tree<'a> {
    document: &'a Document,
    /// The definitions of the text, constant ones first, and the number of constant ones.
    written: Vec<&'a NamedExpression>,
    constant: usize,
    /// The bodies, parents first.
    order: Vec<usize>,
}

impl<'a> Tree<'a> {
    pub(crate) fn of(document: &'a Document) -> Tree<'a> {
        let mut order: Vec<usize> = Vec::new();
        let mut is_placed = vec![false; document.tree.len()];
        for start in 0..document.tree.len() {
            let mut chain = Vec::new();
            let mut next = Some(start);
            while let Some(body) = next.filter(|&body| !is_placed[body]) {
                is_placed[body] = true;
                chain.push(body);
                next = place_of(document, document.tree[body].parent());
            }
            order.extend(chain.into_iter().rev());
        }
        let mut known: HashSet<&str> = document.parameters.iter().map(|p| p.name.text.as_str()).collect();
        let (mut written, mut moving) = (Vec::new(), Vec::new());
        for definition in &document.definitions {
            if is_constant(&definition.expression.ast, &known) {
                known.insert(&definition.name.text);
                written.push(definition);
            } else {
                moving.push(definition);
            }
        }
        let constant = written.len();
        written.extend(moving);
        Tree { document, written, constant, order }
    }

    /// The names of all definitions; those of bodies and points serve only for error messages.
    pub(crate) fn names(&self) -> Vec<String> {
        let bodies = self.order.iter().map(|&body| &self.document.tree[body].name.text);
        let bodies = bodies.flat_map(|name| std::iter::repeat_n(name, OF_BODY));
        let points = self.document.points.iter().map(|point| &point.name.text);
        let points = points.flat_map(|name| std::iter::repeat_n(name, OF_POINT));
        let own = bodies.map(|name| format!("the body {name}"));
        let own = own.chain(points.map(|name| format!("the point {name}")));
        let own = own.chain(ground::names(self.document));
        let contacts = self.contacts().map(|(_, contact)| &contact.name.text);
        let contacts = contacts.flat_map(|name| std::iter::repeat_n(name, OF_CONTACT));
        let own = own.chain(contacts.map(|name| format!("the contact {name}")));
        let (constant, moving) = self.written.split_at(self.constant);
        let named = |list: &[&NamedExpression]| list.iter().map(|d| d.name.text.clone()).collect::<Vec<_>>();
        named(constant).into_iter().chain(own).chain(named(moving)).collect()
    }

    fn first(&self, body: usize) -> usize {
        self.constant + OF_BODY * self.order.iter().position(|&known| known == body).unwrap_or(0)
    }

    /// The rotation of a body, row by row, and its position.
    fn placement(&self, body: Option<usize>) -> (Vec<Term>, Vec<Term>) {
        let Some(body) = body else {
            return (unit(), vec![Term::Number(0.0); 3]);
        };
        let first = self.first(body) + 18;
        let all: Vec<Term> = (first..first + 12).map(Term::Definition).collect();
        (all[..9].to_vec(), all[9..].to_vec())
    }

    /// The rotation of a body on a joint, row by row, and its position.
    pub(crate) fn placed(&self, body: &str) -> Option<(Vec<Term>, Vec<Term>)> {
        place_of(self.document, Some(body)).map(|body| self.placement(Some(body)))
    }

    /// The contacts of bodies on joints, with their numbers.
    fn contacts(&self) -> impl Iterator<Item = (usize, &'a Contact)> {
        let on_joint =
            |(_, contact): &(usize, &Contact)| place_of(self.document, Some(&contact.body.value)).is_some();
        self.document.contacts.iter().enumerate().filter(on_joint)
    }

    /// The point of contact of a body on a joint, for the contact with this number.
    pub(crate) fn point_of_contact(&self, number: usize) -> Vec<Term> {
        let before = OF_BODY * self.document.tree.len() + OF_POINT * self.document.points.len();
        let before = before + ground::names(self.document).len();
        let place = self.contacts().position(|(own, _)| own == number).unwrap_or(0); // is among them
        let first = self.constant + before + OF_CONTACT * place;
        (first..first + OF_CONTACT).map(Term::Definition).collect()
    }

    /// The names of the components of points, with their terms.
    pub(crate) fn points(&self) -> Vec<(String, Term)> {
        let first = self.constant + OF_BODY * self.document.tree.len();
        let components = |(number, point): (usize, &Point)| {
            let (rotation, _) = self.placement(place_of(self.document, point.body()));
            let place = (0..3).map(move |i| Term::Definition(first + OF_POINT * number + i));
            let names: Vec<String> = point.components.iter().map(|name| name.text.clone()).collect();
            names.into_iter().zip(place.chain(rotation)).collect::<Vec<_>>()
        };
        self.document.points.iter().enumerate().flat_map(components).collect()
    }

    /// The definitions, in their order.
    pub(crate) fn definitions(&self, names: &Names) -> Result<Vec<Term>, Unable> {
        let written = |list: &[&NamedExpression]| -> Result<Vec<Term>, Unable> {
            list.iter().map(|definition| names.resolve(&definition.expression.ast)).collect()
        };
        let mut all = written(&self.written[..self.constant])?;
        for &number in &self.order {
            let body = &self.document.tree[number];
            let first = all.len();
            let defined =
                |from: usize| (first + from..first + from + 9).map(Term::Definition).collect::<Vec<_>>();
            let motion = Motion::of(&body.joint, &self.ways(&body.joint, names)?, names)?;
            all.extend(constant_rotation(&body.joint, names)?);
            all.extend(match motion.turn {
                Some(turn) => product(&defined(0), &turn),
                None => defined(0),
            });
            let (parent, origin) = self.placement(place_of(self.document, body.parent()));
            all.extend(product(&parent, &defined(9)));
            let at = vector(body.joint.at.as_ref(), names)?;
            let arm = match motion.slide {
                Some(slide) => added(&at, &turned(&defined(0), &slide)),
                None => at,
            };
            all.extend(added(&origin, &turned(&parent, &arm)));
        }
        for point in &self.document.points {
            let (rotation, origin) = self.placement(place_of(self.document, point.body()));
            all.extend(added(&origin, &turned(&rotation, &vector(point.at.as_ref(), names)?)));
        }
        all.extend(ground::definitions(self.document, names)?);
        for (_, contact) in self.contacts() {
            let touching = self.placed(&contact.body.value).map(|at| Touching::of(contact, names, at));
            all.extend(touching.map_or(Ok(Vec::new()), |touching| touching.point())?);
        }
        all.extend(written(&self.written[self.constant..])?);
        Ok(all)
    }

    /// The coordinates of a joint; ratio · y + offset if it follows one with the coordinate y.
    fn ways(&self, joint: &Joint, names: &Names) -> Result<Vec<Term>, Unable> {
        let Some(Following { body, ratio, offset, .. }) = &joint.follows else {
            return coordinates(joint, names);
        };
        let mut ways = match place_of(self.document, Some(&body.value)) {
            Some(followed) => self.ways(&self.document.tree[followed].joint, names)?,
            None => Vec::new(),
        };
        for way in &mut ways {
            if let Some(ratio) = ratio {
                *way = times([&names.resolve(&ratio.ast)?, way]);
            }
            if let Some(offset) = offset {
                *way = sum([way.clone(), names.resolve(&offset.ast)?]);
            }
        }
        Ok(ways)
    }

    /// The coordinate that moves a joint, by way of any number of others that it follows, and the ratio of the two.
    fn leader(&self, joint: &Joint, names: &Names) -> Result<(String, Term), Unable> {
        let Some(Following { body, ratio, .. }) = &joint.follows else {
            let coordinate = joint.coordinates.first().map(|name| name.text.clone()).unwrap_or_default();
            return Ok((coordinate, Term::Number(1.0)));
        };
        let followed = place_of(self.document, Some(&body.value));
        let followed = followed.ok_or_else(|| Unable::UnknownName { name: body.value.clone() })?;
        let (coordinate, of_followed) = self.leader(&self.document.tree[followed].joint, names)?;
        Ok(match ratio {
            Some(ratio) => (coordinate, times([&names.resolve(&ratio.ast)?, &of_followed])),
            None => (coordinate, of_followed),
        })
    }

    /// The energies and powers of the rotors, springs and dampers of joints: ½ J x'², ½ k (x − x_0)² and ½ d x'².
    pub(crate) fn drives(&self, names: &Names) -> Result<Drives, Unable> {
        let mut drives = Drives::default();
        let half_square = |factor: Term, of: &Term| times([&Term::Number(0.5), &factor, of, of]);
        for body in &self.document.tree {
            let joint = &body.joint;
            let term =
                |part: &Option<Expression>| part.as_ref().map(|part| names.resolve(&part.ast)).transpose();
            let Drive { armature, stiffness, rest, damping, friction, limits, .. } = &joint.drive;
            let [x] = &self.ways(joint, names)?[..] else { continue };
            let rate = Term::Rate(Box::new(x.clone()));
            drives.kinetic.extend(term(armature)?.map(|armature| half_square(armature, &rate)));
            drives.dissipation.extend(term(damping)?.map(|damping| half_square(damping, &rate)));
            if let Some(stiffness) = term(stiffness)? {
                let rest = term(rest)?.unwrap_or(Term::Number(0.0));
                let stretch = Term::Sum(vec![(false, x.clone()), (true, rest)]);
                drives.potential.push(half_square(stiffness, &stretch));
            }
            // Rigid stops act at rest and in impacts only.
            if let (Some(restitution), Some([lower, upper])) = (term(&joint.drive.restitution)?, limits) {
                let [lower, upper] = [names.resolve(&lower.ast)?, names.resolve(&upper.ast)?];
                let minus = |a: &Term, b: &Term| Term::Sum(vec![(false, a.clone()), (true, b.clone())]);
                let stop = |end: &str, gap: Term, rate: Term| Stop {
                    event: format!("{}_{end}", body.name.text),
                    gap,
                    rate,
                    way: minus(&upper, &lower),
                    restitution: restitution.clone(),
                };
                let reversed = Term::Negative(Box::new(rate.clone()));
                drives.stops.push(stop("lower", minus(x, &lower), rate.clone()));
                drives.stops.push(stop("upper", minus(&upper, x), reversed));
            }
            if let Some([lower, upper]) = limits.as_ref().filter(|_| joint.drive.restitution.is_none()) {
                let [lower, upper] = [names.resolve(&lower.ast)?, names.resolve(&upper.ast)?];
                let beyond = [
                    Term::Sum(vec![(false, x.clone()), (true, upper)]),
                    Term::Sum(vec![(false, lower), (true, x.clone())]),
                ];
                let stiffness = term(&joint.drive.stop_stiffness)?.unwrap_or(Term::Number(0.0));
                let damping = term(&joint.drive.stop_damping)?;
                let [zero, one] = [0.0, 1.0].map(Term::Number);
                for s in beyond {
                    let depth = Term::Call(Function::Max, vec![s.clone(), zero.clone()]);
                    drives.potential.push(half_square(stiffness.clone(), &depth));
                    let Some(damping) = &damping else { continue };
                    let acts = Term::Call(Function::Step, vec![s, one.clone(), zero.clone()]);
                    drives.dissipation.push(half_square(times([damping, &acts]), &rate));
                }
            }
            if let Some(friction) = term(friction)? {
                let sign = Term::Call(Function::Sign, vec![rate]);
                let (coordinate, ratio) = self.leader(joint, names)?;
                drives
                    .friction
                    .push((coordinate, Term::Negative(Box::new(times([&friction, &sign, &ratio])))));
            }
        }
        Ok(drives)
    }

    /// The rates of the coordinates of joints, with the names of the coordinates.
    pub(crate) fn rates(&self, names: &Names) -> Result<Vec<(String, Term)>, Unable> {
        let mut all = Vec::new();
        for body in &self.document.tree {
            let joint = &body.joint;
            let x = joint.coordinates.iter().map(|name| name.text.clone());
            let eta: Vec<Term> = joint
                .quasi_velocities
                .iter()
                .map(|name| names.quasi_velocity(&name.text))
                .collect::<Result<_, _>>()?;
            let rates = match joint.kind {
                JointKind::Spherical => quaternion_rates(&coordinates(joint, names)?, &eta),
                JointKind::Free => {
                    let x = coordinates(joint, names)?;
                    let slide = turned(&by_quaternion(&x[3..]), &eta[..3]);
                    [slide, quaternion_rates(&x[3..], &eta[3..])].concat()
                }
                _ => eta,
            };
            all.extend(x.zip(rates));
        }
        Ok(all)
    }

    /// The bodies themselves, in the order of the text.
    pub(crate) fn bodies(&self, names: &Names) -> Result<Vec<Body>, Unable> {
        self.document.tree.iter().enumerate().map(|(number, body)| self.body(number, body, names)).collect()
    }

    fn body(&self, number: usize, body: &TreeBody, names: &Names) -> Result<Body, Unable> {
        let term = |expression: &Expression| names.resolve(&expression.ast);
        let terms = |list: &Option<[Expression; 3]>| -> Result<Vec<Term>, Unable> {
            list.iter().flatten().map(term).collect()
        };
        let (rotation, origin) = self.placement(Some(number));
        let arm = turned(&rotation, &vector(body.center.as_ref(), names)?);
        let force = terms(&body.force)?;
        Ok(Body {
            mass: body.mass.as_ref().map_or(Ok(Term::Number(0.0)), term)?,
            position: added(&origin, &arm),
            inertia: body.inertia.as_ref().map(|inertia| matrix(inertia, term)).transpose()?,
            turning: Some(Turning::Rotation(rotation)),
            force_functions: vec![0.0; force.len()],
            may_have_force_functions: false,
            force,
            torque: terms(&body.torque)?,
        })
    }
}

/// Whether an expression contains only numbers and known names.
fn is_constant(ast: &Ast, known: &HashSet<&str>) -> bool {
    let all = |parts: Vec<&Ast>| parts.into_iter().all(|part| is_constant(part, known));
    match &ast.kind {
        AstKind::Number(_) => true,
        AstKind::Name(name) => name == "pi" || known.contains(name.as_str()),
        AstKind::Velocity(_) | AstKind::TotalDerivative(_) => false,
        AstKind::Negate(inner) => is_constant(inner, known),
        AstKind::Sum(terms) => all(terms.iter().map(|(_, term)| term).collect()),
        AstKind::Product(factors) => all(factors.iter().map(|(_, factor)| factor).collect()),
        AstKind::Power(base, exponent) => all(vec![base, exponent]),
        AstKind::Call(_, _, arguments) => all(arguments.iter().collect()),
    }
}

fn place_of(document: &Document, body: Option<&str>) -> Option<usize> {
    body.and_then(|name| document.tree.iter().position(|body| body.name.text == name))
}

/// The movement that a joint allows, in its own axes: first the slide, then the rotation.
struct Motion {
    slide: Option<Vec<Term>>,
    turn: Option<Vec<Term>>,
}

impl Motion {
    /// The movement of a joint whose coordinates are x.
    fn of(joint: &Joint, x: &[Term], names: &Names) -> Result<Motion, Unable> {
        let axis = |number: usize| -> Vec<Term> {
            let axis = joint.axes.get(number).copied().unwrap_or_default();
            let length = axis.iter().map(|part| part * part).sum::<f64>().sqrt();
            axis.iter().map(|part| Term::Number(part / length)).collect()
        };
        let along = |axis: &[Term], by: &Term| -> Vec<Term> { axis.iter().map(|u| times([u, by])).collect() };
        let (slide, turn) = match joint.kind {
            JointKind::Fixed => (None, None),
            JointKind::Revolute => (None, Some(about(&axis(0), &x[0]))),
            JointKind::Prismatic => (Some(along(&axis(0), &x[0])), None),
            JointKind::Screw => {
                let (axis, pitch) = (axis(0), joint.pitch.as_ref());
                let pitch = pitch.map_or(Ok(Term::Number(0.0)), |pitch| names.resolve(&pitch.ast))?;
                (Some(along(&axis, &times([&pitch, &x[0]]))), Some(about(&axis, &x[0])))
            }
            JointKind::Cylindrical => (Some(along(&axis(0), &x[0])), Some(about(&axis(0), &x[1]))),
            JointKind::Universal => (None, Some(product(&about(&axis(0), &x[0]), &about(&axis(1), &x[1])))),
            JointKind::Planar => {
                let normal = axis(0);
                // The normal is a coordinate axis, and the slides are along the two that follow it.
                let [first, second] = [0, 1]
                    .map(|turns| (0..3).map(|i| normal[(i + 2 - turns) % 3].clone()).collect::<Vec<_>>());
                let slide = added(&along(&first, &x[0]), &along(&second, &x[1]));
                (Some(slide), Some(about(&normal, &x[2])))
            }
            JointKind::Spherical => (None, Some(by_quaternion(x))),
            JointKind::Free => (Some(x[..3].to_vec()), Some(by_quaternion(&x[3..]))),
        };
        Ok(Motion { slide, turn })
    }
}

fn coordinates(joint: &Joint, names: &Names) -> Result<Vec<Term>, Unable> {
    joint.coordinates.iter().map(|name| names.coordinate(&name.text)).collect()
}

fn vector(list: Option<&[Expression; 3]>, names: &Names) -> Result<Vec<Term>, Unable> {
    match list {
        Some(list) => list.iter().map(|part| names.resolve(&part.ast)).collect(),
        None => Ok(vec![Term::Number(0.0); 3]),
    }
}

/// The constant rotation of a joint. Entries that are 0 or ±1 up to rounding, such as cos(π/2), are made
/// exact, so that a loop does not restrict the directions that parallel axes leave free.
fn constant_rotation(joint: &Joint, names: &Names) -> Result<Vec<Term>, Unable> {
    let entries = match &joint.rotation {
        None => unit(),
        Some(JointRotation::Matrix(entries)) => {
            entries.iter().map(|entry| names.resolve(&entry.ast)).collect::<Result<_, _>>()?
        }
        Some(JointRotation::Turns(turns)) => {
            let mut all = unit();
            for (axis, angle) in turns {
                let axis: Vec<Term> = (0..3).map(|i| Term::Number(f64::from(u8::from(i == *axis)))).collect();
                all = product(&all, &about(&axis, &names.resolve(&angle.ast)?));
            }
            all
        }
    };
    let exact = |entry: Term| {
        let is_near = |unit: &f64| number(&entry).is_some_and(|value| (value - unit).abs() <= ROUNDING);
        [0.0, 1.0, -1.0].into_iter().find(is_near).map_or(entry, Term::Number)
    };
    Ok(entries.into_iter().map(exact).collect())
}

/// Some rounding errors of a number near 1.
const ROUNDING: f64 = 1e-15;

fn times<const N: usize>(factors: [&Term; N]) -> Term {
    Term::Product(factors.map(|factor| (false, factor.clone())).to_vec())
}

fn sum(terms: impl IntoIterator<Item = Term>) -> Term {
    Term::Sum(terms.into_iter().map(|term| (false, term)).collect())
}

fn added(a: &[Term], b: &[Term]) -> Vec<Term> {
    a.iter().zip(b).map(|(a, b)| sum([a.clone(), b.clone()])).collect()
}

fn scalar(a: &[Term], b: &[Term]) -> Term {
    sum(a.iter().zip(b).map(|(a, b)| times([a, b])))
}

fn cross(a: &[Term], b: &[Term]) -> Vec<Term> {
    let part =
        |i: usize, j: usize| Term::Sum(vec![(false, times([&a[i], &b[j]])), (true, times([&a[j], &b[i]]))]);
    vec![part(1, 2), part(2, 0), part(0, 1)]
}

/// The unit matrix.
fn unit() -> Vec<Term> {
    (0..9).map(|i| Term::Number(if i % 4 == 0 { 1.0 } else { 0.0 })).collect()
}

/// A v
fn turned(matrix: &[Term], vector: &[Term]) -> Vec<Term> {
    (0..3).map(|i| scalar(&matrix[3 * i..3 * i + 3], vector)).collect()
}

/// A B
fn product(a: &[Term], b: &[Term]) -> Vec<Term> {
    let column = |j: usize| [b[j].clone(), b[3 + j].clone(), b[6 + j].clone()];
    (0..9).map(|ij| scalar(&a[3 * (ij / 3)..3 * (ij / 3) + 3], &column(ij % 3))).collect()
}

/// The matrix S for which S v = u × v.
fn skew(u: &[Term]) -> Vec<Term> {
    let (zero, minus) = (Term::Number(0.0), |i: usize| Term::Negative(Box::new(u[i].clone())));
    vec![
        zero.clone(),
        minus(2),
        u[1].clone(), //
        u[2].clone(),
        zero.clone(),
        minus(0), //
        minus(1),
        u[0].clone(),
        zero,
    ]
}

/// Rodrigues' rotation matrix 1 + sin φ S + (1 − cos φ) S², with the S of a unit vector.
fn about(axis: &[Term], angle: &Term) -> Vec<Term> {
    let (s, one) = (skew(axis), Term::Number(1.0));
    let square = product(&s, &s);
    let [sine, cosine] = sine_and_cosine(angle);
    let rest = Term::Sum(vec![(false, one), (true, cosine)]);
    let entry =
        |((unit, s), square): ((Term, Term), Term)| sum([unit, times([&sine, &s]), times([&rest, &square])]);
    unit().into_iter().zip(s).zip(square).map(entry).collect()
}

/// The sine and cosine of an angle. Both are exact for a number that is a multiple of π/2 up to rounding:
/// otherwise the cosine of the double nearest to π/2 could be the only term left when others vanish, and
/// would be mistaken for their size.
fn sine_and_cosine(angle: &Term) -> [Term; 2] {
    let quarter = std::f64::consts::FRAC_PI_2;
    if let Some(value) = number(angle) {
        let count = (value / quarter).round();
        if (value - count * quarter).abs() <= 4.0 * f64::EPSILON * value.abs() {
            let values = match count.rem_euclid(4.0) {
                0.0 => [0.0, 1.0],
                1.0 => [1.0, 0.0],
                2.0 => [0.0, -1.0],
                _ => [-1.0, 0.0],
            };
            return values.map(Term::Number);
        }
    }
    [Function::Sin, Function::Cos].map(|function| Term::Call(function, vec![angle.clone()]))
}

/// The value of a term that consists of numbers, their sums and products, sines and cosines.
fn number(term: &Term) -> Option<f64> {
    match term {
        Term::Number(value) => Some(*value),
        Term::Negative(inner) => Some(-number(inner)?),
        Term::Sum(terms) => terms.iter().try_fold(0.0, |sum, (minus, term)| {
            let value = number(term)?;
            Some(if *minus { sum - value } else { sum + value })
        }),
        Term::Product(factors) => factors.iter().try_fold(1.0, |product, (over, factor)| {
            let value = number(factor)?;
            Some(if *over { product / value } else { product * value })
        }),
        Term::Call(Function::Sin, arguments) => Some(number(arguments.first()?)?.sin()),
        Term::Call(Function::Cos, arguments) => Some(number(arguments.first()?)?.cos()),
        _ => None,
    }
}

/// |q|² + 2 q_0 S + 2 S² with the S of the vector of a quaternion. This is |q|² times a rotation, so that
/// energies agree even if a motion deviates from |q| = 1 by its tolerance.
fn by_quaternion(q: &[Term]) -> Vec<Term> {
    let (s, two) = (skew(&q[1..]), Term::Number(2.0));
    let square = product(&s, &s);
    let norm = scalar(q, q);
    let entry = |((unit, s), square): ((Term, Term), Term)| {
        sum([times([&norm, &unit]), times([&two, &q[0], &s]), times([&two, &square])])
    };
    unit().into_iter().zip(s).zip(square).map(entry).collect()
}

/// The rates of a quaternion: half its product with (0, ω).
fn quaternion_rates(q: &[Term], omega: &[Term]) -> Vec<Term> {
    let half = Term::Number(0.5);
    let scalar_part = times([&Term::Number(-0.5), &scalar(&q[1..], omega)]);
    let turned = cross(&q[1..], omega);
    let vector = (0..3).map(|i| times([&half, &sum([times([&q[0], &omega[i]]), turned[i].clone()])]));
    std::iter::once(scalar_part).chain(vector).collect()
}
